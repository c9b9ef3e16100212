//! What images and lines say for each plane over each cell: the terms of the labelling energy.

use std::collections::BTreeMap;

use nalgebra::Point2;

use super::ThetaFrame;
use super::arrangement::{Arrangement, CellEdge};
use super::consistency::ConsistencyMap;
use super::grouping::{GroupingInput, PlaneGroup};
use super::hypothesis::Hypothesis;
use super::labelling::{Energy, LabelEdge, NO_PLANE};
use super::line_index::LineIndex;
use super::plan::PlanGrid;
use crate::geometry::Plane;
use crate::params::RoofParams;

/// What the images say about one plane in one cell.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellEvidence {
    /// Plan area seen with the plane's region over it, square metres.
    pub area: f64,
    /// Sum of texture weight over the area.
    pub weight: f64,
    /// Sum of weight x correlation over the area.
    pub correlation: f64,
    /// Metres of line on the cell's border whose half-plane lies over the cell.
    pub half_plane_m: f64,
}

/// The evidence for every plane in every cell that it may cover.
pub struct Evidence {
    /// Per cell: (plane, evidence), ascending by plane.
    cells: Vec<Vec<(u32, CellEvidence)>>,
    /// Per cell: sum of weight x (correlation - least correlation) on the ground, square metres; at least 0.
    ground: Vec<f64>,
}

impl Evidence {
    /// Sums each hypothesis' consistency map over the cells; `ground` are the maps of the ground plane at
    /// a few heights, over `grid`.
    pub fn collect(
        input: &GroupingInput,
        hypotheses: &[Hypothesis],
        arrangement: &Arrangement,
        grid: &PlanGrid,
        ground: &[ConsistencyMap],
        params: &RoofParams,
    ) -> Self {
        let raster = arrangement.raster(grid);
        let ground = ground_evidence(ground, &raster, arrangement.cells, grid, params);
        let per_group = crate::parallel::map_part(hypotheses, 0.7..0.75, |_, h| {
            let mut cells = sum_over_cells(h, &raster, grid);
            add_half_planes(&mut cells, input, &h.group, &raster, grid);
            cells
        });
        let mut cells = vec![Vec::new(); arrangement.cells];
        for (i, group_cells) in per_group.into_iter().enumerate() {
            for (cell, e) in group_cells {
                // Most of the cell must lie in the plane's region and be seen.
                if !arrangement.open[cell] && e.area >= 0.7 * arrangement.areas[cell] {
                    cells[cell].push((i as u32, e));
                }
            }
        }
        Self { cells, ground }
    }

    /// The evidence for a plane in a cell; `None` where the plane may not cover it.
    pub fn get(&self, cell: usize, plane: u32) -> Option<&CellEvidence> {
        self.cells[cell]
            .binary_search_by_key(&plane, |e| e.0)
            .ok()
            .map(|i| &self.cells[cell][i].1)
    }

    /// The energy that labelling minimises.
    pub fn energy(
        &self,
        arrangement: &Arrangement,
        planes: &[Plane],
        index: &LineIndex,
        params: &RoofParams,
    ) -> Energy {
        let unary = self
            .cells
            .iter()
            .zip(&self.ground)
            .map(|(candidates, ground)| {
                candidates
                    .iter()
                    .map(|(plane, e)| {
                        // sum of weight x (least correlation - correlation): negative for a match.
                        let mismatch = e.weight * params.min_correlation - e.correlation;
                        // "No plane" keeps the cost 0, so what speaks for the ground counts against roofs.
                        (
                            *plane,
                            mismatch + ground - params.half_plane_gain_m * e.half_plane_m,
                        )
                    })
                    .collect()
            })
            .collect();
        let edges = arrangement
            .edges
            .iter()
            .map(|e| self.label_edge(e, arrangement, planes, index, params))
            .collect();
        Energy { unary, edges }
    }

    /// What different labels on both sides of a cell border cost.
    fn label_edge(
        &self,
        edge: &CellEdge,
        arrangement: &Arrangement,
        planes: &[Plane],
        index: &LineIndex,
        params: &RoofParams,
    ) -> LabelEdge {
        let (a, b) = (arrangement.vertices[edge.a], arrangement.vertices[edge.b]);
        let length = (b - a).norm();
        let full = length * params.border_cost_m;
        let heights = index.heights_along(&a, &b);
        let on_line = |plane: &Plane, p: &Point2<f64>| {
            let z = plane.z_at(p.x, p.y);
            heights.iter().any(|h| (h - z).abs() < LINE_HEIGHT)
        };
        let middle = Point2::from((a.coords + b.coords) * 0.5);
        let mut supported = Vec::new();
        let labels = |cell: usize| self.cells[cell].iter().map(|c| c.0).chain([NO_PLANE]);
        for p in labels(edge.left) {
            for q in labels(edge.right).filter(|&q| q != p) {
                let (pp, qq) = (planes.get(p as usize), planes.get(q as usize));
                let factor = match (pp, qq) {
                    // Two hypotheses of one roof plane: a border between them says nothing.
                    (Some(p), Some(q))
                        if p.angle_to(q) < SAME_PLANE && apart(p, q, &middle) < MEETING =>
                    {
                        DUPLICATE
                    }
                    (Some(p), Some(q)) => {
                        let meets = [a, b]
                            .iter()
                            .all(|x| (p.z_at(x.x, x.y) - q.z_at(x.x, x.y)).abs() < MEETING);
                        let real = on_line(p, &middle) || on_line(q, &middle);
                        match (meets, real) {
                            (true, true) => CREASE_ON_LINE,
                            (true, false) => CREASE,
                            (false, true) => ON_LINE,
                            (false, false) => 1.0,
                        }
                    }
                    (Some(p), None) | (None, Some(p)) if on_line(p, &middle) => ON_LINE,
                    _ => 1.0,
                };
                if factor != 1.0 {
                    supported.push((p, q, factor * full));
                }
            }
        }
        LabelEdge {
            cells: [edge.left, edge.right],
            unsupported: full,
            supported,
        }
    }
}

