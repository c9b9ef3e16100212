//! The houses: roof facets over shared corners, walls below them, and the ground.

use nalgebra::{Point3, Vector3};

use super::render::RenderedFace;
use super::texture::SurfaceTexture;
use super::truth::SyntheticTruth;
use crate::base::geometry::{Segment3, sides};
use crate::base::math;

/// A house on its ground, ready to render, and what a reconstruction should find.
#[derive(Debug)]
pub(crate) struct SyntheticBuilding {
    pub faces: Vec<RenderedFace>,
    pub truth: SyntheticTruth,
}

/// Position of a house.
#[derive(Clone, Copy, Debug)]
struct Placement {
    center: [f64; 2],
    /// Azimuth of the main wing, degrees.
    azimuth_deg: f64,
    eave_z: f64,
    /// How far the roof projects beyond the walls, metres.
    overhang: f64,
}

/// At the origin, parallel to no baseline.
const HOME: Placement = Placement {
    center: [0.0, 0.0],
    azimuth_deg: 26.0,
    eave_z: EAVE_Z,
    overhang: OVERHANG,
};

/// Height of the ground, metres: not zero, so that no code may assume it.
const GROUND_Z: f64 = 1.5;
const EAVE_Z: f64 = 6.0;
/// Walls on a slope begin so far below the ground in the middle, metres.
const DEEPEST_WALL_M: f64 = 4.0;
/// How far the roof projects beyond the walls, metres.
const OVERHANG: f64 = 0.6;
/// Tangent of the roof slope (about 37 degrees).
const SLOPE: f64 = 0.75;

/// Gable roof of 14 m by 9 m in plan.
pub(crate) fn gable() -> SyntheticBuilding {
    gable_at(HOME, [7.0, 4.5], 0.0, 1)
}

/// The gable roof whose walls stand so far inside its eaves and gables, metres.
pub(crate) fn gable_with_overhang(overhang: f64) -> SyntheticBuilding {
    let place = Placement { overhang, ..HOME };
    gable_at(place, [7.0, 4.5], 0.0, 1)
}

/// The gable roof on ground that rises to the east by `slope`, and is at its usual height in the
/// middle.
pub(crate) fn gable_on_slope(slope: f64) -> SyntheticBuilding {
    let mut house = gable();
    let tilted = |p: &Point3<f64>| Point3::new(p.x, p.y, p.z + slope * p.x);
    let sunk = |p: &Point3<f64>| match p.z == GROUND_Z {
        true => Point3::new(p.x, p.y, p.z - DEEPEST_WALL_M),
        false => *p,
    };
    let walls = house.faces.len() - house.truth.facets.len();
    for (i, face) in house.faces[..walls].iter_mut().enumerate() {
        let corners: Vec<Point3<f64>> = match i {
            0 => face.corners.iter().map(tilted).collect(),
            _ => face.corners.iter().map(sunk).collect(),
        };
        *face = RenderedFace::new(&corners, face.surface);
    }
    house
}

/// Two gable roofs in line, 3 m apart: planes with a gap.
pub(crate) fn row() -> SyntheticBuilding {
    let beside = |u: f64| Placement {
        center: rotated(HOME.azimuth_deg, [u, 0.0]),
        ..HOME
    };
    let half = [3.5, 4.0];
    join(
        gable_at(beside(-5.0), half, 0.0, 1),
        gable_at(beside(5.0), half, 0.0, 3),
    )
}

/// Two gable roofs whose azimuths differ by 37 degrees.
pub(crate) fn askew() -> SyntheticBuilding {
    let place = |center, azimuth_deg| Placement {
        center,
        azimuth_deg,
        ..HOME
    };
    join(
        gable_at(place([-5.5, -5.0], 26.0), [4.5, 3.0], 0.0, 1),
        gable_at(place([6.0, 5.0], 63.0), [4.5, 3.2], 0.0, 3),
    )
}

/// The gable roof, and 29 m south-east of it a shed of 3.6 m by 2.8 m whose eaves are 2 m above the
/// ground.
pub(crate) fn gable_and_shed() -> SyntheticBuilding {
    let place = Placement {
        center: [29.0, -5.5],
        eave_z: GROUND_Z + 2.0,
        overhang: 0.1,
        ..HOME
    };
    join(gable(), gable_at(place, [1.8, 1.4], 0.0, 5))
}

/// A gable roof whose ends are not square: parallelograms.
pub(crate) fn sheared() -> SyntheticBuilding {
    gable_at(HOME, [6.0, 4.5], 0.4, 1)
}

/// A gable roof whose ends are 3 degrees off square.
pub(crate) fn skewed() -> SyntheticBuilding {
    gable_at(HOME, [6.0, 4.5], 0.0524, 1)
}

