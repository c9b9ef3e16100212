//! A whole flight before a pixel is decoded: where its photographs were taken, what each shows of
//! the ground, how many show each place, and what a run on each of many regions would read.
//!
//! The orientation is read once for all regions.

use nalgebra::{Point2, Point3};
use serde::Serialize;

use super::super::ground::{pixel_in_the_middle, reduction_on, unreduced_plan};
use super::super::input::LoadOptions;
use super::super::memory;
use super::super::plan::Plan;
use super::super::planned_view::PlannedView;
use super::super::region::RegionOfInterest;
use super::windows::{ShownArea, ViewWindow, coarsest_pixel, enclosing, shows};
use crate::base::error::{Error, Result};
use crate::orienting::orientation::InputFile;
use crate::photographs::camera::Camera;

/// Places along the longer side of the box in which the photographs that show a place are counted.
const PLACES: u32 = 96;

/// Points along a side of a footprint's outline: a fold at the horizon needs more than corners.
const OUTLINE: u32 = 4;

/// Where the height of the ground comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum GroundSource {
    /// The options state it.
    Stated,
    /// Photographs show it.
    Measured,
    /// From the distances of the cameras, by the usual overlap.
    Assumed,
}

/// The photographs of a flight, seen from above; metres, world frame of the input.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FlightOverview {
    /// Lowest and highest height of the ground, as far as it is known.
    pub heights: [f64; 2],
    /// Where these come from.
    pub ground: GroundSource,
    /// The height between them at which the footprints are drawn.
    pub ground_z: f64,
    /// The factor by which photographs are reduced: as it is stated, or so that roofs do not
    /// suffer.
    pub reduction: f64,
    /// Size of a pixel on the ground then, the middle one of all photographs.
    pub pixel_m: f64,
    /// The photographs in use.
    pub footprints: Vec<Footprint>,
    /// The box of what three or more show, in whole metres: x0, y0, x1, y1.
    pub shown: Option<[f64; 4]>,
    /// How many show each place.
    pub overlap: Overlap,
}

/// What a photograph shows of the ground.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Footprint {
    /// Path of the file.
    pub path: String,
    /// The name that the view goes by.
    pub view: String,
    /// Where it was taken.
    pub center: [f64; 3],
    /// Around what it shows; what lies towards the horizon is left out.
    pub outline: Vec<[f64; 2]>,
}

/// Numbers of photographs on a grid of places.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Overlap {
    /// x0, y0, x1, y1.
    pub area: [f64; 4],
    /// Cells from west to east.
    pub columns: u32,
    /// Cells from south to north.
    pub rows: u32,
    /// How many show the middle of each cell, from west to east, then from south to north.
    pub counts: Vec<u16>,
}

/// A flight whose orientation has been read.
pub struct Flight<'a> {
    files: &'a [InputFile],
    memory_mb: Option<u32>,
    most: Option<usize>,
    plan: Plan,
    /// World frame.
    heights: [f64; 2],
    source: GroundSource,
    reduction: f64,
    shown: Option<ShownArea>,
}

impl<'a> Flight<'a> {
    /// Of the files their heads suffice. `ground` has the heights of the ground where they
    /// were measured, metres, world frame of the input.
    pub fn new(
        files: &'a [InputFile],
        options: &LoadOptions,
        ground: Option<[f64; 2]>,
    ) -> Result<Self> {
        let mut plan = unreduced_plan(files, options);
        if !plan.errors.is_empty() {
            return Err(plan.errors.remove(0));
        }
        let (heights, source) = match (options.ground_z, ground) {
            (Some(stated), _) => ([stated; 2], GroundSource::Stated),
            (None, Some(heights)) => (heights, GroundSource::Measured),
            (None, None) => {
                let cameras: Vec<&Camera> = plan.views.iter().map(|view| &view.whole).collect();
                let assumed = assumed_ground(&cameras) + plan.origin.z;
                ([assumed; 2], GroundSource::Assumed)
            }
        };
        let shown = ShownArea::of_plan(&plan, heights);
        let z = 0.5 * (heights[0] + heights[1]) - plan.origin.z;
        let reduction = options.reduction.unwrap_or_else(|| reduction_on(&plan, z));
        for view in &mut plan.views {
            view.reduce(reduction);
        }
        Ok(Self {
            files,
            memory_mb: options.memory_mb,
            most: options.max_views,
            heights,
            source,
            reduction,
            plan,
            shown,
        })
    }

