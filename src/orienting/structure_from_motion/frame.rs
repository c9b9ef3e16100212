//! Metres and Z up: the block in a frame of the world, and what that rests on.
//!
//! Ground control points come before all of this ([`super::ground_control`]).
//!
//! 1. Stated positions (GPS), three or more that differ by more than their noise: a robust
//!    similarity to them. Heights of consumer receivers are off by tens of metres, all by the same,
//!    which no photograph contradicts. Along a single strip the turn about the strip is open, and
//!    follows from the angles or the plane below.
//! 2. Stated angles (XMP): their mean direction up. The scale is arbitrary.
//! 3. The main plane of the points is level. Scale and north are arbitrary.

use nalgebra::{Matrix3, Point3, Rotation3, SymmetricEigen, Vector3};

use super::block::Block;
use super::ground_control::ControlResidual;
use super::linear::rotation_between;
use super::random::Random;
use super::similarity::Similarity;
use crate::base::geometry::{mean_point, rotation_from_axis_angle};
use crate::base::least_squares::Loss;
use crate::base::math;
use crate::orienting::orientation::Anchor;

/// What is stated of a photograph in a frame east, north, up.
#[derive(Clone, Debug, Default)]
pub(super) struct StatedPose {
    pub position: Option<Point3<f64>>,
    /// `cam_from_world`.
    pub rotation: Option<Rotation3<f64>>,
}

/// What the frame of the world rests on.
#[derive(Clone, Debug, PartialEq)]
pub enum FrameBasis {
    /// Ground control points.
    Control {
        /// The reference system as it is stated.
        system: String,
        /// Its EPSG code, where coordinates are on a map.
        epsg: Option<u32>,
        /// Zero of the coordinates on the Earth, for longitudes and latitudes.
        anchor: Option<Anchor>,
        /// Coordinates on the map of the frame's zero, metres.
        offset: [f64; 3],
        /// The points.
        points: Vec<ControlResidual>,
        /// Root mean square residual of the agreeing ones, in plan and in height, metres.
        rms_m: [f64; 2],
    },
    /// Stated positions.
    Positions {
        /// Zero of the coordinates on the Earth.
        anchor: Anchor,
        /// Photographs whose positions agree.
        agreeing: usize,
        /// Photographs with a stated position.
        stated: usize,
        /// Root mean square distance of the agreeing ones, in plan and in height, metres.
        rms_m: [f64; 2],
        /// Is the turn about the line of flight from the plane of the points or from angles?
        is_levelled: bool,
    },
    /// Stated angles; the scale is arbitrary.
    Angles {
        /// Root mean square difference of the directions up, degrees.
        rms_deg: f64,
    },
    /// The main plane of the points; scale and north are arbitrary.
    MainPlane,
}

/// Noise of a consumer receiver, metres.
const POSITION_NOISE_M: f64 = 2.0;

/// Samples of three positions.
const SAMPLES: usize = 300;

/// Height of the mean photograph above the mean point where nothing states the scale, metres.
const ASSUMED_HEIGHT_M: f64 = 100.0;

/// Turns, scales and shifts the block into its frame.
pub(super) fn to_frame(
    block: &mut Block,
    stated: &[StatedPose],
    anchor: Option<Anchor>,
) -> FrameBasis {
    let by_positions = anchor.and_then(|anchor| by_positions(block, stated, anchor));
    if let Some(basis) = by_positions {
        return basis;
    }
    let (up, basis) = match up_of_angles(block, stated) {
        Some((turn, rms_deg)) => (turn, FrameBasis::Angles { rms_deg }),
        None => (turn_to_up(&up_of_plane(block)), FrameBasis::MainPlane),
    };
    turn(block, &up);
    let (cameras, points) = (centers(block), points(block));
    let (camera, point) = (mean_point(&cameras), mean_point(&points));
    let scale = ASSUMED_HEIGHT_M / (camera.z - point.z).abs().max(1e-9);
    let ground = Point3::new(camera.x, camera.y, point.z);
    let similarity = Similarity {
        scale,
        rotation: Rotation3::identity(),
        shift: -ground.coords * scale,
    };
    similarity.apply(block);
    basis
}