/// A low gable roof close to a tower, which hides some of it from one strip.
pub(crate) fn tower_and_annex() -> SyntheticBuilding {
    let beside = |v: f64, eave_z| Placement {
        center: rotated(0.0, [0.0, v]),
        azimuth_deg: 0.0,
        eave_z,
        ..HOME
    };
    join(
        gable_at(beside(4.0, 14.0), [5.0, 3.0], 0.0, 1),
        gable_at(beside(-3.4, 5.0), [5.0, 3.0], 0.0, 3),
    )
}

/// Hip roof of 14 m by 9 m in plan.
pub(crate) fn hip() -> SyntheticBuilding {
    let (a, b) = (7.0, 4.5);
    let ridge = EAVE_Z + SLOPE * b;
    let corners = [
        [-a, -b, EAVE_Z],
        [a, -b, EAVE_Z],
        [a, b, EAVE_Z],
        [-a, b, EAVE_Z],
        [a - b, 0.0, ridge],
        [-a + b, 0.0, ridge],
    ];
    let facets: [(&[usize], SurfaceTexture); 4] = [
        (&[0, 1, 4, 5], surface([0.62, 0.33, 0.25], 0.15, 1)),
        (&[2, 3, 5, 4], surface([0.55, 0.34, 0.28], 0.22, 2)),
        (&[1, 2, 4], surface([0.60, 0.36, 0.25], 0.20, 3)),
        (&[3, 0, 5], surface([0.52, 0.30, 0.26], 0.18, 4)),
    ];
    let (x, y) = (a - OVERHANG, b - OVERHANG);
    let footprint = [[-x, -y], [x, -y], [x, y], [-x, y]].map(|p| (p, false));
    build(HOME, &corners, &facets, &footprint, ridge)
}

/// Gable roof of given half length and half width; its ends are shifted along the eaves by `shear`
/// for every metre across.
fn gable_at(place: Placement, [a, b]: [f64; 2], shear: f64, seed: u32) -> SyntheticBuilding {
    let (eave, ridge) = (place.eave_z, place.eave_z + SLOPE * b);
    let at = |x: f64, y: f64| [x + shear * y, y];
    let raised = |x: f64, y: f64, z: f64| [x + shear * y, y, z];
    let corners = [
        raised(-a, -b, eave),
        raised(a, -b, eave),
        raised(a, 0.0, ridge),
        raised(-a, 0.0, ridge),
        raised(a, b, eave),
        raised(-a, b, eave),
    ];
    let facets: [(&[usize], SurfaceTexture); 2] = [
        (&[0, 1, 2, 3], surface([0.62, 0.33, 0.25], 0.10, seed)),
        (&[3, 2, 4, 5], surface([0.55, 0.34, 0.28], 0.22, seed + 1)),
    ];
    let (x, y) = (a - place.overhang, b - place.overhang);
    let footprint = [
        (at(-x, -y), false),
        (at(x, -y), true),
        (at(x, y), false),
        (at(-x, y), true),
    ];
    build(place, &corners, &facets, &footprint, ridge)
}

/// Both houses on one ground.
fn join(mut a: SyntheticBuilding, b: SyntheticBuilding) -> SyntheticBuilding {
    // The first face of either is the ground.
    a.faces.extend(b.faces.into_iter().skip(1));
    a.truth.edges.extend(b.truth.edges);
    a.truth.facets.extend(b.truth.facets);
    a
}

/// Main wing of 15 m by 8 m with a hipped west and a gabled east end; side wing of 6 m width to the
/// north with a gable. Equal slopes and eaves, so that its ridge is lower and meets the main slope.
pub(crate) fn l_shape() -> SyntheticBuilding {
    let (a, b, c, w, n) = (7.5, 4.0, 2.5, 3.0, 9.0);
    let (ridge, side_ridge) = (EAVE_Z + SLOPE * b, EAVE_Z + SLOPE * w);
    // The main wing lies south of the origin, so that the whole house is centred.
    let south = |y: f64| y - 2.5;
    let corners = [
        [-a, south(-b), EAVE_Z],
        [a, south(-b), EAVE_Z],
        [a, south(0.0), ridge],
        [-a + b, south(0.0), ridge],
        [a, south(b), EAVE_Z],
        [c + w, south(b), EAVE_Z],
        [c, south(b - w), side_ridge],
        [c - w, south(b), EAVE_Z],
        [-a, south(b), EAVE_Z],
        [c + w, south(n), EAVE_Z],
        [c, south(n), side_ridge],
        [c - w, south(n), EAVE_Z],
    ];
    let facets: [(&[usize], SurfaceTexture); 5] = [
        (&[0, 1, 2, 3], surface([0.46, 0.42, 0.40], 0.18, 3)),
        (&[3, 2, 4, 5, 6, 7, 8], surface([0.47, 0.40, 0.38], 0.14, 4)),
        (&[8, 0, 3], surface([0.45, 0.41, 0.41], 0.06, 5)),
        (&[5, 9, 10, 6], surface([0.58, 0.36, 0.30], 0.10, 6)),
        (&[6, 10, 11, 7], surface([0.56, 0.37, 0.31], 0.20, 7)),
    ];
    let o = OVERHANG;
    let footprint = [
        ([-a + o, south(-b + o)], false),
        ([a - o, south(-b + o)], true),
        ([a - o, south(b - o)], false),
        ([c + w - o, south(b - o)], false),
        ([c + w - o, south(n - o)], true),
        ([c - w + o, south(n - o)], false),
        ([c - w + o, south(b - o)], false),
        ([-a + o, south(b - o)], false),
    ];
    build(HOME, &corners, &facets, &footprint, ridge)
}

