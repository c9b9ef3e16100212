//! Models written as files: valid for independent readers, and the same geometry as in memory.

#![cfg(not(target_arch = "wasm32"))] // The independent readers are native crates.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};
use ridgeline::camera::Camera;
use ridgeline::export::{Results, export_all};
use ridgeline::geometry::{Plane, Segment2, Segment3};
use ridgeline::halfplane::{HalfPlane, Side};
use ridgeline::ids::{BuildingId, LineId, SegmentId, ViewId};
use ridgeline::linematch::{LineSupport, SupportKind};
use ridgeline::lines2d::ImageSegment;
use ridgeline::lines3d::Line3d;
use ridgeline::params::TextureParams;
use ridgeline::raster::Gray;
use ridgeline::roof::{Facet, RoofModel, Surface, check_invariants, close_buildings};
use ridgeline::scene::{Scene, View};
use ridgeline::texture::texture_model;
use serde_json::Value;

/// A scene origin as of a national grid.
const ORIGIN: Vector3<f64> = Vector3::new(432_100.0, 5_412_300.0, 0.0);

/// A facet over plan rings on `z = z0 + gx x + gy y`.
fn facet(rings: &[&[(f64, f64)]], z0: f64, gx: f64, gy: f64) -> Facet {
    let normal = Vector3::new(-gx, -gy, 1.0);
    let plane = Plane::from_point_normal(&Point3::new(0.0, 0.0, z0), &normal).unwrap();
    let lift = |ring: &&[(f64, f64)]| ring.iter().map(|&(x, y)| plane.lift(x, y)).collect();
    Facet {
        building: BuildingId(0),
        plane,
        outer: lift(&rings[0]),
        holes: rings[1..].iter().map(lift).collect(),
        similarity: 0.9,
        real_ratio: 0.8,
        lines: Vec::new(),
        half_planes: Vec::new(),
    }
}

/// A gable; an L with a hip-less valley; a step between two flat roofs; a courtyard.
fn planted_models() -> Vec<(&'static str, RoofModel, f64)> {
    let gable = [
        facet(
            &[&[(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (0.0, 4.0)]],
            5.0,
            0.0,
            0.5,
        ),
        facet(
            &[&[(0.0, 4.0), (10.0, 4.0), (10.0, 8.0), (0.0, 8.0)]],
            9.0,
            0.0,
            -0.5,
        ),
    ];
    // Ridges y = 3 and x = 13 at 6.5 m, equal slopes, so that hip and valley run diagonally.
    let l_shape = [
        facet(
            &[&[(0.0, 0.0), (16.0, 0.0), (13.0, 3.0), (0.0, 3.0)]],
            5.0,
            0.0,
            0.5,
        ),
        facet(
            &[&[(0.0, 3.0), (13.0, 3.0), (10.0, 6.0), (0.0, 6.0)]],
            8.0,
            0.0,
            -0.5,
        ),
        facet(
            &[&[(16.0, 0.0), (16.0, 12.0), (13.0, 12.0), (13.0, 3.0)]],
            13.0,
            -0.5,
            0.0,
        ),
        facet(
            &[&[(13.0, 3.0), (13.0, 12.0), (10.0, 12.0), (10.0, 6.0)]],
            0.0,
            0.5,
            0.0,
        ),
    ];
    let step = [
        facet(
            &[&[(0.0, 0.0), (5.0, 0.0), (5.0, 6.0), (0.0, 6.0)]],
            8.0,
            0.0,
            0.0,
        ),
        facet(
            &[&[(5.0, -2.0), (9.0, -2.0), (9.0, 9.0), (5.0, 9.0)]],
            4.0,
            0.0,
            0.0,
        ),
    ];
    let courtyard = [facet(
        &[
            &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)],
            &[(3.0, 3.0), (3.0, 7.0), (7.0, 7.0), (7.0, 3.0)],
        ],
        6.0,
        0.1,
        0.0,
    )];
    // Prism: footprint times the mean height. L: both wings have the mean height 5.75 m, but for the corner.
    let pyramid_quarter = 3.0 * 3.0 * 1.5 / 3.0;
    let l_volume = (16.0 * 6.0 + 6.0 * 6.0) * 5.75
        - 2.0 * (pyramid_quarter - 9.0 * 0.75)
        - 2.0 * (9.0 * 0.75 - pyramid_quarter);
    [
        ("gable", gable.to_vec(), 480.0),
        ("l", l_shape.to_vec(), l_volume),
        ("step", step.to_vec(), 240.0 + 176.0),
        ("courtyard", courtyard.to_vec(), 84.0 * 6.5),
    ]
    .map(|(name, facets, volume)| {
        let (model, trace) = close_buildings(&facets, |_| 0.0);
        assert_eq!(trace.rejected, [], "{name}");
        assert_eq!(check_invariants(&model), [], "{name}");
        (name, model, volume)
    })
    .into()
}

