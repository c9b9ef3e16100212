//! One run over several workers: each has a session with the same scene, and does its shard of a
//! stage's maps ([`crate::base::execution::shard`]). The page carries the bytes between them.

use js_sys::{Function, Uint8Array};
use wasm_bindgen::prelude::*;

use super::convert::{foreign, listener_of, merge_all, named_error, to_js};
use super::session::{Session, stage_of};
use crate::base::execution::MergedShards;
use crate::pipeline::{PackedView, Run};

#[wasm_bindgen]
impl Session {
    /// The maps of a stage that sessions may divide between them, in their order.
    #[wasm_bindgen(js_name = shardMaps)]
    pub fn shard_maps(&self, stage: &str) -> Result<Vec<String>, JsValue> {
        let maps = stage_of(stage)?.shard_maps();
        Ok(maps.iter().map(|&map| map.to_owned()).collect())
    }

    /// Do these maps read the views' colours?
    #[wasm_bindgen(js_name = shardsReadColours)]
    pub fn shards_read_colours(&self, stage: &str) -> Result<bool, JsValue> {
        Ok(stage_of(stage)?.shards_read_colours())
    }

    /// A view of the loaded scene, for `takeView` of another session.
    #[wasm_bindgen(js_name = packView, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn pack_view(&self, view: usize, with_colours: bool) -> Result<Vec<u8>, JsValue> {
        PackedView::new(self.loaded()?.scene(), view, with_colours)
            .map(|packed| packed.to_bytes())
            .ok_or_else(|| named_error("RangeError", &format!("there is no view {view}")))
    }

    /// Takes a view that another session packed, one after the other; with the last of them the
    /// scene is made.
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

    /// The cameras, for `takeCameras` of the other sessions before each stage.
    #[wasm_bindgen(js_name = packCameras, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn pack_cameras(&self) -> Result<Vec<u8>, JsValue> {
        Ok(self.loaded()?.pack_cameras())
    }

    /// Takes the cameras of another session, which its adjustment may have moved.
    #[wasm_bindgen(js_name = takeCameras)]
    pub fn take_cameras(&mut self, packed: Vec<u8>) -> Result<(), JsValue> {
        match self.loaded_mut()?.take_cameras(&packed) {
            true => Ok(()),
            false => Err(foreign("the cameras of the views")),
        }
    }

    /// What a stage found, as far as sharded maps of later stages read it; empty otherwise.
    #[wasm_bindgen(js_name = handOver, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
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

    /// The shard of session `index` of so many of a map of a stage, for `mergeShards` of all
    /// sessions.
    #[wasm_bindgen(js_name = runShard, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn run_shard(
        &mut self,
        stage: &str,
        map: &str,
        index: usize,
        of: usize,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => void")] on_progress: &Function,
    ) -> Result<Vec<u8>, JsValue> {
        let stage = stage_of(stage)?;
        if stage.shard_maps().first() == Some(&map) {
            self.merged = MergedShards::default();
        }
        let merged = self.merged.clone();
        self.outputs = None;
        let run = self.loaded_mut()?;
        Ok(run.run_shard(stage, map, [index, of], merged, &listener_of(on_progress)))
    }

    /// Takes the shards of a map from all sessions, in the order of their index.
    #[wasm_bindgen(js_name = mergeShards)]
    pub fn merge_shards(&mut self, map: &str, shards: Vec<Uint8Array>) -> Result<(), JsValue> {
        merge_all(&mut self.merged, map, &shards)
    }

    /// The views reduced for a first look at the model, for `firstLook` of another session; empty
    /// where this one is done soon.
    #[wasm_bindgen(js_name = packPreliminary, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn pack_preliminary(&self) -> Result<Vec<u8>, JsValue> {
        Ok(self.loaded()?.pack_preliminary())
    }

    /// The facets of a preliminary model, of the views that another session reduced and the present
    /// parameters. Nothing stays in the session.
    #[wasm_bindgen(js_name = firstLook, unchecked_return_type = "Facet[]")]
    pub fn first_look(&self, packed: Vec<u8>) -> Result<JsValue, JsValue> {
        let run = Run::of_preliminary(&packed, &self.params);
        let mut run = run.ok_or_else(|| foreign("the views of a first look"))?;
        to_js(&run.first_look().facets)
    }
}
