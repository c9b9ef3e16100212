//! Lengths measured in photographs: two places, each from where a person marks it.

use nalgebra::{Matrix3, Point2, Point3};
use serde::Serialize;

use super::sparse_model::SparseModel;
use crate::base::least_squares::{Loss, NormalEquations, Stop, fit};
use crate::orienting::structure_from_motion::ground_control::MARK_SIGMA_PX;
use crate::orienting::structure_from_motion::resection::linearised;
use crate::orienting::structure_from_motion::triangulation::{LEAST_ANGLE, angle, nearest_point};

/// A length between two places in the frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct MeasuredLength {
    /// In the frame's unit.
    pub length: f64,
    /// Its standard deviation by the marks, in the same unit.
    pub sigma: f64,
    /// Root mean square distance of the marks from the images of the places, pixels.
    pub rms_px: f64,
    /// The places: x, y, z in the frame.
    pub ends: [[f64; 3]; 2],
}

/// Why a length cannot be measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotMeasured {
    /// An end is marked in fewer than two oriented photographs.
    FewMarks,
    /// The rays of an end are almost parallel, or do not meet in front of the cameras.
    NoMeeting,
}

impl NotMeasured {
    /// In words, with what to do.
    pub fn words(self) -> &'static str {
        match self {
            Self::FewMarks => "mark both ends in two or more photographs each",
            Self::NoMeeting => {
                "the rays of an end do not meet: mark it in photographs from places further apart, \
                 and look whether the marks show the same"
            }
        }
    }
}

/// A place, its covariance by marks of one pixel, and the squared distances of its marks, pixels.
struct Place {
    point: Point3<f64>,
    covariance: Matrix3<f64>,
    squares: Vec<f64>,
}

impl SparseModel {
    /// The length between two places, each marked in photographs: paths, and pixels as they are
    /// stored.
    ///
    /// # Errors
    /// Where a place does not follow from its marks.
    pub fn measure_length(
        &self,
        ends: [&[(String, Point2<f64>)]; 2],
    ) -> Result<MeasuredLength, NotMeasured> {
        let [a, b] = ends.map(|marks| self.place(marks));
        let [a, b] = [a?, b?];
        let apart = b.point - a.point;
        let length = apart.norm();
        let along = apart.try_normalize(0.0).ok_or(NotMeasured::NoMeeting)?;
        let squares: f64 = a.squares.iter().chain(&b.squares).sum();
        let marks = (a.squares.len() + b.squares.len()) as f64;
        // Two coordinates a mark, less three of each place.
        let of_marks = (squares / (2.0 * marks - 6.0)).sqrt().max(MARK_SIGMA_PX);
        let variance = along.dot(&((a.covariance + b.covariance) * along));
        Ok(MeasuredLength {
            length,
            sigma: of_marks * variance.max(0.0).sqrt(),
            rms_px: (squares / marks).sqrt(),
            ends: [a.point.into(), b.point.into()],
        })
    }

    /// Where the rays of marks meet: the least sum of squared distances in the photographs.
    fn place(&self, marks: &[(String, Point2<f64>)]) -> Result<Place, NotMeasured> {
        let seen: Vec<_> = (marks.iter())
            .filter_map(|(path, pixel)| {
                let photo = self.photos.iter().find(|p| p.path == *path)?;
                Some((&photo.pose, &self.cameras[photo.camera], pixel))
            })
            .collect();
        if seen.len() < 2 {
            return Err(NotMeasured::FewMarks);
        }
        let rays: Vec<_> = (seen.iter())
            .map(|(pose, camera, pixel)| (pose.center, pose.direction(&camera.ray(pixel))))
            .collect();
        let widest = (rays.iter().enumerate())
            .flat_map(|(i, (_, a))| rays[..i].iter().map(move |(_, b)| angle(a, b)))
            .fold(0.0, f64::max);
        if widest < LEAST_ANGLE {
            return Err(NotMeasured::NoMeeting);
        }
        let start = nearest_point(rays).ok_or(NotMeasured::NoMeeting)?;
        let equations = |point: &Point3<f64>| {
            let mut equations = NormalEquations::default();
            for (pose, camera, pixel) in &seen {
                let (residual, _, _, by_point) = linearised(pose, camera, point, pixel)?;
                equations.add(&residual, &by_point, Loss::Squares);
            }
            Some(equations)
        };
        let (point, equations) = fit(start, equations, |at, step| at + step, Stop::default())
            .ok_or(NotMeasured::NoMeeting)?;
        let covariance = equations.inverse().ok_or(NotMeasured::NoMeeting)?;
        let squares: Option<Vec<f64>> = (seen.iter())
            .map(|(pose, camera, pixel)| {
                let (residual, ..) = linearised(pose, camera, &point, pixel)?;
                Some(residual.norm_squared())
            })
            .collect();
        Ok(Place {
            point,
            covariance,
            squares: squares.ok_or(NotMeasured::NoMeeting)?,
        })
    }
}
