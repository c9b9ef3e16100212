//! Decoding views: the part of each image that is used, without its distortion.

use super::planned_view::{PlannedView, offset_calibration};
use super::region;
use crate::base::error::{Error, Result};
use crate::orienting::orientation::{InputFile, Needed};
use crate::orienting::scene::View;
use crate::photographs::camera::undistort;
use crate::photographs::raster::{Coverage, PixelWindow, load_image, load_window};

/// Decodes all views, at the same time where that does not take much more memory.
pub(crate) fn decode_all(files: &[InputFile], planned: &[PlannedView]) -> Result<Vec<View>> {
    // Decoded photographs take up to six bytes a pixel: so many take 600 MB.
    const MOST_PIXELS_AT_ONCE: u64 = 100_000_000;
    let whole = |v: &PlannedView| v.size.map(u64::from).iter().product::<u64>();
    if planned.iter().map(whole).sum::<u64>() <= MOST_PIXELS_AT_ONCE {
        let views = crate::base::execution::map(planned, |_, view| decode(&files[view.file], view));
        views.into_iter().collect()
    } else {
        planned
            .iter()
            .map(|view| decode(&files[view.file], view))
            .collect()
    }
}

/// What decoding a view needs of its photograph.
pub(crate) fn needed(files: &[InputFile], planned: &PlannedView) -> Needed {
    Needed::of_window(files, planned.file, Windows::of(planned).stored)
}

/// The parts of an image that a view is made of: column, row, width and height.
struct Windows {
    /// Of the reduced image without its lens.
    part: PixelWindow,
    /// Of the reduced image.
    source: PixelWindow,
    /// Of the image before it is reduced: all pixels that the source covers.
    unreduced: PixelWindow,
    /// Of the image as it is stored.
    stored: PixelWindow,
    /// Is that all of it?
    is_all: bool,
}

impl Windows {
    fn of(planned: &PlannedView) -> Self {
        let whole = &planned.whole;
        let part = (planned.part).unwrap_or([0, 0, whole.width, whole.height]);
        let source = match &planned.distortion {
            Some(lens) => region::source_of(part, whole, lens),
            None => part,
        };
        let unreduced = planned.unreduced(source);
        let [full_width, full_height] = planned.size;
        let stored = match planned.turn {
            Some(turn) => turn.stored_window(unreduced, [full_height, full_width]),
            None => unreduced,
        };
        Self {
            part,
            source,
            unreduced,
            stored,
            is_all: unreduced == [0, 0, full_width, full_height],
        }
    }
}

/// Decodes the part of a view that is used, and removes its distortion.
fn decode(file: &InputFile, planned: &PlannedView) -> Result<View> {
    let whole = &planned.whole;
    let Windows {
        part,
        source,
        unreduced,
        stored,
        is_all,
    } = Windows::of(planned);
    let mut photograph = match is_all {
        true => load_image(&file.path, file.content())?,
        false => load_window(&file.path, file.content(), stored)?,
    };
    if photograph.rgb.dimensions() != (stored[2], stored[3]) {
        return Err(Error::file(
            &file.path,
            "its header and its content have different sizes",
            "save it anew in an image program, at full size",
        ));
    }
    if let Some(turn) = planned.turn {
        photograph = turn.apply(&photograph);
    }
    if planned.reduction > 1.0 {
        let [columns, rows] = [0, 1].map(|axis| {
            let range = |window: PixelWindow| {
                let [from, count] = [window[axis], window[axis + 2]].map(|pixels| pixels as usize);
                from..from + count
            };
            Coverage::new(range(source), planned.reduction, range(unreduced))
        });
        photograph = photograph.reduced(&columns, &rows);
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

#[cfg(test)]
mod tests {
    use crate::orienting::orientation::InputFile;
    use crate::orienting::scene_loader::{LoadOptions, load_scene};
    use crate::orienting::synthetic::{gable_scene, to_files};

    #[test]
    fn photographs_at_half_their_size_show_the_same_places() {
        let (scene, truth) = gable_scene(200);
        let files: Vec<InputFile> = (to_files(&scene).into_iter())
            .map(|(path, bytes)| InputFile::new(&path, bytes))
            .collect();
        let half = LoadOptions {
            reduction: Some(2.0),
            ..LoadOptions::default()
        };
        let (full, half) = (
            load_scene(&files, &LoadOptions::default()).unwrap(),
            load_scene(&files, &half).unwrap(),
        );
        assert!(
            half.warnings
                .iter()
                .any(|w| w.contains("at 50 % of their width"))
        );
        for (a, b) in full.views.iter().zip(&half.views) {
            assert_eq!((b.camera.width, b.camera.height), (100, 100));
            let blocks = a.gray.reduced(2).data;
            let mut both = b.gray.data.iter().zip(&blocks);
            assert!(both.all(|(b, a)| (b - a).abs() < 1e-6));
            for corner in truth.facets.iter().flat_map(|(_, ring)| ring) {
                let (p, q) = (a.camera.project(corner), b.camera.project(corner));
                let (p, q) = (p.unwrap().coords, q.unwrap().coords);
                assert!((p - 2.0 * q).norm() < 1e-6, "{p} {q}");
            }
        }
        // A part of them is a part of the reduced ones.
        let (x, y) = (full.origin.x, full.origin.y);
        let part = LoadOptions {
            roi: Some([x - 1.0, y - 1.0, x + 1.0, y + 1.0]),
            ground_z: Some(full.origin.z + truth.ground_z),
            reduction: Some(2.0),
            ..LoadOptions::default()
        };
        let part = load_scene(&files, &part).unwrap();
        for (whole, part) in half.views.iter().zip(&part.views) {
            let [column, row] = [0, 1].map(|i| whole.camera.k[(i, 2)] - part.camera.k[(i, 2)]);
            let (column, row) = (column.round() as usize, row.round() as usize);
            for (i, j) in [(0, 0), (3, 5)] {
                assert_eq!(part.gray.get(i, j), whole.gray.get(i + column, j + row));
            }
        }
        // No image is reduced to nothing.
        let most = LoadOptions {
            reduction: Some(1000.0),
            ..LoadOptions::default()
        };
        assert_eq!(load_scene(&files, &most).unwrap().views[0].camera.width, 64);
    }
}
