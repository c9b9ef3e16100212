//! The least-squares adjustment of a wireframe.
//!
//! ```text
//! cost(x) = sum rho(|W (offset, angle)|^2)      measured edges against the images of their sides
//!         + sum ((x - x0) / sigma)^2            prior: the solution that delineation left
//!         + sum (constraint / sigma)^2          meets, straights, adopted relations
//! ```
//!
//! rho is Cauchy's, so that one view that shows a gutter or a shadow does not move the side.
//! Derivatives are central differences: a term depends on a dozen unknowns at most, and there are a
//! few thousand terms.

use nalgebra::{DVector, Point2};

use super::edge_observations::EdgeObservation;
use super::relations::Relation;
use super::statement::Statement;
use super::wireframe::{Meet, Straight, Wireframe, WireframeState};
use crate::base::geometry::Segment2;
use crate::base::least_squares::{
    Envelope, EnvelopeEquations, Loss, Pattern, Stop, fit, variance_of_unit_weight,
};
use crate::base::params::RefineParams;
use crate::orienting::scene::Scene;

/// Standard deviation of what must hold exactly, metres: far below any measurement, and below
/// welding.
const EXACT_M: f64 = 2e-4;
/// Step of the differences, metres and metres of height per metre.
const STEP: f64 = 1e-4;
/// Weight of the belief that the covariances are right, in residuals.
const SCATTER_PRIOR: f64 = 10.0;

/// One summand of the cost.
#[derive(Clone, Debug)]
pub(super) enum Term {
    /// A measured edge: two residuals, robust.
    Edge(EdgeObservation),
    /// The present position of a vertex: two residuals.
    Position {
        /// The vertex.
        vertex: usize,
        /// Where it is.
        at: Point2<f64>,
        /// Standard deviation, metres.
        sigma_m: f64,
    },
    /// The height of a facet at a place.
    Height {
        /// The facet.
        face: usize,
        /// The place in plan.
        at: Point2<f64>,
        /// The height, metres.
        z: f64,
        /// Standard deviation, metres.
        sigma_m: f64,
    },
    /// Two facets of one height at a vertex.
    Meet(Meet),
    /// A vertex inside a straight side.
    Straight(Straight),
    /// An adopted relation, with its standard deviation in its own unit.
    Relation(Relation, f64),
    /// What somebody states of it, with its standard deviation, metres.
    Stated(Statement, f64),
    /// What holds unless more speaks against it: robust.
    Believed(Box<Self>),
}

/// A least-squares problem.
pub(super) struct AdjustmentProblem<'a> {
    /// The views.
    pub scene: &'a Scene,
    /// The wireframe.
    pub wireframe: &'a Wireframe,
    /// What is known.
    pub terms: Vec<Term>,
    /// Scale of the robust loss, standard deviations.
    pub loss: f64,
}

/// A solved problem.
pub(super) struct Solution<'p> {
    /// The adjusted state.
    pub state: WireframeState,
    /// Cholesky factor of the normal matrix.
    factor: Envelope<'p>,
    /// Variance of unit weight.
    variance: f64,
}

impl Solution<'_> {
    /// The covariance of the state times a vector.
    pub(super) fn spread(&self, gradient: &DVector<f64>) -> DVector<f64> {
        DVector::from_vec(self.factor.solve(gradient.as_slice())) * self.variance
    }
}

impl<'a> AdjustmentProblem<'a> {
    /// Sightings, the prior of vertices, and what must hold; heights are added by the caller.
    pub(super) fn new(
        scene: &'a Scene,
        wireframe: &'a Wireframe,
        state: &WireframeState,
        observations: Vec<EdgeObservation>,
        params: &RefineParams,
    ) -> Self {
        let positions = (0..wireframe.vertices).map(|vertex| Term::Position {
            vertex,
            at: wireframe.position(state, vertex),
            sigma_m: params.vertex_sigma_m,
        });
        let terms = (observations.into_iter().map(Term::Edge))
            .chain(positions)
            .chain(wireframe.meets.iter().map(|m| Term::Meet(*m)))
            .chain(wireframe.straights.iter().map(|s| Term::Straight(*s)))
            .collect();
        Self {
            scene,
            wireframe,
            terms,
            loss: params.loss_sigmas,
        }
    }

    /// Which unknowns meet in a term.
    pub(super) fn pattern(&self) -> Pattern {
        let groups: Vec<Vec<usize>> = self.terms.iter().map(|t| self.unknowns(t)).collect();
        Pattern::new(self.wireframe.size(), &groups)
    }

