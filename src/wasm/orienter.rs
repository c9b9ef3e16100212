//! Photographs without orientation in the page: read one by one, connected, oriented.
//!
//! Several workers have an `Orienter` each: photographs are dealt to them (`readPhoto`), what was
//! read is given to all (`takePhoto`), the maps over pairs are done in shards
//! ([`crate::base::execution::shard`]), and one of them registers the block.

use js_sys::{Float32Array, Function, Uint8Array};
use nalgebra::{Matrix3, Point2};
use serde::{Deserialize, Serialize};
use wasm_bindgen::prelude::*;

use super::convert::{
    ViewInfo, foreign, from_js, input_error, listener_of, merge_all, named_error, to_js,
    write_panics,
};
use crate::base::execution::{MergedShards, with_listener};
use crate::orienting::orientation::InputFile;
use crate::orienting::structure_from_motion::{
    CameraReport, ControlResidual, FeatureOptions, Intrinsics, OrientChain, OrientOptions,
    OrientReport, Oriented, PairSummary, PhotoReport, PlanCoverage, Pose, ReadPhoto, Snapshot,
};
use crate::photographs::camera::Camera;

/// Photographs on their way to an orientation.
#[wasm_bindgen]
pub struct Orienter {
    chain: OrientChain,
    merged: MergedShards,
    oriented: Option<Oriented>,
    /// Written on first request.
    files: Option<Vec<(String, Vec<u8>)>>,
}

/// What `new Orienter` may be told.
#[derive(Default, Deserialize, tsify::Tsify)]
#[serde(rename_all = "camelCase", default, deny_unknown_fields)]
#[tsify(rename = "OrientOptions")]
struct JsOrientOptions {
    /// Longest side of the image that is worked on, pixels.
    #[tsify(optional)]
    working_px: Option<usize>,
    /// Most keypoints of a photograph.
    #[tsify(optional)]
    most_features: Option<usize>,
    /// Focal length of all photographs, pixels, instead of what their headers state.
    #[tsify(optional)]
    focal_px: Option<f64>,
    /// Keep the principal point in the middle of the photographs.
    #[tsify(optional)]
    holds_center: bool,
    /// Read control points or angles that a usual mistake explains as they were meant.
    #[tsify(optional)]
    applies_fix: bool,
}

/// What `takePhoto` returns.
#[derive(Serialize, tsify::Tsify)]
struct PhotoFeatures {
    /// Its path.
    file: String,
    /// Width and height, pixels; null where it is of no use.
    size: Option<[u32; 2]>,
    /// Number of its keypoints; null where it is of no use.
    keypoints: Option<usize>,
    /// Why it is of no use, with what to do.
    problem: Option<String>,
}

/// A photograph without orientation.
#[derive(Serialize, tsify::Tsify)]
struct NotOriented {
    /// Its path.
    file: String,
    /// Why, with what to do.
    problem: String,
}

/// What `orient` and `setLength` return.
#[derive(Serialize, tsify::Tsify)]
struct OrientationReport<'a> {
    /// What the frame rests on, in a sentence.
    frame: &'a str,
    /// Is the scale that of the world?
    is_metric: bool,
    /// Its EPSG code, where that is known.
    epsg: Option<u32>,
    /// What scale and level of the frame are worth, and the lag of the receiver, a sentence each.
    worth: Vec<String>,
    /// Ground control points and check points, where they give the frame.
    control: &'a [ControlResidual],
    /// World points.
    points: usize,
    /// Mean number of rays of a point.
    rays_a_point: f64,
    /// Root mean square reprojection error, pixels.
    rms_px: f64,
    /// Cameras.
    cameras: &'a [CameraReport],
    /// Oriented photographs.
    photos: &'a [PhotoReport],
    /// The others.
    left_out: Vec<NotOriented>,
    /// Pairs of `photos` by their indices, and the points that they share.
    overlap: &'a [(usize, usize, usize)],
    /// What the photographs show of the area, and from where another one would tell most.
    coverage: Option<&'a PlanCoverage>,
    /// The same, a sentence each.
    coverage_words: Vec<String>,
    /// What is doubtful.
    warnings: &'a [String],
}

