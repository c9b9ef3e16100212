//! Ground control: points with known coordinates give the frame.
//!
//! ```text
//! gcp_list   OpenDroneMap's list
//! residual   what is reported of a point
//! fit        the points by their images, and the similarity to their coordinates
//! ```

mod fit;
mod gcp_list;
mod residual;

pub(super) use fit::{MARK_SIGMA_PX, to_control};
pub use gcp_list::{ControlPoint, GroundControl};
pub use residual::ControlResidual;
