//! 3D lines from line tracks, the image edges of several views that show one line (B99 3.2, figure
//! 4).
//!
//! ```text
//! track               the edges of one line in all views, as matching gives them
//!    -> observation   an edge as a whitened residual of the line (offset and angle)
//!    -> plane_intersection    start: where the interpretation planes meet
//!    -> fit           four parameters, least squares with Cauchy's loss, covariance
//!    -> extent        end points: the union of the stretches that the views support
//!    -> reconstruct   the stage: one line for each track, or why there is none
//!
//! line                a reconstructed line, how it was found, why the model leaves it out
//! projection          the exact map between places along a line and image points
//! theta_frame         the sides of a line and the angle of its half-planes (4.1)
//! ```
//!
//! Invariant: a line runs the same way as the stretches of all its supports.

mod extent;
mod fit;
mod line;
mod observation;
mod plane_intersection;
#[cfg(test)]
pub(crate) mod planted;
mod projection;
mod reconstruct;
mod theta_frame;
mod track;

pub(crate) use extent::doubly_covered;
pub use fit::{LineFit, conditioning, fit_line, fit_line_on};
pub use line::{Line3d, LineContradiction, LineOrigin};
pub use observation::{Observation, PlaneConstraint};
pub(crate) use observation::{WhitenedObservation, edge_whitening, line_frame};
pub use plane_intersection::line_of_planes;
pub use projection::ProjectedLine;
pub(crate) use projection::reprojects_onto;
pub use reconstruct::{LineOutcome, LineTrace, reconstruct_lines};
pub use theta_frame::{Side, ThetaFrame};
pub use track::{LineSupport, LineTrack, SupportKind};
