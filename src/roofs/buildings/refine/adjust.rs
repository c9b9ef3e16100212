//! The least-squares adjustment of a wireframe (Levenberg-Marquardt).
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
use super::envelope::{Envelope, Pattern};
use super::relations::Relation;
use super::statement::Statement;
use super::wireframe::{Meet, Straight, Wireframe, WireframeState};
use crate::base::geometry::Segment2;
use crate::base::math;
use crate::base::params::RefineParams;
use crate::orienting::scene::Scene;

/// Standard deviation of what must hold exactly, metres: far below any measurement, and below
/// welding.
const EXACT_M: f64 = 2e-4;
/// Step of the differences, metres and metres of height per metre.
const STEP: f64 = 1e-4;
/// Weight of the belief that the covariances are right, in residuals.
const SCATTER_PRIOR: f64 = 10.0;
/// Most iterations.
const MAX_ITERATIONS: usize = 20;

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
    /// By how much the residuals scatter more than they should.
    scatter: f64,
}

impl Solution<'_> {
    /// The covariance of the state times a vector.
    pub(super) fn spread(&self, gradient: &DVector<f64>) -> DVector<f64> {
        self.factor.solve(gradient) * self.scatter
    }
}

struct NormalEquations<'p> {
    matrix: Envelope<'p>,
    gradient: DVector<f64>,
    cost: f64,
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
    ) -> Option<Solution<'p>> {
        let mut state = start.clone();
        let mut normal = self.normal(&state, pattern)?;
        let mut damping = 1e-6;
        for _ in 0..MAX_ITERATIONS {
            let factor = normal.matrix.damped(1.0 + damping).cholesky()?;
            let moved = &state - factor.solve(&normal.gradient);
            match self.normal(&moved, pattern) {
                Some(next) if next.cost <= normal.cost => {
                    let gain = normal.cost - next.cost;
                    (state, normal) = (moved, next);
                    damping = (damping * 0.1).max(1e-12);
                    if gain <= 1e-4 * (1.0 + 1e-3 * normal.cost) {
                        break;
                    }
                }
                _ => damping *= 10.0,
            }
            if damping > 1e6 {
                break;
            }
        }
        self.solution(state, normal)
    }

    /// A state as it is, with how certain its residuals make it; `None` when the normal equations
    /// are singular.
    pub(super) fn unsolved<'p>(
        &self,
        state: &WireframeState,
        pattern: &'p Pattern,
    ) -> Option<Solution<'p>> {
        self.solution(state.clone(), self.normal(state, pattern)?)
    }

    fn solution<'p>(
        &self,
        state: WireframeState,
        normal: NormalEquations<'p>,
    ) -> Option<Solution<'p>> {
        // Residuals that scatter more than they should make the solution less certain.
        let redundancy = (2 * self.observations()) as f64;
        let scatter = ((normal.cost + SCATTER_PRIOR) / (redundancy + SCATTER_PRIOR)).max(1.0);
        let factor = normal.matrix.cholesky()?;
        Some(Solution {
            state,
            factor,
            scatter,
        })
    }

    /// Number of measured edges.
    pub(super) fn observations(&self) -> usize {
        let observation = |t: &&Term| matches!(t, Term::Edge(_));
        self.terms.iter().filter(observation).count()
    }

    /// The normal equations at a state, with robust weights; `None` where a side is behind a
    /// camera.
    fn normal<'p>(
        &self,
        state: &WireframeState,
        pattern: &'p Pattern,
    ) -> Option<NormalEquations<'p>> {
        let mut normal = NormalEquations {
            matrix: pattern.zeros(),
            gradient: DVector::zeros(state.len()),
            cost: 0.0,
        };
        let mut at = state.clone();
        for term in &self.terms {
            let [r0, r1] = self.residual(term, state)?;
            let square = r0 * r0 + r1 * r1;
            let k2 = self.loss * self.loss;
            let weight = if matches!(term, Term::Edge(_)) {
                normal.cost += k2 * math::ln(1.0 + square / k2);
                1.0 / (1.0 + square / k2)
            } else {
                normal.cost += square;
                1.0
            };
            let unknowns = self.unknowns(term);
            let mut rows = [[0.0f64; MAX_UNKNOWNS]; 2];
            for (k, &u) in unknowns.iter().enumerate() {
                at[u] = state[u] + STEP;
                let [a0, a1] = self.residual(term, &at)?;
                at[u] = state[u] - STEP;
                let [b0, b1] = self.residual(term, &at)?;
                at[u] = state[u];
                rows[0][k] = (a0 - b0) / (2.0 * STEP);
                rows[1][k] = (a1 - b1) / (2.0 * STEP);
            }
            for (i, &u) in unknowns.iter().enumerate() {
                normal.gradient[u] += weight * (rows[0][i] * r0 + rows[1][i] * r1);
                for (j, &v) in unknowns[..=i].iter().enumerate() {
                    let product = rows[0][i] * rows[0][j] + rows[1][i] * rows[1][j];
                    normal.matrix.add(u, v, weight * product);
                }
            }
        }
        Some(normal)
    }

    /// Weighted residuals of a term; the second is 0 where there is one only.
    pub(super) fn residual(&self, term: &Term, state: &WireframeState) -> Option<[f64; 2]> {
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
        }
    }
}

/// The most unknowns of a term: a relation between two sides of two facets.
pub(super) const MAX_UNKNOWNS: usize = 14;
