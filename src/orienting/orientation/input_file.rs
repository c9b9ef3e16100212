//! Files as the caller hands them over.

use std::borrow::Cow;
use std::ops::Range;

use super::photograph_head::{PhotographHead, gathered};
#[cfg(test)]
use crate::photographs::raster::image_format;
use crate::photographs::raster::{Excerpt, HeaderNeeds, Piece};

/// How much of a file is inspected: enough for the longest comment header.
pub(super) const HEAD_BYTES: usize = 64 * 1024;

/// A file in memory: whole, or of a photograph the head ([`PhotographHead`]) as long as no pixel is
/// needed, since a flight is larger than the memory that there is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputFile {
    /// Its path within the scene, folders separated by slashes.
    pub path: String,
    /// Its content; of a photograph that is not filled its head, whose start is that of the file.
    pub bytes: Vec<u8>,
    head: Option<Head>,
}

/// What is known of a photograph by its head.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Head {
    /// The path under which it was read.
    source: String,
    /// Where the bytes of the head stand in the file, then those of the ranges that are filled.
    pieces: Vec<Piece>,
    /// How many of them are the head's.
    of_head: usize,
    /// Bytes of the whole file.
    whole: u64,
    /// Are all of them here?
    is_whole: bool,
}

impl Head {
    fn of_head(&self) -> &[Piece] {
        &self.pieces[..self.of_head]
    }

    /// Bytes of the head.
    fn bytes(&self) -> usize {
        let length: u64 = self.of_head().iter().map(Piece::length).sum();
        length as usize
    }
}

impl InputFile {
    /// A file; backslashes in the path become slashes.
    pub fn new(path: &str, bytes: Vec<u8>) -> Self {
        Self {
            path: path.replace('\\', "/"),
            bytes,
            head: None,
        }
    }

    /// A photograph by its head; `None` where that does not suffice to plan with.
    pub fn photograph(head: PhotographHead) -> Option<Self> {
        let is_enough = head.needs() == HeaderNeeds::Nothing;
        is_enough.then(|| Self::of_head(head))
    }

    fn of_head(head: PhotographHead) -> Self {
        let PhotographHead {
            path,
            bytes,
            pieces,
            whole,
        } = head;
        let mut file = Self::new(&path, bytes);
        file.head = Some(Head {
            source: file.path.clone(),
            of_head: pieces.len(),
            pieces,
            whole,
            is_whole: false,
        });
        file
    }

    /// A photograph by its first half; none of other files.
    #[cfg(test)]
    pub(crate) fn half(&self) -> Option<Self> {
        let half = self.bytes.len() / 2;
        let mut head = PhotographHead::new(&self.path, self.length());
        head.add(0..half as u64, &self.bytes[..half]);
        image_format(&self.bytes).map(|_| Self::of_head(head))
    }

    /// Under another path.
    pub fn renamed(self, path: &str) -> Self {
        Self {
            path: path.replace('\\', "/"),
            ..self
        }
    }

    /// Gives a photograph its whole bytes; false where it is not held by its head, or that is
    /// another one.
    pub fn fill(&mut self, bytes: Vec<u8>) -> bool {
        let Some(head) = &mut self.head else {
            return false;
        };
        let of_head = self.bytes.get(..head.bytes()).unwrap_or_default();
        let is_same = bytes.len() as u64 == head.whole
            && (head.is_whole || *of_head == gathered(head.of_head(), &bytes));
        if is_same {
            head.pieces.truncate(head.of_head);
            head.is_whole = true;
            self.bytes = bytes;
        }
        is_same
    }

    /// Gives a photograph some ranges beside its head, instead of what it was filled with; `bytes`
    /// are those of all, one after the other. False where it is not held by its head, or their
    /// number is another.
    pub fn fill_ranges(&mut self, ranges: &[Range<u64>], bytes: &[u8]) -> bool {
        self.empty();
        let length: u64 = ranges.iter().map(|range| range.end - range.start).sum();
        let Some(head) = self.head.as_mut().filter(|_| bytes.len() as u64 == length) else {
            return false;
        };
        let mut at = self.bytes.len();
        for place in ranges {
            let piece = Piece {
                place: place.clone(),
                at,
            };
            at += piece.length() as usize;
            head.pieces.push(piece);
        }
        self.bytes.extend_from_slice(bytes);
        true
    }