/// Looks straight down from 100 m; red grows to the east and green to the north by one grey value per 10 cm.
fn map_view(name: &str, x: f64, y: f64) -> View {
    let (size, focal) = (400u32, 1000.0);
    let k = Matrix3::new(focal, 0.0, 200.0, 0.0, focal, 200.0, 0.0, 0.0, 1.0);
    let down = Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    let camera = Camera::new(k, down, Point3::new(x, y, 100.0), size, size);
    let rgb = image::RgbImage::from_fn(size, size, |column, row| {
        let pixel = nalgebra::Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
        // The gradient is painted on the height of 6 m.
        let p = camera.at_height(&pixel, 6.0).unwrap();
        let grey = |v: f64| (100.0 + 5.0 * v).round().clamp(0.0, 255.0) as u8;
        image::Rgb([grey(p.x), grey(p.y), 40])
    });
    View::new(name.into(), camera, Gray::from_rgb(&rgb), rgb)
}

fn scene() -> Scene {
    Scene {
        views: vec![map_view("a.jpg", 5.0, 5.0), map_view("b.jpg", 8.0, 5.0)],
        origin: ORIGIN,
        ground_z: None,
        warnings: Vec::new(),
        survey: ridgeline::scene::Survey::default(),
    }
}

fn files_of(scene: &Scene, model: &RoofModel) -> BTreeMap<String, Vec<u8>> {
    let params = TextureParams::default();
    let (textured, _) = texture_model(scene, model, &params);
    let (segments, lines, half_planes) = planted_evidence();
    let results = Results {
        scene,
        segments: &segments,
        lines: &lines,
        half_planes: &half_planes,
        model,
        textured: &textured,
    };
    export_all(&results, &params).into_iter().collect()
}

fn planted_evidence() -> (Vec<Vec<ImageSegment>>, Vec<Line3d>, Vec<HalfPlane>) {
    let segment = Segment2::new([1.0, 2.0].into(), [30.25, 4.0].into());
    let image_segment = ImageSegment {
        kind: Default::default(),
        segment,
        contrast: 0.3,
        edgels: 29,
        covariance: nalgebra::Matrix2::zeros(),
    };
    let support = LineSupport {
        view: ViewId(1),
        segments: vec![SegmentId(0)],
        stretch: segment,
        score: 0.75,
        kind: SupportKind::Matched,
        edge: None,
    };
    let line = Line3d {
        origin: Default::default(),
        segment: Segment3::new([1.0, 2.0, 3.0].into(), [4.0, 5.0, 6.123_456].into()),
        sigma_m: 0.02,
        covariance: [Matrix3::zeros(); 2],
        supports: vec![support],
    };
    let half_plane = HalfPlane {
        line: LineId(0),
        side: Side::Left,
        theta: 0.5,
        sigma_theta: 0.01,
        similarity: 0.8,
        curvature: 12.0,
        amplitude: 0.5,
        probability: 0.97,
        views: vec![ViewId(0), ViewId(1)],
        plane: facet(&[&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]], 3.0, 0.2, 0.1).plane,
    };
    (
        vec![Vec::new(), vec![image_segment]],
        vec![line],
        vec![half_plane],
    )
}

#[test]
fn planted_models_have_their_volumes() {
    for (name, model, volume) in planted_models() {
        let found: f64 = model.buildings.iter().map(|b| b.solid.volume()).sum();
        assert!(
            (found - volume).abs() < 1e-6,
            "{name}: {found} for {volume}"
        );
    }
}

