//! The readers of orientation files, one file for each format or family of formats.
//!
//! ```text
//! text            lines with their position, for messages
//! xml             XML elements with theirs; xml/metashape, xml/blocks
//! json            JSON with theirs; json/opensfm (and ODM), json/nerfstudio, json/krc
//! left_out        images whose camera cannot be read
//! brown_fit       distortion stated from measured to ideal points, fitted by Brown's model
//! projection      P = K [R | t] and its decomposition
//! photogrammetric, patb, inpho, colmap, colmap_binary, bundles, matrices, micmac
//! ```
//!
//! To add a format:
//!
//! 1. A file here with `read(path, text, ...) -> Result<Vec<Orientation>>`, which converts to the
//!    conventions of [`Orientation`](super::Orientation) and names file and line in every error;
//!    its conventions in the module's doc.
//! 2. A variant of [`Format`](super::Format), at its place in the order of preference, with its
//!    name.
//! 3. Its files in `detect`: a variant of [`FileKind`](super::FileKind) with its name in messages,
//!    and the line of `by_content`, `by_tags`, `by_keys` or `by_name` that recognises it.
//! 4. In `sets`: which files make a set (`single_file_format`, `add_pairs` or `folders`), and the
//!    reader's line in `OrientationSet::read`.
//! 5. A fixture: the gable house in `tests/fixtures/NAME` (written by `tests/fixtures/make.py`),
//!    listed in `tests/input/readers.rs`, which checks that the truth projects to the same pixels,
//!    and damages it.

mod brown_fit;
pub(crate) mod bundles;
pub(crate) mod colmap;
pub(crate) mod colmap_binary;
pub(crate) mod inpho;
pub(crate) mod json;
mod left_out;
pub(crate) mod matrices;
pub(crate) mod micmac;
pub(crate) mod patb;
pub(crate) mod photogrammetric;
pub(crate) mod projection;
mod text;
pub(crate) mod xml;

/// Of labelled groups in a file that of this label, else the last one, which is preferred.
fn of_group<T>(
    groups: impl IntoIterator<Item = (Option<String>, T)>,
    label: Option<&str>,
) -> Option<T> {
    let mut groups: Vec<(Option<String>, T)> = groups.into_iter().collect();
    let wanted = groups
        .iter()
        .position(|(own, _)| label.is_some() && own.as_deref() == label);
    let last = groups.len().checked_sub(1)?;
    Some(groups.swap_remove(wanted.unwrap_or(last)).1)
}

pub(crate) use text::{TextLine, data_lines, lines};
