//! A project in the page: files in, stages one by one, results out.

use std::sync::Arc;

use js_sys::{Float32Array, Float64Array, Function};
use serde::{Deserialize, Serialize};
use wasm_bindgen::prelude::*;

use super::convert::{
    end_points_px, from_js, input_error, line_array, named_error, row_major, segment_array, to_js,
};
use super::figures::{lines_of, segments_of};
use crate::doctor;
use crate::halfplane::PointsOfInterest;
use crate::linematch::SupportKind;
use crate::objectspace::{Window, WindowTrace};
use crate::params::{Method, Params};
use crate::pipeline::{PackedView, Run, Stage};
use crate::progress::Listener;
use crate::scene_loader::{
    InputFile, LoadOptions, Project, inspect_files, load_scene, open_project, unpack,
};
use crate::shares::Known;
use crate::sorting::sort_by;

/// Files, parameters and the reconstruction made of them.
#[wasm_bindgen]
#[derive(Default)]
pub struct Session {
    files: Vec<InputFile>,
    /// The project that was added last.
    project: Option<Project>,
    pub(super) params: Params,
    pub(super) run: Option<Run>,
    /// Views from another session, until they are all there.
    pub(super) packed: Vec<PackedView>,
    /// What the sessions that share this run found of the next stage.
    pub(super) known: Known,
    /// Written on first request after the last stage.
    pub(super) outputs: Option<Vec<(String, Vec<u8>)>>,
    /// Points of interest, found on first request for a figure.
    pub(super) points: Option<Vec<PointsOfInterest>>,
}

/// What `load` may be told; see [`LoadOptions`].
#[derive(Default, Deserialize, Serialize)]
#[serde(default, rename_all = "camelCase", deny_unknown_fields)]
struct JsLoadOptions {
    orientation: Option<String>,
    views: Option<Vec<String>>,
    roi: Option<[f64; 4]>,
    ground_z: Option<f64>,
    epsg: Option<u32>,
    apply_fix: bool,
    adjust: bool,
}

/// What `openedProject` returns.
#[derive(Serialize)]
struct OpenedProject<'a> {
    options: JsLoadOptions,
    params: &'a Params,
}

/// What `load` returns.
#[derive(Serialize)]
struct SceneInfo {
    views: Vec<ViewInfo>,
    origin: [f64; 3],
    warnings: Vec<String>,
    doctor: Option<doctor::Report>,
}

/// A view of the scene; its centre in metres, local frame, and its 3 x 4 matrix from there to pixels, row by row.
#[derive(Serialize)]
struct ViewInfo {
    name: String,
    width: u32,
    height: u32,
    center: [f64; 3],
    projection: Vec<f64>,
}

/// What `directions` returns.
#[derive(Serialize)]
struct Found<'a> {
    windows: &'a [Window],
    trace: &'a WindowTrace,
}

/// The pixels of a view, RGBA row by row: what `ImageData` takes.
#[wasm_bindgen(getter_with_clone)]
pub struct ViewImage {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// `4 * width * height` bytes.
    pub rgba: js_sys::Uint8ClampedArray,
}

