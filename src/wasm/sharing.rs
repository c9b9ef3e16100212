//! One run over several workers: each has a session with the same scene, and does its share of a stage's maps
//! ([`crate::execution::shard`]). The page carries the bytes between them.

use js_sys::{Function, Uint8Array};
use wasm_bindgen::prelude::*;

use super::convert::named_error;
use super::session::{Session, listener_of, stage_of};
use crate::execution::{Known, Task};
use crate::pipeline::{PackedView, Run};

#[wasm_bindgen]
impl Session {
    /// The maps of a stage that sessions may share, in their order.
    #[wasm_bindgen(js_name = sharedMaps)]
    pub fn shared_maps(&self, stage: &str) -> Result<Vec<String>, JsValue> {
        let maps = stage_of(stage)?.shared_maps();
        Ok(maps.iter().map(|&map| map.to_owned()).collect())
    }

    /// Does sharing this stage need the views' colours?
    #[wasm_bindgen(js_name = sharesColours)]
    pub fn shares_colours(&self, stage: &str) -> Result<bool, JsValue> {
        Ok(stage_of(stage)?.shares_colours())
    }

    /// A view of the loaded scene, for `takeView` of another session.
    #[wasm_bindgen(js_name = packView)]
    pub fn pack_view(&self, view: usize, with_colours: bool) -> Result<Vec<u8>, JsValue> {
        PackedView::new(self.loaded()?.scene(), view, with_colours)
            .map(|packed| packed.to_bytes())
            .ok_or_else(|| named_error("RangeError", &format!("there is no view {view}")))
    }

    /// Takes a view that another session packed, one after the other; with the last of them the scene is made.
    #[wasm_bindgen(js_name = takeView)]
    pub fn take_view(&mut self, view: usize, of: usize, packed: Vec<u8>) -> Result<(), JsValue> {
        if view == 0 {
            self.clear_files();
        }
        let unpacked = PackedView::from_bytes(&packed).ok_or_else(|| foreign("a packed view"))?;
        self.packed.push(unpacked);
        if view + 1 == of {
            let views = std::mem::take(&mut self.packed);
            self.run = Some(Run::of_packed(views, self.params.clone()));
        }
        Ok(())
    }

    /// What a stage found, as far as sharing later stages needs it; empty otherwise.
    #[wasm_bindgen(js_name = handOver)]
    pub fn hand_over(&self, stage: &str) -> Result<Vec<u8>, JsValue> {
        Ok(self.loaded()?.hand_over(stage_of(stage)?))
    }

    /// Takes what another session handed over.
    #[wasm_bindgen(js_name = takeOver)]
    pub fn take_over(&mut self, stage: &str, found: Vec<u8>) -> Result<(), JsValue> {
        let name = stage_of(stage)?;
        match self.loaded_mut()?.take_over(name, &found) {
            true => Ok(()),
            false => Err(foreign("the results of a stage")),
        }
    }

    /// Does the items of a map of a stage that are dealt to instance `index` of so many; their results, for `learn` of all sessions.
    pub fn share(
        &mut self,
        stage: &str,
        map: &str,
        index: usize,
        of: usize,
        on_progress: &Function,
    ) -> Result<Vec<u8>, JsValue> {
        let stage = stage_of(stage)?;
        if stage.shared_maps().first() == Some(&map) {
            self.known = Known::default();
        }
        let task = Task {
            map: map.to_owned(),
            index,
            of,
        };
        let known = self.known.clone();
        self.outputs = None;
        let run = self.loaded_mut()?;
        Ok(run.share(stage, task, known, &listener_of(on_progress)))
    }

    /// Takes the shares of all sessions of a map, in the order of their index.
    pub fn learn(&mut self, map: &str, shares: Vec<Uint8Array>) -> Result<(), JsValue> {
        for share in shares {
            if !self.known.add(map, &share.to_vec()) {
                return Err(foreign("a share of a map"));
            }
        }
        Ok(())
    }
}

fn foreign(what: &str) -> JsValue {
    named_error("TypeError", &format!("these bytes are not {what}"))
}
