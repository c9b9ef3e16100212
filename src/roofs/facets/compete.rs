//! From groups to the planes that compete for the plan.
//!
//! groups -> regions, border lines -> plan cells -> consistency of every plane over its region. All
//! of it is kept for delineation, so that what only weighs it differently measures nothing again.

use std::sync::Arc;

use nalgebra::Point2;
use serde::Serialize;

use super::borders::{Arrangement, Border, BorderKind, LineIndex, border_lines, bounding_lines};
use super::competing_planes::CompetingPlanes;
use super::dominated::{supported, without_dominated};
use super::evidence::PlaneEvidence;
use super::input::FacetInput;
use super::point_cloud::CloudEvidence;
use super::refitting::refitted_groups;
use crate::base::execution::{Sharded, reached, sharded_map};
use crate::base::geometry::{Plane, bounds, sides};
use crate::base::params::RoofParams;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::planes::grouping::{PlanRegion, PlaneGroup};
use crate::planes::hypotheses::{PlaneHypothesis, PlaneLine, PlaneMeasurement};
use crate::planes::photoconsistency::{
    ConsistencyMap, PlanGrid, ShiftableWindows, consistency_map_of_surface,
};
use crate::planes::terrain::Ground;

/// What grouping found.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct GroupingTrace {
    /// Groups of coplanar lines and half-planes.
    pub groups: Vec<PlaneGroup>,
    /// Lines found in the groups' planes.
    pub plane_lines: Vec<PlaneLine>,
    /// Border lines in plan.
    pub borders: Vec<Border>,
    /// Number of cells that the border lines cut the plan into.
    pub cells: usize,
}

/// The planes of groups, with how the views agree on each over the cells of the plan; `None` where
/// there is nothing to compete for.
pub fn competing_planes(
    scene: &Scene,
    evidence: &FacetInput,
    params: &RoofParams,
) -> Sharded<(Option<CompetingPlanes>, GroupingTrace)> {
    let FacetInput {
        segments,
        grouped,
        ground,
        cloud,
    } = *evidence;
    let (input, groups) = (grouped.input(), grouped.groups.clone());
    let lines = input.lines;
    let regions: Vec<PlanRegion> = groups
        .iter()
        .map(|g| PlanRegion::new(&input, g, params))
        .collect();
    let Some(grid) = plan_window(scene, lines, &regions) else {
        let trace = GroupingTrace {
            groups,
            ..GroupingTrace::default()
        };
        return Ok((None, trace));
    };
    let fine = scene
        .views
        .iter()
        .map(|v| v.camera.ground_pixel(&lines[0].at(0.5)))
        .fold(f64::INFINITY, f64::min);
    let reduced = scene.reduced(((grid.of_samples().step / fine) as usize).max(1));
    reached(0.1);
    // Both compare the views on planes, independently of each other: one map.
    let ground_map = ground_map(&reduced, ground, &grid);
    let measurement = PlaneMeasurement::new((scene, &reduced), segments, &input, grid.step, params);
    let hypotheses = measurement.sharded(&groups);
    let (ground_map, hypotheses) = (ground_map?, hypotheses?);
    let windows = ShiftableWindows::new(lines.iter().map(|l| l.segment), &grid);
    let cloud = cloud.map(|cloud| CloudEvidence::new(Arc::clone(cloud), ground, &grid));
    let with_support = |hypotheses| {
        let ground = ground_map.as_ref();
        supported(hypotheses, ground, &windows, &grid, cloud.as_ref())
    };
    let mut planes = without_dominated(with_support(hypotheses));
    if let Some(cloud) = &cloud {
        let refitted = refitted_groups(&planes, cloud, &grid, &input, params);
        planes.extend(with_support(measurement.alone(&refitted)));
        planes = without_dominated(planes);
    }
    let hypotheses: Vec<PlaneHypothesis> = planes.into_iter().map(|p| p.hypothesis).collect();
    reached(0.7);
    let bounding = bounding_lines(&input, &hypotheses, ground, params);
    let borders = border_lines(
        &input,
        &hypotheses,
        &bounding,
        &windows,
        cloud.as_ref(),
        params,
    );
    reached(0.8);
    let arrangement = Arrangement::new(&with_frame(&borders, &grid));
    reached(0.9);
    let evidence = PlaneEvidence::collect(
        &hypotheses,
        &arrangement,
        &grid,
        ground_map.as_ref(),
        &windows,
        cloud.as_ref(),
    );
    let groups: Vec<PlaneGroup> = (hypotheses.iter())
        .map(|h| h.group.without_propagated(&input))
        .collect();
    let (maps, plane_lines): (Vec<ConsistencyMap>, Vec<Vec<PlaneLine>>) =
        hypotheses.into_iter().map(|h| (h.map, h.lines)).unzip();
    let plane_lines = plane_lines.concat();
    let planes: Vec<Plane> = groups.iter().map(|g| g.plane).collect();
    let real = lines
        .iter()
        .map(|l| l.segment)
        .chain(plane_lines.iter().map(|l| l.segment));
    let index = LineIndex::new(real.collect());
    let trace = GroupingTrace {
        groups: groups.clone(),
        plane_lines,
        borders,
        cells: arrangement.cells,
    };
    let competing = CompetingPlanes {
        groups,
        evidence,
        arrangement,
        planes,
        index,
        maps,
        scene: reduced,
        grid,
        cloud,
    };
    Ok((Some(competing), trace))
}

