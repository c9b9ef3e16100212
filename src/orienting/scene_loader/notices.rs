//! What is said of images: turns in their EXIF headers, bands that are not used, and formats that
//! are not read.

use std::collections::BTreeMap;

use super::planned_view::{PlannedImage, PlannedView};
use crate::base::error::{Error, listed};
use crate::orienting::orientation::{FileKind, InputFile, stem};
use crate::photographs::camera::FEWEST_VIEWS;
use crate::photographs::raster::{Bands, UnreadImageFormat, unread_image_format};

/// What is said of images.
pub(super) struct Notices {
    pub warnings: Vec<String>,
    /// Images in other formats, where too few can be read; the first is to be reported first.
    pub errors: Vec<Error>,
}

/// What is said of the images of a plan, `views` being those that have an orientation.
pub(super) fn of_images(
    files: &[InputFile],
    kinds: &[FileKind],
    images: &[PlannedImage],
    views: &[PlannedView],
) -> Notices {
    let mut notices = Notices {
        warnings: [turns(files, images, views), bands(files, images)].concat(),
        errors: Vec::new(),
    };
    let read = kinds.iter().filter(|k| **k == FileKind::Image);
    let is_short = read.count() < FEWEST_VIEWS;
    for (format, names) in unread(files, kinds, is_short) {
        let error = refusal(&format, &names);
        match is_short {
            true => notices.errors.insert(0, error),
            false => notices.warnings.push(format!("left out: {error}")),
        }
    }
    notices
}

fn turns(files: &[InputFile], images: &[PlannedImage], views: &[PlannedView]) -> Vec<String> {
    let is_turned = |file: usize| views.iter().any(|v| v.file == file && v.turn.is_some());
    let asking = images
        .iter()
        .filter(|i| i.header.is_some_and(|h| h.turned()));
    let (turned, stored): (Vec<usize>, Vec<usize>) = asking
        .map(|image| image.file)
        .partition(|&file| is_turned(file));
    let say = |of: &[usize], words: &str| {
        let names = listed(of.iter().map(|&file| &files[file].path));
        (!of.is_empty()).then(|| format!("{names}: {words}"))
    };
    [
        say(
            &turned,
            "turned as the EXIF header asks: the orientation is for width and height exchanged",
        ),
        say(
            &stored,
            "the EXIF header asks for a turn, which is not applied: the orientation must describe the \
             pixels as they are stored",
        ),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn bands(files: &[InputFile], images: &[PlannedImage]) -> Vec<String> {
    let mut found: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for image in images {
        let words = match image.header.map(|h| h.bands) {
            None | Some(Bands::All) => continue,
            Some(Bands::Without(first, last)) if first == last => {
                format!("band {first} (near infrared, or whatever it holds) is not used")
            }
            Some(Bands::Without(first, last)) => {
                format!(
                    "bands {first} to {last} (near infrared, or whatever they hold) are not used"
                )
            }
            Some(Bands::Unnamed(count)) => format!(
                "the file does not say what its {count} bands hold: the first three are taken for \
                 red, green and blue"
            ),
        };
        found
            .entry(words)
            .or_default()
            .push(&files[image.file].path);
    }
    let say = |(words, names): (String, Vec<&str>)| format!("{}: {words}", listed(names.iter()));
    found.into_iter().map(say).collect()
}

/// The files that are not read by their format; a photograph that is there in another format too
/// is no loss, and documents and videos matter only where images are missing.
fn unread<'a>(
    files: &'a [InputFile],
    kinds: &[FileKind],
    is_short: bool,
) -> Vec<(UnreadImageFormat, Vec<&'a str>)> {
    let key = |file: &InputFile| stem(file.name()).to_lowercase();
    let of_kind = |kind: FileKind| (0..files.len()).filter(move |&i| kinds[i] == kind);
    let read: Vec<String> = of_kind(FileKind::Image).map(|i| key(&files[i])).collect();
    let mut found: BTreeMap<&str, (UnreadImageFormat, Vec<&str>)> = BTreeMap::new();
    for i in of_kind(FileKind::UnreadImage).chain(of_kind(FileKind::Ignored)) {
        let Some(format) = unread_image_format(&files[i].path, files[i].content()) else {
            continue;
        };
        if is_short || (format.is_image && !read.contains(&key(&files[i]))) {
            let (_, names) = found.entry(format.name).or_insert((format, Vec::new()));
            names.push(&files[i].path);
        }
    }
    // The kind of most files is named first where errors are put in front of each other.
    let mut found: Vec<_> = found.into_values().collect();
    found.sort_by_key(|(format, names)| (format.is_image, names.len()));
    found
}

fn refusal(format: &UnreadImageFormat, names: &[&str]) -> Error {
    match names {
        [one] => Error::file(
            *one,
            format!("it is {}, which is not read", format.name),
            format.advice,
        ),
        _ => Error::scene(
            format!(
                "{} files are not read, each {}: {}",
                names.len(),
                format.name,
                listed(names.iter())
            ),
            format.advice.replace("convert it", "convert each"),
        ),
    }
}
