//! The block brought to ground control points: each from its images, then a similarity.

use nalgebra::{Matrix3, Point3, Vector3};

use super::gcp_list::{ControlPoint, GroundControl};
use super::residual::ControlResidual;
use crate::base::least_squares::{Loss, NormalEquations};
use crate::base::math;
use crate::orienting::structure_from_motion::block::{Block, Observation};
use crate::orienting::structure_from_motion::frame::{FrameBasis, spread};
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

/// Brings the block into the frame of the control points; `paths` are those of its photographs.
/// The block stays as it is where they do not give a frame, and the error says why.
pub(in super::super) fn to_control(
    block: &mut Block,
    paths: &[&str],
    control: &GroundControl,
) -> Result<FrameBasis, String> {
    let (mut usable, mut points) = (Vec::new(), Vec::new());
    for point in &control.points {
        let (seen, residual) = looked_for(block, paths, point);
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
            "the ground control points lie on one line, which leaves the turn about it open".into(),
        );
    }
    let from: Vec<Point3<f64>> = usable.iter().map(|(_, seen, _)| seen.place).collect();
    // Mean standard deviation of a component, in units of the block.
    let of_images: Vec<f64> = (usable.iter())
        .map(|(_, seen, _)| (seen.covariance.trace() / 3.0).sqrt())
        .collect();
    let (similarity, sigmas) = robust_similarity(&from, &to, &of_images)
        .ok_or("the ground control points do not differ in the photographs")?;
    similarity.apply(block);
    let lengths = |i: usize| (similarity.point(&from[i]) - to[i]).norm() / sigmas[i];
    let mut all: Vec<f64> = (0..from.len()).map(lengths).collect();
    // A block bends by more than the noise of its keypoints: the points themselves say by how much.
    let unit = math::median(&mut all).map_or(1.0, |m| (m / MAXWELL_MEDIAN).max(1.0));
    let (mut squares, mut agreeing) = ([0.0; 2], 0.0);
    for (i, (place, ..)) in usable.iter().enumerate() {
        let d: Vector3<f64> = similarity.point(&from[i]) - to[i];
        let point = &mut points[*place];
        point.residual_m = Some(d.into());
        point.sigma_m = Some(unit * sigmas[i]);
        point.agrees = lengths(i) <= LARGEST_RESIDUAL_SIGMAS * unit;
        if point.agrees {
            squares[0] += d.x * d.x + d.y * d.y;
            squares[1] += d.z * d.z;
            agreeing += 1.0;
        }
    }
    Ok(FrameBasis::Control {
        system: control.system.clone(),
        epsg: control.epsg,
        anchor: control.anchor,
        offset: control.offset.into(),
        points,
        rms_m: squares.map(|sum: f64| (sum / f64::max(agreeing, 1.0)).sqrt()),
    })
}

fn is_narrow(points: &[Point3<f64>]) -> bool {
    let [along, across, _] = spread(points).lengths;
    across <= COLLINEAR_SHARE * along
}

