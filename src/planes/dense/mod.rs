//! Planes from dense matching, where no line starts one (B99 2: the approach of ENST).
//!
//! ```text
//! sweep         the best level plane at every place
//! patch         a small piece of a surface
//! patch_match   slanted patches by PatchMatch, all views at once
//! region        patches in one plane, joined
//! least_rectangle   around a region
//! segmentation  the planes compete for the patches
//! surface_class building, ground or vegetation
//! cloud         a point cloud against the patches, and the planes in it
//! ```

mod cloud;
mod least_rectangle;
mod patch;
mod patch_match;
mod region;
mod segmentation;
mod surface_class;
mod sweep;

pub(crate) use cloud::LEAST_SIGMA_M;
pub use cloud::{CloudComparison, CloudPlane};
pub(crate) use least_rectangle::least_rectangle;
pub use patch::Patch;
pub use surface_class::{SurfaceClass, SurfaceEvidence};

use self::cloud::{Matched, compare};
use self::patch_match::PatchGrid;

use nalgebra::{Point2, Point3};
use serde::{Deserialize, Serialize};

use crate::base::evidence::JudgedSurface;
use crate::base::execution::Sharded;
use crate::base::geometry::{Plane, bounds};
use crate::base::ids::ProposalOrigin;

use crate::base::params::PointCloudParams;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::planes::grouping::ProposedPlane;
use crate::planes::photoconsistency::{PlanGrid, WindowMatcher};
use crate::planes::terrain::Ground;

/// Distance of neighbouring patches, cells of a window.
const SPACING: f64 = 2.5;
/// Samples of a window are so many pixels apart: a window of ten is about two metres wide on
/// photographs of a decimetre a pixel.
const REDUCED: usize = 2;

/// A plane that dense matching found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct DensePlane {
    /// The plane.
    pub plane: Plane,
    /// Covariance of the height at the middle of the region, metres, and of its gradient along x
    /// and y: 3 x 3.
    pub covariance: [[f64; 3]; 3],
    /// The least rectangle around the region in plan, in the plane, counter-clockwise from above.
    pub ring: Vec<Point3<f64>>,
    /// Its patches, by their places among all.
    pub patches: Vec<usize>,
    /// Area in plan, square metres.
    pub area_m2: f64,
    /// Root mean square of the patches' heights above and below the plane, metres.
    pub rms_m: f64,
    /// What it is.
    pub class: SurfaceClass,
}

impl DensePlane {
    /// As a plane that facets may have; `index` is its place in the list.
    pub fn proposed(&self, index: usize) -> ProposedPlane {
        ProposedPlane {
            origin: ProposalOrigin::DensePlane(index as u32),
            plane: self.plane,
            ring: self.ring.clone(),
            sides_on_edges: false,
        }
    }
}

/// How the planes came about.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct DenseTrace {
    /// All patches, row by row in plan.
    pub patches: Vec<Patch>,
    /// What speaks for each plane being a building or vegetation, and against it.
    pub classes: Vec<SurfaceEvidence>,
    /// Distance of neighbouring patches, metres.
    pub spacing_m: f64,
    /// A point cloud that is known, compared with the patches.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(target_arch = "wasm32", tsify(optional))]
    pub point_cloud: Option<CloudComparison>,
}

impl DenseTrace {
    /// The point cloud, where it counts.
    pub fn counted_cloud(&self) -> Option<&CloudComparison> {
        self.point_cloud.as_ref().filter(|cloud| cloud.counts())
    }

    /// What the planes are, as it is written out.
    pub(crate) fn judged(&self, planes: &[DensePlane]) -> Vec<JudgedSurface> {
        let judged = |(plane, class): (&DensePlane, &SurfaceEvidence)| JudgedSurface {
            patches: (plane.patches.iter())
                .map(|&k| self.patches[k].middle)
                .map(|p| plane.plane.lift(p.x, p.y))
                .collect(),
            building: class.building.clone(),
            vegetation: class.vegetation.clone(),
        };
        planes.iter().zip(&self.classes).map(judged).collect()
    }
}

