//! The facets' outlines as one partition of the plan: shared vertices, shared edges, no overlap.
//!
//! 1. Where two facets overlap in plan, the lower one loses the overlap (seen from above it is
//!    hidden).
//! 2. Plan positions closer than [`WELD_M`] become one vertex.
//! 3. Vertices that lie on another facet's edge are put into that edge (T-junctions).
//! 4. A building that touches itself in a corner is parted there.
//! 5. Where two roofs cross in height along a shared edge, the crossing becomes a vertex.
//!
//! What still contradicts (an edge taken twice, edges that cross) is taken out and reported.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Point2, Vector2};

use super::rejection::SolidRejection;
use super::rings::{PlanRegion, area, regions_from_edges, ring_edges};
use crate::base::geometry::{Plane, Polygon};
use crate::base::plan_index::PlanIndex;
use crate::roofs::model::{Facet, WELD_M};

/// Parts of facets below this plan area are dropped, m^2. Assumption: a sliver of 10 cm x 10 cm is
/// smaller than a pixel of any survey and only makes walls that are not visible.
const MIN_AREA_M2: f64 = 0.01;

/// Steepest facet, metres of height per metre of plan (84 degrees): steeper ones have no useful
/// plan.
const MAX_GRADIENT: f64 = 10.0;

/// A facet in the partition.
#[derive(Clone, Debug)]
pub(super) struct PlanFacet {
    /// Which input facet it is (a part of).
    pub source: usize,
    /// Its plane.
    pub plane: Plane,
    /// Outer ring counter-clockwise, holes clockwise; indices of plan vertices.
    pub region: PlanRegion,
}

impl PlanFacet {
    /// One facet for every region, otherwise like this one.
    pub(super) fn with_regions(&self, regions: Vec<PlanRegion>) -> impl Iterator<Item = Self> + '_ {
        regions.into_iter().map(|region| Self {
            region,
            ..self.clone()
        })
    }
}

/// A partition of the plan into facets.
#[derive(Clone, Debug, Default)]
pub(super) struct PlanPartition {
    /// Plan vertices, metres; no two closer than [`WELD_M`].
    pub positions: Vec<Point2<f64>>,
    /// The facets, in the order of the input.
    pub facets: Vec<PlanFacet>,
}

impl PlanPartition {
    /// Builds the partition; also gives the facets that had to go, with the reason.
    pub(super) fn new(facets: &[Facet]) -> (Self, Vec<(usize, SolidRejection)>) {
        /// Welding moves edges by up to [`WELD_M`], so that some cross again; cutting those twice
        /// is enough.
        const CUTTING_ROUNDS: usize = 3;
        let mut rejected = Vec::new();
        let mut parts = flat_parts(facets, &mut rejected);
        let mut welder = Welder::default();
        let mut partition = Self::default();
        for round in 1..=CUTTING_ROUNDS {
            welder = Welder::default();
            partition = Self::welded(&without_overlaps(parts), &mut welder);
            partition.insert_t_junctions();
            if round == CUTTING_ROUNDS || partition.conflicting().is_empty() {
                break;
            }
            parts = partition.parts();
        }
        partition.drop_small(&mut rejected);
        partition.drop_conflicts(&mut rejected);
        partition.part_touching(&mut welder);
        partition.insert_height_crossings(&mut welder);
        let lost = |source: &usize| {
            partition.facets.iter().all(|f| f.source != *source)
                && rejected.iter().all(|r| r.0 != *source)
        };
        let lost: Vec<usize> = (0..facets.len()).filter(lost).collect();
        rejected.extend(
            lost.into_iter()
                .map(|source| (source, SolidRejection::TooSmall)),
        );
        (partition, rejected)
    }

    /// The parts' rings with positions closer than [`WELD_M`] made one.
    fn welded(parts: &[PlanPart], welder: &mut Welder) -> Self {
        let mut partition = Self::default();
        for part in parts {
            let edges: Vec<_> = (part.plan.rings.iter())
                .flat_map(|ring| {
                    let welded: Vec<u32> = ring.iter().map(|p| welder.weld(*p)).collect();
                    ring_edges(&welded)
                        .filter(|(a, b)| a != b)
                        .collect::<Vec<_>>()
                })
                .collect();
            let whole = PlanFacet {
                source: part.source,
                plane: part.plane,
                region: Vec::new(),
            };
            let regions = regions_from_edges(&edges, &welder.positions);
            partition.facets.extend(whole.with_regions(regions));
        }
        partition.positions = welder.positions.clone();
        partition
    }

