//! Closed solids: facets that touch in plan, walls and ground (B99 figure 24: "the vertical walls
//! are produced by extruding the roof's borders to the ground plane").
//!
//! ```text
//! partition  outlines of all facets -> one partition of the plan
//! touching   buildings that touch themselves in a corner, parted
//! rings      closed rings from the directed edges of a region
//! walls      partition -> faces of a building: roofs, walls, ground
//! sides      straight stretches of the outline, a wall below each
//! footprint  where a building stands whose walls are inside the eaves
//! overhang   the same building with its walls there
//! manifold   faces -> closed oriented 2-manifold
//! soundness  whether a solid is one for other programs too
//! rejection  why a facet is not part of a solid
//! ```
//!
//! Deviation: B99 extrudes single borders; here the facets of a building and its walls make one
//! closed polyhedron, so that a step between two roofs is one wall, and volumes can be taken.
//!
//! Invariant: every solid is closed and oriented, and its facets do not overlap in plan.
//! Invariant: facets that touch in a corner only are separate buildings.
//! Invariant: no facet is dropped without a [`SolidRejection`].

mod footprint;
mod manifold;
mod overhang;
mod partition;
mod rejection;
mod rings;
mod sides;
mod soundness;
mod touching;
mod walls;

pub use overhang::{RIM_M, close_below_overhangs};
pub use rejection::SolidRejection;
pub(crate) use sides::STEP_HEIGHT_M;
pub use sides::{Side, outline_sides};
pub use soundness::WRITTEN_STEP_M;

use serde::Serialize;

use self::manifold::close_shell;
use self::partition::{PlanFacet, PlanPartition};
use self::rings::ring_edges;
use self::walls::{FaceKind, Shell, shell_of};
use crate::base::ids::{BuildingId, FacetId};
use crate::planes::terrain::Ground;
use crate::roofs::model::{Building, Facet, RoofModel, Solid, SolidFace, Surface};

/// Least height of a wall above the ground, metres. Assumption: a roof that meets the ground means
/// that the ground height is wrong, and a wall of this height still shows the outline.
const MIN_WALL_M: f64 = 0.5;

/// What became of the facets.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SolidTrace {
    /// For every facet of the model the input facet that it is (a part of).
    pub sources: Vec<usize>,
    /// Input facets, or parts of them, that are in no building.
    pub rejected: Vec<(usize, SolidRejection)>,
    /// Buildings whose ground was put below the given height, because their roof reaches it.
    pub ground_lowered: Vec<BuildingId>,
}

impl SolidTrace {
    /// The trace of closing facets and of closing again what came of it.
    pub fn then(self, again: SolidTrace) -> Self {
        let source = |facet: usize| self.sources[facet];
        let later = again.rejected.iter().map(|&(f, why)| (source(f), why));
        let mut rejected: Vec<_> = self.rejected.iter().copied().chain(later).collect();
        rejected.sort_by_key(|(source, _)| *source);
        Self {
            sources: again.sources.iter().map(|&f| source(f)).collect(),
            rejected,
            ground_lowered: again.ground_lowered,
        }
    }
}

/// Closes the buildings below facets, down to the ground.
pub(crate) fn close_above(facets: &[Facet], ground: &Ground) -> (RoofModel, SolidTrace) {
    close_buildings(facets, |members| {
        ground.below(members.iter().flat_map(|f| &f.outer))
    })
}

/// Groups facets into buildings and closes them with walls and ground.
///
/// `ground_z` gives the height of the ground (metres, local frame) below the facets of one
/// building; where it is not a number or not below the roof, the ground lies half a metre below the
/// lowest eave. The facets of the result have their `building` set and the outlines of the common
/// partition.
pub fn close_buildings(
    facets: &[Facet],
    ground_z: impl Fn(&[&Facet]) -> f64,
) -> (RoofModel, SolidTrace) {
    let (partition, rejected) = PlanPartition::new(facets);
    let mut trace = SolidTrace {
        rejected,
        ..SolidTrace::default()
    };
    let mut model = RoofModel::default();
    let left_of = partition.facet_left_of();
    let tolerances = partition.height_tolerances();
    for group in connected(&partition) {
        let members: Vec<Facet> = group
            .iter()
            .map(|&f| outlined(&partition, f, &facets[partition.facets[f].source]))
            .collect();
        let given = ground_z(&members.iter().collect::<Vec<_>>());
        let (ground, lowered) = ground_below(&members, given);
        let shell = shell_of(&partition, &group, &left_of, &tolerances, ground);
        let sources = group.iter().map(|&f| partition.facets[f].source);
        let Some(shell) = close_shell(&shell) else {
            trace
                .rejected
                .extend(sources.map(|source| (source, SolidRejection::Open)));
            continue;
        };
        trace.sources.extend(sources);
        if lowered {
            trace
                .ground_lowered
                .push(BuildingId::from_index(model.buildings.len()));
        }
        add_building(&mut model, members, &group, shell, ground);
    }
    report_vanished(facets.len(), &mut trace);
    trace.rejected.sort_by_key(|(source, _)| *source);
    (model, trace)
}

