//! Pixel rasters in f32, the filters on them, and photographs from files. Grey values run from 0
//! to 1.
//!
//! ```text
//! files           JPEG, PNG and TIFF bytes, whole or one pixel window
//!    -> photograph    colours and grey values
//! turn            a photograph as its EXIF header wants it shown
//!
//! gray            a raster of f32: a grey value, or the red-blue difference of a pixel (red_blue)
//! channel         the choice between the two; linear_light undoes the camera's tone curve
//! coverage        smaller images, each pixel the mean of what it covers
//! noise           standard deviation of a pixel
//! bilinear, warp  sub-pixel values, one by one or along the rows of a homography; colour likewise
//! filter, fill    Gaussian blur; polygons into masks and gaps filled smoothly
//! ```
//!
//! Invariant: the centre of the top-left pixel lies at (0.5, 0.5).

mod bilinear;
mod channel;
mod colour;
mod coverage;
mod files;
pub(crate) mod fill;
mod filter;
mod gray;
mod linear_light;
mod noise;
mod photograph;
mod red_blue;
mod turn;
mod warp;

pub use channel::Channel;
pub(crate) use colour::colour_at;
pub(crate) use coverage::{Coverage, colours_of_blocks, reduced_gray};
pub use files::{
    Bands, Excerpt, HeaderNeeds, ImageHeader, Piece, UnreadImageFormat, decoding_bytes,
    header_needs, image_format, image_header, load_image, load_window, unread_image_format,
};
pub(crate) use files::{
    Directory, NumberRaster, is_height_raster, is_tiff, tiff_tags, window_ranges,
};
pub(crate) use fill::{fill_gaps, mark_inside};
pub use filter::gaussian_blur;
pub use gray::Gray;
pub use noise::estimate_noise;
pub use photograph::{Photograph, PixelWindow};
pub use red_blue::RedBlueDifference;
pub use turn::Turn;
pub use warp::{Outside, Warp, corners};
