//! From half-planes to facets: the stage that orders B99 4.2 and 4.3.
//!
//! lines and half-planes -> groups -> regions, border lines -> plan cells -> consistency of every plane
//! over its region -> labelling -> outlines -> verification. A facet that fails verification is
//! withdrawn and its neighbours are decided again without it, as the paper updates the
//! neighbours of a plane that is removed.

use nalgebra::{Point2, Point3};
use serde::Serialize;

use super::arrangement::{Arrangement, CellEdge};
use super::borders::{Border, Region, border_lines};
use super::consistency::{ConsistencyMap, consistency_map};
use super::delineation::{Delineation, Outline, delineate, signed_area};
use super::grouping::{GroupingInput, PlaneGroup, group_planes};
use super::labelling::{Energy, LabelEdge, NO_PLANE};
use super::neighbourhood::line_neighbours;
use super::plan::PlanGrid;
use super::plane_lines::{PlaneLine, lines_in_plane};
use super::{HalfPlane, ThetaFrame};
use crate::geometry::{Plane, Segment3};
use crate::ids::BuildingId;
use crate::lines2d::ImageSegment;
use crate::lines3d::Line3d;
use crate::params::RoofParams;
use crate::roof::{Facet, Ground};
use crate::scene::Scene;

/// Why a facet was withdrawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FacetRejection {
    /// Smaller than the least area.
    TooSmall {
        /// Sloped area, square metres.
        area_m2: f64,
    },
    /// On the ground, or too little above it.
    NearGround {
        /// Height of its middle above the ground, metres.
        height_m: f64,
    },
    /// The views do not agree inside the outline.
    Dissimilar {
        /// Mean correlation inside the outline.
        similarity: f64,
    },
    /// Too little of its outline lies on reconstructed lines or on intersections with other facets.
    Unsupported {
        /// tau_real, 0 to 1.
        real_ratio: f64,
    },
}

/// A withdrawn facet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RejectedFacet {
    /// Its outline, metres, local frame.
    pub outline: Vec<Point3<f64>>,
    /// Why.
    pub reason: FacetRejection,
}

/// What grouping, delineation and verification did.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FacetTrace {
    /// Groups of coplanar lines and half-planes.
    pub groups: Vec<PlaneGroup>,
    /// Lines found in the groups' planes.
    pub plane_lines: Vec<PlaneLine>,
    /// Border lines in plan.
    pub borders: Vec<Border>,
    /// Number of cells that the border lines cut the plan into.
    pub cells: usize,
    /// Withdrawn facets.
    pub rejected: Vec<RejectedFacet>,
}

/// Facets from 3D lines and half-planes (B99 4.2, 4.3). Their `building` is still unset (0): facets that
/// touch become buildings when walls are added.
pub fn reconstruct_facets(
    scene: &Scene,
    segments: &[Vec<ImageSegment>],
    lines: &[Line3d],
    half_planes: &[HalfPlane],
    ground: &Ground,
    params: &RoofParams,
) -> (Vec<Facet>, FacetTrace) {
    let neighbours = line_neighbours(lines);
    let input = GroupingInput { lines, half_planes, neighbours: &neighbours };
    let mut groups: Vec<PlaneGroup> = group_planes(&input, params);
    groups.retain(|g| !lies_on_ground(&input, g, ground, params));
    let regions: Vec<Region> = groups.iter().map(|g| Region::new(&input, g, params)).collect();
    let Some(grid) = plan_window(scene, lines, &regions) else {
        return (Vec::new(), FacetTrace { groups, ..FacetTrace::default() });
    };
    let plane_lines: Vec<PlaneLine> =
        crate::parallel::map(&groups, |i, g| lines_in_plane(scene, segments, &g.plane, &regions[i])).concat();
    let in_plane: Vec<Segment3> = plane_lines.iter().map(|l| l.segment).collect();
    let borders = border_lines(&input, &groups, &regions, &in_plane, params);
    let real: Vec<Segment3> = lines.iter().map(|l| l.segment).chain(in_plane).collect();
    let index = LineIndex::new(real);
    let arrangement = Arrangement::new(&with_frame(&borders, &grid));
    let planes: Vec<Plane> = groups.iter().map(|g| g.plane).collect();

    let evidence = Evidence::collect(scene, &input, &groups, &regions, &arrangement, &grid);
    let energy = evidence.energy(&arrangement, &planes, &index, params);
    let mut solver = Solver { energy, evidence, arrangement, planes, index };
    let (facets, rejected) = solver.solve(&groups, ground, params);
    let cells = solver.arrangement.cells;
    (facets, FacetTrace { groups, plane_lines, borders, cells, rejected })
}

