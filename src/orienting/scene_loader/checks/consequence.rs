//! What follows from the finding of the orientation check: a refusal or a warning, in words.

use crate::base::agreement::Agreement;
use crate::base::error::{Error, Result, listed};
use crate::orienting::orientation_check::{CheckFinding, CheckedView, OrientationCheck};

/// A warning, or the refusal of the scene. `refusal` is the one that the positions of the cameras
/// alone gave reason for; with `ignore_check` what the images contradict is only a warning.
pub(crate) fn warning_or_refusal(
    check: &OrientationCheck,
    views: &[CheckedView],
    refusal: Option<Error>,
    ignore_check: bool,
) -> Result<Option<String>> {
    let finding = &check.finding;
    let contradiction = |problem, advice: &str| Error::Contradiction {
        problem,
        advice: advice.to_owned(),
        report: Box::new(check.report()),
    };
    let disagreement = match finding {
        CheckFinding::Explained {
            before,
            after,
            words,
            ..
        } => Some((
            format!(
                "the images contradict their orientation: they agree to {:.2} as it stands, and to {:.2} if {words}",
                before.score, after.score
            ),
            "correct the orientation file, or have it corrected on loading (--apply-fix)",
        )),
        // Anything above chance is some evidence: small or blurred images reach no more.
        CheckFinding::Unexplained(agreement) if agreement.score <= 0.0 => Some((
            hardly_agree(agreement),
            "check that images and orientation belong together (names, folders, the same flight), or go on \
             nevertheless (--ignore-check)",
        )),
        _ => None,
    };
    if let (Some((problem, advice)), false) = (&disagreement, ignore_check) {
        // What the positions of the cameras say is more than that nothing explains it.
        if refusal.is_none() || matches!(finding, CheckFinding::Explained { .. }) {
            return Err(contradiction(problem.clone(), advice));
        }
    }
    match (finding, refusal) {
        (
            CheckFinding::Sound(agreement) | CheckFinding::Offset { agreement, .. },
            Some(refusal),
        ) => Err(contradiction(
            format!(
                "{} (but the images agree with one another to {:.2}, so it is the world that is turned or \
                 displaced)",
                problem_of(&refusal),
                agreement.score
            ),
            "the orientation is needed with Z up, in metres above the ground's height system",
        )),
        (_, Some(Error::Scene { problem, advice })) => Err(contradiction(problem, &advice)),
        (_, Some(refusal)) => Err(refusal),
        (_, None) => Ok(match disagreement {
            Some((problem, _)) => Some(problem),
            None => warning(finding, views),
        }),
    }
}

/// What is to be said of a finding that refuses nothing.
fn warning(finding: &CheckFinding, views: &[CheckedView]) -> Option<String> {
    match finding {
        CheckFinding::Offset {
            offsets_px: [before, after],
            words,
            ..
        } => Some(format!(
            "the images are offset against their orientation by {before:.2} px in the mean, and by {after:.2} px if {words}"
        )),
        CheckFinding::OutlierViews(_, outliers) => Some(format!(
            "views that agree with none of the others, although those agree: {} (check their orientation, or \
             leave them out)",
            listed(outliers.iter().map(|&i| views[i].name))
        )),
        CheckFinding::Sound(_) | CheckFinding::Unknown(_) | CheckFinding::Explained { .. } => None,
        CheckFinding::Unexplained(agreement) => Some(format!(
            "{}: check that they belong together",
            hardly_agree(agreement)
        )),
    }
}

fn hardly_agree(agreement: &Agreement) -> String {
    format!(
        "the images hardly agree with their orientation (to {:.2}, where 0 is chance and 1 perfect), and no usual \
         mistake explains it",
        agreement.score
    )
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
