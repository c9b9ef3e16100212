//! Which similarity to stated positions can be true: in space, else in plan about the vertical of
//! angles or points.

use nalgebra::{Point3, Vector3};

use super::checks::{Doubt, Placement, doubts, tilt_sigma};
use super::places::{Found, Places, TooNear};
use super::stated::{StatedPose, level, without_heights};
use super::vertical::{AnglesFinding, turn_to_up, up_of_plane};
use crate::base::geometry::mean_point;
use crate::base::math;
use crate::orienting::orientation::{Anchor, LinearUnit, geocentric_of};
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::similarity::{FEWEST_POINTS, Similarity};

/// Positions that are nearer to each other are one, metres: headers write no finer ones.
const ONE_PLACE_M: f64 = 1e-3;

/// Why stated positions give no frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NoPositions {
    /// Fewer than three.
    Few { stated: usize },
    /// They fit with latitude and longitude exchanged.
    Exchanged,
    /// All state one place.
    OnePlace { stated: usize },
    /// They differ by no more than their noise, metres.
    Near(TooNear),
    /// They fit only as in a mirror.
    Mirrored,
    /// This speaks against what fits.
    Doubted(Doubt),
}

/// A similarity with what was found of it and what is doubtful; else why there is none.
pub(super) type Placed = Result<(Similarity, Found, Option<Doubt>), NoPositions>;

/// The similarity that brings the block to its stated positions, with what speaks against one in
/// space where that in plan is taken instead.
pub(super) fn by_positions(block: &Block, stated: &[StatedPose], angles: &AnglesFinding) -> Placed {
    let places = Places::of(block, stated, None);
    let count = places.count();
    if count < FEWEST_POINTS {
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

/// Longitude, latitude (degrees) and height (metres) of a position.
type Geographic = [f64; 3];

/// A usual mistake of stated positions.
pub(super) struct Mistake {
    pub words: &'static str,
    /// Is it in the heights alone?
    pub is_of_heights: bool,
    meant: fn(Geographic) -> Geographic,
    /// Lengths in height as they were meant, of those that are stated.
    factor: f64,
}

const MISTAKES: [Mistake; 3] = [
    Mistake {
        words: "latitude and longitude exchanged",
        is_of_heights: false,
        meant: |[lon, lat, height]| [lat, lon, height],
        factor: 1.0,
    },
    Mistake {
        words: "heights in feet",
        is_of_heights: true,
        meant: |[lon, lat, height]| [lon, lat, height * LinearUnit::FOOT.metres],
        factor: LinearUnit::FOOT.metres,
    },
    Mistake {
        words: "heights of the other sign",
        is_of_heights: true,
        meant: |[lon, lat, height]| [lon, lat, -height],
        factor: 1.0,
    },
];

/// A mistake explains positions that fit so many times as well without it.
const CLEARLY_BETTER: f64 = 3.0;

/// The similarity to what is true of stated positions, and the usual mistake that explains why the
/// rest of them does not fit.
pub(super) fn by_true_positions(
    block: &Block,
    stated: &[StatedPose],
    anchor: &Anchor,
    angles: &AnglesFinding,
) -> (Placed, Option<&'static Mistake>) {
    let found = by_positions(block, stated, angles);
    let mistake = mistake_of(block, stated, anchor, angles, &found);
    let found = match mistake {
        None => found,
        Some(mistake) if mistake.is_of_heights => {
            by_positions(block, &without_heights(stated), angles)
        }
        Some(_) => Err(NoPositions::Exchanged),
    };
    (found, mistake)
}

/// The usual mistake that explains why stated positions do not fit as they are.
fn mistake_of(
    block: &Block,
    stated: &[StatedPose],
    anchor: &Anchor,
    angles: &AnglesFinding,
    found: &Placed,
) -> Option<&'static Mistake> {
    let noise_m = Places::of(block, stated, None).sigma_m;
    let miss_m = |found: &Found, factor: f64| math::hypot(found.rms_m[0], found.rms_m[1] / factor);
    let (least, most_m) = match found {
        Ok((_, found, None)) => {
            let miss_m = miss_m(found, 1.0);
            if found.agreeing == found.stated[0] && miss_m <= noise_m {
                return None;
            }
            (
                found.agreeing,
                math::smaller(miss_m / CLEARLY_BETTER, noise_m),
            )
        }
        _ => (FEWEST_POINTS, noise_m),
    };
    MISTAKES.iter().find(|mistake| {
        let meant = as_meant(stated, anchor, mistake.meant);
        by_positions(block, &meant, angles).is_ok_and(|(_, found, doubt)| {
            let is_near = miss_m(&found, mistake.factor) < most_m;
            doubt.is_none() && found.agreeing >= least && is_near
        })
    })
}

/// Positions as they were meant, in a frame that touches the Earth there.
fn as_meant(
    stated: &[StatedPose],
    anchor: &Anchor,
    meant: fn(Geographic) -> Geographic,
) -> Vec<StatedPose> {
    let place = |s: &StatedPose| {
        let [lon, lat, height] = meant(anchor.geographic(&s.position?));
        (lat.abs() <= 90.0).then(|| geocentric_of(lon, lat, height))
    };
    let places: Vec<Option<Point3<f64>>> = stated.iter().map(place).collect();
    let known: Vec<Point3<f64>> = places.iter().copied().flatten().collect();
    let zero = Anchor::near(&mean_point(&known));
    let moved = (stated.iter().zip(places)).map(|(s, place)| StatedPose {
        position: place.map(|place| zero.local(&place)),
        ..s.clone()
    });
    moved.collect()
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
