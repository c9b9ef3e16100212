//! The sparse model and the report of a finished block.

use nalgebra::{Matrix3, Point3, SymmetricEigen, Vector3};

use super::report::{CameraReport, LeftOut, OrientReport, PhotoReport};
use super::sheet::rms_words;
use super::sparse_model::{OrientedPhoto, SparseModel, SparsePoint};
use crate::orienting::orientation::Anchor;
use crate::orienting::structure_from_motion::block::{Block, Track};
use crate::orienting::structure_from_motion::bundle::Covariance;
use crate::orienting::structure_from_motion::frame::{FrameBasis, StatedPose};
use crate::orienting::structure_from_motion::ground_control::{ControlResidual, rms_m};
use crate::orienting::structure_from_motion::incremental::FEWEST_POINTS;
use crate::orienting::structure_from_motion::intrinsics::{Intrinsics, stated_focal_nats};

/// Least mean number of rays without a warning.
const FEW_RAYS: f64 = 2.5;

/// What the block's photographs and cameras are called, and what was known of them.
pub(in super::super) struct Names<'a> {
    /// Paths of the photographs.
    pub paths: Vec<&'a str>,
    /// Colours of their keypoints.
    pub colours: Vec<&'a [[u8; 3]]>,
    pub cameras: Vec<String>,
    /// Cameras at the start.
    pub means: &'a [Intrinsics],
    /// Whose focal length was guessed.
    pub is_guessed: &'a [bool],
    pub stated: &'a [StatedPose],
}

fn tracks(block: &Block) -> impl Iterator<Item = (&Track, Point3<f64>)> {
    block.tracks.iter().filter_map(|t| Some((t, t.point?)))
}

/// Residual of all used rays, pixels.
fn residuals<'a>(
    block: &'a Block,
    t: &'a Track,
    point: &'a Point3<f64>,
) -> impl Iterator<Item = (usize, f64)> + 'a {
    t.used()
        .map(move |o| (o.photo, block.residual(o, point) * block.sigma_px(o)))
}

/// The model of what has an orientation.
pub(in super::super) fn sparse_model(
    block: &Block,
    names: &Names,
    basis: &FrameBasis,
) -> SparseModel {
    let registered = block.registered();
    let mut slots = vec![usize::MAX; block.photos.len()];
    let mut photos: Vec<OrientedPhoto> = Vec::new();
    for &photo in &registered {
        if let Some(pose) = &block.photos[photo].pose {
            slots[photo] = photos.len();
            photos.push(OrientedPhoto {
                path: names.paths[photo].to_owned(),
                camera: block.photos[photo].camera,
                pose: pose.clone(),
                rays: Vec::new(),
            });
        }
    }
    let mut points = Vec::new();
    for (track, position) in tracks(block) {
        let (mut rays, mut sum) = (Vec::new(), [0.0; 3]);
        for o in track.used() {
            let slot = slots[o.photo];
            let pixel = block.pixel(o);
            rays.push((slot, photos[slot].rays.len()));
            photos[slot].rays.push(([pixel.x, pixel.y], points.len()));
            let rgb = names.colours[o.photo][o.keypoint];
            (0..3).for_each(|c| sum[c] += f64::from(rgb[c]));
        }
        let count = rays.len() as f64;
        let square: f64 = residuals(block, track, &position).map(|(_, r)| r * r).sum();
        points.push(SparsePoint {
            position,
            rgb: sum.map(|s| (s / count).round() as u8),
            rms_px: (square / count).sqrt(),
            rays,
        });
    }
    SparseModel {
        cameras: block.cameras.clone(),
        photos,
        points,
        offset: match basis {
            FrameBasis::Control { offset, .. } => (*offset).into(),
            _ => Vector3::zeros(),
        },
        unit: basis.unit(),
    }
}

/// The report on a block in its frame.
pub(in super::super) fn report(
    block: &Block,
    names: &Names,
    basis: &FrameBasis,
    covariance: Option<&Covariance>,
    left_out: Vec<LeftOut>,
) -> OrientReport {
    let counts = RayCounts::of(block);
    let RayCounts { rays, squares, .. } = &counts;
    let registered = block.registered();
    let total: usize = rays.iter().sum();
    let photos = photos(block, names, basis, covariance, &counts);
    let rays_a_point = total as f64 / counts.points.max(1) as f64;
    let (frame, anchor, mut warnings) = frame_words(basis);
    warnings.extend((rays_a_point < FEW_RAYS).then(|| {
        format!(
            "only {rays_a_point:.1} photographs show a point on average: take more of them, with \
             more overlap"
        )
    }));
    let cameras = cameras(block, names, covariance);
    warnings.extend(cameras.iter().filter_map(contradiction));
    let (epsg, offset, control, frame_sigma, lag) = match basis {
        FrameBasis::Control {
            epsg,
            offset,
            points,
            sigma,
            ..
        } => (*epsg, *offset, points.clone(), *sigma, None),
        FrameBasis::Positions { sigma, lag, .. } => {
            (None, [0.0; 3], Vec::new(), *sigma, lag.clone())
        }
        _ => (None, [0.0; 3], Vec::new(), None, None),
    };
    OrientReport {
        frame,
        anchor,
        epsg,
        offset,
        frame_sigma,
        lag,
        is_metric: anchor.is_some() || !control.is_empty(),
        control,
        points: counts.points,
        rays: total,
        rays_a_point,
        rms_px: (squares.iter().sum::<f64>() / total.max(1) as f64).sqrt(),
        cameras,
        photos,
        left_out,
        overlap: counts.overlap(&registered),
        coverage: None,
        warnings,
    }
}

