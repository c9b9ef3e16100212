//! The files of a scene: of large photographs the first bytes are in memory, until a step needs
//! their pixels.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use ridgeline::orientation::{FileSource, InputFile};
use ridgeline::tiles::InputStamp;

/// The headers of most photographs fit into the first of these; what has its own behind all of
/// them is read whole. As on the page (`www/src/worker/projectFiles.ts`).
const HEAD_BYTES: [usize; 3] = [64 << 10, 512 << 10, 2 << 20];

/// Files in memory, and where photographs lie of which only the first bytes are there.
#[derive(Default)]
pub(super) struct SceneFiles {
    pub files: Vec<InputFile>,
    sources: BTreeMap<String, PathBuf>,
}

impl SceneFiles {
    /// Reads a file, of a large photograph the first bytes; `relative` is its path in the scene.
    pub(super) fn read(&mut self, path: &Path, relative: &str) -> io::Result<InputFile> {
        let mut file = File::open(path)?;
        let length = file.metadata()?.len();
        let mut bytes = Vec::new();
        for size in HEAD_BYTES {
            if length <= size as u64 {
                break;
            }
            let more = (size - bytes.len()) as u64;
            file.by_ref().take(more).read_to_end(&mut bytes)?;
            if !is_photograph(&bytes) {
                break;
            }
            match InputFile::photograph(relative, bytes, length) {
                Ok(head) => {
                    self.sources.insert(head.path.clone(), path.to_owned());
                    return Ok(head);
                }
                Err(back) => bytes = back,
            }
        }
        let rest = usize::try_from(length).unwrap_or_default();
        bytes.try_reserve_exact(rest.saturating_sub(bytes.len()))?;
        file.read_to_end(&mut bytes)?;
        Ok(InputFile::new(relative, bytes))
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
            let is_same = bytes.len() as u64 == file.length() && bytes.starts_with(&file.bytes);
            if !is_same {
                return Err(gone(file, "it has changed since its first bytes were read"));
            }
            file.fill(bytes);
        }
        Ok(())
    }
}

/// A JPEG or a PNG, by its first bytes: others say what they are anywhere.
fn is_photograph(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0xff, 0xd8]) || bytes.starts_with(b"\x89PNG")
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
