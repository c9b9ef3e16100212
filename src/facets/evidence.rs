//! Evidence of images and lines for each plane over each cell: the data term of the labelling
//! energy.

use std::collections::{BTreeMap, BTreeSet};

use super::borders::{Arrangement, BorderCosts, LineIndex};
use super::labelling::Energy;
use crate::geometry::Plane;
use crate::lines3d::ThetaFrame;
use crate::math::larger;
use crate::params::RoofParams;
use crate::photoconsistency::{ConsistencyMap, PlanGrid, ShiftableWindows};
use crate::planes::{GroupingInput, PlaneGroup, PlaneHypothesis};

/// Photo-consistency of one plane in one cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CellEvidence {
    /// Plan area seen with the plane's region over it, square metres.
    pub area: f64,
    /// Sum of texture weight over the area.
    pub weight: f64,
    /// Sum of weight x correlation over the area.
    pub correlation: f64,
    /// Sum of what the windows say of the plane over the area, square metres of agreement.
    pub gain: f64,
    /// Sum of the single-view evidence over the area, square metres.
    pub single_view: f64,
}

/// Least texture weight with which planes are compared with each other. Chance correlation is the
/// same for every plane at one place, so that weak texture discriminates between planes better than
/// between a plane and none. Measured: from 1 on it is noise that decides between them.
const AMONG_PLANES: f64 = 0.5;

/// Weight of single-view evidence against perfect agreement of several views. Assumption: half of
/// what agreement mostly reaches beyond the threshold.
const SINGLE_VIEW_WEIGHT: f64 = 0.2;

impl CellEvidence {
    /// Mean correlation of the texture; `None` without any.
    fn mean_correlation(&self) -> Option<f64> {
        (self.weight > 0.0).then(|| self.correlation / self.weight)
    }

    /// Extra cost of a plane of weak texture where another one correlates by `best`.
    fn behind(&self, best: f64) -> f64 {
        let lacking = (AMONG_PLANES * self.area - self.weight).max(0.0);
        (self.mean_correlation()).map_or(0.0, |correlation| lacking * (best - correlation))
    }
}

/// The evidence for every plane in every cell that it may cover.
pub(super) struct PlaneEvidence {
    /// Per cell: (plane, evidence), ascending by plane.
    cells: Vec<Vec<(u32, CellEvidence)>>,
    /// Per cell: what the ground costs a roof, from the sum of weight x (correlation - least
    /// correlation), square metres.
    ground: Vec<f64>,
}

impl PlaneEvidence {
    /// Sums each hypothesis' consistency map over the cells; `ground` are the maps of the ground
    /// plane at a few heights, over `grid`.
    pub(super) fn collect(
        input: &GroupingInput,
        hypotheses: &[PlaneHypothesis],
        arrangement: &Arrangement,
        grid: &PlanGrid,
        ground: Option<&ConsistencyMap>,
        windows: &ShiftableWindows,
        params: &RoofParams,
    ) -> Self {
        let raster = arrangement.raster(grid);
        let mut ground = match ground {
            Some(map) => ground_evidence(map, windows, &raster, arrangement.cells),
            None => vec![0.0; arrangement.cells],
        };
        for (cell, metres) in half_planes_over_cells(input, hypotheses, &raster, grid) {
            ground[cell] -= params.half_plane_gain_m * metres;
        }
        let per_group = crate::execution::map_part(hypotheses, 0.7..0.75, |_, h| {
            sum_over_cells(h, windows, &raster, grid)
        });
        let samples = samples_of_cells(&raster, arrangement.cells);
        let sample_m2 = grid.step * grid.step;
        let mut cells = vec![Vec::new(); arrangement.cells];
        for (i, group_cells) in per_group.into_iter().enumerate() {
            for (cell, e) in group_cells {
                // Most of the cell must lie in the plane's region and be seen. Samples are counted,
                // not areas: a splinter has few, and its area says little about how many.
                let whole = f64::from(samples[cell]) * sample_m2;
                if !arrangement.open[cell] && e.area >= 0.7 * whole {
                    cells[cell].push((i as u32, e));
                }
            }
        }
        let unsampled = |cell: usize| samples[cell] == 0 && !arrangement.open[cell];
        cover_unsampled_cells(&mut cells, arrangement, unsampled);
        Self { cells, ground }
    }