/// A facet of which nothing is left, and that no step rejected, crossed itself.
fn report_vanished(facets: usize, trace: &mut SolidTrace) {
    for source in 0..facets {
        if !trace.sources.contains(&source) && !trace.rejected.iter().any(|r| r.0 == source) {
            trace.rejected.push((source, SolidRejection::Conflict));
        }
    }
}

/// Groups of facets connected through shared edges, each sorted, ordered by their first facet.
fn connected(partition: &PlanPartition) -> Vec<Vec<usize>> {
    let left_of = partition.facet_left_of();
    let mut seen = vec![false; partition.facets.len()];
    let mut groups = Vec::new();
    for first in 0..partition.facets.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let mut group = vec![first];
        let mut next = 0;
        while next < group.len() {
            let region = &partition.facets[group[next]].region;
            for (a, b) in region.iter().flat_map(|ring| ring_edges(ring)) {
                match left_of.get(&(b, a)) {
                    Some(&other) if !seen[other] => {
                        seen[other] = true;
                        group.push(other);
                    }
                    _ => {}
                }
            }
            next += 1;
        }
        group.sort();
        groups.push(group);
    }
    groups
}

/// The facet with the outline that it has in the partition.
fn outlined(partition: &PlanPartition, index: usize, facet: &Facet) -> Facet {
    let PlanFacet { plane, region, .. } = &partition.facets[index];
    let lift = |ring: &Vec<u32>| {
        let corner = |&v: &u32| partition.positions[v as usize];
        ring.iter()
            .map(corner)
            .map(|p| plane.lift(p.x, p.y))
            .collect()
    };
    Facet {
        outer: lift(&region[0]),
        holes: region[1..].iter().map(lift).collect(),
        ..facet.clone()
    }
}

/// The ground below the facets and whether the given height had to be left.
fn ground_below(facets: &[Facet], given: f64) -> (f64, bool) {
    let eave = facets
        .iter()
        .flat_map(|f| f.outer.iter().chain(f.holes.iter().flatten()))
        .fold(f64::INFINITY, |low, p| low.min(p.z));
    let highest = eave - MIN_WALL_M;
    // NaN fails the comparison.
    if given <= highest {
        (given, false)
    } else {
        (highest, true)
    }
}

/// Adds a building with its facets.
fn add_building(
    model: &mut RoofModel,
    members: Vec<Facet>,
    group: &[usize],
    shell: Shell,
    ground_z: f64,
) {
    let building = BuildingId::from_index(model.buildings.len());
    let first = model.facets.len();
    let id = |i: usize| FacetId::from_index(first + i);
    let surface = |kind| match kind {
        FaceKind::Roof(f) => Surface::Roof(id(group
            .binary_search(&f)
            .expect("the facet is in its building"))),
        FaceKind::Wall => Surface::Wall,
        FaceKind::Ceiling => Surface::Ceiling,
        FaceKind::Ground => Surface::Ground,
    };
    let faces = shell
        .faces
        .into_iter()
        .map(|face| SolidFace {
            surface: surface(face.kind),
            rings: face.rings,
        })
        .collect();
    model.buildings.push(Building {
        facets: (0..members.len()).map(id).collect(),
        ground_z,
        solid: Solid {
            vertices: shell.corners,
            faces,
        },
    });
    model
        .facets
        .extend(members.into_iter().map(|facet| Facet { building, ..facet }));
}

#[cfg(test)]
mod tests;