/// The oriented photographs.
fn photos(
    block: &Block,
    names: &Names,
    basis: &FrameBasis,
    covariance: Option<&Covariance>,
    counts: &RayCounts,
) -> Vec<PhotoReport> {
    let (RayCounts { rays, squares, .. }, registered) = (counts, block.registered());
    (registered.iter().enumerate())
        .map(|(slot, &photo)| {
            let from_stated = from_stated(block, names, basis, photo);
            PhotoReport {
                file: names.paths[photo].to_owned(),
                rays: rays[photo],
                rms_px: (squares[photo] / rays[photo].max(1) as f64).sqrt(),
                sigma_m: covariance.map(|c| deviations(&c.centers[slot])),
                sigma_deg: covariance.map(|c| largest_deviation(&c.turns[slot]).to_degrees()),
                partners: counts.partners(photo, &registered),
                from_stated_m: from_stated.map(Vector3::into),
                residual_m: from_stated.map(|d| (d - moved_m(basis, photo)).into()),
            }
        })
        .collect()
}

/// What the rays of a block count up to.
struct RayCounts {
    points: usize,
    /// Rays by photograph, and the sum of their squared residuals.
    rays: Vec<usize>,
    squares: Vec<f64>,
    /// Points that two photographs see, row by row.
    shared: Vec<usize>,
}

impl RayCounts {
    fn of(block: &Block) -> Self {
        let n = block.photos.len();
        let mut counts = Self {
            points: 0,
            rays: vec![0; n],
            squares: vec![0.0; n],
            shared: vec![0; n * n],
        };
        for (track, position) in tracks(block) {
            counts.points += 1;
            for (photo, r) in residuals(block, track, &position) {
                counts.rays[photo] += 1;
                counts.squares[photo] += r * r;
                for other in track.used() {
                    counts.shared[photo * n + other.photo] += 1;
                }
            }
        }
        counts
    }

    fn shared(&self, photo: usize, other: usize) -> usize {
        self.shared[photo * self.rays.len() + other]
    }

    /// How many other photographs overlap with one.
    fn partners(&self, photo: usize, registered: &[usize]) -> usize {
        let others = registered.iter().filter(|&&other| other != photo);
        others
            .filter(|&&other| self.shared(photo, other) >= FEWEST_POINTS)
            .count()
    }

    /// The pairs that overlap, by their places among the registered photographs, and how many
    /// points they share.
    fn overlap(&self, registered: &[usize]) -> Vec<(usize, usize, usize)> {
        let mut overlap = Vec::new();
        for (i, &a) in registered.iter().enumerate() {
            for (j, &b) in registered.iter().enumerate().skip(i + 1) {
                let count = self.shared(a, b);
                if count >= FEWEST_POINTS {
                    overlap.push((i, j, count));
                }
            }
        }
        overlap
    }
}

fn cameras(block: &Block, names: &Names, covariance: Option<&Covariance>) -> Vec<CameraReport> {
    (block.cameras.iter().enumerate())
        .map(|(i, camera)| {
            let oriented = block
                .photos
                .iter()
                .filter(|p| p.camera == i && p.pose.is_some());
            CameraReport {
                name: names.cameras[i].clone(),
                photos: oriented.count(),
                stated_focal_px: names.means[i].focal,
                is_stated: !names.is_guessed[i],
                parameters: camera.parameters(),
                sigmas: covariance.map(|c| c.cameras[i]),
            }
        })
        .collect()
}

/// A stated focal length under which the adjusted one is less likely than under any other.
fn contradiction(camera: &CameraReport) -> Option<String> {
    let ([focal, ..], [sigma, ..]) = (camera.parameters, camera.sigmas?);
    let stated = camera.stated_focal_px;
    let nats = stated_focal_nats(focal, stated, sigma / focal);
    (camera.is_stated && nats < 0.0).then(|| {
        format!(
            "the photographs contradict the stated focal length of {stated:.0} px: they say \
             {focal:.0} +- {sigma:.0} px, which was taken; check whether the header belongs to the \
             photographs, and whether they were cut"
        )
    })
}

/// A photograph's place minus the stated one, metres.
fn from_stated(
    block: &Block,
    names: &Names,
    basis: &FrameBasis,
    photo: usize,
) -> Option<Vector3<f64>> {
    if !matches!(basis, FrameBasis::Positions { .. }) {
        return None;
    }
    let center = block.photos[photo].pose.as_ref()?.center;
    let stated = names.stated.get(photo).filter(|s| !s.lacks_height)?;
    Some(center - stated.position?)
}

