//! How much memory a run takes, and whether that is allowed.

use super::decode::needed;
use super::planned_view::PlannedView;
use crate::base::error::Error;
use crate::orienting::orientation::{InputFile, Needed};
use crate::photographs::raster::decoding_bytes;

/// Bytes that one pixel of a view takes as long as there are views: colours (3) and grey values
/// (4).
const VIEW_BYTES: u64 = 7;

/// Bytes that the stages take at their peak for one pixel of a view, beside roofs: grey values in a
/// reduced copy (4), segments, their matches, and how views agree on every plane. Measured over
/// whole runs, as the following ones: docs/formats.md.
const STAGE_BYTES: u64 = 12;

/// Bytes that a square metre of roof takes: what is known of every plane in every cell of the plan,
/// 2100 pairs of 40 bytes, twice while they are sorted.
const ROOF_BYTES: f64 = 170e3;

/// Bytes for a pixel that roofs take where nobody knows how many there are.
const UNKNOWN_ROOF_BYTES: u64 = 20;

/// Bytes that everything else takes.
const BASE_BYTES: u64 = 20 << 20;

/// Memory for a scene where no limit is given, megabytes. Assumption: a page on a machine of 8 GB
/// has 1.2 GB to spare.
const MEMORY_MB: u32 = if cfg!(target_arch = "wasm32") {
    1200
} else {
    32 << 10
};

/// Peak memory of a run with these views, bytes: while they are decoded, when what is needed of
/// their photographs is in memory, or in the stages; `roofs_m2` has the area of the roofs, square
/// metres, where it is known.
pub(crate) fn peak_bytes(files: &[InputFile], views: &[PlannedView], roofs_m2: Option<f64>) -> u64 {
    let heads: u64 = files.iter().map(InputFile::head_length).sum();
    let filled = Needed::merged(views.iter().map(|view| needed(files, view)), files);
    let read: u64 = filled.iter().map(|one| one.bytes(files)).sum();
    let pixels: u64 = views.iter().map(PlannedView::pixels).sum();
    let decoding = views.iter().map(|v| {
        let chunk = decoding_bytes(files[v.file].content(), v.size);
        // Without its lens, turned, or before it is reduced, a view is a second image of its size.
        let is_copied = v.distortion.is_some() || v.turn.is_some() || v.reduction > 1.0;
        let unreduced = (v.pixels() as f64 * v.reduction * v.reduction) as u64;
        chunk + if is_copied { unreduced * VIEW_BYTES } else { 0 }
    });
    // Views are decoded at the same time when there is room, one by one otherwise.
    let loading = read + decoding.max().unwrap_or(0);
    let of_roofs = roofs_m2.map_or(pixels * UNKNOWN_ROOF_BYTES, |m2| (m2 * ROOF_BYTES) as u64);
    let stages = pixels * STAGE_BYTES + of_roofs;
    BASE_BYTES + heads + pixels * VIEW_BYTES + loading.max(stages)
}

/// Refuses more pixels than memory.
pub(crate) fn check_memory(
    peak_bytes: u64,
    views: &[PlannedView],
    limit_mb: Option<u32>,
) -> Option<Error> {
    let limit = u64::from(limit_mb.unwrap_or(MEMORY_MB)) << 20;
    let pixels: u64 = views.iter().map(PlannedView::pixels).sum();
    let mb = |bytes: u64| bytes >> 20;
    (peak_bytes > limit).then(|| Error::scene(format!(
            "{} views of together {} megapixels need about {} MB of memory, more than {} MB",
            views.len(),
            pixels / 1_000_000,
            mb(peak_bytes),
            mb(limit)
        ), "choose a region of interest (with the height of the ground it is cut closer) or fewer views"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::orientation::InputFile;
    use crate::orienting::scene_loader::LoadOptions;
    use crate::orienting::scene_loader::ground::plan_scene;
    use crate::orienting::synthetic::{gable_scene, to_files};

    #[test]
    fn loading_or_the_stages_take_most() {
        let files: Vec<InputFile> = (to_files(&gable_scene(96).0).into_iter())
            .map(|(path, bytes)| InputFile::new(&path, bytes))
            .collect();
        let options = LoadOptions {
            orientation: Some("colmap".to_owned()),
            ..LoadOptions::default()
        };
        let heads: u64 = files.iter().map(InputFile::head_length).sum();
        let mut views = plan_scene(&files, &options).views;
        assert_eq!(views.len(), 6);
        let beyond_heads = |views: &[PlannedView], roofs_m2: Option<f64>| {
            peak_bytes(&files, views, roofs_m2) - BASE_BYTES - heads
        };
        let peak = |views: &[PlannedView]| beyond_heads(views, None);
        let of_pixel = VIEW_BYTES + STAGE_BYTES + UNKNOWN_ROOF_BYTES;
        assert_eq!(peak(&views), 6 * 96 * 96 * of_pixel);
        let with_roof = 6 * 96 * 96 * (VIEW_BYTES + STAGE_BYTES) + 100 * ROOF_BYTES as u64;
        assert_eq!(beyond_heads(&views, Some(100.0)), with_roof);
        // Of a small part of one photograph its decoding takes most.
        views.truncate(1);
        views[0].part = Some([0, 0, 8, 8]);
        let loading = peak(&views) - 8 * 8 * VIEW_BYTES;
        let decoding = 96 * 96 * 6;
        assert!(loading >= decoding && loading <= decoding + files[views[0].file].length());
    }
}
