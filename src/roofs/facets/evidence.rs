//! Evidence of images and lines for each plane over each cell: the data term of the labelling
//! energy.

use std::collections::{BTreeMap, BTreeSet};

use super::borders::{Arrangement, BorderCosts, LineIndex};
use super::point_cloud::{CloudEvidence, OfPlane};
use super::register::RegisterEvidence;
use crate::base::geometry::Plane;
use crate::base::labelling::Energy;
use crate::base::math::larger;
use crate::base::params::RoofParams;
use crate::planes::hypotheses::PlaneHypothesis;
use crate::planes::photoconsistency::{ConsistencyMap, PlanGrid, ShiftableWindows};

/// Photo-consistency of one plane in one cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CellEvidence {
    /// Plan area seen with the plane's region over it, square metres.
    pub area: f64,
    /// Sum of texture weight over the area.
    pub weight: f64,
    /// Sum of weight x correlation over the area.
    pub correlation: f64,
    /// What the plane costs in the cell, nats, where nothing speaks for the ground.
    pub cost: f64,
}

/// What speaks for one plane in one cell, summed over the area, nats.
#[derive(Clone, Copy, Debug, Default)]
struct CellSums {
    /// What the windows say of the plane: windows a metre apart are independent.
    windows: f64,
    /// The single-view evidence: at most one a square metre.
    single_view: f64,
    /// What a point cloud says of the plane.
    cloud: f64,
}

/// The evidence for every plane in every cell that it may cover.
#[derive(Clone, Debug)]
pub(super) struct PlaneEvidence {
    /// Per cell: (plane, evidence), ascending by plane.
    cells: Vec<Vec<(u32, CellEvidence)>>,
    /// Per cell: what its windows say of the ground, nats; 0 where they speak against it.
    ground: Vec<f64>,
}