/// Are all lines of the group lower than any eave?
fn lies_on_ground(input: &GroupingInput, group: &PlaneGroup, ground: &Ground, params: &RoofParams) -> bool {
    group.members.iter().all(|m| {
        let line = &input.lines[m.line.index()].segment;
        [line.p0, line.p1].iter().all(|p| p.z - ground.z_at(&p.xy()) < 0.7 * params.min_height_m)
    })
}

/// The plan grid of the whole scene: the ground pixel as cell, the regions of all groups as window.
fn plan_window(scene: &Scene, lines: &[Line3d], regions: &[Region]) -> Option<PlanGrid> {
    let middle = lines.get(lines.len() / 2)?.at(0.5);
    let mut steps: Vec<f64> = scene.views.iter().map(|v| v.camera.ground_pixel(&middle)).collect();
    let step = crate::math::median(&mut steps)?;
    let (mut min, mut max) = regions.first()?.bounds();
    for (low, high) in regions.iter().map(Region::bounds) {
        min = Point2::new(min.x.min(low.x), min.y.min(low.y));
        max = Point2::new(max.x.max(high.x), max.y.max(high.y));
    }
    let size = max - min;
    // Coarser cells for a very large window: at most 36 million.
    let step = step.max((size.x * size.y / 36e6).sqrt());
    (size.x > 0.0 && size.y > 0.0 && step.is_finite()).then(|| PlanGrid::covering(min, max, step))
}

/// The borders and a frame around the window, so that every cell that matters is closed.
fn with_frame(borders: &[Border], grid: &PlanGrid) -> Vec<Border> {
    const MARGIN: f64 = 25.0;
    let (x0, y0) = (grid.origin.x - MARGIN, grid.origin.y - MARGIN);
    let x1 = grid.origin.x + grid.width as f64 * grid.step + MARGIN;
    let y1 = grid.origin.y + grid.height as f64 * grid.step + MARGIN;
    let corner = [Point2::new(x0, y0), Point2::new(x1, y0), Point2::new(x1, y1), Point2::new(x0, y1)];
    let frame = (0..4).map(|i| Border {
        kind: super::borders::BorderKind::Closing,
        a: corner[i],
        b: corner[(i + 1) % 4],
    });
    borders.iter().copied().chain(frame).collect()
}

/// What the images say about one plane in one cell.
#[derive(Clone, Copy, Debug, Default)]
struct CellEvidence {
    /// Plan area seen with the plane's region over it, square metres.
    area: f64,
    /// Sum of texture weight over the area.
    weight: f64,
    /// Sum of weight x correlation over the area.
    correlation: f64,
    /// Metres of line on the cell's border whose half-plane lies over the cell.
    half_plane_m: f64,
}

struct Evidence {
    /// Per cell: (plane, evidence), ascending by plane.
    cells: Vec<Vec<(u32, CellEvidence)>>,
}

