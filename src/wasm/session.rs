//! A project in the page: files in, stages one by one, results out.

use js_sys::Function;
use serde::{Deserialize, Serialize};
use wasm_bindgen::prelude::*;

use super::convert::{
    ViewInfo, from_js, input_error, listener_of, named_error, to_js, write_panics,
};
use crate::base::execution::MergedShards;
use crate::base::params::Params;
use crate::orienting::orientation::{InputFile, PhotographHead};
use crate::orienting::scene_loader::{
    LoadOptions, Project, SHOWN, inspect_files, load_scene, open_project, opened_model, unpack,
};
use crate::pipeline::{PackedView, Run, Stage};
use crate::planes::half_planes::PointsOfInterest;
use crate::results::export::ReportedModel;
use crate::tiles::Area;

/// Files, parameters and the reconstruction made of them.
#[wasm_bindgen]
#[derive(Default)]
pub struct Session {
    /// Of large photographs the head only, until their pixels are needed.
    pub(crate) files: Vec<InputFile>,
    /// The head of a photograph that is being added.
    pub(crate) head: Option<PhotographHead>,
    /// The project that was added last.
    project: Option<Project>,
    pub(crate) params: Params,
    pub(crate) run: Option<Run>,
    /// Views from another session, until they are all there.
    pub(crate) packed: Vec<PackedView>,
    /// A large area that is worked off in tiles.
    pub(crate) area: Option<Area>,
    /// What the sessions that divide this run between them found of the next stage.
    pub(crate) merged: MergedShards,
    /// Written on first request after the last stage.
    pub(crate) outputs: Option<Vec<(String, Vec<u8>)>>,
    /// The model of tiles that were joined, for another report of it.
    pub(crate) joined: Option<ReportedModel>,
    /// Points of interest, found on first request for a figure.
    pub(crate) points: Option<Vec<PointsOfInterest>>,
}

/// What `load` may be told; see [`LoadOptions`].
#[derive(Default, Deserialize, Serialize, tsify::Tsify)]
#[serde(rename_all = "camelCase", default, deny_unknown_fields)]
#[tsify(rename = "LoadOptions")]
struct JsLoadOptions {
    /// Path (or folder) of the orientation to take.
    #[tsify(optional)]
    orientation: Option<String>,
    /// Names of the images to use; all when absent.
    #[tsify(optional)]
    views: Option<Vec<String>>,
    /// x0, y0, x1, y1, metres, in the frame of the orientation.
    #[tsify(optional)]
    roi: Option<[f64; 4]>,
    /// Most views of the region of interest; 12 when absent.
    #[tsify(optional)]
    max_views: Option<usize>,
    /// Factor by which photographs are reduced; large ones as far as roofs allow when absent.
    #[tsify(optional)]
    reduction: Option<f64>,
    /// Height of the ground, metres, in the frame of the orientation.
    #[tsify(optional)]
    ground_z: Option<f64>,
    /// Path of the terrain model among the files; the only one among them when absent.
    #[tsify(optional)]
    terrain: Option<String>,
    /// Standard deviation of its heights, metres.
    #[tsify(optional)]
    terrain_accuracy_m: Option<f64>,
    /// Path of the footprints among the files; the only GeoJSON of footprints when absent.
    #[tsify(optional)]
    footprints: Option<String>,
    /// Standard deviation of their borders, metres.
    #[tsify(optional)]
    footprint_accuracy_m: Option<f64>,
    /// Path of the point cloud among the files; the only one among them when absent.
    #[tsify(optional)]
    point_cloud: Option<String>,
    /// Standard deviation of its heights, metres.
    #[tsify(optional)]
    point_cloud_accuracy_m: Option<f64>,
    /// Paths of terrain models, footprints and point clouds that are among the files and not used.
    #[tsify(optional)]
    unused: Vec<String>,
    /// EPSG's number of the world's reference system.
    #[tsify(optional)]
    epsg: Option<u32>,
    /// Undo the mistake in the orientation that the images give away.
    #[tsify(optional)]
    apply_fix: bool,
    /// Go on where the images do not agree with their orientation.
    #[tsify(optional)]
    ignore_check: bool,
}

/// What `openedProject` returns.
#[derive(Serialize, tsify::Tsify)]
struct OpenedProject<'a> {
    /// Null stands for what it leaves open.
    #[tsify(type = "{ [K in keyof LoadOptions]-?: LoadOptions[K] | null }")]
    options: JsLoadOptions,
    params: &'a Params,
}

/// What `load` and `scene` return.
#[derive(Serialize, tsify::Tsify)]
struct SceneInfo {
    views: Vec<ViewInfo>,
    origin: [f64; 3],
    warnings: Vec<String>,
    agreement: Option<crate::base::agreement::AgreementReport>,
    known: KnownFiles,
}

