//! From 3D lines to facets (B99 4): half-planes by homography sweep (4.1), grouping (4.2),
//! delineation and verification (4.3).
//!
//! A 3D line leaves one parameter of a plane through it open, the angle theta. Each side of the line is
//! swept apart: the neighbourhood in the most textured view is compared with every other view under the
//! homographies `H(theta)`, and a distinct maximum of `Sim(theta)` makes a half-plane. Half-planes and lines are
//! then grouped into planes, and the planes compete for the cells into which all border lines cut the plan.
//!
//! ```text
//! 4.1  poi            points of interest of a view
//!      strip          the neighbourhood of a line side, and how a view is warped into it
//!      windows        correlations of all windows of two strips by running sums
//!      similarity     Sim(theta) of one line side, view by view
//!      peak           parabola, uncertainty and acceptance of a maximum
//!      posterior      probability density over theta, and of a plane at all (B99 5)
//!      sweep          the search over theta
//!      trace          what the page draws (B99 figures 12 and 14)
//! 4.2  neighbourhood  Delaunay triangulation constrained to the projected lines
//!      grouping       collinear and coplanar grouping (figures 16 to 18)
//!      line_pairs     planes of two lines without a half-plane
//!      repeated       half-planes that repeat a plane next to them, where texture is weak
//!      proposed       planes of the other method beside the groups
//!      region         the part of the plan that a group may cover
//!      plane_lines    new lines in a plane from segments of several views
//!      bounding       which real lines may bound a facet
//!      borders        border lines, new lines by plane intersection (figures 19 to 22)
//!      extent         closing lines where the views cease to agree on a plane
//! 4.3  arrangement    the plan cut into cells by the border lines
//!      box_sum        sums over windows
//!      agreement      correlations of several views of a plane by running sums
//!      consistency    similarity of a plane over the complete image set
//!      hypothesis     planes with their regions, similarity and lines, ready to compete
//!      shiftable      windows that stay on one side of a line
//!      evidence       what images and lines say for each plane over each cell
//!      line_index     which real lines run along a border
//!      border_cost    what a border between two planes costs
//!      labelling      conflicts: which plane covers which cell
//!      cut            one step of it: the best of all moves to one plane
//!      flow           the maximum flow behind it
//!      islands        patches too small to be a facet or a hole
//!      delineation    closed outlines
//!      interior       what the inside of a facet shows, away from its edges
//!      prominence     the facet against its own plane moved up and down
//!      vegetation     how green a facet is
//!      verification   what a facet must show to stay
//!      overreach      what it covers beyond a line that bounds it
//!      facets         the labelling on its way to facets; orders 4.2 and 4.3
//! ```

mod agreement;
mod alone;
mod arrangement;
mod border_cost;
mod borders;
mod bounding;
mod box_sum;
mod consistency;
mod cut;
mod delineation;
mod evidence;
mod extent;
mod facets;
#[cfg(test)]
mod fixture;
mod flow;
mod grouping;
mod hypothesis;
mod interior;
mod islands;
mod labelling;
mod line_index;
mod line_pairs;
mod neighbourhood;
mod overreach;
mod peak;
mod plan;
mod plane_lines;
mod poi;
mod posterior;
mod prominence;
mod proposed;
mod region;
mod repeated;
mod shiftable;
mod similarity;
mod strip;
mod sweep;
mod trace;
mod vegetation;
mod verification;
mod windows;

pub use borders::{Border, BorderKind};
pub(crate) use consistency::least_overall;
pub use consistency::{ConsistencyMap, consistency_map, consistency_map_behind};
pub use facets::{FacetTrace, reconstruct_facets};
pub use grouping::{Member, PlaneGroup};
pub use plan::{PlanGrid, image_from_plan, orthophoto};
pub use plane_lines::PlaneLine;
pub use poi::PointsOfInterest;
pub use posterior::Posterior;
pub use proposed::ProposedPlane;
pub use sweep::{similarity_curve, sweep_half_planes, sweep_side};
pub use trace::{SideTrace, SimilarityCurve, SweepRejection, SweepTrace, ViewCurve};
pub use verification::{FacetRejection, RejectedFacet};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::geometry::{Plane, Segment3};
use crate::ids::{LineId, ViewId};

/// Which side of a directed 3D line, seen from above with Z towards the eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// To the left of the direction from `p0` to `p1`.
    Left,
    /// To the right.
    Right,
}

/// The frame in which theta is measured about a 3D line: `direction`, `outward` (horizontal, away from the
/// line to the chosen side) and `up` (perpendicular to both, upwards). theta = 0 is the half-plane
/// through `outward` (horizontal for a horizontal line); it rises away from the line for theta > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThetaFrame {
    /// Unit direction of the line.
    pub direction: Vector3<f64>,
    /// Horizontal unit vector across the line, to the side.
    pub outward: Vector3<f64>,
    /// Unit vector perpendicular to both, pointing up.
    pub up: Vector3<f64>,
}

