//! Regularisation and refinement of buildings: the wireframe is adjusted to the image edges of all
//! views (B99 section 2: the partner in Leuven regularises the roofs and refines their corners by
//! the reprojection error of the wireframe).
//!
//! ```text
//! gaps               facets cut back where delineation closed a gap to a wall
//! wireframe          vertices, planes and sides of a building
//! profiles           rows of grey values along a side, from inside to outside
//! edge_observations  sides -> image edges in every view
//! relations          parallel, perpendicular, horizontal, symmetric: proposals
//! adjust             least squares of a wireframe, first without relations
//! relation_tests     relations that the covariance allows, for the second adjustment
//! uncertainty        standard deviations of planes and corners
//! acceptance         tests of the adjusted building, and why one is not adjusted
//! statement          what somebody states of a corner, a side or a facet
//! by_hand            adjustment to such statements
//! ```
//!
//! Delineation puts borders where lines were found or where correlation ends. The first are
//! averages of what matching kept, the second are off by half a window. Here every side is measured
//! again, in every view that sees it, and all sides, planes and corners of a building move
//! together.
//!
//! Invariant: an adjusted building has the smaller reprojection error, is a closed solid without a
//! broken invariant, and its views agree inside the facets as well as before. Otherwise it keeps
//! its shape.
//! Invariant: the result has as many facets as the model, in the same order.

mod acceptance;
mod adjust;
mod by_hand;
mod edge_observations;
#[cfg(test)]
pub(super) mod fixture;
mod gaps;
mod profiles;
mod relation_tests;
mod relations;
mod statement;
mod uncertainty;
mod wireframe;

pub use acceptance::RefineRejection;
pub use by_hand::adjust_to_statements;
#[cfg(test)]
pub(crate) use fixture::gable;
pub use gaps::{RoofGap, cut_back_at_gaps};
pub use relation_tests::TestedRelation;
pub use relations::RelationKind;
pub use statement::Statement;
pub use wireframe::SideKind;

use nalgebra::Vector3;
use serde::Serialize;

use self::acceptance::AcceptanceTest;
use self::adjust::{AdjustmentProblem, Solution, Term};
use self::edge_observations::{EdgeObservation, measure_sides};
use self::relation_tests::adopt_relations;
use self::uncertainty::uncertainty_of;
use self::wireframe::{Wireframe, WireframeState};
use crate::base::ids::BuildingId;
use crate::base::least_squares::Stop;
use crate::base::params::{RefineParams, RoofParams};
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::roofs::model::{Building, Facet, FacetUncertainty, Occluders, RoofModel};

/// The refinement of one building.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct BuildingRefinement {
    /// The building.
    pub building: BuildingId,
    /// Straight sides of its wireframe.
    pub sides: usize,
    /// Edges measured for them over all views.
    pub observations: usize,
    /// Root mean square distance of these edges from the images of the sides before, px.
    pub error_before_px: f64,
    /// ... and after the adjustment.
    pub error_after_px: f64,
    /// Largest move of a corner in plan, metres.
    pub largest_move_m: f64,
    /// Relations that were tested.
    pub relations: Vec<TestedRelation>,
    /// Why the adjustment was rejected; `None` when it was not.
    pub refused: Option<RefineRejection>,
}

/// Refines the facets of a closed model, building by building. The result has as many facets in the
/// same order, to be closed again; what became of each building, in their order.
pub fn refine_roofs(
    scene: &Scene,
    lines: &[Line3d],
    model: &RoofModel,
    params: &RoofParams,
) -> (Vec<Facet>, Vec<BuildingRefinement>) {
    let occluders = Occluders::new(&model.facets);
    let mut facets = model.facets.clone();
    let mut buildings = Vec::new();
    if !params.refine.refine {
        return (facets, buildings);
    }
    let refined = crate::base::execution::map(&model.buildings, |i, building| {
        let old: Vec<&Facet> = (building.facets.iter())
            .map(|f| &model.facets[f.index()])
            .collect();
        let refiner = BuildingRefiner {
            scene,
            lines,
            occluders: &occluders,
            building,
            old: &old,
            params,
        };
        let mut report = BuildingRefinement::of(BuildingId::from_index(i));
        let new = refiner.refine(&mut report).unwrap_or_else(|refusal| {
            report.refused = Some(refusal);
            old.iter().copied().cloned().collect()
        });
        (refiner.with_uncertainty(new), report)
    });
    for (building, (new, report)) in model.buildings.iter().zip(refined) {
        for (id, facet) in building.facets.iter().zip(new) {
            facets[id.index()] = facet;
        }
        buildings.push(report);
    }
    (facets, buildings)
}

impl BuildingRefinement {
    /// Before any step.
    fn of(building: BuildingId) -> Self {
        Self {
            building,
            sides: 0,
            observations: 0,
            error_before_px: 0.0,
            error_after_px: 0.0,
            largest_move_m: 0.0,
            relations: Vec::new(),
            refused: None,
        }
    }
}

