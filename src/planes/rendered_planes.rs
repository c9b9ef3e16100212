//! Rendered views of a few textured planes, for the tests of the sweep.

use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use crate::base::geometry::{Plane, rotation_from_axis_angle};
use crate::orienting::scene::{Scene, View};
use crate::photographs::camera::Camera;
use crate::photographs::raster::Gray;

/// A plane and the part of it (in plan) that exists.
pub(crate) struct TexturedPlane {
    pub plane: Plane,
    pub exists: fn(f64, f64) -> bool,
    /// Amplitude of the texture, 0 to 0.5.
    pub texture: f64,
}

/// A part of a plane with the texture of a roof.
pub(crate) fn textured(plane: Plane, exists: fn(f64, f64) -> bool) -> TexturedPlane {
    TexturedPlane {
        plane,
        exists,
        texture: 0.3,
    }
}

/// Level ground at the height 0.
pub(crate) fn level_ground() -> TexturedPlane {
    let plane = Plane {
        normal: Vector3::z(),
        d: 0.0,
    };
    textured(plane, |_, _| true)
}

/// Height of the top of the roofs of tests, metres, and the descent of their slopes.
pub(crate) const RIDGE_Z: f64 = 6.0;
pub(crate) const PITCH: f64 = 0.7;

/// A slope through a place at the height of the ridge, which falls along this direction in plan.
pub(crate) fn slope_from(top: [f64; 2], falls_along: [f64; 2]) -> Plane {
    let [x, y] = falls_along;
    let top = Point3::new(top[0], top[1], RIDGE_Z);
    Plane::from_point_normal(&top, &Vector3::new(x * PITCH, y * PITCH, 1.0)).unwrap()
}

/// Four views, 250 x 250 px of 0.1 m, in two strips flown in opposite directions.
pub(crate) fn scene(surfaces: &[TexturedPlane]) -> Scene {
    let stations = [
        (-30.0, -12.0, 0.05),
        (28.0, -15.0, -0.1),
        (25.0, 20.0, 3.1),
        (-27.0, 22.0, 3.2),
    ];
    of_cameras(
        stations.map(|(x, y, kappa)| camera(x, y, kappa, &Point3::origin())),
        surfaces,
    )
}

/// Ten views of the same size along x, 10 m apart from -45 m on, each of what lies below it.
pub(crate) fn strip(surfaces: &[TexturedPlane]) -> Scene {
    let below = |i: i32| {
        let x = 10.0 * f64::from(i) - 45.0;
        camera(x, 0.0, 0.0, &Point3::new(x, 0.0, 0.0))
    };
    of_cameras((0..10).map(below), surfaces)
}

fn of_cameras(cameras: impl IntoIterator<Item = Camera>, surfaces: &[TexturedPlane]) -> Scene {
    let view = |(i, camera): (usize, Camera)| {
        let gray = render(&camera, surfaces);
        let rgb = image::RgbImage::new(250, 250);
        View::new(format!("{i}.jpg"), camera, gray, rgb)
    };
    Scene {
        views: cameras.into_iter().enumerate().map(view).collect(),
        ..Scene::default()
    }
}

/// A camera 100 m up whose image is a crop around a point.
fn camera(x: f64, y: f64, kappa: f64, around: &Point3<f64>) -> Camera {
    let down =
        Rotation3::from_matrix_unchecked(Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)));
    let [turn, tilt] = [[0.0, 0.0, kappa], [0.01, -0.02, 0.0]].map(Vector3::from);
    let r = rotation_from_axis_angle(&turn) * rotation_from_axis_angle(&tilt) * down;
    let centre = Point3::new(x, y, 100.0);
    let k = Matrix3::new(1000.0, 0.0, 0.0, 0.0, 1000.0, 0.0, 0.0, 0.0, 1.0);
    let middle = Camera::new(k, r, centre, 250, 250)
        .project(around)
        .expect("it is in front");
    let mut crop = k;
    crop[(0, 2)] = 125.0 - middle.x;
    crop[(1, 2)] = 125.0 - middle.y;
    Camera::new(crop, r, centre, 250, 250)
}

fn render(camera: &Camera, surfaces: &[TexturedPlane]) -> Gray {
    Gray::from_fn(250, 250, |column, row| {
        let image = nalgebra::Point2::new(column as f64 + 0.5, row as f64 + 0.5);
        let ray = camera.ray(&image);
        let hits = surfaces.iter().enumerate().filter_map(|(i, surface)| {
            let t = -surface.plane.signed_distance(&camera.center) / surface.plane.normal.dot(&ray);
            let at = camera.center + ray * t;
            ((surface.exists)(at.x, at.y)).then_some((t, i, at))
        });
        hits.min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(0.5, |(_, i, at)| {
                (0.5 + surfaces[i].texture * noise(at.x, at.y, i)) as f32
            })
    })
}

/// Smooth value noise of 0.4 m wavelength, -1 to 1.
fn noise(x: f64, y: f64, seed: usize) -> f64 {
    let (x, y) = (x / 0.4 + 1000.0, y / 0.4 + 1000.0);
    let (i, j) = (x.floor(), y.floor());
    let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
    let (fx, fy) = (smooth(x - i), smooth(y - j));
    let at = |di: usize, dj: usize| {
        let mut h = ((i as u64 + di as u64) * 73_856_093)
            ^ ((j as u64 + dj as u64) * 19_349_663)
            ^ ((seed as u64 + 1) * 83_492_791);
        h = (h ^ (h >> 13)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        ((h >> 33) % 2001) as f64 / 1000.0 - 1.0
    };
    let top = at(0, 0) + (at(1, 0) - at(0, 0)) * fx;
    let bottom = at(0, 1) + (at(1, 1) - at(0, 1)) * fx;
    top + (bottom - top) * fy
}
