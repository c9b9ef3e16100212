//! What the photographs show of the ground before a scene is planned: between which heights it
//! lies, and by how much photographs of too fine pixels are reduced.
//!
//! Cameras alone hardly say how far below them the ground is. Of a flight every view may then show
//! the region of interest, and nothing tells how fine its pixels are. So the few photographs
//! nearest to a place are matched with each other.

use nalgebra::{Point2, Point3};

use super::decode::{decode_all, needed};
use super::input::LoadOptions;
use super::plan::Plan;
use super::planned_view::PlannedView;
use super::region::MOST_VIEWS;
use crate::base::geometry::mean_point;
use crate::base::math::{larger, median};
use crate::orienting::orientation::{InputFile, Needed};
use crate::orienting::orientation_check::{CheckedView, surface_heights};
use crate::photographs::camera::Camera;

/// So many photographs show the ground. Assumption: a pair may have no baseline, four have one.
const PHOTOGRAPHS: usize = 4;

/// Longest side at which photographs are matched to show the ground, pixels. Assumption: that is a
/// thousand points and a height to within a pixel or two, which is enough here.
const MATCHED_SIDE_PX: u32 = 1200;

/// Photographs are reduced as long as their pixels stay finer than this on the ground, metres.
/// Assumption: B99 has pixels of 8 cm.
const FINEST_PIXEL_M: f64 = 0.05;

/// Smaller photographs are used as they are, pixels: most of a scene is then seen at once.
const SMALL_PHOTOGRAPH_PX: u64 = 4_000_000;

/// Plans a scene; where more views show the region of interest than are used, by the heights that
/// some photographs show there.
pub(crate) fn plan_scene(files: &[InputFile], options: &LoadOptions) -> Plan {
    let options = &settled(files, options);
    let plan = Plan::new(files, options, None);
    let is_known = options.ground_z.is_some() || options.ground_range.is_some();
    let measured = match options.roi.filter(|_| plan.is_chosen && !is_known) {
        Some(roi) => heights_near(files, &whole_plan(files, options), Some(middle_of(roi))),
        None => None,
    };
    match measured {
        Some(heights) => Plan::new(files, options, Some(heights)),
        None => plan,
    }
}

/// The options, with the factor by which photographs are reduced: what is decided once for all
/// parts of an area.
pub fn settled(files: &[InputFile], options: &LoadOptions) -> LoadOptions {
    let reduction = options
        .reduction
        .unwrap_or_else(|| reduction(files, options));
    LoadOptions {
        reduction: Some(reduction),
        ..options.clone()
    }
}

/// The same on ground between these heights, metres, world frame of the input, where they are
/// known.
pub fn settled_on(
    files: &[InputFile],
    options: &LoadOptions,
    ground: Option<[f64; 2]>,
) -> LoadOptions {
    let reduction = options.reduction.unwrap_or_else(|| {
        let whole = unreduced_plan(files, options);
        ground.map_or(1.0, |[low, high]| {
            reduction_on(&whole, 0.5 * (low + high) - whole.origin.z)
        })
    });
    LoadOptions {
        reduction: Some(reduction),
        ..options.clone()
    }
}

/// The options with photographs that are reduced as far as their pixels stay finer than this on the
/// ground, metres, and no less than before. `ground` has its lowest and highest height where they
/// are known, metres, world frame of the input.
pub fn finer_than(
    pixel_m: f64,
    files: &[InputFile],
    options: &LoadOptions,
    ground: Option<[f64; 2]>,
) -> LoadOptions {
    let plan = unreduced_plan(files, options);
    let cameras = plan.views.iter().map(|view| &view.whole);
    let whole = ground
        .and_then(|[low, high]| pixel_in_the_middle(cameras, 0.5 * (low + high) - plan.origin.z));
    // In whole steps, as decision 25 measured what is missed.
    let factor = whole.map_or(1.0, |whole| reduction_to(pixel_m, whole).floor());
    LoadOptions {
        reduction: Some(larger(factor, options.reduction.unwrap_or(1.0))),
        ..options.clone()
    }
}

