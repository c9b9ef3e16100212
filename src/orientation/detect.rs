//! What a file is, by its content.
//!
//! Names decide only where content does not: a damaged `cameras.txt` or `x.P` should be refused with its
//! line, not be passed over in silence.

use serde::Serialize;

use super::text::{Line, data_lines};
use crate::scene_loader::InputFile;

/// What an input file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FileKind {
    /// JPEG, PNG or TIFF.
    Image,
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
    /// JSON, which is no orientation format here.
    Json,
    /// Nothing that is used.
    Ignored,
}

impl FileKind {
    /// What people call it.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Image => "image",
            Self::ColmapCameras => "COLMAP camera list (cameras.txt)",
            Self::ColmapImages => "COLMAP image list (images.txt)",
            Self::ColmapPoints => "COLMAP points, not needed",
            Self::PhotogrammetricCamera => "interior orientation (camera.txt)",
            Self::PhotogrammetricExterior => "exterior orientation (exterior.txt)",
            Self::Projection => "projection matrix (.P)",
            Self::Json => "JSON that is no orientation known here",
            Self::Ignored => "not used",
        }
    }
}

/// How much of a file is looked at: enough for the longest comment header.
const HEAD_BYTES: usize = 64 * 1024;

/// Data lines that are looked at: a list may begin with a damaged one.
const HEAD_LINES: usize = 6;

/// Recognises a file.
pub fn detect(file: &InputFile) -> FileKind {
    if crate::raster::image_format(&file.bytes).is_some() {
        return FileKind::Image;
    }
    let head = &file.bytes[..file.bytes.len().min(HEAD_BYTES)];
    if !head.contains(&0) {
        let text = String::from_utf8_lossy(head);
        if let Some(kind) = by_content(&text) {
            return kind;
        }
    }
    by_name(file)
}

fn by_content(text: &str) -> Option<FileKind> {
    let trimmed = text.trim_start_matches('\u{feff}').trim_start();
    if trimmed.starts_with(['{', '[']) {
        return Some(FileKind::Json);
    }
    if text
        .lines()
        .any(|line| line.trim_start().starts_with("principal_distance"))
    {
        return Some(FileKind::PhotogrammetricCamera);
    }
    let lines: Vec<Line> = data_lines("", text).take(HEAD_LINES).collect();
    let fields: Vec<Vec<&str>> = lines.iter().map(Line::fields).collect();
    if lines.len() == 3
        && fields
            .iter()
            .all(|f| f.len() == 4 && f.iter().all(|f| is_number(f)))
    {
        return Some(FileKind::Projection);
    }
    fields.iter().find_map(|f| by_fields(f))
}

/// The kind that one line of a list gives away.
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
    } else if f.len() == 7 && !is_number(f[0]) && numbers(1..7) {
        Some(FileKind::PhotogrammetricExterior)
    } else {
        None
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
        _ => match name.rsplit_once('.').map_or("", |(_, e)| e) {
            "p" => FileKind::Projection,
            "jpg" | "jpeg" | "png" | "tif" | "tiff" => FileKind::Image,
            "json" => FileKind::Json,
            _ => FileKind::Ignored,
        },
    }
}