    /// The evidence for a plane in a cell; `None` where the plane may not cover it.
    pub(super) fn get(&self, cell: usize, plane: u32) -> Option<&CellEvidence> {
        self.cells[cell]
            .binary_search_by_key(&plane, |e| e.0)
            .ok()
            .map(|i| &self.cells[cell][i].1)
    }

    /// The energy that labelling minimises.
    pub(super) fn energy(
        &self,
        arrangement: &Arrangement,
        planes: &[Plane],
        index: &LineIndex,
        params: &RoofParams,
    ) -> Energy<BorderCosts> {
        let unary = self
            .cells
            .iter()
            .zip(&self.ground)
            .map(|(candidates, ground)| {
                let best = (candidates.iter()).filter_map(|(_, e)| e.mean_correlation());
                let best = best.fold(-1.0, larger);
                (candidates.iter())
                    .map(|(plane, e)| {
                        let mismatch =
                            -e.gain + e.behind(best) - SINGLE_VIEW_WEIGHT * e.single_view;
                        // "No plane" keeps the cost 0, so evidence for the ground counts against
                        // roofs.
                        (*plane, mismatch + ground)
                    })
                    .collect()
            })
            .collect();
        Energy {
            unary,
            edges: (arrangement.edges.iter())
                .map(|e| [e.left, e.right])
                .collect(),
            borders: BorderCosts::new(arrangement, planes, index, params),
        }
    }
}

/// Number of samples of the plan grid in each cell.
fn samples_of_cells(raster: &[u32], cells: usize) -> Vec<u32> {
    let mut samples = vec![0; cells];
    for &cell in raster.iter().filter(|c| **c != u32::MAX) {
        samples[cell as usize] += 1;
    }
    samples
}

/// Slivers between the samples hold no evidence: what may cover a cell beside one may cover it.
fn cover_unsampled_cells(
    cells: &mut [Vec<(u32, CellEvidence)>],
    arrangement: &Arrangement,
    unsampled: impl Fn(usize) -> bool,
) {
    let mut planes: BTreeMap<usize, BTreeSet<u32>> = BTreeMap::new();
    for e in &arrangement.edges {
        for (cell, beside) in [(e.left, e.right), (e.right, e.left)] {
            if unsampled(cell) {
                let around = cells[beside].iter().map(|c| c.0);
                planes.entry(cell).or_default().extend(around);
            }
        }
    }
    for (cell, planes) in planes {
        cells[cell] = (planes.into_iter())
            .map(|plane| (plane, CellEvidence::default()))
            .collect();
    }
}

/// How much of the ground's match counts. Assumption: most of it. Rows of tiles or seams that run
/// along the parallax correlate at any height, so a match with the ground is weaker evidence than a
/// half-plane's.
const GROUND_SHARE: f64 = 0.8;

/// How much of the ground's mismatch counts for roofs. Assumption: a quarter. What is no ground may
/// be a tree.
const NOT_GROUND_SHARE: f64 = 0.25;

/// What the ground explains at least as well as a roof could, per cell.
fn ground_evidence(
    map: &ConsistencyMap,
    windows: &ShiftableWindows,
    raster: &[u32],
    cells: usize,
) -> Vec<f64> {
    let area = map.grid.step * map.grid.step;
    let mut evidence = vec![0.0f64; cells];
    for (k, &cell) in raster.iter().enumerate().filter(|(_, c)| **c != u32::MAX) {
        let at = [k % map.grid.width, k / map.grid.width];
        let observed = windows.evidence_at(map, at);
        evidence[cell as usize] += observed.gain() * area;
    }
    evidence.into_iter().map(against_roofs).collect()
}

/// What the agreement of the views on the ground, summed over a cell, costs every roof there.
fn against_roofs(agreement: f64) -> f64 {
    if agreement > 0.0 {
        GROUND_SHARE * agreement
    } else {
        NOT_GROUND_SHARE * agreement
    }
}

