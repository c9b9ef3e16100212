//! Photographs of which the session holds the first bytes only, until their pixels are needed: a
//! flight is larger than the memory that a page has.

use std::collections::BTreeMap;

use crate::orientation::InputFile;

/// Which files are heads, by their paths.
#[derive(Default)]
pub(crate) struct Heads(pub(crate) BTreeMap<String, Head>);

/// What is known of a photograph by its first bytes.
#[derive(Clone, Copy)]
pub(crate) struct Head {
    /// Bytes of the head.
    pub bytes: usize,
    /// Bytes of the whole file.
    pub whole: u64,
    /// Are all of them here?
    pub is_filled: bool,
}

impl Heads {
    pub(crate) fn forget(&mut self, path: &str) {
        self.0.remove(path);
    }

    fn is_lacking(&self, file: &InputFile) -> bool {
        (self.0.get(&file.path)).is_some_and(|head| !head.is_filled)
    }

    /// The bytes that these files have beyond what is here.
    pub(crate) fn lacking_bytes(&self, files: &[InputFile], of: &[usize]) -> u64 {
        let lacking = |&i: &usize| {
            let head = self.0.get(&files[i].path).filter(|head| !head.is_filled);
            head.map_or(0, |head| head.whole.saturating_sub(head.bytes as u64))
        };
        of.iter().map(lacking).sum()
    }

    /// The paths of those among these files that are not whole.
    pub(crate) fn lacking(&self, files: &[InputFile], of: &[usize]) -> Vec<String> {
        let files = of.iter().map(|&i| &files[i]);
        let lacking = files.filter(|file| self.is_lacking(file));
        lacking.map(|file| file.path.clone()).collect()
    }
}
