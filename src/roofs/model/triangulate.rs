//! Triangles of a planar face, for formats that know no polygons.
//!
//! A constrained Delaunay triangulation keeps every corner, also those on straight edges; ear
//! clipping drops them and leaves cracks where the neighbour keeps its own.

use nalgebra::{Point2, Vector3};
use spade::{ConstrainedDelaunayTriangulation, Point2 as SpadePoint, Triangulation};

use super::roof_model::{Solid, SolidFace};
use crate::base::geometry::{Polygon, sides};

/// Triangles of a face, counter-clockwise seen from outside. Indices count the corners of all rings
/// in order, so that texture coordinates per corner can be looked up.
pub fn triangulate(solid: &Solid, face: &SolidFace) -> Vec<[u32; 3]> {
    let flat = flat_rings(solid, face);
    let mut cdt = ConstrainedDelaunayTriangulation::<SpadePoint<f64>>::new();
    // Rings may touch in a point: spade then gives the same vertex twice.
    let mut corner_of = Vec::new();
    let mut corner = 0;
    for ring in &flat.rings {
        let mut vertices = Vec::with_capacity(ring.len());
        for p in ring {
            // Only numbers that are not finite are rejected.
            let Ok(vertex) = cdt.insert(SpadePoint::new(p.x, p.y)) else {
                return Vec::new();
            };
            if vertex.index() == corner_of.len() {
                corner_of.push(corner);
            }
            vertices.push(vertex);
            corner += 1;
        }
        for [from, to] in sides(&vertices) {
            if from != to && cdt.can_add_constraint(from, to) {
                cdt.add_constraint(from, to);
            }
        }
    }
    cdt.inner_faces()
        .filter(|triangle| {
            let c = triangle.center();
            flat.contains(&Point2::new(c.x, c.y))
        })
        .map(|triangle| triangle.vertices().map(|v| corner_of[v.index()]))
        .collect()
}

/// The rings in a frame of the face's plane, metres, the outer one counter-clockwise.
fn flat_rings(solid: &Solid, face: &SolidFace) -> Polygon {
    let normal = solid
        .vector_area(&face.rings)
        .try_normalize(1e-12)
        .unwrap_or_else(Vector3::z);
    let axis = if normal.z.abs() > 0.7 {
        Vector3::x()
    } else {
        Vector3::z()
    };
    let right = axis.cross(&normal).normalize();
    let up = normal.cross(&right);
    let origin = solid.vertices[face.rings[0][0] as usize];
    let flat = |&v: &u32| {
        let d = solid.vertices[v as usize] - origin;
        Point2::new(d.dot(&right), d.dot(&up))
    };
    let rings = face.rings.iter();
    Polygon {
        rings: rings.map(|ring| ring.iter().map(flat).collect()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::model::Surface;
    use nalgebra::Point3;

    fn face_of(rings: &[&[(f64, f64)]]) -> (Solid, SolidFace) {
        // On a steep plane, so that the frame matters.
        let vertices: Vec<Point3<f64>> = rings
            .iter()
            .flat_map(|ring| {
                ring.iter()
                    .map(|&(x, y)| Point3::new(x, 0.6 * y, 3.0 + 0.8 * y))
            })
            .collect();
        let mut next = 0;
        let indices = rings.iter().map(|ring| {
            next += ring.len() as u32;
            (next - ring.len() as u32..next).collect()
        });
        let face = SolidFace {
            surface: Surface::Wall,
            rings: indices.collect(),
        };
        (
            Solid {
                vertices,
                faces: vec![face.clone()],
            },
            face,
        )
    }

    /// Sum of the triangles' vector areas.
    fn area(solid: &Solid, triangles: &[[u32; 3]]) -> Vector3<f64> {
        triangles
            .iter()
            .map(|t| solid.vector_area(&[t.to_vec()]))
            .sum()
    }

    #[test]
    fn triangles_cover_the_face_once_and_face_its_way() {
        let (solid, face) = face_of(&[
            &[
                (0.0, 0.0),
                (5.0, 0.0),
                (10.0, 0.0),
                (10.0, 4.0),
                (4.0, 4.0),
                (4.0, 9.0),
                (0.0, 9.0),
            ],
            &[(1.0, 1.0), (1.0, 3.0), (3.0, 3.0), (3.0, 1.0)],
        ]);
        let triangles = triangulate(&solid, &face);
        let whole = solid.vector_area(&face.rings);
        assert!((area(&solid, &triangles) - whole).norm() < 1e-9);
        assert!((whole.norm() - (10.0 * 4.0 + 4.0 * 5.0 - 4.0)).abs() < 1e-9);
        assert!(
            triangles
                .iter()
                .all(|t| area(&solid, &[*t]).dot(&whole) > 0.0)
        );
        // The corner on the straight edge is used.
        assert!(triangles.iter().flatten().any(|&i| i == 1));
    }

    #[test]
    fn a_hole_that_touches_the_outline_is_left_open() {
        let (solid, face) = face_of(&[
            &[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)],
            &[(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)],
        ]);
        let triangles = triangulate(&solid, &face);
        assert!((area(&solid, &triangles).norm() - 14.5).abs() < 1e-9);
    }
}