    /// The facets as rings of positions that do not cross themselves.
    fn parts(&self) -> Vec<PlanPart> {
        let ring = |ring: &Vec<u32>| ring.iter().map(|&v| self.positions[v as usize]).collect();
        let plan = |region: &PlanRegion| Polygon {
            rings: region.iter().map(ring).collect(),
        };
        (self.facets.iter())
            .map(|f| PlanPart {
                source: f.source,
                plane: f.plane,
                plan: plan(&f.region).unfolded(),
            })
            .collect()
    }

    /// For every directed edge the facet on its left.
    pub(super) fn facet_left_of(&self) -> BTreeMap<(u32, u32), usize> {
        let mut left_of = BTreeMap::new();
        for (i, facet) in self.facets.iter().enumerate() {
            let edges = facet.region.iter().flat_map(|r| ring_edges(r));
            // Not collected: that would sort them first, by one more sort.
            left_of.extend(edges.map(|e| (e, i)));
        }
        left_of
    }

    /// Height of a facet at a plan vertex, metres.
    pub(super) fn height(&self, facet: usize, vertex: u32) -> f64 {
        let p = self.positions[vertex as usize];
        self.facets[facet].plane.z_at(p.x, p.y)
    }

    /// Heights at a vertex that differ by no more than this are the same, metres: what moving a
    /// plan position by [`WELD_M`] changes between two of the facets that meet there.
    pub(super) fn height_tolerances(&self) -> Vec<f64> {
        let mut steepest = vec![0.0f64; self.positions.len()];
        for facet in &self.facets {
            let gradient = gradient(&facet.plane);
            for &v in facet.region.iter().flatten() {
                steepest[v as usize] = steepest[v as usize].max(gradient);
            }
        }
        steepest.iter().map(|g| WELD_M * (1.0 + 2.0 * g)).collect()
    }

