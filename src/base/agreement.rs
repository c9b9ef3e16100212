//! How well images and their orientation agree: what the orientation check reports.

use serde::Serialize;

/// How well images and orientation agree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Agreement {
    /// Points that were matched, on the epipolar line or beside it.
    pub points: usize,
    /// Of these, the share matched on the epipolar line, rescaled so that chance gives about 0 and
    /// a perfect orientation 1; the lower end of its confidence interval.
    pub score: f64,
}

/// A hypothesis about an error in the orientation that was tested on the images.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct TestedHypothesis {
    /// The hypothesis in words.
    #[serde(rename = "words")]
    pub hypothesis: String,
    /// How well the images agree without that error.
    pub agreement: Agreement,
    /// Was it tested on all pairs of views, or on a few of them for a first ranking?
    pub all_pairs: bool,
}

/// How the images agree with their orientation, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum Finding {
    /// Images and orientation agree.
    Sound,
    /// Too little of the images can be matched.
    Unknown,
    /// They do not agree; without one error they would.
    Explained,
    /// They agree, except for half a pixel.
    Offset,
    /// Some views agree with no other one.
    #[serde(rename = "odd")]
    OutlierViews,
    /// They do not agree, and no usual error explains it.
    Unexplained,
}

/// The report of the orientation check: agreement as stated, the error found, and the hypotheses
/// tested.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct AgreementReport {
    /// The finding.
    pub finding: Finding,
    /// Agreement as the orientation is stated.
    pub stated: Agreement,
    /// Agreement without the error, where one was found.
    #[serde(rename = "cured")]
    pub corrected: Option<Agreement>,
    /// Mean offset across the epipolar lines, pixels, as stated and without the error, where that
    /// is the finding.
    pub offsets_px: Option<[f64; 2]>,
    /// The error that loading can correct, in words.
    #[serde(rename = "mistake")]
    pub error: Option<String>,
    /// The hypotheses that were tested, the best first; those tested on all pairs before the
    /// others.
    #[serde(rename = "trials")]
    pub tested: Vec<TestedHypothesis>,
}
