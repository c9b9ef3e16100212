//! Is a solid sound for other programs, with its corners rounded as files hold them?
//!
//! Invariants of models are those of ISO 19107 before rounding. Programs that check files round
//! before, and look at triangles: at their normals, and at where they touch.

use std::collections::BTreeSet;

use nalgebra::{Point3, Vector3};

use crate::base::geometry::sides;
use crate::roofs::model::{Solid, triangulate};

/// Step of the coordinates in files, metres.
pub const WRITTEN_STEP_M: f64 = 1e-4;

/// Corners nearer than this count as one elsewhere, metres (val3dity's default).
const CORNER_SNAP_M: f64 = 1e-3;
/// Largest distance of a corner from the plane of its face, metres (val3dity's default).
const PLANARITY_M: f64 = 1e-2;
/// Cosine of the largest angle between the normals of a face and of its triangles: 20 degrees
/// (val3dity's default).
const TRIANGLE_COSINE: f64 = 0.939_692_620_785_908_4;
/// A triangulation covers its face if their vector areas differ by less, square metres.
const AREA_M2: f64 = 1e-6;

/// In whole steps: signs of determinants are exact.
type Exact = Vector3<i128>;

/// Are the faces of a closed solid planar, with triangles that look the way they do, and do they
/// touch in common corners and edges only, all as one piece?
pub(super) fn is_sound_as_written(solid: &Solid) -> bool {
    let whole = |p: &Point3<f64>| p.coords.map(|c| (c / WRITTEN_STEP_M).round());
    let rounded = Solid {
        vertices: (solid.vertices.iter())
            .map(|p| Point3::from(whole(p) * WRITTEN_STEP_M))
            .collect(),
        faces: solid.faces.clone(),
    };
    let exact: Vec<Exact> = (solid.vertices.iter())
        .map(|p| whole(p).map(|c| c as i128))
        .collect();
    let triangles: Option<Vec<_>> = (0..solid.faces.len())
        .map(|face| sound_triangles(&rounded, face))
        .collect();
    let corners_sound = corners_are_apart(&rounded) && is_one_piece(solid);
    triangles
        .is_some_and(|of_faces| corners_sound && !faces_meet(&exact, &rounded.vertices, &of_faces))
}

fn corners_are_apart(solid: &Solid) -> bool {
    let mut corners: Vec<&Point3<f64>> = solid.vertices.iter().collect();
    corners.sort_by(|p, q| p.x.total_cmp(&q.x));
    corners.iter().enumerate().all(|(i, p)| {
        let near = corners[i + 1..]
            .iter()
            .take_while(|q| q.x - p.x < CORNER_SNAP_M);
        near.into_iter().all(|q| (*q - *p).norm() >= CORNER_SNAP_M)
    })
}

/// Are all faces connected through common corners?
fn is_one_piece(solid: &Solid) -> bool {
    let mut faces_at = vec![Vec::new(); solid.vertices.len()];
    for (i, face) in solid.faces.iter().enumerate() {
        for v in face.rings.iter().flatten() {
            faces_at[*v as usize].push(i);
        }
    }
    let mut reached = vec![false; solid.faces.len()];
    let mut open: Vec<usize> = faces_at.iter().flatten().copied().take(1).collect();
    while let Some(i) = open.pop() {
        if !std::mem::replace(&mut reached[i], true) {
            let corners = solid.faces[i].rings.iter().flatten();
            open.extend(corners.flat_map(|v| &faces_at[*v as usize]));
        }
    }
    reached.iter().all(|r| *r)
}

/// The triangles of a face, as corners of the solid; `None` where it is not planar.
fn sound_triangles(solid: &Solid, face: usize) -> Option<Vec<[u32; 3]>> {
    let face = &solid.faces[face];
    let corners: Vec<u32> = face.rings.iter().flatten().copied().collect();
    let whole = solid.vector_area(&face.rings);
    let normal = whole.try_normalize(1e-12)?;
    let heights = (corners.iter()).map(|v| normal.dot(&solid.vertices[*v as usize].coords));
    let mean = heights.clone().sum::<f64>() / corners.len() as f64;
    let is_planar = heights.into_iter().all(|h| (h - mean).abs() <= PLANARITY_M);
    let triangles: Vec<[u32; 3]> = (triangulate(solid, face).into_iter())
        .map(|t| t.map(|i| corners[i as usize]))
        .collect();
    let area = |t: &[u32; 3]| solid.vector_area(&[t.to_vec()]);
    let covered: Vector3<f64> = triangles.iter().map(area).sum();
    let looks_along = |t: &[u32; 3]| {
        let area = area(t);
        // One on a line has no normal.
        area.norm() < 1e-12 || area.dot(&normal) >= TRIANGLE_COSINE * area.norm()
    };
    let is_sound =
        is_planar && (covered - whole).norm() < AREA_M2 && triangles.iter().all(looks_along);
    is_sound.then_some(triangles)
}

