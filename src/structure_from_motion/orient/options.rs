//! What is asked for, and what comes out.

use crate::structure_from_motion::features::FeatureOptions;
use crate::structure_from_motion::output::{OrientReport, SparseModel};

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
    /// `words` say what it is. `false`, and nothing happens, where one of them is no length.
    pub fn set_length(&mut self, measured: f64, metres: f64, words: &str) -> bool {
        let factor = metres / measured;
        let is_length = |length: f64| length.is_finite() && length > 0.0;
        if !is_length(measured) || !is_length(metres) || !is_length(factor) {
            return false;
        }
        self.model.scale(factor);
        self.report.scale(factor, &format!("{words}, {metres} m"));
        true
    }
}