    /// The ground that three or more views show; `None` where there is none.
    pub fn shown(&self) -> Option<&ShownArea> {
        self.shown.as_ref()
    }

    /// All photographs, seen from above.
    pub fn overview(&self) -> FlightOverview {
        let origin = self.plan.origin;
        let z = 0.5 * (self.heights[0] + self.heights[1]) - origin.z;
        let cameras: Vec<&Camera> = self.plan.views.iter().map(|view| &view.whole).collect();
        let coarsest = coarsest_pixel(&cameras, z).unwrap_or(f64::INFINITY);
        let footprint = |view: &PlannedView| Footprint {
            path: self.files[view.file].path.clone(),
            view: view.name.clone(),
            center: (view.whole.center + origin).coords.into(),
            outline: (outline(&view.whole, z, coarsest).iter())
                .map(|p| [p.x + origin.x, p.y + origin.y])
                .collect(),
        };
        let pixel_m = pixel_in_the_middle(cameras.iter().copied(), z).unwrap_or_default();
        let moved = |[x0, y0, x1, y1]: [f64; 4], by: f64| {
            let [x, y] = [by * origin.x, by * origin.y];
            [x0 + x, y0 + y, x1 + x, y1 + y]
        };
        let shown = self.shown.as_ref().map(|shown| shown.bounds);
        let frame = frame_of(&cameras, shown.map(|bounds| moved(bounds, -1.0)));
        let mut overlap = overlap(&cameras, z, coarsest, frame);
        overlap.area = moved(overlap.area, 1.0);
        FlightOverview {
            heights: self.heights,
            ground: self.source,
            ground_z: z + origin.z,
            pixel_m,
            reduction: self.reduction,
            footprints: self.plan.views.iter().map(footprint).collect(),
            shown,
            overlap,
        }
    }

    /// The views that a run on a region of interest reads, which part of each, and the memory that
    /// it takes at its peak with so many square metres of roof, megabytes, with the whole files of
    /// these views; and why, if that is refused. Where the region's ground is not known it is that
    /// of the flight.
    pub fn windows(
        &self,
        region: &LoadOptions,
        roofs_m2: Option<f64>,
    ) -> Result<(Vec<ViewWindow>, u64, Option<Error>)> {
        let mut views = self.plan.views.clone();
        let heights = region.ground_range.unwrap_or(self.heights);
        let heights = heights.map(|height| height - self.plan.origin.z);
        let roi = region.roi.expect("a region is stated");
        let region = RegionOfInterest::new(roi, &self.plan.origin, heights)?;
        region.cut(self.files, &mut views, self.most)?;
        let bytes = memory::peak_bytes(self.files, &views, roofs_m2);
        // What roofs take is never a reason to leave them out.
        let of_photographs = memory::peak_bytes(self.files, &views, roofs_m2.map(|_| 0.0));
        let refusal = memory::check_memory(of_photographs, &views, self.memory_mb);
        let window = |view: &PlannedView| ViewWindow::of(self.files, view);
        // A part of a megabyte counts as a whole one.
        Ok((
            views.iter().map(window).collect(),
            (bytes >> 20) + 1,
            refusal,
        ))
    }
}

/// Height of the ground if neighbours show three quarters of the same, metres, local frame.
/// Assumption: the overlap for which flights are usually planned; cameras that look down in
/// parallel say nothing else of it.
fn assumed_ground(cameras: &[&Camera]) -> f64 {
    // What the next photograph shows of other ground.
    const NEW_SHARE: f64 = 0.25;
    let middle = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let nearest = |i: usize| {
        let others = cameras.iter().enumerate().filter(|&(j, _)| i != j);
        let distances = others.map(|(_, other)| (other.center - cameras[i].center).xy().norm());
        // Copies of a photograph were taken at one place.
        distances.filter(|&d| d > 0.0).fold(f64::INFINITY, f64::min)
    };
    let above = |i: usize| {
        let Camera { k, height, .. } = cameras[i];
        nearest(i) / NEW_SHARE * k[(1, 1)].abs() / f64::from(*height)
    };
    let all = || 0..cameras.len();
    middle(all().map(|i| cameras[i].center.z).collect()) - middle(all().map(above).collect())
}

