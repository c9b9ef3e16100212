//! Orientation files: recognised by what stands in them, read into one form.
//!
//! | format | files | conventions that are converted here |
//! |---|---|---|
//! | COLMAP text | `cameras.txt` + `images.txt` | none: `x_cam = R X + t`, centre of the top-left pixel (0.5, 0.5) |
//! | photogrammetric list | camera + exterior | omega, phi, kappa; mm from the frame's centre, y up; crops |
//! | projection matrices | one `.P` per image | 3 x 4 up to scale and sign; centre of the top-left pixel (0, 0) |
//!
//! Where a scene holds its orientation more than once, the first in this order is taken: COLMAP
//! carries lens and size with it, the list carries the size, a bare matrix neither.
//!
//! Invariant: a reader takes any bytes and returns an orientation or a readable error; it holds no more
//! memory than a small multiple of its input.

mod angles;
mod colmap;
mod detect;
mod photogrammetric;
mod projection;
mod text;

pub use angles::{AngleUnit, omega_phi_kappa_from_rotation, rotation_from_omega_phi_kappa};
pub use detect::{FileKind, detect};

use nalgebra::{Matrix3, Point3};
use serde::Serialize;

use crate::Result;
use crate::camera::Distortion;
use crate::scene_loader::InputFile;

/// The supported formats, in the order in which they are preferred.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// COLMAP's text model.
    Colmap,
    /// Camera file and list of X Y Z omega phi kappa.
    Photogrammetric,
    /// VGG's 3 x 4 matrices.
    Projection,
}

impl Format {
    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Colmap => "COLMAP text model",
            Self::Photogrammetric => "photogrammetric list",
            Self::Projection => "projection matrices (.P)",
        }
    }
}

/// The orientation of one image as its file states it: a pinhole, perhaps behind a distorting lens.
#[derive(Clone, Debug, PartialEq)]
pub struct Orientation {
    /// Image that it belongs to, as the file names it (with or without folder and extension).
    pub image: String,
    /// The file that says so, and its line where there is one: "colmap/images.txt, line 5".
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
    /// The rotation angles as the file states them, in whatever unit and order.
    pub angles: Option<[f64; 3]>,
    /// Where in the frame the image lies, where the file states it.
    pub crop: Option<Crop>,
}

/// The place of an image in the frame that it was cut out of, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crop {
    /// First column.
    pub column: f64,
    /// First row, from the top.
    pub row: f64,
    /// Width and height of the frame.
    pub frame: [f64; 2],
}

/// Files that together orient images: one candidate for the orientation of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct OrientationSet {
    /// The format.
    pub format: Format,
    /// Folder of the files, without a final slash; empty for the top.
    pub folder: String,
    /// Indices of the files among the inputs, in the order that the reader wants.
    pub files: Vec<usize>,
}

impl OrientationSet {
    /// The paths of its files, for messages and for choosing between sets: the folder when there are many.
    pub fn label(&self, inputs: &[InputFile]) -> String {
        match &self.files[..] {
            files if files.len() <= 2 => files
                .iter()
                .map(|&i| &*inputs[i].path)
                .collect::<Vec<_>>()
                .join(" + "),
            files if self.folder.is_empty() => format!("{} files .P", files.len()),
            files => format!("{}/ ({} files .P)", self.folder, files.len()),
        }
    }

    /// Reads the orientations of the set. Warnings are added to `warnings`.
    pub fn read(
        &self,
        inputs: &[InputFile],
        warnings: &mut Vec<String>,
    ) -> Result<Vec<Orientation>> {
        let file = |i: usize| (&*inputs[self.files[i]].path, inputs[self.files[i]].text());
        match self.format {
            Format::Colmap => {
                let (cameras, images) = (file(0), file(1));
                colmap::read((cameras.0, &cameras.1), (images.0, &images.1))
            }
            Format::Photogrammetric => {
                let (camera, exterior) = (file(0), file(1));
                photogrammetric::read((camera.0, &camera.1), (exterior.0, &exterior.1), warnings)
            }
            Format::Projection => (0..self.files.len())
                .map(|i| {
                    let (path, text) = file(i);
                    projection::read(path, &text)
                })
                .collect(),
        }
    }
}

/// The candidates among recognised files, best first, and what is missing to complete others.
pub fn orientation_sets(
    inputs: &[InputFile],
    kinds: &[FileKind],
) -> (Vec<OrientationSet>, Vec<String>) {
    let mut sets = Vec::new();
    let mut incomplete = Vec::new();
    for (format, first, second) in [
        (
            Format::Colmap,
            FileKind::ColmapCameras,
            FileKind::ColmapImages,
        ),
        (
            Format::Photogrammetric,
            FileKind::PhotogrammetricCamera,
            FileKind::PhotogrammetricExterior,
        ),
    ] {
        pairs(
            inputs,
            kinds,
            (format, first, second),
            &mut sets,
            &mut incomplete,
        );
    }
    sets.extend(matrix_folders(inputs, kinds));
    sets.sort_by(|a, b| (a.format, &a.folder, &a.files).cmp(&(b.format, &b.folder, &b.files)));
    (sets, incomplete)
}

/// Joins two kinds of files of one folder; a lone partner in another folder is taken as well.
fn pairs(
    inputs: &[InputFile],
    kinds: &[FileKind],
    (format, first, second): (Format, FileKind, FileKind),
    sets: &mut Vec<OrientationSet>,
    incomplete: &mut Vec<String>,
) {
    let of = |kind| (0..inputs.len()).filter(move |&i| kinds[i] == kind);
    let firsts: Vec<usize> = of(first).collect();
    for s in of(second) {
        let folder = inputs[s].folder();
        let partner = firsts
            .iter()
            .find(|&&f| inputs[f].folder() == folder)
            .or(firsts.first().filter(|_| firsts.len() == 1));
        match partner {
            Some(&f) => sets.push(OrientationSet {
                format,
                folder: folder.to_owned(),
                files: vec![f, s],
            }),
            None => incomplete.push(format!(
                "{} has no {} beside it",
                inputs[s].path,
                first.describe()
            )),
        }
    }
    if of(second).next().is_none() {
        incomplete.extend(
            firsts
                .iter()
                .map(|&f| format!("{} has no {} beside it", inputs[f].path, second.describe())),
        );
    }
}

/// All matrices of one folder make one set.
fn matrix_folders(inputs: &[InputFile], kinds: &[FileKind]) -> Vec<OrientationSet> {
    let mut sets: Vec<OrientationSet> = Vec::new();
    for i in (0..inputs.len()).filter(|&i| kinds[i] == FileKind::Projection) {
        let folder = inputs[i].folder();
        match sets.iter_mut().find(|s| s.folder == folder) {
            Some(set) => set.files.push(i),
            None => sets.push(OrientationSet {
                format: Format::Projection,
                folder: folder.to_owned(),
                files: vec![i],
            }),
        }
    }
    sets
}