#[test]
fn cityjson_is_valid_and_holds_the_model_in_the_world_frame() {
    for (name, model, volume) in planted_models() {
        let files = files_of(&scene(), &model);
        let text = std::str::from_utf8(&files["model.city.json"]).unwrap();
        let validator = cjval::CJValidator::from_str(text);
        for (criterion, summary) in validator.validate() {
            assert!(!summary.has_errors(), "{name}, {criterion}: {summary}");
        }
        let json: Value = serde_json::from_str(text).unwrap();
        let solids = solids_in_world(&json);
        assert_eq!(solids.len(), model.buildings.len());
        let found: f64 = solids.iter().map(volume_of).sum();
        // Corners move by half of 0.1 mm, over faces of about a hundred square metres.
        assert!(
            (found - volume).abs() < 0.05,
            "{name}: {found} for {volume}"
        );
        let roof = &json["CityObjects"]["building-0"]["geometry"][0]["semantics"];
        let types: Vec<_> = roof["surfaces"]
            .as_array()
            .unwrap()
            .iter()
            .map(|s| &s["type"])
            .collect();
        for kind in ["RoofSurface", "WallSurface", "GroundSurface"] {
            assert!(types.iter().any(|t| *t == kind), "{name}: {kind}");
        }
    }
}

/// Per building, per face, per ring the corners in the world frame, less [`ORIGIN`].
type Faces = Vec<Vec<Vec<Vector3<f64>>>>;

fn solids_in_world(json: &Value) -> Vec<Faces> {
    let number = |v: &Value| v.as_f64().unwrap();
    let corner = |index: &Value| {
        let v = &json["vertices"][index.as_u64().unwrap() as usize];
        let transform = &json["transform"];
        Vector3::from_fn(|axis, _| {
            number(&v[axis]) * number(&transform["scale"][axis])
                + number(&transform["translate"][axis])
        }) - ORIGIN
    };
    let list = |v: &Value| v.as_array().unwrap().clone();
    json["CityObjects"]
        .as_object()
        .unwrap()
        .values()
        .map(|object| {
            let shell = &object["geometry"][0]["boundaries"][0];
            list(shell)
                .iter()
                .map(|face| {
                    list(face)
                        .iter()
                        .map(|ring| list(ring).iter().map(corner).collect())
                        .collect()
                })
                .collect()
        })
        .collect()
}

fn volume_of(faces: &Faces) -> f64 {
    let mut volume = 0.0;
    for ring in faces.iter().flatten() {
        for i in 1..ring.len() - 1 {
            volume += ring[0].dot(&ring[i].cross(&ring[i + 1])) / 6.0;
        }
    }
    volume
}

#[test]
fn glb_reads_back_with_the_area_of_the_model() {
    for (name, model, _) in planted_models() {
        let files = files_of(&scene(), &model);
        let (document, buffers, images) = gltf::import_slice(&files["model.glb"]).unwrap();
        assert_eq!(images.len(), 1);
        let container = gltf::binary::Glb::from_slice(&files["model.glb"]).unwrap();
        let json: Value = serde_json::from_slice(&container.json).unwrap();
        assert!(json["materials"][0]["extensions"]["KHR_materials_unlit"].is_object());
        let mut area: BTreeMap<String, Vector3<f64>> = BTreeMap::new();
        for node in document.nodes() {
            let Some(mesh) = node.mesh() else {
                continue;
            };
            let extras: Value =
                serde_json::from_str(node.extras().as_ref().unwrap().get()).unwrap();
            let key = format!(
                "{} {}",
                extras["surface"].as_str().unwrap(),
                extras["facet"]
            );
            for primitive in mesh.primitives() {
                let reader = primitive.reader(|b| Some(&buffers[b.index()]));
                // Back from Y up: (x, z, -y).
                let corners: Vec<Vector3<f64>> = reader
                    .read_positions()
                    .unwrap()
                    .map(|[x, y, z]| Vector3::new(x.into(), (-z).into(), y.into()))
                    .collect();
                let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
                let sum = area.entry(key.clone()).or_default();
                for t in indices.chunks_exact(3) {
                    let [a, b, c] = [t[0], t[1], t[2]].map(|i| corners[i as usize]);
                    *sum += (b - a).cross(&(c - a)) / 2.0;
                }
            }
        }
        for building in &model.buildings {
            for face in &building.solid.faces {
                let wanted = building.solid.vector_area(&face.rings);
                if let Surface::Roof(id) = face.surface {
                    let found = area[&format!("roof {}", id.0)];
                    assert!(
                        (found - wanted).norm() < 1e-4,
                        "{name}: {found} for {wanted}"
                    );
                }
            }
        }
        // A closed surface: all vector areas together vanish.
        let total: Vector3<f64> = area.values().sum();
        assert!(total.norm() < 1e-4, "{name}: {total}");
    }
}