/// Points around what a camera shows of the ground at this height in pixels finer than `coarsest`.
fn outline(camera: &Camera, z: f64, coarsest: f64) -> Vec<Point2<f64>> {
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)];
    let places = (0..4 * OUTLINE).filter_map(|i| {
        let side = (i / OUTLINE) as usize;
        let (from, to) = (corners[side], corners[(side + 1) % 4]);
        let t = f64::from(i % OUTLINE) / f64::from(OUTLINE);
        let p = Point2::new(from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
        camera.at_height(&p, z)
    });
    places
        .filter(|p| camera.ground_pixel(p) < coarsest)
        .map(|p| p.xy())
        .collect()
}

/// The box of what is to be seen of a flight: what three show and where they were taken, with a
/// margin; local frame.
fn frame_of(cameras: &[&Camera], shown: Option<[f64; 4]>) -> [f64; 4] {
    // A share of the longer side. Assumption: what lies at the border is then seen whole.
    const MARGIN_SHARE: f64 = 0.06;
    let corners = shown
        .into_iter()
        .flat_map(|[x0, y0, x1, y1]| [(x0, y0), (x1, y1)].map(|(x, y)| Point2::new(x, y)));
    let centers = cameras.iter().map(|camera| camera.center.xy());
    let all: Vec<Point2<f64>> = corners.chain(centers).collect();
    let [x0, y0, x1, y1] = enclosing(&all).unwrap_or_default();
    let margin = (MARGIN_SHARE * (x1 - x0).max(y1 - y0)).max(1.0);
    [x0 - margin, y0 - margin, x1 + margin, y1 + margin]
}