fn centers(block: &Block) -> Vec<Point3<f64>> {
    let poses = block.photos.iter().filter_map(|p| p.pose.as_ref());
    poses.map(|pose| pose.center).collect()
}

fn points(block: &Block) -> Vec<Point3<f64>> {
    block.tracks.iter().filter_map(|t| t.point).collect()
}

fn turn(block: &mut Block, rotation: &Rotation3<f64>) {
    let similarity = Similarity {
        scale: 1.0,
        rotation: *rotation,
        shift: Vector3::zeros(),
    };
    similarity.apply(block);
}

fn by_positions(block: &mut Block, stated: &[StatedPose], anchor: Anchor) -> Option<FrameBasis> {
    let both: Vec<(Point3<f64>, Point3<f64>)> = (block.photos.iter().zip(stated))
        .filter_map(|(photo, stated)| Some((photo.pose.as_ref()?.center, stated.position?)))
        .collect();
    let (from, to): (Vec<_>, Vec<_>) = both.iter().copied().unzip();
    if both.len() < 3 {
        return None;
    }
    let (similarity, weights) = robust_similarity(&from, &to)?;
    let agreeing: Vec<usize> = (0..both.len()).filter(|&i| weights[i] > 0.25).collect();
    let (mut plan, mut height) = (0.0, 0.0);
    for &i in &agreeing {
        let d = similarity.point(&from[i]) - to[i];
        plan += d.x * d.x + d.y * d.y;
        height += d.z * d.z;
    }
    let rms_m = [plan, height].map(|sum: f64| (sum / agreeing.len() as f64).sqrt());
    let spread = spread(&agreeing.iter().map(|&i| to[i]).collect::<Vec<_>>());
    let noise = POSITION_NOISE_M.max(math::hypot(rms_m[0], rms_m[1]));
    if agreeing.len() < 3 || spread.lengths[0] < 2.0 * noise {
        return None;
    }
    similarity.apply(block);
    let is_levelled = spread.lengths[1] < 2.0 * noise;
    if is_levelled {
        let up = match up_of_angles(block, stated) {
            Some((turn, _)) => turn.inverse() * Vector3::z(),
            None => up_of_plane(block),
        };
        let middle = mean_point(&to);
        level(block, &middle, &spread.axis, &up);
    }
    Some(FrameBasis::Positions {
        anchor,
        agreeing: agreeing.len(),
        stated: both.len(),
        rms_m,
        is_levelled,
    })
}

/// Similarity from random triples by the least median of distances (Rousseeuw 1984), then weighted
/// anew while it settles; with the last weights.
fn robust_similarity(from: &[Point3<f64>], to: &[Point3<f64>]) -> Option<(Similarity, Vec<f64>)> {
    let n = from.len();
    let distances = |s: &Similarity| -> Vec<f64> {
        from.iter()
            .zip(to)
            .map(|(a, b)| (s.point(a) - b).norm())
            .collect()
    };
    let mut best = Similarity::between(from, to, &vec![1.0; n])?;
    let median = |s: &Similarity| math::median(&mut distances(s)).unwrap_or(f64::INFINITY);
    let mut least = median(&best);
    let mut random = Random::new(7);
    for _ in 0..SAMPLES {
        let sample = random.sample::<3>(n);
        let pick = |points: &[Point3<f64>]| sample.map(|i| points[i]);
        // Triples near one line say nothing of the turn about it.
        if spread(&pick(to)).lengths[1] < POSITION_NOISE_M {
            continue;
        }
        if let Some(s) = Similarity::between(&pick(from), &pick(to), &[1.0; 3]) {
            let m = median(&s);
            if m < least {
                (best, least) = (s, m);
            }
        }
    }
    let mut weights = vec![1.0; n];
    for _ in 0..20 {
        let scale = 2.0 * math::median(&mut distances(&best))?.max(0.1 * POSITION_NOISE_M);
        weights = distances(&best)
            .iter()
            .map(|d| Loss::Cauchy(scale).weight(d * d))
            .collect();
        best = Similarity::between(from, to, &weights)?;
    }
    Some((best, weights))
}

