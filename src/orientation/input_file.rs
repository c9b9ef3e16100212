//! Files as the caller hands them over.

use std::borrow::Cow;

/// How much of a file is inspected: enough for the longest comment header.
pub(super) const HEAD_BYTES: usize = 64 * 1024;

/// A file in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputFile {
    /// Its path within the scene, folders separated by slashes.
    pub path: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

impl InputFile {
    /// A file; backslashes in the path become slashes.
    pub fn new(path: &str, bytes: Vec<u8>) -> Self {
        Self {
            path: path.replace('\\', "/"),
            bytes,
        }
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
    pub(crate) fn head(&self, bytes: usize) -> Option<Cow<'_, str>> {
        let head = &self.bytes[..self.bytes.len().min(bytes)];
        let is_text = utf16(head).is_some() || !head.contains(&0);
        is_text.then(|| decoded(head))
    }
}

/// Text of UTF-8, of UTF-16 with a byte order mark (Windows' "Unicode"), or of Windows-1252.
fn decoded(bytes: &[u8]) -> Cow<'_, str> {
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
            assert_eq!(file.head(1000).unwrap(), text);
        }
        let old = InputFile::new("a.txt", b"a\rb\r".to_vec());
        assert_eq!(old.text(), "a\nb\n");
        assert_eq!(InputFile::new("a", vec![1, 0, 0]).head(9), None);
        // A head that ends within a character stays UTF-8.
        let file = InputFile::new("a", "aö".as_bytes().to_vec());
        assert!(file.head(2).unwrap().starts_with("a\u{fffd}"));
    }
}
