//! The files of a scene: of large photographs the head is in memory, until a step needs their
//! pixels.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use ridgeline::orientation::{FileSource, InputFile, PhotographHead};
use ridgeline::raster::HeaderNeeds;
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

    fn hold(&mut self, needed: &dyn Fn(&[InputFile]) -> Vec<usize>) -> ridgeline::Result<()> {
        let needed: BTreeSet<usize> = needed(&self.files).into_iter().collect();
        let others = self.files.iter_mut().enumerate();
        let others = others.filter(|(i, _)| !needed.contains(i));
        others.for_each(|(_, file)| file.empty());
        for i in needed {
            let file = &mut self.files[i];
            let Some(source) = file.lacking() else {
                continue;
            };
            let bytes = fs::read(&self.sources[source]).map_err(|e| gone(file, &e.to_string()))?;
            if !file.fill(bytes) {
                return Err(gone(file, "it has changed since its head was read"));
            }
        }
        Ok(())
    }
}

/// The refusal of a photograph that was there when the scene was read.
fn gone(file: &InputFile, problem: &str) -> ridgeline::Error {
    ridgeline::Error::File {
        file: file.path.clone(),
        problem: format!("the photograph can no longer be read: {problem}"),
        advice: "leave the files of a scene as they are while it is read, and start again"
            .to_owned(),
    }
}