fn sum_over_cells(
    hypothesis: &PlaneHypothesis,
    windows: &ShiftableWindows,
    raster: &[u32],
    grid: &PlanGrid,
) -> BTreeMap<usize, CellEvidence> {
    let (map, region) = (&hypothesis.map, &hypothesis.region);
    let window = &map.grid;
    let (dc, dr) = window.offset_in(grid);
    let area = grid.step * grid.step;
    let mut cells = BTreeMap::<usize, CellEvidence>::new();
    // Positions one after the other mostly lie in one cell.
    const NO_CELL: usize = usize::MAX;
    let store = |cells: &mut BTreeMap<_, _>, (cell, evidence)| {
        if cell != NO_CELL {
            cells.insert(cell, evidence);
        }
    };
    let mut run = (NO_CELL, CellEvidence::default());
    for row in 0..window.height {
        for column in 0..window.width {
            let (c, r) = (column as isize + dc, row as isize + dr);
            if c < 0 || r < 0 || c as usize >= grid.width || r as usize >= grid.height {
                continue;
            }
            let cell = raster[r as usize * grid.width + c as usize];
            let k = row * window.width + column;
            let single_view = hypothesis.single_view.at(k);
            if cell == u32::MAX
                || (map.weight(k) == 0.0 && single_view == 0.0)
                || !region.contains(&window.center(column, row))
            {
                continue;
            }
            let cell = cell as usize;
            if run.0 != cell {
                store(&mut cells, run);
                run = (cell, cells.get(&cell).copied().unwrap_or_default());
            }
            let e = &mut run.1;
            e.single_view += single_view * area;
            let observed = windows.evidence_at(map, [column, row]);
            let weight = observed.weight * area;
            e.area += area;
            e.weight += weight;
            e.correlation += weight * observed.correlation;
            e.gain += observed.gain() * area;
        }
    }
    store(&mut cells, run);
    cells
}

/// Metres of line beside each cell with a half-plane over it, of the group that has most: there is
/// a roof, whichever.
fn half_planes_over_cells(
    input: &GroupingInput,
    hypotheses: &[PlaneHypothesis],
    raster: &[u32],
    grid: &PlanGrid,
) -> BTreeMap<usize, f64> {
    let mut most = BTreeMap::<usize, f64>::new();
    for h in hypotheses {
        for (cell, metres) in half_planes_of(input, &h.group, raster, grid) {
            let m = most.entry(cell).or_default();
            *m = m.max(metres);
        }
    }
    most
}

