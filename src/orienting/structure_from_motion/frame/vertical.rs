//! Up: by the angles that photographs state, or by the plane of the points.
//!
//! Angles of a few photographs may contradict the others by any turn, and all may share one
//! mistake, so that a mean says nothing. Those count whose vertical is within 45 degrees of the
//! normal of the points' main plane and agrees with the middle one of them.

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use super::stated::{StatedPose, centers, points, spread};
use crate::base::geometry::{mean_point, rotation_from_axis_angle};
use crate::base::math::{self, SURE_RESIDUAL_SIGMAS};
use crate::orienting::orientation::rotation_from_yaw_pitch_roll;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::linear::rotation_between;

/// Cosine of 45 degrees: where the normal of the points' plane is farther than that from a
/// vertical, the plane is nearer to a wall than to the ground.
pub(super) const NEARER_TO_A_WALL: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Standard deviation of a stated angle, radians. Assumption: makers promise the angles of a gimbal
/// to a hundredth of a degree against its own level, which is good to a degree.
const ANGLE_SIGMA: f64 = std::f64::consts::PI / 180.0;

/// Yaw, pitch and roll in degrees, where they may be of a mistake, as they were meant.
type Meant = fn([f64; 3]) -> Option<[f64; 3]>;

/// Usual mistakes in the angles of a photograph, the likelier first.
const MISTAKES: [(&str, Meant); 6] = [
    (
        "a roll of 180 degrees, the yaw turned by as much, of cameras that were not turned over",
        { |[y, p, r]| (r.abs() > 90.0).then_some([y + 180.0, p, r + 180.0]) },
    ),
    (
        "a roll of 180 degrees of cameras that were not turned over",
        { |[y, p, r]| (r.abs() > 90.0).then_some([y, p, r + 180.0]) },
    ),
    ("a pitch of the other sign, positive downwards", {
        |[y, p, r]| (p > 0.0).then_some([y, -p, r])
    }),
    (
        "a pitch counted from straight down instead of from the horizon",
        { |[y, p, r]| Some([y, p - 90.0, r]) },
    ),
    (
        "a pitch counted from the horizon where this camera's is counted from straight down",
        { |[y, p, r]| (p < -90.0).then_some([y, p + 90.0, r]) },
    ),
    ("angles in radians instead of degrees", {
        |angles| {
            let is_turn = |v: f64| v.abs() <= std::f64::consts::TAU;
            angles
                .into_iter()
                .all(is_turn)
                .then(|| angles.map(f64::to_degrees))
        }
    }),
];

/// The vertical by stated angles.
#[derive(Clone, Debug)]
pub(in super::super) struct ByAngles {
    /// Brings the block's axes to east, north, up.
    pub turn: Rotation3<f64>,
    /// Root mean square difference of the directions up of those that agree, radians.
    pub rms: f64,
    /// Photographs that agree, and those that state angles.
    pub photos: [Vec<usize>; 2],
}

impl ByAngles {
    /// Up in the block.
    pub(super) fn up(&self) -> Vector3<f64> {
        self.turn.inverse() * Vector3::z()
    }

    /// Standard deviation of the vertical, radians: what single angles have in common stays.
    pub(super) fn sigma(&self) -> f64 {
        self.rms.max(ANGLE_SIGMA)
    }
}

/// What stated angles say, and what is wrong with those that do not agree.
#[derive(Clone, Debug, Default)]
pub(super) struct AnglesFinding {
    pub by_angles: Option<ByAngles>,
    /// Photographs whose angles the others or the points contradict.
    pub contradicted: Vec<usize>,
    /// The usual mistake that explains all of them.
    pub mistake: Option<&'static str>,
}

