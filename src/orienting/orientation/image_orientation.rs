//! Interior and exterior orientation of one image, as every reader returns it.

use nalgebra::{Matrix3, Point3};

use super::angles::AngleUnit;
use crate::photographs::camera::Distortion;

/// The orientation of one image as its file states it: a pinhole, perhaps behind a distorting lens.
#[derive(Clone, Debug, PartialEq)]
pub struct Orientation {
    /// Image that it belongs to, as the file names it (with or without folder and extension).
    pub image: String,
    /// The file that it was read from, and its line where there is one: "colmap/images.txt, line
    /// 5".
    pub source: String,
    /// Calibration, pixels of the image, centre of the top-left pixel at (0.5, 0.5).
    pub k: Matrix3<f64>,
    /// Lens distortion, where the file has one.
    pub distortion: Option<Distortion>,
    /// `cam_from_world`, x right, y down, z forward.
    pub r: Matrix3<f64>,
    /// Projection centre, metres, world frame of the file.
    pub center: Point3<f64>,
    /// Width and height of the image in pixels, where the file states them.
    pub size: Option<(u32, u32)>,
    /// Is the principal point in `k` relative to the centre of the image, whose size the file does
    /// not state?
    pub from_middle: bool,
    /// The rotation angles as the file states them, in any unit and order.
    pub angles: Option<[f64; 3]>,
    /// The rotations that the angles mean in each unit, where the file does not state it: then the
    /// images decide, and `r` is the first guess.
    pub readings: Vec<(AngleUnit, Matrix3<f64>)>,
    /// The part of the frame that the image shows, where the file states it.
    pub crop: Option<Crop>,
    /// The chunk or block that it belongs to, where the file holds several orientations of the same
    /// images; the last group in a file is the preferred one.
    pub group: Option<String>,
}

/// The position of an image in the frame that it was cropped from, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crop {
    /// First column.
    pub column: f64,
    /// First row, from the top.
    pub row: f64,
    /// Width and height of the frame.
    pub frame: [f64; 2],
}

/// An orientation of which nothing but the pinhole camera is known.
pub(crate) fn pinhole(
    image: &str,
    source: &str,
    k: Matrix3<f64>,
    r: Matrix3<f64>,
    center: Point3<f64>,
) -> Orientation {
    Orientation {
        image: image.to_owned(),
        source: source.to_owned(),
        k,
        distortion: None,
        r,
        center,
        size: None,
        from_middle: false,
        angles: None,
        readings: Vec::new(),
        crop: None,
        group: None,
    }
}
