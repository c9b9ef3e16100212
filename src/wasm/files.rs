//! The session's photographs, whole only while a call needs their pixels.

use wasm_bindgen::prelude::*;

use super::convert::named_error;
use super::session::{Session, load_options};
use crate::orientation::InputFile;
use crate::scene_loader::{files_of_ground, files_of_views};

#[wasm_bindgen]
impl Session {
    /// Adds a photograph by its first bytes, `whole` being its length; false where they do not
    /// suffice to plan with.
    #[wasm_bindgen(js_name = addHead)]
    pub fn add_head(&mut self, path: &str, bytes: Vec<u8>, whole: f64) -> bool {
        let file = InputFile::photograph(path, bytes, whole as u64);
        file.map(|file| self.put(file)).is_ok()
    }

    /// Gives a photograph its whole bytes.
    #[wasm_bindgen(js_name = fillFile)]
    pub fn fill_file(&mut self, path: &str, bytes: Vec<u8>) -> Result<(), JsValue> {
        let mut added = self.files.iter_mut().filter(|file| file.path == path);
        match added.next().is_some_and(|file| file.fill(bytes)) {
            true => Ok(()),
            false => Err(named_error("RangeError", &format!("{path} is not lacking"))),
        }
    }

    /// Leaves the first bytes of all photographs that were filled.
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
