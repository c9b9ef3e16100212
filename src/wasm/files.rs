//! The session's photographs, whole only while a call needs their pixels.

use wasm_bindgen::prelude::*;

use super::convert::{named_error, to_js};
use super::session::{Session, load_options};
use crate::orientation::{InputFile, PhotographHead};
use crate::raster::HeaderNeeds;
use crate::scene_loader::{files_of_ground, files_of_views};

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
        let begun = self.head.take().filter(|_| bytes.is_some());
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

    /// Leaves the heads of all photographs that were filled.
    #[wasm_bindgen(js_name = emptyFiles)]
    pub fn empty_files(&mut self) {
        self.files.iter_mut().for_each(InputFile::empty);
    }

    /// The paths of all photographs that are not whole.
    #[wasm_bindgen(js_name = lackingFiles)]
    pub fn lacking_files(&self) -> Vec<String> {
        let all: Vec<usize> = (0..self.files.len()).collect();
        self.lacking(&all)
    }

    /// The paths of the photographs that `load` needs first, to measure the ground: to be filled.
    #[wasm_bindgen(js_name = groundFilesOfLoad)]
    pub fn ground_files_of_load(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
    ) -> Result<Vec<String>, JsValue> {
        let needed = files_of_ground(&self.files, &load_options(&options)?);
        Ok(self.lacking(&needed))
    }

    /// The paths of the photographs that `load` makes views of, once the others are filled.
    #[wasm_bindgen(js_name = viewFilesOfLoad)]
    pub fn view_files_of_load(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
    ) -> Result<Vec<String>, JsValue> {
        let needed = files_of_views(&self.files, &load_options(&options)?);
        Ok(self.lacking(&needed))
    }
}

impl Session {
    /// The paths of those among these files that are not whole.
    pub(crate) fn lacking(&self, of: &[usize]) -> Vec<String> {
        let files = of.iter().map(|&i| &self.files[i]);
        let lacking = files.filter(|file| file.lacking().is_some());
        lacking.map(|file| file.path.clone()).collect()
    }
}
