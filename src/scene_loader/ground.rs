//! What the photographs show of the ground before a scene is planned: between which heights it
//! lies, and by how much photographs of too fine pixels are reduced.
//!
//! Cameras alone hardly say how far below them the ground is. Of a flight every view may then show
//! the region of interest, and nothing tells how fine its pixels are. So the few photographs
//! nearest to a place are matched with each other.

use nalgebra::{Point2, Point3};

use super::decode::decode_all;
use super::input::LoadOptions;
use super::plan::Plan;
use super::planned_view::PlannedView;
use crate::camera::Camera;
use crate::geometry::mean_point;
use crate::math::median;
use crate::orientation::InputFile;
use crate::orientation_check::{CheckedView, surface_heights};

/// So many photographs show the ground. Assumption: a pair may have no baseline, four have one.
const PHOTOGRAPHS: usize = 4;

/// Longest side at which photographs are matched to show the ground, pixels. Assumption: that is a
/// thousand points and a height to within a pixel or two, which is enough here.
const MATCHED_PX: u32 = 1200;

/// Photographs are reduced as long as their pixels stay finer than this on the ground, metres.
/// Assumption: B99 has pixels of 8 cm.
const FINEST_M: f64 = 0.05;

/// Smaller photographs are used as they are, pixels: most of a scene is then seen at once.
const SMALL_PX: u64 = 4_000_000;

/// Plans a scene; where more views show the region of interest than are used, by the heights that
/// some photographs show there.
pub(crate) fn plan_scene(files: &[InputFile], options: &LoadOptions) -> Plan {
    let options = &settled(files, options);
    let plan = Plan::new(files, options, None);
    let measured = match (options.roi, options.ground_z) {
        (Some([x0, y0, x1, y1]), None) if plan.is_chosen => {
            let middle = Point2::new(0.5 * (x0 + x1), 0.5 * (y0 + y1));
            heights_near(files, &whole_plan(files, options), Some(middle))
        }
        _ => None,
    };
    match measured {
        Some(heights) => Plan::new(files, options, Some(heights)),
        None => plan,
    }
}

/// The options, with the factor by which photographs are reduced: what is decided once for all
/// parts of an area.
pub fn settled(files: &[InputFile], options: &LoadOptions) -> LoadOptions {
    let reduce = options.reduce.unwrap_or_else(|| reduction(files, options));
    LoadOptions {
        reduce: Some(reduce),
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

/// The largest whole factor that leaves pixels as fine as roofs need; 1 where the photographs are
/// small, or do not show how far away the ground is.
fn reduction(files: &[InputFile], options: &LoadOptions) -> u32 {
    let whole = whole_plan(files, options);
    if whole.views.iter().all(|view| view.pixels() < SMALL_PX) {
        return 1;
    }
    let Some(z) = ground_height(files, options, &whole) else {
        return 1;
    };
    let cameras = whole.views.iter().map(|view| &view.whole);
    pixel_in_the_middle(cameras, z).map_or(1, |pixel_m| ((FINEST_M / pixel_m) as u32).max(1))
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
pub(crate) fn ground_height(
    files: &[InputFile],
    options: &LoadOptions,
    whole: &Plan,
) -> Option<f64> {
    let measured = || {
        let [low, high] = heights_near(files, whole, None)?;
        Some(0.5 * (low + high))
    };
    (options.ground_z).map_or_else(measured, |z| Some(z - whole.origin.z))
}

/// The heights of what the photographs show that were taken nearest to a place in plan (the middle
/// of the cameras when absent, else world frame), metres, local frame.
fn heights_near(files: &[InputFile], whole: &Plan, place: Option<Point2<f64>>) -> Option<[f64; 2]> {
    let centers: Vec<Point3<f64>> = whole.views.iter().map(|v| v.whole.center).collect();
    let place = match place {
        Some(place) => place - whole.origin.xy(),
        None => mean_point(&centers).xy(),
    };
    let mut nearest: Vec<&PlannedView> = whole.views.iter().collect();
    let distance = |view: &PlannedView| (view.whole.center.xy() - place).norm();
    nearest.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let matched = |view: &&PlannedView| {
        let mut view = PlannedView::clone(view);
        let longest = view.whole.width.max(view.whole.height);
        view.reduce(longest.div_ceil(MATCHED_PX));
        view
    };
    let nearest: Vec<PlannedView> = nearest.iter().take(PHOTOGRAPHS).map(matched).collect();
    let views = decode_all(files, &nearest).ok()?;
    let checked: Vec<CheckedView> = (nearest.iter().zip(&views))
        .map(|(planned, view)| planned.checked(view, whole.origin))
        .collect();
    surface_heights(&checked)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{gable_scene, to_files};
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

    #[test]
    fn reduced_photographs_show_the_same_places() {
        let (scene, _) = gable_scene(401);
        let files: Vec<InputFile> = (to_files(&scene).into_iter())
            .map(|(path, bytes)| InputFile::new(&path, bytes))
            .collect();
        let options = LoadOptions {
            reduce: Some(3),
            ..LoadOptions::default()
        };
        let reduced = crate::scene_loader::load_scene(&files, &options).unwrap();
        assert!(reduced.warnings.iter().any(|w| w.contains("a third")));
        let ridge = Point3::new(0.3, 0.0, 9.375);
        for (small, whole) in reduced.views.iter().zip(&scene.views) {
            assert_eq!((small.camera.width, small.camera.height), (133, 133));
            assert_eq!(small.rgb.dimensions(), (133, 133));
            let [p, q] = [small, whole].map(|v| v.camera.project(&ridge).unwrap());
            assert!((p * 3.0 - q).norm() < 1e-6, "{p} {q}");
            let (x, y) = (p.x as usize, p.y as usize);
            let block = (0..9).map(|i| whole.gray.get(3 * x + i % 3, 3 * y + i / 3));
            let mean = block.sum::<f32>() / 9.0;
            assert!((small.gray.get(x, y) - mean).abs() < 0.005);
        }
    }
}
