//! Half-planes by homography sweep (B99 4.1).
//!
//! A 3D line leaves one parameter of a plane through it open, the angle theta. Each side of the
//! line is swept apart: the neighbourhood in the most textured view is compared with every other
//! view under the homographies `H(theta)`, and a distinct maximum of `Sim(theta)` makes a
//! half-plane.
//!
//! ```text
//! half_plane    one side of a 3D line, and the plane there
//! poi           points of interest of a view
//! similarity    Sim(theta) of one line side, view by view
//! peak          parabola, uncertainty and acceptance of a maximum
//! posterior     probability density over theta, and of a plane at all (B99 5)
//! trace         the curves of B99 figures 12 and 14, and why a side has no half-plane
//! theta_search  the search over theta
//! sweep_lines   both sides of every line
//! ```
//!
//! Invariant: a side without a half-plane has a reason in the trace.

mod half_plane;
mod peak;
mod poi;
mod posterior;
mod similarity;
mod sweep_lines;
mod theta_search;
mod trace;

pub use half_plane::HalfPlane;
pub(crate) use half_plane::is_wall;
pub use poi::PointsOfInterest;
pub use posterior::Posterior;
pub use sweep_lines::{similarity_curve, sweep_half_planes, sweep_side};
pub use trace::{SideTrace, SimilarityCurve, SweepRejection, SweepTrace, ViewCurve};
