//! A view and its image before the pixels are decoded.

use nalgebra::{Matrix3, Vector3};

use super::checks::camera_checks;
use crate::base::error::{Error, Result};
use crate::base::math::{larger, smaller};
use crate::orienting::orientation::{AngleUnit, Crop, Orientation};
use crate::orienting::orientation_check::CheckedView;
use crate::orienting::scene::View;
use crate::photographs::camera::{Camera, Distortion};
use crate::photographs::raster::{ImageHeader, PixelWindow, Turn};

/// Images and parts of them keep so many pixels along a side, to be matched. Assumption.
pub(super) const SMALLEST_SIDE_PX: u32 = 64;

/// An image and the orientation found for it.
pub(crate) struct PlannedImage {
    pub file: usize,
    pub header: Option<ImageHeader>,
    /// Why there is no header.
    pub unreadable: Option<Error>,
    pub orientation: Option<Orientation>,
}

/// A view before its pixels are decoded.
#[derive(Clone)]
pub(crate) struct PlannedView {
    pub file: usize,
    /// The name that it goes by: that of the file, with folders where names repeat.
    pub name: String,
    /// Width and height of the whole image as it is, turned.
    pub size: [u32; 2],
    /// By what factor it is reduced; all that follows is in the pixels of the reduced image.
    pub reduction: f64,
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

    /// What the orientation check needs of the view that was decoded by this plan.
    pub(crate) fn checked<'a>(&self, view: &'a View, origin: Vector3<f64>) -> CheckedView<'a> {
        CheckedView {
            name: &view.name,
            camera: view.camera.clone(),
            gray: &view.gray,
            origin,
            angles: self.angles,
            readings: self.readings.clone(),
            // The crop that the file states is that of the whole image.
            crop: self.crop.filter(|_| self.part.is_none()),
        }
    }

    /// The view of an image that is reduced by a factor more. What is left over of a pixel is
    /// dropped; the corner of the image is that of its first pixel, so that coordinates are
    /// divided.
    pub(crate) fn reduce(&mut self, factor: f64) {
        let smallest = self.whole.width.min(self.whole.height);
        let most = f64::from(smallest) / f64::from(SMALLEST_SIDE_PX);
        let factor = larger(smaller(factor, most), 1.0);
        let by = 1.0 / factor;
        self.reduction *= factor;
        self.whole.k = Matrix3::from_diagonal(&Vector3::new(by, by, 1.0)) * self.whole.k;
        [self.whole.width, self.whole.height] = self
            .size
            .map(|side| (f64::from(side) / self.reduction) as u32);
        self.crop = self.crop.map(|crop| Crop {
            column: crop.column * by,
            row: crop.row * by,
            frame: crop.frame.map(|side| side * by),
        });
    }

    /// The pixels of the whole image as it is that a window of the reduced one covers.
    pub(crate) fn unreduced(&self, [column, row, width, height]: PixelWindow) -> PixelWindow {
        let range = |from: u32, count: u32, side: u32| {
            let first = (f64::from(from) * self.reduction) as u32;
            let end = (f64::from(from + count) * self.reduction).ceil() as u32;
            [first, end.min(side) - first]
        };
        let [x0, width] = range(column, width, self.size[0]);
        let [y0, height] = range(row, height, self.size[1]);
        [x0, y0, width, height]
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

/// The camera of a whole image in the world of its orientation file, after the checks that need no
/// other view.
pub(super) fn planned_view(
    path: &str,
    file: usize,
    header: &ImageHeader,
    orientation: &Orientation,
) -> Result<PlannedView> {
    let refuse = |problem: String, advice: &str| Error::file(path, problem, advice);
    let turn = turn_of(header, orientation);
    let (width, height) = shown_size(header, turn);
    if let Some((w, h)) = orientation.size.filter(|&size| size != (width, height)) {
        return Err(refuse(
            format!(
                "the image has {width} x {height} pixels, but its orientation ({}) is for {w} x {h}",
                orientation.source
            ),
            "use the images in the size that was oriented, or scale the orientation to this one",
        ));
    }
    let mut camera = camera_of(orientation, width, height);
    if let Some(problem) = camera_checks::numeric_problem(&camera) {
        return Err(refuse(
            format!(
                "its orientation ({}) is impossible: {problem}",
                orientation.source
            ),
            "correct the numbers of this image, or leave it out",
        ));
    }
    let mut distortion = orientation.distortion;
    if let Some(lens) = &mut distortion {
        (camera.k, *lens) = pinhole_of(lens, &camera).map_err(|problem| {
            refuse(
                format!("the lens distortion in {} {problem}", orientation.source),
                "check the order and the signs of the coefficients, or undistort the images",
            )
        })?;
    }
    Ok(PlannedView {
        file,
        name: String::new(),
        size: [width, height],
        reduction: 1.0,
        whole: camera,
        distortion,
        angles: orientation.angles,
        readings: orientation.readings.clone(),
        crop: orientation.crop,
        part: None,
        turn,
    })
}

fn camera_of(orientation: &Orientation, width: u32, height: u32) -> Camera {
    let mut k = orientation.k;
    if orientation.from_middle {
        k[(0, 2)] += f64::from(width) / 2.0;
        k[(1, 2)] += f64::from(height) / 2.0;
    }
    Camera {
        k,
        r: orientation.r,
        center: orientation.center,
        width,
        height,
    }
}

/// The calibration of the pinhole that a photograph is resampled to, and the lens seen from it; or
/// what is wrong with the lens.
fn pinhole_of(
    lens: &Distortion,
    camera: &Camera,
) -> std::result::Result<(Matrix3<f64>, Distortion), &'static str> {
    let Camera {
        k, width, height, ..
    } = camera;
    match lens.is_fisheye() {
        true => lens.rectified(k, *width, *height),
        false if lens.is_plausible(k, *width, *height) => Ok((*k, *lens)),
        false => Err("folds the image over"),
    }
}

/// The quarter turn after which the image has the size that its orientation states.
///
/// Some programs orient the pixels as stored, others turn them first. Where width and height are
/// exchanged between orientation and file, and the EXIF header asks for a quarter turn, the second
/// is certain; half a turn leaves the size as it is, and the pixels are taken as stored.
fn turn_of(header: &ImageHeader, orientation: &Orientation) -> Option<Turn> {
    let stored = (header.width, header.height);
    let shown = (header.height, header.width);
    let is_exchanged = orientation.size == Some(shown) && stored != shown;
    Turn::from_exif(header.orientation).filter(|_| is_exchanged)
}

/// Width and height of the image as its orientation describes it.
fn shown_size(header: &ImageHeader, turn: Option<Turn>) -> (u32, u32) {
    match turn {
        Some(_) => (header.height, header.width),
        None => (header.width, header.height),
    }
}
