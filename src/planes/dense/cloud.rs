//! A point cloud against what dense matching found: does it belong here, by how much is it moved,
//! and which planes do its points propose?
//!
//! ```text
//! patches of the views + points  ->  shift  ->  share of clear surfaces that the cloud has too
//!                                           ->  points in the frame of the images  ->  planes
//! ```
//!
//! Heights may have another datum, tens of metres off: the differences between patches and points
//! that most places share are found first, without any bound. Around each the shift is sought by
//! steps, so that
//!
//! ```text
//! sum over points  max(0, c^2 - ((z_point + dz - z_patch(x + dx, y + dy)) / s)^2) / 2
//! ```
//!
//! is largest: the log likelihood of a normal distribution with a uniform one beside it, to within
//! a constant. Whether the cloud belongs here is asked where the images show roofs or ground
//! clearly, as of footprints (`facets::register`). The planes are found as those of patches: points
//! make patches, and patches in one plane regions.

use nalgebra::{Point2, Point3, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use super::least_rectangle::least_rectangle;
use super::patch::{Patch, gradient_of};
use super::patch_match::{PatchGrid, STEEPEST};
use super::region::{Region, grow_regions};
use super::surface_class::SurfaceEvidence;
use crate::base::evidence::WindowEvidenceTable;
use crate::base::geometry::{Plane, bounds};
use crate::base::ids::ProposalOrigin;
use crate::base::math::{hypot, larger, smaller};
use crate::base::params::PointCloudParams;
use crate::orienting::known::{
    KnownComparison, KnownShift, KnownVerdict, PointCloud, belongs_here, best_shift,
};
use crate::planes::grouping::ProposedPlane;
use crate::planes::photoconsistency::PlanGrid;
use crate::planes::terrain::Ground;
use crate::planes::terrain::ROOF_M;

/// A point cloud compared with the images.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CloudComparison {
    /// As a whole.
    pub compared: KnownComparison,
    /// Share of the surfaces which the images show clearly, as roofs or as ground, that it has too;
    /// absent where they show too little.
    pub agreement: Option<f64>,
    /// The planes that it proposes.
    pub planes: Vec<CloudPlane>,
}

/// A plane in a point cloud.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CloudPlane {
    /// The plane.
    pub plane: Plane,
    /// The least rectangle around its points in plan, in the plane, counter-clockwise from above.
    pub ring: Vec<Point3<f64>>,
    /// Area in plan, square metres.
    pub area_m2: f64,
}

impl CloudPlane {
    /// As a plane that facets may have; `index` is its place in the list.
    pub fn proposed(&self, index: usize) -> ProposedPlane {
        ProposedPlane {
            origin: ProposalOrigin::CloudPlane(index as u32),
            plane: self.plane,
            ring: self.ring.clone(),
            sides_on_edges: false,
        }
    }
}

impl CloudComparison {
    /// Does it count?
    pub fn counts(&self) -> bool {
        !matches!(
            self.compared.verdict,
            KnownVerdict::Contradicted | KnownVerdict::Elsewhere
        )
    }

    /// The points of a cloud as they were moved, local frame.
    pub fn placed(&self, cloud: &PointCloud) -> Vec<Point3<f64>> {
        let by = self.compared.moved_m();
        cloud.points.iter().map(|p| p.cast() + by).collect()
    }
}

/// Fewest points over patches to compare, and fewest in a scene that is that of the cloud.
const FEWEST: usize = 30;
/// Most points that are compared.
const MOST_COMPARED: usize = 6000;
/// A cloud is moved in plan by at most this, metres. Assumption: more is another place.
const MOST_SHIFT_M: f64 = 4.0;
/// First step of the search in plan, metres: half of the narrowest slopes.
const STEP_M: f64 = 0.5;
/// Steps are halved so often: to three centimetres.
const HALVINGS: usize = 4;
/// What differs by more standard deviations is another surface.
const SAME: f64 = 3.0;
/// So many datums are tried.
const DATUMS: usize = 3;
/// What matching tells of the height of a patch, in heights that move the images by a pixel.
const PATCH_PIXELS: f64 = 0.3;
/// A shift is named, and taken out, from so many standard deviations on.
const SIGMAS: f64 = 2.0;
/// No height or place is known better, metres, whatever is stated.
pub(crate) const LEAST_SIGMA_M: f64 = 1e-3;

