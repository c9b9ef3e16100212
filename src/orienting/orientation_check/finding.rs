//! What the orientation check finds, and its report.

use super::error_hypothesis::ErrorHypothesis;
use crate::base::agreement::{Agreement, AgreementReport, Finding, TestedHypothesis};
use crate::orienting::scene::ViewShift;

/// How the images agree with their orientation.
#[derive(Clone, Debug, PartialEq)]
pub enum CheckFinding {
    /// Images and orientation agree.
    Sound(Agreement),
    /// Too little of the images can be matched for a finding.
    Unknown(Agreement),
    /// They do not agree; without this error they would.
    Explained {
        /// As stated.
        before: Agreement,
        /// Without the error.
        after: Agreement,
        /// The error.
        hypothesis: ErrorHypothesis,
        /// The error in words.
        words: String,
    },
    /// They agree, except for an offset of half a pixel.
    Offset {
        /// The error.
        hypothesis: ErrorHypothesis,
        /// As stated.
        agreement: Agreement,
        /// Mean offset across the epipolar lines, pixels: as stated and without the error.
        offsets_px: [f64; 2],
        /// The error in words.
        words: String,
    },
    /// These views agree with no other one, the others agree.
    OutlierViews(Agreement, Vec<usize>),
    /// They do not agree, and none of the usual errors explains it.
    Unexplained(Agreement),
}

/// A finding, and measurements that only consistent views allow.
#[derive(Clone, Debug, PartialEq)]
pub struct OrientationCheck {
    /// The finding.
    pub finding: CheckFinding,
    /// Shifts of the views against each other, pixels; empty where too little is matched.
    pub shifts: Vec<ViewShift>,
    /// Hypotheses that were tested where the views do not agree, the best first.
    pub tested: Vec<TestedHypothesis>,
}

impl From<CheckFinding> for OrientationCheck {
    fn from(finding: CheckFinding) -> Self {
        Self {
            finding,
            shifts: Vec::new(),
            tested: Vec::new(),
        }
    }
}

impl OrientationCheck {
    /// The report for users and programs.
    pub fn report(&self) -> AgreementReport {
        let blank = |finding, stated: &Agreement| AgreementReport {
            finding,
            stated: *stated,
            corrected: None,
            offsets_px: None,
            error: None,
            tested: self.tested.clone(),
        };
        match &self.finding {
            CheckFinding::Sound(stated) => blank(Finding::Sound, stated),
            CheckFinding::Unknown(stated) => blank(Finding::Unknown, stated),
            CheckFinding::Unexplained(stated) => blank(Finding::Unexplained, stated),
            CheckFinding::OutlierViews(stated, _) => blank(Finding::OutlierViews, stated),
            CheckFinding::Explained {
                before,
                after,
                words,
                ..
            } => AgreementReport {
                corrected: Some(*after),
                error: Some(words.clone()),
                ..blank(Finding::Explained, before)
            },
            CheckFinding::Offset {
                agreement,
                offsets_px,
                words,
                ..
            } => AgreementReport {
                offsets_px: Some(*offsets_px),
                error: Some(words.clone()),
                ..blank(Finding::Offset, agreement)
            },
        }
    }
}
