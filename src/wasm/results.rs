//! What the stages of a session have found, and the files of a finished run.

use js_sys::{Float32Array, Float64Array};
use nalgebra::Point3;
use serde::Serialize;
use wasm_bindgen::prelude::*;

use super::arrays::{end_points_px, line_array, segment_array};
use super::convert::{named_error, to_js};
use super::figures::{Picture, lines_of, segments_of};
use super::session::{Session, not_loaded};
use crate::lines::lines3d::SupportKind;
use crate::planes::adjacency::{AdjacencyTrace, CornerPlane};
use crate::planes::coplanar::{CoplanarSet, CoplanarTrace};
use crate::planes::dense::{DensePlane, DenseTrace};
use crate::planes::objectspace::{Window, WindowTrace};
use crate::results::export::ReportedModel;
use crate::results::roof_report::SetbackRule;
use crate::results::texture::texture_ground;

/// What `directions` returns.
#[derive(Serialize, tsify::Tsify)]
struct Directions<'a> {
    windows: &'a [Window],
    trace: &'a WindowTrace,
}

/// What `coplanar` returns.
#[derive(Serialize, tsify::Tsify)]
struct CoplanarSets<'a> {
    sets: &'a [CoplanarSet],
    trace: &'a CoplanarTrace,
}

/// What `adjacency` returns.
#[derive(Serialize, tsify::Tsify)]
struct AdjacencyGraphs<'a> {
    planes: &'a [CornerPlane],
    trace: &'a AdjacencyTrace,
}

/// What `dense` returns.
#[derive(Serialize, tsify::Tsify)]
struct DensePlanes<'a> {
    planes: &'a [DensePlane],
    trace: &'a DenseTrace,
}

/// What `ground` shows.
#[derive(Serialize, tsify::Tsify)]
struct GroundPicture {
    /// Its upper left, upper right, lower right and lower left corner, metres, local frame.
    #[tsify(type = "[Vec3, Vec3, Vec3, Vec3]")]
    corners: [Point3<f64>; 4],
    /// Texels in a row.
    width: u32,
    /// Rows.
    height: u32,
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
    /// The segments of a view: x0, y0, x1, y1 each, pixels.
    pub fn segments(&self, view: usize) -> Result<Float32Array, JsValue> {
        let all = segments_of(self.loaded()?);
        let segments = all.get(view).map_or(&[][..], |s| s);
        Ok(segment_array(segments.iter().map(|s| &s.segment)))
    }

