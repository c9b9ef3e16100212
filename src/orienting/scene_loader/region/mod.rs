//! The part of each image that may show the region of interest.
//!
//! The region is a rectangle in plan; how high its ground and its roofs are is known only roughly,
//! so the part is the bounding box of the region at the lowest and at the highest possible height,
//! and a margin.

mod detail;
mod view_choice;

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::checks::camera_checks;
use super::planned_view::{PlannedView, SMALLEST_SIDE_PX, offset_calibration};
use crate::base::error::{Error, Result, listed};
use crate::base::geometry::bounds;
use crate::orienting::orientation::InputFile;
use crate::orienting::scene::Scene;
use crate::photographs::camera::{Camera, Distortion, FEWEST_VIEWS};
use crate::photographs::raster::{Gray, Photograph};

/// Buildings rise above the ground by no more than this, metres. Assumption: roofs of houses and
/// halls.
const TALLEST_BUILDING_M: f64 = 60.0;

/// Margin around the box, pixels, so that filters and windows at its border are complete.
const MARGIN_PX: f64 = 40.0;

/// Most views of a region where no number is stated; more only where they show parts of it, so that
/// half as many see a place. Assumption: a dozen see every roof from all sides, half a dozen from
/// most; time grows with their number and accuracy with its root.
pub const MOST_VIEWS: usize = 12;

/// Points along a side of the region at which views are compared.
const COMPARED_AT: u32 = 5;

/// What is said of the views that are not used.
pub(crate) struct CutNotice {
    /// Do more views show the region than are used?
    pub is_chosen: bool,
    pub warnings: Vec<String>,
}

/// A box in the local frame.
#[derive(Debug)]
pub(crate) struct RegionOfInterest {
    low: Point3<f64>,
    high: Point3<f64>,
}

impl RegionOfInterest {
    /// From x0, y0, x1, y1 in the world of the input and the range of the ground's height.
    pub(crate) fn new(roi: [f64; 4], origin: &Vector3<f64>, heights: [f64; 2]) -> Result<Self> {
        let [x0, y0, x1, y1] = roi;
        if !(roi.iter().all(|v| v.is_finite()) && x0 < x1 && y0 < y1) {
            return Err(Error::scene(
                format!("the region of interest {x0},{y0},{x1},{y1} is empty"),
                "give x0,y0,x1,y1 in metres with x0 < x1 and y0 < y1",
            ));
        }
        Ok(Self {
            low: Point3::new(x0 - origin.x, y0 - origin.y, heights[0]),
            high: Point3::new(x1 - origin.x, y1 - origin.y, heights[1]),
        })
    }

    /// Cuts the region out of each view; views that do not show it are left out with a warning, and
    /// those that add least to at most so many others.
    pub(crate) fn cut(
        &self,
        files: &[InputFile],
        views: &mut Vec<PlannedView>,
        most: Option<usize>,
    ) -> Result<CutNotice> {
        let cameras: Vec<Camera> = views.iter().map(|v| v.whole.clone()).collect();
        let mut blind = Vec::new();
        views.retain_mut(|view| {
            view.part = self.part(&view.whole);
            if view.part.is_none() {
                blind.push(files[view.file].name().to_owned());
            }
            view.part.is_some()
        });
        if views.len() < FEWEST_VIEWS {
            return Err(self.unseen(views.len(), &cameras));
        }
        let showing = views.len();
        let whole: Vec<Camera> = views.iter().map(|v| v.whole.clone()).collect();
        let shares = detail::shares_of_information(files, views);
        keep(views, &self.most_telling(&whole, &shares, most));
        let mut warnings = Vec::new();
        if !blind.is_empty() {
            let names = listed(blind.iter());
            warnings.push(format!(
                "views that do not show the region of interest, left out: {names}"
            ));
        }
        warnings.extend(notice_of_choice(showing, views.len()));
        Ok(CutNotice {
            is_chosen: views.len() < showing,
            warnings,
        })
    }

    /// Indices of the cameras that say most about the region, in their order; their photographs
    /// have such shares of the information that they could have.
    fn most_telling(&self, cameras: &[Camera], shares: &[f64], most: Option<usize>) -> Vec<usize> {
        let t = |i: u32| (f64::from(i) + 0.5) / f64::from(COMPARED_AT);
        let z = 0.5 * (self.low.z + self.high.z);
        let place = |i: u32| {
            let (u, v) = (t(i % COMPARED_AT), t(i / COMPARED_AT));
            let at = |axis: usize, t: f64| self.low[axis] + t * (self.high[axis] - self.low[axis]);
            Point3::new(at(0, u), at(1, v), z)
        };
        let places: Vec<Point3<f64>> = (0..COMPARED_AT * COMPARED_AT).map(place).collect();
        view_choice::most_telling(
            cameras,
            shares,
            &places,
            TALLEST_BUILDING_M,
            most.unwrap_or(MOST_VIEWS),
        )
    }

