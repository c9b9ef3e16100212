//! Which files together orient images, and the reader of each format.

use super::angles::without_rounding;
use super::detect::FileKind;
use super::format::Format;
use super::formats::json::{krc, nerfstudio, opensfm};
use super::formats::xml::{blocks, metashape};
use super::formats::{
    bundles, colmap, colmap_binary, inpho, matrices, micmac, patb, photogrammetric, projection,
};
use super::image_orientation::Orientation;
use super::input_file::InputFile;
use super::path_name::{PathName, images_called};
use super::reference::{self, FrameSigma, StatedReference};
use crate::base::error::Result;
use crate::photographs::raster::{image_format, image_header};

/// Files that together orient images: one candidate for the orientation of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct OrientationSet {
    /// The format.
    pub format: Format,
    /// Folder of the files, without a final slash; empty for the top.
    pub folder: String,
    /// Indices of the files among the inputs, in the order in which the reader takes them.
    pub files: Vec<usize>,
}

impl OrientationSet {
    /// Of files of which the first one says in which folder they lie.
    fn new(format: Format, inputs: &[InputFile], files: Vec<usize>) -> Self {
        Self {
            format,
            folder: inputs[files[0]].folder().to_owned(),
            files,
        }
    }

    /// The paths of its files, for messages and for choosing between sets: the folder when there
    /// are many.
    pub fn label(&self, inputs: &[InputFile]) -> String {
        let what = match self.format {
            Format::Strecha => ".camera",
            Format::Micmac => ".xml",
            _ => ".P",
        };
        match &self.files[..] {
            files if files.len() <= 2 || has_further(self.format) => files
                .iter()
                .take(2)
                .map(|&i| &*inputs[i].path)
                .collect::<Vec<_>>()
                .join(" + "),
            files if self.folder.is_empty() => format!("{} files {what}", files.len()),
            files => format!("{}/ ({} files {what})", self.folder, files.len()),
        }
    }

    /// What the files say about the system of their coordinates; of a group (chunk or block) of
    /// theirs, or of the preferred one.
    pub fn reference(&self, inputs: &[InputFile], group: Option<&str>) -> StatedReference {
        let text = |i: usize| self.files.get(i).map(|&f| inputs[f].text());
        let first = text(0).unwrap_or_default();
        match self.format {
            Format::Inpho => reference::of_inpho(&first),
            Format::Blocks => blocks::reference(&first, group),
            Format::OpenSfm => opensfm::reference(&first, text(1).as_deref(), group),
            Format::Colmap | Format::ColmapBinary => {
                text(2).map_or(StatedReference::None, |text| reference::of_orient(&text))
            }
            Format::Pix4d | Format::Pmatrix if self.files.len() == 1 => StatedReference::Local(
                "its positions count from the zero of an _offset.xyz, which is not among the files"
                    .to_owned(),
            ),
            _ => StatedReference::None,
        }
    }

    /// What the files say that the scale and the level of their frame are worth.
    pub fn frame_sigma(&self, inputs: &[InputFile]) -> Option<FrameSigma> {
        let is_colmap = matches!(self.format, Format::Colmap | Format::ColmapBinary);
        let report = self.files.get(2).filter(|_| is_colmap)?;
        reference::frame_sigma_of_orient(&inputs[*report].text())
    }

    /// Reads the orientations of the set; rounded rotations are made orthonormal. Warnings are
    /// added to `warnings`.
    pub fn read(
        &self,
        inputs: &[InputFile],
        warnings: &mut Vec<String>,
    ) -> Result<Vec<Orientation>> {
        let mut found = self.read_as_stated(inputs, warnings)?;
        for orientation in &mut found {
            orientation.r = without_rounding(&orientation.r);
        }
        Ok(found)
    }

