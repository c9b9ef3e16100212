//! Photographs from the bytes of files.
//!
//! ```text
//! excerpt         a file, or the pieces of it that are in memory
//! unread          what cannot be read, by name
//! needed          which ranges of a file are needed
//! load, window    a whole photograph, or one pixel window of it
//!    jpeg, tiff   PNG is left to crate `image`
//! samples         8 or 16 bits a channel, as stored, and the photograph they make
//! ```

mod excerpt;
mod jpeg;
mod load;
mod needed;
mod samples;
mod tiff;
mod unread;
mod window;

pub use excerpt::{Excerpt, Piece};
pub use load::{ImageHeader, image_format, image_header, load_image};
pub(crate) use needed::window_ranges;
pub use needed::{HeaderNeeds, header_needs};
pub use tiff::Bands;
pub(crate) use tiff::{Directory, NumberRaster, is_height_raster, is_tiff, tags as tiff_tags};
pub use unread::{UnreadImageFormat, unread_image_format};
pub use window::{decoding_bytes, load_window};