/// By how much the stated position of a photograph was moved along the flight, metres.
fn moved_m(basis: &FrameBasis, photo: usize) -> Vector3<f64> {
    let lag = match basis {
        FrameBasis::Positions { lag, .. } => lag.as_ref(),
        _ => None,
    };
    lag.and_then(|lag| lag.moved_m.get(photo).copied())
        .unwrap_or_default()
}

fn deviations(covariance: &Matrix3<f64>) -> [f64; 3] {
    [0, 1, 2].map(|i| covariance[(i, i)].max(0.0).sqrt())
}

fn largest_deviation(covariance: &Matrix3<f64>) -> f64 {
    SymmetricEigen::new(*covariance)
        .eigenvalues
        .max()
        .max(0.0)
        .sqrt()
}

fn metres_from(anchor: &Anchor) -> String {
    format!(
        "metres, x east, y north, z up from longitude {:.3}, latitude {:.3}",
        anchor.lon_deg, anchor.lat_deg
    )
}

/// A frame by stated positions.
fn positions_words(basis: &FrameBasis) -> (String, Option<Anchor>, Vec<String>) {
    let FrameBasis::Positions {
        anchor,
        agreeing,
        stated,
        heights,
        rms_m: [plan, height],
        is_levelled,
        ..
    } = basis
    else {
        return Default::default();
    };
    let levelled = "the stated positions lie on one line: the slope across it follows from \
                            the angles or the ground";
    let warnings = (*is_levelled && *heights > 0).then(|| levelled.to_owned());
    let of_heights = match heights {
        0 => "; heights count from the ground".to_owned(),
        _ => format!(", {height:.2} m in height (an offset common to all heights cannot be seen)"),
    };
    let words = format!(
        "{}: the stated positions of {agreeing} of {stated} photographs, rms {plan:.2} m in \
                 plan{of_heights}",
        metres_from(anchor)
    );
    (words, Some(*anchor), warnings.into_iter().collect())
}

/// A frame in words, the place that it counts from, and what is to be said against it.
fn frame_words(basis: &FrameBasis) -> (String, Option<Anchor>, Vec<String>) {
    match basis {
        FrameBasis::Control {
            system,
            anchor,
            offset: [east, north, _],
            points,
            rms_m: [plan, height],
            ..
        } => {
            let of = |is_check| points.iter().filter(move |p| p.role.is_check == is_check);
            let (unit, agreeing) = (basis.unit(), of(false).filter(|p| p.agrees).count());
            let check = match of(true).count() {
                0 => String::new(),
                count => format!("; check points: {count}{}", rms_words(rms_m(of(true)))),
            };
            let frame = match anchor {
                Some(anchor) => metres_from(anchor),
                None if unit.is_metre() => format!("{system}, x from {east} and y from {north} m"),
                None => format!("{system}, whose unit the files have: {}", unit.words()),
            };
            let words = format!(
                "{frame}: {agreeing} of {} ground control points, rms {plan:.3} m in plan, \
                 {height:.3} m in height{check}",
                of(false).count()
            );
            (words, *anchor, control_warnings(points))
        }
        FrameBasis::Positions { .. } => positions_words(basis),
        FrameBasis::Angles {
            rms_deg,
            photos: [agreeing, stated],
        } => (
            format!(
                "z up by the stated angles of {agreeing} of {stated} photographs (rms {rms_deg:.2} \
                 degrees); no positions"
            ),
            None,
            vec![ARBITRARY_SCALE.to_owned()],
        ),
        FrameBasis::MainPlane => (
            "z up across the main plane of the points".to_owned(),
            None,
            vec![ARBITRARY_SCALE.to_owned()],
        ),
    }
}

/// Which points or marks are wrong, and what to do.
fn control_warnings(points: &[ControlResidual]) -> Vec<String> {
    let mut warnings = Vec::new();
    for p in points {
        let (what, others) = match p.role.is_check {
            true => ("check point", "the control points put"),
            false => ("ground control point", "the others put"),
        };
        if let (Some(off), false) = (p.residual_m, p.agrees) {
            let off = off.map(|d| d.map_or_else(|| "-".to_owned(), |d| format!("{d:.2}")));
            warnings.push(format!(
                "{what} {} is {} m (x, y, z) from where {others} it: check its coordinates and marks",
                p.name,
                off.join(", ")
            ));
        }
        if p.residual_m.is_none() {
            warnings.push(format!(
                "{what} {} is not used: mark it in two or more oriented photographs ({} of its marks \
                 are in such)",
                p.name, p.marks[0]
            ));
        }
        if !p.wrong_marks.is_empty() {
            warnings.push(format!(
                "{what} {} is marked elsewhere in {} than in the other photographs",
                p.name,
                p.wrong_marks.join(", ")
            ));
        }
    }
    warnings
}

pub(super) const ARBITRARY_SCALE: &str = "the scale is arbitrary (as if taken from 100 m above the ground): \
                               measure one length to set it";