    fn read_as_stated(
        &self,
        inputs: &[InputFile],
        warnings: &mut Vec<String>,
    ) -> Result<Vec<Orientation>> {
        let texts: Vec<_> = (self.files.iter())
            .map(|&i| (&*inputs[i].path, inputs[i].text()))
            .collect();
        let file = |i: usize| (texts[i].0, &*texts[i].1);
        let further = |i: usize| (i < texts.len()).then(|| file(i));
        let (path, text) = file(0);
        match self.format {
            Format::Colmap => colmap::read(file(0), file(1)),
            Format::ColmapBinary => {
                let bytes = |i: usize| &inputs[self.files[i]].bytes[..];
                let cameras = colmap_binary::cameras_text(path, bytes(0))?;
                let images = colmap_binary::images_text(texts[1].0, bytes(1))?;
                colmap::read((path, &cameras), (texts[1].0, &images))
            }
            Format::Photogrammetric => photogrammetric::read(file(0), file(1), warnings),
            Format::Inpho => inpho::read(path, text, warnings),
            Format::Patb => patb::read(file(0), file(1), warnings),
            Format::Metashape => metashape::read(path, text, warnings),
            Format::Blocks => blocks::read(path, text, warnings),
            Format::Pix4d => matrices::read_pix4d(file(0), further(1)),
            Format::OpenSfm => opensfm::read(path, text, warnings),
            Format::Shots => opensfm::read_shots(file(0), further(1), warnings),
            Format::Krc => krc::read(path, text),
            Format::Nerfstudio => {
                let images = inputs
                    .iter()
                    .filter(|file| image_format(&file.bytes).is_some());
                let images: Vec<&InputFile> = images.collect();
                let names: Vec<PathName> = (images.iter())
                    .map(|file| PathName::new(&file.path))
                    .collect();
                let size_of = |name: &str| {
                    let mut called = images_called(name, &names).into_iter();
                    let header = |i: usize| image_header(&images[i].path, images[i].content());
                    let found = called.find_map(|i| header(i).ok())?;
                    Some([found.width, found.height])
                };
                nerfstudio::read(path, text, &size_of, warnings)
            }
            Format::Bundler => bundles::read_bundler(file(0), file(1), further(2), warnings),
            Format::Nvm => bundles::read_nvm(path, text),
            Format::Middlebury => matrices::read_middlebury(path, text),
            Format::Pmatrix => matrices::read_pmatrix(file(0), further(1)),
            Format::Micmac => micmac::read(&texts),
            Format::Strecha => each(&texts, matrices::read_strecha),
            Format::Projection => each(&texts, projection::read),
        }
    }
}

/// May files stand behind the two that a format's label names?
fn has_further(format: Format) -> bool {
    matches!(
        format,
        Format::Bundler | Format::Colmap | Format::ColmapBinary
    )
}

fn each<T: AsRef<str>>(
    texts: &[(&str, T)],
    read: fn(&str, &str) -> Result<Orientation>,
) -> Result<Vec<Orientation>> {
    texts
        .iter()
        .map(|(path, text)| read(path, text.as_ref()))
        .collect()
}

/// The candidates among recognised files, best first, and what is missing to complete others.
pub fn orientation_sets(
    inputs: &[InputFile],
    kinds: &[FileKind],
) -> (Vec<OrientationSet>, Vec<String>) {
    let mut sets = Vec::new();
    let mut incomplete = Vec::new();
    for pair in [
        (
            Format::Colmap,
            FileKind::ColmapCameras,
            FileKind::ColmapImages,
        ),
        (
            Format::ColmapBinary,
            FileKind::ColmapBinaryCameras,
            FileKind::ColmapBinaryImages,
        ),
        (
            Format::Photogrammetric,
            FileKind::PhotogrammetricCamera,
            FileKind::PhotogrammetricExterior,
        ),
        (
            Format::Patb,
            FileKind::PhotogrammetricCamera,
            FileKind::Patb,
        ),
        (Format::Bundler, FileKind::Bundler, FileKind::BundlerList),
    ] {
        add_pairs(inputs, kinds, pair, &mut sets, &mut incomplete);
    }
    for (i, kind) in kinds.iter().enumerate() {
        if let Some(format) = single_file_format(*kind) {
            sets.push(OrientationSet::new(format, inputs, vec![i]));
        }
    }
    for (format, kind) in [
        (Format::Projection, FileKind::Projection),
        (Format::Strecha, FileKind::Strecha),
        (Format::Micmac, FileKind::Micmac),
    ] {
        sets.extend(folders(inputs, kinds, format, kind));
    }
    for set in &mut sets {
        add_files_beside(inputs, kinds, set);
    }
    sets.sort_by(|a, b| (a.format, &a.folder, &a.files).cmp(&(b.format, &b.folder, &b.files)));
    if sets.is_empty() {
        name_nearly_lists(inputs, kinds, &mut incomplete);
    }
    (sets, incomplete)
}

/// Puts first what nearly is a list of orientations, and why it is none.
fn name_nearly_lists(inputs: &[InputFile], kinds: &[FileKind], incomplete: &mut Vec<String>) {
    let nearly: Vec<String> = (0..inputs.len())
        .filter(|&i| kinds[i] == FileKind::Ignored)
        .filter_map(|i| nearly_a_list(&inputs[i]))
        .collect();
    if !nearly.is_empty() {
        // What a camera file lacks is the list that cannot be read.
        let lacks_list = FileKind::PhotogrammetricExterior.describe();
        incomplete.retain(|message| !message.contains(lacks_list));
        incomplete.splice(0..0, nearly);
    }
}

