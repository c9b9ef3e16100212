//! How well images and their orientation agree: what the orientation check reports.

use serde::Serialize;

/// How well images and orientation agree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Agreement {
    /// Points that were found again, on any line.
    pub points: usize,
    /// Of these, the share found on the epipolar line, less what chance puts there: about 0 for a wrong orientation, 1
    /// for a perfect one; the lower end of its confidence interval.
    pub score: f64,
}

/// An assumption that was tried on the images.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// The assumption.
    pub words: String,
    /// How well the images agree with it.
    pub agreement: Agreement,
    /// Was it tried on all pairs of views, or on a few of them for a first impression?
    pub all_pairs: bool,
}

/// What the images say of their orientation, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Finding {
    /// Images and orientation agree.
    Sound,
    /// The images show too little to tell.
    Unknown,
    /// They do not agree; without one mistake they would.
    Explained,
    /// They agree, but for half a pixel.
    Offset,
    /// Some views agree with no other one.
    Odd,
    /// They do not agree, and no usual mistake explains it.
    Unexplained,
}

/// What was assumed about the orientation, and how well the images agree with it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AgreementReport {
    /// The finding.
    pub finding: Finding,
    /// Agreement as the orientation is stated.
    pub stated: Agreement,
    /// Agreement without the mistake, where one was found.
    pub cured: Option<Agreement>,
    /// Mean offset across the epipolar lines, pixels, as stated and without the mistake, where that is the finding.
    pub offsets_px: Option<[f64; 2]>,
    /// The mistake that loading can undo, in words.
    pub mistake: Option<String>,
    /// What was tried, the best first; those tried on all pairs before the others.
    pub trials: Vec<Trial>,
}
