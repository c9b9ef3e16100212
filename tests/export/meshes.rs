//! OBJ, PLY and DXF.

use nalgebra::Vector3;
use ridgeline::roofs::model::RoofModel;

use crate::planted::{ORIGIN, files_of, planted_evidence, planted_models, scene};

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
