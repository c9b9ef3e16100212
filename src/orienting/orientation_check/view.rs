//! A view as the orientation check sees it: its image, and what the files state about it.

use nalgebra::{Matrix3, Vector3};

use crate::orienting::orientation::{AngleUnit, Crop};
use crate::photographs::camera::Camera;
use crate::photographs::raster::Gray;

/// A view whose orientation is checked.
#[derive(Clone, Debug)]
pub struct CheckedView<'a> {
    /// Name of the view.
    pub name: &'a str,
    /// Camera of the image, local frame.
    pub camera: Camera,
    /// Grey values.
    pub gray: &'a Gray,
    /// Scene origin, which is subtracted in the local frame.
    pub origin: Vector3<f64>,
    /// The rotation angles as the file states them.
    pub angles: Option<[f64; 3]>,
    /// The rotations that the angles mean in each unit, where the file does not state it.
    pub readings: Vec<(AngleUnit, Matrix3<f64>)>,
    /// The part of the frame that the image shows, where the file states it.
    pub crop: Option<Crop>,
}