/// Planes of the surfaces that the views agree on, and of a point cloud that is known, where it is
/// a source of planes.
pub fn dense_planes(
    scene: &Scene,
    lines: &[Line3d],
    ground: &Ground,
    cloud: Option<&PointCloudParams>,
) -> Sharded<(Vec<DensePlane>, DenseTrace)> {
    let Some(search) = Search::new(scene, lines) else {
        return Ok(Default::default());
    };
    let (matcher, z_per_pixel) = (search.matcher(), search.z_per_pixel);
    let grid = search.grid(search.extent.map(|p| p.xy()));
    let found = search.matched(&matcher, grid)?;
    let places: Vec<usize> = (found.patches.iter())
        .scan(0, |n, patch| {
            let place = *n;
            *n += usize::from(patch.is_some());
            Some(place)
        })
        .collect();
    let regions = segmentation::segmented(&found, &matcher, z_per_pixel);
    let classes = crate::base::execution::map(&regions, |_, region| {
        surface_class::weigh(region, &found, scene, ground, z_per_pixel)
    });
    let cloud = scene.known.point_cloud.as_ref().zip(cloud);
    let point_cloud = cloud.map(|(cloud, params)| {
        let matched = Matched {
            found: &found,
            regions: &regions,
            classes: &classes,
            ground,
            z_per_pixel,
        };
        compare(cloud, &matched, params)
    });
    let planes = regions.into_iter().zip(&classes).map(|(region, evidence)| {
        let middles = (region.cells.iter()).filter_map(|&k| found.patches[k].map(|p| p.middle));
        let middles: Vec<Point2<f64>> = middles.collect();
        let corners = least_rectangle(&middles, 0.5 * grid.step, &region.plane);
        DensePlane {
            plane: region.plane,
            covariance: region.covariance.transpose().into(),
            ring: (corners.iter())
                .map(|p| region.plane.lift(p.x, p.y))
                .collect(),
            area_m2: region.cells.len() as f64 * grid.step * grid.step,
            patches: region.cells.iter().map(|&k| places[k]).collect(),
            rms_m: region.rms_m,
            class: evidence.class(),
        }
    });
    let planes = planes.collect();
    let trace = DenseTrace {
        patches: found.patches.into_iter().flatten().collect(),
        classes,
        spacing_m: grid.step,
        point_cloud,
    };
    Ok((planes, trace))
}

/// Where and how finely the surfaces of a scene are sought.
struct Search {
    reduced: Scene,
    extent: [Point3<f64>; 2],
    /// Size of the cells compared, metres.
    step: f64,
    /// The change of height that moves the images by a pixel against each other, metres.
    z_per_pixel: f64,
}

impl Search {
    /// `None` where there are no lines.
    fn new(scene: &Scene, lines: &[Line3d]) -> Option<Self> {
        let extent = extent(lines)?;
        let reduced = scene.reduced(REDUCED);
        let middle = nalgebra::center(&extent[0], &extent[1]);
        let pixels = reduced.views.iter().map(|v| v.camera.ground_pixel(&middle));
        let pixel = pixels.fold(f64::INFINITY, f64::min);
        let z_per_pixel = pixel * height_by_base(&reduced, &middle);
        Some(Self {
            reduced,
            extent,
            step: PlanGrid::cell_of_pixels(pixel),
            z_per_pixel,
        })
    }

    /// The grid of the patches of a box in plan.
    fn grid(&self, [low, high]: [Point2<f64>; 2]) -> PlanGrid {
        PlanGrid::covering(low, high, SPACING * self.step)
    }

    fn matcher(&self) -> WindowMatcher<'_> {
        WindowMatcher::new(&self.reduced, self.step)
    }

    /// The patches of a grid.
    fn matched(&self, matcher: &WindowMatcher, grid: PlanGrid) -> Sharded<PatchGrid> {
        let heights = self.extent.map(|p| p.z);
        let (step, z_per_pixel) = (self.step, self.z_per_pixel);
        let levels = sweep::best_levels(&self.reduced, &grid, step, heights, z_per_pixel)?;
        patch_match::match_patches(matcher, grid, &levels, z_per_pixel)
    }
}

/// The box in which surfaces are sought: around the lines, which may be wrong in a few places.
fn extent(lines: &[Line3d]) -> Option<[Point3<f64>; 2]> {
    // Metres. Assumption: surfaces reach no farther beyond the lines.
    const MARGIN: f64 = 3.0;
    if lines.is_empty() {
        return None;
    }
    let ends = || lines.iter().flat_map(|l| [l.segment.p0, l.segment.p1]);
    let mut heights: Vec<f64> = ends().map(|p| p.z).collect();
    heights.sort_by(f64::total_cmp);
    let share = |f: f64| heights[(f * (heights.len() - 1) as f64) as usize];
    let [low, high] = bounds(ends().map(|p| p.xy()));
    Some([
        Point3::new(low.x - MARGIN, low.y - MARGIN, share(0.02) - 1.0),
        Point3::new(high.x + MARGIN, high.y + MARGIN, share(0.98) + 1.0),
    ])
}

