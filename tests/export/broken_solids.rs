//! Every error of the independent check of solids, planted.

use std::fs;

use crate::solid_checks::solid_errors;
use serde_json::{Value, json};

/// No error.
const NONE: [u16; 0] = [];

/// A file with one solid; metres.
fn city(vertices: &[[f64; 3]], faces: &Value) -> Value {
    let whole: Vec<[i64; 3]> = (vertices.iter())
        .map(|v| v.map(|c| (c * 1e4).round() as i64))
        .collect();
    json!({
        "type": "CityJSON",
        "transform": { "scale": [1e-4, 1e-4, 1e-4], "translate": [0.0, 0.0, 0.0] },
        "vertices": whole,
        "CityObjects": { "a": { "geometry": [{ "boundaries": [faces] }] } },
    })
}

/// The numbers of the errors, each once.
fn codes(vertices: &[[f64; 3]], faces: &Value) -> Vec<u16> {
    let errors = solid_errors(&city(vertices, faces));
    let mut codes: Vec<u16> = errors["a"].iter().map(|e| e.0).collect();
    codes.sort();
    codes.dedup();
    codes
}

/// A cube of 10 m: its corners, and its faces bottom, top, south, east, north, west.
fn cube() -> (Vec<[f64; 3]>, Value) {
    let corner = |i: usize| [[0, 0], [10, 0], [10, 10], [0, 10]][i % 4];
    let vertices = (0..8).map(|i| {
        let [x, y] = corner(i).map(f64::from);
        [x, y, if i < 4 { 0.0 } else { 10.0 }]
    });
    let faces = json!([
        [[3, 2, 1, 0]],
        [[4, 5, 6, 7]],
        [[0, 1, 5, 4]],
        [[1, 2, 6, 5]],
        [[2, 3, 7, 6]],
        [[3, 0, 4, 7]]
    ]);
    (vertices.collect(), faces)
}

/// The cube, changed.
fn damaged(damage: impl Fn(&mut Vec<[f64; 3]>, &mut Value)) -> Vec<u16> {
    let (mut vertices, mut faces) = cube();
    damage(&mut vertices, &mut faces);
    codes(&vertices, &faces)
}

/// The cube with rings of four corners in its top.
fn with_holes(holes: &[[[f64; 2]; 4]]) -> Vec<u16> {
    damaged(|vertices, faces| {
        for hole in holes {
            let first = vertices.len();
            vertices.extend(hole.map(|[x, y]| [x, y, 10.0]));
            let ring: Vec<usize> = (first..first + 4).collect();
            faces[1].as_array_mut().unwrap().push(json!(ring));
        }
    })
}

/// A square in the top, clockwise.
fn hole(x: f64, y: f64, side: f64) -> [[f64; 2]; 4] {
    [[x, y], [x, y + side], [x + side, y + side], [x + side, y]]
}

#[test]
fn a_sound_cube_and_a_tower_on_it_have_no_error() {
    assert_eq!(damaged(|_, _| {}), NONE);
    let tower = damaged(|vertices, faces| {
        for z in [10.0, 15.0] {
            vertices.extend([[2.0, 2.0, z], [5.0, 2.0, z], [5.0, 5.0, z], [2.0, 5.0, z]]);
        }
        faces[1].as_array_mut().unwrap().push(json!([11, 10, 9, 8]));
        let more = json!([
            [[12, 13, 14, 15]],
            [[8, 9, 13, 12]],
            [[9, 10, 14, 13]],
            [[10, 11, 15, 14]],
            [[11, 8, 12, 15]]
        ]);
        faces
            .as_array_mut()
            .unwrap()
            .extend(more.as_array().unwrap().clone());
    });
    assert_eq!(tower, NONE);
}

#[test]
fn rings() {
    assert_eq!(damaged(|_, f| f[0][0] = json!([3, 2])), [101]);
    assert_eq!(damaged(|_, f| f[0][0] = json!([3, 2, 2, 1, 0])), [102]);
    assert_eq!(
        damaged(|_, f| f[0][0] = json!([3, 2, 1, 0, 3])),
        [102],
        "closed twice"
    );
    // Two corners closer than a millimetre are the same.
    let near = damaged(|v, f| {
        v.push([10.0, 9.9995, 0.0]);
        f[0][0] = json!([3, 2, 8, 1, 0]);
    });
    assert_eq!(near, [102]);
    assert_eq!(
        damaged(|_, f| f[0][0] = json!([3, 1, 2, 0])),
        [104],
        "a bow tie"
    );
    let spike = damaged(|v, f| {
        v.push([12.0, 0.0, 0.0]);
        f[0][0] = json!([3, 2, 1, 8, 1, 0]);
    });
    assert_eq!(spike, [104]);
}

