//! The checks that val3dity makes of a CityJSON solid (ISO 19107), with its numbers of errors, from
//! the file alone: nothing of the crate is used, and predicates are exact.
//!
//! Rings of CityJSON close by themselves, so that 103 cannot occur; one that repeats its first
//! corner has 102.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;
use spade::{ConstrainedDelaunayTriangulation, Point2 as SpadePoint, Triangulation};

/// Corners nearer than this are one, metres (val3dity's default).
const SNAP_M: f64 = 1e-3;
/// Largest distance of a corner from the plane of its face, metres (val3dity's default).
const PLANAR_M: f64 = 1e-2;
/// Cosine of the largest angle between the normals of a face and of a triangle of it: 20 degrees
/// (its default).
const NORMALS_COS: f64 = 0.939_692_620_785_908_4;

/// A corner as whole steps of the file's scale.
type Corner = [i64; 3];
type Ring = Vec<usize>;

/// What is wrong with an object, as (number of the error, where).
pub type Findings = Vec<(u16, String)>;

/// The errors of all solids of a file, by object.
pub fn solid_errors(city: &Value) -> BTreeMap<String, Findings> {
    let scale = city["transform"]["scale"][0].as_f64().expect("a scale");
    let whole = |v: &Value| v.as_i64().expect("a whole number");
    let vertices: Vec<Corner> = (city["vertices"].as_array().expect("vertices").iter())
        .map(|v| [0, 1, 2].map(|i| whole(&v[i])))
        .collect();
    let mut errors = BTreeMap::new();
    for (name, object) in city["CityObjects"].as_object().expect("objects") {
        for geometry in object["geometry"].as_array().expect("geometry") {
            for shell in geometry["boundaries"].as_array().expect("shells") {
                let list = |v: &Value| v.as_array().expect("a list").clone();
                let ring = |r: &Value| -> Vec<usize> {
                    list(r).iter().map(|v| whole(v) as usize).collect()
                };
                let faces: Vec<Vec<Vec<usize>>> = (list(shell).iter())
                    .map(|face| list(face).iter().map(ring).collect())
                    .collect();
                let found: &mut Findings = errors.entry(name.clone()).or_default();
                found.extend(shell_errors(&vertices, &faces, scale));
            }
        }
    }
    errors
}

/// The errors of one outer shell: those of its faces, or if these are sound, its own.
fn shell_errors(vertices: &[Corner], faces: &[Vec<Ring>], scale: f64) -> Findings {
    let (corners, faces) = snapped(vertices, faces, scale);
    let mut found = Findings::new();
    for (i, face) in faces.iter().enumerate() {
        found.extend(face_error(&corners, face, scale).map(|code| (code, format!("face {i}"))));
    }
    if faces.len() < 4 {
        found.push((301, format!("{} faces", faces.len())));
    }
    if found.is_empty() {
        check_edges(&faces, &mut found);
    }
    if found.is_empty() {
        check_intersections(&corners, &faces, &mut found);
    }
    if found.is_empty() && volume(&corners, &faces) <= 0.0 {
        found.push((405, "its faces look inwards".into()));
    }
    found
}

/// Corners that lie together as one, with the faces that refer to them.
fn snapped(vertices: &[Corner], faces: &[Vec<Ring>], scale: f64) -> (Vec<Corner>, Vec<Vec<Ring>>) {
    let near = |a: &Corner, b: &Corner| norm(less(*a, *b)) * scale < SNAP_M;
    let mut corners: Vec<Corner> = Vec::new();
    let mut index: BTreeMap<usize, usize> = BTreeMap::new();
    for &v in faces.iter().flatten().flatten() {
        index.entry(v).or_insert_with(|| {
            let known = corners.iter().position(|c| near(c, &vertices[v]));
            known.unwrap_or_else(|| {
                corners.push(vertices[v]);
                corners.len() - 1
            })
        });
    }
    let renamed = |face: &Vec<Ring>| -> Vec<Ring> {
        let ring = |ring: &Ring| ring.iter().map(|v| index[v]).collect();
        face.iter().map(ring).collect()
    };
    let faces = faces.iter().map(renamed).collect();
    (corners, faces)
}

