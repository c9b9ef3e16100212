//! Each control point from its images, then the similarity from those to the coordinates.

use nalgebra::{Matrix3, Point3, Vector3};

use super::gcp_list::{ControlPoint, GroundControl};
use super::marks::{Mark, Marks};
use super::residual::ControlResidual;
use crate::base::least_squares::{Loss, NormalEquations};
use crate::base::math;
use crate::orienting::structure_from_motion::block::{Block, BlockPhoto, Observation};
use crate::orienting::structure_from_motion::frame::{spread, tilt_sigma};
use crate::orienting::structure_from_motion::random::Random;
use crate::orienting::structure_from_motion::resection::linearised;
use crate::orienting::structure_from_motion::similarity::Similarity;
use crate::orienting::structure_from_motion::triangulation::{
    LARGEST_RESIDUAL_SIGMAS, triangulate,
};

/// Standard deviation of a point that a person marks in a photograph, pixels. Assumption: the list
/// does not state any.
pub(in super::super) const MARK_SIGMA_PX: f64 = 1.0;

/// That of a surveyed coordinate, metres. Assumption: a satellite receiver with corrections.
const COORDINATE_SIGMA_M: f64 = 0.03;

/// Fewest points that give a frame.
const FEWEST_POINTS: usize = 3;

/// Points whose spread across their main axis is a smaller share of that along it are on a line.
const COLLINEAR_SHARE: f64 = 0.02;

/// Triples of points that are tried, at most.
const SAMPLES: usize = 300;

/// Rounds of weighting the points anew.
const ROUNDS: usize = 20;

/// Normalised residuals at which Cauchy's loss of a point begins to give way.
const LOSS: Loss = Loss::Cauchy(2.0);

/// Median length of a residual of three normal components, in their standard deviation.
const MAXWELL_MEDIAN: f64 = 1.538_17;

/// A point as the block sees it.
struct Seen {
    place: Point3<f64>,
    covariance: Matrix3<f64>,
    agreeing: Vec<usize>,
}

/// Photographs with their poses, and without keypoints: what marks are looked at in.
pub(super) fn without_keypoints(block: &Block) -> Block {
    let photos = block.photos.iter().map(|photo| BlockPhoto {
        keypoints: Vec::new(),
        factors: Vec::new(),
        sigma_px: MARK_SIGMA_PX,
        camera: photo.camera,
        pose: photo.pose.clone(),
    });
    Block {
        photos: photos.collect(),
        cameras: block.cameras.clone(),
        tracks: Vec::new(),
    }
}

/// Points brought to their coordinates.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub similarity: Similarity,
    pub points: Vec<ControlResidual>,
    /// Root mean square residual of the agreeing ones, in plan and in height, metres.
    pub rms_m: [f64; 2],
    /// How many agree.
    pub agreeing: usize,
    /// Sum of the losses of all points, in squared standard deviations.
    pub loss: f64,
    /// Standard deviation of the vertical, radians.
    pub tilt_sigma: f64,
}

/// The similarity from a block without keypoints to control points; why there is none.
pub(super) fn fitted(block: &Block, marks: &Marks, control: &GroundControl) -> Result<Fit, String> {
    let (mut usable, mut points) = (Vec::new(), Vec::new());
    for (point, of_point) in control.points.iter().zip(&marks.of_points) {
        let (seen, residual) = looked_for(block, of_point, point);
        if let Some(seen) = seen {
            usable.push((points.len(), seen, point.position));
        }
        points.push(residual);
    }
    if usable.len() < FEWEST_POINTS {
        let [all, used] = [points.len(), usable.len()];
        return Err(format!(
            "{used} of {all} ground control points are marked in two oriented photographs where \
             the rays meet, and a frame needs {FEWEST_POINTS}"
        ));
    }
    let to: Vec<Point3<f64>> = usable.iter().map(|(_, _, position)| *position).collect();
    if is_narrow(&to) {
        return Err(
            "the ground control points lie on one line, about which the block may turn: add one \
             beside it"
                .into(),
        );
    }
    let from: Vec<Point3<f64>> = usable.iter().map(|(_, seen, _)| seen.place).collect();
    // Mean standard deviation of a component, in units of the block.
    let of_images: Vec<f64> = (usable.iter())
        .map(|(_, seen, _)| (seen.covariance.trace() / 3.0).sqrt())
        .collect();
    let (similarity, sigmas) = robust_similarity(&from, &to, &of_images)
        .ok_or("the photographs show all ground control points at one place: check their marks")?;
    let lengths = |i: usize| (similarity.point(&from[i]) - to[i]).norm() / sigmas[i];
    let mut all: Vec<f64> = (0..from.len()).map(lengths).collect();
    // A block bends by more than the noise of its keypoints: the points themselves say by how much.
    let unit = math::median(&mut all).map_or(1.0, |m| (m / MAXWELL_MEDIAN).max(1.0));
    let (mut squares, mut agreeing) = ([0.0; 2], 0);
    for (i, (place, ..)) in usable.iter().enumerate() {
        let d: Vector3<f64> = similarity.point(&from[i]) - to[i];
        let point = &mut points[*place];
        point.residual_m = Some(d.into());
        point.sigma_m = Some(unit * sigmas[i]);
        point.agrees = lengths(i) <= LARGEST_RESIDUAL_SIGMAS * unit;
        if point.agrees {
            squares[0] += d.x * d.x + d.y * d.y;
            squares[1] += d.z * d.z;
            agreeing += 1;
        }
    }
    let noise_m = unit * math::median(&mut sigmas.clone()).unwrap_or(COORDINATE_SIGMA_M);
    Ok(Fit {
        rms_m: squares.map(|sum: f64| (sum / f64::from(agreeing.max(1))).sqrt()),
        agreeing: agreeing as usize,
        loss: (0..from.len())
            .map(|i| LOSS.cost(lengths(i) * lengths(i)))
            .sum(),
        tilt_sigma: tilt_sigma(&to, noise_m),
        similarity,
        points,
    })
}

