//! From competing planes to facets and the closed buildings below them: the stage that orders B99
//! 4.3.
//!
//! labelling -> outlines -> verification -> walls (figure 24). A facet that fails verification is
//! rejected and the labelling continues without it, as the paper updates the neighbours of a plane
//! that is removed.

use std::collections::BTreeMap;

use serde::Serialize;

use super::competing_planes::CompetingPlanes;
use super::delineation::{Delineation, Outline, delineate};
use super::islands::without_islands;
use super::register::{RegisterEvidence, RegisterTrace};
use super::verification::{
    FacetRejection, KnownEvidence, Measured, RejectedFacet, VerifiedFacet, tail_on_ground, verify,
};
use crate::base::evidence::JudgedFacet;
use crate::base::execution::reached;
use crate::base::labelling::Labelling;
use crate::base::params::RoofParams;
use crate::orienting::scene::Scene;
use crate::planes::terrain::Ground;
use crate::roofs::model::{Facet, Occluders, RoofModel};
use crate::roofs::solids::{SolidTrace, close_above};

/// What delineation and verification did.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FacetTrace {
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

/// The steps from competing planes to closed buildings.
#[derive(Clone, Debug, Default, Serialize)]
pub struct RoofTrace {
    /// Delineation and verification.
    pub facets: FacetTrace,
    /// Walls and ground.
    pub solids: SolidTrace,
}

/// Delineates and verifies facets, and closes the buildings below them.
pub fn reconstruct_roofs(
    scene: &Scene,
    competing: Option<&CompetingPlanes>,
    ground: &Ground,
    params: &RoofParams,
) -> (RoofModel, RoofTrace) {
    let (found, facets) = competing.map_or_else(Default::default, |competing| {
        reconstruct_facets(scene, competing, ground, params)
    });
    reached(0.9);
    let (model, solids) = close_above(&found, ground);
    (model, RoofTrace { facets, solids })
}

/// Facets on the planes that compete (B99 4.3). Their `building` is still unset (0): facets that
/// touch become buildings when walls are added.
fn reconstruct_facets(
    scene: &Scene,
    competing: &CompetingPlanes,
    ground: &Ground,
    params: &RoofParams,
) -> (Vec<Facet>, FacetTrace) {
    let labelling_with = |register: Option<&RegisterEvidence>| {
        Labelling::new(
            competing.energy(register, params),
            competing.planes.len() as u32,
        )
    };
    let known = KnownEvidence {
        colours: scene,
        register: None,
        cloud: competing.cloud.as_ref(),
    };
    let verifier = Verifier {
        competing,
        ground,
        known: &known,
        params,
    };
    let mut verified = verifier.solve(labelling_with(None));
    let register = scene.known.footprints.as_ref().map(|register| {
        let CompetingPlanes {
            evidence,
            arrangement,
            grid,
            ..
        } = competing;
        let mut register = RegisterEvidence::new(register, &params.register, arrangement, grid);
        // What the images show by themselves tells what the register is worth.
        register.compare(&verified.facets);
        if register.counts() {
            let known = KnownEvidence {
                register: Some(&register),
                ..known
            };
            let labelling = labelling_with(Some(&register));
            let verifier = Verifier {
                known: &known,
                ..verifier
            };
            verified = verifier.solve(labelling);
        }
        register.findings(&verified.facets, evidence.ground(), &arrangement.areas)
    });
    let trace = FacetTrace {
        judged: verified.judged,
        rejected: verified.rejected,
        register,
    };
    (verified.facets, trace)
}

/// The facets that stand, all that were weighed, and those that were rejected.
struct Verified {
    facets: Vec<Facet>,
    judged: Vec<JudgedFacet>,
    rejected: Vec<RejectedFacet>,
}

/// What has been weighed in all rounds so far.
#[derive(Default)]
struct Weighed {
    /// By plane and cells.
    measured: BTreeMap<(u32, Vec<usize>), Measured>,
    rejected: Vec<RejectedFacet>,
    improbable: Vec<JudgedFacet>,
}

/// What became of the outlines of one delineation.
#[derive(Default)]
struct Round {
    facets: Vec<Facet>,
    accepted: Vec<JudgedFacet>,
    /// By outline.
    stands: Vec<bool>,
    /// Planes and the cells that they lose.
    excluded: Vec<(u32, Vec<usize>)>,
    /// On the ground no other plane may take their place: they stay in the labelling.
    on_ground: Vec<RejectedFacet>,
}

impl Round {
    fn reject(
        &mut self,
        outline: &Outline,
        facet: Facet,
        reason: FacetRejection,
        rejected: &mut Vec<RejectedFacet>,
    ) {
        let near_ground = matches!(reason, FacetRejection::NearGround { .. });
        let rejection = RejectedFacet {
            group: outline.plane,
            outline: facet.outer,
            reason,
        };
        if near_ground {
            self.on_ground.push(rejection);
        } else {
            rejected.push(rejection);
            self.excluded.push((outline.plane, outline.cells.clone()));
        }
    }
}

