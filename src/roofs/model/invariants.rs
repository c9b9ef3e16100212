//! Invariants of every roof model, whichever method made it; tests check them after each pipeline
//! run.

use std::collections::BTreeMap;

use nalgebra::{Point2, Point3, Vector2, Vector3};
use serde::Serialize;

use super::roof_model::{Facet, RoofModel, Solid, SolidFace, Surface, WELD_M};
use crate::base::geometry::{Polygon, sides, signed_area, vector_area};
use crate::base::ids::{BuildingId, FacetId};
use crate::base::math::{larger, smaller};

/// Faces of solids are planar within this distance, metres. Welding moves a corner by up to 1 mm in
/// plan, and two steep roofs that meet there are welded in height by a few millimetres; writers of
/// city models accept 1 cm.
pub const PLANAR_M: f64 = 5e-3;

/// Facets are planar within this distance, metres: their corners are computed from the plane.
const FACET_PLANAR_M: f64 = 1e-6;

/// Overlaps in plan below this width are rounding, metres.
const OVERLAP_WIDTH_M: f64 = 1e-3;

/// A broken invariant.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "violation")]
pub enum Violation {
    /// A facet's normal is not a unit vector that points up, or something is not a finite number.
    FacetPlane {
        /// The facet.
        facet: FacetId,
    },
    /// A corner of a facet is off its plane.
    FacetNotPlanar {
        /// The facet.
        facet: FacetId,
        /// Largest distance, metres.
        distance_m: f64,
    },
    /// A ring of a facet has fewer than three corners, touches or crosses itself.
    FacetRingNotSimple {
        /// The facet.
        facet: FacetId,
        /// 0 for the outer ring, then holes.
        ring: usize,
    },
    /// A facet's outer ring runs clockwise, or a hole counter-clockwise, seen from above.
    FacetRingOrientation {
        /// The facet.
        facet: FacetId,
        /// 0 for the outer ring, then holes.
        ring: usize,
    },
    /// Two facets cover the same ground.
    FacetsOverlap {
        /// One facet.
        first: FacetId,
        /// The other.
        second: FacetId,
        /// Plan area of the overlap, m^2.
        area_m2: f64,
    },
    /// Facets and buildings do not refer to each other, or a roof face is missing or doubled.
    Membership {
        /// The building.
        building: BuildingId,
    },
    /// An edge of a solid is not run through exactly once each way.
    SolidNotClosed {
        /// The building.
        building: BuildingId,
        /// Start of the edge, metres.
        from: Point3<f64>,
        /// End of the edge, metres.
        to: Point3<f64>,
    },
    /// The faces around a corner form more than one fan.
    CornerNotManifold {
        /// The building.
        building: BuildingId,
        /// The corner, metres.
        at: Point3<f64>,
    },
    /// A ring of a face has fewer than three corners, touches or crosses itself, or refers to no
    /// corner.
    FaceRingNotSimple {
        /// The building.
        building: BuildingId,
        /// Index of the face.
        face: usize,
    },
    /// A face of a solid is not planar.
    FaceNotPlanar {
        /// The building.
        building: BuildingId,
        /// Index of the face.
        face: usize,
        /// Largest distance of a corner from the face's plane, metres.
        distance_m: f64,
    },
    /// A roof face does not look up, a ground face or a ceiling not down, or a wall is not
    /// vertical.
    FaceDirection {
        /// The building.
        building: BuildingId,
        /// Index of the face.
        face: usize,
    },
    /// The solid's faces look inwards: its volume is not positive.
    InsideOut {
        /// The building.
        building: BuildingId,
        /// Signed volume, m^3.
        volume_m3: f64,
    },
    /// Two walls cross in plan where they have common heights.
    WallsCross {
        /// The building.
        building: BuildingId,
        /// One face.
        first: usize,
        /// The other.
        second: usize,
    },
}

/// All broken invariants of a model; empty for a good one.
pub fn check_invariants(model: &RoofModel) -> Vec<Violation> {
    let mut found = Vec::new();
    for (i, facet) in model.facets.iter().enumerate() {
        check_facet(FacetId::from_index(i), facet, &mut found);
    }
    check_overlaps(&model.facets, &mut found);
    for i in 0..model.buildings.len() {
        check_building(BuildingId::from_index(i), model, &mut found);
    }
    found
}