/// The plan of the whole images, of any size.
pub(crate) fn whole_plan(files: &[InputFile], options: &LoadOptions) -> Plan {
    let everywhere = LoadOptions {
        roi: None,
        memory_mb: Some(u32::MAX),
        ..options.clone()
    };
    Plan::new(files, &everywhere, None)
}

/// The plan of the whole images as they are, whatever the options reduce them by.
pub(crate) fn unreduced_plan(files: &[InputFile], options: &LoadOptions) -> Plan {
    let unreduced = LoadOptions {
        reduction: Some(1.0),
        ..options.clone()
    };
    whole_plan(files, &unreduced)
}

/// The largest factor that leaves pixels as fine as roofs need; 1 where the photographs are
/// small, or do not show how far away the ground is.
fn reduction(files: &[InputFile], options: &LoadOptions) -> f64 {
    let whole = whole_plan(files, options);
    if are_small(&whole) {
        return 1.0;
    }
    let z = ground_height(files, options, &whole);
    z.map_or(1.0, |z| reduction_on(&whole, z))
}

/// The largest factor that leaves pixels as fine as roofs need on ground of this height, metres,
/// local frame; 1 where the photographs are small.
pub(crate) fn reduction_on(whole: &Plan, z: f64) -> f64 {
    let cameras = whole.views.iter().map(|view| &view.whole);
    let pixel_m = pixel_in_the_middle(cameras, z).filter(|_| !are_small(whole));
    pixel_m.map_or(1.0, |pixel_m| reduction_to(FINEST_PIXEL_M, pixel_m))
}

/// The largest factor that leaves pixels finer than `to_m` of pixels of this size, metres; in
/// tenths, so that a person can state it again.
fn reduction_to(to_m: f64, pixel_m: f64) -> f64 {
    larger((10.0 * to_m / pixel_m).floor() / 10.0, 1.0)
}

/// Median size of a pixel in the middle of an image on ground of this height, metres.
pub(crate) fn pixel_in_the_middle<'a>(
    cameras: impl Iterator<Item = &'a Camera>,
    z: f64,
) -> Option<f64> {
    let pixel_m = |camera: &Camera| {
        let middle = Point2::new(f64::from(camera.width), f64::from(camera.height)) * 0.5;
        Some(camera.ground_pixel(&camera.at_height(&middle, z)?))
    };
    let mut pixels: Vec<f64> = cameras.filter_map(pixel_m).collect();
    median(&mut pixels)
}

/// Height of the ground in the middle of a block, metres, local frame: as it is stated, or as
/// photographs show it.
fn ground_height(files: &[InputFile], options: &LoadOptions, whole: &Plan) -> Option<f64> {
    let measured = || {
        let [low, high] = heights_near(files, whole, None)?;
        Some(0.5 * (low + high))
    };
    (options.ground_z).map_or_else(measured, |z| Some(z - whole.origin.z))
}

/// Lowest and highest ground as a few photographs in the middle of a block show it, metres, world
/// frame of the input; the same however far photographs are reduced.
pub fn ground_heights(files: &[InputFile], options: &LoadOptions) -> Option<[f64; 2]> {
    let whole = unreduced_plan(files, options);
    let heights = heights_near(files, &whole, None)?;
    Some(heights.map(|z| z + whole.origin.z))
}

/// What is needed of the files in whose pixels [`ground_heights`] measures. Of the files their
/// heads suffice.
pub fn ground_files(files: &[InputFile], options: &LoadOptions) -> Vec<Needed> {
    files_near(&unreduced_plan(files, options), None)
}

/// What is needed of the files in whose pixels [`settled`] measures the height of the ground: none
/// where nothing is open. Of the files their heads suffice.
pub fn files_of_settling(files: &[InputFile], options: &LoadOptions) -> Vec<Needed> {
    let is_settled = options.reduction.is_some() && options.roi.is_some();
    if options.ground_z.is_some() || is_settled {
        return Vec::new();
    }
    let whole = whole_plan(files, options);
    match options.roi.is_some() && are_small(&whole) {
        true => Vec::new(),
        false => files_near(&whole, None),
    }
}

