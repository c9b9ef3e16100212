//! Closed solids: facets that touch in plan, walls and ground (B99 figure 24: "the vertical walls
//! are produced by extruding the roof's borders to the ground plane").
//!
//! ```text
//! facets -> partition of the plan -> buildings (facets that share edges) -> shell -> solid
//! ```
//!
//! B99 extrudes single borders; here the facets of a building and its walls make one closed
//! polyhedron, so that a step between two roofs is one wall, and volumes can be taken. Facets that
//! touch in a corner only are separate buildings.

mod manifold;
mod partition;
mod rings;
mod walls;

use serde::Serialize;

use self::manifold::close_shell;
use self::partition::{Partition, PlanFacet};
use self::rings::ring_edges;
use self::walls::{FaceKind, Shell, shell_of};
use crate::ids::BuildingId;
use crate::ids::FacetId;
use crate::model::{Building, Facet, RoofModel, Solid, SolidFace, Surface};
use crate::sorting::{sort_by, sort_by_key};

/// Least height of a wall above the ground, metres. Assumption: a roof that meets the ground means
/// that the ground height is wrong, and a wall of this height still shows the outline.
const MIN_WALL_M: f64 = 0.5;

/// Why a facet, or a part of it, is not in any building.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SolidRejection {
    /// Fewer than three corners, or coordinates that are not numbers.
    NoOutline,
    /// Vertical, nearly vertical or facing down.
    TooSteep,
    /// Next to no area in plan (after overlaps were taken out).
    TooSmall,
    /// Its outline crosses itself or an earlier facet's.
    Conflict,
    /// The faces of its building do not close.
    Open,
}

/// What became of the facets.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
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
        sort_by_key(&mut rejected, |(source, _)| *source);
        Self {
            sources: again.sources.iter().map(|&f| source(f)).collect(),
            rejected,
            ground_lowered: again.ground_lowered,
        }
    }
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
    let (partition, rejected) = Partition::new(facets);
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
    sort_by_key(&mut trace.rejected, |(source, _)| *source);
    (model, trace)
}

/// A facet of which nothing is left and that nobody refused crossed itself: no facet goes without a
/// reason.
fn report_vanished(facets: usize, trace: &mut SolidTrace) {
    for source in 0..facets {
        if !trace.sources.contains(&source) && !trace.rejected.iter().any(|r| r.0 == source) {
            trace.rejected.push((source, SolidRejection::Conflict));
        }
    }
}

/// Groups of facets connected through shared edges, each sorted, ordered by their first facet.
fn connected(partition: &Partition) -> Vec<Vec<usize>> {
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
        sort_by(&mut group, Ord::cmp);
        groups.push(group);
    }
    groups
}

