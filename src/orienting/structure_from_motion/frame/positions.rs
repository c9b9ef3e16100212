//! Which similarity to stated positions can be true: in space, else in plan about the vertical of
//! angles or points.

use nalgebra::{Point3, Vector3};

use super::checks::{Doubt, Placement, doubts, tilt_sigma};
use super::places::{FEWEST_POSITIONS, Found, Places, TooNear};
use super::stated::{StatedPose, level};
use super::vertical::{AnglesFinding, turn_to_up, up_of_plane};
use crate::base::geometry::mean_point;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::similarity::Similarity;

/// Positions that are nearer to each other are one, metres: headers write no finer ones.
const ONE_PLACE_M: f64 = 1e-3;

/// Why stated positions give no frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NoPositions {
    /// Fewer than three.
    Few { stated: usize },
    /// All state one place.
    OnePlace { stated: usize },
    /// They differ by no more than their noise, metres.
    Near(TooNear),
    /// They fit only as in a mirror.
    Mirrored,
    /// This speaks against what fits.
    Doubted(Doubt),
}

/// The similarity that brings the block to its stated positions, with what speaks against one in
/// space where that in plan is taken instead.
pub(super) fn by_positions(
    block: &Block,
    stated: &[StatedPose],
    angles: &AnglesFinding,
) -> Result<(Similarity, Found, Option<Doubt>), NoPositions> {
    let places = Places::of(block, stated, None);
    let count = places.count();
    if count < FEWEST_POSITIONS {
        return Err(NoPositions::Few { stated: count });
    }
    let first = places.to[0];
    if places
        .to
        .iter()
        .all(|p| (p - first).xy().norm() < ONE_PLACE_M)
    {
        return Err(NoPositions::OnePlace { stated: count });
    }
    let mut doubt = None;
    if let Some((mut similarity, found, axis)) = places.in_space() {
        if found.is_levelled {
            let up = similarity.rotation * up_of(block, angles);
            level(&mut similarity, &mean_point(&places.to), &axis, &up);
        }
        doubt = asked(block, stated, angles, &places, &similarity, &found);
        if doubt.is_none() {
            return Ok((similarity, found, None));
        }
        if matches!(doubt, Some(Doubt::LooksUp { .. })) && is_mirrored(block, stated, angles) {
            return Err(NoPositions::Mirrored);
        }
    }
    let up = turn_to_up(&up_of(block, angles));
    let places = Places::of(block, stated, Some(up));
    let (similarity, found, _) = places.found().map_err(|why| {
        let is_mirrored = is_mirrored(block, stated, angles);
        if is_mirrored {
            NoPositions::Mirrored
        } else {
            NoPositions::Near(why)
        }
    })?;
    match asked(block, stated, angles, &places, &similarity, &found) {
        Some(why) => Err(NoPositions::Doubted(why)),
        None => Ok((similarity, found, doubt)),
    }
}

/// Do positions fit as in a mirror, with the cameras above what they show?
fn is_mirrored(block: &Block, stated: &[StatedPose], angles: &AnglesFinding) -> bool {
    let mirrored: Vec<StatedPose> = (stated.iter())
        .map(|s| StatedPose {
            position: s.position.map(|p| Point3::new(-p.x, p.y, p.z)),
            ..s.clone()
        })
        .collect();
    let up = turn_to_up(&up_of(block, angles));
    let places = [stated, &mirrored].map(|s| Places::of(block, s, Some(up)).found());
    match places {
        [Err(_), Ok(_)] => true,
        [Ok((_, a, _)), Ok((_, b, _))] => b.rms_m[0] < a.rms_m[0] && b.agreeing >= a.agreeing,
        _ => false,
    }
}

fn up_of(block: &Block, angles: &AnglesFinding) -> Vector3<f64> {
    let by_angles = angles.by_angles.as_ref();
    by_angles.map_or_else(|| up_of_plane(block), |angles| angles.up())
}

/// The first thing that speaks against a placement.
fn asked(
    block: &Block,
    stated: &[StatedPose],
    angles: &AnglesFinding,
    places: &Places,
    similarity: &Similarity,
    found: &Found,
) -> Option<Doubt> {
    let noise = places.sigma_m.max(found.rms_m[1]);
    let placement = Placement {
        block,
        similarity,
        stated,
        // What they level they cannot contradict.
        angles: angles.by_angles.as_ref().filter(|_| !found.is_levelled),
        tilt_sigma: tilt_sigma(&places.with_heights(), noise),
        control: None,
    };
    doubts(&placement).into_iter().next()
}
