//! The files of a scene: of large photographs the head is in memory, until a step needs their
//! pixels.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};

use ridgeline::orienting::orientation::{FileSource, InputFile, Needed, PhotographHead};
use ridgeline::photographs::raster::HeaderNeeds;
use ridgeline::tiles::InputStamp;

/// Files in memory, and where photographs lie of which only the head is there.
#[derive(Default)]
pub(super) struct SceneFiles {
    pub files: Vec<InputFile>,
    sources: BTreeMap<String, PathBuf>,
}

impl SceneFiles {
    /// Reads a file, of a large photograph the head; `relative` is its path in the scene.
    pub(super) fn read(&mut self, path: &Path, relative: &str) -> io::Result<InputFile> {
        let mut file = File::open(path)?;
        let mut head = PhotographHead::new(relative, file.metadata()?.len());
        while let HeaderNeeds::Range(range) = head.needs() {
            let mut bytes = Vec::new();
            file.seek(SeekFrom::Start(range.start))?;
            (file.by_ref().take(range.end - range.start)).read_to_end(&mut bytes)?;
            if !head.add(range, &bytes) {
                break;
            }
        }
        if let Some(head) = InputFile::photograph(head) {
            self.sources.insert(head.path.clone(), path.to_owned());
            return Ok(head);
        }
        Ok(InputFile::new(relative, fs::read(path)?))
    }

    /// Other files of the same scene, in their order.
    pub(super) fn with(self, files: Vec<InputFile>) -> Self {
        Self { files, ..self }
    }

    /// Length and sum of every file, also of those that are not in memory as a whole.
    pub(super) fn stamps(&self) -> ridgeline::Result<Vec<InputStamp>> {
        let stamp = |file: &InputFile| match file.lacking() {
            None => Ok(InputStamp::of_whole(file)),
            Some(source) => {
                let opened = File::open(&self.sources[source]);
                let read = opened.and_then(|whole| InputStamp::of_stream(file, whole));
                read.map_err(|e| gone(file, &e.to_string()))
            }
        };
        self.files.iter().map(stamp).collect()
    }
}

impl FileSource for SceneFiles {
    fn files(&self) -> &[InputFile] {
        &self.files
    }

    fn hold(&mut self, needed: &dyn Fn(&[InputFile]) -> Vec<Needed>) -> ridgeline::Result<()> {
        let needed = needed(&self.files);
        let (held, lacking): (Vec<_>, Vec<_>) =
            needed.iter().partition(|one| one.is_in(&self.files));
        for (i, file) in self.files.iter_mut().enumerate() {
            if held.iter().all(|one| one.file != i) {
                file.empty();
            }
        }
        for one in lacking {
            let file = &mut self.files[one.file];
            let Some(source) = file.lacking() else {
                continue;
            };
            let path = &self.sources[source];
            let filled = match &one.ranges {
                None => fs::read(path).map(|bytes| file.fill(bytes)),
                Some(ranges) => read_beside_head(path, file, ranges)
                    .map(|bytes| bytes.is_some_and(|bytes| file.fill_ranges(ranges, &bytes))),
            };
            match filled {
                Ok(true) => {}
                Ok(false) => return Err(gone(file, "it has changed since its head was read")),
                Err(e) => return Err(gone(file, &e.to_string())),
            }
        }
        Ok(())
    }
}

/// Some ranges of a photograph, one after the other; `None` where its length or head has changed.
fn read_beside_head(
    path: &Path,
    file: &InputFile,
    ranges: &[Range<u64>],
) -> io::Result<Option<Vec<u8>>> {
    let head = read_ranges(path, &file.head_places())?;
    let is_same = fs::metadata(path)?.len() == file.length() && *head == *file.head();
    (is_same.then(|| read_ranges(path, ranges))).transpose()
}

/// Some ranges of a file, one after the other.
fn read_ranges(path: &Path, ranges: &[Range<u64>]) -> io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    let mut bytes = Vec::new();
    for range in ranges {
        file.seek(SeekFrom::Start(range.start))?;
        (file.by_ref().take(range.end - range.start)).read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// The refusal of a photograph that was there when the scene was read.
fn gone(file: &InputFile, problem: &str) -> ridgeline::Error {
    ridgeline::Error::file(
        &file.path,
        format!("the photograph can no longer be read: {problem}"),
        "leave the files of a scene as they are while it is read, and start again",
    )
}