    /// Solves from a state; `None` when the normal equations are singular.
    pub(super) fn solve<'p>(
        &self,
        start: &WireframeState,
        pattern: &'p Pattern,
        stop: Stop,
    ) -> Option<Solution<'p>> {
        let equations = |state: &WireframeState| self.equations(state, pattern);
        let moved =
            |state: &WireframeState, step: &Vec<f64>| state + DVector::from_column_slice(step);
        let (state, equations) = fit(start.clone(), equations, moved, stop)?;
        self.solution(state, equations)
    }

    /// A state as it is, with how certain its residuals make it; `None` when the normal equations
    /// are singular.
    pub(super) fn unsolved<'p>(
        &self,
        state: &WireframeState,
        pattern: &'p Pattern,
    ) -> Option<Solution<'p>> {
        self.solution(state.clone(), self.equations(state, pattern)?)
    }

    fn solution<'p>(
        &self,
        state: WireframeState,
        equations: EnvelopeEquations<'p>,
    ) -> Option<Solution<'p>> {
        let redundancy = (2 * self.observations()) as f64;
        Some(Solution {
            state,
            variance: variance_of_unit_weight(equations.cost, redundancy, SCATTER_PRIOR),
            factor: equations.matrix.cholesky()?,
        })
    }

    /// Number of what is measured or believed.
    pub(super) fn observations(&self) -> usize {
        let observation = |t: &&Term| matches!(t, Term::Edge(_) | Term::Believed(_));
        self.terms.iter().filter(observation).count()
    }

    /// The normal equations at a state, with robust weights; `None` where a side is behind a
    /// camera.
    fn equations<'p>(
        &self,
        state: &WireframeState,
        pattern: &'p Pattern,
    ) -> Option<EnvelopeEquations<'p>> {
        let mut equations = EnvelopeEquations::new(pattern);
        let mut at = state.clone();
        for term in &self.terms {
            let loss = match term {
                Term::Edge(_) | Term::Believed(_) => Loss::Cauchy(self.loss),
                _ => Loss::Squares,
            };
            let unknowns = self.unknowns(term);
            let mut rows = [[0.0f64; MAX_UNKNOWNS]; 2];
            for (k, &u) in unknowns.iter().enumerate() {
                at[u] = state[u] + STEP;
                let above = self.residual(term, &at)?;
                at[u] = state[u] - STEP;
                let below = self.residual(term, &at)?;
                at[u] = state[u];
                for (row, (a, b)) in rows.iter_mut().zip(above.into_iter().zip(below)) {
                    row[k] = (a - b) / (2.0 * STEP);
                }
            }
            let rows = [&rows[0][..], &rows[1]];
            equations.add(self.residual(term, state)?, &unknowns, rows, loss);
        }
        Some(equations)
    }

    /// Weighted residuals of a term; the second is 0 where there is one only.
    fn residual(&self, term: &Term, state: &WireframeState) -> Option<[f64; 2]> {
        let w = self.wireframe;
        Some(match term {
            Term::Edge(s) => {
                let [e0, e1] = self.distances(s, state)?;
                let r = s.whitening
                    * nalgebra::Vector2::new(0.5 * (e0 + e1), (e1 - e0) / s.segment.length());
                [r.x, r.y]
            }
            Term::Position {
                vertex,
                at,
                sigma_m,
            } => {
                let d = (w.position(state, *vertex) - at) / *sigma_m;
                [d.x, d.y]
            }
            Term::Height {
                face,
                at,
                z,
                sigma_m,
            } => [(w.height(state, *face, at) - z) / sigma_m, 0.0],
            Term::Meet(meet) => {
                let p = w.position(state, meet.vertex);
                let [f, g] = meet.faces.map(|f| w.height(state, f, &p));
                [(f - g) / EXACT_M, 0.0]
            }
            Term::Straight(straight) => {
                let [p, q] = straight.between.map(|v| w.position(state, v));
                let along = q - p;
                let off = along.perp(&(w.position(state, straight.vertex) - p));
                [off / along.norm().max(1e-9) / EXACT_M, 0.0]
            }
            Term::Relation(relation, sigma) => [relation.value(w, state) / sigma, 0.0],
            Term::Stated(statement, sigma) => statement.value(w, state).map(|r| r / sigma),
            Term::Believed(term) => self.residual(term, state)?,
        })
    }

    /// Signed distances (px) of a measured edge's ends from the image of its side.
    pub(super) fn distances(
        &self,
        observation: &EdgeObservation,
        state: &WireframeState,
    ) -> Option<[f64; 2]> {
        let side = &self.wireframe.sides[observation.side];
        let line = self.wireframe.segment(state, side);
        let camera = self.scene.camera(observation.view);
        let image = Segment2::new(camera.project(&line.p0)?, camera.project(&line.p1)?);
        let l = image.line();
        Some([observation.segment.p0, observation.segment.p1].map(|p| l.x * p.x + l.y * p.y + l.z))
    }

    /// Root mean square distance (px) of the measured edges from their sides. Distances beyond
    /// `cap_px` count as that much: these views show another edge.
    pub(super) fn error_px(&self, state: &WireframeState, cap_px: f64) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0f64);
        for term in &self.terms {
            let Term::Edge(s) = term else { continue };
            for e in self.distances(s, state).unwrap_or([cap_px; 2]) {
                let e = e.abs().min(cap_px);
                sum += e * e;
                count += 1.0;
            }
        }
        (sum / count.max(1.0)).sqrt()
    }

    fn unknowns(&self, term: &Term) -> Vec<usize> {
        let w = self.wireframe;
        let vertex = |v: usize| [2 * v, 2 * v + 1];
        let plane = |f: usize| [0, 1, 2].map(|k| w.plane_at(f) + k);
        match term {
            Term::Edge(s) => w.unknowns(&w.sides[s.side]),
            Term::Position { vertex: v, .. } => vertex(*v).to_vec(),
            Term::Height { face, .. } => plane(*face).to_vec(),
            Term::Meet(m) => {
                let [f, g] = m.faces;
                [&vertex(m.vertex)[..], &plane(f), &plane(g)].concat()
            }
            Term::Straight(s) => {
                let [p, q] = s.between;
                [vertex(s.vertex), vertex(p), vertex(q)].concat()
            }
            Term::Relation(relation, _) => relation.unknowns(w),
            Term::Stated(statement, _) => statement.unknowns(w),
            Term::Believed(term) => self.unknowns(term),
        }
    }
}

/// The most unknowns of a term: a relation between two sides of two facets.
pub(super) const MAX_UNKNOWNS: usize = 14;
