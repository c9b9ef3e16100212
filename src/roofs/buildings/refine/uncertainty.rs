//! Standard deviations of planes, corners and sides from the covariance of the adjustment.
//!
//! ```text
//! C = s^2 (A' W A)^-1,    sigma^2 of any f(x) = g' C g,    g = df/dx
//! ```
//!
//! with s^2 by how much the residuals scatter more than they should. What is stated is inflated to
//! the errors that were measured on scenes with truth ([`UncertaintyTable`]).

use std::collections::BTreeSet;

use nalgebra::{DVector, Point2, Vector2, Vector3};

use super::adjust::{AdjustmentProblem, Solution, Term};
use super::wireframe::{Wireframe, WireframeState};
use crate::base::evidence::{Inflation, UncertaintyTable};
use crate::base::geometry::signed_area;
use crate::base::math::median;
use crate::roofs::model::{CornerUncertainty, FacetUncertainty, SideSupport, SideUncertainty};

/// The uncertainty of every facet of a solved problem; sides rest on the edges measured for it.
pub(super) fn uncertainty_of(
    problem: &AdjustmentProblem,
    solution: &Solution,
) -> Vec<FacetUncertainty> {
    let supports = supports_of(problem, &solution.state);
    uncertainty_on(problem, solution, &supports)
}

/// The uncertainty of every facet of a solved problem, of which is known what the sides rest on: a
/// list for each facet.
pub(super) fn uncertainty_on(
    problem: &AdjustmentProblem,
    solution: &Solution,
    supports: &[Vec<SideSupport>],
) -> Vec<FacetUncertainty> {
    let (w, state) = (problem.wireframe, &solution.state);
    let place = w.corner(state, 0, w.faces[0][0][0]);
    let pixels = problem
        .scene
        .views
        .iter()
        .map(|v| v.camera.ground_pixel(&place));
    let pixel_m = median(&mut pixels.collect::<Vec<_>>()).unwrap_or(0.0);
    of_facets(w, solution, pixel_m, UncertaintyTable::fitted(), supports)
}

/// What every side of every facet rests on, by the edges that were measured.
fn supports_of(problem: &AdjustmentProblem, state: &WireframeState) -> Vec<Vec<SideSupport>> {
    let w = problem.wireframe;
    let mut views = vec![BTreeSet::new(); w.sides.len()];
    for term in &problem.terms {
        if let Term::Edge(edge) = term {
            views[edge.side].insert(edge.view);
        }
    }
    let support = |face: usize, ends: [usize; 2]| {
        let covering = (0..w.sides.len()).filter(|&side| w.covers(state, &w.sides[side], ends));
        match covering.map(|side| views[side].len()).max() {
            Some(3..) => SideSupport::Edges,
            Some(1 | 2) => SideSupport::FewEdges,
            _ if w.is_crease(face, ends) => SideSupport::Planes,
            _ => SideSupport::Nothing,
        }
    };
    (0..w.faces.len())
        .map(|face| w.ring_sides(face).map(|ends| support(face, ends)).collect())
        .collect()
}

/// The uncertainty of every facet of an adjusted wireframe; `pixel_m` is a ground pixel.
fn of_facets(
    w: &Wireframe,
    solution: &Solution,
    pixel_m: f64,
    table: &UncertaintyTable,
    supports: &[Vec<SideSupport>],
) -> Vec<FacetUncertainty> {
    let covariance = Covariance {
        w,
        solution,
        pixel_m,
        table,
    };
    let in_plan: Vec<Vector2<f64>> = (0..w.vertices).map(|v| covariance.in_plan(v)).collect();
    (0..w.faces.len())
        .map(|face| FacetUncertainty {
            sides: covariance.of_sides(face, &supports[face]),
            ..covariance.of_facet(face, &in_plan)
        })
        .collect()
}

struct Covariance<'a> {
    w: &'a Wireframe,
    solution: &'a Solution<'a>,
    pixel_m: f64,
    table: &'a UncertaintyTable,
}