    /// Of the vertices of some facets, the heights of these there and their indices, from below.
    pub(super) fn heights(
        &self,
        facets: impl Iterator<Item = usize>,
    ) -> BTreeMap<u32, Vec<(f64, usize)>> {
        let mut heights: BTreeMap<u32, Vec<(f64, usize)>> = BTreeMap::new();
        for facet in facets {
            for &v in self.facets[facet].region.iter().flatten() {
                let at_vertex = heights.entry(v).or_default();
                at_vertex.push((self.height(facet, v), facet));
            }
        }
        for at_vertex in heights.values_mut() {
            at_vertex.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
        heights
    }

    /// The facets, their edges led by the vertices at which they are to stop.
    pub(super) fn led_by(&self, mut stops: impl FnMut((u32, u32)) -> Vec<u32>) -> Vec<PlanFacet> {
        let mut facets = Vec::with_capacity(self.facets.len());
        for facet in &self.facets {
            let mut edges = Vec::new();
            for edge in facet.region.iter().flat_map(|ring| ring_edges(ring)) {
                let path = [edge.0].into_iter().chain(stops(edge)).chain([edge.1]);
                let path: Vec<u32> = path.collect();
                edges.extend(path.windows(2).map(|w| (w[0], w[1])));
            }
            facets.extend(facet.with_regions(regions_from_edges(&edges, &self.positions)));
        }
        facets
    }

    /// Puts vertices that lie on an edge into it.
    fn insert_t_junctions(&mut self) {
        // An edge moves by up to WELD_M when a vertex is put in and may meet another one; rarely
        // twice.
        for _ in 0..4 {
            let index = PlanIndex::new(self.positions.iter().map(|&p| [p; 2]));
            let mut changed = false;
            self.facets = self.led_by(|(a, b)| {
                let stops = vertices_on_edge(a, b, &self.positions, &index);
                changed |= !stops.is_empty();
                stops
            });
            if !changed {
                break;
            }
        }
    }

    /// Takes out facets whose area is nearly nothing.
    fn drop_small(&mut self, rejected: &mut Vec<(usize, SolidRejection)>) {
        let positions = &self.positions;
        self.facets.retain(|facet| {
            let keep = region_area(&facet.region, positions) >= MIN_AREA_M2;
            if !keep {
                rejected.push((facet.source, SolidRejection::TooSmall));
            }
            keep
        });
    }

    /// Takes out facets whose edges are taken already or cross those of an earlier facet.
    fn drop_conflicts(&mut self, rejected: &mut Vec<(usize, SolidRejection)>) {
        let conflicting = self.conflicting();
        let mut index = 0;
        self.facets.retain(|facet| {
            let conflict = conflicting.contains(&index);
            index += 1;
            if conflict {
                rejected.push((facet.source, SolidRejection::Conflict));
            }
            !conflict
        });
    }

    /// The facets whose edges are taken already or cross those of an earlier facet that is not one
    /// of them.
    pub(super) fn conflicting(&self) -> BTreeSet<usize> {
        let mut taken = BTreeSet::new();
        let (mut index_of_taken, mut taken_edges) = (PlanIndex::default(), Vec::new());
        let positions = &self.positions;
        let mut conflicting = BTreeSet::new();
        for (index, facet) in self.facets.iter().enumerate() {
            let edges: Vec<_> = facet.region.iter().flat_map(|r| ring_edges(r)).collect();
            let conflict = edges.iter().enumerate().any(|(i, &(a, b))| {
                let ends = [a, b].map(|v| positions[v as usize]);
                taken.contains(&(a, b))
                    || edges[..i]
                        .iter()
                        .any(|&other| other == (a, b) || cross(positions, (a, b), other))
                    || index_of_taken
                        .touching(ends, 0.0)
                        .any(|other| cross(positions, (a, b), taken_edges[other as usize]))
            });
            if conflict {
                conflicting.insert(index);
                continue;
            }
            for (a, b) in edges {
                taken.insert((a, b));
                let ends = [a, b].map(|v| positions[v as usize]);
                index_of_taken.insert(ends, taken_edges.len() as u32);
                taken_edges.push((a, b));
            }
        }
        conflicting
    }

    /// Puts a vertex where the two roofs beside an edge change places in height.
    fn insert_height_crossings(&mut self, welder: &mut Welder) {
        let tolerance = self.height_tolerances();
        let left_of = self.facet_left_of();
        let mut stops: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for (&(a, b), &left) in left_of.iter().filter(|((a, b), _)| a < b) {
            let Some(&right) = left_of.get(&(b, a)) else {
                continue;
            };
            let da = self.height(left, a) - self.height(right, a);
            let db = self.height(left, b) - self.height(right, b);
            if da * db < 0.0 && da.abs() > tolerance[a as usize] && db.abs() > tolerance[b as usize]
            {
                let (p, q) = (self.positions[a as usize], self.positions[b as usize]);
                let stop = welder.weld(p + (q - p) * (da / (da - db)));
                stops.insert((a, b), stop);
                stops.insert((b, a), stop);
            }
        }
        for ring in self.facets.iter_mut().flat_map(|f| f.region.iter_mut()) {
            *ring = ring_edges(ring)
                .flat_map(|e| [Some(e.0), stops.get(&e).copied()])
                .flatten()
                .collect();
        }
        self.positions = welder.positions.clone();
    }
}

/// Rise of a plane, metres of height per metre of plan.
fn gradient(plane: &Plane) -> f64 {
    Vector2::new(plane.normal.x, plane.normal.y).norm() / plane.normal.z
}

/// Plan area of a region, m^2.
fn region_area(region: &PlanRegion, positions: &[Point2<f64>]) -> f64 {
    region.iter().map(|r| area(r, positions)).sum()
}

/// Do two edges cross in their insides?
fn cross(positions: &[Point2<f64>], (a, b): (u32, u32), (c, d): (u32, u32)) -> bool {
    if a == c || a == d || b == c || b == d {
        return false;
    }
    let [p, q, r, s] = [a, b, c, d].map(|i| positions[i as usize]);
    let side = |o: Point2<f64>, u: Point2<f64>, v: Point2<f64>| (u - o).perp(&(v - o));
    side(p, q, r) * side(p, q, s) < 0.0 && side(r, s, p) * side(r, s, q) < 0.0
}

/// Vertices strictly between the ends of an edge and on it within [`WELD_M`], in order.
fn vertices_on_edge(a: u32, b: u32, positions: &[Point2<f64>], index: &PlanIndex) -> Vec<u32> {
    let (p, q) = (positions[a as usize], positions[b as usize]);
    let length = (q - p).norm();
    let direction = (q - p) / length;
    let mut stops: Vec<(f64, u32)> = index
        .touching([p, q], WELD_M)
        .filter(|&v| v != a && v != b)
        .filter_map(|v| {
            let r = positions[v as usize] - p;
            let along = r.dot(&direction);
            let on_edge = along > 0.0 && along < length && r.perp(&direction).abs() < WELD_M;
            on_edge.then_some((along, v))
        })
        .collect();
    stops.sort_by(|s, t| s.0.total_cmp(&t.0).then(s.1.cmp(&t.1)));
    stops.into_iter().map(|(_, v)| v).collect()
}

/// Gives plan positions closer than [`WELD_M`] the same index.
#[derive(Default)]
pub(super) struct Welder {
    pub(super) positions: Vec<Point2<f64>>,
    cells: BTreeMap<(i64, i64), Vec<u32>>,
}

impl Welder {
    pub(super) fn weld(&mut self, p: Point2<f64>) -> u32 {
        let (column, row) = ((p.x / WELD_M).floor() as i64, (p.y / WELD_M).floor() as i64);
        let nearest = (-1..=1)
            .flat_map(|dy| (-1..=1).map(move |dx| (column + dx, row + dy)))
            .filter_map(|cell| self.cells.get(&cell))
            .flatten()
            .map(|&i| ((self.positions[i as usize] - p).norm(), i))
            .filter(|(distance, _)| *distance < WELD_M)
            .min_by(|s, t| s.0.total_cmp(&t.0).then(s.1.cmp(&t.1)));
        if let Some((_, i)) = nearest {
            return i;
        }
        let i = u32::try_from(self.positions.len()).expect("fewer than 2^32 corners");
        self.positions.push(p);
        self.cells.entry((column, row)).or_default().push(i);
        i
    }
}

/// A facet, or what is left of it.
struct PlanPart {
    source: usize,
    plane: Plane,
    plan: Polygon,
}

/// The facets as rings in plan, without those that have no plan.
fn flat_parts(facets: &[Facet], rejected: &mut Vec<(usize, SolidRejection)>) -> Vec<PlanPart> {
    let mut parts = Vec::new();
    for (source, facet) in facets.iter().enumerate() {
        let plan = facet.plan().oriented();
        let finite = (plan.rings.iter().flatten()).all(|p| p.x.is_finite() && p.y.is_finite());
        let n = facet.plane.normal;
        // NaN compares false, so this also catches planes that are not numbers.
        let upright =
            n.z > 0.0 && gradient(&facet.plane) < MAX_GRADIENT && facet.plane.d.is_finite();
        if facet.outer.len() < 3 || !finite {
            rejected.push((source, SolidRejection::NoOutline));
        } else if !upright {
            rejected.push((source, SolidRejection::TooSteep));
        } else {
            parts.push(PlanPart {
                source,
                plane: facet.plane,
                // An outline that folds over at one corner loses the fold, not the facet.
                plan: plan.unfolded(),
            });
        }
    }
    parts
}

/// Takes every overlap from the lower of the two facets.
fn without_overlaps(mut parts: Vec<PlanPart>) -> Vec<PlanPart> {
    let mut i = 0;
    while i < parts.len() {
        let mut j = 0;
        while j < i {
            if boxes_meet(&parts[i], &parts[j]) {
                let overlap = parts[i].plan.and(&parts[j].plan);
                if !overlap.rings.is_empty() {
                    let loser = if lower_over(&parts[i], &parts[j], &overlap) {
                        i
                    } else {
                        j
                    };
                    let winner = i + j - loser;
                    // All pieces stay in one part: they become separate regions after welding.
                    parts[loser].plan = parts[loser].plan.without(&parts[winner].plan);
                }
            }
            j += 1;
        }
        i += 1;
    }
    parts
}

/// Is `a` below `b` over their overlap? Equal heights: the later facet gives way.
fn lower_over(a: &PlanPart, b: &PlanPart, overlap: &Polygon) -> bool {
    let corners = overlap.rings.iter().flatten();
    corners
        .map(|p| a.plane.z_at(p.x, p.y) - b.plane.z_at(p.x, p.y))
        .sum::<f64>()
        <= 0.0
}

/// Do the bounding boxes of two parts overlap?
fn boxes_meet(a: &PlanPart, b: &PlanPart) -> bool {
    let [[la, ha], [lb, hb]] = [a, b].map(|part| part.plan.bounds());
    la.x < hb.x && lb.x < ha.x && la.y < hb.y && lb.y < ha.y
}
