//! How much memory a run takes, and whether that is allowed.

use super::decode::needed;
use super::planned_view::PlannedView;
use crate::base::error::Error;
use crate::orienting::orientation::{InputFile, Needed};
use crate::photographs::raster::decoding_bytes;

/// Bytes that one pixel of a view takes at the peak: colours and grey values (7), and what the
/// stages make of them. Measured over whole runs: 35 (a farmhouse) to 90 (a suburb, barns); the
/// matches of lines and the cells of roofs take most.
const BYTES_PER_PIXEL: u64 = 90;

/// Bytes that everything else takes.
const BASE_BYTES: u64 = 20 << 20;

/// Memory for a scene where no limit is given, bytes. Assumption: browsers on small machines
/// give a page no more than 1.5 GB.
const MEMORY_BYTES: u64 = if cfg!(target_arch = "wasm32") {
    3 << 29
} else {
    32 << 30
};

/// Peak memory of a run with these views, bytes: of photographs that are views what is needed of
/// them is in memory.
pub(crate) fn peak_bytes(files: &[InputFile], views: &[PlannedView]) -> u64 {
    let heads: u64 = files.iter().map(InputFile::head_length).sum();
    let filled = Needed::merged(views.iter().map(|view| needed(files, view)), files);
    let read = heads + filled.iter().map(|one| one.bytes(files)).sum::<u64>();
    let kept: u64 = views.iter().map(|v| v.pixels() * BYTES_PER_PIXEL).sum();
    let decoding = views.iter().map(|v| {
        let chunk = decoding_bytes(files[v.file].content(), v.size);
        // Without its lens, turned, or before it is reduced, a view is a second image of its size.
        let is_copied = v.distortion.is_some() || v.turn.is_some() || v.reduction > 1.0;
        let unreduced = (v.pixels() as f64 * v.reduction * v.reduction) as u64;
        chunk + if is_copied { unreduced * (3 + 4) } else { 0 }
    });
    // Views are decoded at the same time when there is room, one by one otherwise.
    BASE_BYTES + read + kept + decoding.max().unwrap_or(0)
}

/// Refuses more pixels than memory.
pub(crate) fn check_memory(
    peak_bytes: u64,
    views: &[PlannedView],
    limit_mb: Option<u32>,
) -> Option<Error> {
    let limit = limit_mb.map_or(MEMORY_BYTES, |mb| u64::from(mb) << 20);
    let pixels: u64 = views.iter().map(PlannedView::pixels).sum();
    let mb = |bytes: u64| bytes >> 20;
    (peak_bytes > limit).then(|| Error::Scene {
        problem: format!(
            "{} views of together {} megapixels need about {} MB of memory, more than {} MB",
            views.len(),
            pixels / 1_000_000,
            mb(peak_bytes),
            mb(limit)
        ),
        advice: "choose a region of interest (with the height of the ground it is cut closer) or fewer views".to_owned(),
    })
}