#[wasm_bindgen]
impl Orienter {
    /// Without photographs yet.
    #[wasm_bindgen(constructor)]
    pub fn new(
        #[wasm_bindgen(unchecked_param_type = "OrientOptions")] options: JsValue,
    ) -> Result<Self, JsValue> {
        write_panics();
        let options: Option<JsOrientOptions> = from_js(&options, "options of the orientation")?;
        let options = options.unwrap_or_default();
        let defaults = FeatureOptions::default();
        Ok(Self {
            chain: OrientChain::new(OrientOptions {
                features: FeatureOptions {
                    working_px: options.working_px.unwrap_or(defaults.working_px),
                    most: options.most_features.unwrap_or(defaults.most),
                },
                focal_px: options.focal_px,
                holds_center: options.holds_center,
                applies_fix: options.applies_fix,
            }),
            merged: MergedShards::default(),
            oriented: None,
            files: None,
        })
    }

    /// Decodes a photograph and finds its features: bytes for `takePhoto` of this and all others.
    #[wasm_bindgen(js_name = readPhoto, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn read_photo(&self, path: &str, bytes: Vec<u8>) -> Vec<u8> {
        let file = InputFile::new(path, bytes);
        ReadPhoto::read(&file, self.chain.options()).to_bytes()
    }

    /// Takes in what `readPhoto` of any orienter returned.
    #[wasm_bindgen(js_name = takePhoto, unchecked_return_type = "PhotoFeatures")]
    pub fn take_photo(&mut self, read: Vec<u8>) -> Result<JsValue, JsValue> {
        let photo = ReadPhoto::from_bytes(&read).ok_or_else(|| foreign("a photograph"))?;
        let about = PhotoFeatures {
            file: photo.path().to_owned(),
            size: photo.size(),
            keypoints: photo.keypoints(),
            problem: photo.problem(),
        };
        self.chain.add(photo);
        self.merged = MergedShards::default();
        to_js(&about)
    }

    /// Takes a list of ground control points, which give the frame of what `orient` returns, or of
    /// the places of photographs, which count instead of those in their headers.
    #[wasm_bindgen(js_name = setControl)]
    pub fn set_control(&mut self, path: &str, bytes: Vec<u8>) -> Result<(), JsValue> {
        let list = [InputFile::new(path, bytes)];
        let set = self.chain.set_lists(&list);
        set.map_err(|e| input_error(&e))
    }

    /// The maps that orienters may divide between them before `connect`, in their order.
    #[wasm_bindgen(js_name = shardMaps)]
    pub fn shard_maps(&self) -> Vec<String> {
        let maps = OrientChain::shard_maps().iter();
        maps.map(|&map| map.to_owned()).collect()
    }

    /// The shard of orienter `index` of so many of a map, for `mergeShards` of all.
    #[wasm_bindgen(js_name = runShard, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn run_shard(
        &self,
        map: &str,
        index: usize,
        of: usize,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => void")] on_progress: &Function,
    ) -> Vec<u8> {
        let listener = listener_of(on_progress);
        (self.chain).run_shard(map, [index, of], self.merged.clone(), &listener)
    }

    /// Takes the shards of a map from all orienters, in the order of their index.
    #[wasm_bindgen(js_name = mergeShards)]
    pub fn merge_shards(&mut self, map: &str, shards: Vec<Uint8Array>) -> Result<(), JsValue> {
        merge_all(&mut self.merged, map, &shards)
    }

    /// Finds the pairs that show the same, with the merged shards of the maps; returns them, those
    /// with the most matches first.
    #[wasm_bindgen(unchecked_return_type = "PairSummary[]")]
    pub fn connect(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => void")] on_progress: &Function,
    ) -> Result<JsValue, JsValue> {
        let merged = std::mem::take(&mut self.merged);
        let chain = &mut self.chain;
        with_listener(listener_of(on_progress), || chain.connect(merged))
            .map_err(|e| input_error(&e))?;
        let pairs: Vec<PairSummary> = self.chain.pairs();
        to_js(&pairs)
    }

    /// Matches of a pair by its place in what `connect` returned: x, y in the first photograph and
    /// x, y in the second, pixels.
    #[wasm_bindgen(js_name = pairMatches)]
    pub fn pair_matches(&self, place: usize) -> Float32Array {
        let matches = self.chain.pair_matches(place).into_iter();
        let numbers: Vec<f32> = matches
            .flat_map(|[a, b]| [a.x, a.y, b.x, b.y].map(|v| v as f32))
            .collect();
        Float32Array::from(&numbers[..])
    }

    /// Registers and adjusts the photographs; `on_block` is given views, points (x, y, z each) and
    /// their colours whenever the block has grown.
    #[wasm_bindgen(unchecked_return_type = "OrientationReport")]
    pub fn orient(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "(fraction: number) => void")] on_progress: &Function,
        #[wasm_bindgen(
            unchecked_param_type = "(views: ViewInfo[], points: Float32Array<ArrayBuffer>, colours: Uint8Array<ArrayBuffer>) => void"
        )]
        on_block: &Function,
    ) -> Result<JsValue, JsValue> {
        let mut show = |snapshot: Snapshot| {
            let views: Vec<ViewInfo> = (snapshot.photos.iter())
                .map(|p| view(&p.path, &p.intrinsics, &p.pose))
                .collect();
            let (points, colours) = cloud(snapshot.points.iter().map(|(p, rgb)| (p, rgb)));
            // A listener that throws is the page's own fault, and no reason to lose the block.
            let _ = to_js(&views).and_then(|views| {
                on_block.call3(&JsValue::NULL, &views, &points.into(), &colours.into())
            });
        };
        let chain = &self.chain;
        let oriented = with_listener(listener_of(on_progress), || chain.orient(Some(&mut show)));
        self.oriented = Some(oriented.map_err(|e| input_error(&e))?);
        self.files = None;
        self.report()
    }

    /// Sets the scale: what measures `measured` in the frame becomes `metres`. `words` say what it
    /// is.
    #[wasm_bindgen(js_name = setLength, unchecked_return_type = "OrientationReport")]
    pub fn set_length(
        &mut self,
        measured: f64,
        metres: f64,
        words: &str,
    ) -> Result<JsValue, JsValue> {
        let oriented = self.oriented.as_mut().ok_or_else(not_oriented)?;
        (oriented.set_length(measured, metres, words)).map_err(|e| input_error(&e))?;
        self.files = None;
        self.report()
    }

    /// The length between two places that are marked in photographs; or why there is none, in
    /// words. Of each mark the path of its photograph, and its x and y, pixels; those of the first
    /// place are the first `first`.
    #[wasm_bindgen(js_name = measureLength, unchecked_return_type = "MeasuredLength | string")]
    pub fn measure_length(
        &self,
        files: Vec<String>,
        pixels: &[f64],
        first: usize,
    ) -> Result<JsValue, JsValue> {
        let pixels = pixels.chunks_exact(2).map(|xy| Point2::new(xy[0], xy[1]));
        let marks: Vec<(String, Point2<f64>)> = files.into_iter().zip(pixels).collect();
        let (first, second) = marks.split_at(first.min(marks.len()));
        match (self.oriented()?.model).measure_length([first, second]) {
            Ok(length) => to_js(&length),
            Err(why) => Ok(JsValue::from_str(why.words())),
        }
    }

    /// The oriented photographs, without the distortion of their lenses.
    #[wasm_bindgen(unchecked_return_type = "ViewInfo[]")]
    pub fn views(&self) -> Result<JsValue, JsValue> {
        let model = &self.oriented()?.model;
        let views: Vec<ViewInfo> = (model.photos.iter())
            .map(|p| view(&p.path, &model.cameras[p.camera], &p.pose))
            .collect();
        to_js(&views)
    }

    /// x, y, z of the world points.
    pub fn points(&self) -> Result<Float32Array, JsValue> {
        let points = self.oriented()?.model.points.iter();
        Ok(cloud(points.map(|p| (&p.position, &p.rgb))).0)
    }

    /// Red, green and blue of the world points.
    pub fn colours(&self) -> Result<Uint8Array, JsValue> {
        let points = self.oriented()?.model.points.iter();
        Ok(cloud(points.map(|p| (&p.position, &p.rgb))).1)
    }

    /// The image in the second photograph of the ray through a pixel of the first: x, y of points
    /// along it, pixels. Empty where one of them is not oriented.
    #[wasm_bindgen(js_name = epipolarCurve)]
    pub fn epipolar_curve(&self, first: &str, second: &str, x: f64, y: f64) -> Float32Array {
        let curve = (self.oriented.as_ref()).and_then(|Oriented { model, .. }| {
            let place = |path: &str| model.photos.iter().position(|p| p.path == path);
            Some(model.epipolar_curve(place(first)?, place(second)?, &Point2::new(x, y)))
        });
        let numbers: Vec<f32> = (curve.unwrap_or_default().iter())
            .flat_map(|p| [p.x as f32, p.y as f32])
            .collect();
        Float32Array::from(&numbers[..])
    }

    /// Names of the files of the orientation: COLMAP's text model, and the report.
    #[wasm_bindgen(js_name = exportNames)]
    pub fn export_names(&mut self) -> Result<Vec<String>, JsValue> {
        Ok(self
            .written()?
            .iter()
            .map(|(name, _)| name.clone())
            .collect())
    }

    /// One of them.
    #[wasm_bindgen(js_name = exportFile, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn export_file(&mut self, name: &str) -> Result<Vec<u8>, JsValue> {
        let found = self.written()?.iter().find(|(n, _)| n == name);
        found
            .map(|(_, bytes)| bytes.clone())
            .ok_or_else(|| named_error("RangeError", &format!("no file is called '{name}'")))
    }

    fn written(&mut self) -> Result<&[(String, Vec<u8>)], JsValue> {
        if self.files.is_none() {
            self.files = Some(self.oriented()?.files());
        }
        Ok(self.files.as_deref().unwrap_or_default())
    }

    fn oriented(&self) -> Result<&Oriented, JsValue> {
        self.oriented.as_ref().ok_or_else(not_oriented)
    }

    fn report(&self) -> Result<JsValue, JsValue> {
        let report: &OrientReport = &self.oriented()?.report;
        to_js(&OrientationReport {
            frame: &report.frame,
            is_metric: report.is_metric,
            epsg: report.epsg,
            worth: report.worth(),
            control: &report.control,
            points: report.points,
            rays_a_point: report.rays_a_point,
            rms_px: report.rms_px,
            cameras: &report.cameras,
            photos: &report.photos,
            left_out: (report.left_out.iter())
                .map(|left| NotOriented {
                    file: left.file.clone(),
                    problem: left.reason.words(),
                })
                .collect(),
            overlap: &report.overlap,
            coverage: report.coverage.as_ref(),
            coverage_words: report.coverage_words(),
            warnings: &report.warnings,
        })
    }
}

fn not_oriented() -> JsValue {
    named_error("InputError", "the photographs are not oriented yet")
}

/// The pinhole of a photograph.
fn view(path: &str, intrinsics: &Intrinsics, pose: &Pose) -> ViewInfo {
    let (f, [cx, cy], [width, height]) = (intrinsics.focal, intrinsics.center, intrinsics.size);
    let k = Matrix3::new(f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0);
    ViewInfo::new(
        path,
        &Camera::new(k, pose.rotation, pose.center, width, height),
    )
}

/// Positions and colours of points.
fn cloud<'a>(
    points: impl Iterator<Item = (&'a nalgebra::Point3<f64>, &'a [u8; 3])>,
) -> (Float32Array, Uint8Array) {
    let (positions, colours): (Vec<[f32; 3]>, Vec<[u8; 3]>) = points
        .map(|(p, rgb)| ([p.x as f32, p.y as f32, p.z as f32], *rgb))
        .unzip();
    (
        Float32Array::from(positions.as_flattened()),
        Uint8Array::from(colours.as_flattened()),
    )
}