/// How many cameras show each place of a box, local frame.
fn overlap(cameras: &[&Camera], z: f64, coarsest: f64, area: [f64; 4]) -> Overlap {
    let [x0, y0, x1, y1] = area;
    let cell = ((x1 - x0).max(y1 - y0) / f64::from(PLACES)).max(f64::MIN_POSITIVE);
    let count = |size: f64| (size / cell).ceil().clamp(1.0, f64::from(PLACES)) as u32;
    let (columns, rows) = (count(x1 - x0), count(y1 - y0));
    let places: Vec<u32> = (0..columns * rows).collect();
    let counts = crate::base::execution::map(&places, |_, &i| {
        let middle = |low: f64, high: f64, n: u32, of: u32| {
            low + (high - low) * (f64::from(n) + 0.5) / f64::from(of)
        };
        let x = middle(x0, x1, i % columns, columns);
        let y = middle(y0, y1, i / columns, rows);
        let place = Point3::new(x, y, z);
        let showing = cameras
            .iter()
            .filter(|camera| shows(camera, &place, coarsest));
        u16::try_from(showing.count()).unwrap_or(u16::MAX)
    });
    Overlap {
        area,
        columns,
        rows,
        counts,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::scene_loader::ground::plan_scene;
    use crate::orienting::scene_loader::{files_of_ground, files_of_views};
    use crate::orienting::synthetic::{gable_scene, to_files};
    use crate::photographs::raster::image_format;

    fn options(roi: Option<[f64; 4]>, ground_z: Option<f64>) -> LoadOptions {
        LoadOptions {
            orientation: Some("colmap".to_owned()),
            roi,
            ground_z,
            max_views: Some(4),
            ..LoadOptions::default()
        }
    }

    /// The files of a house, and the height of its ground.
    fn house() -> (Vec<InputFile>, f64) {
        let (scene, truth) = gable_scene(96);
        let files = to_files(&scene).into_iter();
        let files = files.map(|(path, bytes)| InputFile::new(&path, bytes));
        (files.collect(), scene.origin.z + truth.ground_z)
    }

    #[test]
    fn each_region_is_planned_as_a_run_on_it_is() {
        let (files, z) = house();
        let stated = options(None, Some(z));
        let flight = Flight::new(&files, &stated, None).unwrap();
        let [x0, y0, x1, y1] = flight.overview().shown.unwrap();
        let (x, y) = (0.5 * (x0 + x1), 0.5 * (y0 + y1));
        for roi in [[x0, y0, x1, y1], [x, y, x + 1.0, y + 1.0], [x0, y0, x, y]] {
            let alone = plan_scene(&files, &options(Some(roi), Some(z)));
            let views = alone.views.iter().map(|view| ViewWindow::of(&files, view));
            let region = options(Some(roi), Some(z));
            let (windows, memory_mb, _) = flight.windows(&region, None).unwrap();
            assert_eq!(windows, views.collect::<Vec<_>>());
            assert_eq!(memory_mb, (alone.peak_bytes >> 20) + 1);
            assert_eq!(windows.len(), 4);
            // Ground that is known of the region alone, and is not measured.
            let known = LoadOptions {
                ground_range: Some([z - 1.0, z + 2.0]),
                ..options(Some(roi), None)
            };
            assert!(files_of_ground(&files, &known).is_empty());
            let alone = plan_scene(&files, &known);
            let views = alone.views.iter().map(|view| ViewWindow::of(&files, view));
            let (windows, ..) = flight.windows(&known, None).unwrap();
            assert_eq!(windows, views.collect::<Vec<_>>());
        }
        let elsewhere = [x1 + 900.0, y1, x1 + 950.0, y1 + 50.0];
        assert!(
            flight
                .windows(&options(Some(elsewhere), Some(z)), None)
                .is_err()
        );
    }

    #[test]
    fn large_roofs_are_stated_and_photographs_alone_are_refused() {
        let (files, z) = house();
        let planned = |memory_mb: u32, roofs_m2: f64| {
            let limited = LoadOptions {
                memory_mb: Some(memory_mb),
                ..options(None, Some(z))
            };
            let flight = Flight::new(&files, &limited, None).unwrap();
            let roi = flight.overview().shown;
            let (_, stated_mb, refusal) = flight
                .windows(&options(roi, Some(z)), Some(roofs_m2))
                .unwrap();
            (stated_mb, refusal.is_some())
        };
        let (small, large) = (planned(100, 100.0), planned(100, 7000.0));
        assert!(small.0 < 50 && large.0 > 1000, "{small:?} {large:?}");
        assert!(!small.1 && !large.1);
        assert!(planned(20, 0.0).1);
    }

    #[test]
    fn the_first_bytes_of_photographs_suffice_for_a_plan() {
        let (files, z) = house();
        let mut heads = files.clone();
        let is_image = |file: &InputFile| image_format(&file.bytes).is_some();
        for file in heads.iter_mut().filter(|file| is_image(file)) {
            file.bytes.truncate(file.bytes.len() / 2);
        }
        let stated = options(None, Some(z));
        let plan = |files: &[InputFile]| Flight::new(files, &stated, None).unwrap().overview();
        assert_eq!(plan(&heads), plan(&files));
        let [x0, y0, x1, y1] = plan(&files).shown.unwrap();
        let region = options(Some([x0, y0, x1, y1]), Some(z));
        assert!(files_of_ground(&heads, &region).is_empty());
        assert_eq!(
            files_of_views(&heads, &region),
            files_of_views(&files, &region)
        );
        // Where the ground is to be measured, in four photographs.
        let unknown = options(Some([x0, y0, x1, y1]), None);
        assert_eq!(files_of_ground(&heads, &unknown).len(), 4);
    }

    #[test]
    fn the_plan_counts_the_photographs_that_show_a_place() {
        let (files, z) = house();
        let found = Flight::new(&files, &options(None, Some(z)), None)
            .unwrap()
            .overview();
        assert_eq!(found.ground, GroundSource::Stated);
        assert_eq!((found.ground_z, found.heights), (z, [z, z]));
        assert_eq!(found.footprints.len(), 6);
        let Overlap {
            columns,
            rows,
            counts,
            ..
        } = &found.overlap;
        assert_eq!(counts.len(), (columns * rows) as usize);
        assert_eq!(counts.iter().max(), Some(&6));
        assert_eq!(counts.iter().min(), Some(&0));
        // The frames' pixels are 8.5 cm large.
        assert!((found.pixel_m - 0.085).abs() < 0.09, "{}", found.pixel_m);
        for footprint in &found.footprints {
            assert_eq!(footprint.outline.len(), 4 * OUTLINE as usize);
        }
    }

    #[test]
    fn a_flight_as_it_is_usually_planned_tells_its_height() {
        // 100 m above the ground, each next view shows a quarter of new ground.
        let above = |i: u32| Camera {
            k: nalgebra::Matrix3::new(80.0, 0.0, 40.0, 0.0, 80.0, 40.0, 0.0, 0.0, 1.0),
            r: nalgebra::Matrix3::new(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0),
            center: Point3::new(25.0 * f64::from(i), 0.0, 130.0),
            width: 80,
            height: 80,
        };
        let cameras: Vec<Camera> = (0..5).map(above).collect();
        let found = assumed_ground(&cameras.iter().collect::<Vec<_>>());
        assert!((found - 30.0).abs() < 1e-9, "{found}");
    }
}
