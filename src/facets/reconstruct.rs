//! From half-planes to facets: the stage that orders B99 4.2 and 4.3.
//!
//! lines and half-planes -> groups -> regions, border lines -> plan cells -> consistency of every
//! plane over its region -> labelling -> outlines -> verification. A facet that fails verification
//! is rejected and the labelling continues without it, as the paper updates the neighbours of a
//! plane that is removed.

use std::collections::BTreeMap;

use nalgebra::Point2;
use serde::Serialize;

use super::borders::{Arrangement, Border, BorderKind, LineIndex, border_lines, bounding_lines};
use super::competing_planes::CompetingPlanes;
use super::delineation::{Outline, delineate};
use super::dominated::without_dominated;
use super::evidence::PlaneEvidence;
use super::input::FacetInput;
use super::islands::without_islands;
use super::point_cloud::CloudEvidence;
use super::register::{RegisterEvidence, RegisterTrace};
use super::verification::{
    FacetRejection, KnownEvidence, Measured, RejectedFacet, tail_on_ground, verify,
};
use crate::evidence::JudgedFacet;
use crate::execution::{Sharded, sharded_map};
use crate::geometry::{Plane, bounds};
use crate::labelling::Labelling;
use crate::lines3d::Line3d;
use crate::model::{Facet, Occluders};
use crate::params::RoofParams;
use crate::photoconsistency::{
    ConsistencyMap, PlanGrid, ShiftableWindows, consistency_map_of_surface,
};
use crate::planes::{
    GroupingInput, Member, PlanRegion, PlaneGroup, PlaneLine, add_proposals, group_planes,
    group_propagated, is_wall, line_neighbours, plane_hypotheses, with_propagated,
};
use crate::scene::Scene;
use crate::terrain::Ground;

/// What grouping, delineation and verification did.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FacetTrace {
    /// Groups of coplanar lines and half-planes.
    pub groups: Vec<PlaneGroup>,
    /// Lines found in the groups' planes.
    pub plane_lines: Vec<PlaneLine>,
    /// Border lines in plan.
    pub borders: Vec<Border>,
    /// Number of cells that the border lines cut the plan into.
    pub cells: usize,
    /// Every facet that was weighed, with what speaks for it and against it: the accepted ones in
    /// their order before refinement, then those that were rejected as improbable.
    pub judged: Vec<JudgedFacet>,
    /// Rejected facets.
    pub rejected: Vec<RejectedFacet>,
    /// A register that is known, compared with the model.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(target_arch = "wasm32", tsify(optional))]
    pub register: Option<RegisterTrace>,
}

