//! Each control point from its images, then the similarity from those to the coordinates.

use nalgebra::{Matrix3, Point3, Vector3};

use super::gcp_list::{ControlPoint, GroundControl};
use super::marks::{Mark, Marks};
use super::residual::ControlResidual;
use crate::base::geometry::mean_point;
use crate::base::least_squares::{Loss, NormalEquations};
use crate::base::math::{self, RAYLEIGH_MEDIAN, SIGMA_OVER_MEDIAN, SURE_RESIDUAL_SIGMAS};
use crate::orienting::orientation::FrameSigma;
use crate::orienting::structure_from_motion::block::{Block, BlockPhoto, Observation};
use crate::orienting::structure_from_motion::frame::{centers, spread, tilt_sigma, turn_to_up};
use crate::orienting::structure_from_motion::resection::linearised;
use crate::orienting::structure_from_motion::similarity::{FEWEST_POINTS, Similarity};
use crate::orienting::structure_from_motion::similarity_fit::{
    Free, KnownOf, Tie, fitted as adjusted, worth,
};
use crate::orienting::structure_from_motion::triangulation::triangulate;

/// Standard deviation of a point that a person marks in a photograph, pixels. Assumption: the list
/// does not state any.
pub(in super::super) const MARK_SIGMA_PX: f64 = 1.0;

/// That of a surveyed coordinate, metres. Assumption: a satellite receiver with corrections.
const COORDINATE_SIGMA_M: f64 = 0.03;

/// Points whose spread across their main axis is a smaller share of that along it are on a line.
const COLLINEAR_SHARE: f64 = 0.02;

/// Normalised residuals at which Cauchy's loss of a point begins to give way.
const LOSS: Loss = Loss::Cauchy(2.0);

/// Median length of a residual of three normal components, in their standard deviation.
const MAXWELL_MEDIAN: f64 = 1.538_17;

/// Control points have no lag.
const FREE: Free = Free {
    up: true,
    lag: false,
};

/// A point that two rays or more see, with its place in the block and on the map.
struct Usable {
    /// Its number in the list.
    number: usize,
    is_check: bool,
    tie: Tie,
    /// Mean standard deviation of a component by its images, units of the block.
    of_images: f64,
}

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
    /// How many are listed, without those that check.
    pub control: usize,
    /// Sum of the losses of all points, in squared standard deviations.
    pub loss: f64,
    /// Standard deviation of the vertical, radians.
    pub tilt_sigma: f64,
    /// What scale and level are worth.
    pub sigma: Option<FrameSigma>,
}

/// The similarity from a block without keypoints to control points; why there is none.
pub(super) fn fitted(block: &Block, marks: &Marks, control: &GroundControl) -> Result<Fit, String> {
    let (usable, mut points) = usable_of(block, marks, control);
    let listed = (control.points.iter()).filter(|p| !p.role.is_check).count();
    let (mut fixing, mut checks): (Vec<_>, Vec<_>) = usable.into_iter().partition(|u| !u.is_check);
    are_enough(&fixing, listed)?;
    let similarity = robust_similarity(block, &mut fixing)
        .ok_or("the photographs show all ground control points at one place: check their marks")?;
    weigh(&mut checks, &similarity);
    let length = |u: &Usable| u.tie.off(&similarity, 0.0).norm() / u.tie.sigma_m;
    // A block bends by more than the noise of its keypoints: the points themselves say by how much.
    let mut typical: Vec<f64> = (fixing.iter())
        .map(|u| length(u) / typical_length(u.tie.known))
        .collect();
    let unit = math::median(&mut typical).map_or(1.0, |m| m.max(1.0));
    let agrees = |u: &&Usable| length(u) <= SURE_RESIDUAL_SIGMAS * unit;
    for of in fixing.iter().chain(&checks) {
        let point = &mut points[of.number];
        let (off, axes) = (of.tie.off(&similarity, 0.0), of.tie.known.axes());
        point.place_m = Some(similarity.point(&of.tie.from).into());
        point.residual_m = Some([0, 1, 2].map(|i| axes[i].then_some(off[i])));
        point.sigma_m = Some(unit * of.tie.sigma_m);
        point.agrees = agrees(&of);
    }
    let agreeing: Vec<Tie> = (fixing.iter().filter(agrees))
        .map(|u| u.tie.clone())
        .collect();
    let mut sigmas: Vec<f64> = fixing.iter().map(|u| u.tie.sigma_m).collect();
    let noise_m = unit * math::median(&mut sigmas).unwrap_or(COORDINATE_SIGMA_M);
    let level: Vec<Point3<f64>> = (fixing.iter())
        .filter(|u| u.tie.known != KnownOf::Plan)
        .map(|u| similarity.point(&u.tie.from))
        .collect();
    let used = points.iter().filter(|p| p.agrees && !p.role.is_check);
    Ok(Fit {
        rms_m: rms_m(used).map(|rms| rms.unwrap_or(0.0)),
        agreeing: agreeing.len(),
        control: listed,
        loss: fixing
            .iter()
            .map(|u| LOSS.cost(length(u) * length(u)))
            .sum(),
        tilt_sigma: tilt_sigma(&level, noise_m),
        sigma: worth(&agreeing, &similarity, 0.0, FREE).map(|worth| worth.frame),
        similarity,
        points,
    })
}

