//! Why photographs, or all of them together, have no orientation.

use super::photo::Photo;
use crate::base::error::{Error, Result};
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::bundle::Covariance;
use crate::orienting::structure_from_motion::incremental::VerifiedPair;
use crate::orienting::structure_from_motion::intrinsics::{Intrinsics, STATED_FOCAL_PRIOR};
use crate::orienting::structure_from_motion::output::{LeftOut, NotJoined};
use crate::orienting::structure_from_motion::two_view::PairKind;
use crate::orienting::structure_from_motion::verification::Guess;

/// Why the photographs that were read have no orientation.
pub(super) fn not_joined(
    photos: &[Photo],
    block: &Block,
    verified: &[VerifiedPair],
) -> Vec<LeftOut> {
    let reason = |photo: usize| {
        let own = || verified.iter().filter(|p| p.photos.contains(&photo));
        if own().next().is_none() {
            NotJoined::NoOverlap
        } else if own().all(|p| p.geometry.kind == PairKind::Rotation) {
            NotJoined::OnlyTurned
        } else {
            NotJoined::FewPoints {
                partners: own().count(),
            }
        }
    };
    (0..photos.len())
        .filter(|&i| block.photos[i].pose.is_none())
        .map(|i| LeftOut {
            file: photos[i].path.to_owned(),
            reason: reason(i),
        })
        .collect()
}

pub(super) fn too_few(left_out: &[LeftOut]) -> Error {
    let named: Vec<String> = (left_out.iter().take(5))
        .map(|left| format!("{}: {}", left.file, left.reason.words()))
        .collect();
    Error::scene(
        format!(
            "fewer than three photographs are of use ({})",
            named.join("; ")
        ),
        "give three or more sharp photographs that overlap",
    )
}

/// Why no block arose.
pub(super) fn unconnected(verified: &[VerifiedPair], left_out: &[LeftOut]) -> Error {
    if verified.is_empty() {
        return Error::scene(
            "no two photographs show enough of the same",
            "take photographs that overlap by two thirds, of things that do not move",
        );
    }
    if verified
        .iter()
        .all(|p| p.geometry.kind == PairKind::Rotation)
    {
        return Error::scene(
            "the photographs were taken from one place, the camera only turned: nothing shows depth",
            "move the camera between photographs",
        );
    }
    Error::scene(
        format!("the {} photographs do not join", left_out.len()),
        "take photographs that overlap by two thirds, so that every place is in three of them, or \
         state the focal length in pixels",
    )
}

/// What to do about a stated focal length that is not that of the photographs.
const OTHER_FOCAL: &str = "state the focal length in pixels, or leave out photographs that were \
    cut, or whose headers belong to other ones";

/// Of photographs that do not join: a stated focal length and a likelier one.
pub(super) fn contradicted_focal(guesses: &[&Guess]) -> Option<Error> {
    let [stated, other] = guesses else {
        return None;
    };
    if stated.is_guessed.contains(&true) {
        return None;
    }
    let [f, likelier] = [stated, other].map(|g| g.cameras.first().map_or(0.0, |c| c.focal));
    Some(Error::scene(
        format!(
            "the photographs contradict the stated focal length of {f:.0} px: two by two they fit \
             {likelier:.0} px better, and do not join under either"
        ),
        OTHER_FOCAL,
    ))
}

/// Refuses a block that contradicts what is stated of its cameras, and knows less of their focal
/// lengths than a header would say.
///
/// # Errors
/// Where the focal length of a camera is not determined.
pub(super) fn undetermined_focal(
    found: &[Intrinsics],
    stated: &[Intrinsics],
    covariance: Option<&Covariance>,
) -> Result<()> {
    for (i, (found, stated)) in found.iter().zip(stated).enumerate() {
        let sigma = covariance.map_or(f64::INFINITY, |c| c.cameras[i][0]);
        if sigma > STATED_FOCAL_PRIOR * found.focal {
            return Err(Error::scene(
                format!(
                    "the photographs contradict the stated focal length of {:.0} px, and do not say \
                     which it is ({:.0} +- {sigma:.0} px)",
                    stated.focal, found.focal
                ),
                OTHER_FOCAL,
            ));
        }
    }
    Ok(())
}
