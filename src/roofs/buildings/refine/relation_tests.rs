//! Whether the images allow a relation between sides.
//!
//! With the free solution x and its covariance C, forcing the relation `c(x)` to zero raises the
//! cost of the adjustment by
//!
//! ```text
//! chi2 = c^2 / (J C J' + sigma^2),   J = dc/dx
//! ```
//!
//! which is chi-square with one degree of freedom when the relation is true of the building to
//! within sigma. It is adopted when chi2 is below a quantile, and then C and x are updated (one
//! step of a Kalman filter), so that the next relation is tested against what has been adopted.

use nalgebra::DVector;
use serde::Serialize;

use super::adjust::Solution;
use super::relations::{Relation, RelationKind};
use super::wireframe::{Wireframe, WireframeState};
use crate::base::geometry::Segment3;
use crate::base::params::RefineParams;

/// Step of the differences.
const STEP: f64 = 1e-4;

/// A relation that was tested.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct TestedRelation {
    /// Its kind.
    pub kind: RelationKind,
    /// Its sides in the free solution, metres.
    pub sides: Vec<Segment3>,
    /// How far the free solution is from it, metres (at the end of the side; of height over 4 m for
    /// slopes).
    pub deviation_m: f64,
    /// By how much the cost would rise, standard deviations squared.
    pub chi2: f64,
    /// Was it adopted?
    pub adopted: bool,
}

/// Tests relations one after the other, those that fit best first within each kind's turn, and
/// adopts those that the covariance of the free solution allows.
pub(super) fn adopt_relations(
    w: &Wireframe,
    solution: &Solution,
    proposed: &[Relation],
    params: &RefineParams,
) -> (Vec<Relation>, Vec<TestedRelation>) {
    let free = &solution.state;
    let mut state = free.clone();
    // What the relations adopted so far take from the covariance: spread spread' / variance each.
    let mut taken: Vec<(DVector<f64>, f64)> = Vec::new();
    let (mut adopted, mut tested) = (Vec::new(), Vec::new());
    for relation in proposed {
        let gradient = gradient(relation, w, &state);
        let mut spread = solution.spread(&gradient);
        for (earlier, variance) in &taken {
            spread -= earlier * (earlier.dot(&gradient) / variance);
        }
        let variance = gradient.dot(&spread) + params.relation_sigma_m * params.relation_sigma_m;
        let value = relation.value(w, &state);
        let chi2 = value * value / variance;
        let accept = chi2 <= params.relation_chi2;
        tested.push(TestedRelation {
            kind: relation.kind(),
            sides: relation
                .sides()
                .iter()
                .map(|&i| w.segment(free, &w.sides[i]))
                .collect(),
            deviation_m: value,
            chi2,
            adopted: accept,
        });
        if accept {
            state -= &spread * (value / variance);
            taken.push((spread, variance));
            adopted.push(*relation);
        }
    }
    (adopted, tested)
}

fn gradient(relation: &Relation, w: &Wireframe, state: &WireframeState) -> DVector<f64> {
    let mut gradient = DVector::zeros(state.len());
    let mut at = state.clone();
    for u in relation.unknowns(w) {
        at[u] = state[u] + STEP;
        let above = relation.value(w, &at);
        at[u] = state[u] - STEP;
        gradient[u] = (above - relation.value(w, &at)) / (2.0 * STEP);
        at[u] = state[u];
    }
    gradient
}