/// Do triangles of different faces have more in common than common corners and edges?
fn faces_meet(corners: &[Exact], places: &[Point3<f64>], of_faces: &[Vec<[u32; 3]>]) -> bool {
    let extent = |t: &[u32; 3], axis: usize| {
        let at = t.map(|v| places[v as usize][axis]);
        let fold = |f: fn(f64, f64) -> f64| f(f(at[0], at[1]), at[2]);
        [
            fold(crate::base::math::smaller),
            fold(crate::base::math::larger),
        ]
    };
    let has_area = |t: &[u32; 3]| normal(&t.map(|v| corners[v as usize])) != Exact::zeros();
    let mut all: Vec<([[f64; 2]; 3], usize, [u32; 3])> = (of_faces.iter().enumerate())
        .flat_map(|(face, triangles)| triangles.iter().map(move |t| (face, *t)))
        .filter(|(_, t)| has_area(t))
        .map(|(face, t)| ([0, 1, 2].map(|axis| extent(&t, axis)), face, t))
        .collect();
    all.sort_by(|a, b| a.0[0][0].total_cmp(&b.0[0][0]));
    all.iter().enumerate().any(|(i, (box_s, face_s, s))| {
        let after = all[i + 1..].iter();
        let mut near = after.take_while(|other| other.0[0][0] <= box_s[0][1]);
        near.any(|(box_t, face_t, t)| {
            let apart = (1..3)
                .any(|axis| box_s[axis][1] < box_t[axis][0] || box_t[axis][1] < box_s[axis][0]);
            face_s != face_t && !apart && triangles_meet(corners, s, t)
        })
    })
}

fn triangles_meet(corners: &[Exact], s: &[u32; 3], t: &[u32; 3]) -> bool {
    let common: BTreeSet<u32> = s.iter().copied().filter(|v| t.contains(v)).collect();
    let at = |v: u32| corners[v as usize];
    let [in_s, in_t] = [s, t].map(|triangle| triangle.map(at));
    let own = |t: &[u32; 3]| -> Vec<Exact> {
        let own = t.iter().filter(|v| !common.contains(v));
        own.map(|v| at(*v)).collect()
    };
    let (of_s, of_t) = (own(s), own(t));
    let any_side =
        |of: &[Exact; 3], meets: &[Exact; 3]| sides(of).any(|side| side_meets(side, meets));
    match common.len() {
        0 => any_side(&in_s, &in_t) || any_side(&in_t, &in_s),
        1 => side_meets([of_s[0], of_s[1]], &in_t) || side_meets([of_t[0], of_t[1]], &in_s),
        2 => {
            let mut edge = common.iter().map(|v| at(*v));
            let (a, b) = (edge.next(), edge.next());
            let Some((a, b)) = a.zip(b) else { return true };
            let [one, other] = [of_s[0], of_t[0]].map(|c| normal(&[a, b, c]));
            // Folded upon each other.
            one.cross(&other) == Exact::zeros() && one.dot(&other) > 0
        }
        _ => true,
    }
}

fn normal([a, b, c]: &[Exact; 3]) -> Exact {
    (b - a).cross(&(c - a))
}

