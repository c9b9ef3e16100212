//! The doctor's diagnosis in the words of a refusal or a warning.

use super::names::listed;
use crate::error::{Error, Result};
use crate::orientation_check::{Diagnosis, Examination, Patient};

/// A warning, or the refusal of the scene. `refusal` is what the places of the cameras alone gave reason to say.
pub(crate) fn verdict(
    examination: &Examination,
    patients: &[Patient],
    refusal: Option<Error>,
) -> Result<Option<String>> {
    let diagnosis = &examination.diagnosis;
    let contradiction = |problem, advice: &str| Error::Contradiction {
        problem,
        advice: advice.to_owned(),
        report: Box::new(examination.report()),
    };
    if let Diagnosis::Explained {
        before,
        after,
        words,
        ..
    } = diagnosis
    {
        return Err(contradiction(
            format!(
                "the images contradict their orientation: they agree to {:.2} as it stands, and to {:.2} if {words}",
                before.score, after.score
            ),
            "correct the orientation file, export it again, or have it corrected on loading (--apply-fix)",
        ));
    }
    if let Some(refusal) = refusal {
        return Err(match (diagnosis, refusal) {
            (Diagnosis::Sound(agreement) | Diagnosis::Offset { agreement, .. }, refusal) => {
                contradiction(
                    format!(
                        "{} (but the images agree with one another to {:.2}, so it is the world that is turned or \
                         displaced)",
                        problem_of(&refusal),
                        agreement.score
                    ),
                    "export the orientation with Z up, in metres above the ground's height system",
                )
            }
            (_, Error::Scene { problem, advice }) => contradiction(problem, &advice),
            (_, refusal) => refusal,
        });
    }
    Ok(match diagnosis {
        Diagnosis::Offset {
            offsets_px: [before, after],
            words,
            ..
        } => Some(format!(
            "the images are offset against their orientation by {before:.2} px in the mean, and by {after:.2} px if {words}"
        )),
        Diagnosis::Odd(_, odd) => Some(format!(
            "views that agree with none of the others, although those agree: {} (check their orientation, or \
             leave them out)",
            listed(odd.iter().map(|&i| patients[i].name))
        )),
        Diagnosis::Unexplained(agreement) => Some(format!(
            "the images hardly agree with their orientation (to {:.2}, where 0 is chance and 1 perfect), and no usual \
             mistake explains it: check that they belong together",
            agreement.score
        )),
        Diagnosis::Sound(_) | Diagnosis::Unknown(_) | Diagnosis::Explained { .. } => None,
    })
}

/// A refusal without its advice.
fn problem_of(error: &Error) -> String {
    match error {
        Error::File { file, problem, .. } => format!("{file}: {problem}"),
        Error::Scene { problem, .. }
        | Error::Line { problem, .. }
        | Error::Contradiction { problem, .. } => problem.clone(),
    }
}