/// The points that the block shows, and what is known of all before there is a frame.
fn usable_of(
    block: &Block,
    marks: &Marks,
    control: &GroundControl,
) -> (Vec<Usable>, Vec<ControlResidual>) {
    let (mut usable, mut points) = (Vec::new(), Vec::new());
    for (point, of_point) in control.points.iter().zip(&marks.of_points) {
        let (seen, residual) = looked_for(block, of_point, point);
        usable.extend(seen.map(|seen| Usable {
            number: points.len(),
            is_check: point.role.is_check,
            tie: Tie {
                from: seen.place,
                to: point.position,
                known: point.role.known,
                sigma_m: COORDINATE_SIGMA_M,
                velocity: Vector3::zeros(),
            },
            of_images: (seen.covariance.trace() / 3.0).sqrt(),
        }));
        points.push(residual);
    }
    (usable, points)
}

/// Median length of a residual in its standard deviation, by the components that are known.
fn typical_length(known: KnownOf) -> f64 {
    match known {
        KnownOf::All => MAXWELL_MEDIAN,
        KnownOf::Plan => RAYLEIGH_MEDIAN,
        KnownOf::Height => 1.0 / SIGMA_OVER_MEDIAN,
    }
}

/// Do points give a frame, of so many that are listed? Two have to be known in plan and three in
/// height, which is what three whole ones are.
fn are_enough(fixing: &[Usable], listed: usize) -> Result<(), String> {
    let without = |other: KnownOf| fixing.iter().filter(move |u| u.tie.known != other);
    let (plan, heights) = (without(KnownOf::Height), without(KnownOf::Plan));
    let [plan, heights] = [plan.count(), heights.count()];
    if fixing.len() < FEWEST_POINTS || heights < FEWEST_POINTS || plan + 1 < FEWEST_POINTS {
        let parts = match plan == fixing.len() && heights == fixing.len() {
            true => format!("{FEWEST_POINTS}"),
            false => {
                format!("two in plan and {FEWEST_POINTS} in height ({plan} and {heights} are)")
            }
        };
        return Err(format!(
            "{} of {listed} ground control points are marked in two oriented photographs where the \
             rays meet, and a frame needs {parts}",
            fixing.len()
        ));
    }
    let from: Vec<Point3<f64>> = without(KnownOf::Plan).map(|u| u.tie.from).collect();
    let whole: Vec<Point3<f64>> = (without(KnownOf::Plan))
        .filter(|u| u.tie.known == KnownOf::All)
        .map(|u| u.tie.to)
        .collect();
    if is_narrow(&from) || whole.len() == fixing.len() && is_narrow(&whole) {
        return Err(
            "the ground control points lie on one line, about which the block may turn: add one \
             beside it"
                .into(),
        );
    }
    Ok(())
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
            let r = with.residual(&observations[i], &place) / SURE_RESIDUAL_SIGMAS;
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
        role: point.role,
        stated: point.stated,
        marks: [shown.len(), agreeing.len()],
        wrong_marks: wrong.map(|i| shown[i].image.clone()).collect(),
        place_m: None,
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

/// Standard deviations of a component under a similarity: of the images and of the coordinates.
fn weigh(points: &mut [Usable], similarity: &Similarity) {
    for point in points {
        let of_images = similarity.scale * point.of_images;
        point.tie.sigma_m = math::hypot(of_images, COORDINATE_SIGMA_M);
    }
}

/// The similarity of least Cauchy's loss among those of three whole points, then by robust least
/// squares of all; the points are weighed by it.
fn robust_similarity(block: &Block, points: &mut [Usable]) -> Option<Similarity> {
    let whole: Vec<(Point3<f64>, Point3<f64>)> = (points.iter())
        .filter(|u| u.tie.known == KnownOf::All)
        .map(|u| (u.tie.from, u.tie.to))
        .collect();
    let between = |pairs: &[(Point3<f64>, Point3<f64>)]| {
        let (from, to): (Vec<_>, Vec<_>) = pairs.iter().copied().unzip();
        Similarity::between(&from, &to, &vec![1.0; pairs.len()])
    };
    let is_whole = whole.len() >= FEWEST_POINTS;
    let mut best = match is_whole {
        true => between(&whole)?,
        false => upright(block, points)?,
    };
    if is_whole {
        let of_triple = |triple: [usize; 3]| {
            let sample = triple.map(|i| whole[i]);
            let is_narrow = is_narrow(&sample.map(|(_, to)| to));
            (!is_narrow).then(|| between(&sample)).flatten()
        };
        best = Similarity::of_triples(best, 11, whole.len(), of_triple, |s| {
            weigh(points, s);
            let square = |u: &Usable| (u.tie.off(s, 0.0) / u.tie.sigma_m).norm_squared();
            points.iter().map(|u| LOSS.cost(square(u))).sum()
        });
    }
    weigh(points, &best);
    let ties: Vec<Tie> = points.iter().map(|u| u.tie.clone()).collect();
    let (found, _) = adjusted(&best, &ties, FREE, LOSS)?;
    weigh(points, &found);
    Some(found)
}

/// A start for points of which too few are known wholly: up is across all of them, for they lie on
/// the ground, on the side of the cameras; the rest follows from the plan.
fn upright(block: &Block, points: &[Usable]) -> Option<Similarity> {
    let from: Vec<Point3<f64>> = points.iter().map(|u| u.tie.from).collect();
    let normal = spread(&from).normal;
    let towards = mean_point(&centers(block)) - mean_point(&from);
    let turn = turn_to_up(&(normal * towards.dot(&normal).signum()));
    let in_plan = points.iter().filter(|u| u.tie.known != KnownOf::Height);
    let (from, to): (Vec<_>, Vec<_>) = in_plan.map(|u| (turn * u.tie.from, u.tie.to)).unzip();
    let mut found = Similarity::in_plan(&from, &to, &vec![1.0; from.len()])?;
    found.rotation *= turn;
    let heights = points.iter().filter(|u| u.tie.known != KnownOf::Plan);
    let below = heights.map(|u| u.tie.to.z - found.point(&u.tie.from).z);
    found.shift.z += math::median(&mut below.collect::<Vec<f64>>())?;
    Some(found)
}

/// Root mean square residuals of points in plan and in height, metres, where any are known.
pub(in super::super) fn rms_m<'a>(
    points: impl Iterator<Item = &'a ControlResidual>,
) -> [Option<f64>; 2] {
    let seen: Vec<[Option<f64>; 3]> = points.filter_map(|p| p.residual_m).collect();
    let rms = |square: &dyn Fn(&[Option<f64>; 3]) -> Option<f64>| {
        let squares: Vec<f64> = seen.iter().filter_map(square).collect();
        (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
    };
    let square = |d: Option<f64>| d.map(|d| d * d);
    let plan = rms(&|[x, y, _]| Some(square(*x)? + square(*y)?));
    [plan, rms(&|[_, _, z]| square(*z))]
}