/// What dense matching found, for the comparison.
pub(super) struct Matched<'a> {
    pub found: &'a PatchGrid,
    pub regions: &'a [Region],
    pub classes: &'a [SurfaceEvidence],
    pub ground: &'a Ground,
    pub z_per_pixel: f64,
}

/// Compares a cloud with the patches of the views, and finds its planes.
pub(super) fn compare(
    cloud: &PointCloud,
    matched: &Matched,
    params: &PointCloudParams,
) -> CloudComparison {
    let grid = &matched.found.grid;
    let is_here = |p: &&Point3<f32>| grid.cell(&p.xy().cast()).is_some();
    let points: Vec<Point3<f64>> = (cloud.points.iter())
        .filter(is_here)
        .map(|p| p.cast())
        .collect();
    let unchecked = KnownComparison::new(&cloud.file, cloud.accuracy_m);
    let mut comparison = CloudComparison {
        compared: unchecked.clone(),
        agreement: None,
        planes: Vec::new(),
    };
    if points.len() < FEWEST {
        return comparison;
    }
    let patch_m = PATCH_PIXELS * matched.z_per_pixel;
    let surface = Surface {
        patches: matched.found,
        sigma_m: hypot(cloud.accuracy_m, patch_m).max(LEAST_SIGMA_M),
        place_sigma_m: params.place_sigma_m.max(LEAST_SIGMA_M),
    };
    let shift = surface.best_shift(&points).map(|by| KnownShift {
        by,
        explained_m: [
            SIGMAS * hypot(params.place_sigma_m, patch_m),
            SIGMAS * surface.sigma_m,
        ],
    });
    // What no clear roof or ground confirms is neither moved nor believed more than before.
    let found = shift.and_then(|shift| {
        let moved = match shift.is_real() {
            true => shift.by,
            false => Vector3::zeros(),
        };
        Some((shift, agreement(matched, &points, &moved, &surface)?))
    });
    comparison.agreement = found.map(|(_, [agree, differ])| agree / (agree + differ));
    let parts = found.map_or([0.0; 2], |(_, cells)| {
        cells.map(|n| n * (grid.step * grid.step / params.part_m2))
    });
    let belongs = belongs_here(params.belongs, parts, params.agreement, params.chance);
    comparison.compared = unchecked.judged(found.map(|(shift, _)| shift), belongs);
    if comparison.counts() {
        let placed = comparison.placed(cloud);
        comparison.planes = planes(&placed, cloud.accuracy_m, matched, params);
    }
    comparison
}

/// The surface that the views agree on.
struct Surface<'a> {
    patches: &'a PatchGrid,
    /// Standard deviation of a point's height against it, metres.
    sigma_m: f64,
    /// Standard deviation of the cloud in place, metres.
    place_sigma_m: f64,
}

/// Do the views agree on a patch?
fn agreed(patch: &Patch) -> bool {
    WindowEvidenceTable::fitted().nats_of(patch.weight, patch.correlation) > 0.0
}

