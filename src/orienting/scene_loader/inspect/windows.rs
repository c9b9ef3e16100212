//! What a run would read of each view, and the area that views show, before anything is computed.

use nalgebra::{Point2, Point3};
use serde::{Deserialize, Serialize};

use super::super::decode::needed;
use super::super::ground::{pixel_in_the_middle, unreduced_plan};
use super::super::input::LoadOptions;
use super::super::plan::Plan;
use super::super::planned_view::PlannedView;
use crate::base::error::{Error, Result};
use crate::base::math::{larger, smaller};
use crate::orienting::orientation::InputFile;
use crate::photographs::camera::{Camera, FEWEST_VIEWS};

/// Places along the longer side of the area at which the views are counted.
const PLACES: u32 = 200;

/// Pixels so many times as large on the ground as those in the middle of the photographs are not
/// counted: towards the horizon an image shows any distance, and little of it.
const COARSEST_RATIO: f64 = 2.0;

/// A view of a region and its part that a run reads.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct ViewWindow {
    /// The name that the view goes by.
    pub view: String,
    /// Column, row, width and height, pixels of the whole image without its lens, reduced.
    pub window: [u32; 4],
    /// Bytes that are read of its photograph beyond the head.
    pub bytes: u64,
}

impl ViewWindow {
    pub(super) fn of(files: &[InputFile], planned: &PlannedView) -> Self {
        let whole = &planned.whole;
        Self {
            view: planned.name.clone(),
            window: (planned.part).unwrap_or([0, 0, whole.width, whole.height]),
            bytes: needed(files, planned).bytes(files),
        }
    }
}

/// The places on the ground that three or more views show, on a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownArea {
    /// The box around them in whole metres, world frame of the input: x0, y0, x1, y1.
    pub bounds: [f64; 4],
    /// The places, world frame.
    places: Vec<Point2<f64>>,
    /// Distance of neighbouring places, metres.
    step: f64,
}

impl ShownArea {
    /// What the views show of level ground in the middle of `ground` (lowest and highest, metres,
    /// world frame), where that is known. By how much photographs are reduced does not matter.
    pub fn new(
        files: &[InputFile],
        options: &LoadOptions,
        ground: Option<[f64; 2]>,
    ) -> Result<Self> {
        let plan = unreduced_plan(files, options);
        if let Some(error) = plan.errors.first() {
            return Err(error.clone());
        }
        let shown = ground.and_then(|heights| Self::of_plan(&plan, heights));
        shown.ok_or_else(|| {
            Error::scene(
                "the cameras do not tell which area three of them show",
                "give the region of interest (--roi x0,y0,x1,y1)",
            )
        })
    }

    /// The same of whole images that are not reduced.
    pub(super) fn of_plan(plan: &Plan, ground: [f64; 2]) -> Option<Self> {
        let [low, high] = ground.map(|height| height - plan.origin.z);
        let cameras: Vec<&Camera> = plan.views.iter().map(|view| &view.whole).collect();
        let (places, step) = shown_places(&cameras, 0.5 * (low + high));
        let places = places.into_iter().map(|p| p + plan.origin.xy());
        let places: Vec<Point2<f64>> = places.collect();
        let [x0, y0, x1, y1] = enclosing(&places)?;
        let bounds = [x0.floor(), y0.floor(), x1.ceil(), y1.ceil()];
        Some(Self {
            bounds,
            places,
            step,
        })
    }

    /// Does a box (x0, y0, x1, y1, world frame) hold some of the places? A side that is shorter
    /// than their distance counts as long as that, so that none falls between them.
    pub fn meets(&self, [x0, y0, x1, y1]: [f64; 4]) -> bool {
        let [x, y] = [x1 - x0, y1 - y0].map(|side| larger(0.5 * (self.step - side), 0.0));
        let holds =
            |p: &Point2<f64>| p.x >= x0 - x && p.x < x1 + x && p.y >= y0 - y && p.y < y1 + y;
        self.places.iter().any(holds)
    }
}

/// The largest pixels that count, metres, on ground at this height.
pub(super) fn coarsest_pixel(cameras: &[&Camera], z: f64) -> Option<f64> {
    pixel_in_the_middle(cameras.iter().copied(), z).map(|pixel_m| COARSEST_RATIO * pixel_m)
}

/// Does a camera show a place in pixels finer than `coarsest` metres?
pub(super) fn shows(camera: &Camera, p: &Point3<f64>, coarsest: f64) -> bool {
    camera.ground_pixel(p) < coarsest
        && (camera.project(p)).is_some_and(|image| camera.contains(&image, 0.0))
}

/// The places of a grid on the ground at this height that enough cameras show, none of them much
/// more coarsely than the middle of an image, and the step of the grid; local frame.
pub(crate) fn shown_places(cameras: &[&Camera], z: f64) -> (Vec<Point2<f64>>, f64) {
    let Some(coarsest) = coarsest_pixel(cameras, z) else {
        return (Vec::new(), 0.0);
    };
    let boxes = cameras
        .iter()
        .map(|camera| box_of_shown(camera, z, coarsest));
    let Some([x0, y0, x1, y1]) = boxes.reduce(around) else {
        return (Vec::new(), 0.0);
    };
    let step = larger(x1 - x0, y1 - y0) / f64::from(PLACES);
    let along = |from: f64, to: f64| (0..=((to - from) / step) as u32).map(f64::from);
    let rows: Vec<f64> = along(y0, y1).map(|j| y0 + step * j).collect();
    let row = |_: usize, &y: &f64| -> Vec<Point2<f64>> {
        let places = along(x0, x1).map(|i| Point2::new(x0 + step * i, y));
        let is_shown = |p: &Point2<f64>| {
            let place = Point3::new(p.x, p.y, z);
            let showing = cameras.iter().filter(|c| shows(c, &place, coarsest));
            showing.take(FEWEST_VIEWS).count() == FEWEST_VIEWS
        };
        places.filter(is_shown).collect()
    };
    (crate::base::execution::map(&rows, row).concat(), step)
}

