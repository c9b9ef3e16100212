//! Paths as names are compared, and how well two of them fit.

use std::cmp::Reverse;

use super::input_file::stem;

/// Extensions of photographs: what ends in one of them is the whole name of a file.
const PHOTOGRAPHS: [&str; 12] = [
    "jpg", "jpeg", "png", "tif", "tiff", "dng", "cr2", "nef", "arw", "heic", "bmp", "jp2",
];

/// A path in Unicode's composed form (macOS decomposes accents), whatever separates its folders.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PathName {
    /// The name without folders.
    base: String,
    /// The folders in lower case, the innermost first.
    folders: Vec<String>,
}

/// How well a stated name fits a path; less is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct NameFit {
    /// `a.jpg.png` for the stated `a.jpg`: as masks are called.
    pub is_appended: bool,
    /// How many folders agree, from the innermost outwards.
    pub folders: Reverse<usize>,
    pub ending: NameEnding,
    /// Does the next folder outwards differ, where both have one?
    pub is_elsewhere: bool,
}

/// How the names themselves differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct NameEnding {
    pub extension: Extension,
    pub is_other_case: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Extension {
    Same,
    /// The stated name has none.
    Missing,
    Other,
}

/// Unicode's composed form (NFC). A browser has the tables, which would be a tenth of the module
/// that orients.
fn composed(text: &str) -> String {
    #[cfg(target_arch = "wasm32")]
    return js_sys::JsString::from(text).normalize("NFC").into();
    #[cfg(not(target_arch = "wasm32"))]
    unicode_normalization::UnicodeNormalization::nfc(text).collect()
}

impl PathName {
    pub(crate) fn new(path: &str) -> Self {
        let composed = composed(path);
        let mut parts = composed
            .split(['/', '\\'])
            .filter(|part| !["", ".", ".."].contains(part));
        let base = parts.next_back().unwrap_or_default().to_owned();
        let folders = parts.rev().map(str::to_lowercase).collect();
        Self { base, folders }
    }

    /// What a stated name may mean: itself, and what it is without the `%20` of addresses.
    pub(crate) fn readings(stated: &str) -> Vec<Self> {
        let decoded = decoded(stated).map(|path| Self::new(&path));
        std::iter::once(Self::new(stated)).chain(decoded).collect()
    }

    /// Under these an image is found: without extension as it goes by, and as a name that lacks it.
    pub(crate) fn keys(&self) -> [String; 2] {
        [stem(&self.base).to_lowercase(), self.base.to_lowercase()]
    }

    /// How this name, stated by an orientation or a user, fits the path of an image.
    pub(crate) fn fit(&self, image: &Self) -> Option<NameFit> {
        let image_stem = stem(&image.base);
        let is_whole = |name: &str| {
            let extension = name.rsplit_once('.').map_or("", |(_, e)| e);
            PHOTOGRAPHS.contains(&&*extension.to_lowercase())
        };
        let (extension, is_other_case, is_appended) = [
            (&*self.base, &*image.base, Extension::Same),
            (&*self.base, image_stem, Extension::Missing),
            (stem(&self.base), image_stem, Extension::Other),
        ]
        .into_iter()
        .filter(|(a, b, _)| a.to_lowercase() == b.to_lowercase())
        .map(|(a, b, extension)| {
            let is_appended = extension == Extension::Missing && is_whole(a);
            (extension, a != b, is_appended)
        })
        .min_by_key(|&(extension, is_other_case, is_appended)| {
            (is_appended, extension, is_other_case)
        })?;
        let pairs = self.folders.iter().zip(&image.folders);
        let agreeing = pairs.take_while(|(a, b)| a == b).count();
        Some(NameFit {
            is_appended,
            folders: Reverse(agreeing),
            ending: NameEnding {
                extension,
                is_other_case,
            },
            is_elsewhere: agreeing < self.folders.len().min(image.folders.len()),
        })
    }
}