#[test]
fn colours_come_back_where_they_were_painted() {
    // A flat roof at the height of the gradient, off the middle and longer than wide.
    let roof = [facet(
        &[&[(2.0, 3.0), (9.0, 3.0), (9.0, 7.0), (2.0, 7.0)]],
        6.0,
        0.0,
        0.0,
    )];
    let (model, _) = close_buildings(&roof, |_| 0.0);
    let scene = scene();
    let (textured, trace) = texture_model(&scene, &model, &TextureParams::default());
    let solid = &model.buildings[0].solid;
    let atlas = &textured.atlas;
    for (i, face) in solid.faces.iter().enumerate() {
        if textured.faces[0][i].view.is_none() {
            assert!(!matches!(face.surface, Surface::Roof(_)));
            continue;
        }
        let uv = &textured.faces[0][i].uv[0];
        let corners: Vec<_> = face.rings[0]
            .iter()
            .map(|&v| solid.vertices[v as usize])
            .collect();
        let centre = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let middle =
            [0, 1].map(|c| centre(&uv.iter().map(|t| f64::from(t[c])).collect::<Vec<_>>()));
        let mean = corners.iter().map(|p| p.coords).sum::<Vector3<f64>>() / corners.len() as f64;
        for (t, corner) in uv.iter().zip(&corners) {
            // A little inside of the corner, away from the border of the patch.
            let inwards = [0, 1].map(|c| 0.9 * f64::from(t[c]) + 0.1 * middle[c]);
            let x = (inwards[0] * f64::from(atlas.width())) as u32;
            let y = (inwards[1] * f64::from(atlas.height())) as u32;
            let (colour, p) = (atlas.get_pixel(x, y), corner.coords * 0.9 + mean * 0.1);
            // The gradient lies in the plane of the roof; below it a wall shows what the ray passes there.
            let camera = &scene.view(textured.faces[0][i].view.unwrap()).camera;
            let seen = camera
                .at_height(&camera.project(&p.into()).unwrap(), 6.0)
                .unwrap();
            for (channel, value) in [seen.x, seen.y].into_iter().enumerate() {
                let wanted = 100.0 + 5.0 * value;
                assert!(
                    (f64::from(colour[channel]) - wanted).abs() < 2.0,
                    "{colour:?} at {p}"
                );
            }
        }
    }
    let is_roof = |f: usize| matches!(solid.faces[f].surface, Surface::Roof(_));
    let roof_trace = trace.faces.iter().find(|t| is_roof(t.face)).unwrap();
    assert!(
        (roof_trace.texel_m - 0.094).abs() < 1e-3,
        "94 m above the roof, 1000 px"
    );
    assert_eq!(roof_trace.unseen, 0.0);
}

#[test]
fn what_a_higher_roof_hides_is_taken_from_another_view() {
    let roofs = [
        facet(
            &[&[(0.0, 0.0), (5.0, 0.0), (5.0, 6.0), (0.0, 6.0)]],
            8.0,
            0.0,
            0.0,
        ),
        facet(
            &[&[(5.0, 0.0), (9.0, 0.0), (9.0, 6.0), (5.0, 6.0)]],
            4.0,
            0.0,
            0.0,
        ),
    ];
    let (model, _) = close_buildings(&roofs, |_| 0.0);
    let low_roof = |views: Vec<View>| {
        let scene = Scene { views, ..scene() };
        let (_, trace) = texture_model(&scene, &model, &TextureParams::default());
        let low = Surface::Roof(ridgeline::ids::FacetId(1));
        let is_low = |f: usize| model.buildings[0].solid.faces[f].surface == low;
        trace.faces.into_iter().find(|t| is_low(t.face)).unwrap()
    };
    // From (-10, 3, 100) the ray over the step falls by 4 m within 4 * 15 / 92 m of the 4 m wide roof.
    let hidden = 15.0 / 92.0;
    let alone = low_roof(vec![map_view("west.jpg", -10.0, 3.0)]);
    assert!((alone.unseen - hidden).abs() < 0.01, "{}", alone.unseen);
    assert!((alone.views[0].visible - 1.0 + hidden).abs() < 0.01);
    let both = low_roof(vec![
        map_view("east.jpg", 20.0, 3.0),
        map_view("west.jpg", -10.0, 3.0),
    ]);
    assert_eq!((both.views[0].view, both.unseen), (ViewId(0), 0.0));
    // A second view that shows just the hidden part: the step's foot is at its border.
    let mut foot = map_view("foot.jpg", 5.0, 3.0);
    foot.camera.width = 210;
    let filled = low_roof(vec![foot, map_view("west.jpg", -10.0, 3.0)]);
    assert_eq!(
        (filled.views[0].view, filled.views[1].view),
        (ViewId(1), ViewId(0))
    );
    assert!(filled.filled > 0.02 && filled.filled + filled.unseen < hidden + 0.01);
}

