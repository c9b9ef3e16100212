//! Between which heights the ground of a region lies, measured before its views are chosen.
//!
//! Cameras alone hardly say how far below them the ground is, and of a whole flight every view may
//! then show the region. The few photographs nearest to it in plan are matched with each other.

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
fn heights_near(
    files: &[InputFile],
    options: &LoadOptions,
    [x0, y0, x1, y1]: [f64; 4],
) -> Option<[f64; 2]> {
    let everywhere = LoadOptions {
        roi: None,
        memory_mb: Some(u32::MAX),
        ..options.clone()
    };
    let whole = Plan::new(files, &everywhere, None);
    let middle = nalgebra::Point2::new(0.5 * (x0 + x1), 0.5 * (y0 + y1)) - whole.origin.xy();
    let distance = |view: &PlannedView| (view.whole.center.xy() - middle).norm();
    let mut nearest = whole.views;
    nearest.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.truncate(PHOTOGRAPHS);
    let views = decode_all(files, &nearest).ok()?;
    let checked: Vec<CheckedView> = (nearest.iter().zip(&views))
        .map(|(planned, view)| planned.checked(view, whole.origin))
        .collect();
    surface_heights(&checked)
}
