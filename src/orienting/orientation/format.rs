//! The supported formats of orientation files.

use serde::Serialize;

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
    /// Its usual name.
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
