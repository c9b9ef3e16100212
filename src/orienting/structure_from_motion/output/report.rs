//! What an orientation rests on and how good it is: for programs as JSON, for people as text.

use std::fmt::Write;

use serde::Serialize;

use super::coverage::PlanCoverage;
use super::sheet::{control_tables, worth_words};
use crate::orienting::orientation::FrameSigma;
use crate::orienting::structure_from_motion::frame::Lag;
use crate::orienting::structure_from_motion::ground_control::ControlResidual;

/// Why a photograph has no orientation.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "reason", rename_all = "snake_case")]
pub enum NotJoined {
    /// It cannot be decoded.
    Unreadable {
        /// What the decoder says.
        problem: String,
    },
    /// It shows hardly any keypoints: blurred, or without texture.
    FewFeatures {
        /// How many.
        keypoints: usize,
    },
    /// No other photograph shows enough of the same.
    NoOverlap,
    /// It was taken from the place of those that it overlaps with, and only turned.
    OnlyTurned,
    /// It overlaps with others, but sees too few of the block's points.
    FewPoints {
        /// Photographs that it overlaps with.
        partners: usize,
    },
}

impl NotJoined {
    /// In words, with what to do.
    pub fn words(&self) -> String {
        match self {
            Self::Unreadable { problem } => problem.clone(),
            Self::FewFeatures { keypoints } => format!(
                "{keypoints} keypoints: it is blurred or shows no texture; leave it out or take a \
                 sharp one"
            ),
            Self::NoOverlap => {
                "no other photograph shows enough of the same; add photographs between them".into()
            }
            Self::OnlyTurned => {
                "taken from the same place as those it overlaps with, only turned; move the camera \
                 between photographs"
                    .into()
            }
            Self::FewPoints { partners } => format!(
                "it overlaps with {partners} others, but shares too few points with the block; add \
                 photographs between them"
            ),
        }
    }
}

/// An oriented photograph.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PhotoReport {
    /// Its path.
    pub file: String,
    /// Rays to points of the block.
    pub rays: usize,
    /// Root mean square reprojection error, pixels.
    pub rms_px: f64,
    /// Standard deviations of its position, x y z: metres in the datum of all positions.
    pub sigma_m: Option<[f64; 3]>,
    /// Standard deviation of its rotation about its worst axis, degrees.
    pub sigma_deg: Option<f64>,
    /// Photographs that share at least fifteen points with it.
    pub partners: usize,
    /// Distance from its stated position, x y z: metres.
    pub from_stated_m: Option<[f64; 3]>,
    /// What is left of that without the lag of the receiver, where one was taken out.
    pub residual_m: Option<[f64; 3]>,
}

/// A calibrated camera.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CameraReport {
    /// As EXIF names it.
    pub name: String,
    /// Photographs that it took.
    pub photos: usize,
    /// Focal length at the start, pixels.
    pub stated_focal_px: f64,
    /// Was it stated, or guessed?
    pub is_stated: bool,
    /// f, k1, k2, cx, cy after the adjustment.
    pub parameters: [f64; 5],
    /// Their standard deviations; 0 where held.
    pub sigmas: Option<[f64; 5]>,
}

/// A photograph without orientation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// Its path.
    pub file: String,
    /// Why.
    #[serde(flatten)]
    pub reason: NotJoined,
}

/// The report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OrientReport {
    /// What the frame rests on, in a sentence.
    pub frame: String,
    /// Longitude, latitude (degrees) and height (metres) of the frame's zero, where known.
    pub anchor: Option<crate::orienting::orientation::Anchor>,
    /// EPSG code of the frame's map, where it is known; files state positions in its unit, and
    /// those here are metres.
    pub epsg: Option<u32>,
    /// What files in the frame's map add to the coordinates of the model, metres.
    pub offset: [f64; 3],
    /// Is the scale that of the world?
    pub is_metric: bool,
    /// What scale and level of the frame are worth, where that is known.
    pub frame_sigma: Option<FrameSigma>,
    /// By how much stated positions are late, where they give the frame and tell.
    pub lag: Option<Lag>,
    /// Ground control points and check points, where they give the frame.
    pub control: Vec<ControlResidual>,
    /// World points.
    pub points: usize,
    /// Rays to them.
    pub rays: usize,
    /// Mean number of rays of a point.
    pub rays_a_point: f64,
    /// Root mean square reprojection error, pixels.
    pub rms_px: f64,
    /// Cameras.
    pub cameras: Vec<CameraReport>,
    /// Oriented photographs.
    pub photos: Vec<PhotoReport>,
    /// The others.
    pub left_out: Vec<LeftOut>,
    /// Pairs whose matches agree with one geometry: indices of `photos` and shared points.
    pub overlap: Vec<(usize, usize, usize)>,
    /// What the photographs show of the area.
    pub coverage: Option<PlanCoverage>,
    /// What is doubtful.
    pub warnings: Vec<String>,
}

