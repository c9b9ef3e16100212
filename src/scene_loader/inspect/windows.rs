//! What a run would read of each view, and the area that views show, before a pixel is decoded.

use nalgebra::{Point2, Point3};
use serde::{Deserialize, Serialize};

use super::super::checks::camera_checks;
use super::super::input::LoadOptions;
use super::super::plan::Plan;
use crate::camera::Camera;
use crate::error::{Error, Result};
use crate::orientation::InputFile;

/// Views that must show a place: a line match in two cannot be verified without a third.
const LEAST_VIEWS: usize = 3;

/// Places along a side of the area at which the views are counted.
const PLACES: u32 = 200;

/// Ground farther from a camera than so many times its height is not counted as shown: towards the
/// horizon an image shows any distance, and nothing in it.
pub(super) const FARTHEST: f64 = 10.0;

/// A view of a region and its part that a run reads.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewWindow {
    /// The name that the view goes by.
    pub view: String,
    /// Column, row, width and height, pixels of the whole image without its lens.
    pub window: [u32; 4],
}

/// The views of the region of interest, and the memory that a run on them takes at its peak,
/// megabytes, as far as the cameras tell: a run that has to choose among many views over ground of
/// unknown height measures that first, and may choose others.
pub fn region_windows(
    files: &[InputFile],
    options: &LoadOptions,
) -> Result<(Vec<ViewWindow>, u64)> {
    let plan = Plan::new(files, options, None);
    if let (Some(error), false) = (plan.errors.into_iter().next(), plan.is_implausible) {
        return Err(error);
    }
    let views = plan.views.iter().map(|planned| ViewWindow {
        view: planned.name.clone(),
        window: (planned.part).unwrap_or([0, 0, planned.whole.width, planned.whole.height]),
    });
    // A part of a megabyte counts as a whole one.
    Ok((views.collect(), (plan.peak_bytes >> 20) + 1))
}

/// The box in plan of what three or more views show of the ground, in whole metres of the input's
/// world: x0, y0, x1, y1.
pub fn shown_area(files: &[InputFile], options: &LoadOptions) -> Result<[f64; 4]> {
    let whole = LoadOptions {
        roi: None,
        memory_mb: Some(u32::MAX),
        ..options.clone()
    };
    let plan = Plan::new(files, &whole, None);
    if let Some(error) = plan.errors.into_iter().next() {
        return Err(error);
    }
    let named: Vec<(&str, &Camera)> = (plan.views.iter())
        .map(|view| (&*view.name, &view.whole))
        .collect();
    let ground_z = options.ground_z.map(|z| z - plan.origin.z);
    let heights = camera_checks::check_cameras(&named, ground_z).heights;
    let found = heights.and_then(|[low, high]| {
        let cameras: Vec<&Camera> = plan.views.iter().map(|view| &view.whole).collect();
        box_of_shown(&cameras, 0.5 * (low + high))
    });
    let [x0, y0, x1, y1] = found.ok_or_else(|| Error::Scene {
        problem: "the cameras do not tell which area three of them show".to_owned(),
        advice: "give the region of interest (--roi x0,y0,x1,y1)".to_owned(),
    })?;
    let (x, y) = (plan.origin.x, plan.origin.y);
    Ok([
        (x0 + x).floor(),
        (y0 + y).floor(),
        (x1 + x).ceil(),
        (y1 + y).ceil(),
    ])
}

/// Does a camera show a place on the ground, not too far away?
pub(super) fn shows(camera: &Camera, p: &Point3<f64>) -> bool {
    (p - camera.center).norm() < FARTHEST * (camera.center.z - p.z).abs()
        && (camera.project(p)).is_some_and(|image| camera.contains(&image, 0.0))
}

/// The box of the places on the ground at this height that enough cameras show, local frame.
pub(super) fn box_of_shown(cameras: &[&Camera], z: f64) -> Option<[f64; 4]> {
    let corners = cameras.iter().flat_map(|camera| {
        let (w, h) = (f64::from(camera.width), f64::from(camera.height));
        let reach = FARTHEST * (camera.center.z - z).abs();
        let corners = [(0.0, 0.0), (w, 0.0), (0.0, h), (w, h)].map(|(u, v)| {
            let found = camera.at_height(&Point2::new(u, v), z);
            found.filter(|p| (p - camera.center).norm() < reach)
        });
        // Where a corner shows the sky, the view may reach in any direction.
        let far = (corners.iter().any(Option::is_none)).then(|| {
            let c = &camera.center;
            [-reach, reach].map(|d| Point3::new(c.x + d, c.y + d, z))
        });
        corners
            .into_iter()
            .flatten()
            .chain(far.into_iter().flatten())
    });
    let all = enclosing(corners)?;
    let at = |low: f64, high: f64, i: u32| low + (high - low) * f64::from(i) / f64::from(PLACES);
    let places = (0..=PLACES).flat_map(|j| (0..=PLACES).map(move |i| (i, j)));
    let places = places.map(|(i, j)| Point3::new(at(all[0], all[2], i), at(all[1], all[3], j), z));
    enclosing(places.filter(|p| {
        let showing = cameras.iter().filter(|camera| shows(camera, p));
        showing.take(LEAST_VIEWS).count() == LEAST_VIEWS
    }))
}

/// Least and largest x and y; `None` of nothing.
pub(super) fn enclosing(points: impl Iterator<Item = Point3<f64>>) -> Option<[f64; 4]> {
    points.map(|p| [p.x, p.y, p.x, p.y]).reduce(|a, b| {
        [
            a[0].min(b[0]),
            a[1].min(b[1]),
            a[2].max(b[2]),
            a[3].max(b[3]),
        ]
    })
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
        let found = box_of_shown(&cameras, 0.0).unwrap();
        // The first three share 10 to 50, the last three 40 to 80.
        for (found, planted) in found.iter().zip([10.0, -45.0, 80.0, 55.0]) {
            assert!((found - planted).abs() < 1.0, "{found} for {planted}");
        }
        assert_eq!(box_of_shown(&cameras[..2], 0.0), None);
    }
}