/// Refines one building.
struct BuildingRefiner<'a> {
    scene: &'a Scene,
    lines: &'a [Line3d],
    occluders: &'a Occluders<'a>,
    building: &'a Building,
    old: &'a [&'a Facet],
    params: &'a RoofParams,
}

impl BuildingRefiner<'_> {
    /// The refined facets, or why there are none. Facets that make the result unacceptable keep
    /// their outlines and a small search range, and the others are adjusted again.
    fn refine(&self, report: &mut BuildingRefinement) -> Result<Vec<Facet>, RefineRejection> {
        // Adjustments, each with fewer facets open. Assumption.
        const ATTEMPTS: usize = 4;
        let (wireframe, _) = Wireframe::new(self.old);
        report.sides = wireframe.sides.len();
        if wireframe.size() > self.params.refine.max_unknowns {
            let unknowns = wireframe.size();
            return Err(RefineRejection::TooLarge { unknowns });
        }
        let mut open = vec![true; self.old.len()];
        for attempt in 1.. {
            let (rejection, offending) = match self.refined(&open, report) {
                Ok(new) => return Ok(new),
                Err(why) => why,
            };
            let exhausted = offending.iter().all(|&f| !open[f]);
            if attempt == ATTEMPTS || exhausted {
                return Err(rejection);
            }
            // In the last attempt no side may move far.
            if attempt + 1 == ATTEMPTS {
                open.fill(false);
            }
            offending.into_iter().for_each(|f| open[f] = false);
        }
        unreachable!("the last attempt returns")
    }

    fn edge_observations(
        &self,
        wireframe: &Wireframe,
        state: &WireframeState,
        search: &[bool],
    ) -> Vec<EdgeObservation> {
        let (scene, occluders, params) = (self.scene, self.occluders, self.params);
        measure_sides(
            scene, occluders, wireframe, state, search, self.lines, params,
        )
    }

    /// The facets with their uncertainty: where they are not the adjusted ones, from how far the
    /// image edges lie from them as they are; without it where the images show too few.
    fn with_uncertainty(&self, facets: Vec<Facet>) -> Vec<Facet> {
        if facets.iter().all(|f| f.uncertainty.is_some()) {
            return facets;
        }
        let all: Vec<&Facet> = facets.iter().collect();
        let (wireframe, state) = Wireframe::new(&all);
        if wireframe.size() > self.params.refine.max_unknowns {
            return facets;
        }
        let near = vec![false; facets.len()];
        let observations = self.edge_observations(&wireframe, &state, &near);
        if observations.len() < self.params.refine.min_observations {
            return facets;
        }
        let mut problem = AdjustmentProblem::new(
            self.scene,
            &wireframe,
            &state,
            observations,
            &self.params.refine,
        );
        let heights = height_terms(&wireframe, &state, &all, self.lines, &self.params.refine);
        problem.terms.extend(heights);
        let pattern = problem.pattern();
        match problem.unsolved(&state, &pattern) {
            Some(solution) => {
                let uncertainties = uncertainty_of(&problem, &solution);
                with_uncertainties(facets, uncertainties)
            }
            None => facets,
        }
    }

    fn acceptance_test(&self) -> AcceptanceTest<'_> {
        AcceptanceTest {
            scene: self.scene,
            old: self.old,
            ground_z: self.building.ground_z,
            params: &self.params.refine,
        }
    }

    /// The refined facets of a building, or why there are none and which facets are the cause.
    /// Those not `open` keep their outlines.
    fn refined(
        &self,
        open: &[bool],
        report: &mut BuildingRefinement,
    ) -> Result<Vec<Facet>, (RefineRejection, Vec<usize>)> {
        let params = &self.params.refine;
        let rejected = |why| (why, Vec::new());
        let (wireframe, start) = Wireframe::new(self.old);
        report.sides = wireframe.sides.len();
        let heights = height_terms(&wireframe, &start, self.old, self.lines, params);
        let problem = |state: &WireframeState, far: &[bool]| {
            let observations = self.edge_observations(&wireframe, state, far);
            let mut problem =
                AdjustmentProblem::new(self.scene, &wireframe, &start, observations, params);
            problem.terms.extend(heights.iter().cloned());
            problem
        };
        // First to the edges that stand out within the search range, then measured again from
        // there.
        let singular = || rejected(RefineRejection::Singular);
        let far = problem(&start, open);
        let pattern = far.pattern();
        let near = far
            .solve(&start, &pattern, Stop::default())
            .ok_or_else(singular)?;
        let mut problem = problem(&near.state, &vec![false; open.len()]);
        report.observations = problem.observations();
        if report.observations < params.min_observations {
            let observations = report.observations;
            return Err(rejected(RefineRejection::FewObservations { observations }));
        }
        let pattern = problem.pattern();
        let free = problem
            .solve(&near.state, &pattern, Stop::default())
            .ok_or_else(singular)?;
        let (regular, uncertainties) =
            regularised(&mut problem, &free, params, &mut report.relations).ok_or_else(singular)?;

        report.error_before_px = problem.error_px(&start, params.cap_px);
        report.error_after_px = problem.error_px(&regular, params.cap_px);
        let moves = (0..wireframe.vertices)
            .map(|v| (wireframe.position(&regular, v) - wireframe.position(&start, v)).norm());
        report.largest_move_m = moves.fold(0.0, f64::max);
        // NaN fails the comparison.
        if report.error_after_px < report.error_before_px {
            let new = (self.acceptance_test()).accept(wireframe.facets(&regular, self.old))?;
            Ok(with_uncertainties(new, uncertainties))
        } else {
            Err(rejected(RefineRejection::NoGain))
        }
    }
}