impl Solid {
    /// Volume, m^3: positive when the faces look outwards.
    pub fn volume(&self) -> f64 {
        // Divergence theorem: a third of the sum of (face centroid . vector area), about a near
        // origin.
        let Some(origin) = self.vertices.first() else {
            return 0.0;
        };
        self.faces
            .iter()
            .map(|face| {
                let area = self.vector_area(&face.rings);
                let corner = self.vertices[face.rings[0][0] as usize] - origin;
                area.dot(&corner) / 3.0
            })
            .sum()
    }

    /// Vector area of a face, m^2: its length is the area, its direction the outward normal.
    pub fn vector_area(&self, rings: &[Vec<u32>]) -> Vector3<f64> {
        let corner = |&v: &u32| self.vertices[v as usize];
        (rings.iter())
            .map(|ring| vector_area(ring.iter().map(corner)))
            .sum()
    }
}

fn check_facet(id: FacetId, facet: &Facet, found: &mut Vec<Violation>) {
    let corners = || facet.outer.iter().chain(facet.holes.iter().flatten());
    let finite = corners().all(|p| p.coords.iter().all(|c| c.is_finite()));
    let plane = &facet.plane;
    let is_unit = (plane.normal.norm() - 1.0).abs() < 1e-9;
    if !(finite && is_unit && plane.normal.z > 0.0) {
        found.push(Violation::FacetPlane { facet: id });
        return;
    }
    let distance_m = corners().fold(0.0f64, |d, p| d.max(plane.signed_distance(p).abs()));
    if distance_m > FACET_PLANAR_M {
        found.push(Violation::FacetNotPlanar {
            facet: id,
            distance_m,
        });
    }
    for (ring, plan) in facet.plan().rings.into_iter().enumerate() {
        if !is_simple(&plan) {
            found.push(Violation::FacetRingNotSimple { facet: id, ring });
        } else if (signed_area(plan) > 0.0) != (ring == 0) {
            found.push(Violation::FacetRingOrientation { facet: id, ring });
        }
    }
}

fn check_overlaps(facets: &[Facet], found: &mut Vec<Violation>) {
    let plans: Vec<Polygon> = facets.iter().map(Facet::plan).collect();
    let boxes: Vec<[Point2<f64>; 2]> = facets.iter().map(Facet::plan_bounds).collect();
    let boxes_meet = |i: usize, j: usize| {
        let ([a, b], [c, d]) = (boxes[i], boxes[j]);
        (0..2).all(|axis| a[axis] < d[axis] && c[axis] < b[axis])
    };
    for j in 0..facets.len() {
        for i in (0..j).filter(|&i| boxes_meet(i, j)) {
            let common = plans[i].and(&plans[j]);
            let area_m2 = common.signed_area();
            // A sliver of width w and length l has the area w l and the outline 2 l.
            if area_m2 > OVERLAP_WIDTH_M * common.perimeter() / 2.0 {
                found.push(Violation::FacetsOverlap {
                    first: FacetId::from_index(i),
                    second: FacetId::from_index(j),
                    area_m2,
                });
            }
        }
    }
}

fn check_building(id: BuildingId, model: &RoofModel, found: &mut Vec<Violation>) {
    let building = &model.buildings[id.index()];
    let solid = &building.solid;
    let mut roofs: Vec<FacetId> = solid
        .faces
        .iter()
        .filter_map(|face| match face.surface {
            Surface::Roof(facet) => Some(facet),
            _ => None,
        })
        .collect();
    let known = building.facets.iter().all(|f| {
        model
            .facets
            .get(f.index())
            .is_some_and(|facet| facet.building == id)
    });
    let mut own = building.facets.clone();
    own.sort();
    own.dedup();
    roofs.sort();
    if !known || own != roofs {
        found.push(Violation::Membership { building: id });
    }
    let all_rings = solid.faces.iter().flat_map(|f| &f.rings);
    let in_range = all_rings
        .flatten()
        .all(|&v| (v as usize) < solid.vertices.len());
    let finite = solid
        .vertices
        .iter()
        .all(|p| p.coords.iter().all(|c| c.is_finite()));
    if !in_range || !finite {
        found.push(Violation::FaceRingNotSimple {
            building: id,
            face: 0,
        });
        return;
    }
    for face in 0..solid.faces.len() {
        check_face(id, solid, face, found);
    }
    check_closed(id, solid, found);
    check_wall_crossings(id, solid, found);
    let volume_m3 = solid.volume();
    if volume_m3 <= 0.0 {
        found.push(Violation::InsideOut {
            building: id,
            volume_m3,
        });
    }
}