#[wasm_bindgen]
impl Session {
    /// An empty session with the default parameters.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        console_error_panic_hook::set_once();
        Self::default()
    }

    /// The names of the stages of method "lines", in order.
    pub fn stages() -> Vec<String> {
        Stage::of(Method::Lines)
            .iter()
            .map(|s| s.name().to_owned())
            .collect()
    }

    /// The names of the stages of the method that the parameters choose, in order.
    #[wasm_bindgen(js_name = chosenStages)]
    pub fn chosen_stages(&self) -> Vec<String> {
        Stage::of(self.params.method)
            .iter()
            .map(|s| s.name().to_owned())
            .collect()
    }

    /// The parameters with their defaults, as a plain object.
    #[wasm_bindgen(js_name = defaultParams)]
    pub fn default_params() -> Result<JsValue, JsValue> {
        to_js(&Params::default())
    }

    /// Adds an image or orientation file, or an archive of them; a file of the same path is replaced.
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
            self.files.retain(|file| file.path != added.path);
            self.files.push(added);
        }
        sort_by(&mut self.files, |a, b| a.path.cmp(&b.path));
        Ok(())
    }

    /// The wishes and parameters of the project among the added files, `{options, params}`; null where there is none.
    #[wasm_bindgen(js_name = openedProject)]
    pub fn opened_project(&self) -> Result<JsValue, JsValue> {
        to_js(&self.project.as_ref().map(|project| OpenedProject {
            options: JsLoadOptions::from(&project.options),
            params: &project.params,
        }))
    }

    /// The files, the options of `load`, the parameters and the results so far as a project file (.zip).
    #[wasm_bindgen(js_name = exportProject)]
    pub fn export_project(&self, options: JsValue) -> Result<Vec<u8>, JsValue> {
        let project = Project::new(load_options(&options)?, self.params.clone());
        let results = self
            .run
            .as_ref()
            .map(|run| run.files(&[]))
            .unwrap_or_default();
        project
            .pack(&self.files, &results)
            .map_err(|e| input_error(&e))
    }

    /// Forgets all files and all results.
    #[wasm_bindgen(js_name = clearFiles)]
    pub fn clear_files(&mut self) {
        self.files.clear();
        self.packed.clear();
        self.known = Known::default();
        self.project = None;
        self.run = None;
        self.outputs = None;
        self.points = None;
    }

    /// What the files are: their kinds, sizes, orientation status, and warnings; under the options of
    /// `load`.
    pub fn inspect(&self, options: JsValue) -> Result<JsValue, JsValue> {
        to_js(&inspect_files(&self.files, &load_options(&options)?))
    }

    /// Makes a scene of the files: `{orientation?, views?, roi?, groundZ?}` in, `{views, origin,
    /// warnings}` out.
    pub fn load(&mut self, options: JsValue) -> Result<JsValue, JsValue> {
        let options = load_options(&options)?;
        self.run = None;
        self.outputs = None;
        self.points = None;
        let scene = load_scene(&self.files, &options).map_err(|e| input_error(&e))?;
        let views = scene.views.iter().map(|view| ViewInfo {
            name: view.name.clone(),
            width: view.camera.width,
            height: view.camera.height,
            center: view.camera.center.coords.into(),
            projection: row_major(&view.camera.projection_matrix()),
        });
        let info = to_js(&SceneInfo {
            views: views.collect(),
            origin: scene.origin.into(),
            warnings: scene.warnings.clone(),
            doctor: scene.survey.doctor.clone(),
        });
        self.run = Some(Run::new(scene, self.params.clone()));
        info
    }

    /// Sets the parameters (what is missing takes its default) and drops the results that they change.
    #[wasm_bindgen(js_name = setParams)]
    pub fn set_params(&mut self, params: JsValue) -> Result<(), JsValue> {
        self.params = from_js(&params, "parameters")?;
        self.outputs = None;
        self.points = None;
        if let Some(run) = &mut self.run {
            run.set_params(self.params.clone());
        }
        Ok(())
    }

    /// Runs a stage (after those before it that are missing), with what was learnt of its maps; `{stage, counts, warnings}`.
    #[wasm_bindgen(js_name = runStage)]
    pub fn run_stage(&mut self, name: &str, on_progress: &Function) -> Result<JsValue, JsValue> {
        let stage = stage_of(name)?;
        self.outputs = None;
        let known = std::mem::take(&mut self.known);
        let run = self.loaded_mut()?;
        to_js(&run.step_with(stage, known, &listener_of(on_progress)))
    }

    /// The segments of a view: x0, y0, x1, y1 each, pixels.
    pub fn segments(&self, view: usize) -> Result<Float32Array, JsValue> {
        let all = segments_of(self.loaded()?);
        let segments = all.get(view).map_or(&[][..], |s| s);
        Ok(segment_array(segments.iter().map(|s| &s.segment)))
    }

    /// The supports of the 3D lines (before that stage, of the matches) in a view: x0, y0, x1, y1 in pixels,
    /// kind (0 matched, 1 merged, 2 grown) and index of the line each.
    #[wasm_bindgen(js_name = matchedSegments)]
    pub fn matched_segments(&self, view: usize) -> Result<Float32Array, JsValue> {
        let run = self.loaded()?;
        let lines = lines_of(run);
        let matches = run.results().matches.as_ref();
        let supports: Vec<_> = match matches {
            Some(matches) if lines.is_empty() => {
                matches.value.iter().map(|m| &m.supports).collect()
            }
            _ => lines.iter().map(|l| &l.supports).collect(),
        };
        let mut numbers: Vec<f32> = Vec::new();
        for (line, supports) in supports.into_iter().enumerate() {
            for support in supports.iter().filter(|s| s.view.index() == view) {
                numbers.extend(end_points_px(&support.stretch));
                numbers.extend([kind_number(support.kind), line as f32]);
            }
        }
        Ok(Float32Array::from(&numbers[..]))
    }

    /// The 3D lines: both end points each, metres, local frame.
    pub fn lines(&self) -> Result<Float64Array, JsValue> {
        Ok(line_array(&lines_of(self.loaded()?)))
    }

    /// The accepted half-planes, as an array of objects.
    #[wasm_bindgen(js_name = halfPlanes)]
    pub fn half_planes(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().half_planes.as_ref();
        to_js(&found.map_or(&[][..], |h| &h.value))
    }

    /// The roof facets, as an array of objects.
    pub fn facets(&self) -> Result<JsValue, JsValue> {
        let model = self.loaded()?.results().model();
        to_js(&model.map_or(&[][..], |m| &m.facets))
    }

    /// Method "rectangles": the segmentation of a view, `{regions, vectors, initial_regions, moves}`; `null` before
    /// that stage.
    pub fn regions(&self, view: usize) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().regions.as_ref();
        to_js(&found.and_then(|r| r.trace.get(view)))
    }

    /// Method "rectangles": the windows with their main directions and how they were found, `{windows, trace}`.
    pub fn directions(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().directions.as_ref();
        to_js(&found.map(|d| Found {
            windows: &d.value,
            trace: &d.trace,
        }))
    }

    /// Method "rectangles": the cluster planes, one for each window and direction (figures 7 and 8).
    pub fn clusters(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().clusters.as_ref();
        to_js(&found.map(|c| &c.trace))
    }

    /// Method "rectangles": pairs of lines, candidates and the choice (figures 11 and 12).
    pub fn rectangles(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().rectangles.as_ref();
        to_js(&found.map(|r| &r.trace))
    }

    /// The pixels of a view, distortion removed.
    pub fn image(&self, view: usize) -> Result<ViewImage, JsValue> {
        let run = self.loaded()?;
        let view = run
            .scene()
            .views
            .get(view)
            .ok_or_else(|| named_error("RangeError", &format!("there is no view {view}")))?;
        let rgba: Vec<u8> = view
            .rgb
            .pixels()
            .flat_map(|p| [p[0], p[1], p[2], 255])
            .collect();
        Ok(ViewImage {
            width: view.rgb.width(),
            height: view.rgb.height(),
            rgba: js_sys::Uint8ClampedArray::from(&rgba[..]),
        })
    }

    /// The names of the files that the finished run offers; none before its last stage.
    #[wasm_bindgen(js_name = exportNames)]
    pub fn export_names(&mut self) -> Result<Vec<String>, JsValue> {
        Ok(self
            .outputs()?
            .iter()
            .map(|(name, _)| name.clone())
            .collect())
    }

    /// The bytes of one of these files.
    #[wasm_bindgen(js_name = exportFile)]
    pub fn export_file(&mut self, name: &str) -> Result<Vec<u8>, JsValue> {
        let outputs = self.outputs()?;
        let found = outputs.iter().find(|(n, _)| n == name);
        found.map(|(_, bytes)| bytes.clone()).ok_or_else(|| {
            let message = format!("there is no '{name}': run all stages first");
            named_error("RangeError", &message)
        })
    }

    pub(super) fn loaded(&self) -> Result<&Run, JsValue> {
        self.run.as_ref().ok_or_else(not_loaded)
    }

    pub(super) fn loaded_mut(&mut self) -> Result<&mut Run, JsValue> {
        self.run.as_mut().ok_or_else(not_loaded)
    }

    fn outputs(&mut self) -> Result<&[(String, Vec<u8>)], JsValue> {
        let run = self.run.as_ref().ok_or_else(not_loaded)?;
        Ok(self.outputs.get_or_insert_with(|| run.files(&[])))
    }
}

