//! The findings of the orientation check as a table.

use super::{Diagnosis, Examination};
use crate::agreement::{Agreement, AgreementReport, Finding};

impl Examination {
    /// Its table.
    pub fn report(&self) -> AgreementReport {
        let blank = |finding, stated: &Agreement| AgreementReport {
            finding,
            stated: *stated,
            cured: None,
            offsets_px: None,
            mistake: None,
            trials: self.trials.clone(),
        };
        match &self.diagnosis {
            Diagnosis::Sound(stated) => blank(Finding::Sound, stated),
            Diagnosis::Unknown(stated) => blank(Finding::Unknown, stated),
            Diagnosis::Unexplained(stated) => blank(Finding::Unexplained, stated),
            Diagnosis::Odd(stated, _) => blank(Finding::Odd, stated),
            Diagnosis::Explained {
                before,
                after,
                words,
                ..
            } => AgreementReport {
                cured: Some(*after),
                mistake: Some(words.clone()),
                ..blank(Finding::Explained, before)
            },
            Diagnosis::Offset {
                agreement,
                offsets_px,
                words,
                ..
            } => AgreementReport {
                offsets_px: Some(*offsets_px),
                mistake: Some(words.clone()),
                ..blank(Finding::Offset, agreement)
            },
        }
    }
}