/// The files that are taken as what is known beforehand.
#[derive(Serialize, tsify::Tsify)]
struct KnownFiles {
    terrain: Option<String>,
    footprints: Option<String>,
    point_cloud: Option<String>,
}

#[wasm_bindgen]
impl Session {
    /// An empty session with the default parameters.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        write_panics();
        Self::default()
    }

    /// The names of the stages that the sources of planes need, in order.
    #[wasm_bindgen(js_name = chosenStages)]
    pub fn chosen_stages(&self) -> Vec<String> {
        Stage::of(self.params.sources())
            .iter()
            .map(|s| s.name().to_owned())
            .collect()
    }

    /// The parameters with their defaults, as a plain object.
    #[wasm_bindgen(js_name = defaultParams, unchecked_return_type = "Params")]
    pub fn default_params() -> Result<JsValue, JsValue> {
        to_js(&Params::default())
    }

    /// Adds an image or orientation file, or an archive of them; a file of the same path is
    /// replaced.
    #[wasm_bindgen(js_name = addFile)]
    pub fn add_file(&mut self, path: &str, bytes: Vec<u8>) -> Result<(), JsValue> {
        let opened = unpack(InputFile::new(path, bytes)).and_then(open_project);
        let (files, project) = opened.map_err(|e| input_error(&e))?;
        if let Some(project) = project {
            // A project is a whole state: nothing else stays.
            self.clear_files();
            self.params = project.params.clone();
            self.project = Some(project);
        }
        for added in files {
            self.put(added);
        }
        Ok(())
    }

    /// The wishes and parameters of the project among the added files, `{options, params}`; null
    /// where there is none.
    #[wasm_bindgen(js_name = openedProject, unchecked_return_type = "OpenedProject | null")]
    pub fn opened_project(&self) -> Result<JsValue, JsValue> {
        to_js(&self.project.as_ref().map(|project| OpenedProject {
            options: JsLoadOptions::from(&project.options),
            params: &project.params,
        }))
    }

    /// What the page showed when the project among the added files was written by this version;
    /// empty otherwise.
    #[wasm_bindgen(js_name = openedResults, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn opened_results(&self) -> Vec<u8> {
        (self.project.as_ref()).map_or_else(Vec::new, |project| project.shown.clone())
    }

    /// The files, the options of `load`, the parameters, the results so far and what the page shows
    /// of them (empty for nothing) as a project file (.zip).
    #[wasm_bindgen(js_name = exportProject, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn export_project(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
        shown: Vec<u8>,
    ) -> Result<Vec<u8>, JsValue> {
        let project = Project::new(load_options(&options)?, self.params.clone());
        let of_run = || self.run.as_ref().map(|run| run.files(&[]));
        let mut results = self.outputs.clone().or_else(of_run).unwrap_or_default();
        if !shown.is_empty() {
            results.push((SHOWN.to_owned(), shown));
        }
        project
            .pack(&self.files, &results)
            .map_err(|e| input_error(&e))
    }

    /// Forgets all files and all results.
    #[wasm_bindgen(js_name = clearFiles)]
    pub fn clear_files(&mut self) {
        self.files.clear();
        self.head = None;
        self.packed.clear();
        self.merged = MergedShards::default();
        self.project = None;
        self.area = None;
        self.run = None;
        self.outputs = None;
        self.joined = None;
        self.points = None;
    }

    /// What the files are: their kinds, sizes, orientation status, and warnings; under the options
    /// of `load`.
    #[wasm_bindgen(unchecked_return_type = "Inspection")]
    pub fn inspect(
        &self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
    ) -> Result<JsValue, JsValue> {
        let options = load_options(&options)?;
        to_js(&inspect_files(&self.files, &options))
    }

    /// Makes a scene of the files: `{orientation?, views?, roi?, groundZ?}` in, `{views, origin,
    /// warnings}` out.
    #[wasm_bindgen(unchecked_return_type = "SceneInfo")]
    pub fn load(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "LoadOptions")] options: JsValue,
    ) -> Result<JsValue, JsValue> {
        let options = load_options(&options)?;
        self.area = None;
        self.merged = MergedShards::default();
        self.run = None;
        self.outputs = None;
        self.points = None;
        self.run = Some(match opened_model(&self.files) {
            Some(file) => Run::of_model(file.bytes.clone(), self.params.clone())
                .map_err(|e| named_error("InputError", &format!("{}: {e}", file.path)))?,
            None => {
                let scene = load_scene(&self.files, &options).map_err(|e| input_error(&e))?;
                Run::new(scene, self.params.clone())
            }
        });
        self.scene()
    }

    /// The loaded scene, its views adjusted as far as the stages have run.
    #[wasm_bindgen(unchecked_return_type = "SceneInfo")]
    pub fn scene(&self) -> Result<JsValue, JsValue> {
        let scene = self.loaded()?.scene();
        let views = (scene.views.iter()).map(|view| ViewInfo::new(&view.name, &view.camera));
        to_js(&SceneInfo {
            views: views.collect(),
            origin: scene.origin.into(),
            warnings: scene.warnings.clone(),
            agreement: scene.survey.agreement.clone(),
            known: KnownFiles {
                terrain: scene.known.terrain.as_ref().map(|t| t.file.clone()),
                footprints: scene.known.footprints.as_ref().map(|f| f.file.clone()),
                point_cloud: scene.known.point_cloud.as_ref().map(|c| c.file.clone()),
            },
        })
    }

    /// Sets the parameters (what is missing takes its default) and drops the results that they
    /// change.
    #[wasm_bindgen(js_name = setParams)]
    pub fn set_params(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Params")] params: JsValue,
    ) -> Result<(), JsValue> {
        self.params = from_js(&params, "parameters")?;
        self.merged = MergedShards::default();
        self.outputs = None;
        self.points = None;
        if let Some(run) = &mut self.run {
            run.set_params(self.params.clone());
        }
        Ok(())
    }

    /// Runs a stage (after those before it that are missing), with the merged shards of its maps;
    /// `{stage, counts, warnings}`.
    #[wasm_bindgen(js_name = runStage, unchecked_return_type = "StageSummary")]
    pub fn run_stage(
        &mut self,
        name: &str,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => void")] on_progress: &Function,
    ) -> Result<JsValue, JsValue> {
        let stage = stage_of(name)?;
        self.outputs = None;
        let merged = std::mem::take(&mut self.merged);
        let run = self.loaded_mut()?;
        to_js(&run.step_merged(stage, merged, &listener_of(on_progress)))
    }

    /// Runs the adjustment of the views once; as `runStage` where they stay. Where views moved,
    /// null: the stages from the matches on are to be run again, which sessions may divide.
    #[wasm_bindgen(js_name = adjustOnce, unchecked_return_type = "StageSummary | null")]
    pub fn adjust_once(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => void")] on_progress: &Function,
    ) -> Result<JsValue, JsValue> {
        self.outputs = None;
        to_js(&self.loaded_mut()?.adjust_once(&listener_of(on_progress)))
    }

    /// Puts a file in its place, or in that of another one of its path.
    pub(crate) fn put(&mut self, added: InputFile) {
        self.files.retain(|file| file.path != added.path);
        self.files.push(added);
        self.files.sort_by(|a, b| a.path.cmp(&b.path));
    }

    pub(crate) fn loaded(&self) -> Result<&Run, JsValue> {
        self.run.as_ref().ok_or_else(not_loaded)
    }

    pub(crate) fn loaded_mut(&mut self) -> Result<&mut Run, JsValue> {
        self.run.as_mut().ok_or_else(not_loaded)
    }
}

