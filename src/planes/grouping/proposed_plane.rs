//! A plane that another source than lines and half-planes proposes.

use nalgebra::{Point2, Point3};
use serde::{Deserialize, Serialize};

use crate::base::geometry::{Plane, depth, mean_point, plan_sides};
use crate::base::ids::ProposalOrigin;
use crate::base::params::RoofParams;

/// A convex polygon in a plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProposedPlane {
    /// Where it comes from.
    pub origin: ProposalOrigin,
    /// The plane.
    pub plane: Plane,
    /// Corners, metres, counter-clockwise seen from above.
    pub ring: Vec<Point3<f64>>,
    /// Are its sides edges of the images? They bound facets then; those of a box around what was
    /// found only where no line lies in the plane.
    pub sides_on_edges: bool,
}

impl ProposedPlane {
    /// The sides in plan, metres.
    pub fn sides(&self) -> impl Iterator<Item = [Point2<f64>; 2]> {
        plan_sides(&self.ring)
    }

    /// Distance of a position from it in plan, metres; 0 inside.
    pub fn distance(&self, p: &Point2<f64>) -> f64 {
        (-depth(self.sides(), p)).max(0.0)
    }

    /// The middle of the corners.
    pub(super) fn middle(&self) -> Point3<f64> {
        mean_point(&self.ring)
    }

    /// Do its corners lie in a plane, as well as the lines of one plane do?
    pub(super) fn lies_in(&self, plane: &Plane, params: &RoofParams) -> bool {
        self.is_parallel(plane, params) && self.ring.iter().all(|p| self.is_near(plane, p, params))
    }

    /// Has a plane about its normal?
    pub(super) fn is_parallel(&self, plane: &Plane, params: &RoofParams) -> bool {
        plane.angle_to(&self.plane) < params.coplanar_angle_deg.to_radians()
    }

    /// Is one of its points as near to a plane as lines of one plane are?
    pub(super) fn is_near(&self, plane: &Plane, p: &Point3<f64>, params: &RoofParams) -> bool {
        plane.signed_distance(p).abs() <= 2.0 * params.coplanar_distance_m
    }

    /// Points all over it.
    pub(super) fn places(&self) -> impl Iterator<Item = Point3<f64>> {
        let middle = self.middle();
        let towards = move |p: &Point3<f64>, share: f64| middle + (p - middle) * share;
        let shares = [0.3, 0.6, 0.9];
        self.ring
            .iter()
            .flat_map(move |p| shares.map(|share| towards(p, share)))
    }
}
