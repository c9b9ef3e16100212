//! The geometry of two photographs: an essential matrix, the homography of a plane, or a pure
//! rotation, whichever makes the matches likeliest.
//!
//! ```text
//! five_point   essential matrices through five matches
//! essential    the robust estimate, and the relative pose in it
//! homography   planes and rotations
//! ```
//!
//! The three are compared by their log-likelihoods (compare GRIC, Torr 1999): under an essential
//! matrix a match lies anywhere along a line, under the others at a point. A rotation that
//! explains the matches nearly as well as the best of the others leaves no depth to measure.

mod essential;
mod five_point;
mod homography;

pub(super) use essential::RelativePose;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use self::essential::EssentialProblem;
use self::homography::{HomographyProblem, RotationProblem};
use super::random::Random;
use super::robust::{Likelihood, estimate};

/// Most samples drawn for each kind of geometry.
const MOST_SAMPLES: usize = 1000;

/// Fewest inliers of a pair: fewer agree by chance.
const FEWEST_INLIERS: usize = 20;

/// Nats by which a model with parallax has to be likelier than a rotation, for each inlier.
const PARALLAX_NATS: f64 = 0.1;

/// What relates two photographs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PairKind {
    /// An essential matrix.
    General,
    /// The homography of a plane explains the matches better still: depths differ little.
    Planar,
    /// A rotation about one projection centre explains them.
    Rotation,
}

/// The geometry of a pair.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct TwoViewGeometry {
    /// Which kind explains it best.
    pub kind: PairKind,
    /// The second camera relative to the first, and the matches that agree with it.
    pub pose: RelativePose,
    /// Indices of these matches.
    pub inliers: Vec<usize>,
    /// Nats by which the essential matrix makes the matches likelier.
    pub score: f64,
    /// Median angle between the rays of the inliers, radians.
    pub angle: f64,
}

/// The geometry of matches `(a, b)`, rays (x, y, 1) of both cameras without distortion; `sigma` is
/// the standard deviation of x and y, and an outlier lies anywhere within `range` of them. `None`
/// where too few agree.
pub(super) fn two_view_geometry(
    rays: &[(Vector3<f64>, Vector3<f64>)],
    sigma: f64,
    range: f64,
    seed: u64,
) -> Option<TwoViewGeometry> {
    if rays.len() < FEWEST_INLIERS {
        return None;
    }
    let mut random = Random::new(seed);
    let line = Likelihood::new(1, range);
    let point = Likelihood::new(2, range);
    let essential = EssentialProblem { rays, sigma };
    let general = estimate(&essential, &line, &mut random, MOST_SAMPLES)?;
    let (pose, inliers) = essential::pose_of(&general.model, rays, &general.inliers)?;
    if inliers.len() < FEWEST_INLIERS {
        return None;
    }
    let homography = HomographyProblem { rays, sigma };
    let planar = estimate(&homography, &point, &mut random, MOST_SAMPLES);
    let planar = planar.map_or(0.0, |e| e.score);
    let rotation = RotationProblem { rays, sigma };
    let rotation = estimate(&rotation, &point, &mut random, MOST_SAMPLES);
    let rotation = rotation.map_or(0.0, |e| e.score);
    let best = planar.max(general.score);
    let kind = if rotation > best - PARALLAX_NATS * inliers.len() as f64 {
        PairKind::Rotation
    } else if planar > general.score {
        PairKind::Planar
    } else {
        PairKind::General
    };
    let mut angles: Vec<f64> = (inliers.iter())
        .map(|&i| pose.angle(&rays[i].0, &rays[i].1))
        .collect();
    Some(TwoViewGeometry {
        kind,
        pose,
        angle: crate::base::math::median(&mut angles).unwrap_or(0.0),
        inliers,
        score: general.score,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::rotation_from_axis_angle;

    const SIGMA: f64 = 0.0008;

    /// Matches of points at these depths under a motion, a third of them wrong.
    fn matches(
        turn: Vector3<f64>,
        shift: Vector3<f64>,
        depth: impl Fn(&mut Random, f64, f64) -> f64,
    ) -> Vec<(Vector3<f64>, Vector3<f64>)> {
        let r = rotation_from_axis_angle(&turn);
        let mut random = Random::new(8);
        let mut noise = Random::new(9);
        (0..300)
            .map(|i| {
                let (x, y) = (0.5 * random.signed(), 0.4 * random.signed());
                let point = Vector3::new(x, y, 1.0) * depth(&mut random, x, y);
                let seen = r * point + shift;
                let mut b = seen / seen.z;
                if i % 3 == 0 {
                    b = Vector3::new(0.5 * random.signed(), 0.4 * random.signed(), 1.0);
                }
                let mut noisy =
                    |v: Vector3<f64>| v + Vector3::new(noise.normal(), noise.normal(), 0.0) * SIGMA;
                (noisy(Vector3::new(x, y, 1.0)), noisy(b))
            })
            .collect()
    }

    #[test]
    fn each_kind_of_geometry_is_named() {
        let (turn, shift) = (Vector3::new(0.1, -0.2, 0.4), Vector3::new(-0.7, 0.2, 0.1));
        let planar = |_: &mut Random, x: f64, y: f64| 4.0 / (1.0 + 0.2 * x - 0.1 * y);
        let general = |random: &mut Random, _: f64, _: f64| 4.0 + 1.5 * random.signed();
        let of = |m: &[_]| two_view_geometry(m, SIGMA, 1.0 / SIGMA, 1).unwrap();
        let found = of(&matches(turn, shift, general));
        assert_eq!(found.kind, PairKind::General);
        assert!(
            (190..=215).contains(&found.inliers.len()),
            "{}",
            found.inliers.len()
        );
        let off = found.pose.rotation.matrix() - rotation_from_axis_angle(&turn).matrix();
        assert!(off.norm() < 0.003, "{}", off.norm());
        assert!(found.pose.translation.dot(&shift.normalize()) > 0.999);
        assert_eq!(of(&matches(turn, shift, planar)).kind, PairKind::Planar);
        let still = Vector3::zeros();
        assert_eq!(of(&matches(turn, still, general)).kind, PairKind::Rotation);
    }

    #[test]
    fn matches_by_chance_have_no_geometry() {
        let mut random = Random::new(12);
        let chance: Vec<_> = (0..60)
            .map(|_| {
                let mut any = || Vector3::new(0.5 * random.signed(), 0.4 * random.signed(), 1.0);
                (any(), any())
            })
            .collect();
        assert!(two_view_geometry(&chance, SIGMA, 1.0 / SIGMA, 1).is_none());
    }
}