/// Slopes below this have no steepest direction, metres of height per metre.
const LEVEL: f64 = 1e-3;

impl Covariance<'_> {
    /// Standard deviation of a function with this gradient: unknowns and derivatives.
    fn sigma(&self, gradient: &[(usize, f64)]) -> f64 {
        let mut full = DVector::zeros(self.w.size());
        for &(unknown, derivative) in gradient {
            full[unknown] += derivative;
        }
        full.dot(&self.solution.spread(&full)).max(0.0).sqrt()
    }

    fn in_plan(&self, vertex: usize) -> Vector2<f64> {
        Vector2::new(2 * vertex, 2 * vertex + 1).map(|unknown| {
            let sigma = self.sigma(&[(unknown, 1.0)]);
            self.table.corner_plan.of(sigma, self.pixel_m)
        })
    }

    fn of_facet(&self, face: usize, in_plan: &[Vector2<f64>]) -> FacetUncertainty {
        let (w, state) = (self.w, &self.solution.state);
        let plane = w.plane_at(face);
        let slope = Vector2::new(state[plane], state[plane + 1]);
        let height = |p: &Point2<f64>| {
            let d = p - w.origin;
            [(plane, d.x), (plane + 1, d.y), (plane + 2, 1.0)]
        };
        let corners: Vec<CornerUncertainty> = (w.faces[face].iter().flatten())
            .map(|&v| {
                let at = w.corner(state, face, v);
                let moved = [(2 * v, slope.x), (2 * v + 1, slope.y)];
                let z = self.sigma(&[&height(&at.xy())[..], &moved].concat());
                let z = self.table.corner_height.of(z, self.pixel_m);
                CornerUncertainty {
                    at,
                    sigma_m: Vector3::new(in_plan[v].x, in_plan[v].y, z),
                }
            })
            .collect();
        let outer = &w.faces[face][0];
        let sum = (outer.iter()).fold(Vector2::zeros(), |s, &v| s + w.position(state, v).coords);
        let middle = Point2::from(sum / outer.len().max(1) as f64);
        let steepest = match slope.norm() > LEVEL {
            true => slope.normalize(),
            false => Vector2::x(),
        };
        let tangent = self.sigma(&[(plane, steepest.x), (plane + 1, steepest.y)]);
        let table = self.table;
        // d atan(s) = ds / (1 + s^2).
        let slope_rad = tangent / (1.0 + slope.norm_squared());
        let area = signed_area(outer.iter().map(|&v| w.position(state, v))).abs();
        let pixel_rad = self.pixel_m / area.max(1e-6).sqrt();
        FacetUncertainty {
            height_m: table.height.of(self.sigma(&height(&middle)), self.pixel_m),
            slope_deg: table.slope.of(slope_rad, pixel_rad).to_degrees(),
            corners,
            sides: Vec::new(),
        }
    }

    fn of_sides(&self, face: usize, supports: &[SideSupport]) -> Vec<SideUncertainty> {
        let (w, state) = (self.w, &self.solution.state);
        let sides = w.ring_sides(face).zip(supports);
        let of_side = |(ends, &support): ([usize; 2], &SideSupport)| {
            let places = ends.map(|v| w.position(state, v));
            let along = places[1] - places[0];
            let across = Vector2::new(-along.y, along.x).try_normalize(0.0);
            // Of its middle: half of each end.
            let half = across.unwrap_or_else(Vector2::x) / 2.0;
            let [u, v] = ends.map(|v| [(2 * v, half.x), (2 * v + 1, half.y)]);
            let sigma = self.sigma(&[u, v].concat());
            SideUncertainty {
                ends: places,
                sigma_m: inflation_of(self.table, support).of(sigma, self.pixel_m),
                support,
            }
        };
        sides.map(of_side).collect()
    }
}

