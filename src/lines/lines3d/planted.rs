//! A planted scene for the tests: a flat roof 6 m above textured ground, seen from two strips flown
//! in opposite directions, with the segments that a detector would give.

use std::sync::OnceLock;

use nalgebra::{Matrix2, Matrix3, Point2, Point3, Vector3};

use crate::base::geometry::{Segment2, Segment3, rotation_from_axis_angle};
use crate::lines::lines2d::{ImageSegment, SegmentKind};
use crate::orienting::scene::{Scene, View};
use crate::photographs::camera::Camera;
use crate::photographs::raster::Gray;

/// Height of the roof, metres; the ground is at zero.
pub(crate) const ROOF_Z: f64 = 6.0;
/// Half the roof in x and y, metres.
const HALF: [f64; 2] = [7.0, 5.0];
/// Descent of the gable's slopes: 40 degrees.
const SLOPE: f64 = 0.839;
const SIZE: u32 = 300;

/// A camera 300 m up with pixels of 0.1 m, cropped about the world's origin.
fn camera(x: f64, y: f64, kappa: f64) -> Camera {
    let down = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    let r = rotation_from_axis_angle(&Vector3::new(0.0, 0.0, kappa)).matrix() * down;
    let center = Point3::new(x, y, 300.0);
    let f = 3000.0;
    let towards = r * (Point3::origin() - center);
    let half = f64::from(SIZE) / 2.0;
    let k = Matrix3::new(
        f,
        0.0,
        half - f * towards.x / towards.z,
        0.0,
        f,
        half - f * towards.y / towards.z,
        0.0,
        0.0,
        1.0,
    );
    Camera {
        k,
        r,
        center,
        width: SIZE,
        height: SIZE,
    }
}

