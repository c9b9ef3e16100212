//! The wireframe of one polygon, adjusted to the measured edges of all views: the total
//! reprojection error is minimised (B99 2: Leuven).
//!
//! ```text
//! unknowns    c, a, b of the plane z = c + a (x - x0) + b (y - y0); x, y of each corner
//! cost(x) = sum rho(|W (offset, angle)|^2)   edges of the lines on a side against its image
//!         + sum (p - p0)^2 / END_M^2         corners where their lines end
//!         + sum (z - z0)^2 / sigma^2         lines of the set inside the polygon
//!         + sum (relation / tolerance)^2     relations that were adopted
//! ```
//!
//! rho is Cauchy's loss. Gauss-Newton; the derivatives of edges are those of a line fit
//! ([`crate::lines::lines3d`]), carried over from the ends of the side to the plane and its
//! corners.

use nalgebra::{DMatrix, DVector, Point2, Point3, Vector2, Vector3};
use serde::Serialize;

use super::hypothesis::{END_M, LEVEL, SQUARE, SYMMETRIC, relation_nats};
use super::outline::Outline;
use super::uncertain_plane::UncertainPlane;
use crate::base::geometry::{Plane, Segment3};
use crate::base::math::ln;
use crate::base::params::Lines3dParams;
use crate::lines::lines3d::{Observation, ProjectedLine, WhitenedObservation, line_frame};

/// Least steps of the adjustment; a good start converges in fewer than ten.
const MOST_STEPS: usize = 10;
/// What of a relation that holds does not: that of true roofs, and of their drawing.
const TOLERANCE: f64 = 0.01;

/// A relation of the sides and corners of a polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Relation {
    /// The corner is square in plan.
    Square(usize),
    /// The side is level.
    Level(usize),
    /// The plane is so steep, as the one across its ridge.
    Slope(f64),
}

/// The kinds of relations, for the trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum CoplanarRelationKind {
    /// A corner is square in plan.
    Square,
    /// A side is level.
    Level,
    /// The slope is that of the plane across the ridge.
    Symmetric,
}

/// A relation that was weighed.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct WeighedRelation {
    /// What is supposed.
    pub kind: CoplanarRelationKind,
    /// The corner, the middle of the side or that of the polygon, metres, local frame.
    pub at: Point3<f64>,
    /// Logarithm of its odds; it is adopted where they are better than even.
    pub nats: f64,
}

/// An image edge of a line on a side.
struct SideEdge<'a> {
    side: usize,
    whitened: WhitenedObservation,
    measured: Observation<'a>,
}

/// A summand of the cost.
enum Term<'a> {
    Edge(Box<SideEdge<'a>>),
    Corner(usize, Point2<f64>),
    Height(Point3<f64>, f64),
    Relation(Relation),
}

/// The polygon with what was measured of it.
pub(super) struct Wireframe<'a> {
    origin: Point2<f64>,
    corners: usize,
    terms: Vec<Term<'a>>,
    loss: f64,
}

/// Plane coefficients, then x and y of each corner.
pub(super) type WireframeState = DVector<f64>;

/// An adjusted state.
pub(super) struct Adjusted {
    pub state: WireframeState,
    /// Inverse of the normal equations.
    pub covariance: DMatrix<f64>,
}