    /// Are these ranges of it in memory, or all of it where none are given?
    pub(super) fn has(&self, ranges: Option<&[Range<u64>]>) -> bool {
        match (&self.head, ranges) {
            (None, _) => true,
            (Some(head), None) => head.is_whole,
            (Some(head), Some(ranges)) => {
                let places = head.pieces[head.of_head..].iter().map(|piece| &piece.place);
                head.is_whole || places.eq(ranges)
            }
        }
    }

    /// Is it whole from the beginning, and stays so?
    pub(super) fn is_always_whole(&self) -> bool {
        self.head.is_none()
    }

    /// The ranges that are filled beside its head, with their bytes; none where it is whole.
    pub(crate) fn filled_ranges(&self) -> impl Iterator<Item = (Range<u64>, &[u8])> {
        let pieces = self
            .head
            .iter()
            .flat_map(|head| &head.pieces[head.of_head..]);
        pieces.map(|piece| {
            let end = piece.at + piece.length() as usize;
            (piece.place.clone(), &self.bytes[piece.at..end])
        })
    }

    /// Leaves the head of a photograph that was filled.
    pub fn empty(&mut self) {
        let Some(head) = &mut self.head else {
            return;
        };
        head.pieces.truncate(head.of_head);
        if std::mem::take(&mut head.is_whole) {
            self.bytes = gathered(&head.pieces, &self.bytes);
        } else {
            self.bytes.truncate(head.bytes());
            self.bytes.shrink_to_fit();
        }
    }

    /// The path under which a photograph was read that is not whole.
    pub fn lacking(&self) -> Option<&str> {
        let head = self.head.as_ref().filter(|head| !head.is_whole)?;
        Some(&head.source)
    }

    /// Was it filled, as a whole or with ranges?
    pub fn is_filled(&self) -> bool {
        let is_filled = |head: &Head| head.is_whole || head.pieces.len() > head.of_head;
        self.head.as_ref().is_some_and(is_filled)
    }

    /// What of it is in memory, for readers of images.
    pub fn content(&self) -> Excerpt<'_> {
        match self.head.as_ref().filter(|head| !head.is_whole) {
            Some(head) => Excerpt::new(&self.bytes, &head.pieces, head.whole),
            None => (&self.bytes).into(),
        }
    }

    /// What of it always is in memory: the head of a photograph, all of another file.
    pub fn head(&self) -> Cow<'_, [u8]> {
        match &self.head {
            Some(head) if head.is_whole => Cow::Owned(gathered(&head.pieces, &self.bytes)),
            Some(head) => Cow::Borrowed(&self.bytes[..head.bytes()]),
            None => Cow::Borrowed(&self.bytes),
        }
    }

    /// Where the bytes of the head of a photograph stand in the file; nowhere of another file.
    pub fn head_places(&self) -> Vec<Range<u64>> {
        let pieces = self.head.iter().flat_map(Head::of_head);
        pieces.map(|piece| piece.place.clone()).collect()
    }

    /// Bytes of [`Self::head`].
    pub fn head_length(&self) -> u64 {
        let all = self.bytes.len() as u64;
        let of_head = |head: &Head| head.bytes() as u64;
        self.head.as_ref().map_or(all, of_head)
    }

    /// Bytes of the whole file.
    pub fn length(&self) -> u64 {
        let here = self.bytes.len() as u64;
        self.head.as_ref().map_or(here, |head| head.whole)
    }

    /// Its name without the folder.
    pub fn name(&self) -> &str {
        base_name(&self.path)
    }

    /// Its folder without a final slash; empty at the top.
    pub fn folder(&self) -> &str {
        self.path.rsplit_once('/').map_or("", |(folder, _)| folder)
    }

    /// Its content as text, in the encoding that its first bytes or its content show.
    pub(crate) fn text(&self) -> Cow<'_, str> {
        decoded(&self.bytes)
    }

    /// Its first bytes as text; `None` where it is none.
    pub(crate) fn start_as_text(&self, bytes: usize) -> Option<Cow<'_, str>> {
        let head = &self.bytes[..self.bytes.len().min(bytes)];
        let is_text = utf16(head).is_some() || !head.contains(&0);
        is_text.then(|| decoded(head))
    }
}

/// Text of UTF-8, of UTF-16 with a byte order mark (Windows' "Unicode"), or of Windows-1252;
/// without its mark.
fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    let text = match (utf16(bytes), std::str::from_utf8(bytes)) {
        (Some(text), _) => Cow::Owned(text),
        (None, Ok(text)) => Cow::Borrowed(text),
        // The end of the head may cut a character.
        (None, Err(e)) if e.error_len().is_none() => String::from_utf8_lossy(bytes),
        (None, Err(_)) => Cow::Owned(bytes.iter().map(|&b| windows_1252(b)).collect()),
    };
    // Lines of old Macintosh programs end with a carriage return alone.
    if text.contains('\r') && !text.contains('\n') {
        return Cow::Owned(text.replace('\r', "\n"));
    }
    text
}

