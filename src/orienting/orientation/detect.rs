//! What kind of file it is, by its content.
//!
//! Names decide only where the content does not: a damaged `cameras.txt` or `x.P` should be refused
//! with its line, not be ignored silently.

use serde::Serialize;

use super::formats::{TextLine, bundles, data_lines, patb, photogrammetric};
use super::input_file::{HEAD_BYTES, InputFile};
use super::unread;

/// What an input file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
pub enum FileKind {
    /// JPEG, PNG or TIFF.
    Image,
    /// An image in a format that is not read.
    UnreadImage,
    /// COLMAP's list of cameras.
    ColmapCameras,
    /// COLMAP's list of images.
    ColmapImages,
    /// COLMAP's points, which are not needed.
    ColmapPoints,
    /// Interior orientation of a photogrammetric camera.
    PhotogrammetricCamera,
    /// List of X Y Z omega phi kappa.
    PhotogrammetricExterior,
    /// A 3 x 4 matrix.
    Projection,
    /// COLMAP's binary list of cameras.
    ColmapBinaryCameras,
    /// COLMAP's binary list of images.
    ColmapBinaryImages,
    /// Metashape's cameras.
    Metashape,
    /// ContextCapture's BlocksExchange.
    Blocks,
    /// Pix4D's calibrated camera parameters.
    Pix4d,
    /// Pix4D's projection matrices.
    Pmatrix,
    /// Pix4D's offset of the world.
    Offset,
    /// OpenSfM's reconstruction.
    OpenSfm,
    /// JSON list of K, R, C.
    Krc,
    /// nerfstudio's transforms.
    Nerfstudio,
    /// Bundler's cameras.
    Bundler,
    /// Bundler's list of images.
    BundlerList,
    /// Principal points of Bundler's images.
    PrincipalPoints,
    /// ODM's shots.
    Shots,
    /// OpenSfM's cameras, beside the shots.
    OpenSfmCameras,
    /// INPHO's project.
    Inpho,
    /// PAT-B's exterior orientation.
    Patb,
    /// MicMac's orientation of one image.
    Micmac,
    /// MicMac's interior orientation.
    MicmacCalibration,
    /// A coordinate reference system.
    ReferenceSystem,
    /// Heights of the ground on a grid.
    Terrain,
    /// Footprints of buildings.
    Footprints,
    /// VisualSFM's model.
    Nvm,
    /// Strecha's camera.
    Strecha,
    /// Middlebury's parameters.
    Middlebury,
    /// A format that is known but not read.
    Unread,
    /// JSON that is no orientation known here.
    Json,
    /// Nothing that is used.
    Ignored,
}

impl FileKind {
    /// Its name in messages.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Image => "image",
            Self::UnreadImage => "image in a format that is not read",
            Self::ColmapCameras => "COLMAP camera list (cameras.txt)",
            Self::ColmapImages => "COLMAP image list (images.txt)",
            Self::ColmapPoints => "COLMAP points, not needed",
            Self::PhotogrammetricCamera => "interior orientation (camera.txt)",
            Self::PhotogrammetricExterior => "exterior orientation (exterior.txt)",
            Self::Projection => "projection matrix (.P)",
            Self::ColmapBinaryCameras => "COLMAP camera list (cameras.bin)",
            Self::ColmapBinaryImages => "COLMAP image list (images.bin)",
            Self::Metashape => "Metashape cameras (XML)",
            Self::Blocks => "BlocksExchange (XML)",
            Self::Pix4d => "Pix4D camera parameters",
            Self::Pmatrix => "Pix4D projection matrices",
            Self::Offset => "Pix4D offset of the world",
            Self::OpenSfm => "OpenSfM reconstruction",
            Self::Krc => "JSON list of K, R, C",
            Self::Nerfstudio => "nerfstudio transforms",
            Self::Bundler => "Bundler cameras (bundle.out)",
            Self::BundlerList => "Bundler list of images (list.txt)",
            Self::PrincipalPoints => "principal points of the images",
            Self::Shots => "ODM shots (shots.geojson)",
            Self::OpenSfmCameras => "OpenSfM cameras (cameras.json)",
            Self::Inpho => "INPHO project (.prj)",
            Self::Patb => "PAT-B exterior orientation (.ori)",
            Self::Micmac => "MicMac orientation",
            Self::MicmacCalibration => "MicMac interior orientation",
            Self::ReferenceSystem => "coordinate reference system",
            Self::Terrain => "terrain model",
            Self::Footprints => "footprints of buildings",
            Self::Nvm => "VisualSFM model (.nvm)",
            Self::Strecha => "Strecha camera",
            Self::Middlebury => "Middlebury parameters",
            Self::Unread => "known, but not read",
            Self::Json => "JSON that is no orientation known here",
            Self::Ignored => "not used",
        }
    }
}

/// Data lines that are inspected: a list may begin with a damaged one.
const HEAD_LINES: usize = 6;

