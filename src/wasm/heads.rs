//! Photographs of which the session holds the first bytes only, until their pixels are needed: a
//! flight is larger than the memory that a page has.

use std::collections::BTreeMap;

use image::ImageFormat;
use wasm_bindgen::prelude::*;

use super::convert::named_error;
use super::session::{Session, load_options};
use crate::orientation::InputFile;
use crate::raster::{image_format, image_header};
use crate::scene_loader::{files_of_ground, files_of_views};

/// Which files are heads, by their paths.
#[derive(Default)]
pub(crate) struct Heads(BTreeMap<String, Head>);

#[derive(Clone, Copy)]
struct Head {
    /// Bytes of the head, and of the whole.
    bytes: usize,
    whole: u64,
    is_filled: bool,
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
