//! Segments of images, and lines in space from segments of several views (B99 3).
//!
//! ```text
//! lines2d      segments of one image                              B99 3.2
//! lines3d      one line in space and its covariance               B99 3.2
//! linematch    line tracks over all views                         B99 3.1 to 3.4
//! adjustment   single views adjusted to matched lines
//! ```

pub(crate) mod adjustment;
pub mod linematch;
pub mod lines2d;
pub mod lines3d;