/// The stage of this name.
pub(super) fn stage_of(name: &str) -> Result<Stage, JsValue> {
    Stage::from_name(name)
        .ok_or_else(|| named_error("RangeError", &format!("no stage is called '{name}'")))
}

/// Tells the page how far a stage is.
pub(super) fn listener_of(on_progress: &Function) -> Listener {
    let on_progress = on_progress.clone();
    Arc::new(move |fraction| {
        // A listener that throws is the page's own fault, and no reason to lose the stage.
        let _ = on_progress.call1(&JsValue::NULL, &fraction.into());
    })
}

fn load_options(options: &JsValue) -> Result<LoadOptions, JsValue> {
    let options: Option<JsLoadOptions> = from_js(options, "options of load")?;
    let options = options.unwrap_or_default();
    Ok(LoadOptions {
        orientation: options.orientation,
        views: options.views,
        roi: options.roi,
        ground_z: options.ground_z,
        epsg: options.epsg,
        memory_mb: None,
        apply_fix: options.apply_fix,
        adjust: options.adjust,
    })
}

impl From<&LoadOptions> for JsLoadOptions {
    fn from(options: &LoadOptions) -> Self {
        Self {
            orientation: options.orientation.clone(),
            views: options.views.clone(),
            roi: options.roi,
            ground_z: options.ground_z,
            epsg: options.epsg,
            apply_fix: options.apply_fix,
            adjust: options.adjust,
        }
    }
}

fn not_loaded() -> JsValue {
    named_error(
        "InputError",
        "no scene is loaded; add files and load them first",
    )
}

fn kind_number(kind: SupportKind) -> f32 {
    match kind {
        SupportKind::Matched => 0.0,
        SupportKind::Merged => 1.0,
        SupportKind::Grown => 2.0,
    }
}
