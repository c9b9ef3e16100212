//! Ground control: points with known coordinates give the frame.
//!
//! ```text
//! gcp_list   OpenDroneMap's list
//! geo_list   its list of the photographs' own places
//! system     the first line of both
//! role       what a point is for: control, check, plan or height alone
//! marks      the photographs that a list means, and marks that are in none
//! residual   what is reported of a point
//! fit        the points by their images, and the similarity to their coordinates
//! mistakes   usual mistakes of lists, and the list as it was meant
//! placing    which reading of a list can be true, and the frame by it
//! ```

mod fit;
mod gcp_list;
mod geo_list;
mod marks;
mod mistakes;
mod placing;
mod residual;
mod role;
mod system;
#[cfg(test)]
mod tests;

pub(super) use fit::{MARK_SIGMA_PX, rms_m};
pub use gcp_list::{ControlPoint, GroundControl};
pub use geo_list::GeoList;
pub(super) use geo_list::GeoPlace;
pub(super) use placing::{Beside, to_control};
pub use residual::ControlResidual;
pub use role::Role;