/// How far points spread along their main axes.
pub(super) struct Spread {
    /// Standard deviations, the largest first.
    pub lengths: [f64; 3],
    /// Direction of the largest one.
    axis: Vector3<f64>,
    /// Direction of the least one.
    normal: Vector3<f64>,
}

pub(super) fn spread(points: &[Point3<f64>]) -> Spread {
    let middle = mean_point(points);
    let square = points.iter().fold(Matrix3::zeros(), |sum, p| {
        let d = p - middle;
        sum + d * d.transpose()
    });
    let eigen = SymmetricEigen::new(square / points.len() as f64);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    Spread {
        lengths: order.map(|i| eigen.eigenvalues[i].max(0.0).sqrt()),
        axis: eigen.eigenvectors.column(order[0]).into_owned(),
        normal: eigen.eigenvectors.column(order[2]).into_owned(),
    }
}

/// The rotation that brings the block's axes to east, north, up by the stated angles, and the root
/// mean square difference of the directions up, degrees.
fn up_of_angles(block: &Block, stated: &[StatedPose]) -> Option<(Rotation3<f64>, f64)> {
    let world_from_block: Vec<Rotation3<f64>> = (block.photos.iter().zip(stated))
        .filter_map(|(photo, stated)| {
            Some(stated.rotation?.inverse() * photo.pose.as_ref()?.rotation)
        })
        .collect();
    if world_from_block.len() < 2 {
        return None;
    }
    // The mean in the sense of the chordal distance.
    let sum = world_from_block
        .iter()
        .fold(Matrix3::zeros(), |s, r| s + r.matrix());
    let mean = rotation_between(&sum.transpose());
    let up = mean * Vector3::z();
    let squares = world_from_block.iter().map(|r| {
        let angle = math::acos((r * (mean.inverse() * Vector3::z())).z.clamp(-1.0, 1.0));
        angle * angle
    });
    let rms = (squares.sum::<f64>() / world_from_block.len() as f64).sqrt();
    up.z.is_finite().then_some((mean, rms.to_degrees()))
}

