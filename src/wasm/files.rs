//! The session's photographs, whole only while a call needs their pixels.

use image::ImageFormat;
use wasm_bindgen::prelude::*;

use super::convert::named_error;
use super::heads::Head;
use super::session::{Session, load_options};
use crate::orientation::InputFile;
use crate::raster::{image_format, image_header};
use crate::scene_loader::{files_of_ground, files_of_views};

#[wasm_bindgen]
impl Session {
    /// Adds a photograph by its first bytes, `whole` being its length; false where they do not
    /// suffice to plan with.
    #[wasm_bindgen(js_name = addHead)]
    pub fn add_head(&mut self, path: &str, bytes: Vec<u8>, whole: f64) -> bool {
        let file = InputFile::new(path, bytes);
        // The directory of a TIFF may stand at its end.
        let is_enough = image_format(&file.bytes).is_some_and(|format| format != ImageFormat::Tiff)
            && image_header(&file.path, &file.bytes).is_ok();
        if is_enough {
            let head = Head {
                bytes: file.bytes.len(),
                whole: whole as u64,
                is_filled: false,
            };
            self.heads.0.insert(file.path.clone(), head);
            self.put(file);
        }
        is_enough
    }

    /// Gives a photograph its whole bytes.
    #[wasm_bindgen(js_name = fillFile)]
    pub fn fill_file(&mut self, path: &str, bytes: Vec<u8>) -> Result<(), JsValue> {
        let file = InputFile::new(path, bytes);
        let head = (self.heads.0.get_mut(&file.path))
            .ok_or_else(|| named_error("RangeError", &format!("{path} is not lacking")))?;
        head.is_filled = true;
        self.put(file);
        Ok(())
    }

    /// Leaves the first bytes of all photographs that were filled.
    #[wasm_bindgen(js_name = emptyFiles)]
    pub fn empty_files(&mut self) {
        for file in &mut self.files {
            let head = self.heads.0.get_mut(&file.path);
            if let Some(head) = head.filter(|head| head.is_filled) {
                head.is_filled = false;
                file.bytes.truncate(head.bytes);
                file.bytes.shrink_to_fit();
            }
        }
    }

    /// The paths of all photographs that are not whole.
    #[wasm_bindgen(js_name = lackingFiles)]
    pub fn lacking_files(&self) -> Vec<String> {
        let all: Vec<usize> = (0..self.files.len()).collect();
        self.heads.lacking(&self.files, &all)
    }

    /// The paths of the photographs that `load` needs first, to measure the ground: to be filled.
    #[wasm_bindgen(js_name = groundFilesOfLoad)]
    pub fn ground_files_of_load(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
    ) -> Result<Vec<String>, JsValue> {
        let needed = files_of_ground(&self.files, &load_options(&options)?);
        Ok(self.heads.lacking(&self.files, &needed))
    }

    /// The paths of the photographs that `load` makes views of, once the others are filled.
    #[wasm_bindgen(js_name = viewFilesOfLoad)]
    pub fn view_files_of_load(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
    ) -> Result<Vec<String>, JsValue> {
        let needed = files_of_views(&self.files, &load_options(&options)?);
        Ok(self.heads.lacking(&self.files, &needed))
    }
}
