//! A building adjusted to what somebody states of its corners, sides and facets.
//!
//! ```text
//! cost(x) = sum (statement / sigma)^2           what is stated, each with its standard deviation
//!         + sum rho((x - x0) / sigma)           corners and heights as they are, as they are known
//!         + sum rho(relation / sigma)           level, parallel, symmetric sides stay such
//!         + sum (constraint / sigma)^2          meets, straights
//! ```
//!
//! rho is Cauchy's: what the statements contradict is a mistake of the model, which it gives up,
//! and what they do not touch stays. Earlier statements are believed in the same way.

use super::adjust::{AdjustmentProblem, Term};
use super::relations::propose;
use super::statement::Statement;
use super::uncertainty::uncertainty_on;
use super::wireframe::{Wireframe, WireframeState};
use crate::base::least_squares::Stop;
use crate::base::params::RefineParams;
use crate::orienting::scene::Scene;
use crate::roofs::model::{Facet, SideSupport};

/// Standard deviation of a corner or a height that nothing states, metres. Assumption.
const UNKNOWN_SIGMA_M: f64 = 0.1;
/// No corner is known better than that, metres: what is stated by hand weighs more.
const LEAST_SIGMA_M: f64 = 0.05;
/// What holds exactly lets a corner that goes a metre only bend its way there: short steps, of
/// which each gains little.
const STOP: Stop = Stop {
    steps: 400,
    least_gain: 1e-9,
};
/// A relation from which the building is this far does not hold in it, metres.
const HOLDS_M: f64 = 0.02;

/// The facets of one building, adjusted to statements with their standard deviations, metres, and
/// to earlier ones as far as these allow it; `None` where it has too many unknowns or there is no
/// solution.
pub fn adjust_to_statements(
    scene: &Scene,
    facets: &[&Facet],
    statements: &[(Statement, f64)],
    earlier: &[(Statement, f64)],
    params: &RefineParams,
) -> Option<Vec<Facet>> {
    let (wireframe, start) = Wireframe::new(facets);
    if wireframe.size() > params.max_unknowns {
        return None;
    }
    let stated = |all: &[(Statement, f64)]| -> Vec<Term> {
        all.iter()
            .map(|&(s, sigma)| Term::Stated(s, sigma))
            .collect()
    };
    let supports: Vec<Vec<SideSupport>> = (facets.iter().enumerate())
        .map(|(face, facet)| supports_before(&wireframe, &start, face, facet))
        .collect();
    let mut believed = believed(&wireframe, &start, facets, params);
    believed.extend(stated(earlier));
    let exact = (wireframe.meets.iter().map(|m| Term::Meet(*m)))
        .chain(wireframe.straights.iter().map(|s| Term::Straight(*s)));
    let believed = believed
        .into_iter()
        .map(|term| Term::Believed(Box::new(term)));
    let problem = AdjustmentProblem {
        scene,
        wireframe: &wireframe,
        terms: believed.chain(stated(statements)).chain(exact).collect(),
        loss: params.loss_sigmas,
    };
    let pattern = problem.pattern();
    let solution = problem.solve(&start, &pattern, STOP)?;
    let uncertainties = uncertainty_on(&problem, &solution, &supports);
    let adjusted = wireframe.facets(&solution.state, facets);
    let known = adjusted.into_iter().zip(uncertainties);
    Some(
        known
            .map(|(facet, uncertainty)| Facet {
                uncertainty: Some(uncertainty),
                ..facet
            })
            .collect(),
    )
}

/// What the sides of a facet rest on, as its uncertainty says.
fn supports_before(
    w: &Wireframe,
    state: &WireframeState,
    face: usize,
    facet: &Facet,
) -> Vec<SideSupport> {
    let known = facet.uncertainty.as_ref();
    let support = |ends: [usize; 2]| {
        let [u, v] = ends.map(|v| w.position(state, v));
        let side = known.and_then(|known| known.side(&nalgebra::center(&u, &v)));
        side.map_or(SideSupport::Nothing, |side| side.support)
    };
    w.ring_sides(face).map(support).collect()
}

/// The building as it is: corners in plan, heights of the facets there, and the relations that
/// hold.
fn believed(
    w: &Wireframe,
    state: &WireframeState,
    facets: &[&Facet],
    params: &RefineParams,
) -> Vec<Term> {
    let mut plan_sigmas = vec![UNKNOWN_SIGMA_M; w.vertices];
    let mut terms = Vec::new();
    for (face, facet) in facets.iter().enumerate() {
        for &v in w.faces[face].iter().flatten() {
            let corner = w.corner(state, face, v);
            let known = facet.uncertainty.as_ref().and_then(|u| u.at(&corner));
            if let Some(sigma) = known {
                plan_sigmas[v] = sigma.x.max(sigma.y).max(LEAST_SIGMA_M);
            }
            terms.push(Term::Height {
                face,
                at: corner.xy(),
                z: corner.z,
                sigma_m: known.map_or(UNKNOWN_SIGMA_M, |sigma| sigma.z.max(LEAST_SIGMA_M)),
            });
        }
    }
    terms.extend(plan_sigmas.iter().enumerate().map(|(vertex, &sigma_m)| {
        let at = w.position(state, vertex);
        Term::Position {
            vertex,
            at,
            sigma_m,
        }
    }));
    let holding = propose(w, state, params).into_iter();
    let holding = holding.filter(|relation| relation.value(w, state).abs() < HOLDS_M);
    terms.extend(holding.map(|relation| Term::Relation(relation, params.relation_sigma_m)));
    terms
}