fn with_uncertainties(facets: Vec<Facet>, of: Vec<FacetUncertainty>) -> Vec<Facet> {
    let with = |(facet, of)| Facet {
        uncertainty: Some(of),
        ..facet
    };
    facets.into_iter().zip(of).map(with).collect()
}

/// Solves once more with the relations that the free solution allows; with the uncertainty of every
/// facet then.
fn regularised(
    problem: &mut AdjustmentProblem,
    free: &Solution,
    params: &RefineParams,
    tested: &mut Vec<TestedRelation>,
) -> Option<(WireframeState, Vec<FacetUncertainty>)> {
    let proposed = relations::propose(problem.wireframe, &free.state, params);
    let (adopted, tests) = adopt_relations(problem.wireframe, free, &proposed, params);
    *tested = tests;
    let terms = adopted
        .into_iter()
        .map(|r| Term::Relation(r, ADOPTED_SIGMA_M));
    problem.terms.extend(terms);
    // Relations join unknowns that no image edge does.
    let pattern = problem.pattern();
    let solution = problem.solve(&free.state, &pattern, Stop::default())?;
    let uncertainties = uncertainty_of(problem, &solution);
    Some((solution.state, uncertainties))
}

/// Standard deviation of an adopted relation, metres: small enough to make it hold.
const ADOPTED_SIGMA_M: f64 = 1e-3;