impl PlaneEvidence {
    /// Sums each hypothesis' consistency map over the cells of the arrangement, by the samples that
    /// lie in them: where borders cut a cell of the map, each sample counts for the side that it is
    /// on. `ground` are the maps of the ground plane at a few heights, over `grid`.
    pub(super) fn collect(
        hypotheses: &[PlaneHypothesis],
        arrangement: &Arrangement,
        grid: &PlanGrid,
        ground: Option<&ConsistencyMap>,
        windows: &ShiftableWindows,
        cloud: Option<&CloudEvidence>,
    ) -> Self {
        let grid = &grid.of_samples();
        let raster = arrangement.raster(grid);
        let ground = match ground {
            Some(map) => ground_evidence(map, windows, &raster, arrangement.cells),
            None => vec![0.0; arrangement.cells],
        };
        let samples = samples_of_cells(&raster, arrangement.cells);
        let sample_m2 = grid.step * grid.step;
        let per_group = crate::base::execution::map_part(hypotheses, 0.9..1.0, |_, h| {
            let of_cloud = cloud.map(|cloud| cloud.of(&h.group.plane));
            let places = (raster.as_slice(), arrangement.cells);
            let sums = sum_over_cells(h, windows, places, grid, of_cloud.as_ref());
            // Most of the cell must lie in the plane's region and be seen. Samples are counted,
            // not areas: a splinter has few, and its area says little about how many.
            let covers = |(cell, e): &(u32, CellEvidence)| {
                let cell = *cell as usize;
                let whole = f64::from(samples[cell]) * sample_m2;
                !arrangement.open[cell] && e.area >= 0.7 * whole
            };
            let priced = |(cell, e, nats): (u32, CellEvidence, CellSums)| {
                let cost = -nats.windows - nats.single_view - nats.cloud;
                (cell, CellEvidence { cost, ..e })
            };
            let covered: Box<[_]> = sums.into_iter().map(priced).filter(covers).collect();
            covered
        });
        // There are millions: room for no more than there are.
        let mut counts = vec![0; arrangement.cells];
        for (cell, _) in per_group.iter().flatten() {
            counts[*cell as usize] += 1;
        }
        let mut cells: Vec<Vec<_>> = counts.into_iter().map(Vec::with_capacity).collect();
        for (i, covered) in per_group.into_iter().enumerate() {
            for (cell, e) in covered {
                cells[cell as usize].push((i as u32, e));
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

    /// The planes that may cover a cell, ascending, with the evidence for each.
    pub(super) fn of_cell(&self, cell: usize) -> &[(u32, CellEvidence)] {
        &self.cells[cell]
    }

    /// What a plane costs in a cell, nats, but for what a register says; `None` where the plane may
    /// not cover it.
    pub(super) fn cost(&self, cell: usize, plane: u32) -> Option<f64> {
        self.get(cell, plane).map(|e| self.ground[cell] + e.cost)
    }

    /// What the images say of the ground in each cell, nats.
    pub(super) fn ground(&self) -> &[f64] {
        &self.ground
    }

    /// The energy that labelling minimises.
    pub(super) fn energy(
        &self,
        arrangement: &Arrangement,
        planes: &[Plane],
        index: &LineIndex,
        register: Option<&RegisterEvidence>,
        params: &RoofParams,
    ) -> Energy<BorderCosts> {
        let ends_of_roofs = |a: &_, b: &_| register.map_or(0.0, |r| r.of_border(a, b));
        let registered = match register {
            Some(register) => register.of_cells(self.cells.len()),
            None => vec![0.0; self.cells.len()],
        };
        // "No plane" keeps the cost 0, so evidence for the ground counts against roofs.
        // What a register says for a roof counts for every plane.
        let against = self.ground.iter().zip(&registered).map(|(g, r)| g - r);
        let costs = |(planes, against): (&Vec<(u32, CellEvidence)>, f64)| {
            let cost = |(plane, e): &(u32, CellEvidence)| (*plane, against + e.cost);
            planes.iter().map(cost).collect()
        };
        let unary = self.cells.iter().zip(against).map(costs).collect();
        Energy {
            unary,
            edges: (arrangement.edges.iter())
                .map(|e| [e.left, e.right])
                .collect(),
            borders: BorderCosts::new(arrangement, planes, index, ends_of_roofs, params),
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

/// What the windows of each cell say of the ground, nats, where that is more than nothing: what is
/// no ground need not be a roof.
fn ground_evidence(
    map: &ConsistencyMap,
    windows: &ShiftableWindows,
    raster: &[u32],
    cells: usize,
) -> Vec<f64> {
    let samples = map.grid.of_samples();
    let area = samples.step * samples.step;
    let mut evidence = vec![0.0f64; cells];
    for k in 0..map.grid.width * map.grid.height {
        let at = [k % map.grid.width, k / map.grid.width];
        let observed = windows.evidence_at(map, at).nats_with_prior();
        for [column, row] in map.grid.samples_of(at) {
            let cell = raster[row * samples.width + column];
            if cell != u32::MAX {
                evidence[cell as usize] += observed * area;
            }
        }
    }
    evidence.into_iter().map(|nats| larger(nats, 0.0)).collect()
}

/// Sums over the cells of the arrangement, but for the cost: `raster` says in which of `cells`
/// each sample of `grid` lies.
fn sum_over_cells(
    hypothesis: &PlaneHypothesis,
    windows: &ShiftableWindows,
    (raster, cells): (&[u32], usize),
    grid: &PlanGrid,
    cloud: Option<&OfPlane>,
) -> Vec<(u32, CellEvidence, CellSums)> {
    let (map, region) = (&hypothesis.map, &hypothesis.region);
    let window = &map.grid;
    let samples = window.of_samples();
    let (dc, dr) = samples.offset_in(grid);
    let area = grid.step * grid.step;
    // A cell whose sum is not there yet.
    const NO_PLACE: u32 = u32::MAX;
    // By cell the place of its sum.
    let mut place_of = vec![NO_PLACE; cells];
    let mut sums: Vec<(u32, CellEvidence, CellSums)> = Vec::new();
    let within =
        |at: usize, d: isize, size: usize| at.checked_add_signed(d).filter(|moved| *moved < size);
    for row in 0..window.height {
        let rows = window.samples_of([0, row]).map(|[_, row]| row);
        let of_region = rows.map(|row| region.row(samples.center(0, row).y));
        for column in 0..window.width {
            let k = row * window.width + column;
            let single_view = hypothesis.single_view.at(k);
            if map.weight(k) == 0.0 && single_view == 0.0 && cloud.is_none() {
                continue;
            }
            let observed = windows.evidence_at(map, [column, row]);
            let at = window.samples_of([column, row]);
            for ([column, row], of_region) in at.into_iter().zip(&of_region) {
                let place = samples.center(column, row);
                let in_grid = within(column, dc, grid.width).zip(within(row, dr, grid.height));
                let Some((c, r)) = in_grid.filter(|_| of_region.contains(place.x)) else {
                    continue;
                };
                let cell = raster[r * grid.width + c];
                let of_cloud = cloud.map_or(0.0, |cloud| cloud.nats_at(&place));
                let unseen = map.weight(k) == 0.0 && single_view == 0.0 && of_cloud == 0.0;
                if cell == u32::MAX || unseen {
                    continue;
                }
                let cell = cell as usize;
                if place_of[cell] == NO_PLACE {
                    place_of[cell] = sums.len() as u32;
                    sums.push((cell as u32, CellEvidence::default(), CellSums::default()));
                }
                let (_, e, nats) = &mut sums[place_of[cell] as usize];
                nats.single_view += single_view * area;
                nats.cloud += of_cloud * area;
                let weight = observed.weight * area;
                e.area += area;
                e.weight += weight;
                e.correlation += weight * observed.correlation;
                nats.windows += observed.nats_with_prior() * area;
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planes::grouping::{PlaneGroup, region_beside};
    use crate::planes::hypotheses::single_view::SingleViewEvidence;
    use crate::roofs::facets::borders::{Border, BorderKind};
    use crate::roofs::testing::line;
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

    /// What a plane costs over all cells, with the correlation and weight of its map and the
    /// single-view evidence everywhere, where the ground correlates by so much.
    fn cost(correlation: i8, weight: u8, single_view: i8, ground: Option<i8>) -> f64 {
        let (arrangement, grid) = with_splinter();
        let eave = line(Point3::new(0.0, 0.0, 6.0), Point3::new(10.0, 0.0, 6.0));
        let cells = grid.width * grid.height;
        let map = |correlation: i8| ConsistencyMap {
            grid,
            correlation: vec![correlation; cells],
            weight: vec![weight; cells],
            common_weight: vec![weight; cells],
        };
        let hypothesis = PlaneHypothesis {
            group: PlaneGroup {
                plane: HORIZONTAL,
                members: Vec::new(),
                proposals: Vec::new(),
            },
            region: region_beside(eave, HORIZONTAL),
            map: map(correlation),
            single_view: SingleViewEvidence::everywhere(cells, single_view),
            lines: Vec::new(),
        };
        let ground = ground.map(map);
        let windows = ShiftableWindows::new([], &grid);
        let evidence = PlaneEvidence::collect(
            &[hypothesis],
            &arrangement,
            &grid,
            ground.as_ref(),
            &windows,
            None,
        );
        let index = LineIndex::new(Vec::new());
        let energy = evidence.energy(
            &arrangement,
            &[HORIZONTAL],
            &index,
            None,
            &RoofParams::default(),
        );
        energy.unary.iter().flatten().map(|(_, cost)| cost).sum()
    }

    #[test]
    fn agreement_of_the_views_earns_and_disagreement_costs() {
        let [agree, differ] = [110, -30].map(|correlation| cost(correlation, 250, 0, None));
        assert!(agree < -100.0 && differ > 30.0, "{agree} {differ}");
    }

    #[test]
    fn single_view_evidence_counts_where_nothing_else_does() {
        let [nothing, alike, unlike] = [0, 127, -127].map(|value| cost(0, 0, value, None));
        assert_eq!(nothing, 0.0, "nobody sees it");
        assert!(alike < -1.0 && (alike + unlike).abs() < 1e-9);
    }

    #[test]
    fn ground_costs_a_roof_and_what_is_no_ground_earns_it_nothing() {
        let alone = cost(110, 250, 0, None);
        let [on_ground, beside_ground] = [110, -30].map(|c| cost(110, 250, 0, Some(c)));
        assert!(on_ground.abs() < 1e-6 * alone.abs(), "as good as the roof");
        assert_eq!(beside_ground, alone, "a tree is no roof");
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
