//! Half-planes by homography sweep (B99 4.1).

mod peak;
mod poi;
mod posterior;
mod similarity;
mod sweep_lines;
mod theta_search;
mod trace;

pub use poi::PointsOfInterest;
pub use posterior::Posterior;
pub use sweep_lines::{similarity_curve, sweep_half_planes, sweep_side};
pub use trace::{SideTrace, SimilarityCurve, SweepRejection, SweepTrace, ViewCurve};
