//! A model as files. Nothing here touches a file system: every writer returns bytes.
//!
//! | file | what |
//! |---|---|
//! | `model.city.json` | CityJSON 2.0, world frame of the input; names the atlas file |
//! | `model.city.jsonl` | CityJSONSeq: the same, a building a line |
//! | `model_atlas.jpg` | the texture atlas of `model.city.json` |
//! | `model.glb` | glTF 2.0, Y up, near-origin coordinates, the atlas inside |
//! | `tileset.json` | 3D Tiles 1.1, places `model.glb` on the Earth where that is known |
//! | `model.obj`, `model.mtl` | triangles and the same atlas, world frame |
//! | `model.ply` | triangles, and the 3D lines as edges |
//! | `model.ifc` | IFC4 for building information models |
//! | `model.dxf` | 3DFACE and LINE for drawing programs |
//! | `footprints.geojson` | outlines on the ground, with heights |
//! | `facets.geojson`, `edges.geojson` | the roofs in plan, with areas, slopes, lengths |
//! | `obstructions.geojson` | what stands on them |
//! | `roof_report.html` | the roofs in numbers and pictures, a page that prints |
//! | `buildings.csv`, `facets.csv`, `edges.csv` | the same numbers as tables |
//! | `roofs.json` | the same for programs, with polygons |
//! | `lines.csv` | the 3D lines as a table |
//! | `lines.json`, `segments.json`, `halfplanes.json` | what the model was made from |
//! | `evidence.json` | what spoke for every candidate, and against it |
//!
//! `corrected_file` corrects a CityJSON file of anybody, whose other bytes stay.
//! `format` and `measured` hold what the writers share,
//! `walls` the LoD 2.3 solids of CityJSON.
//!
//! Invariant: the same input gives the same bytes; nothing writes a date, a path or a random id.

mod cityjson;
mod corrected_file;
mod evidence;
mod format;
mod geojson;
mod glb;
mod ifc;
mod json;
mod measured;
mod mesh;
mod plans;
mod report;
mod tileset;
mod walls;

pub use corrected_file::corrected_file;
pub use evidence::evidence_json;
pub use format::{ATLAS_FILE, MATERIAL_FILE};
pub use glb::{glb, glb_of};
pub use json::{half_planes_json, lines_json, segments_json};
pub use mesh::{mtl, obj, ply};
pub use plans::{dxf, lines_csv};
pub use report::{ComparedModels, ReportedModel};
pub use tileset::{SquareContent, TILESET_FILE, tileset_of_squares};

use image::codecs::jpeg::JpegEncoder;

use self::measured::Measured;
use crate::base::evidence::Candidates;
use crate::base::params::TextureParams;
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::planes::half_planes::HalfPlane;
use crate::results::roof_report::SetbackRule;
use crate::results::texture::TexturedModel;
use crate::roofs::model::{BuildingWalls, RoofModel};

/// Everything that is written out.
#[derive(Clone, Copy, Debug)]
pub struct ExportInput<'a> {
    /// The views and the origin of the local frame.
    pub scene: &'a Scene,
    /// Image segments, per view.
    pub segments: &'a [Vec<ImageSegment>],
    /// 3D lines; contradicted ones are not written.
    pub lines: &'a [Line3d],
    /// Half-planes.
    pub half_planes: &'a [HalfPlane],
    /// The lines and facets that were weighed.
    pub candidates: &'a Candidates,
    /// The model.
    pub model: &'a RoofModel,
    /// For each building where its walls stand; none where that was not asked.
    pub walls: &'a [BuildingWalls],
    /// Its textures.
    pub textured: &'a TexturedModel,
}

/// All files: name and bytes, in a fixed order.
pub fn export_all(input: &ExportInput, params: &TextureParams) -> Vec<(String, Vec<u8>)> {
    let ExportInput {
        scene,
        segments,
        lines,
        half_planes,
        candidates,
        model,
        walls,
        textured,
    } = *input;
    let atlas = atlas_jpeg(textured, params.jpeg_quality);
    let measured = Measured::new(scene, model);
    let city = cityjson::city_json(scene, (model, walls), &measured, textured);
    let report = ReportedModel::of_measured(scene, (model, walls), &measured);
    let mut files: Vec<(String, Vec<u8>)> = [
        ("model.city.json", city),
        (
            "model.city.jsonl",
            cityjson::city_json_seq(scene, (model, walls), &measured, textured),
        ),
        ("model.glb", glb(scene, model, textured, &atlas)),
        (ATLAS_FILE, atlas),
        (TILESET_FILE, tileset::tileset(scene, model, "model.glb")),
        ("model.obj", obj(scene, model, textured)),
        (MATERIAL_FILE, mtl()),
        ("model.ply", ply(scene, model, lines)),
        ("model.ifc", ifc::ifc(scene, (model, walls), &measured)),
        ("model.dxf", dxf(scene, model, lines)),
        ("footprints.geojson", geojson::footprints(scene, model)),
        ("facets.geojson", geojson::facets(scene, model, &measured)),
        ("edges.geojson", geojson::edges(scene, &measured)),
        ("obstructions.geojson", geojson::obstructions(scene, model)),
        ("lines.csv", lines_csv(scene, lines)),
        ("lines.json", lines_json(scene, lines)),
        ("segments.json", segments_json(scene, segments)),
        (
            "halfplanes.json",
            half_planes_json(scene, lines, half_planes),
        ),
        ("evidence.json", evidence_json(scene, candidates)),
    ]
    .map(|(name, bytes)| (name.to_owned(), bytes))
    .into();
    files.extend(report.files(&SetbackRule::built_in()));
    files
}

/// The atlas as a JPEG file; quality from 1 to 100.
pub fn atlas_jpeg(textured: &TexturedModel, quality: u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, quality.clamp(1, 100))
        .encode_image(&textured.atlas)
        .expect("writing to memory does not fail and an atlas is smaller than 65536 pixels");
    bytes
}