/// What is needed of the files in whose pixels loading measures the height of the ground, before it
/// decides by how much photographs are reduced, and before it chooses views: none where both are
/// known. Of the files their heads suffice. Flights state the first: see [`settled`].
pub fn files_of_ground(files: &[InputFile], options: &LoadOptions) -> Vec<Needed> {
    if options.ground_z.is_some() || options.ground_range.is_some() {
        return Vec::new();
    }
    let whole = whole_plan(files, options);
    let is_undecided = options.reduction.is_none() && !are_small(&whole);
    let mut measured = match is_undecided && whole.views.len() <= MOST_VIEWS {
        true => files_near(&whole, None),
        false => Vec::new(),
    };
    if let (Some(roi), true) = (options.roi, Plan::new(files, options, None).is_chosen) {
        measured.extend(files_near(&whole, Some(middle_of(roi))));
    }
    Needed::merged(measured, files)
}

/// What is needed of the files whose pixels loading makes views of. Of these their heads suffice,
/// of [`files_of_ground`] all are needed.
pub fn files_of_views(files: &[InputFile], options: &LoadOptions) -> Vec<Needed> {
    let plan = plan_scene(files, options);
    plan.views.iter().map(|view| needed(files, view)).collect()
}

/// The files of [`nearest`], whole: they stay so while windows of others are read, and whatever
/// they are reduced by.
fn files_near(whole: &Plan, place: Option<Point2<f64>>) -> Vec<Needed> {
    let nearest = nearest(whole, place);
    nearest
        .iter()
        .map(|view| Needed::whole(view.file))
        .collect()
}

fn middle_of([x0, y0, x1, y1]: [f64; 4]) -> Point2<f64> {
    Point2::new(0.5 * (x0 + x1), 0.5 * (y0 + y1))
}

/// The views that were taken nearest to a place in plan (the middle of the cameras when absent,
/// else world frame), small enough to be matched.
fn nearest(whole: &Plan, place: Option<Point2<f64>>) -> Vec<PlannedView> {
    let centers: Vec<Point3<f64>> = whole.views.iter().map(|v| v.whole.center).collect();
    let place = match place {
        Some(place) => place - whole.origin.xy(),
        None => mean_point(&centers).xy(),
    };
    let distance = |view: &PlannedView| (view.whole.center.xy() - place).norm();
    let mut nearest: Vec<&PlannedView> = whole.views.iter().collect();
    nearest.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let matched = |view: &&PlannedView| {
        let mut view = PlannedView::clone(view);
        let longest = view.whole.width.max(view.whole.height);
        view.reduce(f64::from(longest.div_ceil(MATCHED_SIDE_PX)));
        view
    };
    nearest.iter().take(PHOTOGRAPHS).map(matched).collect()
}

/// The heights of what the photographs show that were taken nearest to a place, metres, local
/// frame.
fn heights_near(files: &[InputFile], whole: &Plan, place: Option<Point2<f64>>) -> Option<[f64; 2]> {
    let nearest = nearest(whole, place);
    let views = decode_all(files, &nearest).ok()?;
    let checked: Vec<CheckedView> = (nearest.iter().zip(&views))
        .map(|(planned, view)| planned.checked(view, whole.origin))
        .collect();
    surface_heights(&checked)
}

/// Are all photographs small enough to be used as they are?
fn are_small(whole: &Plan) -> bool {
    whole
        .views
        .iter()
        .all(|view| view.pixels() < SMALL_PHOTOGRAPH_PX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    #[test]
    fn the_pixel_in_the_middle_is_that_of_the_median_camera() {
        let camera = |height: f64| Camera {
            k: Matrix3::new(1000.0, 0.0, 50.0, 0.0, 1000.0, 50.0, 0.0, 0.0, 1.0),
            r: Matrix3::new(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0),
            center: Point3::new(0.0, 0.0, 100.0 + height),
            width: 100,
            height: 100,
        };
        let cameras = [20.0, 60.0, 21.0].map(camera);
        let pixel_m = pixel_in_the_middle(cameras.iter(), 100.0).unwrap();
        assert!((pixel_m - 0.021).abs() < 1e-9);
        assert_eq!(pixel_in_the_middle(cameras.iter(), 900.0), None);
    }
}