/// The images that a name means, which may leave out folders and extension: those that fit best.
pub(crate) fn images_called(name: &str, paths: &[PathName]) -> Vec<usize> {
    let readings = PathName::readings(name);
    let fits: Vec<_> = paths
        .iter()
        .map(|path| readings.iter().filter_map(|name| name.fit(path)).min())
        .collect();
    let best = fits.iter().flatten().min();
    (0..paths.len())
        .filter(|&i| best.is_some() && fits[i].as_ref() == best)
        .collect()
}

/// A path without the escapes of addresses; `None` where it has none.
fn decoded(path: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(path.len());
    let mut rest = path.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let digits = after.get(..2).filter(|_| first == b'%');
        let code = digits
            .filter(|d| d.iter().all(u8::is_ascii_hexdigit))
            .and_then(|d| u8::from_str_radix(std::str::from_utf8(d).ok()?, 16).ok());
        bytes.push(code.unwrap_or(first));
        rest = if code.is_some() { &after[2..] } else { after };
    }
    let is_changed = bytes.len() < path.len();
    String::from_utf8(bytes).ok().filter(|_| is_changed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(stated: &str, path: &str) -> Option<NameFit> {
        let path = PathName::new(path);
        let fits = PathName::readings(stated);
        fits.iter().filter_map(|name| name.fit(&path)).min()
    }

    #[test]
    fn the_closest_name_wins() {
        // From the best to the worst.
        let orders: [&[(&str, &str)]; 3] = [
            &[
                ("b.jpg", "x/b.jpg"),
                ("B.JPG", "x/b.jpg"),
                ("b", "x/b.jpg"),
                ("b.tif", "x/b.jpg"),
                ("b.jpg", "x/b.jpg.png"),
            ],
            &[
                ("d:\\p\\x\\b.jpg", "x/b.jpg"),
                ("d:\\p\\x\\b.jpg", "b.jpg"),
                ("d:\\p\\x\\b.jpg", "y/b.jpg"),
            ],
            &[("p/x/b.jpg", "p/x/b.jpg"), ("q/x/b.jpg", "p/x/b.jpg")],
        ];
        for order in orders {
            let fits = order.iter().map(|(a, b)| fit(a, b).expect(b));
            assert!(fits.is_sorted_by(|a, b| a < b), "{order:?}");
        }
        assert_eq!(
            fit("b.c", "b.c.jpg").unwrap().ending.extension,
            Extension::Missing
        );
        assert_eq!(fit("b.1.tif", "b.2.jpg"), None);
        assert_eq!(fit("ab.jpg", "b.jpg"), None);
    }

    #[test]
    fn names_are_the_same_however_they_are_written() {
        for (stated, path) in [
            ("S\u{fc}d 1.jpg", "x/Su\u{308}d 1.jpg"),
            ("Su\u{308}d 1.jpg", "x/S\u{fc}d 1.jpg"),
            ("file:///D:/x/S%C3%BCd%201.jpg", "x/S\u{fc}d 1.jpg"),
            ("\u{d55c}.jpg", "\u{1112}\u{1161}\u{11ab}.jpg"),
            ("a%20b.jpg", "a%20b.jpg"),
            ("100% a.jpg", "100% a.jpg"),
            ("\\\\server\\share\\x\\b.jpg", "x/b.jpg"),
        ] {
            let fit = fit(stated, path).expect(path);
            assert_eq!(fit.ending.extension, Extension::Same, "{stated}");
            assert!(!fit.ending.is_other_case, "{stated}");
        }
        assert_eq!(fit("S\u{fc}d.jpg", "Sud.jpg"), None);
    }

    #[test]
    fn a_name_means_the_images_that_fit_it_best() {
        let paths = ["c0/1.jpg", "c1/1.jpg", "masks/2.jpg.png", "c0/2.jpg"].map(PathName::new);
        assert_eq!(images_called("1", &paths), [0, 1]);
        assert_eq!(images_called("c1/1.JPG", &paths), [1]);
        assert_eq!(images_called("2.jpg", &paths), [3]);
        assert_eq!(images_called("3.jpg", &paths), [0; 0]);
    }
}
