//! Archives: a `.zip` is replaced by the files in it.

use std::io::{Cursor, Read};

use zip::ZipArchive;

use crate::base::error::{Error, Result};
use crate::orienting::orientation::InputFile;

/// Unpacked bytes of one archive at most: a few bytes can be packed that unpack to any size.
const MOST_BYTES: u64 = if cfg!(target_arch = "wasm32") {
    1 << 30
} else {
    8 << 30
};

/// Files in one archive at most.
const MOST_FILES: usize = 20_000;

/// The files of an archive, below its own path without ".zip"; any other file is handed back as it
/// is. Hidden files and what begins with "__MACOSX" are left out.
pub fn unpack(file: InputFile) -> Result<Vec<InputFile>> {
    if !file.bytes.starts_with(b"PK\x03\x04") {
        return Ok(vec![file]);
    }
    let refuse = |problem: String| {
        Error::file(
            &file.path,
            problem,
            "unpack it and add the files, or pack it again",
        )
    };
    let mut archive = ZipArchive::new(Cursor::new(&file.bytes))
        .map_err(|e| refuse(format!("the archive cannot be read: {e}")))?;
    if archive.len() > MOST_FILES {
        return Err(refuse(format!(
            "it holds {} files, more than {MOST_FILES}",
            archive.len()
        )));
    }
    let folder = file.path.strip_suffix(".zip").unwrap_or(&file.path);
    let mut left = MOST_BYTES;
    let mut files = Vec::new();
    for i in 0..archive.len() {
        let entry = archive
            .by_index(i)
            .map_err(|e| refuse(format!("entry {i} cannot be read: {e}")))?;
        let name = entry.name().to_owned();
        let is_hidden = |part: &str| part.starts_with('.') || part == "__MACOSX";
        if entry.is_dir() || name.split(['/', '\\']).any(is_hidden) {
            continue;
        }
        let mut bytes = Vec::new();
        // The stated size may be a lie: what counts is what comes out.
        let read = entry.take(left + 1).read_to_end(&mut bytes);
        read.map_err(|e| refuse(format!("{name} in it cannot be read: {e}")))?;
        left = left
            .checked_sub(bytes.len() as u64)
            .ok_or_else(|| refuse(format!("it unpacks to more than {MOST_BYTES} bytes")))?;
        files.push(InputFile::new(&format!("{folder}/{name}"), bytes));
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(files)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use zip::write::{SimpleFileOptions, ZipWriter};

    use super::*;

    fn packed(files: &[(&str, &[u8])]) -> InputFile {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in files {
            zip.start_file(*name, SimpleFileOptions::default()).unwrap();
            zip.write_all(bytes).unwrap();
        }
        InputFile::new("in/scene.zip", zip.finish().unwrap().into_inner())
    }

    #[test]
    fn an_archive_gives_its_files_in_order() {
        let text = [b'x'; 5000];
        let zip = packed(&[
            ("b/c.txt", &text),
            ("a.txt", b"a"),
            (".hidden", b""),
            ("__MACOSX/a.txt", b""),
        ]);
        assert!(zip.bytes.len() < 2000, "it is compressed");
        let files = unpack(zip).unwrap();
        let paths: Vec<_> = files.iter().map(|f| &*f.path).collect();
        assert_eq!(paths, ["in/scene/a.txt", "in/scene/b/c.txt"]);
        assert_eq!(files[1].bytes, text);
    }

    #[test]
    fn what_is_no_archive_stays_and_what_is_damaged_is_refused() {
        let plain = InputFile::new("a.txt", b"PK".to_vec());
        assert_eq!(unpack(plain.clone()).unwrap(), [plain]);
        let mut damaged = packed(&[("a.txt", &[b'x'; 5000])]);
        damaged.bytes.truncate(40);
        let message = unpack(damaged).unwrap_err().to_string();
        assert!(
            message.contains("in/scene.zip") && message.contains("; "),
            "{message}"
        );
    }
}