/// The normal of the points' main plane, on the side of the cameras.
fn up_of_plane(block: &Block) -> Vector3<f64> {
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
fn turn_to_up(up: &Vector3<f64>) -> Rotation3<f64> {
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

/// Turns the block about an axis through a point until a direction is as steep as it can be.
fn level(block: &mut Block, middle: &Point3<f64>, axis: &Vector3<f64>, up: &Vector3<f64>) {
    let across = |v: &Vector3<f64>| v - axis * axis.dot(v);
    let (from, to) = (across(up), across(&Vector3::z()));
    let angle = math::atan2(from.cross(&to).dot(axis), from.dot(&to));
    let rotation = rotation_from_axis_angle(&(axis * angle));
    let similarity = Similarity {
        scale: 1.0,
        rotation,
        shift: middle.coords - rotation * middle.coords,
    };
    similarity.apply(block);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::structure_from_motion::bundle::tests::planted;
    use crate::orienting::structure_from_motion::random::Random;

    const ANCHOR: Anchor = Anchor {
        lon_deg: 8.4,
        lat_deg: 49.0,
        height_m: 0.0,
    };

    /// A block in a frame of its own, and what the photographs state of their poses.
    fn moved() -> (Block, Block, Vec<StatedPose>) {
        let truth = planted(0.1, 3);
        let mut random = Random::new(5);
        let stated = (truth.photos.iter())
            .map(|p| {
                let pose = p.pose.as_ref().unwrap();
                let noise = Vector3::from_fn(|_, _| 0.3 * random.normal());
                StatedPose {
                    position: Some(pose.center + noise + Vector3::z() * 37.0),
                    rotation: Some(pose.rotation),
                }
            })
            .collect();
        let mut block = truth.clone();
        let similarity = Similarity {
            scale: 0.02,
            rotation: rotation_from_axis_angle(&Vector3::new(1.2, -0.7, 0.5)),
            shift: Vector3::new(0.3, 0.1, 4.0),
        };
        similarity.apply(&mut block);
        (truth, block, stated)
    }

    /// Largest distance of the centres in plan, and angle between the vertical directions.
    fn off(block: &Block, truth: &Block) -> (f64, f64) {
        let mut off = (0.0f64, 0.0f64);
        for (a, b) in block.photos.iter().zip(&truth.photos) {
            let (a, b) = (a.pose.as_ref().unwrap(), b.pose.as_ref().unwrap());
            let d = a.center - b.center;
            off.0 = off.0.max(math::hypot(d.x, d.y));
            let up = a.rotation.inverse() * (b.rotation * Vector3::z());
            off.1 = off.1.max(math::acos(up.z.min(1.0)));
        }
        off
    }

    #[test]
    fn stated_positions_give_metres_though_one_is_wrong() {
        let (truth, mut block, mut stated) = moved();
        stated[4].position = stated[4]
            .position
            .map(|p| p + Vector3::new(60.0, -20.0, 9.0));
        let basis = to_frame(&mut block, &stated, Some(ANCHOR));
        let FrameBasis::Positions {
            agreeing,
            stated,
            is_levelled,
            ..
        } = basis
        else {
            panic!("{basis:?}")
        };
        assert_eq!((agreeing, stated, is_levelled), (8, 9, false));
        let (plan, tilt) = off(&block, &truth);
        assert!(plan < 0.8 && tilt < 0.03, "{plan} {tilt}");
    }

    #[test]
    fn a_single_strip_is_levelled() {
        let (truth, mut block, mut stated) = moved();
        for one in &mut stated[3..] {
            *one = StatedPose::default();
        }
        for (i, one) in stated[..3].iter_mut().enumerate() {
            let pose = truth.photos[i].pose.as_ref().unwrap();
            one.position = Some(pose.center);
            one.rotation = None;
        }
        let basis = to_frame(&mut block, &stated, Some(ANCHOR));
        assert!(
            matches!(
                basis,
                FrameBasis::Positions {
                    is_levelled: true,
                    ..
                }
            ),
            "{basis:?}"
        );
        let (_, tilt) = off(&block, &truth);
        assert!(tilt < 0.2, "{tilt}");
    }

    #[test]
    fn without_positions_angles_or_the_ground_say_where_up_is() {
        let (truth, block, mut stated) = moved();
        stated.iter_mut().for_each(|s| s.position = None);
        let mut by_angles = block.clone();
        let basis = to_frame(&mut by_angles, &stated, None);
        assert!(
            matches!(basis, FrameBasis::Angles { rms_deg } if rms_deg < 0.01),
            "{basis:?}"
        );
        assert!(off(&by_angles, &truth).1 < 1e-4);
        stated.iter_mut().for_each(|s| s.rotation = None);
        let mut by_plane = block;
        assert_eq!(
            to_frame(&mut by_plane, &stated, None),
            FrameBasis::MainPlane
        );
        let heights: Vec<f64> = centers(&by_plane).iter().map(|c| c.z).collect();
        assert!(
            heights.iter().all(|h| (80.0..120.0).contains(h)),
            "{heights:?}"
        );
        let off: f64 = (by_plane.photos.iter().zip(&truth.photos))
            .map(|(a, b)| {
                let [a, b] = [a, b].map(|p| p.pose.as_ref().unwrap().rotation * Vector3::z());
                a.z - b.z
            })
            .fold(0.0, |m, d| m.max(d.abs()));
        assert!(off < 0.05, "{off}");
    }
}
