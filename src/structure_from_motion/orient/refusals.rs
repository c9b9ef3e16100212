//! Why photographs, or all of them together, have no orientation.

use super::photo::Photo;
use crate::error::Error;
use crate::structure_from_motion::block::Block;
use crate::structure_from_motion::incremental::VerifiedPair;
use crate::structure_from_motion::output::{LeftOut, NotJoined};
use crate::structure_from_motion::two_view::PairKind;

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

pub(super) fn refusal(problem: String, advice: &str) -> Error {
    Error::Scene {
        problem,
        advice: advice.to_owned(),
    }
}

pub(super) fn too_few(left_out: &[LeftOut]) -> Error {
    let named: Vec<String> = (left_out.iter().take(5))
        .map(|left| format!("{}: {}", left.file, left.reason.words()))
        .collect();
    refusal(
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
        return refusal(
            "no two photographs show enough of the same".to_owned(),
            "take photographs that overlap by two thirds, of things that do not move",
        );
    }
    if verified
        .iter()
        .all(|p| p.geometry.kind == PairKind::Rotation)
    {
        return refusal(
            "the photographs were taken from one place, the camera only turned: nothing shows depth"
                .to_owned(),
            "move the camera between photographs",
        );
    }
    refusal(
        format!("the {} photographs do not join", left_out.len()),
        "take photographs that overlap by two thirds, so that every place is in three of them, or \
         state the focal length in pixels",
    )
}