fn less(a: Corner, b: Corner) -> [i128; 3] {
    [0, 1, 2].map(|i| i128::from(a[i] - b[i]))
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn norm(a: [i128; 3]) -> f64 {
    dot_f64(a, a).sqrt()
}

/// Twice the vector area of a ring.
fn vector_area(corners: &[Corner], ring: &Ring) -> [i128; 3] {
    let at = |i: usize| less(corners[ring[i]], corners[ring[0]]);
    (1..ring.len() - 1).fold([0; 3], |sum, i| {
        let c = cross(at(i), at(i + 1));
        [0, 1, 2].map(|k| sum[k] + c[k])
    })
}

/// The axis to drop so that a face keeps its shape in the two others.
fn largest_axis(v: [i128; 3]) -> usize {
    (0..3)
        .max_by_key(|&i| (v[i].abs(), 2 - i))
        .expect("three axes")
}

type Flat = [i128; 2];

fn flat(corner: Corner, axis: usize) -> Flat {
    [(axis + 1) % 3, (axis + 2) % 3].map(|i| i128::from(corner[i]))
}

/// Positive where a, b, c turn to the left.
fn turn(a: Flat, b: Flat, c: Flat) -> i128 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Do two closed segments have a common point?
fn meet(a: Flat, b: Flat, c: Flat, d: Flat) -> bool {
    let on = |p: Flat, q: Flat, r: Flat| {
        turn(p, q, r) == 0 && (0..2).all(|i| r[i] >= p[i].min(q[i]) && r[i] <= p[i].max(q[i]))
    };
    let sides = |p, q, r, s| turn(p, q, r).signum() * turn(p, q, s).signum();
    (sides(a, b, c, d) < 0 && sides(c, d, a, b) < 0)
        || on(a, b, c)
        || on(a, b, d)
        || on(c, d, a)
        || on(c, d, b)
}

/// Is a point inside a ring, whose sides do not pass it (even-odd rule)?
fn inside(ring: &[Flat], p: Flat) -> bool {
    (0..ring.len()).fold(false, |odd, i| {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        let crosses = (a[1] > p[1]) != (b[1] > p[1])
            && (turn(a, b, p) > 0) == (b[1] > a[1])
            && turn(a, b, p) != 0;
        odd != crosses
    })
}

/// The first error of a face.
fn face_error(corners: &[Corner], face: &[Ring], scale: f64) -> Option<u16> {
    for ring in face {
        let distinct: BTreeSet<_> = ring.iter().collect();
        if ring.len() < 3 || distinct.len() < 3 {
            return Some(101);
        }
        if (0..ring.len()).any(|i| ring[i] == ring[(i + 1) % ring.len()]) {
            return Some(102);
        }
    }
    let area = vector_area(corners, face.first()?);
    let axis = largest_axis(area);
    let rings: Vec<Vec<Flat>> = (face.iter())
        .map(|ring| ring.iter().map(|&v| flat(corners[v], axis)).collect())
        .collect();
    if rings.iter().any(|ring| !is_simple(ring)) || area == [0; 3] {
        return Some(104);
    }
    rings_error(face, &rings, corners, axis)
        .or_else(|| planarity_error(corners, face, axis, area, scale))
}

fn is_simple(ring: &[Flat]) -> bool {
    let n = ring.len();
    let side = |i: usize| (ring[i], ring[(i + 1) % n]);
    (0..n).all(|j| {
        (0..j).all(|i| {
            let ((a, b), (c, d)) = (side(i), side(j));
            let follows = i + 1 == j;
            let precedes = i == 0 && j == n - 1;
            match (follows, precedes) {
                // Neighbours may have their corner only: no spike.
                (true, _) => !(turn(a, b, d) == 0 && along(b, a, d) > 0),
                (_, true) => !(turn(c, d, b) == 0 && along(d, c, b) > 0),
                _ => !meet(a, b, c, d),
            }
        })
    })
}

/// Positive where p and q lie on the same side of the corner.
fn along(corner: Flat, p: Flat, q: Flat) -> i128 {
    (0..2)
        .map(|i| (p[i] - corner[i]) * (q[i] - corner[i]))
        .sum()
}

/// Errors between the rings of a face.
fn rings_error(face: &[Ring], rings: &[Vec<Flat>], corners: &[Corner], axis: usize) -> Option<u16> {
    let sides = |ring: &Vec<Flat>| -> Vec<(Flat, Flat)> {
        (0..ring.len())
            .map(|i| (ring[i], ring[(i + 1) % ring.len()]))
            .collect()
    };
    let mut touches = 0;
    for j in 1..rings.len() {
        for i in 0..j {
            let same: BTreeSet<_> = face[i].iter().collect();
            let common = face[j].iter().filter(|v| same.contains(v)).count();
            if common == face[j].len() && face[i].len() == common {
                return Some(202);
            }
            let crossing = sides(&rings[i]).into_iter().any(|(a, b)| {
                let crosses = |&(c, d): &(Flat, Flat)| {
                    let shares = [a, b].iter().any(|p| *p == c || *p == d);
                    !shares && meet(a, b, c, d)
                };
                sides(&rings[j]).iter().any(crosses)
            });
            if crossing {
                return Some(201);
            }
            touches += common;
            // Twice on the same two rings parts the face.
            if common > 1 {
                return Some(205);
            }
        }
    }
    // Rings that touch in as many places as there are rings form a closed chain.
    if touches >= rings.len() && rings.len() > 1 {
        return Some(205);
    }
    let outer = &rings[0];
    let free = |i: usize, other: usize| {
        let taken: BTreeSet<_> = face[other].iter().collect();
        let at = face[i].iter().position(|v| !taken.contains(v));
        rings[i][at.expect("one common corner at most")]
    };
    for hole in 1..rings.len() {
        if !inside(outer, free(hole, 0)) {
            return Some(206);
        }
        if (1..rings.len()).any(|o| o != hole && inside(&rings[o], free(hole, o))) {
            return Some(207);
        }
        let of = |ring: usize| vector_area(corners, &face[ring])[axis].signum();
        if of(hole) == of(0) {
            return Some(208);
        }
    }
    None
}

fn planarity_error(
    corners: &[Corner],
    face: &[Ring],
    axis: usize,
    area: [i128; 3],
    scale: f64,
) -> Option<u16> {
    let length = norm(area);
    let heights: Vec<f64> = (face.iter().flatten())
        .map(|&v| dot(less(corners[v], corners[face[0][0]]), area) as f64 / length * scale)
        .collect();
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    if heights.iter().any(|h| (h - mean).abs() > PLANAR_M) {
        return Some(203);
    }
    let deviates = |t: &[usize; 3]| {
        let normal = triangle_normal(corners, t);
        let size = norm(normal);
        size > 0.0 && dot_f64(normal, area) / (size * length) < NORMALS_COS
    };
    triangles(corners, face, axis, area)
        .iter()
        .any(deviates)
        .then_some(204)
}

fn dot_f64(a: [i128; 3], b: [i128; 3]) -> f64 {
    (0..3).map(|i| a[i] as f64 * b[i] as f64).sum()
}

fn triangle_normal(corners: &[Corner], t: &[usize; 3]) -> [i128; 3] {
    cross(
        less(corners[t[1]], corners[t[0]]),
        less(corners[t[2]], corners[t[0]]),
    )
}

/// The triangles of a sound face, turning as it does.
fn triangles(corners: &[Corner], face: &[Ring], axis: usize, area: [i128; 3]) -> Vec<[usize; 3]> {
    let mut cdt = ConstrainedDelaunayTriangulation::<SpadePoint<f64>>::new();
    let mut corner_of = BTreeMap::new();
    for ring in face {
        let handles: Vec<_> = (ring.iter())
            .map(|&v| {
                let [x, y] = flat(corners[v], axis).map(|c| c as f64);
                let handle = cdt.insert(SpadePoint::new(x, y)).expect("finite");
                corner_of.insert(handle.index(), v);
                handle
            })
            .collect();
        for i in 0..handles.len() {
            let (a, b) = (handles[i], handles[(i + 1) % handles.len()]);
            if cdt.can_add_constraint(a, b) {
                cdt.add_constraint(a, b);
            }
        }
    }
    // Three times as large, so that the middle of a triangle is whole.
    let large: Vec<Vec<Flat>> = (face.iter())
        .map(|ring| {
            ring.iter()
                .map(|&v| flat(corners[v], axis).map(|c| 3 * c))
                .collect()
        })
        .collect();
    let all = cdt
        .inner_faces()
        .map(|t| t.vertices().map(|v| corner_of[&v.index()]));
    let within = all.filter(|t| {
        let middle = [0, 1].map(|i| t.iter().map(|&v| flat(corners[v], axis)[i]).sum());
        large
            .iter()
            .fold(false, |odd, ring| odd != inside(ring, middle))
    });
    within
        .map(|[a, b, c]| if area[axis] > 0 { [a, b, c] } else { [a, c, b] })
        .collect()
}

/// Closed, oriented, one piece, no edge or corner where it touches itself.
fn check_edges(faces: &[Vec<Ring>], found: &mut Findings) {
    let mut uses: BTreeMap<(usize, usize), Vec<bool>> = BTreeMap::new();
    let mut fans: BTreeMap<usize, BTreeMap<usize, usize>> = BTreeMap::new();
    for ring in faces.iter().flatten() {
        for i in 0..ring.len() {
            let [a, b, c] = [0, 1, 2].map(|k| ring[(i + k) % ring.len()]);
            uses.entry((a.min(b), a.max(b))).or_default().push(a < b);
            fans.entry(b).or_default().insert(a, c);
        }
    }
    for (edge, directions) in &uses {
        let code = match directions[..] {
            [_] => 302,
            [a, b] if a == b => 307,
            [_, _] => continue,
            _ => 303,
        };
        found.push((code, format!("edge {edge:?}")));
    }
    if !found.is_empty() {
        return;
    }
    for (corner, fan) in &fans {
        let start = *fan.keys().next().expect("a corner has edges");
        let (mut at, mut steps) = (fan[&start], 1);
        while at != start {
            (at, steps) = (fan[&at], steps + 1);
        }
        if steps != fan.len() {
            found.push((303, format!("corner {corner}")));
        }
    }
    let mut reached = BTreeSet::new();
    let mut next = vec![faces[0][0][0]];
    while let Some(corner) = next.pop() {
        if reached.insert(corner) {
            let with = faces
                .iter()
                .filter(|f| f.iter().flatten().any(|v| *v == corner));
            next.extend(with.flatten().flatten());
        }
    }
    if reached.len() < fans.len() {
        found.push((305, "more than one piece".into()));
    }
}

/// Faces that touch or cross elsewhere than in common corners and edges.
fn check_intersections(corners: &[Corner], faces: &[Vec<Ring>], found: &mut Findings) {
    let mut all = Vec::new();
    for (i, face) in faces.iter().enumerate() {
        let area = vector_area(corners, &face[0]);
        let of_face = triangles(corners, face, largest_axis(area), area);
        let proper = |t: &[usize; 3]| triangle_normal(corners, t) != [0; 3];
        all.extend(of_face.into_iter().filter(proper).map(|t| (i, t)));
    }
    let range = |t: &[usize; 3], axis: usize| {
        let of = t.map(|v| corners[v][axis]);
        (of.iter().min().copied(), of.iter().max().copied())
    };
    let mut pairs = BTreeSet::new();
    for (n, (j, t)) in all.iter().enumerate() {
        for (i, s) in &all[..n] {
            let apart = (0..3).any(|axis| {
                let ((a, b), (c, d)) = (range(t, axis), range(s, axis));
                b < c || d < a
            });
            if i != j && !apart && intersect(corners, s, t) {
                pairs.insert((i, j));
            }
        }
    }
    found.extend(
        pairs
            .iter()
            .map(|(i, j)| (306, format!("faces {i} and {j}"))),
    );
}

/// Do two triangles have more in common than common corners and edges?
fn intersect(corners: &[Corner], s: &[usize; 3], t: &[usize; 3]) -> bool {
    let common: Vec<usize> = s.iter().copied().filter(|v| t.contains(v)).collect();
    let rest = |of: &[usize; 3]| -> Vec<usize> {
        of.iter().copied().filter(|v| !common.contains(v)).collect()
    };
    let (of_s, of_t) = (rest(s), rest(t));
    let hits = |edge: [usize; 2], triangle: &[usize; 3]| {
        segment_meets(edge.map(|v| corners[v]), triangle.map(|v| corners[v]))
    };
    match common.len() {
        0 => (0..3).any(|i| hits([s[i], s[(i + 1) % 3]], t) || hits([t[i], t[(i + 1) % 3]], s)),
        1 => hits([of_s[0], of_s[1]], t) || hits([of_t[0], of_t[1]], s),
        2 => {
            let [a, b, c, d] = [common[0], common[1], of_s[0], of_t[0]].map(|v| corners[v]);
            let normal = cross(less(b, a), less(c, a));
            let other = cross(less(b, a), less(d, a));
            // Folded flat upon each other.
            dot(normal, less(d, a)) == 0 && dot(normal, other) > 0
        }
        _ => true,
    }
}

fn segment_meets([p, q]: [Corner; 2], triangle: [Corner; 3]) -> bool {
    let [a, b, c] = triangle;
    let normal = cross(less(b, a), less(c, a));
    let sides = [p, q].map(|r| dot(normal, less(r, a)).signum());
    if sides[0] * sides[1] > 0 {
        return false;
    }
    if sides == [0, 0] {
        let axis = largest_axis(normal);
        let [p, q] = [p, q].map(|r| flat(r, axis));
        let ring = triangle.map(|r| flat(r, axis));
        let crosses = (0..3).any(|i| meet(p, q, ring[i], ring[(i + 1) % 3]));
        return crosses || inside(&ring, p);
    }
    let around = [(a, b), (b, c), (c, a)]
        .map(|(u, v)| dot(cross(less(q, p), less(u, p)), less(v, p)).signum());
    around.iter().all(|&s| s >= 0) || around.iter().all(|&s| s <= 0)
}

/// Six times the volume, positive where faces look outwards.
fn volume(corners: &[Corner], faces: &[Vec<Ring>]) -> f64 {
    let origin = corners[faces[0][0][0]];
    let of = |face: &Vec<Ring>| -> f64 {
        face.iter()
            .map(|ring| dot_f64(less(corners[ring[0]], origin), vector_area(corners, ring)))
            .sum()
    };
    faces.iter().map(of).sum()
}