/// Observations of the planes: heights at the ends of the facets' lines, with the covariance of the
/// lines, and loose heights around each facet, so that no plane is undetermined.
fn height_terms(
    wireframe: &Wireframe,
    state: &WireframeState,
    facets: &[&Facet],
    lines: &[Line3d],
    params: &RefineParams,
) -> Vec<Term> {
    let mut terms = Vec::new();
    for (face, facet) in facets.iter().enumerate() {
        let mut add = |p: &nalgebra::Point3<f64>, variance: f64| {
            let at = p.xy();
            terms.push(Term::Height {
                face,
                at,
                z: wireframe.height(state, face, &at),
                sigma_m: (variance + params.height_floor_m * params.height_floor_m).sqrt(),
            });
        };
        let normal: Vector3<f64> = facet.plane.normal / facet.plane.normal.z;
        for line in facet.lines.iter().map(|l| &lines[l.index()]) {
            let ends = [&line.segment.p0, &line.segment.p1];
            for (p, covariance) in ends.into_iter().zip(&line.covariance) {
                add(p, normal.dot(&(covariance * normal)));
            }
        }
        let loose = params.height_sigma_m * params.height_sigma_m;
        facet.outer.iter().for_each(|p| add(p, loose));
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::synthetic::{SyntheticTruth, gable_scene, l_scene, skewed_scene};
    use crate::roofs::model::check_invariants;
    use crate::roofs::solids::close_buildings;
    use nalgebra::{Matrix3, Point3};

    /// The true roof, each corner moved by `change`; affine changes keep facets planar and joined.
    fn changed(truth: &SyntheticTruth, change: impl Fn(&Point3<f64>) -> Point3<f64>) -> RoofModel {
        let facets: Vec<Facet> = (truth.facets.iter())
            .map(|(_, ring)| {
                crate::roofs::testing::facet(&ring.iter().map(&change).collect::<Vec<_>>())
            })
            .collect();
        let (model, trace) = close_buildings(&facets, |_| truth.ground_z);
        assert_eq!((trace.rejected.len(), model.buildings.len()), (0, 1));
        model
    }

    /// Shifted by 0.15 m, turned by half a degree, stretched by a hundredth.
    fn displaced(p: &Point3<f64>) -> Point3<f64> {
        let m = Matrix3::new(1.01, -0.009, 0.0, 0.008, 1.0, 0.0, 0.0, 0.0, 1.0);
        Point3::from(m * p.coords + Vector3::new(0.12, -0.09, 0.1))
    }

    /// Refines and closes; gives the model and what happened to its only building.
    fn refine(scene: &Scene, model: &RoofModel) -> (RoofModel, BuildingRefinement) {
        let (facets, refined) = refine_roofs(scene, &[], model, &RoofParams::default());
        let ground = model.buildings[0].ground_z;
        let (closed, solids) = close_buildings(&facets, |_| ground);
        assert_eq!(solids.rejected, []);
        assert_eq!(check_invariants(&closed), []);
        (closed, refined[0].clone())
    }

    /// Largest distance of a true corner from the nearest corner of the model, metres.
    fn error_m(model: &RoofModel, truth: &SyntheticTruth) -> f64 {
        let corners = truth.facets.iter().flat_map(|(_, ring)| ring);
        let nearest = |p: &Point3<f64>| {
            let found = model.facets.iter().flat_map(|f| &f.outer);
            found.map(|q| (p - q).norm()).fold(f64::INFINITY, f64::min)
        };
        corners.map(nearest).fold(0.0, f64::max)
    }

    #[test]
    fn a_displaced_roof_is_put_back() {
        for (scene, truth) in [gable_scene(320), l_scene(320)] {
            let model = changed(&truth, displaced);
            let before = error_m(&model, &truth);
            let (refined, report) = refine(&scene, &model);
            let after = error_m(&refined, &truth);
            // A pixel is 8.5 cm.
            assert!(before > 0.2 && after < 0.06, "{before} {after} {report:#?}");
            assert_eq!(report.refused, None);
            assert!(report.error_after_px < 0.35 && report.error_before_px > 1.0);
        }
    }

    #[test]
    fn an_eave_out_of_reach_of_a_guided_measurement_is_found() {
        let (scene, truth) = gable_scene(320);
        // Both eaves half a metre out, in their planes, as where correlation windows straddle the
        // edge.
        let lowest = (truth.facets.iter().flat_map(|f| &f.1)).fold(f64::MAX, |l, p| l.min(p.z));
        let ridge: Vec<Point3<f64>> = (truth.facets.iter().flat_map(|f| &f.1))
            .filter(|p| p.z > lowest + 1.0)
            .copied()
            .collect();
        let out = |p: &Point3<f64>| {
            if p.z > lowest + 1.0 {
                return *p;
            }
            let up = ridge
                .iter()
                .min_by(|a, b| (*a - p).norm().total_cmp(&(*b - p).norm()))
                .unwrap();
            p + (p - up).normalize() * 0.5
        };
        let model = changed(&truth, out);
        let (refined, report) = refine(&scene, &model);
        let after = error_m(&refined, &truth);
        assert!(after < 0.06, "{after} {report:#?}");
    }

    fn tested(report: &BuildingRefinement, kind: RelationKind, adopted: bool) -> usize {
        let same = |r: &&TestedRelation| r.kind == kind && r.adopted == adopted;
        report.relations.iter().filter(same).count()
    }

    #[test]
    fn relations_are_adopted_where_true_and_rejected_where_the_images_contradict() {
        use RelationKind::{Horizontal, Parallel, Perpendicular, Symmetric};
        let (scene, truth) = gable_scene(320);
        let (refined, report) = refine(&scene, &changed(&truth, displaced));
        assert!(tested(&report, Perpendicular, true) > 0, "{report:#?}");
        assert!(report.relations.iter().all(|r| r.adopted), "{report:#?}");
        // The adopted relations hold: the ridge is level and both facets have one slope.
        let [f, g] = [0, 1].map(|i| refined.facets[i].plane.normal);
        assert!((f.z - g.z).abs() < 1e-3 && f.cross(&g).normalize().z.abs() < 1e-3);

        let (scene, truth) = skewed_scene(320);
        let (refined, report) = refine(&scene, &changed(&truth, displaced));
        assert_eq!(tested(&report, Perpendicular, true), 0, "{report:#?}");
        assert!(tested(&report, Perpendicular, false) > 0, "{report:#?}");
        for kind in [Horizontal, Parallel, Symmetric] {
            assert_eq!(tested(&report, kind, false), 0, "{kind:?} {report:#?}");
        }
        let error = error_m(&refined, &truth);
        assert!(error < 0.06, "{error}");
    }

    #[test]
    fn images_that_show_nothing_change_nothing() {
        let (mut scene, truth) = gable_scene(320);
        for view in &mut scene.views {
            view.gray.data.fill(0.5);
        }
        let model = changed(&truth, displaced);
        let (facets, refined) = refine_roofs(&scene, &[], &model, &RoofParams::default());
        assert_eq!(facets, model.facets);
        let refused = refined[0].refused;
        assert_eq!(
            refused,
            Some(RefineRejection::FewObservations { observations: 0 })
        );
    }
}
