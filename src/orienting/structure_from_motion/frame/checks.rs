//! Can a placement be true? One list of questions to every frame, however it was found: do cameras
//! look down on what they show, is the vertical that of stated angles, do scale and place of
//! control points agree with the positions in the headers.
//!
//! A similarity fits mirrored points that are level by turning the block over, and leaves no
//! residual: so exchanged axes and missing letters of a hemisphere show here only.

use nalgebra::{Point3, Vector3};

use super::places::{RECEIVER_SIGMA_M, upright_fit};
use super::stated::{StatedPose, spread};
use super::vertical::{ByAngles, NEARER_TO_A_WALL, angle_between};
use crate::base::math::{self, SURE_RESIDUAL_SIGMAS};
use crate::orienting::orientation::{Anchor, MOST_DATUM_M, geocentric_of};
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::similarity::Similarity;

/// A block in its own axes, the similarity that is to place it, and what else is known.
pub(in super::super) struct Placement<'a> {
    pub block: &'a Block,
    pub similarity: &'a Similarity,
    pub stated: &'a [StatedPose],
    pub angles: Option<&'a ByAngles>,
    /// Standard deviation of the placement's vertical, radians.
    pub tilt_sigma: f64,
    /// Where control points place the block.
    pub control: Option<ByControl<'a>>,
}

/// What can be held against the positions in the headers.
#[derive(Clone, Copy)]
pub(in super::super) struct ByControl<'a> {
    /// Zero of those positions.
    pub anchor: Option<Anchor>,
    /// Longitude and latitude of a point of the frame, degrees, where its system is known.
    pub on_earth: &'a dyn Fn(&Point3<f64>) -> Option<[f64; 2]>,
    /// Height of the photographs above those in their headers, metres.
    pub above_headers_m: Option<f64>,
}

/// What speaks against a placement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) enum Doubt {
    /// Photographs that look up at what they show, of those with an orientation.
    LooksUp {
        photos: usize,
        of: usize,
        is_steep: bool,
    },
    /// The vertical is so far from that of stated angles, degrees.
    OffAngles { deg: f64, photos: usize },
    /// Distances are so many times those between positions in the headers.
    OtherScale { factor: f64 },
    /// So far from the positions in the headers, metres.
    Elsewhere { metres: f64 },
    /// So far above the heights in the headers, metres.
    OtherHeight { metres: f64 },
}

/// No datum is as far from that of the receivers, metres: Tokyo's is off by 450 m.
const OTHER_PLACE_M: f64 = 1000.0;

/// Neither a map nor a receiver changes distances by as much: where control points and headers
/// differ by more, the marks or the coordinates are others.
const OTHER_SCALE: f64 = 1.1;

const CHECKS: [fn(&Placement) -> Option<Doubt>; 5] =
    [looks_up, off_angles, other_scale, elsewhere, other_height];

/// All that speaks against a placement.
pub(in super::super) fn doubts(placement: &Placement) -> Vec<Doubt> {
    CHECKS.iter().filter_map(|check| check(placement)).collect()
}

impl Doubt {
    /// Can a placement not be true with it, whatever else is known?
    pub(in super::super) fn is_impossible(&self) -> bool {
        match self {
            Self::LooksUp { is_steep, .. } => *is_steep,
            Self::OtherScale { factor } => math::ln(*factor).abs() > math::ln(OTHER_SCALE),
            _ => false,
        }
    }

    /// In words that follow the name of what gave the placement.
    pub(in super::super) fn words(&self) -> String {
        match self {
            Self::LooksUp { photos, of, .. } => {
                format!("put {photos} of {of} photographs below what they show, looking up")
            }
            Self::OffAngles { deg, photos } => format!(
                "give a vertical that is {deg:.0} degrees from that of the angles of {photos} \
                 photographs"
            ),
            Self::OtherScale { factor } => format!(
                "put the photographs {factor:.3} times as far apart as the positions in their \
                 headers are"
            ),
            Self::Elsewhere { metres } => format!(
                "lie {:.0} km from the positions in the headers",
                metres / 1000.0
            ),
            Self::OtherHeight { metres } => format!(
                "lie {:.0} m {} the heights in the headers, and no datums of heights are as far apart",
                metres.abs(),
                if *metres < 0.0 { "below" } else { "above" }
            ),
        }
    }
}

/// Most photographs look up at the middle of what they show.
fn looks_up(p: &Placement) -> Option<Doubt> {
    let up = p.similarity.rotation.inverse() * Vector3::z();
    let mut steep: Vec<Vec<f64>> = vec![Vec::new(); p.block.photos.len()];
    for track in &p.block.tracks {
        let Some(point) = track.point else { continue };
        for o in track.used() {
            if let Some(pose) = &p.block.photos[o.photo].pose {
                let ray = point - pose.center;
                steep[o.photo].push(ray.dot(&up) / ray.norm());
            }
        }
    }
    let sines: Vec<f64> = steep.iter_mut().filter_map(|s| math::median(s)).collect();
    let count = |least: f64| sines.iter().filter(|s| **s > least).count();
    (2 * count(0.0) > sines.len()).then(|| Doubt::LooksUp {
        photos: count(0.0),
        of: sines.len(),
        // From there on a camera looks at the zenith rather than at a wall: no roof is seen so.
        is_steep: 2 * count(NEARER_TO_A_WALL) > sines.len(),
    })
}

fn off_angles(p: &Placement) -> Option<Doubt> {
    let angles = p.angles?;
    let up = p.similarity.rotation.inverse() * Vector3::z();
    let off = angle_between(&up, &angles.up());
    let sigma = math::hypot(angles.sigma(), p.tilt_sigma);
    (off > SURE_RESIDUAL_SIGMAS * sigma).then(|| Doubt::OffAngles {
        deg: off.to_degrees(),
        photos: angles.photos[0].len(),
    })
}

fn other_scale(p: &Placement) -> Option<Doubt> {
    p.control?;
    let (similarity, found) = upright_fit(p.block, p.stated, &p.similarity.rotation)?;
    // Of a scale by so many positions of this noise that spread so far.
    let sigma =
        RECEIVER_SIGMA_M.max(found.rms_m[0]) / (found.spread_m * (found.agreeing as f64).sqrt());
    let factor = p.similarity.scale / similarity.scale;
    let off = math::ln(factor).abs();
    (off > SURE_RESIDUAL_SIGMAS * sigma).then_some(Doubt::OtherScale { factor })
}

fn elsewhere(p: &Placement) -> Option<Doubt> {
    let control = p.control?;
    let anchor = control.anchor?;
    let placed = (p.block.photos.iter().zip(p.stated)).filter_map(|(photo, stated)| {
        let place = p.similarity.point(&photo.pose.as_ref()?.center);
        let [lon, lat] = (control.on_earth)(&place)?;
        let [own_lon, own_lat, _] = anchor.geographic(&stated.position?);
        Some((geocentric_of(lon, lat, 0.0) - geocentric_of(own_lon, own_lat, 0.0)).norm())
    });
    let metres = math::median(&mut placed.collect::<Vec<f64>>())?;
    (metres > OTHER_PLACE_M).then_some(Doubt::Elsewhere { metres })
}

fn other_height(p: &Placement) -> Option<Doubt> {
    let metres = p.control?.above_headers_m?;
    (metres.abs() > MOST_DATUM_M).then_some(Doubt::OtherHeight { metres })
}

/// Standard deviation of the vertical by points of this noise, radians.
pub(in super::super) fn tilt_sigma(points: &[Point3<f64>], noise_m: f64) -> f64 {
    math::atan2(noise_m, spread(points).lengths[1])
}