/// The vertical by the angles that agree with the points and with each other; with `is_mended`
/// those that a usual mistake explains count as they were meant.
pub(super) fn up_of_angles(block: &Block, stated: &[StatedPose], is_mended: bool) -> AnglesFinding {
    let turns = turns(block, stated, |s| s.rotation);
    if turns.is_empty() {
        return AnglesFinding::default();
    }
    let normal = up_of_plane(block);
    let agreed = agreement(&turns, &normal, NEARER_TO_A_WALL);
    let contradicted: Vec<usize> = (turns.iter())
        .filter(|(i, turn)| match &agreed {
            Some(found) => !found.photos[0].contains(i),
            None => up_by(turn).dot(&normal) <= NEARER_TO_A_WALL,
        })
        .map(|(i, _)| *i)
        .collect();
    let contradicted = match (&agreed, contradicted.is_empty()) {
        // All are near the ground's vertical, and far from each other.
        (None, true) => turns.iter().map(|(i, _)| *i).collect(),
        _ => contradicted,
    };
    let explained = MISTAKES.iter().filter_map(|(words, meant)| {
        let mended: Vec<(usize, Rotation3<f64>)> =
            turns_as(block, stated, |i, s| match contradicted.contains(&i) {
                true => Some(rotation_of_angles(meant(s.yaw_pitch_roll?)?)),
                false => s.rotation,
            });
        let found = agreement(&mended, &normal, NEARER_TO_A_WALL)?;
        // All of them, or it is no explanation.
        (found.photos[0].len() == turns.len()).then(|| (spread_of(&mended, &found), *words, found))
    });
    // Of two that mean the same the first: they differ by rounding.
    let closer = |a: f64, b: f64| a < b - ANGLE_SIGMA;
    let explained = (explained.filter(|_| !contradicted.is_empty()))
        .reduce(|best, next| if closer(next.0, best.0) { next } else { best });
    // The plane of the points may be a wall: angles that most share count then, if no mistake
    // brings them to the ground, and unless they turn the block over.
    let before_a_wall = || {
        let found = agreement(&turns, &normal, -NEARER_TO_A_WALL)?;
        (2 * found.photos[0].len() > turns.len()).then_some(found)
    };
    if let (None, None, Some(found)) = (&agreed, &explained, before_a_wall()) {
        let is_other = |i: &usize| !found.photos[0].contains(i);
        return AnglesFinding {
            contradicted: turns.iter().map(|(i, _)| *i).filter(is_other).collect(),
            by_angles: Some(found),
            mistake: None,
        };
    }
    let mistake = explained.as_ref().map(|(_, words, _)| *words);
    AnglesFinding {
        by_angles: match explained {
            Some((_, _, found)) if is_mended => Some(found),
            _ => agreed,
        },
        contradicted,
        mistake,
    }
}

/// `cam_from_world` of yaw, pitch (-90 down) and roll, degrees.
pub(in super::super) fn rotation_of_angles(yaw_pitch_roll: [f64; 3]) -> Rotation3<f64> {
    let [yaw, pitch, roll] = yaw_pitch_roll.map(f64::to_radians);
    rotation_from_yaw_pitch_roll(yaw, pitch + std::f64::consts::FRAC_PI_2, roll)
}

/// `world_from_block` by each photograph.
fn turns(
    block: &Block,
    stated: &[StatedPose],
    rotation: impl Fn(&StatedPose) -> Option<Rotation3<f64>>,
) -> Vec<(usize, Rotation3<f64>)> {
    turns_as(block, stated, |_, s| rotation(s))
}

fn turns_as(
    block: &Block,
    stated: &[StatedPose],
    rotation: impl Fn(usize, &StatedPose) -> Option<Rotation3<f64>>,
) -> Vec<(usize, Rotation3<f64>)> {
    (block.photos.iter().zip(stated).enumerate())
        .filter_map(|(i, (photo, s))| {
            let cam_from_block = photo.pose.as_ref()?.rotation;
            Some((i, rotation(i, s)?.inverse() * cam_from_block))
        })
        .collect()
}