#[test]
fn evidence_is_written_in_the_world_frame_of_the_input() {
    let (_, model, _) = planted_models().remove(0);
    let files = files_of(&scene(), &model);
    let parse = |name: &str| serde_json::from_slice::<Value>(&files[name]).unwrap();
    let line = &parse("lines.json")["lines"][0];
    assert_eq!(
        line["p1"],
        serde_json::json!([432_104.0, 5_412_305.0, 6.1235])
    );
    assert_eq!(line["views"][0]["view"], "b.jpg");
    assert_eq!(
        line["views"][0]["segment"],
        serde_json::json!([1.0, 2.0, 30.25, 4.0])
    );
    let segments = parse("segments.json");
    assert_eq!(segments["views"][0]["segments"], serde_json::json!([]));
    assert_eq!(segments["views"][1]["segments"][0][2], 30.25);
    let half_plane = &parse("halfplanes.json")["half_planes"][0];
    assert_eq!(half_plane["side"], "left");
    let plane: Vec<f64> = half_plane["plane"]
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect();
    let world = ORIGIN + Vector3::new(2.0, 4.0, 3.8);
    let distance = Vector3::new(plane[0], plane[1], plane[2]).dot(&world) + plane[3];
    assert!(distance.abs() < 1e-6);
}

#[test]
fn a_model_without_buildings_makes_valid_files() {
    let files = files_of(&scene(), &RoofModel::default());
    let text = std::str::from_utf8(&files["model.city.json"]).unwrap();
    assert!(cjval::CJValidator::from_str(text).is_valid());
    assert!(gltf::Gltf::from_slice(&files["model.glb"]).is_ok());
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    let (_, model, _) = planted_models().remove(1);
    assert_eq!(files_of(&scene(), &model), files_of(&scene(), &model));
}

/// Area of the faces of all solids, square metres.
fn surface_area(model: &RoofModel) -> f64 {
    let solids = model.buildings.iter().map(|b| &b.solid);
    solids
        .flat_map(|s| s.faces.iter().map(|f| s.vector_area(&f.rings).norm()))
        .sum()
}

fn triangle_area([a, b, c]: [Vector3<f64>; 3]) -> f64 {
    0.5 * (b - a).cross(&(c - a)).norm()
}

#[test]
fn obj_reads_back_with_the_area_and_the_texture_of_the_model() {
    let scene = scene();
    for (name, model, _) in planted_models() {
        let files = files_of(&scene, &model);
        let (meshes, materials) = tobj::load_obj_buf(
            &mut &files["model.obj"][..],
            &tobj::LoadOptions::default(),
            |path| {
                assert_eq!(path.to_str(), Some("model.mtl"));
                tobj::load_mtl_buf(&mut &files["model.mtl"][..])
            },
        )
        .unwrap();
        assert_eq!(
            materials.unwrap()[0].diffuse_texture.as_deref(),
            Some("model_atlas.jpg")
        );
        let mut area = 0.0;
        for mesh in meshes.iter().map(|m| &m.mesh) {
            let point =
                |i: u32| Vector3::from_row_slice(&mesh.positions[3 * i as usize..][..3]) - ORIGIN;
            for t in mesh.indices.chunks(3) {
                area += triangle_area([point(t[0]), point(t[1]), point(t[2])]);
            }
            assert_eq!(mesh.indices.len(), mesh.texcoord_indices.len());
            assert!(mesh.texcoords.iter().all(|v| (0.0..=1.0).contains(v)));
        }
        assert!((area - surface_area(&model)).abs() < 0.05, "{name}: {area}");
    }
}