/// The plan grid of the whole scene: samples a ground pixel apart, the regions of all groups as
/// window.
fn plan_window(scene: &Scene, lines: &[Line3d], regions: &[PlanRegion]) -> Option<PlanGrid> {
    let middle = lines.get(lines.len() / 2)?.at(0.5);
    let mut steps: Vec<f64> = scene
        .views
        .iter()
        .map(|v| v.camera.ground_pixel(&middle))
        .collect();
    let step = PlanGrid::cell_of_pixels(crate::base::math::median(&mut steps)?);
    let [min, max] = bounds(regions.iter().flat_map(PlanRegion::bounds));
    let size = max - min;
    // Coarser cells for a very large window: at most 9 million.
    let step = step.max(FINEST_CELL_M).max((size.x * size.y / 9e6).sqrt());
    (size.x > 0.0 && size.y > 0.0 && step.is_finite()).then(|| PlanGrid::covering(min, max, step))
}

/// Similarity of the views on the ground. Its height is only known to a few decimetres: at every
/// position the views may agree at the height that it has there or a step beside it.
fn ground_map(scene: &Scene, ground: &Ground, grid: &PlanGrid) -> Sharded<Option<ConsistencyMap>> {
    // Metres: the few decimetres.
    const STEP: f64 = 0.3;
    let plane = ground.plane();
    let maps = sharded_map("planes", &[-STEP, 0.0, STEP], 0.1..0.2, |_, step| {
        consistency_map_of_surface(scene, &plane, &|p| ground.z_at(p) + step, grid)
    })?;
    Ok(ConsistencyMap::best_of(&maps))
}

/// Finest cell, metres. Assumption: samples 6 cm apart are what a roof's border lines can be told
/// apart by; sharper images are reduced.
pub(crate) const FINEST_CELL_M: f64 = 0.12;

/// The borders and a frame around the window, so that every cell that matters is closed.
fn with_frame(borders: &[Border], grid: &PlanGrid) -> Vec<Border> {
    // Metres. Assumption: no cell beside the window matters farther out.
    const MARGIN: f64 = 25.0;
    let (x0, y0) = (grid.origin.x - MARGIN, grid.origin.y - MARGIN);
    let x1 = grid.origin.x + grid.width as f64 * grid.step + MARGIN;
    let y1 = grid.origin.y + grid.height as f64 * grid.step + MARGIN;
    let corner = [
        Point2::new(x0, y0),
        Point2::new(x1, y0),
        Point2::new(x1, y1),
        Point2::new(x0, y1),
    ];
    let frame = sides(&corner).map(|[a, b]| Border {
        kind: BorderKind::Closing,
        a,
        b,
    });
    borders.iter().copied().chain(frame).collect()
}
