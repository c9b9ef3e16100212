//! Between which heights the ground of a region lies, measured before its views are chosen.
//!
//! Cameras alone hardly say how far below them the ground is, and of a whole flight every view may
//! then show the region. The few photographs nearest to it in plan are matched with each other.

use nalgebra::{Point2, Vector3};

use super::decode::decode_all;
use super::input::LoadOptions;
use super::plan::Plan;
use super::planned_view::PlannedView;
use crate::orientation::InputFile;
use crate::orientation_check::{CheckedView, surface_heights};

/// So many photographs show the ground. Assumption: a pair may have no baseline, four have one.
const PHOTOGRAPHS: usize = 4;

/// Plans a scene; where more views show the region of interest than are used, by the heights that
/// some photographs show there.
pub(crate) fn plan_scene(files: &[InputFile], options: &LoadOptions) -> Plan {
    let plan = Plan::new(files, options, None);
    let measured = match (options.roi, options.ground_z) {
        (Some(roi), None) if plan.is_chosen => heights_near(files, options, roi),
        _ => None,
    };
    match measured {
        Some(heights) => Plan::new(files, options, Some(heights)),
        None => plan,
    }
}

/// The heights of what the photographs show that were taken nearest to a region, metres, local
/// frame.
fn heights_near(files: &[InputFile], options: &LoadOptions, roi: [f64; 4]) -> Option<[f64; 2]> {
    let (nearest, origin) = nearest(files, options, roi);
    let views = decode_all(files, &nearest).ok()?;
    let checked: Vec<CheckedView> = (nearest.iter().zip(&views))
        .map(|(planned, view)| planned.checked(view, origin))
        .collect();
    surface_heights(&checked)
}

/// The views that were taken nearest to a region, whole, and the origin of their frame.
fn nearest(
    files: &[InputFile],
    options: &LoadOptions,
    [x0, y0, x1, y1]: [f64; 4],
) -> (Vec<PlannedView>, Vector3<f64>) {
    let everywhere = LoadOptions {
        roi: None,
        memory_mb: Some(u32::MAX),
        ..options.clone()
    };
    let whole = Plan::new(files, &everywhere, None);
    let middle = Point2::new(0.5 * (x0 + x1), 0.5 * (y0 + y1)) - whole.origin.xy();
    let distance = |view: &PlannedView| (view.whole.center.xy() - middle).norm();
    let mut nearest = whole.views;
    nearest.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.truncate(PHOTOGRAPHS);
    (nearest, whole.origin)
}

/// The heights of the ground of an area as a few photographs in its middle show it, metres, world
/// frame of the input.
pub fn ground_heights(
    files: &[InputFile],
    options: &LoadOptions,
    area: [f64; 4],
) -> Option<[f64; 2]> {
    let heights = heights_near(files, options, area)?;
    let origin = nearest(files, options, area).1;
    Some(heights.map(|z| z + origin.z))
}

/// Indices of the files in whose pixels [`ground_heights`] measures.
pub fn ground_files(files: &[InputFile], options: &LoadOptions, area: [f64; 4]) -> Vec<usize> {
    let (nearest, _) = nearest(files, options, area);
    nearest.iter().map(|view| view.file).collect()
}

/// Indices of the files in whose pixels loading measures the height of the ground, before it
/// chooses views: none where that is known, or nothing is to be chosen. Of the files their first
/// bytes suffice.
pub fn files_of_ground(files: &[InputFile], options: &LoadOptions) -> Vec<usize> {
    let plan = Plan::new(files, options, None);
    match (options.roi, options.ground_z) {
        (Some(roi), None) if plan.is_chosen => ground_files(files, options, roi),
        _ => Vec::new(),
    }
}

/// Indices of the files whose pixels loading makes views of. Of these their first bytes suffice, of
/// [`files_of_ground`] all are needed.
pub fn files_of_views(files: &[InputFile], options: &LoadOptions) -> Vec<usize> {
    let plan = plan_scene(files, options);
    plan.views.iter().map(|view| view.file).collect()
}