/// What a list of ground control points is called, as OpenDroneMap's: its lines would pass for
/// those of other lists, and it orients no image by itself.
pub(crate) const GCP_LIST: &str = "gcp_list.txt";

/// What its list of the places of photographs is called.
pub(crate) const GEO_LIST: &str = "geo.txt";

/// What a point cloud in LAS or LAZ begins with.
pub(crate) const POINT_CLOUD: &[u8] = b"LASF";

/// Recognises a file.
pub fn detect(file: &InputFile) -> FileKind {
    if crate::photographs::raster::unread_image_format(&file.path, file.content())
        .is_some_and(|f| f.is_image)
    {
        return FileKind::UnreadImage;
    }
    if crate::photographs::raster::is_height_raster(file.content())
        || file.bytes.starts_with(POINT_CLOUD)
    {
        return FileKind::Terrain;
    }
    if crate::photographs::raster::image_format(&file.bytes).is_some() {
        return FileKind::Image;
    }
    if file.name().eq_ignore_ascii_case(GCP_LIST) {
        return FileKind::Ignored;
    }
    if let Some(text) = file.start_as_text(HEAD_BYTES) {
        // Lines of GeoJSON may each have a record separator before them (RFC 8142).
        if text
            .trim_start_matches('\u{1e}')
            .trim_start()
            .starts_with(['{', '['])
        {
            // OpenSfM's place of the local frame: no content tells it from other places.
            let is_place = file.name().eq_ignore_ascii_case("reference_lla.json");
            if is_place {
                return FileKind::ReferenceSystem;
            }
            return match by_keys(&file.text()) {
                FileKind::Json if unread::of(file).is_some() => FileKind::Unread,
                kind => kind,
            };
        }
        let unread = unread::by_content(&text).or_else(|| unread::by_whole_name(file));
        let unread = unread.map(|_| FileKind::Unread);
        if let Some(kind) = unread.or_else(|| by_content(&text)) {
            return kind;
        }
    }
    match by_name(file) {
        FileKind::Ignored if unread::of(file).is_some() => FileKind::Unread,
        kind => kind,
    }
}

fn by_content(text: &str) -> Option<FileKind> {
    let trimmed = text.trim_start();
    match trimmed.starts_with('<') {
        true => by_tags(trimmed),
        false => by_words(text, trimmed).or_else(|| by_lines(text)),
    }
}

/// By what the file begins with, or a word at the beginning of any line.
fn by_words(text: &str, trimmed: &str) -> Option<FileKind> {
    if trimmed.starts_with("# Bundle file") {
        return Some(FileKind::Bundler);
    }
    if trimmed.starts_with("$PROJECT") || (trimmed.starts_with('$') && text.contains("$EXT_ORI")) {
        return Some(FileKind::Inpho);
    }
    if ["PROJC", "GEOG", "COMPD", "COMPOUNDCRS"]
        .iter()
        .any(|word| trimmed.starts_with(word))
        && trimmed.contains('[')
    {
        return Some(FileKind::ReferenceSystem);
    }
    if is_ascii_grid(trimmed) {
        return Some(FileKind::Terrain);
    }
    if trimmed.starts_with("NVM_V3") {
        return Some(FileKind::Nvm);
    }
    if trimmed.starts_with("fileName imageWidth imageHeight") {
        return Some(FileKind::Pix4d);
    }
    if text
        .lines()
        .any(|line| line.trim_start().starts_with("principal_distance"))
    {
        return Some(FileKind::PhotogrammetricCamera);
    }
    None
}

/// Does a text begin as an ASCII grid of ESRI does?
pub(crate) fn is_ascii_grid(text: &str) -> bool {
    let first = text.split_whitespace().next().unwrap_or_default();
    ["ncols", "nrows"]
        .iter()
        .any(|name| first.eq_ignore_ascii_case(name))
}

/// By how many numbers its first lines hold.
fn by_lines(text: &str) -> Option<FileKind> {
    let lines: Vec<TextLine> = data_lines("", text).take(HEAD_LINES).collect();
    let fields: Vec<Vec<&str>> = lines.iter().map(TextLine::fields).collect();
    if fields.len() == HEAD_LINES
        && fields
            .iter()
            .all(|f| f.len() == 3 && f.iter().all(|f| is_number(f)))
    {
        return Some(FileKind::Strecha);
    }
    // The image may have blanks in its name, the 21 numbers of its camera stand behind.
    let is_middlebury =
        |f: &[&str]| f.len() >= 22 && f[f.len() - 21..].iter().all(|f| is_number(f));
    if fields.len() > 1
        && fields[0].len() == 1
        && is_number(fields[0][0])
        && (fields[1].len() == 22 || is_middlebury(&fields[1]))
    {
        return Some(FileKind::Middlebury);
    }
    if lines.len() == 3
        && fields
            .iter()
            .all(|f| f.len() == 4 && f.iter().all(|f| is_number(f)))
    {
        return Some(FileKind::Projection);
    }
    let of_lines = fields.iter().find_map(|f| by_fields(f));
    // Names have blanks: a line of COLMAP's list of images ends like one of these too.
    let is_names = (lines.iter()).all(|l| bundles::listed_image(l.text).is_some());
    if of_lines.is_none() && !lines.is_empty() && is_names {
        return Some(FileKind::BundlerList);
    }
    let of_list = || photogrammetric::is_list(text).then_some(FileKind::PhotogrammetricExterior);
    (of_lines.or(patb::is_patb(text).then_some(FileKind::Patb))).or_else(of_list)
}