/// What facets are verified with.
#[derive(Clone, Copy)]
struct Verifier<'a> {
    competing: &'a CompetingPlanes,
    ground: &'a Ground,
    known: &'a KnownEvidence<'a>,
    params: &'a RoofParams,
}

impl Verifier<'_> {
    /// Labels, delineates and verifies until no facet is rejected.
    fn solve(&self, mut labelling: Labelling) -> Verified {
        // Where a facet is rejected its cells are labelled anew. Assumption: what is rejected in
        // the fourth round leaves a gap.
        const REJECTION_ROUNDS: usize = 4;
        let arrangement = &self.competing.arrangement;
        let mut weighed = Weighed::default();
        for round in 1..=REJECTION_ROUNDS {
            labelling.minimise();
            let labels = labelling.labels();
            let labels = without_islands(arrangement, labels, self.params.min_area_m2);
            let delineation = delineate(arrangement, &labels, &self.competing.planes);
            labelling.relabel(labels);
            let is_last = round == REJECTION_ROUNDS;
            let found = self.weigh(&delineation, &mut weighed, is_last);
            if found.excluded.is_empty() || is_last {
                return self.simplified(delineation, found, weighed);
            }
            for (plane, cells) in found.excluded {
                labelling.exclude(plane, &cells);
            }
        }
        unreachable!("the last round returns")
    }

    /// Verifies the facets of a delineation. Those that reach the ground lose what lies on it,
    /// where another round follows.
    fn weigh(&self, delineation: &Delineation, weighed: &mut Weighed, is_last: bool) -> Round {
        let competing = self.competing;
        let outlines = &delineation.outlines;
        let found: Vec<Facet> = (outlines.iter())
            .map(|outline| competing.facet(outline, delineation))
            .collect();
        let occluders = Occluders::new(&found);
        let results = crate::base::execution::map(outlines, |i, outline| {
            let before = weighed
                .measured
                .get(&(outline.plane, outline.cells.clone()));
            let facet = (&found[i], outline);
            let (ground, known) = (self.ground, self.known);
            verify(
                competing,
                facet,
                &occluders,
                ground,
                known,
                before,
                self.params,
            )
        });
        let mut round = Round {
            stands: vec![false; outlines.len()],
            ..Round::default()
        };
        for (i, ((outline, facet), result)) in (outlines.iter().zip(found).zip(results)).enumerate()
        {
            let reason = match result {
                Ok(verified) => {
                    let judged = self.judged(&facet, &verified);
                    let key = (outline.plane, outline.cells.clone());
                    weighed.measured.insert(key, verified.measured);
                    if judged.accepted {
                        round.facets.push(Facet {
                            probability: verified.evidence.probability(),
                            ..facet
                        });
                        round.accepted.push(judged);
                        round.stands[i] = true;
                        continue;
                    }
                    weighed.improbable.push(judged);
                    FacetRejection::Improbable {
                        evidence: verified.evidence,
                    }
                }
                Err(reason) => reason,
            };
            if !is_last && let Some(tail) = self.tail_on_ground(&reason, &facet, outline) {
                round.excluded.push((outline.plane, tail));
            } else {
                round.reject(outline, facet, reason, &mut weighed.rejected);
            }
        }
        round
    }

    fn judged(&self, facet: &Facet, verified: &VerifiedFacet) -> JudgedFacet {
        JudgedFacet {
            outline: facet.outer.clone(),
            holes: facet.holes.clone(),
            plane: facet.plane,
            accepted: verified.evidence.accepts(self.params.least_nats),
            evidence: verified.evidence.clone(),
            windows: verified.windows().clone(),
        }
    }

    /// The cells of a facet that lie on the ground, where that is why it is rejected.
    fn tail_on_ground(
        &self,
        reason: &FacetRejection,
        facet: &Facet,
        outline: &Outline,
    ) -> Option<Vec<usize>> {
        if !matches!(reason, FacetRejection::ReachesGround { .. }) {
            return None;
        }
        tail_on_ground(
            &facet.plane,
            &outline.cells,
            &self.competing.arrangement,
            self.ground,
            self.params.min_height_m,
        )
    }

    /// The facets of the last round with simpler outlines, and all that was weighed.
    fn simplified(&self, delineation: Delineation, round: Round, weighed: Weighed) -> Verified {
        let Weighed {
            mut rejected,
            improbable,
            ..
        } = weighed;
        let (mut judged, stands) = (round.accepted, round.stands);
        rejected.extend(round.on_ground);
        judged.extend(improbable);
        let simpler = (self.competing).simplify(delineation, &stands, self.params);
        let outlines = (simpler.outlines.iter().zip(stands)).filter(|(_, stands)| *stands);
        let simple = |(facet, (outline, _)): (Facet, (&Outline, bool))| Facet {
            probability: facet.probability,
            ..self.competing.facet(outline, &simpler)
        };
        Verified {
            facets: round.facets.into_iter().zip(outlines).map(simple).collect(),
            judged,
            rejected,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    use crate::base::geometry::Plane;
    use crate::base::ids::ProposalOrigin;
    use crate::base::params::PointCloudParams;
    use crate::planes::grouping::{GroupedPlanes, ProposedPlane};
    use crate::planes::rendered_planes::{TexturedPlane, scene};
    use crate::roofs::facets::{FacetInput, PlacedCloud, competing_planes};
    use crate::roofs::testing::line;
    use nalgebra::{Point3, Vector3};

    const ROOF_Z: f64 = 5.0;

    /// A rectangle of 8 m by 6 m around the origin, at a height.
    fn rectangle(index: u32, z: f64) -> ProposedPlane {
        let corners = [(-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)];
        ProposedPlane {
            origin: ProposalOrigin::Rectangle(index),
            plane: Plane::level(z),
            ring: corners.map(|(x, y)| Point3::new(x, y, z)).to_vec(),
            sides_on_edges: true,
        }
    }

    /// The facets of a flat roof of which one eave was matched, without a half-plane, with planes
    /// that are proposed for it.
    fn facets(proposals: &[ProposedPlane], cloud: Option<&Arc<PlacedCloud>>) -> Vec<Facet> {
        let on_roof = |x: f64, y: f64| x.abs() < 4.0 && y.abs() < 3.0;
        let textured = |plane, exists| TexturedPlane {
            plane,
            exists,
            texture: 0.3,
        };
        let scene = scene(&[
            textured(Plane::level(ROOF_Z), on_roof),
            textured(Plane::level(0.0), |_, _| true),
        ]);
        let eave = line(
            Point3::new(-4.0, -3.0, ROOF_Z),
            Point3::new(4.0, -3.0, ROOF_Z),
        );
        let (lines, ground, params) = ([eave], Ground::level(0.0), RoofParams::default());
        let evidence = FacetInput {
            segments: &[],
            grouped: &GroupedPlanes::new(&lines, &[], true, proposals, &ground, &params),
            ground: &ground,
            cloud,
        };
        let (competing, _) = competing_planes(&scene, &evidence, &params).unwrap();
        competing.map_or_else(Vec::new, |competing| {
            reconstruct_facets(&scene, &competing, evidence.ground, &params).0
        })
    }

    #[test]
    fn a_rectangle_is_a_facet_where_half_planes_are_absent() {
        assert!(facets(&[], None).is_empty());
        // The wrong ones come first, and lose.
        let proposed = [rectangle(7, 7.5), rectangle(8, 2.5), rectangle(9, ROOF_Z)];
        let found = facets(&proposed, None);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].proposals, [ProposalOrigin::Rectangle(9)]);
        assert!((found[0].plane.z_at(0.0, 0.0) - ROOF_Z).abs() < 0.05);
        let covered = |p: &Point3<f64>| p.x.abs() < 4.5 && p.y.abs() < 3.5;
        assert!(found[0].outer.iter().all(covered), "{:?}", found[0].outer);
    }

    #[test]
    fn a_plane_is_fitted_to_the_points_of_a_cloud() {
        // Its plane is a decimetre off at both ends.
        let normal = Vector3::new(0.025, 0.0, 1.0);
        let tilted = Plane::from_point_normal(&Point3::new(0.0, 0.0, ROOF_Z), &normal);
        let mut proposed = rectangle(9, ROOF_Z);
        proposed.plane = tilted.expect("a normal");
        (proposed.ring.iter_mut()).for_each(|p| *p = proposed.plane.lift(p.x, p.y));
        let places = (-40..40).flat_map(|x| (-30..30).map(move |y| (x, y)));
        let point = |(x, y)| Point3::new(0.1 * f64::from(x), 0.1 * f64::from(y), ROOF_Z);
        let cloud = Arc::new(PlacedCloud {
            points: places.map(point).collect(),
            accuracy_m: 0.05,
            belongs: 0.9,
            params: PointCloudParams::default(),
        });
        let off = |cloud| {
            let found = facets(std::slice::from_ref(&proposed), cloud);
            let heights = found[0].outer.iter().map(|p| (p.z - ROOF_Z).abs());
            heights.fold(0.0, f64::max)
        };
        assert!(off(None) > 0.08);
        assert!(off(Some(&cloud)) < 0.02);
    }
}