/// Facets from 3D lines and half-planes (B99 4.2, 4.3). Their `building` is still unset (0): facets
/// that touch become buildings when walls are added.
pub fn reconstruct_facets(
    scene: &Scene,
    evidence: &FacetInput,
    params: &RoofParams,
) -> Sharded<(Vec<Facet>, FacetTrace)> {
    let FacetInput {
        segments,
        lines,
        half_planes,
        ground,
        proposals,
        cloud,
        line_pairs,
    } = *evidence;
    let neighbours = line_neighbours(lines);
    let input = GroupingInput {
        lines,
        half_planes,
        neighbours: &neighbours,
        proposals,
    };
    let mut groups: Vec<PlaneGroup> = match line_pairs {
        true => group_planes(&input, params),
        false => Vec::new(),
    };
    groups.retain(|g| !is_wall(&g.plane) && !lies_on_ground(&input, g, ground, params));
    let half_planes = with_propagated(&input, &groups, ground, params);
    let input = GroupingInput {
        half_planes: &half_planes,
        ..input
    };
    groups.extend(group_propagated(&input, params));
    add_proposals(&input, &mut groups, params);
    let regions: Vec<PlanRegion> = groups
        .iter()
        .map(|g| PlanRegion::new(&input, g, params))
        .collect();
    let Some(grid) = plan_window(scene, lines, &regions) else {
        let trace = FacetTrace {
            groups,
            ..FacetTrace::default()
        };
        return Ok((Vec::new(), trace));
    };
    let fine = scene
        .views
        .iter()
        .map(|v| v.camera.ground_pixel(&lines[0].at(0.5)))
        .fold(f64::INFINITY, f64::min);
    let reduced = scene.reduced(((grid.of_samples().step / fine) as usize).max(1));
    // Both compare the views on planes, independently of each other: one map.
    let ground_map = ground_map(&reduced, ground, &grid);
    let hypotheses = plane_hypotheses(scene, &reduced, segments, &input, groups, grid.step, params);
    let (ground_map, hypotheses) = (ground_map?, hypotheses?);
    let windows = ShiftableWindows::new(lines.iter().map(|l| l.segment), &grid);
    let cloud = cloud.map(|cloud| CloudEvidence::new(cloud, ground, &grid));
    let cloud = cloud.as_ref();
    let hypotheses = without_dominated(hypotheses, ground_map.as_ref(), &windows, &grid, cloud);
    let bounding = bounding_lines(&input, &hypotheses, ground, params);
    let borders = border_lines(&input, &hypotheses, &bounding, &windows, cloud, params);
    let arrangement = Arrangement::new(&with_frame(&borders, &grid));

    let evidence = PlaneEvidence::collect(
        &hypotheses,
        &arrangement,
        &grid,
        ground_map.as_ref(),
        &windows,
        cloud,
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
    let energy = evidence.energy(&arrangement, &planes, &index, None, params);
    let mut labelling = Labelling::new(energy, planes.len() as u32);
    let competing = CompetingPlanes {
        evidence,
        arrangement,
        planes,
        index,
        maps,
        scene: reduced,
    };
    let known = KnownEvidence {
        colours: scene,
        register: None,
        cloud,
    };
    let mut verified = solve(&mut labelling, &competing, &groups, ground, &known, params);
    let register = scene.known.footprints.as_ref().map(|register| {
        let CompetingPlanes {
            evidence,
            arrangement,
            planes,
            index,
            ..
        } = &competing;
        let mut register = RegisterEvidence::new(register, &params.register, arrangement, &grid);
        // What the images show by themselves tells what the register is worth.
        register.compare(&verified.facets);
        if register.counts() {
            let energy = evidence.energy(arrangement, planes, index, Some(&register), params);
            labelling = Labelling::new(energy, planes.len() as u32);
            let known = KnownEvidence {
                register: Some(&register),
                ..known
            };
            verified = solve(&mut labelling, &competing, &groups, ground, &known, params);
        }
        register.findings(&verified.facets, evidence.ground(), &arrangement.areas)
    });
    let cells = competing.arrangement.cells;
    let trace = FacetTrace {
        groups,
        plane_lines,
        borders,
        cells,
        judged: verified.judged,
        rejected: verified.rejected,
        register,
    };
    Ok((verified.facets, trace))
}

/// Are all lines of the group lower than any eave?
fn lies_on_ground(
    input: &GroupingInput,
    group: &PlaneGroup,
    ground: &Ground,
    params: &RoofParams,
) -> bool {
    let mut members = group.members.iter();
    let line = |m: &Member| &input.lines[m.line.index()].segment;
    members.all(|m| ground.is_near(line(m), params.min_height_m))
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
    let step = PlanGrid::cell_of_pixels(crate::math::median(&mut steps)?);
    let [min, max] = bounds(regions.iter().flat_map(PlanRegion::bounds));
    let size = max - min;
    // Coarser cells for a very large window: at most 9 million.
    let step = step.max(FINEST_CELL).max((size.x * size.y / 9e6).sqrt());
    (size.x > 0.0 && size.y > 0.0 && step.is_finite()).then(|| PlanGrid::covering(min, max, step))
}

/// Similarity of the views on the ground. Its height is only known to a few decimetres: at every
/// position the views may agree at the height that it has there or a step beside it.
fn ground_map(scene: &Scene, ground: &Ground, grid: &PlanGrid) -> Sharded<Option<ConsistencyMap>> {
    const STEP: f64 = 0.3;
    let plane = ground.plane();
    let maps = sharded_map("planes", &[-STEP, 0.0, STEP], 0.1..0.2, |_, step| {
        consistency_map_of_surface(scene, &plane, &|p| ground.z_at(p) + step, grid)
    })?;
    Ok(ConsistencyMap::best_of(&maps))
}

/// Finest cell, metres. Assumption: samples 6 cm apart are what a roof's border lines can be told
/// apart by; sharper images are reduced.
const FINEST_CELL: f64 = 0.12;

/// The borders and a frame around the window, so that every cell that matters is closed.
fn with_frame(borders: &[Border], grid: &PlanGrid) -> Vec<Border> {
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
    let frame = (0..4).map(|i| Border {
        kind: BorderKind::Closing,
        a: corner[i],
        b: corner[(i + 1) % 4],
    });
    borders.iter().copied().chain(frame).collect()
}

/// The facets that stand, all that were weighed, and those that were rejected.
struct Verified {
    facets: Vec<Facet>,
    judged: Vec<JudgedFacet>,
    rejected: Vec<RejectedFacet>,
}

/// Labels, delineates and verifies until no facet is rejected.
fn solve(
    labelling: &mut Labelling,
    competing: &CompetingPlanes,
    groups: &[PlaneGroup],
    ground: &Ground,
    known: &KnownEvidence,
    params: &RoofParams,
) -> Verified {
    const ROUNDS: usize = 4;
    let (mut rejected, mut improbable) = (Vec::new(), Vec::new());
    // By plane and cells.
    let mut measured: BTreeMap<(u32, Vec<usize>), Measured> = BTreeMap::new();
    for round in 1..=ROUNDS {
        labelling.minimise();
        let labels = labelling.labels();
        let labels = without_islands(&competing.arrangement, labels, params.min_area_m2);
        let delineation = delineate(&competing.arrangement, &labels, &competing.planes);
        labelling.relabel(labels);
        let (mut facets, mut accepted) = (Vec::new(), Vec::new());
        let mut stands = vec![false; delineation.outlines.len()];
        let mut excluded: Vec<(u32, Vec<usize>)> = Vec::new();
        // On the ground no other plane may take their place: they stay in the labelling.
        let mut on_ground = Vec::new();
        let found: Vec<Facet> = (delineation.outlines.iter())
            .map(|outline| competing.facet(outline, &delineation, groups))
            .collect();
        let occluders = Occluders::new(&found);
        let results = crate::execution::map(&delineation.outlines, |i, outline| {
            let before = measured.get(&(outline.plane, outline.cells.clone()));
            let facet = (&found[i], outline);
            verify(competing, facet, &occluders, ground, known, before, params)
        });
        for (i, ((outline, facet), result)) in
            (delineation.outlines.iter().zip(found).zip(results)).enumerate()
        {
            let reason = match result {
                Ok(verified) => {
                    let windows = verified.windows().clone();
                    let evidence = verified.evidence;
                    let key = (outline.plane, outline.cells.clone());
                    measured.insert(key, verified.measured);
                    let probability = evidence.probability();
                    let judged = JudgedFacet {
                        outline: facet.outer.clone(),
                        holes: facet.holes.clone(),
                        plane: facet.plane,
                        accepted: evidence.accepts(params.least_nats),
                        evidence: evidence.clone(),
                        windows,
                    };
                    if judged.accepted {
                        facets.push(Facet {
                            probability,
                            ..facet
                        });
                        accepted.push(judged);
                        stands[i] = true;
                        continue;
                    }
                    improbable.push(judged);
                    FacetRejection::Improbable { evidence }
                }
                Err(reason) => reason,
            };
            if round < ROUNDS
                && matches!(reason, FacetRejection::ReachesGround { .. })
                && let Some(tail) = tail_on_ground(
                    &facet.plane,
                    &outline.cells,
                    &competing.arrangement,
                    ground,
                    params.min_height_m,
                )
            {
                excluded.push((outline.plane, tail));
                continue;
            }
            let near_ground = matches!(reason, FacetRejection::NearGround { .. });
            let rejection = RejectedFacet {
                group: outline.plane,
                outline: facet.outer,
                reason,
            };
            if near_ground {
                on_ground.push(rejection);
            } else {
                rejected.push(rejection);
                excluded.push((outline.plane, outline.cells.clone()));
            }
        }
        if excluded.is_empty() || round == ROUNDS {
            rejected.extend(on_ground);
            accepted.extend(improbable);
            let simpler = competing.simplify(delineation, &stands, params);
            let outlines = simpler
                .outlines
                .iter()
                .zip(stands)
                .filter(|(_, stands)| *stands);
            let simple = |(facet, (outline, _)): (Facet, (&Outline, bool))| Facet {
                probability: facet.probability,
                ..competing.facet(outline, &simpler, groups)
            };
            return Verified {
                facets: facets.into_iter().zip(outlines).map(simple).collect(),
                judged: accepted,
                rejected,
            };
        }
        for (plane, cells) in excluded {
            labelling.exclude(plane, &cells);
        }
    }
    unreachable!("the last round returns")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::ProposalOrigin;
    use crate::planes::ProposedPlane;
    use crate::planes::rendered_planes::{TexturedPlane, scene};
    use crate::testing::line;
    use nalgebra::{Point3, Vector3};

    const ROOF_Z: f64 = 5.0;

    fn level(z: f64) -> Plane {
        Plane {
            normal: Vector3::z(),
            d: -z,
        }
    }

    /// A rectangle of 8 m by 6 m around the origin, at a height.
    fn rectangle(index: u32, z: f64) -> ProposedPlane {
        let corners = [(-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)];
        ProposedPlane {
            origin: ProposalOrigin::Rectangle(index),
            plane: level(z),
            ring: corners.map(|(x, y)| Point3::new(x, y, z)).to_vec(),
        }
    }

    /// The facets of a flat roof of which one eave was matched, without a half-plane, with planes
    /// that are proposed for it.
    fn facets(proposals: &[ProposedPlane]) -> Vec<Facet> {
        let on_roof = |x: f64, y: f64| x.abs() < 4.0 && y.abs() < 3.0;
        let textured = |plane, exists| TexturedPlane {
            plane,
            exists,
            texture: 0.3,
        };
        let scene = scene(&[
            textured(level(ROOF_Z), on_roof),
            textured(level(0.0), |_, _| true),
        ]);
        let eave = line(
            Point3::new(-4.0, -3.0, ROOF_Z),
            Point3::new(4.0, -3.0, ROOF_Z),
        );
        let evidence = FacetInput {
            segments: &[],
            lines: &[eave],
            half_planes: &[],
            ground: &Ground::level(0.0),
            proposals,
            cloud: None,
            line_pairs: true,
        };
        reconstruct_facets(&scene, &evidence, &RoofParams::default())
            .unwrap()
            .0
    }

    #[test]
    fn a_rectangle_is_a_facet_where_half_planes_are_absent() {
        assert!(facets(&[]).is_empty());
        // The wrong ones come first, and lose.
        let proposed = [rectangle(7, 7.5), rectangle(8, 2.5), rectangle(9, ROOF_Z)];
        let found = facets(&proposed);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].proposals, [ProposalOrigin::Rectangle(9)]);
        assert!((found[0].plane.z_at(0.0, 0.0) - ROOF_Z).abs() < 0.05);
        let covered = |p: &Point3<f64>| p.x.abs() < 4.5 && p.y.abs() < 3.5;
        assert!(found[0].outer.iter().all(covered), "{:?}", found[0].outer);
    }
}