impl ThetaFrame {
    /// The frame of one side of a line; `None` for a line that is vertical within about half a degree.
    pub fn new(line: &Segment3, side: Side) -> Option<Self> {
        let direction = line.direction();
        let left = Vector3::z().cross(&direction);
        // |z x d| is the sine of the angle to the vertical.
        if left.norm() < 0.01 {
            return None;
        }
        let outward = match side {
            Side::Left => left.normalize(),
            Side::Right => -left.normalize(),
        };
        let up = direction.cross(&outward);
        Some(Self {
            direction,
            outward,
            up: if up.z < 0.0 { -up } else { up },
        })
    }

    /// Unit vector in the half-plane at `theta` (radians), perpendicular to the line, away from it.
    pub fn away(&self, theta: f64) -> Vector3<f64> {
        let (s, c) = crate::math::sin_cos(theta);
        self.outward * c + self.up * s
    }

    /// The plane through the line at `theta` (radians), oriented upwards.
    pub fn plane(&self, line: &Segment3, theta: f64) -> Plane {
        let normal = self.direction.cross(&self.away(theta));
        Plane::from_point_normal(&line.p0, &normal)
            .expect("direction and away are perpendicular")
            .upwards()
    }

    /// The theta (radians, -pi/2 to pi/2) of a plane that contains the line approximately.
    pub fn theta_of(&self, plane: &Plane) -> f64 {
        let mut away = plane.normal.cross(&self.direction);
        if away.dot(&self.outward) < 0.0 {
            away = -away;
        }
        crate::math::atan2(away.dot(&self.up), away.dot(&self.outward))
    }
}

/// Is the plane too steep for a roof (75 degrees, the interval of B99 figure 15)?
fn is_wall(plane: &Plane) -> bool {
    /// The normal's z.
    const STEEPEST: f64 = 0.26;
    plane.normal.z < STEEPEST
}

/// A half-plane attached to one side of a 3D line, with what Sim(theta) looked like.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HalfPlane {
    /// The line.
    pub line: LineId,
    /// Which side of it.
    pub side: Side,
    /// Angle of the maximum, radians, see [`ThetaFrame`].
    pub theta: f64,
    /// Standard deviation of theta, radians.
    pub sigma_theta: f64,
    /// `Sim(theta_max)`, 0 to 1.
    pub similarity: f64,
    /// `|Sim''(theta_max)|`, per radian squared (B99 figure 12).
    pub curvature: f64,
    /// `Sim(theta_max) - Sim(theta_min)`.
    pub amplitude: f64,
    /// Posterior probability that there is a plane at theta, 0 to 1.
    pub probability: f64,
    /// The valid views.
    pub views: Vec<ViewId>,
    /// The plane at theta, oriented upwards.
    pub plane: Plane,
}

impl HalfPlane {
    /// Have views shown it? Otherwise it repeats the plane of a neighbour.
    fn is_swept(&self) -> bool {
        !self.views.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn theta_of_inverts_plane() {
        let line = Segment3::new(Point3::new(1.0, 2.0, 3.0), Point3::new(5.0, 4.0, 3.5));
        for side in [Side::Left, Side::Right] {
            let frame = ThetaFrame::new(&line, side).unwrap();
            for theta in [-1.2, -0.3, 0.0, 0.5, 1.2] {
                let plane = frame.plane(&line, theta);
                assert!((frame.theta_of(&plane) - theta).abs() < 1e-9);
                assert!(plane.signed_distance(&line.p1).abs() < 1e-9);
                let beyond = line.p0 + frame.away(theta) * 2.0;
                assert!(plane.signed_distance(&beyond).abs() < 1e-9);
                let left = Vector3::z()
                    .cross(&frame.direction)
                    .dot(&(beyond - line.p0))
                    > 0.0;
                assert_eq!(left, side == Side::Left);
                assert!((frame.away(theta).z > 0.0) == (theta > 0.0) || theta == 0.0);
            }
        }
    }

    #[test]
    fn walls_are_steeper_than_75_degrees() {
        let inclined = |degrees: f64| {
            let (s, c) = crate::math::sin_cos(degrees.to_radians());
            Plane {
                normal: Vector3::new(s, 0.0, c),
                d: 0.0,
            }
        };
        assert!(!is_wall(&inclined(74.0)));
        assert!(is_wall(&inclined(76.0)));
    }

    #[test]
    fn vertical_lines_have_no_frame() {
        let line = Segment3::new(Point3::new(1.0, 2.0, 3.0), Point3::new(1.0, 2.0, 9.0));
        assert!(ThetaFrame::new(&line, Side::Left).is_none());
    }
}
