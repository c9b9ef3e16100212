//! A view and its image before the pixels are decoded.

use nalgebra::Matrix3;

use crate::camera::{Camera, Distortion};
use crate::error::Error;
use crate::orientation::{AngleUnit, Crop, Orientation};
use crate::raster::{ImageHeader, Turn};

/// An image and the orientation found for it.
pub(crate) struct PlannedImage {
    pub file: usize,
    pub header: Option<ImageHeader>,
    /// Why there is no header.
    pub unreadable: Option<Error>,
    pub orientation: Option<Orientation>,
}

/// A view before its pixels are decoded.
pub(crate) struct PlannedView {
    pub file: usize,
    /// The name that it goes by: that of the file, with folders where names repeat.
    pub name: String,
    /// Camera of the whole image, local frame.
    pub whole: Camera,
    pub distortion: Option<Distortion>,
    /// The rotation angles as the file states them, and the crop of the image in its frame.
    pub angles: Option<[f64; 3]>,
    /// The rotations that the angles mean in each unit, where the file does not state it.
    pub readings: Vec<(AngleUnit, Matrix3<f64>)>,
    pub crop: Option<Crop>,
    /// Column, row, width, height of the part that is used; the whole image when absent.
    pub part: Option<[u32; 4]>,
    /// How the stored pixels are turned first.
    pub turn: Option<Turn>,
}

impl PlannedView {
    /// Number of pixels of the part that is used.
    pub(crate) fn pixels(&self) -> u64 {
        let [_, _, width, height] =
            self.part
                .unwrap_or([0, 0, self.whole.width, self.whole.height]);
        u64::from(width) * u64::from(height)
    }

    /// The camera of the part that is used.
    pub(crate) fn camera(&self) -> Camera {
        let mut camera = self.whole.clone();
        if let Some([column, row, width, height]) = self.part {
            camera.k = offset_calibration(&camera.k, [column, row]);
            (camera.width, camera.height) = (width, height);
        }
        camera
    }
}

/// The calibration of a part that begins at this column and row.
pub(crate) fn offset_calibration(k: &Matrix3<f64>, [column, row]: [u32; 2]) -> Matrix3<f64> {
    let mut k = *k;
    k[(0, 2)] -= f64::from(column);
    k[(1, 2)] -= f64::from(row);
    k
}