/// Height over base: the change of height that moves the images of the two most different views by
/// one ground pixel against each other.
fn height_by_base(scene: &Scene, middle: &Point3<f64>) -> f64 {
    let down = |p: &Point3<f64>| (p.xy() - middle.xy()) / (p.z - middle.z);
    let centers = || scene.views.iter().map(|v| &v.camera.center);
    let bases = centers().flat_map(|a| centers().map(move |b| (down(a) - down(b)).norm()));
    1.0 / bases.fold(0.05, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planes::rendered_planes::{RIDGE_Z, level_ground, scene, slope_from, textured};
    use crate::roofs::testing::line;
    use nalgebra::{Vector2, Vector3};

    fn slope(to_the_north: f64) -> Plane {
        slope_from([0.0, 0.0], [0.0, to_the_north])
    }

    /// The planes of a gable roof of 14 m by 10 m on level ground.
    fn found() -> (Vec<DensePlane>, DenseTrace) {
        let views = scene(&[
            textured(slope(1.0), |x, y| x.abs() < 7.0 && (0.0..5.0).contains(&y)),
            textured(slope(-1.0), |x, y| {
                x.abs() < 7.0 && (-5.0..0.0).contains(&y)
            }),
            level_ground(),
        ]);
        let ridge = line(
            Point3::new(-7.0, 0.0, RIDGE_Z),
            Point3::new(7.0, 0.0, RIDGE_Z),
        );
        let kerb = line(Point3::new(-7.0, -8.0, 0.0), Point3::new(7.0, 8.0, 0.0));
        dense_planes(&views, &[ridge, kerb], &Ground::level(0.0), None).unwrap()
    }

    #[test]
    fn planted_slopes_are_found_where_no_line_lies_in_them() {
        let (planes, trace) = found();
        for truth in [slope(1.0), slope(-1.0)] {
            let near = |p: &&DensePlane| p.plane.angle_to(&truth) < 0.05;
            let plane = planes.iter().find(near).expect("the slope");
            let middle = crate::base::geometry::mean_point(&plane.ring);
            assert!(truth.signed_distance(&middle).abs() < 0.1, "{middle}");
            // Windows reach over the borders by half their width.
            assert!((plane.area_m2 - 70.0).abs() < 25.0, "{}", plane.area_m2);
            let off = |k: &usize| {
                let patch = &trace.patches[*k];
                (patch.z - truth.z_at(patch.middle.x, patch.middle.y)).abs()
            };
            // At its border a patch may have the plane, but not the height, of its neighbours.
            let near = plane.patches.iter().filter(|k| off(k) < 0.2).count();
            assert!(near * 50 >= plane.patches.len() * 49, "{near}");
            assert!(plane.covariance[0][0].sqrt() < 0.1);
            let inside = |k: &usize| {
                let p = trace.patches[*k].middle;
                p.x.abs() < 8.0 && p.y.abs() < 6.0
            };
            assert!(plane.patches.iter().all(inside));
        }
        let level = |p: &&DensePlane| p.plane.normal.z > 0.99 && p.class.building < 0.5;
        assert!(planes.iter().any(|p| level(&&p.clone())), "the ground");
    }

    #[test]
    fn probabilities_of_a_class_add_up() {
        let (planes, trace) = found();
        assert_eq!(planes.len(), trace.classes.len());
        for class in planes.iter().map(|p| p.class) {
            let sum = class.building + class.ground + class.vegetation;
            assert!(
                (sum - 1.0).abs() < 1e-12 && class.ground >= 0.0,
                "{class:?}"
            );
        }
    }

    #[test]
    fn the_least_rectangle_lies_along_the_contour_lines_of_a_long_slope() {
        let plane = Plane::from_point_normal(&Point3::origin(), &Vector3::new(0.6, 0.8, 2.0));
        let plane = plane.unwrap();
        let (along, down) = (Vector2::new(-0.8, 0.6), Vector2::new(0.6, 0.8));
        let points = (0..20).flat_map(|i| (0..5).map(move |j| (f64::from(i), f64::from(j))));
        let points: Vec<Point2<f64>> = points
            .map(|(t, u)| Point2::from(along * t + down * u))
            .collect();
        let corners = least_rectangle(&points, 0.5, &plane);
        let sides = [corners[1] - corners[0], corners[2] - corners[1]];
        assert!((sides[0].norm() - 20.0).abs() < 1e-9 && (sides[1].norm() - 5.0).abs() < 1e-9);
        assert!(sides[0].perp(&sides[1]) > 0.0, "counter-clockwise");
        assert!(sides[0].perp(&along).abs() < 1e-9);
    }

    #[test]
    fn nothing_is_sought_without_lines() {
        let (planes, trace) = dense_planes(&scene(&[]), &[], &Ground::level(0.0), None).unwrap();
        assert!(planes.is_empty() && trace.patches.is_empty());
    }
}