fn check_face(building: BuildingId, solid: &Solid, face: usize, found: &mut Vec<Violation>) {
    let SolidFace { surface, rings } = &solid.faces[face];
    let area = solid.vector_area(rings);
    let normal = area.normalize();
    let points = |ring: &Vec<u32>| -> Vec<Point3<f64>> {
        ring.iter().map(|&v| solid.vertices[v as usize]).collect()
    };
    let all: Vec<_> = rings.iter().flat_map(points).collect();
    let Some(first) = all.first().filter(|_| area.norm() > 0.0) else {
        found.push(Violation::FaceRingNotSimple { building, face });
        return;
    };
    let heights: Vec<f64> = all.iter().map(|p| normal.dot(&(p - first))).collect();
    let (low, high) = heights
        .iter()
        .fold((0.0f64, 0.0f64), |(l, h), &x| (l.min(x), h.max(x)));
    if high - low > 2.0 * PLANAR_M {
        let distance_m = (high - low) / 2.0;
        found.push(Violation::FaceNotPlanar {
            building,
            face,
            distance_m,
        });
    }
    let directed = match surface {
        Surface::Roof(_) => normal.z > 1e-3,
        Surface::Wall => normal.z.abs() < 1e-3,
        Surface::Ceiling => normal.z < -1e-3,
        // Level, or on a slope.
        Surface::Ground => normal.z < -0.9,
    };
    if !directed {
        found.push(Violation::FaceDirection { building, face });
    }
    // Dropping the normal's largest component keeps the ring's topology.
    let drop = normal.abs().imax();
    let flat = |p: &Point3<f64>| Point2::new(p[(drop + 1) % 3], p[(drop + 2) % 3]);
    let simple = rings
        .iter()
        .all(|ring| is_simple(&points(ring).iter().map(flat).collect::<Vec<_>>()));
    if !simple {
        found.push(Violation::FaceRingNotSimple { building, face });
    }
}

fn check_closed(building: BuildingId, solid: &Solid, found: &mut Vec<Violation>) {
    let mut count: BTreeMap<(u32, u32), (usize, usize)> = BTreeMap::new();
    // For every corner: from the corner before it in a ring to the corner after it.
    let mut fans: BTreeMap<u32, BTreeMap<u32, u32>> = BTreeMap::new();
    for ring in solid.faces.iter().flat_map(|f| &f.rings) {
        for i in 0..ring.len() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            let c = ring[(i + 2) % ring.len()];
            let uses = count.entry((a.min(b), a.max(b))).or_default();
            if a < b {
                uses.0 += 1;
            } else {
                uses.1 += 1;
            }
            fans.entry(b).or_default().insert(a, c);
        }
    }
    let open = count.iter().filter(|(_, uses)| **uses != (1, 1));
    let before = found.len();
    found.extend(open.map(|(&(a, b), _)| Violation::SolidNotClosed {
        building,
        from: solid.vertices[a as usize],
        to: solid.vertices[b as usize],
    }));
    if found.len() > before {
        return;
    }
    for (corner, fan) in fans {
        let start = *fan
            .keys()
            .next()
            .expect("a corner of a ring has neighbours");
        let (mut at, mut steps) = (start, 0);
        loop {
            at = fan[&at];
            steps += 1;
            if at == start || steps > fan.len() {
                break;
            }
        }
        if steps != fan.len() {
            found.push(Violation::CornerNotManifold {
                building,
                at: solid.vertices[corner as usize],
            });
        }
    }
}

fn check_wall_crossings(building: BuildingId, solid: &Solid, found: &mut Vec<Violation>) {
    let walls: Vec<(usize, Vec<Point3<f64>>)> = solid
        .faces
        .iter()
        .enumerate()
        .filter(|(_, face)| face.surface == Surface::Wall)
        .map(|(i, face)| {
            let ring = face.rings[0]
                .iter()
                .map(|&v| solid.vertices[v as usize])
                .collect();
            (i, ring)
        })
        .collect();
    for (n, (second, b)) in walls.iter().enumerate() {
        for (first, a) in &walls[..n] {
            let range = |w: &[Point3<f64>]| {
                w.iter()
                    .fold((f64::MAX, f64::MIN), |(l, h), p| (l.min(p.z), h.max(p.z)))
            };
            let ((la, ha), (lb, hb)) = (range(a), range(b));
            let (pa, pb) = (plan_extent(a), plan_extent(b));
            if la < hb
                && lb < ha
                && properly_cross(pa.0, pa.1, pb.0, pb.1)
                && meet_where_they_cross(a, b)
            {
                let (first, second) = (*first, *second);
                found.push(Violation::WallsCross {
                    building,
                    first,
                    second,
                });
            }
        }
    }
}

