//! What is doubtful of stated angles and positions, in words that lead to what is to be done.

use super::checks::Doubt;
use super::places::TooNear;
use super::positions::{Mistake, NoPositions};
use super::vertical::AnglesFinding;
use crate::base::error::listed;
use crate::orienting::structure_from_motion::ground_control::GeoList;

/// Of photographs whose headers state nothing.
pub(in super::super) const NOTHING_STATED: &str = "neither positions nor angles are stated";

/// The way to what a usual mistake means.
pub(in super::super) const OFFER: &str = "have them read so (--apply-fix)";

/// Angles that the others or the points contradict.
pub(super) fn of_angles(found: &AnglesFinding, is_mended: bool, paths: &[&str]) -> Vec<String> {
    if found.contradicted.is_empty() {
        return Vec::new();
    }
    let names = listed(found.contradicted.iter().map(|&i| paths[i]));
    let end = match (found.mistake, is_mended) {
        (Some(mistake), true) => format!("they were read as {mistake}"),
        (Some(mistake), false) => format!("they are left out; it looks like {mistake}: {OFFER}"),
        (None, _) => "they are left out: correct them in the headers".to_owned(),
    };
    let others = match &found.by_angles {
        Some(_) => "contradict the others and the ground",
        None => "contradict each other or the ground",
    };
    let count = found.contradicted.len();
    vec![format!(
        "the angles that {count} photographs state {others}: {names}; {end}"
    )]
}

/// Positions whose heights were set aside for this.
pub(super) fn of_heights(doubt: &Doubt) -> String {
    format!(
        "with their heights the stated positions {}: only their plan was taken; correct the heights \
         or the angles in the headers",
        doubt.words()
    )
}

/// Positions that a usual mistake explains.
pub(super) fn of_mistake(mistake: &Mistake) -> String {
    let end = match mistake.is_of_heights {
        true => "only their plan was taken",
        false => "they were not used",
    };
    format!(
        "the stated positions do not fit the photographs, and fit them with {}: {end}; correct them \
         in the headers or in {}",
        mistake.words,
        GeoList::FILE
    )
}

/// Positions that the others contradict.
pub(super) fn of_contradicted(photos: &[usize], paths: &[&str]) -> Option<String> {
    let names = listed(photos.iter().map(|&i| paths[i]));
    (!photos.is_empty()).then(|| {
        format!(
            "the stated positions of {} photographs are not where the others put them, and were left \
             out: {names}",
            photos.len()
        )
    })
}

/// Why positions that are stated do not give the frame.
pub(super) fn of_no_positions(why: &NoPositions) -> Option<String> {
    match why {
        NoPositions::Few { stated: 0 } | NoPositions::Exchanged => None,
        NoPositions::Few { stated } => Some(format!(
            "{stated} of the oriented photographs state a position, and a frame needs three"
        )),
        NoPositions::OnePlace { stated } => Some(format!(
            "all {stated} positions state one place, as of a receiver that found no satellites: they \
             give no scale"
        )),
        NoPositions::Near(TooNear { stated, noise_m }) => Some(format!(
            "the {stated} stated positions fit the photographs to {noise_m:.1} m only, which is as \
             much as they differ: they give no frame"
        )),
        NoPositions::Mirrored => Some(
            "the stated positions are those of a mirror, under which the cameras would be below the \
             ground: of latitude and longitude one has the wrong sign, as where a header leaves out \
             S or W, or both are exchanged; write GPSLatitudeRef and GPSLongitudeRef into the headers. They were not used"
                .to_owned(),
        ),
        NoPositions::Doubted(doubt) => Some(format!(
            "the stated positions {}: they were not used; correct them in the headers",
            doubt.words()
        )),
    }
}
