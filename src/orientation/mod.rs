//! Orientation files: recognised by what stands in them, read into one form.
//!
//! | format | files | conventions that are converted here |
//! |---|---|---|
//! | COLMAP text, binary | `cameras` + `images` | none: `x_cam = R X + t`, centre of the top-left pixel (0.5, 0.5) |
//! | photogrammetric list | camera + exterior | omega, phi, kappa; mm from the frame's centre, y up; crops |
//! | INPHO, PAT-B | text | see `inpho`, `patb` |
//! | Metashape, BlocksExchange | XML | see `xml` |
//! | MicMac | XML | see `micmac` |
//! | Pix4D parameters, pmatrix | text | see `matrices` |
//! | OpenSfM, ODM, nerfstudio, K R C | JSON | see `json` |
//! | Bundler, VisualSFM | text | see `bundles` |
//! | Strecha, Middlebury | text | see `matrices` |
//! | projection matrices | one `.P` per image | 3 x 4 up to scale and sign; centre of the top-left pixel (0, 0) |
//!
//! Where a scene holds its orientation more than once, the first in the order of [`Format`] is taken: COLMAP
//! carries lens and size with it, the list carries the size, a bare matrix neither.
//!
//! Invariant: a reader takes any bytes and returns an orientation or a readable error; it holds no more
//! memory than a small multiple of its input.

mod angles;
pub(crate) mod detect;
mod formats;
mod geodesy;
mod input_file;
mod reference;
mod sets;

pub use angles::{AngleUnit, omega_phi_kappa_from_rotation, rotation_from_omega_phi_kappa};
pub use detect::{FileKind, detect};
pub use geodesy::{Anchor, to_metric_frame};
pub use input_file::InputFile;
pub(crate) use input_file::{base_name, stem};
pub use reference::epsg_of;
pub use sets::{OrientationSet, orientation_sets};

use nalgebra::{Matrix3, Point3};
use serde::Serialize;

use crate::camera::Distortion;

/// The supported formats, in the order in which they are preferred.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// COLMAP's text model.
    Colmap,
    /// COLMAP's binary model.
    ColmapBinary,
    /// Camera file and list of X Y Z omega phi kappa.
    Photogrammetric,
    /// INPHO's project.
    Inpho,
    /// Camera file and PAT-B's exterior orientation.
    Patb,
    /// Metashape's `cameras.xml`.
    Metashape,
    /// ContextCapture's BlocksExchange.
    Blocks,
    /// Pix4D's calibrated camera parameters.
    Pix4d,
    /// OpenSfM's `reconstruction.json`.
    OpenSfm,
    /// ODM's `shots.geojson`, with `cameras.json` where it is there.
    Shots,
    /// A JSON list of K, R, C.
    Krc,
    /// nerfstudio's `transforms.json`.
    Nerfstudio,
    /// Bundler's `bundle.out` and list.
    Bundler,
    /// VisualSFM's `.nvm`.
    Nvm,
    /// MicMac's `Orientation-*.xml`.
    Micmac,
    /// Strecha's `.camera` files.
    Strecha,
    /// Middlebury's `_par.txt`.
    Middlebury,
    /// Pix4D's `_pmatrix.txt`.
    Pmatrix,
    /// VGG's 3 x 4 matrices.
    Projection,
}

impl Format {
    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Colmap => "COLMAP text model",
            Self::ColmapBinary => "COLMAP binary model",
            Self::Photogrammetric => "photogrammetric list",
            Self::Inpho => "INPHO project",
            Self::Patb => "PAT-B orientation",
            Self::Metashape => "Metashape cameras",
            Self::Blocks => "BlocksExchange",
            Self::Pix4d => "Pix4D camera parameters",
            Self::OpenSfm => "OpenSfM reconstruction",
            Self::Shots => "ODM shots",
            Self::Krc => "JSON list of K, R, C",
            Self::Nerfstudio => "nerfstudio transforms",
            Self::Bundler => "Bundler model",
            Self::Nvm => "VisualSFM model",
            Self::Micmac => "MicMac orientation",
            Self::Strecha => "Strecha cameras",
            Self::Middlebury => "Middlebury parameters",
            Self::Pmatrix => "Pix4D projection matrices",
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
    /// Does the principal point in `k` count from the middle of the image, whose size the file does not know?
    pub from_middle: bool,
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

/// An orientation of which no more is known than a pinhole.
fn pinhole(
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
        crop: None,
    }
}