fn is_narrow(points: &[Point3<f64>]) -> bool {
    let [along, across, _] = spread(points).lengths;
    across <= COLLINEAR_SHARE * along
}

/// A block with the marks of a point as keypoints, and which they are.
fn with_marks(block: &Block, marks: &[Mark]) -> (Block, Vec<Observation>) {
    let mut with = block.clone();
    let mut observations = Vec::new();
    for mark in marks
        .iter()
        .filter(|m| block.photos[m.photo].pose.is_some())
    {
        let of_block = &mut with.photos[mark.photo];
        observations.push(Observation {
            photo: mark.photo,
            keypoint: of_block.keypoints.len(),
            is_used: true,
        });
        of_block.keypoints.push(mark.pixel);
        of_block.factors.push(1.0);
    }
    (with, observations)
}

/// How well marks meet: of each that agrees with others 1 where the rays meet, 0 at the largest
/// residual.
pub(super) fn meeting(block: &Block, of_points: &[Vec<Mark>]) -> f64 {
    let of_point = |marks: &Vec<Mark>| {
        let (with, observations) = with_marks(block, marks);
        let Some((place, agreeing)) = triangulate(&with, &observations) else {
            return 0.0;
        };
        let share = |&i: &usize| {
            let r = with.residual(&observations[i], &place) / LARGEST_RESIDUAL_SIGMAS;
            1.0 - (r * r).min(1.0)
        };
        agreeing.iter().map(share).sum::<f64>()
    };
    of_points.iter().map(of_point).sum()
}

/// A control point by its marks, and what is known of it before there is a frame.
fn looked_for(
    block: &Block,
    marks: &[Mark],
    point: &ControlPoint,
) -> (Option<Seen>, ControlResidual) {
    let shown: Vec<&Mark> = (marks.iter())
        .filter(|m| block.photos[m.photo].pose.is_some())
        .collect();
    let (with, observations) = with_marks(block, marks);
    let seen = seen_in(&with, &observations);
    let agreeing = seen.as_ref().map_or(&[][..], |s| &s.agreeing);
    let wrong = (0..shown.len()).filter(|i| seen.is_some() && !agreeing.contains(i));
    let residual = ControlResidual {
        name: point.name.clone(),
        stated: point.stated,
        marks: [shown.len(), agreeing.len()],
        wrong_marks: wrong.map(|i| shown[i].image.clone()).collect(),
        residual_m: None,
        sigma_m: None,
        agrees: false,
    };
    (seen, residual)
}

/// Where the rays of marks meet.
fn seen_in(block: &Block, observations: &[Observation]) -> Option<Seen> {
    let (place, agreeing) = triangulate(block, observations)?;
    let mut equations = NormalEquations::default();
    for &i in &agreeing {
        let o = &observations[i];
        let photo = &block.photos[o.photo];
        let (residual, _, _, by_point) = linearised(
            photo.pose.as_ref()?,
            block.intrinsics(o.photo),
            &place,
            &block.pixel(o),
        )?;
        equations.add_weighted(&residual, &by_point, 1.0 / (MARK_SIGMA_PX * MARK_SIGMA_PX));
    }
    Some(Seen {
        place,
        covariance: equations.inverse()?,
        agreeing,
    })
}

/// The similarity from points to others of least Cauchy's loss among those of three of them, then
/// by least squares, weighted anew while it settles; and the standard deviations of a component of
/// its residuals, metres. `of_images` are those of the points, in their units.
fn robust_similarity(
    from: &[Point3<f64>],
    to: &[Point3<f64>],
    of_images: &[f64],
) -> Option<(Similarity, Vec<f64>)> {
    let n = from.len();
    let sigmas = |s: &Similarity| -> Vec<f64> {
        let of_image = of_images.iter().map(|sigma| s.scale * sigma);
        of_image
            .map(|m| math::hypot(m, COORDINATE_SIGMA_M))
            .collect()
    };
    // Squared normalised residuals.
    let squares = |s: &Similarity| -> Vec<f64> {
        let pairs = from.iter().zip(to).zip(sigmas(s));
        pairs
            .map(|((a, b), sigma)| (s.point(a) - b).norm_squared() / (sigma * sigma))
            .collect()
    };
    let loss = |s: &Similarity| -> f64 {
        let each = squares(s).into_iter();
        each.map(|square| LOSS.cost(square)).sum()
    };
    let mut best = Similarity::between(from, to, &vec![1.0; n])?;
    let mut least = loss(&best);
    let mut random = Random::new(11);
    for _ in 0..SAMPLES {
        let sample = random.sample::<3>(n);
        let pick = |points: &[Point3<f64>]| sample.map(|i| points[i]);
        if is_narrow(&pick(to)) {
            continue;
        }
        if let Some(s) = Similarity::between(&pick(from), &pick(to), &[1.0; 3]) {
            let l = loss(&s);
            if l < least {
                (best, least) = (s, l);
            }
        }
    }
    for _ in 0..ROUNDS {
        let weights: Vec<f64> = (squares(&best).iter().zip(sigmas(&best)))
            .map(|(square, sigma)| LOSS.weight(*square) / (sigma * sigma))
            .collect();
        best = Similarity::between(from, to, &weights)?;
    }
    let sigmas = sigmas(&best);
    Some((best, sigmas))
}