impl Evidence {
    fn collect(
        scene: &Scene,
        input: &GroupingInput,
        groups: &[PlaneGroup],
        regions: &[Region],
        arrangement: &Arrangement,
        grid: &PlanGrid,
    ) -> Self {
        let raster = arrangement.raster(grid);
        let per_group = crate::parallel::map(groups, |i, group| {
            let (min, max) = regions[i].bounds();
            let window = PlanGrid::covering(min, max, grid.step);
            let map = consistency_map(scene, &group.plane, &window);
            let mut cells = sum_over_cells(&map, &regions[i], &raster, grid);
            add_half_planes(&mut cells, input, group, &raster, grid);
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
        Self { cells }
    }

    fn get(&self, cell: usize, plane: u32) -> Option<&CellEvidence> {
        self.cells[cell].binary_search_by_key(&plane, |e| e.0).ok().map(|i| &self.cells[cell][i].1)
    }

    fn energy(&self, arrangement: &Arrangement, planes: &[Plane], index: &LineIndex, params: &RoofParams) -> Energy {
        let unary = self
            .cells
            .iter()
            .map(|candidates| {
                candidates
                    .iter()
                    .map(|(plane, e)| {
                        // sum of weight x (least correlation - correlation): negative for a match.
                        let mismatch = e.weight * params.min_correlation - e.correlation;
                        (*plane, mismatch - params.half_plane_gain_m * e.half_plane_m)
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
                    (Some(p), Some(q)) => {
                        let meets = [a, b].iter().all(|x| (p.z_at(x.x, x.y) - q.z_at(x.x, x.y)).abs() < MEETING);
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
                if factor < 1.0 {
                    supported.push((p, q, factor * full));
                }
            }
        }
        LabelEdge { cells: [edge.left, edge.right], unsupported: full, supported }
    }
}

/// Share of the full border cost where two planes meet along a reconstructed line, ...
const CREASE_ON_LINE: f64 = 0.1;
/// ... where two planes meet, ...
const CREASE: f64 = 0.3;
/// ... and where a reconstructed line of one of the planes bounds it.
const ON_LINE: f64 = 0.15;
/// Planes meet when their heights differ by less, metres.
const MEETING: f64 = 0.25;
/// A line lies in a plane's border when their heights differ by less, metres.
const LINE_HEIGHT: f64 = 0.35;

fn sum_over_cells(
    map: &ConsistencyMap,
    region: &Region,
    raster: &[u32],
    grid: &PlanGrid,
) -> std::collections::BTreeMap<usize, CellEvidence> {
    let window = &map.grid;
    let (dc, dr) = window.offset_in(grid);
    let area = grid.step * grid.step;
    let mut cells = std::collections::BTreeMap::<usize, CellEvidence>::new();
    for row in 0..window.height {
        for column in 0..window.width {
            let (c, r) = (column as isize + dc, row as isize + dr);
            if c < 0 || r < 0 || c as usize >= grid.width || r as usize >= grid.height {
                continue;
            }
            let cell = raster[r as usize * grid.width + c as usize];
            let k = row * window.width + column;
            if cell == u32::MAX || map.weight[k] == 0.0 || !region.contains(&window.center(column, row)) {
                continue;
            }
            let e = cells.entry(cell as usize).or_default();
            let weight = f64::from(map.weight[k]) * area;
            e.area += area;
            e.weight += weight;
            e.correlation += weight * f64::from(map.correlation[k]);
        }
    }
    cells
}

/// Credits the cells beside each member line, on the side of its half-plane.
fn add_half_planes(
    cells: &mut std::collections::BTreeMap<usize, CellEvidence>,
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
        let Some(frame) = ThetaFrame::new(line, input.half_planes[h.index()].side) else { continue };
        let count = (line.length() / STEP).ceil().max(1.0);
        for i in 0..count as usize {
            let p = line.at((i as f64 + 0.5) / count).xy() + frame.outward.xy() * BESIDE;
            let Some((c, r)) = grid.cell(&p) else { continue };
            if let Some(e) = cells.get_mut(&(raster[r * grid.width + c] as usize)) {
                e.half_plane_m += line.length() / count;
            }
        }
    }
}

/// 3D lines by plan position.
struct LineIndex {
    lines: Vec<Segment3>,
    tree: rstar::RTree<rstar::primitives::GeomWithData<rstar::primitives::Rectangle<[f64; 2]>, usize>>,
}

/// A border lies on a line within this distance in plan, metres, and this sine of the angle.
const BESIDE_LINE: f64 = 0.25;
const LINE_SINE: f64 = 0.12;

impl LineIndex {
    fn new(lines: Vec<Segment3>) -> Self {
        let boxes = lines
            .iter()
            .enumerate()
            .map(|(i, l)| {
                let (a, b) = (l.p0, l.p1);
                let low = [a.x.min(b.x) - BESIDE_LINE, a.y.min(b.y) - BESIDE_LINE];
                let high = [a.x.max(b.x) + BESIDE_LINE, a.y.max(b.y) + BESIDE_LINE];
                rstar::primitives::GeomWithData::new(rstar::primitives::Rectangle::from_corners(low, high), i)
            })
            .collect();
        Self { lines, tree: rstar::RTree::bulk_load(boxes) }
    }

    /// Heights of the lines that run along a -> b at its middle, ascending.
    fn heights_along(&self, a: &Point2<f64>, b: &Point2<f64>) -> Vec<f64> {
        let middle = Point2::from((a.coords + b.coords) * 0.5);
        let d = (b - a) / (b - a).norm().max(1e-12);
        let mut heights: Vec<f64> = self
            .tree
            .locate_all_at_point(&[middle.x, middle.y])
            .filter_map(|g| {
                let line = &self.lines[g.data];
                let e = line.p1.xy() - line.p0.xy();
                let length = e.norm();
                if length < 1e-9 {
                    return None;
                }
                let u = e / length;
                let r = middle - line.p0.xy();
                let t = r.dot(&u) / length;
                let slack = BESIDE_LINE / length;
                ((-slack..=1.0 + slack).contains(&t) && u.perp(&r).abs() < BESIDE_LINE && u.perp(&d).abs() < LINE_SINE)
                    .then(|| line.at(t.clamp(0.0, 1.0)).z)
            })
            .collect();
        heights.sort_by(f64::total_cmp);
        heights
    }
}

struct Solver {
    energy: Energy,
    evidence: Evidence,
    arrangement: Arrangement,
    planes: Vec<Plane>,
    index: LineIndex,
}

impl Solver {
    /// Labels, delineates and verifies until no facet is withdrawn.
    fn solve(
        &mut self,
        groups: &[PlaneGroup],
        ground: &Ground,
        params: &RoofParams,
    ) -> (Vec<Facet>, Vec<RejectedFacet>) {
        const ROUNDS: usize = 4;
        let mut rejected = Vec::new();
        for round in 1..=ROUNDS {
            let labels = self.energy.minimise(self.planes.len() as u32);
            let delineation = delineate(&self.arrangement, &labels, &self.planes);
            let mut facets = Vec::new();
            let mut withdrawn = Vec::new();
            for outline in &delineation.outlines {
                let facet = self.facet(outline, &delineation, groups);
                match self.verify(&facet, outline, ground, params) {
                    Ok(()) => facets.push(facet),
                    Err(reason) => {
                        rejected.push(RejectedFacet { outline: facet.outer, reason });
                        withdrawn.push(outline);
                    }
                }
            }
            if withdrawn.is_empty() || round == ROUNDS {
                return (facets, rejected);
            }
            for outline in withdrawn {
                for &cell in &outline.cells {
                    self.energy.unary[cell].retain(|u| u.0 != outline.plane);
                }
            }
        }
        unreachable!("the last round returns")
    }

    fn facet(&self, outline: &Outline, delineation: &Delineation, groups: &[PlaneGroup]) -> Facet {
        let plane = self.planes[outline.plane as usize];
        let group = &groups[outline.plane as usize];
        let lift = |ring: &Vec<usize>| -> Vec<Point3<f64>> {
            ring.iter().map(|&v| delineation.vertices[v]).map(|p| plane.lift(p.x, p.y)).collect()
        };
        let (mut weight, mut correlation) = (0.0, 0.0);
        for e in outline.cells.iter().filter_map(|&c| self.evidence.get(c, outline.plane)) {
            weight += e.weight;
            correlation += e.correlation;
        }
        Facet {
            building: BuildingId(0),
            plane,
            outer: lift(&outline.outer),
            holes: outline.holes.iter().map(lift).collect(),
            similarity: if weight > 0.0 { correlation / weight } else { 0.0 },
            real_ratio: self.real_ratio(outline, delineation),
            lines: group.lines(),
            half_planes: group.half_planes(),
        }
    }

    /// tau_real: the share of the outline on reconstructed lines, B99 4.3.
    fn real_ratio(&self, outline: &Outline, delineation: &Delineation) -> f64 {
        let plane = &self.planes[outline.plane as usize];
        let (mut real, mut total) = (0.0, 0.0);
        for (i, &v) in outline.outer.iter().enumerate() {
            let a = delineation.vertices[v];
            let b = delineation.vertices[outline.outer[(i + 1) % outline.outer.len()]];
            let pieces = ((b - a).norm() / 0.25).ceil().max(1.0);
            for k in 0..pieces as usize {
                let (p, q) = (a + (b - a) * (k as f64 / pieces), a + (b - a) * ((k + 1) as f64 / pieces));
                let z = plane.z_at(0.5 * (p.x + q.x), 0.5 * (p.y + q.y));
                total += (q - p).norm();
                if self.index.heights_along(&p, &q).iter().any(|h| (h - z).abs() < LINE_HEIGHT) {
                    real += (q - p).norm();
                }
            }
        }
        if total > 0.0 { real / total } else { 0.0 }
    }

    fn verify(&self, facet: &Facet, outline: &Outline, ground: &Ground, params: &RoofParams) -> Result<(), FacetRejection> {
        let plan: Vec<Point2<f64>> = facet.outer.iter().map(Point3::xy).collect();
        let ring: Vec<usize> = (0..plan.len()).collect();
        let area_m2 = signed_area(&ring, &plan) / facet.plane.normal.z;
        if area_m2 < params.min_area_m2 {
            return Err(FacetRejection::TooSmall { area_m2 });
        }
        let middle = facet.outer.iter().fold(nalgebra::Vector3::zeros(), |s, p| s + p.coords) / facet.outer.len() as f64;
        let height_m = middle.z - ground.z_at(&Point2::new(middle.x, middle.y));
        if height_m < params.min_height_m {
            return Err(FacetRejection::NearGround { height_m });
        }
        // What little texture there is must not speak against the plane.
        if facet.similarity < params.min_correlation && self.weight(outline) > 0.1 * area_m2 {
            return Err(FacetRejection::Dissimilar { similarity: facet.similarity });
        }
        if facet.real_ratio < params.min_real_ratio {
            return Err(FacetRejection::Unsupported { real_ratio: facet.real_ratio });
        }
        Ok(())
    }

    fn weight(&self, outline: &Outline) -> f64 {
        outline.cells.iter().filter_map(|&c| self.evidence.get(c, outline.plane)).map(|e| e.weight).sum()
    }
}
