//! Pixel rasters in f32, the filters on them, and photographs from files. Grey values run from 0
//! to 1.
//!
//! ```text
//! load            JPEG (jpeg), PNG and TIFF bytes, whole or one pixel window (window)
//!    -> samples   8 or 16 bits a channel, as stored
//!    -> photograph    colours and grey values
//!
//! gray            a raster of f32: a grey value, or the red-blue difference of a pixel (red_blue)
//! channel         the choice between the two; linear_light undoes the camera's tone curve
//! noise           standard deviation of a pixel
//! bilinear, warp  sub-pixel values, one by one or along the rows of a homography
//! filter, fill    Gaussian blur; polygons into masks and gaps filled smoothly
//! ```
//!
//! Invariant: the centre of the top-left pixel lies at (0.5, 0.5).

mod bilinear;
mod channel;
pub(crate) mod fill;
mod filter;
mod gray;
mod jpeg;
mod linear_light;
mod load;
mod noise;
mod photograph;
mod red_blue;
mod samples;
mod warp;
mod window;

pub use channel::Channel;
pub(crate) use fill::{fill_gaps, mark_inside};
pub use filter::gaussian_blur;
pub use gray::Gray;
pub use load::{ImageHeader, image_format, image_header, load_image};
pub use noise::estimate_noise;
pub use photograph::{Photograph, PixelWindow};
pub use red_blue::RedBlueDifference;
pub use warp::{Outside, Warp, corners};
pub use window::{decoding_bytes, load_window};