/// Does a closed segment meet a closed triangle?
fn side_meets([p, q]: [Exact; 2], triangle: &[Exact; 3]) -> bool {
    let n = normal(triangle);
    let [from, to] = [p, q].map(|r| n.dot(&(r - triangle[0])).signum());
    if from * to > 0 {
        return false;
    }
    if (from, to) == (0, 0) {
        // In one plane: left and right of lines are seen along its normal.
        let turn = |a: Exact, b: Exact, c: Exact| n.dot(&normal(&[a, b, c])).signum();
        let within = |r: Exact| sides(triangle).all(|[a, b]| turn(a, b, r) >= 0);
        let crosses = |[a, b]: [Exact; 2]| {
            turn(a, b, p) * turn(a, b, q) <= 0
                && turn(p, q, a) * turn(p, q, b) <= 0
                // On one line they may lie apart.
                && (0..3).all(|k| a[k].min(b[k]) <= p[k].max(q[k]) && p[k].min(q[k]) <= a[k].max(b[k]))
        };
        return within(p) || within(q) || sides(triangle).any(crosses);
    }
    let around = || sides(triangle).map(|[a, b]| (q - p).cross(&(a - p)).dot(&(b - p)).signum());
    around().all(|side| side >= 0) || around().all(|side| side <= 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::model::{SolidFace, Surface};

    /// A cube of 10 m with more corners, its top replaced by other faces.
    fn cube(more: &[[f64; 3]], top: &[&[u32]]) -> Solid {
        let square = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
        let level = |z: f64| square.map(|[x, y]| Point3::new(x, y, z));
        let mut vertices = [level(0.0), level(10.0)].concat();
        vertices.extend(more.iter().map(|p| Point3::from(*p)));
        let others: [&[u32]; 5] = [
            &[3, 2, 1, 0],
            &[0, 1, 5, 4],
            &[1, 2, 6, 5],
            &[2, 3, 7, 6],
            &[3, 0, 4, 7],
        ];
        let face = |ring: &&[u32]| SolidFace {
            surface: Surface::Wall,
            rings: vec![ring.to_vec()],
        };
        Solid {
            vertices,
            faces: others.iter().chain(top).map(face).collect(),
        }
    }

    /// The top as four triangles around its middle.
    fn tent(middle: [f64; 3]) -> Solid {
        cube(&[middle], &[&[4, 5, 8], &[5, 6, 8], &[6, 7, 8], &[7, 4, 8]])
    }

    #[test]
    fn a_cube_and_tents_are_sound_until_they_meet_the_bottom() {
        assert!(is_sound_as_written(&cube(&[], &[&[4, 5, 6, 7]])));
        for (z, sound) in [(13.0, true), (1.0, true), (0.0, false), (-1.0, false)] {
            assert_eq!(is_sound_as_written(&tent([5.0, 5.0, z])), sound, "{z}");
        }
        // Beyond a wall.
        assert!(!is_sound_as_written(&tent([12.0, 5.0, 5.0])));
    }

    #[test]
    fn a_face_may_bend_a_little() {
        let mut bent = cube(&[], &[&[4, 5, 6, 7]]);
        for (z, sound) in [(10.03, true), (10.05, false)] {
            bent.vertices[6].z = z;
            assert_eq!(is_sound_as_written(&bent), sound, "{z}");
        }
        // Within a centimetre, and a triangle of it is as steep as a stair.
        let corner = [[5.0, 0.0, 10.0], [5.0, 0.012, 10.009], [5.012, 0.0, 10.0]];
        assert!(!is_sound_as_written(&cube(
            &corner,
            &[&[4, 8, 9, 10, 5, 6, 7]]
        )));
    }

    #[test]
    fn two_cubes_are_no_solid() {
        let mut two = cube(&[], &[&[4, 5, 6, 7]]);
        let far = two.vertices.iter().map(|p| p + Vector3::x() * 30.0);
        two.vertices = two.vertices.iter().copied().chain(far).collect();
        let mut more = two.faces.clone();
        for v in more.iter_mut().flat_map(|f| &mut f.rings).flatten() {
            *v += 8;
        }
        two.faces.extend(more);
        assert!(!is_sound_as_written(&two));
    }

    #[test]
    fn corners_of_one_place_are_not_sound() {
        let twice = |gap: f64| {
            let corner = [5.0, 5.0 + gap, 12.0];
            let top: [&[u32]; 4] = [&[4, 5, 8], &[5, 6, 8], &[6, 7, 9, 8], &[7, 4, 8]];
            is_sound_as_written(&cube(&[[5.0, 5.0, 12.0], corner], &top))
        };
        assert!(!twice(0.0005));
    }
}