/// Do two walls that cross in plan have a height in common there? One may pass over the other, or
/// through a notch of it.
fn meet_where_they_cross(a: &[Point3<f64>], b: &[Point3<f64>]) -> bool {
    let (pa, pb) = (plan_extent(a), plan_extent(b));
    let (u, v) = (pa.1 - pa.0, pb.1 - pb.0);
    let t = (pb.0 - pa.0).perp(&v) / u.perp(&v);
    let at = pa.0 + u * t;
    // Beside the place, on both sides, for a wall may end there.
    let beside = [-2.0 * WELD_M, 2.0 * WELD_M];
    let sections = [(a, u), (b, v)].map(|(wall, along)| {
        let along = along.normalize();
        beside.map(|aside| section(wall, &(at + along * aside), &along))
    });
    let [first, second, third, fourth] = [0, 1, 2, 3].map(|i| &sections[i / 2][i % 2]);
    let common = in_both(&in_both(first, second), &in_both(third, fourth));
    common.iter().any(|[low, high]| high - low > PLANAR_M)
}

/// The heights of a wall at a place along it, from each to each.
fn section(wall: &[Point3<f64>], at: &Point2<f64>, along: &Vector2<f64>) -> Vec<[f64; 2]> {
    let s = |p: &Point3<f64>| along.dot(&(p.xy() - at));
    let mut heights: Vec<f64> = sides(wall)
        .map(|[p, q]| (p, q, s(&p), s(&q)))
        .filter(|(.., sp, sq)| (*sp < 0.0) != (*sq < 0.0))
        .map(|(p, q, sp, sq)| p.z + (q.z - p.z) * sp / (sp - sq))
        .collect();
    heights.sort_by(f64::total_cmp);
    heights.chunks_exact(2).map(|z| [z[0], z[1]]).collect()
}

/// What two lists of stretches have in common.
fn in_both(a: &[[f64; 2]], b: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let pairs = a.iter().flat_map(|x| b.iter().map(move |y| (x, y)));
    pairs
        .map(|(x, y)| [larger(x[0], y[0]), smaller(x[1], y[1])])
        .filter(|[low, high]| low < high)
        .collect()
}

/// The two ends of a wall in plan.
fn plan_extent(wall: &[Point3<f64>]) -> (Point2<f64>, Point2<f64>) {
    let far = |from: Point2<f64>| {
        wall.iter()
            .map(|p| p.xy())
            .max_by(|p, q| (p - from).norm().total_cmp(&(q - from).norm()))
            .expect("a wall has corners")
    };
    let start = far(wall[0].xy());
    (start, far(start))
}

/// Does a ring of at least three corners neither touch nor cross itself?
pub(crate) fn is_simple(ring: &[Point2<f64>]) -> bool {
    let n = ring.len();
    let distinct = (0..n).all(|i| (0..i).all(|j| (ring[i] - ring[j]).norm() > WELD_M / 100.0));
    let edges: Vec<[Point2<f64>; 2]> = sides(ring).collect();
    let cross = |&[a, b]: &[Point2<f64>; 2], &[c, d]: &[Point2<f64>; 2]| properly_cross(a, b, c, d);
    let crosses = (0..n).any(|i| edges[..i].iter().any(|edge| cross(&edges[i], edge)));
    n >= 3 && distinct && !crosses && signed_area(ring.iter().copied()) != 0.0
}

/// Do two segments cross in their insides, by more than rounding?
fn properly_cross(a: Point2<f64>, b: Point2<f64>, c: Point2<f64>, d: Point2<f64>) -> bool {
    // Distances of the ends of one segment from the line of the other.
    let side = |p: Point2<f64>, q: Point2<f64>, r: Point2<f64>| {
        let distance = (q - p).perp(&(r - p)) / (q - p).norm();
        if distance.abs() < WELD_M {
            0.0
        } else {
            distance
        }
    };
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}