/// Adds the files that a set's first files need besides.
fn add_files_beside(inputs: &[InputFile], kinds: &[FileKind], set: &mut OrientationSet) {
    let all = |kind: FileKind| (0..inputs.len()).filter(move |&i| kinds[i] == kind);
    let beside = |kind: FileKind| all(kind).filter(|&i| inputs[i].folder() == set.folder);
    let named = |i: usize, name: &str| inputs[i].name().eq_ignore_ascii_case(name);
    let only = |kind: FileKind| all(kind).next().filter(|_| all(kind).count() == 1);
    let extra = match set.format {
        Format::Bundler => beside(FileKind::PrincipalPoints).next(),
        Format::Pix4d | Format::Pmatrix => {
            // Each project of a folder has its own: PROJECT_offset.xyz.
            let common = |i: usize| {
                let (a, b) = (inputs[i].name(), inputs[set.files[0]].name());
                a.bytes().zip(b.bytes()).take_while(|(a, b)| a == b).count()
            };
            beside(FileKind::Offset)
                .max_by_key(|&i| common(i))
                .or_else(|| only(FileKind::Offset))
        }
        // ODM keeps its cameras in another folder than its shots; OpenSfM's camera_models.json
        // beside them holds what the adjustment began with.
        Format::Shots => {
            let is_odms = |&i: &usize| named(i, "cameras.json");
            let odms = || all(FileKind::OpenSfmCameras).filter(is_odms);
            beside(FileKind::OpenSfmCameras)
                .find(is_odms)
                .or_else(|| beside(FileKind::OpenSfmCameras).next())
                .or_else(|| odms().next().filter(|_| odms().count() == 1))
                .or_else(|| only(FileKind::OpenSfmCameras))
        }
        Format::Colmap | Format::ColmapBinary => {
            beside(FileKind::ReferenceSystem).find(|&i| named(i, reference::OF_ORIENT))
        }
        Format::OpenSfm => {
            beside(FileKind::ReferenceSystem).find(|&i| named(i, "reference_lla.json"))
        }
        Format::Micmac => {
            // Each orientation file names its calibration; of equal names the last is taken.
            let mut lenses: Vec<usize> = all(FileKind::MicmacCalibration).collect();
            lenses.sort_by_key(|&i| inputs[i].folder() == set.folder);
            set.files.extend(lenses);
            return;
        }
        _ => None,
    };
    set.files.extend(extra);
}

/// Why a text that nearly is a list of orientations is none, with its line.
fn nearly_a_list(input: &InputFile) -> Option<String> {
    // A list of more than some thousand images is none that a scene is made of.
    const MOST_BYTES: usize = 1 << 20;
    let text = input.start_as_text(MOST_BYTES)?;
    let error = photogrammetric::nearly_a_list(&input.path, &text)?;
    Some(error.to_string().replace("; ", ", "))
}

/// The format of a file that is a complete orientation.
fn single_file_format(kind: FileKind) -> Option<Format> {
    Some(match kind {
        FileKind::Metashape => Format::Metashape,
        FileKind::Blocks => Format::Blocks,
        FileKind::Pix4d => Format::Pix4d,
        FileKind::OpenSfm => Format::OpenSfm,
        FileKind::Inpho => Format::Inpho,
        FileKind::Shots => Format::Shots,
        FileKind::Krc => Format::Krc,
        FileKind::Nerfstudio => Format::Nerfstudio,
        FileKind::Nvm => Format::Nvm,
        FileKind::Middlebury => Format::Middlebury,
        FileKind::Pmatrix => Format::Pmatrix,
        _ => return None,
    })
}

/// Joins two kinds of files of one folder; a single second file in another folder is taken as well.
fn add_pairs(
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
                folder: folder.to_owned(),
                ..OrientationSet::new(format, inputs, vec![f, s])
            }),
            // Lists of images are written for many other ends.
            None if second == FileKind::BundlerList => {}
            None => incomplete.push(format!(
                "{} has no {} beside it{}",
                inputs[s].path,
                first.describe(),
                match first {
                    FileKind::PhotogrammetricCamera =>
                        " (lines principal_distance_mm, pixel_size_mm, image_size_px)",
                    _ => "",
                }
            )),
        }
    }
    // A camera file serves two kinds of lists; it lacks one only where it has neither.
    let has_list =
        |&kind: &FileKind| [FileKind::Patb, FileKind::PhotogrammetricExterior].contains(&kind);
    if first == FileKind::PhotogrammetricCamera
        && (format == Format::Patb || kinds.iter().any(has_list))
    {
        return;
    }
    if of(second).next().is_none() {
        let lacks =
            |&f: &usize| format!("{} has no {} beside it", inputs[f].path, second.describe());
        incomplete.extend(firsts.iter().map(lacks));
    }
}

/// All files of this kind in one folder make one set.
fn folders(
    inputs: &[InputFile],
    kinds: &[FileKind],
    format: Format,
    kind: FileKind,
) -> Vec<OrientationSet> {
    let mut sets: Vec<OrientationSet> = Vec::new();
    for i in (0..inputs.len()).filter(|&i| kinds[i] == kind) {
        let folder = inputs[i].folder();
        match sets.iter_mut().find(|s| s.folder == folder) {
            Some(set) => set.files.push(i),
            None => sets.push(OrientationSet::new(format, inputs, vec![i])),
        }
    }
    sets
}