/// Value noise with cells of 0.3 m, 0 to 1.
fn texture(x: f64, y: f64) -> f64 {
    let (u, v) = (x / 0.3 + 1000.0, y / 0.3 + 1000.0);
    let (i, j) = (u.floor(), v.floor());
    let value = |di: f64, dj: f64| {
        let mut h = ((i + di) as u64)
            .wrapping_mul(0x9E37_79B9_7F4A_7C15)
            .wrapping_add(((j + dj) as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F));
        h = (h ^ (h >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        ((h >> 33) & 0xFFFF) as f64 / 65535.0
    };
    let (a, b) = (u - i, v - j);
    let top = value(0.0, 0.0) * (1.0 - a) + value(1.0, 0.0) * a;
    let low = value(0.0, 1.0) * (1.0 - a) + value(1.0, 1.0) * a;
    top * (1.0 - b) + low * b
}

/// The roof above the ground.
#[derive(Clone, Copy)]
enum Cover {
    /// A flat roof, [`edges`].
    Flat,
    /// Two slopes down from [`ridge`].
    Gable,
}

impl Cover {
    /// The grey value of the roof that a ray meets; `None` where it passes.
    fn seen(self, camera: &Camera, x: &Point2<f64>) -> Option<f64> {
        let inside = |p: &Point3<f64>| p.x.abs() <= HALF[0] && p.y.abs() <= HALF[1];
        if matches!(self, Self::Gable) {
            let ray = camera.ray(x);
            let slope = |sign: f64| {
                // z + sign SLOPE x = ROOF_Z
                let c = &camera.center;
                let t = (ROOF_Z - c.z - sign * SLOPE * c.x) / (ray.z + sign * SLOPE * ray.x);
                Some(c + ray * t).filter(|p| p.x * sign >= 0.0 && inside(p))
            };
            let (p, level) = slope(1.0)
                .map(|p| (p, 0.45))
                .or(slope(-1.0).map(|p| (p, 0.4)))?;
            return Some(level + 0.3 * texture(p.x, p.y));
        }
        let p = camera.at_height(x, ROOF_Z).filter(inside)?;
        Some(0.6 + 0.3 * texture(p.x, p.y))
    }
}

/// Rendered with four by four samples a pixel, so that edges lie between pixels.
fn render(camera: &Camera, roof: Cover) -> Gray {
    let seen = |x: &Point2<f64>| {
        roof.seen(camera, x).unwrap_or_else(|| {
            let ground = camera.at_height(x, 0.0).unwrap();
            0.2 + 0.3 * texture(ground.x + 50.0, ground.y)
        })
    };
    Gray::from_fn(SIZE as usize, SIZE as usize, |c, r| {
        let samples = (0..16).map(|i| {
            let (u, v) = ((i % 4) as f64 + 0.5, (i / 4) as f64 + 0.5);
            seen(&Point2::new(c as f64 + u / 4.0, r as f64 + v / 4.0))
        });
        (samples.sum::<f64>() / 16.0) as f32
    })
}

/// Position (x, y) and kappa of the photographs: views 0, 1 and 4 of one strip, 2 and 3 of another
/// one flown in the opposite direction.
const POSITIONS: [(f64, f64, f64); 5] = [
    (-40.0, -45.0, 0.0),
    (40.0, -40.0, 0.02),
    (42.0, 45.0, 3.12),
    (-38.0, 40.0, 3.15),
    (0.0, -42.0, 0.01),
];

/// The flat roof, rendered once for all tests.
pub(crate) fn scene() -> Scene {
    static FLAT: OnceLock<Scene> = OnceLock::new();
    let rendered = || scene_of(&POSITIONS, |camera| render(camera, Cover::Flat));
    FLAT.get_or_init(rendered).clone()
}

/// A gable roof with baselines three times as long: views 0 and 1 of one strip, 2 of another one
/// flown in the opposite direction.
pub(crate) fn gable() -> Scene {
    let places = [
        (-120.0, -20.0, 0.0),
        (120.0, 20.0, 0.01),
        (110.0, 50.0, 3.13),
    ];
    scene_of(&places, |camera| render(camera, Cover::Gable))
}

/// The views of [`scene`] with black photographs.
pub(crate) fn scene_without_photographs() -> Scene {
    views_from(&POSITIONS)
}

/// Black photographs from these positions.
pub(crate) fn views_from(places: &[(f64, f64, f64)]) -> Scene {
    scene_of(places, |_| Gray::new(SIZE as usize, SIZE as usize))
}

/// The ridge of the gable, the brighter slope to its right as seen from above.
pub(crate) fn ridge() -> Segment3 {
    let [start, end] = [-HALF[1], HALF[1]].map(|y| Point3::new(0.0, y, ROOF_Z));
    Segment3::new(start, end)
}

fn scene_of(places: &[(f64, f64, f64)], photograph: impl Fn(&Camera) -> Gray) -> Scene {
    let views = places
        .iter()
        .enumerate()
        .map(|(i, (x, y, kappa))| {
            let camera = camera(*x, *y, *kappa);
            let (gray, rgb) = (photograph(&camera), image::RgbImage::new(SIZE, SIZE));
            View::new(format!("{i}.png"), camera, gray, rgb)
        })
        .collect();
    Scene {
        views,
        ..Scene::default()
    }
}

/// The four edges of the roof, the roof to their right as seen from above.
pub(crate) fn edges() -> [Segment3; 4] {
    let [x, y] = HALF;
    let corners = [(-x, -y), (-x, y), (x, y), (x, -y)].map(|(x, y)| Point3::new(x, y, ROOF_Z));
    [0, 1, 2, 3].map(|i| Segment3::new(corners[i], corners[(i + 1) % 4]))
}

/// A detected segment, a twentieth of a pixel off.
pub(crate) fn detected(segment: Segment2, index: usize) -> ImageSegment {
    let off = segment.normal() * if index.is_multiple_of(2) { 0.05 } else { -0.05 };
    let segment = Segment2::new(segment.p0 + off, segment.p1 + off);
    let length = segment.length();
    ImageSegment {
        kind: SegmentKind::Edge,
        segment,
        contrast: 0.4,
        edgels: length as u32,
        covariance: Matrix2::new(0.0025, 0.0, 0.0, 0.01 / (length * length)),
    }
}

/// The part `from` to `to` of an edge in a view.
pub(crate) fn part_of(scene: &Scene, view: usize, edge: usize, from: f64, to: f64) -> Segment2 {
    let camera = &scene.views[view].camera;
    let at = |t| camera.project(&edges()[edge].at(t)).unwrap();
    Segment2::new(at(from), at(to))
}

/// The segments of a detector: each view's four edges in order, then distractors. In view 1 edge 0
/// is broken in two, in view 2 it lacks its last third.
pub(crate) fn segments(scene: &Scene) -> Vec<Vec<ImageSegment>> {
    (0..scene.views.len())
        .map(|view| {
            let mut found = Vec::new();
            for edge in 0..4 {
                let (from, to) = match (view, edge) {
                    (1, 0) => (0.02, 0.4),
                    (2, 0) => (0.02, 0.66),
                    _ => (0.02, 0.98),
                };
                found.push(detected(part_of(scene, view, edge, from, to), view + edge));
            }
            if view == 1 {
                found.push(detected(part_of(scene, view, 0, 0.6, 0.98), 1));
            }
            for i in 0..6 {
                let (i, v) = (f64::from(i), view as f64);
                let p = Point2::new(20.0 + 45.0 * i, 15.0 + 20.0 * v + 4.0 * i);
                let q = p + nalgebra::Vector2::new(25.0 - 8.0 * i, 20.0 + 7.0 * v);
                found.push(detected(Segment2::new(p, q), view));
            }
            found
        })
        .collect()
}
