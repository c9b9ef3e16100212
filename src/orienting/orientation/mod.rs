//! Orientation files: recognised by their content, read into one form.
//!
//! ```text
//! input_file         a file in memory, or the head of a photograph
//! needed             what is needed of a file, all of it or blocks of it, and who gives it
//! path_name          which images a name means
//! photograph_head    what of a photograph is read to plan with it
//! image_orientation  interior and exterior orientation of one image: what every reader returns
//! angles             omega, phi, kappa and their units
//! geodesy            the ellipsoid, and the anchor of a local frame on it
//! formats            the readers, one file for each format; how to add one
//! format             the list of formats, in the order of preference
//! detect             what kind of file it is
//! unread             formats that are known but not read, and what to do instead
//! reference          EPSG code of the coordinate reference system; what a frame is worth
//! units              what coordinates of a system count: metres, feet, degrees
//! epsg               what the codes stand for
//! well_known         systems that are written out
//! sets               the files that together orient images, and their reader
//! metric_frame       geocentric and geographic positions become a local metric frame
//! ```
//!
//! | format | files | conventions that are converted here |
//! |---|---|---|
//! | COLMAP text, binary | `cameras` + `images` | none: these are the conventions of this program |
//! | photogrammetric list | camera + exterior | omega, phi, kappa; mm from the centre, y up |
//! | INPHO, PAT-B | text | see `inpho`, `patb` |
//! | Metashape, BlocksExchange | XML | see `xml::metashape`, `xml::blocks` |
//! | MicMac | XML | see `micmac` |
//! | Pix4D parameters, pmatrix | text | see `matrices` |
//! | OpenSfM, ODM, nerfstudio, K R C | JSON | see `json::opensfm` and its neighbours |
//! | Bundler, VisualSFM | text | see `bundles` |
//! | Strecha, Middlebury | text | see `matrices` |
//! | projection matrices | one `.P` per image | scale and sign; (0, 0) is the centre of a pixel |
//!
//! Where a scene holds its orientation more than once, the first in the order of [`Format`] is
//! taken: COLMAP states distortion and image size, the list states the size, a bare matrix neither.
//!
//! Invariant: a reader takes any bytes and returns an orientation or a readable error; it holds no
//! more memory than a small multiple of its input. Invariant: every reader returns cameras with x
//! right, y down, z forward, `cam_from_world`, and (0.5, 0.5) at the centre of the top-left pixel.

mod angles;
pub(crate) mod detect;
mod epsg;
mod format;
mod formats;
mod geodesy;
mod image_orientation;
mod input_file;
mod metric_frame;
mod needed;
mod path_name;
mod photograph_head;
mod reference;
mod sets;
mod units;
mod unread;
mod well_known;

pub use angles::{
    AngleUnit, omega_phi_kappa_from_rotation, rotation_from_omega_phi_kappa,
    rotation_from_yaw_pitch_roll,
};
pub(crate) use angles::{EXACT_ROTATION, Y_UP, axis_rotations};
pub use detect::{FileKind, detect};
pub(crate) use detect::{GCP_LIST, GEO_LIST, POINT_CLOUD, is_ascii_grid};
pub(crate) use epsg::{TransverseMercator, is_geographic, plane_of};
pub use format::Format;
pub(crate) use formats::{TextLine, data_lines, lines};
pub(crate) use geodesy::{A_M, LARGEST_SCENE_M, geocentric_of, geographic_of};
pub use geodesy::{Anchor, MOST_DATUM_M};
pub use image_orientation::{Crop, Orientation};
pub use input_file::InputFile;
pub(crate) use input_file::stem;
pub use metric_frame::to_metric_frame;
pub use needed::{BLOCK_BYTES, FileSource, Needed};
pub(crate) use path_name::{NameEnding, NameFit, PathName, images_called};
pub use photograph_head::PhotographHead;
pub use reference::{FrameSigma, StatedReference, epsg_of};
pub use sets::{OrientationSet, orientation_sets};
pub use units::{
    LinearUnit, PlanUnit, SystemUnits, height_unit_of_code, linear_unit_of_code, units_of,
    units_of_code,
};
pub(crate) use unread::{UnreadFormat, of as unread_format};