    /// Column, row, width, height of the part of a view that may show the region; `None` where it
    /// shows nothing of it.
    fn part(&self, camera: &Camera) -> Option<[u32; 4]> {
        if !self.is_seen_by(camera) {
            return None;
        }
        let window = window_of(bounds(self.outline(camera)), MARGIN_PX, camera);
        let [_, _, width, height] = window;
        let is_large = |side: u32, of: u32| side >= SMALLEST_SIDE_PX.min(of);
        (is_large(width, camera.width) && is_large(height, camera.height)).then_some(window)
    }

    /// Does some ground point of the region lie in the image? The box of the projected corners
    /// alone also contains parts of tilted views that see nothing of it.
    fn is_seen_by(&self, camera: &Camera) -> bool {
        // Points of the grid a side, but one. Assumption: a view that shows less than an eighth of
        // a region either way is of no use to it.
        const GRID_STEPS: u32 = 8;
        let t = |i: u32| f64::from(i) / f64::from(GRID_STEPS);
        let grid =
            || (0..=GRID_STEPS).flat_map(move |i| (0..=GRID_STEPS).map(move |j| (t(i), t(j))));
        let heights = [self.low.z, 0.5 * (self.low.z + self.high.z), self.high.z];
        let shown = heights.iter().any(|&z| {
            grid().any(|(u, v)| {
                let x = self.low.x + u * (self.high.x - self.low.x);
                let y = self.low.y + v * (self.high.y - self.low.y);
                let p = camera.project(&Point3::new(x, y, z));
                p.is_some_and(|p| camera.contains(&p, 0.0))
            })
        });
        // A region larger than the image.
        let (w, h) = (f64::from(camera.width), f64::from(camera.height));
        let contains = |p: &Point3<f64>| {
            p.x > self.low.x && p.x < self.high.x && p.y > self.low.y && p.y < self.high.y
        };
        let shows = |&z: &f64| {
            grid().any(|(u, v)| {
                camera
                    .at_height(&Point2::new(u * w, v * h), z)
                    .is_some_and(|p| contains(&p))
            })
        };
        shown || heights.iter().any(shows)
    }

    /// Points of the image whose box holds the region and its buildings: the corners, and where
    /// edges pass behind the camera.
    fn outline(&self, camera: &Camera) -> Vec<Point2<f64>> {
        // Depth of the plane at which edges are cut off, metres: in front of the camera, and nearer
        // than whatever is photographed from the air.
        const NEAR_PLANE_M: f64 = 1.0;
        let corner = |i: usize| {
            let pick =
                |axis: usize, low: f64, high: f64| if i >> axis & 1 == 0 { low } else { high };
            let top = self.high.z + TALLEST_BUILDING_M;
            Point3::new(
                pick(0, self.low.x, self.high.x),
                pick(1, self.low.y, self.high.y),
                pick(2, self.low.z, top),
            )
        };
        let mut points = Vec::new();
        for (i, axis) in (0..8)
            .flat_map(|i| (0..3).map(move |axis| (i, axis)))
            .filter(|(i, axis)| i >> axis & 1 == 0)
        {
            let (a, b) = (corner(i), corner(i | 1 << axis));
            let [da, db] = [a, b].map(|p| camera.depth(&p) - NEAR_PLANE_M);
            let before = [(a, da), (b, db)].into_iter().filter(|(_, d)| *d >= 0.0);
            points.extend(before.map(|(p, _)| p));
            if da * db < 0.0 {
                points.push(a + (b - a) * (da / (da - db)));
            }
        }
        points.iter().filter_map(|p| camera.project(p)).collect()
    }