impl Surface<'_> {
    fn z_at(&self, p: &Point2<f64>) -> Option<f64> {
        let (column, row) = self.patches.grid.cell(p)?;
        let patch = self.patches.patches[row * self.patches.grid.width + column].as_ref()?;
        agreed(patch).then(|| patch.z_at(p))
    }

    /// How well points that are moved lie on it, nats; a shift in plan is the less likely the
    /// larger it is.
    fn nats(&self, points: &[Point3<f64>], by: &Vector3<f64>) -> f64 {
        let of_point = |p: &Point3<f64>| {
            let p = p + by;
            let off = (p.z - self.z_at(&p.xy())?) / self.sigma_m;
            Some(0.5 * larger(SAME * SAME - off * off, 0.0))
        };
        let away = hypot(by.x, by.y) / self.place_sigma_m;
        points.iter().filter_map(of_point).sum::<f64>() - 0.5 * away * away
    }

    /// The shift at which most points lie on it; `None` where few lie over it.
    fn best_shift(&self, points: &[Point3<f64>]) -> Option<Vector3<f64>> {
        let every = points.len().div_ceil(MOST_COMPARED);
        let points: Vec<Point3<f64>> = points.iter().copied().step_by(every).collect();
        let rises = points
            .iter()
            .filter_map(|p| Some(self.z_at(&p.xy())? - p.z));
        let datums = self.datums(rises.collect());
        let reach = (MOST_SHIFT_M / STEP_M) as i32;
        // No shift comes first, and of equally good ones the first counts.
        let mut starts = vec![Vector3::zeros()];
        for dz in datums {
            for (y, x) in (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (y, x))) {
                for z in [0.0, -1.0, 1.0] {
                    let [x, y] = [x, y].map(|n| f64::from(n) * STEP_M);
                    starts.push(Vector3::new(x, y, dz + z * SAME * self.sigma_m));
                }
            }
        }
        if starts.len() == 1 {
            return None;
        }
        let (mut best, mut most) = best_shift(&starts, |by| self.nats(&points, by))?;
        let mut step = Vector3::new(0.5 * STEP_M, 0.5 * STEP_M, 1.5 * self.sigma_m);
        for _ in 0..HALVINGS {
            for _ in 0..2 {
                for (axis, sign) in [
                    (2, 1.0),
                    (2, -1.0),
                    (0, 1.0),
                    (0, -1.0),
                    (1, 1.0),
                    (1, -1.0),
                ] {
                    let mut by = best;
                    by[axis] += sign * step[axis];
                    let found = self.nats(&points, &by);
                    if found > most {
                        (best, most) = (by, found);
                    }
                }
            }
            step *= 0.5;
        }
        Some(best)
    }

    /// Heights by which many points lie below it, metres: those that most share first.
    fn datums(&self, mut rises: Vec<f64>) -> Vec<f64> {
        rises.sort_by(f64::total_cmp);
        let width = 2.0 * SAME * self.sigma_m;
        let mut found = Vec::new();
        while found.len() < DATUMS && rises.len() >= FEWEST {
            let (mut end, mut best) = (0, 0..0);
            for start in 0..rises.len() {
                while end < rises.len() && rises[end] <= rises[start] + width {
                    end += 1;
                }
                if end - start > best.len() {
                    best = start..end;
                }
            }
            found.push(rises[best.start + best.len() / 2]);
            rises.drain(best);
        }
        found
    }
}

/// How many patches of clear roofs or ground the moved cloud agrees with, and how many not; `None`
/// where the views show none. What is near the border of a surface is not asked.
fn agreement(
    matched: &Matched,
    points: &[Point3<f64>],
    moved: &Vector3<f64>,
    surface: &Surface,
) -> Option<[f64; 2]> {
    let grid = &matched.found.grid;
    // What lies highest above the ground, and nearest to the patch, in each cell.
    let mut nearest = vec![f64::INFINITY; grid.width * grid.height];
    let mut highest = vec![f64::NEG_INFINITY; grid.width * grid.height];
    for p in points.iter().map(|p| p + moved) {
        let Some((column, row)) = grid.cell(&p.xy()) else {
            continue;
        };
        let cell = row * grid.width + column;
        highest[cell] = larger(highest[cell], p.z - matched.ground.z_at(&p.xy()));
        if let Some(patch) = matched.found.patches[cell].as_ref().filter(|p| agreed(p)) {
            nearest[cell] = smaller(nearest[cell], (p.z - patch.z_at(&p.xy())).abs());
        }
    }
    let [mut agree, mut differ] = [0.0; 2];
    for (region, class) in matched.regions.iter().zip(matched.classes) {
        let class = class.class();
        let is_inside = |cell: usize| {
            let around = matched.found.around(cell);
            let of_region = around.filter(|(k, _)| region.cells.binary_search(k).is_ok());
            of_region.count() == 8
        };
        for &cell in region.cells.iter().filter(|k| nearest[**k].is_finite()) {
            if !is_inside(cell) {
                continue;
            }
            let is_same = nearest[cell] < SAME * surface.sigma_m;
            if class.building > SURE {
                match is_same {
                    true => agree += 1.0,
                    false => differ += 1.0,
                }
            } else if class.ground > SURE && highest[cell] > ROOF_M && !is_same {
                // Ground that both have tells no place from another.
                differ += 1.0;
            }
        }
    }
    (agree + differ > 0.0).then_some([agree, differ])
}

/// A surface that is something with this probability shows it clearly.
const SURE: f64 = 0.8;

