//! What is asked for, and what comes out.

use nalgebra::{Point3, Vector3};

use crate::base::error::{Error, Result};
use crate::base::geometry::mean_point;
use crate::orienting::structure_from_motion::features::FeatureOptions;
use crate::orienting::structure_from_motion::output::{OrientReport, PlanCoverage, SparseModel};

/// How photographs are oriented.
#[derive(Clone, Debug, Default)]
pub struct OrientOptions {
    /// Working size and number of features.
    pub features: FeatureOptions,
    /// Focal length of all photographs, pixels, instead of what their headers state.
    pub focal_px: Option<f64>,
    /// Keep the principal point in the middle of the photographs, also where the block determines
    /// it.
    pub holds_center: bool,
    /// Read a list of control points or stated angles whose usual mistake is known as they were
    /// meant, instead of leaving them out.
    pub applies_fix: bool,
}

/// Oriented photographs.
#[derive(Clone, Debug)]
pub struct Oriented {
    /// Cameras, poses and points.
    pub model: SparseModel,
    /// How good they are.
    pub report: OrientReport,
}

impl Oriented {
    /// COLMAP's text model and the report, by name.
    pub fn files(&self) -> Vec<(String, Vec<u8>)> {
        let mut files = self.model.colmap_files();
        files.push((
            "orientation.json".into(),
            self.report.to_json().into_bytes(),
        ));
        files.push(("orientation.log".into(), self.report.to_text().into_bytes()));
        files
    }

    /// Sets the scale by a known length: what measures `measured` in the frame becomes `metres`;
    /// `words` say what it is. Where stated positions give the frame, their mean stays in its
    /// place, and so do the coordinates on the Earth.
    ///
    /// # Errors
    /// Where one of them is no length, or ground control points give the scale; nothing happens.
    pub fn set_length(&mut self, measured: f64, metres: f64, words: &str) -> Result<()> {
        let factor = metres / measured;
        let is_length = |length: f64| length.is_finite() && length > 0.0;
        if !is_length(measured) || !is_length(metres) || !is_length(factor) {
            return Err(Error::scene(
                format!("{measured} in the frame, {metres} m in the world: no length"),
                "measure two places that are apart",
            ));
        }
        if !self.report.control.is_empty() {
            return Err(Error::scene(
                "the ground control points give the scale",
                "correct them, or leave them out",
            ));
        }
        let centers: Vec<Point3<f64>> = self.model.photos.iter().map(|p| p.pose.center).collect();
        let fixed = match self.report.anchor {
            Some(_) => mean_point(&centers),
            None => Point3::origin(),
        };
        self.model.scale(factor, &fixed);
        let moved: Vec<Vector3<f64>> = (self.model.photos.iter().zip(&centers))
            .map(|(photo, before)| photo.pose.center - before)
            .collect();
        (self.report).scale(factor, &moved, &format!("{words}, {metres} m"));
        self.report.coverage = PlanCoverage::of(&self.model, self.report.anchor.as_ref());
        Ok(())
    }
}