/// The stage of this name.
pub(crate) fn stage_of(name: &str) -> Result<Stage, JsValue> {
    Stage::from_name(name)
        .ok_or_else(|| named_error("RangeError", &format!("no stage is called '{name}'")))
}

pub(crate) fn load_options(options: &JsValue) -> Result<LoadOptions, JsValue> {
    let options: Option<JsLoadOptions> = from_js(options, "options of load")?;
    let options = options.unwrap_or_default();
    Ok(LoadOptions {
        orientation: options.orientation,
        views: options.views,
        roi: options.roi,
        max_views: options.max_views,
        ground_z: options.ground_z,
        ground_range: None,
        reduction: options.reduction,
        terrain: options.terrain,
        terrain_accuracy_m: options.terrain_accuracy_m,
        footprints: options.footprints,
        footprint_accuracy_m: options.footprint_accuracy_m,
        point_cloud: options.point_cloud,
        point_cloud_accuracy_m: options.point_cloud_accuracy_m,
        unused: options.unused,
        epsg: options.epsg,
        memory_mb: None,
        apply_fix: options.apply_fix,
        ignore_check: options.ignore_check,
    })
}

impl From<&LoadOptions> for JsLoadOptions {
    fn from(options: &LoadOptions) -> Self {
        Self {
            orientation: options.orientation.clone(),
            views: options.views.clone(),
            roi: options.roi,
            max_views: options.max_views,
            ground_z: options.ground_z,
            reduction: options.reduction,
            terrain: options.terrain.clone(),
            terrain_accuracy_m: options.terrain_accuracy_m,
            footprints: options.footprints.clone(),
            footprint_accuracy_m: options.footprint_accuracy_m,
            point_cloud: options.point_cloud.clone(),
            point_cloud_accuracy_m: options.point_cloud_accuracy_m,
            unused: options.unused.clone(),
            epsg: options.epsg,
            apply_fix: options.apply_fix,
            ignore_check: options.ignore_check,
        }
    }
}

pub(crate) fn not_loaded() -> JsValue {
    named_error(
        "InputError",
        "no scene is loaded; add files and load them first",
    )
}