/// Metres of the group's lines beside each cell, on the side of their half-planes.
fn half_planes_of(
    input: &GroupingInput,
    group: &PlaneGroup,
    raster: &[u32],
    grid: &PlanGrid,
) -> BTreeMap<usize, f64> {
    const STEP: f64 = 0.1;
    /// How far beside the line the cell is looked up, metres: beyond the snapping of vertices.
    const BESIDE: f64 = 0.3;
    let mut metres = BTreeMap::<usize, f64>::new();
    for member in &group.members {
        let half_plane = member.half_plane.map(|h| &input.half_planes[h.index()]);
        let line = &input.lines[member.line.index()].segment;
        let swept = half_plane.filter(|h| h.is_swept());
        let Some(frame) = swept.and_then(|h| ThetaFrame::new(line, h.side)) else {
            continue;
        };
        let count = (line.length() / STEP).ceil().max(1.0);
        for i in 0..count as usize {
            let p = line.at((i as f64 + 0.5) / count).xy() + frame.outward.xy() * BESIDE;
            let at = grid.cell(&p).map(|(c, r)| raster[r * grid.width + c]);
            if let Some(cell) = at.filter(|cell| *cell != u32::MAX) {
                *metres.entry(cell as usize).or_default() += line.length() / count;
            }
        }
    }
    metres
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facets::borders::{Border, BorderKind};
    use crate::ids::{HalfPlaneId, LineId, ViewId};
    use crate::lines3d::{Line3d, Side};
    use crate::planes::single_view::SingleViewEvidence;
    use crate::planes::{HalfPlane, Member, PlanRegion, line_neighbours};
    use crate::testing::line;
    use nalgebra::{Point2, Point3, Vector3};

    /// A square of 10 m, cut by two lines so close to each other that no sample lies between them.
    fn with_splinter() -> (Arrangement, PlanGrid) {
        let line = |(x0, y0), (x1, y1)| Border {
            kind: BorderKind::Real,
            a: Point2::new(x0, y0),
            b: Point2::new(x1, y1),
        };
        let frame = |low: f64, high: f64| {
            let c = [(low, low), (high, low), (high, high), (low, high)];
            (0..4).map(move |i| line(c[i], c[(i + 1) % 4]))
        };
        let cuts = [5.4, 5.6].map(|x| line((x, 0.0), (x, 10.0)));
        let borders: Vec<Border> =
            (frame(-5.0, 15.0).chain(frame(0.0, 10.0)).chain(cuts)).collect();
        let grid = PlanGrid::covering(Point2::new(0.0, 0.0), Point2::new(10.0, 10.0), 0.5);
        (Arrangement::new(&borders), grid)
    }

    const HORIZONTAL: Plane = Plane {
        normal: Vector3::new(0.0, 0.0, 1.0),
        d: -6.0,
    };

    /// A line of 8 m along y = 2 with a half-plane to its left, north of it.
    fn line_with_half_plane() -> ([Line3d; 1], [HalfPlane; 1], PlaneGroup) {
        let half_plane = HalfPlane {
            line: LineId(0),
            side: Side::Left,
            theta: 0.0,
            sigma_theta: 0.01,
            similarity: 0.9,
            curvature: 9.0,
            amplitude: 0.5,
            probability: 1.0,
            views: vec![ViewId(0)],
            plane: HORIZONTAL,
        };
        let group = PlaneGroup {
            plane: HORIZONTAL,
            members: vec![Member {
                line: LineId(0),
                side: Some(Side::Left),
                half_plane: Some(HalfPlaneId(0)),
            }],
            rectangles: Vec::new(),
        };
        let eave = line(Point3::new(1.0, 2.0, 6.0), Point3::new(9.0, 2.0, 6.0));
        ([eave], [half_plane], group)
    }

    #[test]
    fn a_half_plane_counts_beside_its_line() {
        let (lines, half_planes, group) = line_with_half_plane();
        let input = GroupingInput {
            lines: &lines,
            half_planes: &half_planes,
            neighbours: &line_neighbours(&lines),
            rectangles: &[],
        };
        let grid = PlanGrid::covering(Point2::new(0.0, 0.0), Point2::new(10.0, 10.0), 0.5);
        // Cell 0 lies south of the line, cell 1 north of it: to the left.
        let cells = grid.width * grid.height;
        let raster: Vec<u32> = (0..cells).map(|k| u32::from(5 * k >= cells)).collect();
        let metres = half_planes_of(&input, &group, &raster, &grid);
        assert_eq!(metres.keys().collect::<Vec<_>>(), [&1]);
        assert!((metres[&1] - 8.0).abs() < 1e-9);
        let mut propagated = half_planes.clone();
        propagated[0].views.clear();
        let input = GroupingInput {
            half_planes: &propagated,
            ..input
        };
        assert!(half_planes_of(&input, &group, &raster, &grid).is_empty());
    }

    /// What the planes of a group with a half-plane and of one without cost over all cells, with a
    /// `gain` for the half-plane, correlation and weight of the maps, and the single-view evidence
    /// everywhere.
    fn costs(gain: f64, correlation: i8, weight: u8, single_view: i8) -> [f64; 2] {
        let (lines, half_planes, group) = line_with_half_plane();
        let input = GroupingInput {
            lines: &lines,
            half_planes: &half_planes,
            neighbours: &line_neighbours(&lines),
            rectangles: &[],
        };
        let (arrangement, grid) = with_splinter();
        let other = PlaneGroup {
            members: vec![Member {
                half_plane: None,
                ..group.members[0]
            }],
            ..group.clone()
        };
        let params = RoofParams {
            half_plane_gain_m: gain,
            ..RoofParams::default()
        };
        let cells = grid.width * grid.height;
        let hypotheses = [&group, &other].map(|g| PlaneHypothesis {
            group: g.clone(),
            region: PlanRegion::new(&input, g, &params),
            map: ConsistencyMap {
                grid,
                correlation: vec![correlation; cells],
                overall: vec![correlation; cells],
                weight: vec![weight; cells],
                common_weight: vec![weight; cells],
            },
            single_view: SingleViewEvidence::everywhere(cells, single_view),
            lines: Vec::new(),
        });
        let windows = ShiftableWindows::new([], &grid);
        let evidence = PlaneEvidence::collect(
            &input,
            &hypotheses,
            &arrangement,
            &grid,
            None,
            &windows,
            &params,
        );
        let index = LineIndex::new(Vec::new());
        let energy = evidence.energy(&arrangement, &[HORIZONTAL; 2], &index, &params);
        [0, 1].map(|plane| {
            let of_plane = energy.unary.iter().flatten().filter(|(p, _)| *p == plane);
            of_plane.map(|(_, cost)| cost).sum()
        })
    }

    #[test]
    fn a_half_plane_makes_every_roof_beside_its_line_cheaper() {
        let [without, with] = [0.0, 0.5].map(|gain| costs(gain, 80, 200, 0));
        // Both planes, the one whose half-plane it is and the other one, by the same.
        let earned = [0, 1].map(|plane| without[plane] - with[plane]);
        assert!(earned[0] > 0.0, "{earned:?}");
        assert!((earned[0] - earned[1]).abs() < 1e-9, "{earned:?}");
    }

    #[test]
    fn single_view_evidence_counts_where_nothing_else_does() {
        let [nothing, alike, unlike] = [0, 127, -127].map(|value| costs(0.0, 0, 0, value)[0]);
        assert_eq!(nothing, 0.0, "nobody sees it");
        assert!(alike < -1.0 && (alike + unlike).abs() < 1e-9);
    }

    #[test]
    fn planes_of_weak_texture_are_told_apart_though_little_tells_them_from_none() {
        let cell = |weight: f64, correlation: f64| CellEvidence {
            area: 10.0,
            weight: 10.0 * weight,
            correlation: 10.0 * weight * correlation,
            gain: 0.0,
            single_view: 0.0,
        };
        let (weak, strong) = (cell(0.1, 0.3), cell(0.9, 0.3));
        assert!((weak.behind(0.4) - 0.1 * (5.0 - 1.0)).abs() < 1e-12);
        assert_eq!(strong.behind(0.4), 0.0, "its own weight is enough");
        assert!(weak.behind(0.3).abs() < 1e-12, "the best of all");
        assert_eq!(CellEvidence::default().behind(0.4), 0.0);
    }

    #[test]
    fn ground_costs_a_roof_and_what_is_no_ground_earns_it_less() {
        let (agreeing, contrary) = (against_roofs(2.0), against_roofs(-2.0));
        assert!(agreeing > 0.0 && contrary < 0.0);
        assert!(-contrary < 0.5 * agreeing, "a tree is no roof");
    }

    #[test]
    fn a_splinter_may_be_covered_by_what_covers_the_cells_beside_it() {
        let (arrangement, grid) = with_splinter();
        let samples = samples_of_cells(&arrangement.raster(&grid), arrangement.cells);
        let cell = |x: f64| {
            let fine = PlanGrid::covering(Point2::new(0.0, 0.0), Point2::new(10.0, 10.0), 0.05);
            let (c, r) = fine.cell(&Point2::new(x, 5.0)).unwrap();
            arrangement.raster(&fine)[r * fine.width + c] as usize
        };
        let [left, splinter, right] = [2.0, 5.5, 8.0].map(cell);
        assert_eq!(samples[splinter], 0);
        assert!(samples[left] > 100 && samples[right] > 50);

        let seen = CellEvidence {
            area: 1.0,
            weight: 1.0,
            ..CellEvidence::default()
        };
        let mut cells = vec![Vec::new(); arrangement.cells];
        cells[left] = vec![(3, seen), (7, seen)];
        cells[right] = vec![(4, seen)];
        cover_unsampled_cells(&mut cells, &arrangement, |c| samples[c] == 0);
        let planes: Vec<u32> = cells[splinter].iter().map(|c| c.0).collect();
        assert_eq!(planes, [3, 4, 7]);
        assert!(cells[splinter].iter().all(|c| c.1.weight == 0.0));
        assert_eq!((cells[left].len(), cells[right].len()), (2, 1));
    }
}