#[test]
fn ply_reads_back_with_its_faces_and_edges() {
    use ply_rs_bw::ply::Property;
    let scene = scene();
    let (_, lines, _) = planted_evidence();
    for (name, model, _) in planted_models() {
        let files = files_of(&scene, &model);
        let parser = ply_rs_bw::parser::Parser::<ply_rs_bw::ply::DefaultElement>::new();
        let ply = parser.read_ply(&mut &files["model.ply"][..]).unwrap();
        let number = |p: &Property| match p {
            Property::Double(v) => *v,
            Property::Int(i) => f64::from(*i),
            other => panic!("{other:?}"),
        };
        let point = |i: usize| {
            let v = &ply.payload["vertex"][i];
            Vector3::new(number(&v["x"]), number(&v["y"]), number(&v["z"])) - ORIGIN
        };
        let area: f64 = ply.payload["face"]
            .iter()
            .map(|face| match &face["vertex_indices"] {
                Property::ListInt(i) => triangle_area([0, 1, 2].map(|k| point(i[k] as usize))),
                other => panic!("{other:?}"),
            })
            .sum();
        assert!((area - surface_area(&model)).abs() < 0.01, "{name}: {area}");
        assert_eq!(ply.payload["edge"].len(), lines.len());
        let edge = &ply.payload["edge"][0];
        let ends = ["vertex1", "vertex2"].map(|k| point(number(&edge[k]) as usize));
        assert!((ends[0] - lines[0].segment.p0.coords).norm() < 1e-4);
        assert!((ends[1] - lines[0].segment.p1.coords).norm() < 1e-4);
    }
}

#[test]
fn dxf_reads_back_on_its_layers() {
    let scene = scene();
    let (_, lines, _) = planted_evidence();
    for (name, model, _) in planted_models() {
        let files = files_of(&scene, &model);
        let drawing = dxf::Drawing::load(&mut &files["model.dxf"][..]).unwrap();
        assert_eq!(drawing.header.version, dxf::enums::AcadVersion::R12);
        let at = |p: &dxf::Point| Vector3::new(p.x, p.y, p.z) - ORIGIN;
        let (mut area, mut drawn) = (0.0, 0);
        for entity in drawing.entities() {
            match &entity.specific {
                dxf::entities::EntityType::Face3D(f) => {
                    assert!(["ROOF", "WALL", "GROUND"].contains(&&*entity.common.layer));
                    area +=
                        triangle_area([&f.first_corner, &f.second_corner, &f.third_corner].map(at));
                }
                dxf::entities::EntityType::Line(line) => {
                    assert_eq!(entity.common.layer, "LINE3D");
                    assert!((at(&line.p1) - lines[drawn].segment.p0.coords).norm() < 1e-4);
                    drawn += 1;
                }
                other => panic!("{other:?}"),
            }
        }
        assert!((area - surface_area(&model)).abs() < 0.01, "{name}: {area}");
        assert_eq!(drawn, lines.len());
    }
}