/// A control point by its marks, and what is known of it before there is a frame.
fn looked_for(
    block: &Block,
    paths: &[&str],
    point: &ControlPoint,
) -> (Option<Seen>, ControlResidual) {
    let name = |path: &str| path.rsplit('/').next().unwrap_or(path).to_ascii_lowercase();
    let mut with = Block {
        tracks: Vec::new(),
        ..block.clone()
    };
    let (mut observations, mut shown) = (Vec::new(), Vec::new());
    for (image, pixel) in &point.marks {
        let named = paths.iter().position(|path| name(path) == name(image));
        let Some(photo) = named.filter(|&p| with.photos[p].pose.is_some()) else {
            continue;
        };
        let of_block = &mut with.photos[photo];
        observations.push(Observation {
            photo,
            keypoint: of_block.keypoints.len(),
            is_used: true,
        });
        of_block.keypoints.push(*pixel);
        of_block.factors.push(MARK_SIGMA_PX / of_block.sigma_px);
        shown.push(image);
    }
    let seen = seen_in(&with, &observations);
    let agreeing = seen.as_ref().map_or(&[][..], |s| &s.agreeing);
    let wrong = (0..shown.len()).filter(|i| seen.is_some() && !agreeing.contains(i));
    let residual = ControlResidual {
        name: point.name.clone(),
        stated: point.stated,
        marks: [shown.len(), agreeing.len()],
        wrong_marks: wrong.map(|i| shown[i].clone()).collect(),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::rotation_from_axis_angle;
    use crate::orienting::structure_from_motion::bundle::tests::planted;

    const OFFSET: Vector3<f64> = Vector3::new(432_100.0, 5_412_300.0, 0.0);

    /// A block in a frame of its own, and a list of its points of these numbers as they are on the
    /// map; `change` may spoil coordinates and marks.
    fn listed(
        numbers: &[usize],
        mut change: impl FnMut(usize, &mut Point3<f64>, &mut Vec<Vector3<f64>>),
    ) -> (Block, Block, Vec<String>, GroundControl) {
        let truth = planted(0.1, 3);
        let paths: Vec<String> = (0..9).map(|i| format!("images/P{i}.jpg")).collect();
        let mut text = "EPSG:25832\n".to_owned();
        for (name, &number) in numbers.iter().enumerate() {
            let track = &truth.tracks[number];
            let mut place = track.point.unwrap() + OFFSET;
            let mut marks: Vec<Vector3<f64>> = (track.used())
                .map(|o| truth.pixel(o).coords.push(o.photo as f64))
                .collect();
            change(name, &mut place, &mut marks);
            for mark in marks {
                let [x, y, z] = place.into();
                text += &format!(
                    "{x} {y} {z} {} {} p{}.JPG g{name}\n",
                    mark.x, mark.y, mark.z
                );
            }
        }
        let mut block = truth.clone();
        let similarity = Similarity {
            scale: 0.02,
            rotation: rotation_from_axis_angle(&Vector3::new(1.2, -0.7, 0.5)),
            shift: Vector3::new(0.3, 0.1, 4.0),
        };
        similarity.apply(&mut block);
        let control = GroundControl::read("gcp_list.txt", &text).unwrap();
        (truth, block, paths, control)
    }

    /// Numbers of points that several photographs show.
    fn well_seen(count: usize) -> Vec<usize> {
        let truth = planted(0.1, 3);
        let seen = (0..truth.tracks.len()).filter(|&t| truth.tracks[t].observations.len() >= 4);
        seen.step_by(9).take(count).collect()
    }

    fn brought(block: &mut Block, paths: &[String], control: &GroundControl) -> FrameBasis {
        let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
        to_control(block, &paths, control).unwrap()
    }

    #[test]
    fn control_points_give_the_map_and_a_wrong_one_and_a_wrong_mark_are_named() {
        let (truth, mut block, paths, control) = listed(&well_seen(7), |name, place, marks| {
            if name == 2 {
                *place += Vector3::new(0.0, 3.0, -1.0);
            }
            if name == 4 {
                marks[0].x += 80.0;
            }
        });
        let basis = brought(&mut block, &paths, &control);
        let FrameBasis::Control {
            points,
            rms_m,
            offset,
            epsg,
            ..
        } = basis
        else {
            panic!("{basis:?}")
        };
        assert_eq!(epsg, Some(25832));
        let agrees: Vec<bool> = points.iter().map(|p| p.agrees).collect();
        assert_eq!(agrees, [true, true, false, true, true, true, true]);
        assert_eq!(points[4].wrong_marks.len(), 1);
        let [_, y, z] = points[2].residual_m.unwrap();
        assert!((y + 3.0).abs() < 0.1 && (z - 1.0).abs() < 0.1, "{y} {z}");
        assert!(rms_m[0] < 0.03 && rms_m[1] < 0.06, "{rms_m:?}");
        for (a, b) in block.photos.iter().zip(&truth.photos) {
            let [a, b] = [a, b].map(|p| p.pose.as_ref().unwrap().center);
            let off = (a + Vector3::from(offset) - (b + OFFSET)).norm();
            assert!(off < 0.1, "{off} m");
        }
    }

    #[test]
    fn too_few_points_or_points_on_a_line_give_no_frame() {
        let (_, block, paths, control) = listed(&well_seen(4), |name, _, marks| {
            marks.truncate(if name < 2 { 1 } else { 4 });
        });
        let refused = |control: &GroundControl| {
            let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
            let mut attempt = block.clone();
            let why = to_control(&mut attempt, &paths, control).unwrap_err();
            assert_eq!(attempt.photos[0].pose, block.photos[0].pose);
            why
        };
        assert!(refused(&control).starts_with("2 of 4 ground control points"));
        let (_, _, _, control) = listed(&well_seen(4), |name, place, _| {
            *place = Point3::from(OFFSET + Vector3::new(5.0, 4.0, 0.1) * name as f64);
        });
        assert!(refused(&control).contains("on one line"));
    }
}