/// The kind that one line of a list shows.
fn by_fields(f: &[&str]) -> Option<FileKind> {
    let numbers = |range: std::ops::Range<usize>| f[range].iter().all(|f| is_number(f));
    if f.len() >= 5 && is_number(f[0]) && is_model(f[1]) && numbers(2..4) {
        Some(FileKind::ColmapCameras)
    } else if f.len() >= 10 && numbers(0..9) && !is_number(f[9]) {
        Some(FileKind::ColmapImages)
    } else if f.len() >= 8
        && f.len().is_multiple_of(2)
        && numbers(0..f.len())
        && is_colour(&f[4..7])
    {
        Some(FileKind::ColmapPoints)
    } else if f.len() >= 13
        && !is_number(f[0])
        && !is_number(f[f.len() - 13])
        && numbers(f.len() - 12..f.len())
    {
        Some(FileKind::Pmatrix)
    } else if f.len() == 7 && !is_number(f[0]) && numbers(1..7) {
        Some(FileKind::PhotogrammetricExterior)
    } else {
        None
    }
}

/// The kind of an XML file.
fn by_tags(head: &str) -> Option<FileKind> {
    if head.contains("<BlocksExchange") {
        Some(FileKind::Blocks)
    } else if head.contains("<chunk") && head.contains("<sensor") {
        Some(FileKind::Metashape)
    } else if head.contains("<OrientationConique") {
        Some(FileKind::Micmac)
    } else if head.contains("<CalibrationInternConique") {
        Some(FileKind::MicmacCalibration)
    } else {
        None
    }
}

/// The kind of a JSON file, by its keys anywhere in it.
fn by_keys(text: &str) -> FileKind {
    let has = |keys: &[&str]| keys.iter().all(|key| text.contains(&format!("\"{key}\"")));
    if has(&["cameras", "shots", "projection_type"]) {
        FileKind::OpenSfm
    } else if has(&["FeatureCollection", "filename", "translation", "rotation"]) {
        FileKind::Shots
    } else if has(&["projection_type", "width", "height"]) {
        FileKind::OpenSfmCameras
    } else if has(&["frames", "transform_matrix"]) {
        FileKind::Nerfstudio
    } else if has(&["is_metric", "anchor", "rays_a_point", "left_out"]) {
        // What `orient` writes beside its model.
        FileKind::ReferenceSystem
    } else if has(&["views", "K", "R", "C"]) {
        FileKind::Krc
    } else if has(&["CityJSON", "CityObjects"])
        || (has(&["Polygon", "coordinates"]) || has(&["MultiPolygon", "coordinates"]))
    {
        FileKind::Footprints
    } else {
        FileKind::Json
    }
}

fn is_number(field: &str) -> bool {
    field.parse::<f64>().is_ok()
}

/// COLMAP writes its camera models in capitals.
fn is_model(field: &str) -> bool {
    field.len() > 2
        && field
            .bytes()
            .all(|b| b.is_ascii_uppercase() || b == b'_' || b.is_ascii_digit())
        && !is_number(field)
}

fn is_colour(fields: &[&str]) -> bool {
    fields.iter().all(|f| f.parse::<u8>().is_ok())
}

fn by_name(file: &InputFile) -> FileKind {
    let name = file.name().to_ascii_lowercase();
    match &*name {
        "cameras.txt" => FileKind::ColmapCameras,
        "images.txt" => FileKind::ColmapImages,
        "camera.txt" => FileKind::PhotogrammetricCamera,
        "exterior.txt" => FileKind::PhotogrammetricExterior,
        "cameras.bin" => FileKind::ColmapBinaryCameras,
        "images.bin" => FileKind::ColmapBinaryImages,
        "principal_points.txt" => FileKind::PrincipalPoints,
        _ if name.ends_with("_offset.xyz") || name == "offset.xyz" => FileKind::Offset,
        _ => match name.rsplit_once('.').map_or("", |(_, e)| e) {
            "p" => FileKind::Projection,
            "nvm" => FileKind::Nvm,
            "ori" => FileKind::Patb,
            "camera" => FileKind::Strecha,
            "jpg" | "jpeg" | "png" | "tif" | "tiff" => FileKind::Image,
            "json" | "geojson" => FileKind::Json,
            _ => FileKind::Ignored,
        },
    }
}