fn inflation_of(table: &UncertaintyTable, support: SideSupport) -> &Inflation {
    match support {
        SideSupport::Edges => &table.sides.edges,
        SideSupport::FewEdges => &table.sides.few_edges,
        SideSupport::Planes => &table.sides.planes,
        SideSupport::Nothing => &table.sides.nothing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::params::RefineParams;
    use crate::orienting::synthetic::gable_scene;
    use nalgebra::Point3;

    #[test]
    fn what_is_planted_of_corners_and_heights_comes_back() {
        const SIDE: f64 = 8.0;
        const SIGMA: f64 = 0.1;
        let (scene, _) = gable_scene(64);
        let ring = [(0.0, 0.0), (SIDE, 0.0), (SIDE, SIDE), (0.0, SIDE)];
        let roof = crate::roofs::testing::facet(&ring.map(|(x, y)| Point3::new(x, y, 5.0)));
        let (w, state) = Wireframe::new(&[&roof]);
        let params = RefineParams::default();
        let mut problem = AdjustmentProblem::new(&scene, &w, &state, Vec::new(), &params);
        problem.terms.extend(ring.map(|(x, y)| Term::Height {
            face: 0,
            at: Point2::new(x, y),
            z: 5.0,
            sigma_m: SIGMA,
        }));
        let pattern = problem.pattern();
        let solution = problem
            .unsolved(&state, &pattern)
            .expect("a regular matrix");
        let table = UncertaintyTable::as_adjusted();
        let supports = supports_of(&problem, &state);
        let known = of_facets(&w, &solution, 0.1, &table, &supports).remove(0);
        // The mean of four heights, and the slope of a line through two times two.
        assert!((known.height_m - SIGMA / 2.0).abs() < 1e-9);
        assert!((known.slope_deg - (SIGMA / SIDE).to_degrees()).abs() < 1e-9);
        assert_eq!(known.corners.len(), 4);
        for corner in &known.corners {
            let plan = params.vertex_sigma_m;
            let distance = |axis: usize| (corner.sigma_m[axis] - plan).abs();
            assert!(distance(0) < 1e-9 && distance(1) < 1e-9);
            // Of the plane at its corner: 1/4 + 1/4 + 1/4 of the variance of one height.
            assert!((corner.sigma_m.z - SIGMA * 0.75f64.sqrt()).abs() < 1e-9);
        }
    }

    #[test]
    fn the_end_of_a_ridge_is_as_high_on_both_slopes() {
        let (scene, _) = gable_scene(64);
        let slope = |corners: [(f64, f64, f64); 4]| {
            crate::roofs::testing::facet(&corners.map(|(x, y, z)| Point3::new(x, y, z)))
        };
        let west = [
            (0.0, 0.0, 5.0),
            (4.0, 0.0, 7.0),
            (4.0, 9.0, 7.0),
            (0.0, 9.0, 5.0),
        ];
        let east = [
            (4.0, 0.0, 7.0),
            (7.0, 0.0, 5.0),
            (7.0, 9.0, 5.0),
            (4.0, 9.0, 7.0),
        ];
        let roof = [west, east].map(slope);
        let (w, state) = Wireframe::new(&[&roof[0], &roof[1]]);
        let params = RefineParams::default();
        let mut problem = AdjustmentProblem::new(&scene, &w, &state, Vec::new(), &params);
        for (face, ring) in [west, east].into_iter().enumerate() {
            problem.terms.extend(ring.map(|(x, y, z)| Term::Height {
                face,
                at: Point2::new(x, y),
                z,
                sigma_m: 0.1 + 0.1 * face as f64,
            }));
        }
        let pattern = problem.pattern();
        let solution = problem.unsolved(&state, &pattern).expect("regular");
        let table = UncertaintyTable::as_adjusted();
        let supports = supports_of(&problem, &state);
        let known = of_facets(&w, &solution, 0.1, &table, &supports);
        for ridge_end in [Point3::new(4.0, 0.0, 7.0), Point3::new(4.0, 9.0, 7.0)] {
            let [a, b] = [0, 1].map(|i| known[i].at(&ridge_end).expect("corners").z);
            assert!((a - b).abs() < 1e-3 && a > 0.03, "{a} {b}");
        }
    }
}