/// Those that agree, at least two and half of all, with verticals whose cosine with the normal of
/// the points' plane is not less than this.
fn agreement(
    turns: &[(usize, Rotation3<f64>)],
    normal: &Vector3<f64>,
    least_cosine: f64,
) -> Option<ByAngles> {
    let ups: Vec<(usize, Vector3<f64>)> = (turns.iter().map(|(i, r)| (*i, up_by(r))))
        .filter(|(_, up)| up.dot(normal) > least_cosine)
        .collect();
    let from = |middle: &Vector3<f64>| -> Vec<f64> {
        ups.iter()
            .map(|(_, up)| angle_between(up, middle))
            .collect()
    };
    let middle = (ups.iter())
        .map(|(_, up)| (from(up).iter().sum::<f64>(), up))
        .min_by(|a, b| a.0.total_cmp(&b.0))?
        .1;
    let scale = math::median(&mut from(middle))?.max(ANGLE_SIGMA);
    // However far they scatter, what is nearer to the horizon than to their middle does not agree.
    let most = math::smaller(SURE_RESIDUAL_SIGMAS * scale, math::acos(NEARER_TO_A_WALL));
    let agreeing: Vec<usize> = (ups.iter().zip(from(middle)))
        .filter_map(|((i, _), angle)| (angle <= most).then_some(*i))
        .collect();
    if agreeing.len() < 2 || 2 * agreeing.len() < turns.len() {
        return None;
    }
    // The mean in the sense of the chordal distance.
    let kept = turns.iter().filter(|(i, _)| agreeing.contains(i));
    let sum = kept.fold(Matrix3::zeros(), |s, (_, r)| s + r.matrix());
    let turn = rotation_between(&sum.transpose());
    let mean = turn.inverse() * Vector3::z();
    if !mean.z.is_finite() {
        return None;
    }
    let agree = ups.iter().filter(|(i, _)| agreeing.contains(i));
    let squares = agree.map(|(_, up)| angle_between(up, &mean)).map(|a| a * a);
    Some(ByAngles {
        turn,
        rms: (squares.sum::<f64>() / agreeing.len() as f64).sqrt(),
        photos: [agreeing, turns.iter().map(|(i, _)| *i).collect()],
    })
}

/// Up in the block by a photograph.
fn up_by(world_from_block: &Rotation3<f64>) -> Vector3<f64> {
    world_from_block.inverse() * Vector3::z()
}

/// How far the turns themselves are from the common one: mistakes of the yaw show here.
fn spread_of(turns: &[(usize, Rotation3<f64>)], found: &ByAngles) -> f64 {
    let off = |r: &Rotation3<f64>| (r.matrix() - found.turn.matrix()).norm();
    turns.iter().map(|(_, r)| off(r)).sum()
}

/// Angle between two directions, radians.
pub(super) fn angle_between(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    math::atan2(a.cross(b).norm(), a.dot(b))
}

/// The normal of the points' main plane, on the side of the cameras.
pub(super) fn up_of_plane(block: &Block) -> Vector3<f64> {
    let all = points(block);
    let mut kept = all.clone();
    // Points far from the plane leave it.
    for _ in 0..10 {
        let (s, middle) = (spread(&kept), mean_point(&kept));
        let distance = |p: &Point3<f64>| (p - middle).dot(&s.normal).abs();
        let mut distances: Vec<f64> = all.iter().map(distance).collect();
        let most = 3.0 * math::median(&mut distances).unwrap_or(0.0);
        let near: Vec<Point3<f64>> = all
            .iter()
            .filter(|p| distance(p) <= most)
            .copied()
            .collect();
        if near.len() < 3 {
            break;
        }
        kept = near;
    }
    let normal = spread(&kept).normal;
    let towards = mean_point(&centers(block)) - mean_point(&kept);
    if towards.dot(&normal) < 0.0 {
        -normal
    } else {
        normal
    }
}

/// A rotation that brings a direction to Z.
pub(in super::super) fn turn_to_up(up: &Vector3<f64>) -> Rotation3<f64> {
    let axis = up.cross(&Vector3::z());
    let angle = math::atan2(axis.norm(), up.z);
    match axis.try_normalize(1e-12) {
        Some(axis) => rotation_from_axis_angle(&(axis * angle)),
        None if up.z < 0.0 => {
            rotation_from_axis_angle(&Vector3::new(std::f64::consts::PI, 0.0, 0.0))
        }
        None => Rotation3::identity(),
    }
}