impl OrientReport {
    /// As JSON.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a report holds only numbers and names")
    }

    /// As text.
    pub fn to_text(&self) -> String {
        let table = self.table() + &control_tables(&self.control);
        self.block_words() + &table + &self.remarks()
    }

    /// The same without a row for each photograph and control point.
    pub fn in_short(&self) -> String {
        self.block_words() + &self.remarks()
    }

    /// What the photographs show of the area, and where another one would tell most, a sentence
    /// each.
    pub fn coverage_words(&self) -> Vec<String> {
        (self.coverage.as_ref()).map_or_else(Vec::new, |coverage| coverage.words(self.offset))
    }

    /// What scale and level of the frame are worth, and the lag of the receiver, a sentence each.
    pub fn worth(&self) -> Vec<String> {
        worth_words(self.frame_sigma.as_ref(), self.lag.as_ref())
    }

    /// The block as a whole, and its cameras.
    fn block_words(&self) -> String {
        let mut text = format!(
            "{} of {} photographs oriented, {} points, {:.2} rays a point, rms {:.3} px\n{}\n",
            self.photos.len(),
            self.photos.len() + self.left_out.len(),
            self.points,
            self.rays_a_point,
            self.rms_px,
            self.frame
        );
        for words in self.worth().into_iter().chain(self.coverage_words()) {
            text += &(words + "\n");
        }
        for camera in &self.cameras {
            text += &camera.words();
        }
        text
    }

    /// A row for each photograph.
    fn table(&self) -> String {
        let mut text = String::new();
        let widest = self
            .photos
            .iter()
            .map(|p| p.file.chars().count())
            .max()
            .unwrap_or(0);
        let width = widest.max("photograph".len());
        let unit = if self.is_metric { "m" } else { "units" };
        let _ = writeln!(
            text,
            "{:<width$}  rays  partners  rms px  sigma x, y, z ({unit})      sigma deg",
            "photograph"
        );
        for p in &self.photos {
            let sigma = p.sigma_m.map_or_else(
                || format!("{:>27}", "-"),
                |[x, y, z]| format!("{x:>9.4}{y:>9.4}{z:>9.4}"),
            );
            let turn = p
                .sigma_deg
                .map_or_else(|| "-".to_owned(), |s| format!("{s:.4}"));
            let _ = writeln!(
                text,
                "{:<width$}{:>6}{:>10}{:>8.3}{sigma}{turn:>11}",
                p.file, p.rays, p.partners, p.rms_px
            );
        }
        text
    }

    /// What is left out, and warnings.
    fn remarks(&self) -> String {
        let mut text = String::new();
        for left in &self.left_out {
            let _ = writeln!(text, "not oriented: {}: {}", left.file, left.reason.words());
        }
        for warning in &self.warnings {
            let _ = writeln!(text, "warning: {warning}");
        }
        text
    }
}

impl CameraReport {
    fn words(&self) -> String {
        let names = ["f", "k1", "k2", "cx", "cy"];
        let values: Vec<String> = (0..5)
            .map(|i| {
                let digits = if matches!(i, 1 | 2) { 5 } else { 2 };
                let value = self.parameters[i];
                match self.sigmas.map(|s| s[i]) {
                    Some(sigma) if sigma > 0.0 => {
                        format!("{} {value:.digits$} +- {sigma:.digits$}", names[i])
                    }
                    _ => format!("{} {value:.digits$} (held)", names[i]),
                }
            })
            .collect();
        let name = if self.name.is_empty() {
            "camera"
        } else {
            &self.name
        };
        let origin = if self.is_stated { "stated" } else { "guessed" };
        format!(
            "{name}, {} photographs: {}; {origin} f {:.1} px\n",
            self.photos,
            values.join(", "),
            self.stated_focal_px
        )
    }
}
