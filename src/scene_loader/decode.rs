//! Decoding views: the part of each image that is used, without its distortion.

use super::planned_view::{PlannedView, offset_calibration};
use super::region;
use crate::camera::undistort;
use crate::error::{Error, Result};
use crate::orientation::InputFile;
use crate::raster::{load_image, load_window};
use crate::scene::View;

/// Decodes all views, at the same time where that does not take much more memory.
pub(crate) fn decode_all(files: &[InputFile], planned: &[PlannedView]) -> Result<Vec<View>> {
    const MOST_PIXELS: u64 = 100_000_000;
    let whole = |v: &PlannedView| u64::from(v.whole.width) * u64::from(v.whole.height);
    if planned.iter().map(whole).sum::<u64>() <= MOST_PIXELS {
        let views = crate::execution::map(planned, |_, view| decode(&files[view.file], view));
        views.into_iter().collect()
    } else {
        planned
            .iter()
            .map(|view| decode(&files[view.file], view))
            .collect()
    }
}

/// Decodes the part of a view that is used, and removes its distortion.
fn decode(file: &InputFile, planned: &PlannedView) -> Result<View> {
    let whole = &planned.whole;
    let all = [0, 0, whole.width, whole.height];
    let part = planned.part.unwrap_or(all);
    let source = match &planned.distortion {
        Some(lens) => region::source_of(part, whole, lens),
        None => part,
    };
    let [full_width, full_height] = planned.full;
    // In the photograph's own pixels.
    let read = source.map(|side| side * planned.reduction);
    let stored = match planned.turn {
        Some(turn) => turn.stored_window(read, [full_height, full_width]),
        None => read,
    };
    let mut photograph = match read == [0, 0, full_width, full_height] {
        true => load_image(&file.path, &file.bytes)?,
        false => load_window(&file.path, &file.bytes, stored)?,
    };
    if photograph.rgb.dimensions() != (stored[2], stored[3]) {
        return Err(Error::File {
            file: file.path.clone(),
            problem: "its header and its content have different sizes".to_owned(),
            advice: "save it anew in an image program, at full size".to_owned(),
        });
    }
    if let Some(turn) = planned.turn {
        photograph = turn.apply(&photograph);
    }
    if planned.reduction > 1 {
        photograph = photograph.reduced(planned.reduction);
    }
    let [column, row, width, height] = part;
    if let Some(lens) = &planned.distortion {
        let k = offset_calibration(&whole.k, [source[0], source[1]]);
        photograph = undistort(&photograph, &k, lens);
    }
    if source != part {
        photograph = photograph.crop([column - source[0], row - source[1], width, height]);
    }
    Ok(View::new(
        planned.name.clone(),
        planned.camera(),
        photograph.gray,
        photograph.rgb,
    ))
}
