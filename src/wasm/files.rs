//! The session's photographs, whole only while a call needs their pixels.

use std::ops::Range;

use serde::Serialize;
use wasm_bindgen::prelude::*;

use super::convert::{named_error, to_js};
use super::session::{Session, load_options};
use crate::orienting::orientation::{InputFile, Needed, PhotographHead};
use crate::orienting::scene_loader::{files_of_ground, files_of_views};
use crate::photographs::raster::HeaderNeeds;

#[wasm_bindgen]
impl Session {
    /// Adds a photograph by its head, of a file of `whole` bytes, range by range: begins it without
    /// `bytes`, and goes on with those of the range that was answered. Answers the next range, true
    /// when the photograph is added, and false where the file is to be added whole.
    #[wasm_bindgen(js_name = addHead, unchecked_return_type = "[from: number, to: number] | boolean")]
    pub fn add_head(
        &mut self,
        path: &str,
        whole: f64,
        bytes: Option<Vec<u8>>,
    ) -> Result<JsValue, JsValue> {
        let begun = (self.head.take()).filter(|head| bytes.is_some() && head.is_of(path));
        let mut head = begun.unwrap_or_else(|| PhotographHead::new(path, whole as u64));
        if let (HeaderNeeds::Range(range), Some(bytes)) = (head.needs(), bytes)
            && !head.add(range, &bytes)
        {
            return Ok(false.into());
        }
        if let HeaderNeeds::Range(range) = head.needs() {
            self.head = Some(head);
            return to_js(&[range.start as f64, range.end as f64]);
        }
        let file = InputFile::photograph(head).map(|file| self.put(file));
        Ok(file.is_some().into())
    }

    /// Gives a photograph its whole bytes.
    #[wasm_bindgen(js_name = fillFile)]
    pub fn fill_file(&mut self, path: &str, bytes: Vec<u8>) -> Result<(), JsValue> {
        let mut added = self.files.iter_mut().filter(|file| file.path == path);
        match added.next().is_some_and(|file| file.fill(bytes)) {
            true => Ok(()),
            false => Err(named_error(
                "RangeError",
                &format!("{path}: the file is whole, or has changed since its head was read"),
            )),
        }
    }

    /// Gives a photograph ranges of its bytes beside its head: `places` are the first place of each
    /// and the one behind its last, `bytes` those of all, one after the other.
    #[wasm_bindgen(js_name = fillRanges)]
    pub fn fill_ranges(&mut self, path: &str, places: &[f64], bytes: &[u8]) -> Result<(), JsValue> {
        let ranges: Vec<Range<u64>> = (places.chunks_exact(2))
            .map(|ends| ends[0] as u64..ends[1] as u64)
            .collect();
        let mut added = self.files.iter_mut().filter(|file| file.path == path);
        match (added.next()).is_some_and(|file| file.fill_ranges(&ranges, bytes)) {
            true => Ok(()),
            false => Err(named_error(
                "RangeError",
                &format!("{path}: the file is whole, or has become shorter"),
            )),
        }
    }

    /// Leaves the heads of all photographs that were filled.
    #[wasm_bindgen(js_name = emptyFiles)]
    pub fn empty_files(&mut self) {
        self.files.iter_mut().for_each(InputFile::empty);
    }

    /// All photographs that are not whole, to be filled.
    #[wasm_bindgen(js_name = lackingFiles, unchecked_return_type = "LackingFile[]")]
    pub fn lacking_files(&self) -> Result<JsValue, JsValue> {
        self.lacking(&Needed::all(&self.files))
    }

    /// The photographs that `load` needs first, to measure the ground: to be filled.
    #[wasm_bindgen(js_name = groundFilesOfLoad, unchecked_return_type = "LackingFile[]")]
    pub fn ground_files_of_load(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
    ) -> Result<JsValue, JsValue> {
        let needed = files_of_ground(&self.files, &load_options(&options)?);
        self.lacking(&needed)
    }

    /// The photographs that `load` makes views of, once the others are filled.
    #[wasm_bindgen(js_name = viewFilesOfLoad, unchecked_return_type = "LackingFile[]")]
    pub fn view_files_of_load(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
    ) -> Result<JsValue, JsValue> {
        let needed = files_of_views(&self.files, &load_options(&options)?);
        self.lacking(&needed)
    }
}

/// A photograph that is not filled with what a call needs of it.
#[derive(Serialize, tsify::Tsify)]
struct LackingFile<'a> {
    path: &'a str,
    /// Of each range that is needed the first place and the one behind its last; null for all.
    #[tsify(type = "number[] | null")]
    places: Option<Vec<f64>>,
}

impl Session {
    /// Those of which what is needed is not in memory.
    pub(crate) fn lacking(&self, needed: &[Needed]) -> Result<JsValue, JsValue> {
        let lacking = needed.iter().filter(|one| !one.is_in(&self.files));
        let ends = |range: &Range<u64>| [range.start as f64, range.end as f64];
        let lacking = lacking.map(|one| LackingFile {
            path: &self.files[one.file].path,
            places: (one.ranges.as_ref()).map(|ranges| ranges.iter().flat_map(ends).collect()),
        });
        to_js(&lacking.collect::<Vec<_>>())
    }
}