/// The facet with the outline that it has in the partition.
fn outlined(partition: &Partition, index: usize, facet: &Facet) -> Facet {
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
mod tests {
    use super::*;
    use crate::geometry::Plane;
    use crate::model::{Violation, check_invariants};
    use nalgebra::{Point3, Vector3};
    use proptest::prelude::*;

    /// A facet over plan rings on `z = z0 + gx x + gy y`.
    fn facet(rings: &[&[(f64, f64)]], z0: f64, gx: f64, gy: f64) -> Facet {
        let plane =
            Plane::from_point_normal(&Point3::new(0.0, 0.0, z0), &Vector3::new(-gx, -gy, 1.0))
                .unwrap();
        let lift = |ring: &&[(f64, f64)]| ring.iter().map(|&(x, y)| plane.lift(x, y)).collect();
        Facet {
            building: BuildingId(0),
            plane,
            outer: lift(&rings[0]),
            holes: rings[1..].iter().map(lift).collect(),
            similarity: 0.0,
            real_ratio: 0.0,
            lines: Vec::new(),
            half_planes: Vec::new(),
            rectangles: Vec::new(),
        }
    }

    fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64, z0: f64, gx: f64, gy: f64) -> Facet {
        facet(&[&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)]], z0, gx, gy)
    }

    /// Closes the facets over ground 0 and expects a model without violations.
    fn closed(facets: &[Facet]) -> RoofModel {
        let (model, trace) = close_buildings(facets, |_| 0.0);
        assert_eq!(trace.rejected, []);
        assert_eq!(check_invariants(&model), []);
        model
    }

    fn count(solid: &Solid, what: fn(&Surface) -> bool) -> usize {
        solid.faces.iter().filter(|f| what(&f.surface)).count()
    }

    fn walls(solid: &Solid) -> usize {
        count(solid, |s| *s == Surface::Wall)
    }

    #[test]
    fn a_gable_has_the_volume_of_the_formula() {
        // 10 m long, 8 m wide, eaves at 5 m, ridge at 7 m.
        let model = closed(&[
            rectangle(0.0, 0.0, 10.0, 4.0, 5.0, 0.0, 0.5),
            rectangle(0.0, 4.0, 10.0, 8.0, 9.0, 0.0, -0.5),
        ]);
        let solid = &model.buildings[0].solid;
        assert!((solid.volume() - 10.0 * 8.0 * (5.0 + 1.0)).abs() < 1e-9);
        // Two eave walls and two gable ends (pentagons), no corner below the ridge ends.
        assert_eq!(walls(solid), 4);
        assert_eq!(solid.vertices.len(), 10);
    }

    #[test]
    fn a_step_between_two_roofs_is_one_wall_of_one_solid() {
        // The low roof is longer: its edge meets the high one's in a T-junction.
        let model = closed(&[
            rectangle(0.0, 0.0, 5.0, 6.0, 8.0, 0.0, 0.0),
            rectangle(5.0, -2.0, 9.0, 9.0, 4.0, 0.0, 0.0),
        ]);
        assert_eq!(model.buildings.len(), 1);
        let solid = &model.buildings[0].solid;
        assert!((solid.volume() - (5.0 * 6.0 * 8.0 + 4.0 * 11.0 * 4.0)).abs() < 1e-9);
        assert_eq!(walls(solid), 4 + 4 + 1 - 1 + 1);
    }

    #[test]
    fn roofs_that_cross_in_height_get_a_corner_at_the_crossing() {
        let model = closed(&[
            rectangle(0.0, 0.0, 5.0, 8.0, 5.0, 0.0, 0.0),
            rectangle(5.0, 0.0, 9.0, 8.0, 4.0, 0.0, 0.25),
        ]);
        let solid = &model.buildings[0].solid;
        assert!((solid.volume() - (5.0 * 8.0 * 5.0 + 4.0 * 8.0 * 5.0)).abs() < 1e-9);
        let crossing = Point3::new(5.0, 4.0, 5.0);
        assert!(solid.vertices.iter().any(|p| (p - crossing).norm() < 1e-9));
    }

    #[test]
    fn a_courtyard_is_a_hole_in_the_ground() {
        let model = closed(&[facet(
            &[
                &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)],
                &[(3.0, 3.0), (3.0, 7.0), (7.0, 7.0), (7.0, 3.0)],
            ],
            6.0,
            0.1,
            0.0,
        )]);
        let solid = &model.buildings[0].solid;
        assert_eq!(walls(solid), 8);
        let ground = solid
            .faces
            .iter()
            .find(|f| f.surface == Surface::Ground)
            .unwrap();
        assert_eq!(ground.rings.len(), 2);
        assert!((solid.volume() - (100.0 - 16.0) * 6.5).abs() < 1e-9);
    }

    #[test]
    fn facets_that_touch_in_a_corner_are_two_buildings() {
        let model = closed(&[
            rectangle(0.0, 0.0, 4.0, 4.0, 5.0, 0.0, 0.0),
            rectangle(4.0, 4.0, 8.0, 8.0, 5.0, 0.0, 0.0),
        ]);
        assert_eq!(model.buildings.len(), 2);
    }

    #[test]
    fn a_ring_of_roofs_that_meets_itself_in_a_corner_is_a_manifold() {
        // Seven of nine squares around an open middle; the two ends touch in a corner only, and
        // heights high, low, high, low meet in the corner (4, 2).
        let squares = [(0, 0), (1, 0), (2, 0), (0, 1), (0, 2), (1, 2), (2, 1)];
        let facets: Vec<_> = squares
            .iter()
            .enumerate()
            .map(|(i, &(x, y))| {
                let (x, y) = (2.0 * f64::from(x), 2.0 * f64::from(y));
                rectangle(
                    x,
                    y,
                    x + 2.0,
                    y + 2.0,
                    if i % 2 == 0 { 6.0 } else { 4.0 },
                    0.0,
                    0.0,
                )
            })
            .collect();
        let model = closed(&facets);
        assert_eq!(model.buildings.len(), 1);
        let ground = model.buildings[0]
            .solid
            .faces
            .iter()
            .find(|f| f.surface == Surface::Ground);
        assert_eq!(ground.unwrap().rings.len(), 2);
    }

    #[test]
    fn four_roofs_high_and_low_around_a_corner_are_a_manifold() {
        let model = closed(&[
            rectangle(0.0, 0.0, 3.0, 3.0, 8.0, 0.0, 0.0),
            rectangle(3.0, 0.0, 6.0, 3.0, 4.0, 0.0, 0.0),
            rectangle(3.0, 3.0, 6.0, 6.0, 9.0, 0.0, 0.0),
            rectangle(0.0, 3.0, 3.0, 6.0, 5.0, 0.0, 0.0),
        ]);
        assert!((model.buildings[0].solid.volume() - 9.0 * 26.0).abs() < 1e-9);
    }

    #[test]
    fn a_low_roof_around_two_high_ones_that_touch_in_a_corner_is_a_manifold() {
        let model = closed(&[
            rectangle(7.0, 3.0, 11.0, 4.0, 42.0, 0.0, 0.0),
            rectangle(9.0, 1.0, 14.0, 6.0, 30.0, 0.0, 0.0),
            rectangle(11.0, 2.0, 12.0, 3.0, 37.0, 0.0, 0.0),
        ]);
        let volume = 4.0 * 42.0 + 22.0 * 30.0 + 37.0;
        assert!((model.buildings[0].solid.volume() - volume).abs() < 1e-6);
    }

    #[test]
    fn the_higher_of_two_overlapping_facets_stays_whole() {
        let model = closed(&[
            rectangle(0.0, 0.0, 10.0, 10.0, 5.0, 0.0, 0.0),
            rectangle(4.0, 4.0, 6.0, 6.0, 7.0, 0.0, 0.0),
        ]);
        assert_eq!(model.facets[0].holes.len(), 1);
        assert!((model.buildings[0].solid.volume() - (96.0 * 5.0 + 4.0 * 7.0)).abs() < 1e-6);
    }

    #[test]
    fn an_outline_that_folds_over_loses_the_fold_only() {
        // The last corner lies beyond the first side: a triangle of 4 x 4 / 2 and a fold, turned
        // inside out.
        let folded = facet(
            &[&[(30.0, 0.0), (34.0, 0.0), (34.0, 4.0), (33.0, -1.0)]],
            5.0,
            0.0,
            0.0,
        );
        let (model, trace) = close_buildings(&[folded], |_| 0.0);
        assert_eq!(trace.rejected, []);
        assert_eq!(check_invariants(&model), []);
        // Sides (34, 4) - (33, -1) and (30, 0) - (34, 0) cross at x = 33.2.
        assert!((model.buildings[0].solid.volume() - 5.0 * 0.5 * 0.8 * 4.0).abs() < 1e-3);
    }

    #[test]
    fn an_outline_that_runs_along_itself_keeps_its_area() {
        // Around a square and then, along the same first side, around a triangle inside it.
        let (a, b) = ((0.0, 0.0), (4.0, 0.0));
        let twice = facet(
            &[&[a, b, (4.0, 4.0), (0.0, 4.0), a, b, (2.0, 2.0)]],
            5.0,
            0.0,
            0.0,
        );
        let beside = rectangle(4.0, 0.0, 8.0, 4.0, 5.0, 0.0, 0.0);
        let (model, trace) = close_buildings(&[twice, beside], |_| 0.0);
        assert_eq!(trace.rejected, []);
        assert_eq!(check_invariants(&model), []);
        assert!((model.buildings[0].solid.volume() - 5.0 * 32.0).abs() < 1e-6);
    }

    #[test]
    fn hopeless_facets_are_refused_with_a_reason() {
        let mut nan = rectangle(0.0, 0.0, 4.0, 4.0, 5.0, 0.0, 0.0);
        nan.outer[1].x = f64::NAN;
        let steep = rectangle(10.0, 0.0, 14.0, 4.0, 5.0, 50.0, 0.0);
        let sliver = rectangle(20.0, 0.0, 24.0, 1e-4, 5.0, 0.0, 0.0);
        let (model, trace) = close_buildings(&[nan, steep, sliver], |_| 0.0);
        assert!(model.buildings.is_empty() && model.facets.is_empty());
        let reasons: Vec<_> = trace.rejected.iter().map(|r| r.1).collect();
        assert_eq!(
            reasons,
            [
                SolidRejection::NoOutline,
                SolidRejection::TooSteep,
                SolidRejection::TooSmall
            ]
        );
    }

    #[test]
    fn a_ground_above_the_eave_is_lowered_and_reported() {
        let roof = [rectangle(0.0, 0.0, 4.0, 4.0, 5.0, 0.0, 0.0)];
        for wrong in [6.0, f64::NAN] {
            let (model, trace) = close_buildings(&roof, |_| wrong);
            assert_eq!(trace.ground_lowered, [BuildingId(0)]);
            assert_eq!(model.buildings[0].ground_z, 4.5);
            assert_eq!(check_invariants(&model), []);
        }
    }

    #[test]
    fn broken_models_are_noticed() {
        let good = closed(&[
            rectangle(0.0, 0.0, 10.0, 4.0, 5.0, 0.0, 0.5),
            rectangle(0.0, 4.0, 10.0, 8.0, 9.0, 0.0, -0.5),
        ]);
        let broken = |change: fn(&mut RoofModel)| {
            let mut model = good.clone();
            change(&mut model);
            check_invariants(&model)
        };
        use Violation as V;
        let found = broken(|m| drop(m.buildings[0].solid.faces.pop()));
        assert!(found.iter().any(|v| matches!(v, V::SolidNotClosed { .. })));
        let found = broken(|m| {
            for ring in m.buildings[0]
                .solid
                .faces
                .iter_mut()
                .flat_map(|f| &mut f.rings)
            {
                ring.reverse();
            }
        });
        assert!(found.iter().any(|v| matches!(v, V::InsideOut { .. })));
        assert!(found.iter().any(|v| matches!(v, V::FaceDirection { .. })));
        let found = broken(|m| m.buildings[0].solid.vertices[0].z += 0.5);
        assert!(found.iter().any(|v| matches!(v, V::FaceNotPlanar { .. })));
        let found = broken(|m| m.facets[0].outer[0].z += 0.5);
        assert!(found.iter().any(|v| matches!(v, V::FacetNotPlanar { .. })));
        let found = broken(|m| m.facets[0].outer.swap(0, 1));
        assert!(
            found
                .iter()
                .any(|v| matches!(v, V::FacetRingNotSimple { .. }))
        );
        let found = broken(|m| m.facets[0].outer.reverse());
        assert!(
            found
                .iter()
                .any(|v| matches!(v, V::FacetRingOrientation { .. }))
        );
        let found = broken(|m| m.facets[1] = m.facets[0].clone());
        assert!(found.iter().any(|v| matches!(v, V::FacetsOverlap { .. })));
        let found = broken(|m| m.buildings[0].facets.truncate(1));
        assert!(found.iter().any(|v| matches!(v, V::Membership { .. })));
        let found = broken(|m| m.facets[0].plane.normal *= -1.0);
        assert!(found.iter().any(|v| matches!(v, V::FacetPlane { .. })));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

        /// Any patchwork of rectangles of any heights and slopes, overlapping at will, closes.
        #[test]
        fn patchworks_close(
            patches in prop::collection::vec(
                (0..12i32, 0..12i32, 1..6i32, 1..6i32, 30..60i32, -2..3i32, -2..3i32, 0.0..1.0f64),
                1..12,
            ),
        ) {
            let facets: Vec<_> = patches
                .iter()
                .map(|&(x, y, w, h, z, gx, gy, jitter)| {
                    // Some outlines lie on a common grid, some next to it.
                    let x = f64::from(x) + if jitter > 0.7 { jitter } else { 0.0 };
                    let (y, w, h) = (f64::from(y), f64::from(w), f64::from(h));
                    let (gx, gy) = (f64::from(gx) * 0.25, f64::from(gy) * 0.25);
                    rectangle(x, y, x + w, y + h, f64::from(z), gx, gy)
                })
                .collect();
            let (model, trace) = close_buildings(&facets, |_| 0.0);
            prop_assert_eq!(check_invariants(&model), []);
            prop_assert!(trace.rejected.iter().all(|r| r.1 == SolidRejection::TooSmall), "{:?}", trace);
            prop_assert!(!model.buildings.is_empty());
        }
    }
}