/// The planes in a cloud above the ground, the largest first.
fn planes(
    points: &[Point3<f64>],
    accuracy_m: f64,
    matched: &Matched,
    params: &PointCloudParams,
) -> Vec<CloudPlane> {
    let whole = &matched.found.grid;
    let size = Vector2::new(whole.width as f64, whole.height as f64) * whole.step;
    let [low, high] = [whole.origin, whole.origin + size];
    let is_high = |p: &&Point3<f64>| {
        whole.cell(&p.xy()).is_some() && p.z - matched.ground.z_at(&p.xy()) > params.least_height_m
    };
    let high_points: Vec<Point3<f64>> = points.iter().filter(is_high).copied().collect();
    if high_points.is_empty() {
        return Vec::new();
    }
    let density = points
        .iter()
        .filter(|p| whole.cell(&p.xy()).is_some())
        .count() as f64
        / (size.x * size.y);
    let step = (1.0 / density).sqrt().clamp(FINEST_M, COARSEST_M);
    let grid = PlanGrid::covering(low, high, step);
    let mut cells = vec![Vec::new(); grid.width * grid.height];
    for p in &high_points {
        if let Some((column, row)) = grid.cell(&p.xy()) {
            cells[row * grid.width + column].push((*p, 1.0));
        }
    }
    let off_m = SAME * accuracy_m;
    let patches = (0..cells.len()).map(|cell| patch(&grid, &cells, cell, accuracy_m));
    let found = PatchGrid {
        grid,
        patches: patches.collect(),
        views: Vec::new(),
    };
    // A patch lies in a plane within half of that.
    let regions = grow_regions(&found, 2.0 * off_m);
    let plane = |region: Region| {
        let of_region = region.cells.iter().flat_map(|&k| &cells[k]);
        let near = of_region.filter(|(p, _)| region.plane.signed_distance(p).abs() < off_m);
        let near: Vec<(Point3<f64>, f64)> = near.copied().collect();
        let plane = Plane::fit(&near)?.upwards();
        if gradient_of(&plane).norm() > STEEPEST {
            return None;
        }
        let area_m2 = region.cells.len() as f64 * grid.step * grid.step;
        let middles: Vec<Point2<f64>> = near.iter().map(|(p, _)| p.xy()).collect();
        let corners = least_rectangle(&middles, 0.25 * grid.step, &plane);
        (area_m2 >= params.least_area_m2).then(|| CloudPlane {
            plane,
            ring: corners.iter().map(|p| plane.lift(p.x, p.y)).collect(),
            area_m2,
        })
    };
    let mut planes: Vec<CloudPlane> = regions.into_iter().filter_map(plane).collect();
    planes.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    planes
}

/// Finest and coarsest distance of the patches of a cloud, metres.
const FINEST_M: f64 = 0.5;
const COARSEST_M: f64 = 2.0;
/// Fewest points of a patch.
const FEWEST_OF_PATCH: usize = 5;

/// The patch of a cell: the plane through the points in it and around it, where they lie in one.
fn patch(
    grid: &PlanGrid,
    cells: &[Vec<(Point3<f64>, f64)>],
    cell: usize,
    accuracy_m: f64,
) -> Option<Patch> {
    if cells[cell].is_empty() {
        return None;
    }
    let (column, row) = (cell % grid.width, cell / grid.width);
    let [columns, rows] = [(column, grid.width), (row, grid.height)]
        .map(|(at, size)| at.saturating_sub(1)..=(at + 1).min(size - 1));
    let around = rows.flat_map(|r| {
        columns
            .clone()
            .flat_map(move |c| &cells[r * grid.width + c])
    });
    let points: Vec<(Point3<f64>, f64)> = around.copied().collect();
    if points.len() < FEWEST_OF_PATCH {
        return None;
    }
    // Points along a line span no plane.
    let [low, high] = bounds(points.iter().map(|(p, _)| p.xy()));
    if smaller(high.x - low.x, high.y - low.y) < grid.step {
        return None;
    }
    let plane = Plane::fit(&points)?.upwards();
    let off = points.iter().map(|(p, _)| plane.signed_distance(p));
    let rms = (off.map(|off| off * off).sum::<f64>() / points.len() as f64).sqrt();
    let gradient = gradient_of(&plane);
    let is_plane = rms <= accuracy_m && gradient.norm() <= STEEPEST;
    let middle = grid.center(column, row);
    is_plane.then(|| Patch {
        middle,
        z: plane.z_at(middle.x, middle.y),
        gradient,
        correlation: 1.0,
        weight: 1.0,
    })
}