    /// The refusal, with the area that the views see instead.
    fn unseen(&self, count: usize, cameras: &[Camera]) -> Error {
        let z = 0.5 * (self.low.z + self.high.z);
        let shown = cameras.iter().flat_map(|camera| {
            let (w, h) = (f64::from(camera.width), f64::from(camera.height));
            let places = [(0.5, 0.5), (0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
            let on_ground = places.map(|(u, v)| camera.at_height(&Point2::new(u * w, v * h), z));
            // Near the horizon the footprint of an image is unbounded.
            let farthest = 10.0 * (camera.center.z - z).abs();
            let is_near = move |p: &Point3<f64>| (p - camera.center).norm() < farthest;
            on_ground.into_iter().flatten().filter(is_near)
        });
        let [low, high] = bounds(shown);
        let off = 0.5 * (self.low.coords + self.high.coords - low.coords - high.coords);
        Error::scene(
            format!(
                "the region of interest is seen by {count} views, but three are needed; its middle lies {:.0} m east and {:.0} m north of \
                 that of the {:.0} x {:.0} m that the views see",
                off.x,
                off.y,
                high.x - low.x,
                high.y - low.y
            ),
            "give it as x0,y0,x1,y1 in metres of the orientation's coordinates",
        )
    }
}

/// Keeps the elements at these indices, which rise.
fn keep<T>(all: &mut Vec<T>, indices: &[usize]) {
    let mut index = 0..;
    all.retain(|_| (index.next()).is_some_and(|i| indices.binary_search(&i).is_ok()));
}

/// What is said of views that show the region and are not used.
fn notice_of_choice(showing: usize, used: usize) -> Option<String> {
    (used < showing).then(|| {
        format!("{showing} views show the region of interest; the {used} that say most about it are used")
    })
}

/// Cuts the region out of a scene whose views are decoded, and keeps at most so many of them.
pub(crate) fn cut_scene(scene: &mut Scene, roi: [f64; 4], most: Option<usize>) -> Result<()> {
    let cameras: Vec<Camera> = scene.views.iter().map(|v| v.camera.clone()).collect();
    let named: Vec<(&str, &Camera)> = scene.views.iter().map(|v| (&*v.name, &v.camera)).collect();
    let Some(heights) = camera_checks::check_cameras(&named, scene.ground_z).heights else {
        return Ok(());
    };
    let region = RegionOfInterest::new(roi, &scene.origin, heights)?;
    scene.views.retain_mut(|view| {
        let Some(part) = region.part(&view.camera) else {
            return false;
        };
        let photograph = Photograph {
            rgb: std::mem::take(&mut view.rgb),
            gray: std::mem::replace(&mut view.gray, Gray::new(0, 0)),
        };
        let Photograph { rgb, gray } = photograph.crop(part);
        (view.rgb, view.gray) = (rgb, gray);
        view.camera.k = offset_calibration(&view.camera.k, [part[0], part[1]]);
        (view.camera.width, view.camera.height) = (part[2], part[3]);
        true
    });
    let showing = scene.views.len();
    if showing < FEWEST_VIEWS {
        return Err(region.unseen(showing, &cameras));
    }
    let seeing: Vec<Camera> = scene.views.iter().map(|v| v.camera.clone()).collect();
    let shares = vec![1.0; seeing.len()];
    keep(
        &mut scene.views,
        &region.most_telling(&seeing, &shares, most),
    );
    scene
        .warnings
        .extend(notice_of_choice(showing, scene.views.len()));
    Ok(())
}

/// The part of the photograph that a part of the pinhole is made of, and the part itself: column,
/// row, width, height.
pub(crate) fn source_of(part: [u32; 4], whole: &Camera, lens: &Distortion) -> [u32; 4] {
    // Assumption: between so many samples a lens bends the border of a part by less than
    // [`SLACK_PX`].
    const GRID_STEPS: u32 = 16;
    let [column, row, width, height] = part.map(f64::from);
    let corner = Point2::new(column, row);
    let place = |i: u32, j: u32| {
        let t = |n: u32| f64::from(n) / f64::from(GRID_STEPS);
        Point2::new(column + t(i) * width, row + t(j) * height)
    };
    let grid = (0..=GRID_STEPS).flat_map(|i| (0..=GRID_STEPS).map(move |j| (i, j)));
    let measured = grid.map(|(i, j)| lens.measured(&whole.k, &place(i, j)));
    let ends = [corner, corner + Vector2::new(width, height)];
    // For positions between the samples, and for interpolation at the border.
    const SLACK_PX: f64 = 4.0;
    window_of(bounds(ends.into_iter().chain(measured)), SLACK_PX, whole)
}

/// The whole pixels of an image (column, row, width, height) around a box with a margin.
fn window_of([low, high]: [Point2<f64>; 2], margin_px: f64, image: &Camera) -> [u32; 4] {
    let side = |axis: usize, size: u32| {
        let inside = |v: f64| v.clamp(0.0, f64::from(size)) as u32;
        let from = inside((low[axis] - margin_px).floor());
        let to = inside((high[axis] + margin_px).ceil());
        (from, to.saturating_sub(from))
    };
    let (column, width) = side(0, image.width);
    let (row, height) = side(1, image.height);
    [column, row, width, height]
}
