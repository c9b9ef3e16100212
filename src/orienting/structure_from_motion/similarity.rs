//! The similarity between two sets of points.

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use super::block::{Block, Pose};
use super::linear::rotation_between;
use super::random::Random;
use crate::base::geometry::rotation_from_axis_angle;
use crate::base::math;

/// Fewest points that give a similarity in space, which has seven unknowns.
pub(super) const FEWEST_POINTS: usize = 3;

/// `x -> s R x + t`.
#[derive(Clone, Debug)]
pub(super) struct Similarity {
    pub scale: f64,
    pub rotation: Rotation3<f64>,
    pub shift: Vector3<f64>,
}

impl Default for Similarity {
    /// Everything stays where it is.
    fn default() -> Self {
        Self {
            scale: 1.0,
            rotation: Rotation3::identity(),
            shift: Vector3::zeros(),
        }
    }
}

/// The weighted mean of points.
fn middle(points: &[Point3<f64>], weights: &[f64]) -> Vector3<f64> {
    let weighted = points.iter().zip(weights).map(|(p, w)| p.coords * *w);
    weighted.fold(Vector3::zeros(), |a, b| a + b) / weights.iter().sum::<f64>()
}

/// Triples of points that are tried, at most.
const TRIPLES: usize = 300;

impl Similarity {
    /// Of a start and of what random triples of so many points fit the one of least cost (Fischler,
    /// Bolles 1981); `fitted` has none of triples that say too little.
    pub(super) fn of_triples(
        start: Self,
        seed: u64,
        points: usize,
        fitted: impl Fn([usize; 3]) -> Option<Self>,
        mut cost: impl FnMut(&Self) -> f64,
    ) -> Self {
        let mut random = Random::new(seed);
        let mut best = (cost(&start), start);
        for _ in 0..TRIPLES {
            if let Some(found) = fitted(random.sample::<3>(points)) {
                let cost = cost(&found);
                if cost < best.0 {
                    best = (cost, found);
                }
            }
        }
        best.1
    }

    /// The similarity of least weighted squares from points to others (Horn 1987; Umeyama 1991);
    /// `None` where the points do not differ. Points on a line leave the turn about it open.
    pub(super) fn between(
        from: &[Point3<f64>],
        to: &[Point3<f64>],
        weights: &[f64],
    ) -> Option<Self> {
        let (middle_from, middle_to) = (middle(from, weights), middle(to, weights));
        let (mut correlation, mut square) = (Matrix3::zeros(), 0.0);
        for ((a, b), w) in from.iter().zip(to).zip(weights) {
            let (a, b) = (a.coords - middle_from, b.coords - middle_to);
            correlation += a * b.transpose() * *w;
            square += w * a.norm_squared();
        }
        let is_spread = square > 0.0;
        if !is_spread {
            return None;
        }
        let rotation = rotation_between(&correlation);
        // trace(R a b^T) summed.
        let scale = (rotation.matrix() * correlation).trace() / square;
        Self::turned(scale, rotation, [middle_from, middle_to])
    }

    /// The similarity in x and y of least weighted squares that turns about z only, z being scaled
    /// alike; `None` where the points do not differ in plan.
    pub(super) fn in_plan(
        from: &[Point3<f64>],
        to: &[Point3<f64>],
        weights: &[f64],
    ) -> Option<Self> {
        let (middle_from, middle_to) = (middle(from, weights), middle(to, weights));
        let (mut along, mut across, mut square) = (0.0, 0.0, 0.0);
        for ((a, b), w) in from.iter().zip(to).zip(weights) {
            let (a, b) = (a.coords - middle_from, b.coords - middle_to);
            along += w * (a.x * b.x + a.y * b.y);
            across += w * a.cross(&b).z;
            square += w * (a.x * a.x + a.y * a.y);
        }
        let scale = math::hypot(along, across) / square;
        let turn = Vector3::z() * math::atan2(across, along);
        let rotation = rotation_from_axis_angle(&turn);
        Self::turned(scale, rotation, [middle_from, middle_to])
    }

    /// Of this scale and rotation, from one place to another; `None` of a scale that is none.
    fn turned(scale: f64, rotation: Rotation3<f64>, [from, to]: [Vector3<f64>; 2]) -> Option<Self> {
        (scale > 0.0 && scale.is_finite()).then(|| Self {
            scale,
            rotation,
            shift: to - rotation * from * scale,
        })
    }

    pub(super) fn point(&self, p: &Point3<f64>) -> Point3<f64> {
        Point3::from(self.rotation * p.coords * self.scale + self.shift)
    }

    pub(super) fn pose(&self, pose: &Pose) -> Pose {
        Pose {
            rotation: pose.rotation * self.rotation.inverse(),
            center: self.point(&pose.center),
        }
    }

    pub(super) fn apply(&self, block: &mut Block) {
        for photo in &mut block.photos {
            photo.pose = photo.pose.as_ref().map(|pose| self.pose(pose));
        }
        for track in &mut block.tracks {
            track.point = track.point.map(|p| self.point(&p));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::structure_from_motion::random::Random;

    #[test]
    fn a_planted_similarity_is_found() {
        let planted = Similarity {
            scale: 7.5,
            rotation: rotation_from_axis_angle(&Vector3::new(0.2, 1.4, -0.3)),
            shift: Vector3::new(300.0, -20.0, 8.0),
        };
        let mut random = Random::new(1);
        let from: Vec<Point3<f64>> = (0..6)
            .map(|_| Point3::from(Vector3::from_fn(|_, _| random.signed())))
            .collect();
        let to: Vec<Point3<f64>> = from.iter().map(|p| planted.point(p)).collect();
        let found = Similarity::between(&from, &to, &[1.0, 2.0, 1.0, 0.5, 1.0, 3.0]).unwrap();
        assert!((found.scale - 7.5).abs() < 1e-9);
        assert!((found.rotation.matrix() - planted.rotation.matrix()).norm() < 1e-9);
        assert!((found.shift - planted.shift).norm() < 1e-8);
        assert!(Similarity::between(&[from[0]; 3], &to[..3], &[1.0; 3]).is_none());
    }

    #[test]
    fn a_moved_pose_sees_moved_points_where_they_were() {
        let pose = Pose {
            rotation: rotation_from_axis_angle(&Vector3::new(0.4, -0.2, 2.0)),
            center: Point3::new(1.0, 2.0, 3.0),
        };
        let similarity = Similarity {
            scale: 3.0,
            rotation: rotation_from_axis_angle(&Vector3::new(-0.4, 0.7, 0.1)),
            shift: Vector3::new(9.0, 8.0, 7.0),
        };
        let world = Point3::new(-4.0, 5.0, 6.0);
        let before = pose.in_camera(&world);
        let after = similarity.pose(&pose).in_camera(&similarity.point(&world));
        assert!((after - before * 3.0).norm() < 1e-12);
    }
}