impl<'a> Wireframe<'a> {
    /// Of an outline in a plane: `edges` are the measured edges on a side, `inside` the ends of
    /// lines inside with their standard deviations, metres.
    pub(super) fn new(
        outline: &Outline,
        plane: &UncertainPlane,
        edges: impl IntoIterator<Item = (usize, Observation<'a>)>,
        inside: impl IntoIterator<Item = (Point3<f64>, f64)>,
        params: &Lines3dParams,
    ) -> (Self, WireframeState) {
        let mut terms: Vec<Term> = (edges.into_iter())
            .map(|(side, measured)| SideEdge {
                side,
                whitened: WhitenedObservation::new(&measured, params),
                measured,
            })
            .map(|edge| Term::Edge(Box::new(edge)))
            .collect();
        terms.extend(
            outline
                .corners
                .iter()
                .enumerate()
                .map(|(k, p)| Term::Corner(k, *p)),
        );
        terms.extend(
            inside
                .into_iter()
                .map(|(at, sigma)| Term::Height(at, sigma)),
        );
        let wireframe = Self {
            origin: plane.origin,
            corners: outline.len(),
            terms,
            loss: params.loss_scale,
        };
        let places = outline.corners.iter().flat_map(|p| [p.x, p.y]);
        let state = plane.coefficients.iter().copied().chain(places);
        let state = DVector::from_iterator(3 + 2 * outline.len(), state);
        (wireframe, state)
    }

    /// Corner `k`, counted around, in space.
    fn corner(&self, state: &WireframeState, k: usize) -> Point3<f64> {
        let at = 3 + 2 * (k % self.corners);
        let p = Point2::new(state[at], state[at + 1]);
        let d = p - self.origin;
        Point3::new(p.x, p.y, state[0] + state[1] * d.x + state[2] * d.y)
    }

    /// All corners.
    pub(super) fn ring(&self, state: &WireframeState) -> Vec<Point3<f64>> {
        (0..self.corners).map(|k| self.corner(state, k)).collect()
    }

    /// The plane.
    pub(super) fn plane(&self, state: &WireframeState) -> Plane {
        let normal = Vector3::new(-state[1], -state[2], 1.0);
        let through = Point3::new(self.origin.x, self.origin.y, state[0]);
        Plane::from_point_normal(&through, &normal).expect("z of the normal is 1")
    }

    fn side(&self, state: &WireframeState, k: usize) -> Segment3 {
        Segment3::new(self.corner(state, k), self.corner(state, k + 1))
    }

    /// Root mean square distance (px) of the ends of the measured edges from the images of their
    /// sides, and their number. Robust: an end that is off by more than the loss bears counts as
    /// that much.
    pub(super) fn reprojection(&self, state: &WireframeState) -> (f64, usize) {
        let (mut sum, mut count) = (0.0, 0usize);
        for term in &self.terms {
            let Term::Edge(edge) = term else { continue };
            let o = &edge.measured;
            let Some(image) = ProjectedLine::new(o.camera, &self.side(state, edge.side)) else {
                continue;
            };
            for end in [o.segment.p0, o.segment.p1] {
                let off = image.distance(&end).abs().min(self.loss);
                sum += off * off;
            }
            count += 1;
        }
        ((sum / (2 * count).max(1) as f64).sqrt(), count)
    }

    /// Gauss-Newton from a state; `None` where the measurements leave it undetermined.
    pub(super) fn adjust(&self, start: &WireframeState) -> Option<Adjusted> {
        let mut state = start.clone();
        let (mut cost, mut normal, mut gradient) = self.normal_equations(&state)?;
        for _ in 0..MOST_STEPS {
            let step = normal.clone().cholesky()?.solve(&-&gradient);
            // Halved while it overshoots.
            let tried = [1.0, 0.5, 0.25, 0.125].into_iter().find_map(|share| {
                let next = &state + &step * share;
                let equations = self.normal_equations(&next)?;
                (equations.0 < cost).then_some((next, equations))
            });
            let Some((next, equations)) = tried else {
                break;
            };
            let gain = cost - equations.0;
            state = next;
            (cost, normal, gradient) = equations;
            if gain < 1e-6 * (1.0 + cost) {
                break;
            }
        }
        let covariance = normal.cholesky()?.inverse();
        Some(Adjusted { state, covariance })
    }

    /// Cost, J'WJ and J'Wr with robust weights.
    fn normal_equations(
        &self,
        state: &WireframeState,
    ) -> Option<(f64, DMatrix<f64>, DVector<f64>)> {
        let n = state.len();
        let (mut cost, mut normal) = (0.0, DMatrix::zeros(n, n));
        let mut gradient = DVector::zeros(n);
        for term in &self.terms {
            let (r, rows) = self.linearised(term, state)?;
            let square = r.norm_squared();
            let c2 = self.loss * self.loss;
            let weight = match term {
                Term::Edge(..) => {
                    cost += c2 * ln(1.0 + square / c2);
                    1.0 / (1.0 + square / c2)
                }
                _ => {
                    cost += square;
                    1.0
                }
            };
            for (i, row) in rows.iter().enumerate() {
                for &(u, du) in row {
                    gradient[u] += weight * du * r[i];
                    for &(v, dv) in row {
                        normal[(u, v)] += weight * du * dv;
                    }
                }
            }
        }
        Some((cost, normal, gradient))
    }

    /// The two residuals of a term, in standard deviations, and their derivatives as (unknown,
    /// value); the second is 0 where there is one only.
    fn linearised(&self, term: &Term, state: &WireframeState) -> Option<(Vector2<f64>, [Row; 2])> {
        let none = Row::new();
        Some(match term {
            Term::Edge(edge) => {
                let line = self.side(state, edge.side);
                let across = line_frame(&line.direction());
                let (r, j) = edge.whitened.residual(&line, &across)?;
                let row = |i: usize| {
                    let ends = [0, 1].map(|end| {
                        let by_point =
                            across[0] * j[(2 * end, i)] + across[1] * j[(2 * end + 1, i)];
                        self.through_corner(state, edge.side + end, &by_point)
                    });
                    ends.concat()
                };
                (r, [row(0), row(1)])
            }
            Term::Corner(k, at) => {
                let off = (self.corner(state, *k).xy() - at) / END_M;
                let row = |i: usize| vec![(3 + 2 * k + i, 1.0 / END_M)];
                (off, [row(0), row(1)])
            }
            Term::Height(at, sigma) => {
                let d = at.xy() - self.origin;
                let height = state[0] + state[1] * d.x + state[2] * d.y;
                let row = vec![(0, 1.0 / sigma), (1, d.x / sigma), (2, d.y / sigma)];
                (Vector2::new((height - at.z) / sigma, 0.0), [row, none])
            }
            Term::Relation(relation) => {
                let row = self.derivatives(relation, state);
                let row = row.into_iter().map(|(u, d)| (u, d / TOLERANCE)).collect();
                let value = self.value(relation, state) / TOLERANCE;
                (Vector2::new(value, 0.0), [row, none])
            }
        })
    }

    /// Derivatives by the unknowns of what changes by `by_point` with corner `k`.
    fn through_corner(&self, state: &WireframeState, k: usize, by_point: &Vector3<f64>) -> Row {
        let at = 3 + 2 * (k % self.corners);
        let d = Vector2::new(state[at], state[at + 1]) - self.origin.coords;
        vec![
            (0, by_point.z),
            (1, by_point.z * d.x),
            (2, by_point.z * d.y),
            (at, by_point.x + state[1] * by_point.z),
            (at + 1, by_point.y + state[2] * by_point.z),
        ]
    }

    /// How far a state is from a relation: a cosine, metres of height, metres a metre.
    fn value(&self, relation: &Relation, state: &WireframeState) -> f64 {
        match *relation {
            Relation::Square(k) => {
                let n = self.corners;
                let [a, b, c] = [k + n - 1, k, k + 1].map(|i| self.corner(state, i).xy());
                let (u, v) = (b - a, c - b);
                u.dot(&v) / (u.norm() * v.norm()).max(1e-9)
            }
            Relation::Level(k) => self.corner(state, k + 1).z - self.corner(state, k).z,
            Relation::Slope(of) => state.fixed_rows::<2>(1).norm() - of,
        }
    }

    /// Central differences of a relation by all unknowns.
    fn derivatives(&self, relation: &Relation, state: &WireframeState) -> Row {
        const STEP: f64 = 1e-5;
        let mut at = state.clone();
        let by = |u: usize| {
            at[u] = state[u] + STEP;
            let above = self.value(relation, &at);
            at[u] = state[u] - STEP;
            let below = self.value(relation, &at);
            at[u] = state[u];
            (u, (above - below) / (2.0 * STEP))
        };
        (0..state.len())
            .map(by)
            .filter(|(_, d)| *d != 0.0)
            .collect()
    }

    /// Weighs all relations at an adjusted state, by what it says of their covariance; `slope` is
    /// that of the plane across a ridge.
    pub(super) fn weigh_relations(
        &self,
        adjusted: &Adjusted,
        slope: Option<f64>,
    ) -> Vec<(Relation, WeighedRelation)> {
        let state = &adjusted.state;
        let all = 0..self.corners;
        let squares = all.clone().map(|k| (Relation::Square(k), 2.0, SQUARE));
        let length = |k: usize| self.side(state, k).length();
        let levels = all.map(|k| (Relation::Level(k), length(k), LEVEL));
        let slopes = slope.map(|slope| (Relation::Slope(slope), 2.0, SYMMETRIC));
        let weighed = squares
            .chain(levels)
            .chain(slopes)
            .map(|(relation, range, prior)| {
                let row = self.derivatives(&relation, state);
                let product = |&(u, du): &(usize, f64)| {
                    let of_row = row.iter().map(|&(v, dv)| adjusted.covariance[(u, v)] * dv);
                    du * of_row.sum::<f64>()
                };
                let variance = row.iter().map(product).sum::<f64>() + TOLERANCE * TOLERANCE;
                let nats = relation_nats(self.value(&relation, state), variance, range, prior);
                let (kind, at) = match relation {
                    Relation::Square(k) => (CoplanarRelationKind::Square, self.corner(state, k)),
                    Relation::Level(k) => {
                        (CoplanarRelationKind::Level, self.side(state, k).at(0.5))
                    }
                    Relation::Slope(_) => {
                        let middle = crate::base::geometry::mean_point(&self.ring(state));
                        (CoplanarRelationKind::Symmetric, middle)
                    }
                };
                (relation, WeighedRelation { kind, at, nats })
            });
        weighed.collect()
    }

    /// From now on these relations hold.
    pub(super) fn adopt(&mut self, relations: impl IntoIterator<Item = Relation>) {
        self.terms.extend(relations.into_iter().map(Term::Relation));
    }
}

#[cfg(test)]
impl Wireframe<'_> {
    /// Largest difference between the derivatives of all terms and central differences, as a share
    /// of the largest derivative of the term.
    pub(super) fn worst_derivative(&self, state: &WireframeState) -> f64 {
        const STEP: f64 = 1e-5;
        let mut worst = 0.0f64;
        for term in &self.terms {
            let (_, rows) = self.linearised(term, state).unwrap();
            let largest = (rows.iter().flatten())
                .map(|(_, d)| d.abs())
                .fold(1e-9, f64::max);
            for u in 0..state.len() {
                let moved = |by: f64| {
                    let mut at = state.clone();
                    at[u] += by;
                    self.linearised(term, &at).unwrap().0
                };
                let numeric = (moved(STEP) - moved(-STEP)) / (2.0 * STEP);
                for (i, row) in rows.iter().enumerate() {
                    let own: f64 = row.iter().filter(|(v, _)| *v == u).map(|(_, d)| d).sum();
                    worst = worst.max((own - numeric[i]).abs() / largest);
                }
            }
        }
        worst
    }
}

/// Derivatives by a few unknowns.
type Row = Vec<(usize, f64)>;
