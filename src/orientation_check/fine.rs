//! Offsets of a fraction of a pixel: places found again are measured in the images as they are, and their
//! distances from the epipolar lines compared with and without half a pixel.
//!
//! Views of one strip shift together and hide it; strips flown in opposite directions show twice of it.

use nalgebra::{Point2, Vector3};

use super::epipolar::{Reduced, best_place, fine_place};
use super::suspects::Suspect;
use super::{Clinic, Patient, mean_axis};
use crate::camera::{Camera, fundamental};
use crate::execution::parallel;
use crate::math;

/// Least mean offset worth a word, pixels. Orientations from structure from motion reach 0.2.
const LEAST_OFFSET_PX: f64 = 0.25;

/// The offset that may remain, as a share of what was.
const REMAINDER: f64 = 0.5;

/// Fewest places in a pair of views for its median.
const FEWEST: usize = 12;

/// A place that a pair of views shares, pixels.
pub(crate) struct Place {
    /// Number of the interest point in the first view.
    pub point: usize,
    /// Where the first view has it: x.
    pub first: Point2<f64>,
    /// Where the second view has it: x'.
    pub second: Point2<f64>,
}

/// All places of a pair of views.
pub(crate) type Places = Vec<Place>;

/// Half a pixel, if adding it to the principal points takes most of the offsets away; mean offsets before
/// and after, pixels.
pub(crate) fn half_pixel(
    clinic: &Clinic,
    patients: &[Patient],
    stated: &[Camera],
    places: &[Places],
) -> Option<(Suspect, [f64; 2])> {
    let before = mean_offset_px(clinic, places, stated)?;
    if before < LEAST_OFFSET_PX {
        return None;
    }
    let tried = [0.5, -0.5].map(Suspect::HalfPixel).into_iter();
    let after = tried.filter_map(|suspect| {
        let cameras = suspect.treated(patients)?;
        Some((suspect, mean_offset_px(clinic, places, &cameras)?))
    });
    let (suspect, after) = after.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (after < REMAINDER * before).then_some((suspect, [before, after]))
}

/// Measures places in the images as they are.
pub(crate) fn places(clinic: &Clinic, patients: &[Patient], cameras: &[Camera]) -> Vec<Places> {
    let reduced = clinic.reduced(cameras);
    let whole: Vec<Reduced> = (cameras.iter().zip(patients))
        .map(|(camera, patient)| Reduced {
            camera: camera.clone(),
            gray: patient.gray,
        })
        .collect();
    let axis = mean_axis(cameras);
    parallel::map(&clinic.pairs, |_, &(i, j)| {
        let scale = [i, j].map(|v| clinic.factors[v] as f64);
        let measure = |(point, x): (usize, &Point2<f64>)| {
            let place = best_place(&reduced[i], &reduced[j], &axis, x)?;
            if place.shift.abs() > 1 {
                return None;
            }
            let (x, near) = (x * scale[0], place.at * scale[1]);
            let y = fine_place(&whole[i], &whole[j], &axis, &x, &near, scale[1] + 3.0)?;
            Some(Place {
                point,
                first: x,
                second: y,
            })
        };
        clinic.points[i]
            .iter()
            .enumerate()
            .filter_map(measure)
            .collect()
    })
}

/// Mean over the pairs of views of the size of the median offset across the epipolar lines, pixels.
fn mean_offset_px(clinic: &Clinic, places: &[Places], cameras: &[Camera]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for (&(i, j), places) in clinic.pairs.iter().zip(places) {
        if places.len() < FEWEST {
            continue;
        }
        let f = fundamental(&cameras[i], &cameras[j]);
        let mut offsets: Vec<f64> = places
            .iter()
            .map(
                |Place {
                     first: x,
                     second: y,
                     ..
                 }| {
                    let l = f * Vector3::new(x.x, x.y, 1.0);
                    l.dot(&Vector3::new(y.x, y.y, 1.0)) / l.xy().norm()
                },
            )
            .collect();
        sum += math::median(&mut offsets)?.abs();
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count)
}