#[test]
fn faces_with_holes() {
    assert_eq!(with_holes(&[hole(8.0, 8.0, 4.0)]), [201]);
    assert_eq!(
        with_holes(&[hole(2.0, 2.0, 3.0), hole(2.0, 2.0, 3.0)]),
        [202]
    );
    assert_eq!(with_holes(&[hole(20.0, 2.0, 3.0)]), [206]);
    assert_eq!(
        with_holes(&[hole(2.0, 2.0, 6.0), hole(3.0, 3.0, 1.0)]),
        [207]
    );
    let mut same_way = hole(2.0, 2.0, 3.0);
    same_way.reverse();
    assert_eq!(with_holes(&[same_way]), [208]);
    // From the corner at (0, 0) to that at (10, 10): two halves.
    let parted = damaged(|v, f| {
        v.extend([[4.0, 6.0, 10.0], [6.0, 4.0, 10.0]]);
        f[1].as_array_mut().unwrap().push(json!([4, 8, 6, 9]));
    });
    assert_eq!(parted, [205]);
}

#[test]
fn planarity() {
    // Of four corners one is raised by z: a quarter of it off the plane through them.
    let raised = |z: f64| damaged(|v, _| v[6][2] += z);
    assert_eq!(raised(0.03), NONE);
    assert_eq!(raised(0.05), [203]);
    // A corner 8 mm off, beside another: within 1 cm, and a triangle there turns by far more.
    let bent = damaged(|v, f| {
        v.push([5.0, 0.0, 10.0]);
        v.push([5.0, 0.012, 10.009]);
        v.push([5.012, 0.0, 10.0]);
        f[1][0] = json!([4, 8, 9, 10, 5, 6, 7]);
        f[2][0] = json!([0, 1, 5, 10, 9, 8, 4]);
    });
    assert!(bent.contains(&204), "{bent:?}");
}

#[test]
fn shells() {
    assert_eq!(damaged(|_, f| f.as_array_mut().unwrap().truncate(3)), [301]);
    assert_eq!(damaged(|_, f| drop(f.as_array_mut().unwrap().pop())), [302]);
    let turned = damaged(|_, f| f[1][0] = json!([7, 6, 5, 4]));
    assert_eq!(turned, [307]);
    let inside_out = damaged(|_, f| {
        for face in f.as_array_mut().unwrap() {
            face[0].as_array_mut().unwrap().reverse();
        }
    });
    assert_eq!(inside_out, [405]);
    // A second cube that shares an edge, a corner, or nothing.
    let second = |shift: [f64; 3]| {
        damaged(|vertices, faces| {
            let (more, of_more) = cube();
            vertices.extend(more.iter().map(|v| [0, 1, 2].map(|i| v[i] + shift[i])));
            for face in of_more.as_array().unwrap() {
                let ring = face[0].as_array().unwrap().iter();
                let ring: Vec<u64> = ring.map(|v| v.as_u64().unwrap() + 8).collect();
                faces.as_array_mut().unwrap().push(json!([ring]));
            }
        })
    };
    assert_eq!(second([10.0, 10.0, 0.0]), [303]);
    assert_eq!(second([10.0, 10.0, 10.0]), [303]);
    assert_eq!(second([30.0, 0.0, 0.0]), [305]);
    // The middle of the top pushed down through the bottom.
    let pushed = damaged(|vertices, faces| {
        vertices.push([5.0, 5.0, -1.0]);
        let top = [[4, 5, 8], [5, 6, 8], [6, 7, 8], [7, 4, 8]].map(|t| json!([t]));
        let all = faces.as_array_mut().unwrap();
        all.remove(1);
        all.extend(top);
    });
    assert_eq!(pushed, [306]);
    // To where it touches the bottom.
    let touching = damaged(|vertices, faces| {
        vertices.push([5.0, 5.0, 0.0]);
        let top = [[4, 5, 8], [5, 6, 8], [6, 7, 8], [7, 4, 8]].map(|t| json!([t]));
        let all = faces.as_array_mut().unwrap();
        all.remove(1);
        all.extend(top);
    });
    assert_eq!(touching, [306]);
}

/// `MODELS=a.city.json:b.city.json` names files to check beside the planted ones.
#[test]
fn named_models_have_no_error() {
    let named = std::env::var("MODELS").unwrap_or_default();
    let mut wrong = Vec::new();
    for path in named.split(':').filter(|path| !path.is_empty()) {
        let file: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
        let errors = solid_errors(&file);
        let bad = errors.into_iter().filter(|(_, errors)| !errors.is_empty());
        wrong.extend(bad.map(|(name, errors)| format!("{path}: {name}: {errors:?}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