fn surface(rgb: [f64; 3], contrast: f64, seed: u32) -> SurfaceTexture {
    SurfaceTexture {
        rgb,
        contrast,
        seed,
    }
}

/// Faces and truth from roof corners (before turning by the azimuth), facets over them, and a
/// footprint whose flagged sides end in a gable.
fn build(
    place: Placement,
    corners: &[[f64; 3]],
    facets: &[(&[usize], SurfaceTexture)],
    footprint: &[([f64; 2], bool)],
    ridge: f64,
) -> SyntheticBuilding {
    let corners: Vec<Point3<f64>> = corners.iter().map(|&p| place.world(p)).collect();
    let mut faces = vec![ground()];
    faces.extend(walls(place, footprint, ridge));
    let first_roof = faces.len();
    faces.extend(facets.iter().map(|(ring, surface)| {
        let ring: Vec<Point3<f64>> = ring.iter().map(|&i| corners[i]).collect();
        RenderedFace::new(&ring, *surface)
    }));
    let truth = SyntheticTruth {
        edges: edges(&corners, facets),
        facets: faces[first_roof..]
            .iter()
            .map(|f| (f.plane, f.corners.clone()))
            .collect(),
        ground_z: GROUND_Z,
    };
    SyntheticBuilding { faces, truth }
}

impl Placement {
    /// A point of the house in the world.
    fn world(&self, [x, y, z]: [f64; 3]) -> Point3<f64> {
        let [x, y] = rotated(self.azimuth_deg, [x, y]);
        Point3::new(self.center[0] + x, self.center[1] + y, z)
    }
}

/// Rotated by an azimuth.
fn rotated(azimuth_deg: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let (s, c) = math::sin_cos(azimuth_deg.to_radians());
    [c * x - s * y, s * x + c * y]
}

/// The sides of all facets, each once.
fn edges(corners: &[Point3<f64>], facets: &[(&[usize], SurfaceTexture)]) -> Vec<Segment3> {
    let mut sides: Vec<[usize; 2]> = facets
        .iter()
        .flat_map(|(ring, _)| sides(ring).map(|[p, q]| [p.min(q), p.max(q)]))
        .collect();
    sides.sort();
    sides.dedup();
    sides
        .into_iter()
        .map(|[p, q]| Segment3::new(corners[p], corners[q]))
        .collect()
}

/// Vertical faces over the sides of a counter-clockwise footprint, up to the underside of the roof.
/// Equal slopes make the roof equally high over all footprint corners.
fn walls(place: Placement, footprint: &[([f64; 2], bool)], ridge: f64) -> Vec<RenderedFace> {
    let top = place.eave_z + SLOPE * place.overhang;
    (sides(footprint).enumerate())
        .map(|(i, [([px, py], gabled), ([qx, qy], _)])| {
            let mut ring = vec![
                place.world([px, py, GROUND_Z]),
                place.world([qx, qy, GROUND_Z]),
                place.world([qx, qy, top]),
            ];
            if gabled {
                let half_width = 0.5 * (math::hypot(qx - px, qy - py));
                let apex = (top + SLOPE * half_width).min(ridge);
                ring.push(place.world([0.5 * (px + qx), 0.5 * (py + qy), apex]));
            }
            ring.push(place.world([px, py, top]));
            RenderedFace::new(&ring, surface([0.78, 0.75, 0.66], 0.05, 20 + i as u32))
        })
        .collect()
}

/// A lawn, larger than any crop.
fn ground() -> RenderedFace {
    let r = 200.0;
    let corner = |x, y| Point3::origin() + Vector3::new(x, y, GROUND_Z);
    let ring = [corner(-r, -r), corner(r, -r), corner(r, r), corner(-r, r)];
    RenderedFace::new(&ring, surface([0.30, 0.40, 0.24], 0.25, 40))
}