/// A box around all that some of the cameras show of ground between these heights, none of it much
/// more coarsely than the middle of an image; local frame.
pub(crate) fn box_of_views(cameras: &[&Camera], heights: [f64; 2]) -> Option<[f64; 4]> {
    let boxes = heights.iter().flat_map(|&z| {
        let coarsest = coarsest_pixel(cameras, z);
        let of_camera = move |camera: &&Camera| Some(box_of_shown(camera, z, coarsest?));
        cameras.iter().filter_map(of_camera)
    });
    boxes.reduce(around)
}

/// A box around all that a camera shows of the ground at this height in pixels finer than
/// `coarsest` metres.
fn box_of_shown(camera: &Camera, z: f64, coarsest: f64) -> [f64; 4] {
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    let corners = [(0.0, 0.0), (w, 0.0), (0.0, h), (w, h)].map(|(u, v)| {
        let found = camera.at_height(&Point2::new(u, v), z);
        found.filter(|p| camera.ground_pixel(p) < coarsest)
    });
    let near: Vec<Point2<f64>> = corners.iter().flatten().map(|p| p.xy()).collect();
    match enclosing(&near) {
        Some(all) if near.len() == corners.len() => all,
        // Where a corner shows something farther away, the image may reach in any direction.
        _ => {
            let farthest = coarsest * camera.k[(0, 0)].abs();
            let (x, y) = (camera.center.x, camera.center.y);
            [x - farthest, y - farthest, x + farthest, y + farthest]
        }
    }
}

/// Least and largest x and y; `None` of nothing.
pub(super) fn enclosing(points: &[Point2<f64>]) -> Option<[f64; 4]> {
    points.iter().map(|p| [p.x, p.y, p.x, p.y]).reduce(around)
}

/// The box around two boxes.
fn around(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [
        smaller(a[0], b[0]),
        smaller(a[1], b[1]),
        larger(a[2], b[2]),
        larger(a[3], b[3]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    /// A vertical view of 100 x 100 m from 100 m above a place.
    fn above(x: f64, y: f64) -> Camera {
        Camera {
            k: Matrix3::new(100.0, 0.0, 50.0, 0.0, 100.0, 50.0, 0.0, 0.0, 1.0),
            r: Matrix3::new(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0),
            center: Point3::new(x, y, 100.0),
            width: 100,
            height: 100,
        }
    }

    #[test]
    fn the_area_is_what_three_views_show() {
        let cameras = [0.0, 30.0, 60.0, 90.0].map(|x| above(x, 5.0));
        let cameras: Vec<&Camera> = cameras.iter().collect();
        let found = enclosing(&shown_places(&cameras, 0.0).0).unwrap();
        // The first three share 10 to 50, the last three 40 to 80.
        for (found, planted) in found.iter().zip([10.0, -45.0, 80.0, 55.0]) {
            assert!((found - planted).abs() < 3.0, "{found} for {planted}");
        }
        assert!(shown_places(&cameras[..2], 0.0).0.is_empty());
    }

    #[test]
    fn no_square_falls_between_places_that_are_far_from_each_other() {
        // Every hundred metres along a line.
        let shown = ShownArea {
            bounds: [0.0, 0.0, 1000.0, 60.0],
            places: (0..10)
                .map(|i| Point2::new(100.0 * f64::from(i), 30.0))
                .collect(),
            step: 100.0,
        };
        for i in 0..15 {
            let x = 60.0 * f64::from(i);
            assert!(shown.meets([x, 0.0, x + 60.0, 60.0]), "{x}");
        }
        assert!(!shown.meets([960.0, 0.0, 1000.0, 60.0]));
        assert!(!shown.meets([0.0, 120.0, 60.0, 180.0]));
    }

    #[test]
    fn the_box_of_views_holds_all_that_one_shows() {
        let cameras = [0.0, 30.0].map(|x| above(x, 5.0));
        let cameras: Vec<&Camera> = cameras.iter().collect();
        // From 100 m above, and from 50 m above.
        let found = box_of_views(&cameras, [0.0, 50.0]).unwrap();
        assert_eq!(found, [-50.0, -45.0, 80.0, 55.0]);
        let found = box_of_views(&cameras, [50.0, 50.0]).unwrap();
        assert_eq!(found, [-25.0, -20.0, 55.0, 30.0]);
        assert_eq!(box_of_views(&[], [0.0, 0.0]), None);
    }

    #[test]
    fn ground_towards_the_horizon_is_not_counted() {
        // Tilted by 70 degrees, so that the upper part shows the sky.
        let tilted = |x: f64| {
            let mut camera = above(x, 0.0);
            let (sin, cos) = crate::base::math::sin_cos(70_f64.to_radians());
            let tilt = Matrix3::new(1.0, 0.0, 0.0, 0.0, cos, sin, 0.0, -sin, cos);
            camera.r = tilt * camera.r;
            camera
        };
        let cameras = [0.0, 5.0, 10.0].map(tilted);
        let cameras: Vec<&Camera> = cameras.iter().collect();
        let (found, _) = shown_places(&cameras, 0.0);
        let farthest = found.iter().map(|p| p.y.abs()).fold(0.0, larger);
        // The middle of an image is 100 / cos 70 = 292 m away.
        assert!((500.0..585.0).contains(&farthest), "{farthest}");
    }
}