fn utf16(bytes: &[u8]) -> Option<String> {
    let (mark, rest) = bytes.split_first_chunk::<2>()?;
    let pairs = rest.chunks_exact(2);
    let unit = match mark {
        [0xff, 0xfe] => u16::from_le_bytes,
        [0xfe, 0xff] => u16::from_be_bytes,
        _ => return None,
    };
    let units = pairs.map(|pair| unit([pair[0], pair[1]]));
    let characters = char::decode_utf16(units);
    Some(characters.map(|c| c.unwrap_or('\u{fffd}')).collect())
}

/// A byte of Windows' western code page: Latin-1 but for what stands at 0x80 to 0x9f.
fn windows_1252(byte: u8) -> char {
    const EXTRA: [char; 32] = [
        '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž',
        '\u{8f}', '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}',
        'ž', 'Ÿ',
    ];
    match byte {
        0x80..=0x9f => EXTRA[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

/// A path without its folder.
pub(crate) fn base_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// A name without its folder and extension: by this, images and orientations find each other.
pub(crate) fn stem(path: &str) -> &str {
    let name = base_name(path);
    match name.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The head of a file, read as it asks for.
    fn head_of(path: &str, bytes: &[u8]) -> Option<InputFile> {
        let mut head = PhotographHead::new(path, bytes.len() as u64);
        while let HeaderNeeds::Range(range) = head.needs() {
            let part = &bytes[range.start as usize..range.end as usize];
            assert!(head.add(range, part));
        }
        InputFile::photograph(head)
    }

    #[test]
    fn a_photograph_is_whole_only_while_it_is_filled() {
        let mut png = std::io::Cursor::new(Vec::new());
        let mut random = crate::roofs::testing::uniform(1);
        let image = image::RgbImage::from_fn(200, 150, |_, _| {
            image::Rgb([0; 3].map(|_: u8| (256.0 * random()) as u8))
        });
        image.write_to(&mut png, image::ImageFormat::Png).unwrap();
        let png = png.into_inner();
        let length = png.len() as u64;
        assert_eq!(head_of("a.txt", &vec![b' '; 100_000]), None);
        assert_eq!(head_of("a.png", &png[..60_000]), None);
        let file = head_of("in\\a.png", &png).unwrap();
        let mut file = file.renamed("b.png");
        let head = file.clone();
        assert_eq!((&*file.path, file.lacking()), ("b.png", Some("in/a.png")));
        assert_eq!((file.length(), file.is_filled()), (length, false));
        let mut changed = png.clone();
        changed[50] ^= 1;
        assert!(!file.fill(changed) && !file.fill(png[1..].to_vec()));
        assert!(file.fill(png.clone()));
        assert_eq!((&file.bytes, file.lacking()), (&png, None));
        assert_eq!((file.length(), file.is_filled()), (length, true));
        assert_eq!(&*file.head(), &png[..64 << 10]);
        file.empty();
        assert_eq!(file, head);
        assert!(!InputFile::new("a.txt", Vec::new()).fill(png));
    }

    #[test]
    fn text_is_read_in_the_encodings_of_windows() {
        let text = "Höhe über\n1 2\n";
        let units = || text.encode_utf16();
        let little: Vec<u8> = [0xff, 0xfe]
            .into_iter()
            .chain(units().flat_map(u16::to_le_bytes))
            .collect();
        let big: Vec<u8> = [0xfe, 0xff]
            .into_iter()
            .chain(units().flat_map(u16::to_be_bytes))
            .collect();
        let western: Vec<u8> = text.chars().map(|c| c as u8).collect();
        for bytes in [text.as_bytes().to_vec(), little, big, western] {
            let file = InputFile::new("a.txt", bytes);
            assert_eq!(file.text(), text);
            assert_eq!(file.start_as_text(1000).unwrap(), text);
        }
        let old = InputFile::new("a.txt", b"a\rb\r".to_vec());
        assert_eq!(old.text(), "a\nb\n");
        assert_eq!(InputFile::new("a", vec![1, 0, 0]).start_as_text(9), None);
        // A head that ends within a character stays UTF-8.
        let file = InputFile::new("a", "aö".as_bytes().to_vec());
        assert!(file.start_as_text(2).unwrap().starts_with("a\u{fffd}"));
    }
}