    /// The supports of the 3D lines (before that stage, of the matches) in a view: x0, y0, x1, y1
    /// in pixels, kind (0 matched, 1 merged, 2 grown) and index of the line each.
    #[wasm_bindgen(js_name = matchedSegments)]
    pub fn matched_segments(&self, view: usize) -> Result<Float32Array, JsValue> {
        let run = self.loaded()?;
        let lines = lines_of(run);
        let found = run.results();
        let supports: Vec<_> = match (&found.matches, &found.clusters) {
            (Some(matches), clusters)
                if lines.is_empty() && (clusters.is_none() || found.lines.is_some()) =>
            {
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
    #[wasm_bindgen(js_name = halfPlanes, unchecked_return_type = "HalfPlane[]")]
    pub fn half_planes(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().half_planes.as_ref();
        to_js(&found.map_or(&[][..], |h| &h.value))
    }

    /// How the terrain model that is known compares with the images; `null` without one, and before
    /// the ground.
    #[wasm_bindgen(unchecked_return_type = "KnownComparison | null")]
    pub fn terrain(&self) -> Result<JsValue, JsValue> {
        let ground = self.loaded()?.results().ground.as_ref();
        to_js(&ground.and_then(|ground| ground.terrain()))
    }

    /// The sets of coplanar lines with their polygons, `{sets, trace}`; `null` before that stage.
    #[wasm_bindgen(unchecked_return_type = "CoplanarSets | null")]
    pub fn coplanar(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().coplanar.as_ref();
        to_js(&found.map(|c| CoplanarSets {
            sets: &c.value,
            trace: &c.trace,
        }))
    }

    /// The graphs of all views, the corners in space and the planes that they propose,
    /// `{planes, trace}`; `null` before that stage.
    #[wasm_bindgen(unchecked_return_type = "AdjacencyGraphs | null")]
    pub fn adjacency(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().adjacency.as_ref();
        to_js(&found.map(|a| AdjacencyGraphs {
            planes: &a.value,
            trace: &a.trace,
        }))
    }

    /// The planes of dense matching, with all patches and what speaks for the class of each plane,
    /// `{planes, trace}`; `null` before that stage.
    #[wasm_bindgen(unchecked_return_type = "DensePlanes | null")]
    pub fn dense(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().dense.as_ref();
        to_js(&found.map(|d| DensePlanes {
            planes: &d.value,
            trace: &d.trace,
        }))
    }

    /// The ground around the buildings, painted from the photographs (`about`: `GroundPicture`);
    /// `undefined` without a building.
    pub fn ground(&self) -> Result<Option<Picture>, JsValue> {
        let run = self.loaded()?;
        let model = run.results().roof_model();
        let Some(ground) =
            model.and_then(|m| texture_ground(run.scene(), m, &run.params().texture))
        else {
            return Ok(None);
        };
        let (width, height) = ground.image.dimensions();
        let about = GroundPicture {
            corners: ground.corners,
            width,
            height,
        };
        Ok(Some(Picture {
            about: to_js(&about)?,
            rgba: js_sys::Uint8ClampedArray::from(&ground.image.into_raw()[..]),
        }))
    }

    /// The roof facets, as an array of objects.
    #[wasm_bindgen(unchecked_return_type = "Facet[]")]
    pub fn facets(&self) -> Result<JsValue, JsValue> {
        let model = self.loaded()?.results().roof_model();
        to_js(&model.map_or(&[][..], |m| &m.facets))
    }

    /// Method "rectangles": the segmentation of a view, `{regions, vectors, initial_regions,
    /// moves}`; `null` before that stage.
    #[wasm_bindgen(unchecked_return_type = "Segmentation | null")]
    pub fn regions(&self, view: usize) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().regions.as_ref();
        to_js(&found.and_then(|r| r.trace.get(view)))
    }

    /// Method "rectangles": the windows with their main directions and how they were found,
    /// `{windows, trace}`.
    #[wasm_bindgen(unchecked_return_type = "Directions | null")]
    pub fn directions(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().directions.as_ref();
        to_js(&found.map(|d| Directions {
            windows: &d.value,
            trace: &d.trace,
        }))
    }

    /// Method "rectangles": the cluster planes, one for each window and direction (figures 7 and
    /// 8).
    #[wasm_bindgen(unchecked_return_type = "ClusterTrace[] | null")]
    pub fn clusters(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().clusters.as_ref();
        to_js(&found.map(|c| &c.trace))
    }

    /// Method "rectangles": pairs of lines, candidates and the choice (figures 11 and 12).
    #[wasm_bindgen(unchecked_return_type = "RectangleTrace | null")]
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
    #[wasm_bindgen(js_name = exportFile, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn export_file(&mut self, name: &str) -> Result<Vec<u8>, JsValue> {
        let outputs = self.outputs()?;
        let found = outputs.iter().find(|(n, _)| n == name);
        found.map(|(_, bytes)| bytes.clone()).ok_or_else(|| {
            let message = format!("there is no '{name}': run all stages first");
            named_error("RangeError", &message)
        })
    }

    /// How long the sun shines on each facet in the course of a year; null where the place of the
    /// model on the Earth is not known.
    #[wasm_bindgen(unchecked_return_type = "Sunshine[] | null")]
    pub fn sunshine(&self) -> Result<JsValue, JsValue> {
        to_js(&self.reported()?.sunshine())
    }

    /// Compares the model with that of a CityJSON file: what both have, and by how much it differs.
    #[wasm_bindgen(js_name = compareWith, unchecked_return_type = "ComparedModels")]
    pub fn compare_with(&self, city_json: &[u8]) -> Result<JsValue, JsValue> {
        let refused = |problem: String| named_error("InputError", &format!("the file {problem}"));
        let own = self.reported()?;
        let other = ReportedModel::read(city_json).map_err(refused)?;
        let refused = |problem: String| named_error("InputError", &problem);
        to_js(&own.compare(&other).map_err(refused)?)
    }

    /// Makes the files of the report anew with setbacks of one's own, the text of a rule file,
    /// beside the built-in ones.
    #[wasm_bindgen(js_name = reportWith)]
    pub fn report_with(&mut self, setbacks: &str) -> Result<(), JsValue> {
        let refused = |problem: String| named_error("InputError", &format!("the file {problem}"));
        let rules = SetbackRule::with(setbacks).map_err(refused)?;
        self.outputs()?;
        let written = self.reported()?.files(&rules);
        let outputs = self.outputs.get_or_insert_default();
        outputs.retain(|(name, _)| written.iter().all(|(new, _)| new != name));
        outputs.extend(written);
        Ok(())
    }
}

impl Session {
    /// The model of the finished run, or of joined tiles.
    fn reported(&self) -> Result<ReportedModel, JsValue> {
        let reported = match &self.run {
            Some(run) => run.reported(),
            None => self.joined.clone(),
        };
        let not_run = || named_error("RangeError", "there is no report: run all stages first");
        reported.ok_or_else(not_run)
    }

    fn outputs(&mut self) -> Result<&[(String, Vec<u8>)], JsValue> {
        // Joined tiles have files and no run.
        if self.outputs.is_none() {
            let run = self.run.as_ref().ok_or_else(not_loaded)?;
            self.outputs = Some(run.files(&[]));
        }
        Ok(self.outputs.as_deref().unwrap_or_default())
    }
}

fn kind_number(kind: SupportKind) -> f32 {
    match kind {
        SupportKind::Matched => 0.0,
        SupportKind::Merged => 1.0,
        SupportKind::Grown => 2.0,
    }
}