#[test]
fn footprints_read_back_with_the_plan_area() {
    let scene = scene();
    let ring_area = |ring: &Vec<geojson::Position>| -> f64 {
        assert_eq!(ring.first(), ring.last(), "rings are closed");
        ring.windows(2)
            .map(|e| {
                let [a, b] = [0, 1].map(|i| [e[i][0] - ORIGIN.x, e[i][1] - ORIGIN.y]);
                0.5 * (a[0] * b[1] - b[0] * a[1])
            })
            .sum()
    };
    for (name, model, _) in planted_models() {
        let files = files_of(&scene, &model);
        let text = std::str::from_utf8(&files["footprints.geojson"]).unwrap();
        let collection: geojson::FeatureCollection = text
            .parse::<geojson::GeoJson>()
            .unwrap()
            .try_into()
            .unwrap();
        let mut area = 0.0;
        for feature in &collection.features {
            let Some(geojson::GeometryValue::Polygon { coordinates }) =
                feature.geometry.as_ref().map(|g| &g.value)
            else {
                panic!("{name}: no polygon");
            };
            // Outer rings counter-clockwise, holes clockwise (RFC 7946, 3.1.6).
            assert!(ring_area(&coordinates[0]) > 0.0);
            assert!(coordinates[1..].iter().all(|hole| ring_area(hole) < 0.0));
            area += coordinates.iter().map(ring_area).sum::<f64>();
            assert_eq!(feature.property("ground_m").unwrap().as_f64(), Some(0.0));
        }
        let plan: f64 = model
            .buildings
            .iter()
            .map(|b| {
                let ground = b
                    .solid
                    .faces
                    .iter()
                    .filter(|f| f.surface == Surface::Ground);
                ground
                    .map(|f| b.solid.vector_area(&f.rings).norm())
                    .sum::<f64>()
            })
            .sum();
        assert!(
            (area - plan).abs() < 1e-6,
            "{name}: {area} instead of {plan}"
        );
    }
}

#[test]
fn the_table_of_lines_reads_back() {
    let (_, lines, _) = planted_evidence();
    let files = files_of(&scene(), &planted_models()[0].1);
    let mut reader = csv::Reader::from_reader(&files["lines.csv"][..]);
    let rows: Vec<BTreeMap<String, String>> = reader.deserialize().map(Result::unwrap).collect();
    assert_eq!(rows.len(), lines.len());
    for (row, line) in rows.iter().zip(&lines) {
        assert_eq!(row["origin"], "matched");
        let row = |name: &str| row[name].parse::<f64>().unwrap();
        let p = Vector3::new(row("x1_m"), row("y1_m"), row("z1_m")) - ORIGIN;
        assert!((p - line.segment.p1.coords).norm() < 1e-4);
        assert!((row("length_m") - line.segment.length()).abs() < 1e-4);
        assert_eq!(row("views") as usize, line.supports.len());
    }
}

#[test]
fn a_known_reference_system_is_written() {
    let (_, model, _) = &planted_models()[0];
    let mut scene = scene();
    scene.survey.epsg = Some(25832);
    let files = files_of(&scene, model);
    let text = |name: &str| String::from_utf8_lossy(&files[name]).into_owned();
    let city: Value = serde_json::from_slice(&files["model.city.json"]).unwrap();
    assert_eq!(
        city["metadata"]["referenceSystem"],
        "https://www.opengis.net/def/crs/EPSG/0/25832"
    );
    assert!(cjval::CJValidator::from_str(&text("model.city.json")).is_valid());
    let plan: Value = serde_json::from_slice(&files["footprints.geojson"]).unwrap();
    assert_eq!(
        plan["crs"]["properties"]["name"],
        "urn:ogc:def:crs:EPSG::25832"
    );
    for name in ["model.obj", "model.ply", "model.dxf", "model.glb"] {
        assert!(text(name).contains("EPSG:25832"), "{name}");
    }
    dxf::Drawing::load(&mut &files["model.dxf"][..]).unwrap();

    // A local frame on the Earth: footprints in longitude and latitude, within a metre of its zero here.
    scene.survey.epsg = None;
    scene.origin = Vector3::zeros();
    scene.survey.anchor = Some(ridgeline::orientation::Anchor {
        lon_deg: 8.412,
        lat_deg: 49.013,
        height_m: 0.0,
    });
    let files = files_of(&scene, model);
    let plan: Value = serde_json::from_slice(&files["footprints.geojson"]).unwrap();
    let ring = plan["features"][0]["geometry"]["coordinates"][0]
        .as_array()
        .unwrap()
        .clone();
    let metres = |p: &Value| {
        // A degree of latitude is 111.2 km there, one of longitude 73.1 km.
        let [lon, lat] = [0, 1].map(|i| p[i].as_f64().unwrap());
        ((lon - 8.412) * 73_133.0, (lat - 49.013) * 111_214.0)
    };
    let width = ring.iter().map(|p| metres(p).0).fold(0.0, f64::max);
    let depth = ring.iter().map(|p| metres(p).1).fold(0.0, f64::max);
    assert!(
        (width - 10.0).abs() < 0.05 && (depth - 8.0).abs() < 0.05,
        "{width} {depth}"
    );
}