fn apart(p: &Plane, q: &Plane, at: &Point2<f64>) -> f64 {
    (p.z_at(at.x, at.y) - q.z_at(at.x, at.y)).abs()
}

/// Planes at less than this angle, radians (6 degrees), that meet are one plane found twice.
const SAME_PLANE: f64 = 6.0 * std::f64::consts::PI / 180.0;
/// Share of the full border cost between two hypotheses of one plane.
const DUPLICATE: f64 = 1.5;
/// Share of the full border cost where two planes meet along a reconstructed line, ...
const CREASE_ON_LINE: f64 = 0.1;
/// ... where two planes meet, ...
const CREASE: f64 = 0.3;
/// ... and where a reconstructed line of one of the planes bounds it.
const ON_LINE: f64 = 0.15;
/// Planes meet when their heights differ by less, metres.
const MEETING: f64 = 0.25;
/// A line lies in a plane's border when their heights differ by less, metres.
pub const LINE_HEIGHT: f64 = 0.35;

/// How much of the ground's match counts. Assumption: half. Rows of tiles or seams that run along the parallax
/// correlate at any height, so a match with the ground is weaker evidence than a half-plane's.
const GROUND_SHARE: f64 = 0.5;

/// What the ground explains at least as well as a roof could, per cell.
fn ground_evidence(
    maps: &[ConsistencyMap],
    raster: &[u32],
    cells: usize,
    grid: &PlanGrid,
    params: &RoofParams,
) -> Vec<f64> {
    let area = grid.step * grid.step;
    let mut evidence = vec![0.0f64; cells];
    for (k, &cell) in raster.iter().enumerate().filter(|(_, c)| **c != u32::MAX) {
        let best = maps
            .iter()
            .map(|m| (m.correlation(k), m.weight(k)))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((correlation, weight)) = best {
            evidence[cell as usize] +=
                f64::from(weight) * (f64::from(correlation) - params.min_correlation) * area;
        }
    }
    evidence
        .iter_mut()
        .for_each(|e| *e = GROUND_SHARE * e.max(0.0));
    evidence
}

fn sum_over_cells(
    hypothesis: &Hypothesis,
    raster: &[u32],
    grid: &PlanGrid,
) -> BTreeMap<usize, CellEvidence> {
    let (map, region) = (&hypothesis.map, &hypothesis.region);
    let window = &map.grid;
    let (dc, dr) = window.offset_in(grid);
    let area = grid.step * grid.step;
    let mut cells = BTreeMap::<usize, CellEvidence>::new();
    for row in 0..window.height {
        for column in 0..window.width {
            let (c, r) = (column as isize + dc, row as isize + dr);
            if c < 0 || r < 0 || c as usize >= grid.width || r as usize >= grid.height {
                continue;
            }
            let cell = raster[r as usize * grid.width + c as usize];
            let k = row * window.width + column;
            if cell == u32::MAX
                || map.weight(k) == 0.0
                || !region.contains(&window.center(column, row))
            {
                continue;
            }
            let e = cells.entry(cell as usize).or_default();
            let weight = f64::from(map.weight(k)) * area;
            e.area += area;
            e.weight += weight;
            e.correlation += weight * f64::from(map.correlation(k));
        }
    }
    cells
}

/// Credits the cells beside each member line, on the side of its half-plane.
fn add_half_planes(
    cells: &mut BTreeMap<usize, CellEvidence>,
    input: &GroupingInput,
    group: &PlaneGroup,
    raster: &[u32],
    grid: &PlanGrid,
) {
    const STEP: f64 = 0.1;
    /// How far beside the line the cell is looked up, metres: beyond the snapping of vertices.
    const BESIDE: f64 = 0.3;
    for member in &group.members {
        let Some(h) = member.half_plane else { continue };
        let line = &input.lines[member.line.index()].segment;
        let Some(frame) = ThetaFrame::new(line, input.half_planes[h.index()].side) else {
            continue;
        };
        let count = (line.length() / STEP).ceil().max(1.0);
        for i in 0..count as usize {
            let p = line.at((i as f64 + 0.5) / count).xy() + frame.outward.xy() * BESIDE;
            let Some((c, r)) = grid.cell(&p) else {
                continue;
            };
            if let Some(e) = cells.get_mut(&(raster[r * grid.width + c] as usize)) {
                e.half_plane_m += line.length() / count;
            }
        }
    }
}
