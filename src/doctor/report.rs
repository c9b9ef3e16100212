//! The doctor's findings as a table: what was assumed about the orientation, and how well the images agree with it.

use serde::Serialize;

use super::{Agreement, Diagnosis, Examination};

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

/// What the doctor found, in one word.
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

/// The findings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
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

impl Report {
    /// The table of an examination.
    pub fn new(examination: &Examination) -> Self {
        let blank = |finding, stated: &Agreement| Self {
            finding,
            stated: *stated,
            cured: None,
            offsets_px: None,
            mistake: None,
            trials: examination.trials.clone(),
        };
        match &examination.diagnosis {
            Diagnosis::Sound(stated) => blank(Finding::Sound, stated),
            Diagnosis::Unknown(stated) => blank(Finding::Unknown, stated),
            Diagnosis::Unexplained(stated) => blank(Finding::Unexplained, stated),
            Diagnosis::Odd(stated, _) => blank(Finding::Odd, stated),
            Diagnosis::Explained {
                before,
                after,
                words,
                ..
            } => Self {
                cured: Some(*after),
                mistake: Some(words.clone()),
                ..blank(Finding::Explained, before)
            },
            Diagnosis::Offset {
                agreement,
                offsets_px,
                words,
                ..
            } => Self {
                offsets_px: Some(*offsets_px),
                mistake: Some(words.clone()),
                ..blank(Finding::Offset, agreement)
            },
        }
    }
}
