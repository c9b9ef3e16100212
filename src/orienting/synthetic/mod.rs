//! Small scenes with known ground truth, rendered quickly, for tests natively and in wasm.
//!
//! A building of textured planar faces lies at the local origin on flat ground; six crops of
//! large frames look down on it from two strips flown in opposite directions, with the numbers
//! of B99's flights (about 1300 m above ground, ground pixel 8.5 cm, principal point far outside
//! the crop).
//!
//! ```text
//! texture       value noise on a face
//! render        rays through nine samples of every pixel
//! building      faces of the houses, and the truth
//! truth         what a reconstruction should find
//! files         the scene as image and orientation files
//! ```
//!
//! Invariant: nothing is random but a hash of integers, so that every target renders the same
//! bytes.

mod building;
mod files;
mod render;
mod texture;
mod truth;

pub use files::{to_colmap, to_files, to_photogrammetric, to_projection};
pub use truth::SyntheticTruth;

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use nalgebra::{Matrix3, Point3, Vector3};

use crate::orienting::orientation::rotation_from_omega_phi_kappa;
use crate::orienting::scene::{Scene, View};
use crate::photographs::camera::Camera;

/// A rectangular house with a gable roof; six views of `size` x `size` pixels. The house fills a
/// crop of 320 pixels.
pub fn gable_scene(size: u32) -> (Scene, SyntheticTruth) {
    scene_of(&building::gable(), size)
}

/// The same house with its walls so far inside the roof's rim, seen from all sides at a slant by
/// twelve views of `size` x `size` pixels, 5 cm on the house each.
pub fn oblique_scene(size: u32, overhang: f64) -> (Scene, SyntheticTruth) {
    scene_seen_by(
        &building::gable_with_overhang(overhang),
        &oblique_cameras(size),
    )
}

/// The same house on ground that rises by `slope` metres a metre to the east; at the origin it is
/// at the height that the truth states.
pub fn slope_scene(size: u32, slope: f64) -> (Scene, SyntheticTruth) {
    scene_of(&building::gable_on_slope(slope), size)
}

/// An L-shaped house: a wing with one hipped and one gabled end, and a gabled side wing of the same
/// slope, so that a hip, a valley and a facet that is not convex occur; six views of `size` x
/// `size` pixels. The house fills a crop of 320 pixels.
pub fn l_scene(size: u32) -> (Scene, SyntheticTruth) {
    scene_of(&building::l_shape(), size)
}

/// Two gable roofs in line, 3 m apart; four facets in two planes with a gap.
pub fn row_scene(size: u32) -> (Scene, SyntheticTruth) {
    scene_of(&building::row(), size)
}

/// Two small gable roofs whose azimuths differ by 37 degrees; 400 pixels show both.
pub fn askew_scene(size: u32) -> (Scene, SyntheticTruth) {
    scene_of(&building::askew(), size)
}

/// The rectangular house, and a low shed 29 m to the south-east; 800 pixels show both.
pub fn shed_scene(size: u32) -> (Scene, SyntheticTruth) {
    scene_of(&building::gable_and_shed(), size)
}

/// A gable roof whose ends are not square: its facets are parallelograms.
pub fn sheared_scene(size: u32) -> (Scene, SyntheticTruth) {
    scene_of(&building::sheared(), size)
}

/// A gable roof whose ends are 3 degrees off square: more than a building's tolerance, and hardly
/// visible.
pub fn skewed_scene(size: u32) -> (Scene, SyntheticTruth) {
    scene_of(&building::skewed(), size)
}

/// A low gable roof beside a tower that hides some of it in every second view.
pub fn tower_scene(size: u32) -> (Scene, SyntheticTruth) {
    scene_of(&building::tower_and_annex(), size)
}

/// A hip roof: two trapezoids and two triangles.
pub fn hip_scene(size: u32) -> (Scene, SyntheticTruth) {
    scene_of(&building::hip(), size)
}

/// The same houses as a drone photographs them: nine views of `size` x `size` pixels with a normal
/// lens (principal point in the middle) in three strips, 45 m above the ground.
pub fn drone_scene(size: u32) -> (Scene, SyntheticTruth) {
    tower_scene_of(&drone_cameras(size))
}

/// The same houses, seen by these cameras.
pub fn tower_scene_of(cameras: &[(String, Camera)]) -> (Scene, SyntheticTruth) {
    scene_seen_by(&building::tower_and_annex(), cameras)
}

fn scene_of(building: &building::SyntheticBuilding, size: u32) -> (Scene, SyntheticTruth) {
    scene_seen_by(building, &strip_cameras(size))
}

/// What was rendered before: few scenes are asked for many times.
static RENDERED: Mutex<BTreeMap<String, (Scene, SyntheticTruth)>> = Mutex::new(BTreeMap::new());

fn scene_seen_by(
    building: &building::SyntheticBuilding,
    cameras: &[(String, Camera)],
) -> (Scene, SyntheticTruth) {
    let all_rendered = || RENDERED.lock().unwrap_or_else(PoisonError::into_inner);
    let key = format!("{building:?}{cameras:?}");
    let before = all_rendered().get(&key).cloned();
    before.unwrap_or_else(|| {
        // Not locked meanwhile: who waits for its rays may take up a task that wants a scene.
        let scene = rendered(building, cameras);
        all_rendered().insert(key, scene.clone());
        scene
    })
}

fn rendered(
    building: &building::SyntheticBuilding,
    cameras: &[(String, Camera)],
) -> (Scene, SyntheticTruth) {
    let views = crate::base::execution::map(cameras, |_, (name, camera)| {
        let rgb = render::render(&building.faces, camera);
        let gray = crate::photographs::raster::Gray::from_rgb(&rgb);
        View::new(name.clone(), camera.clone(), gray, rgb)
    });
    let scene = Scene {
        views,
        ..Scene::default()
    };
    (scene, building.truth.clone())
}

/// Principal distance in pixels: 183.5 mm at 12 micrometres, as in B99's frames.
const FOCAL_PX: f64 = 15294.0;

/// The point that all crops are centred on, at half the height of the roof.
const TARGET: Point3<f64> = Point3::new(0.0, 0.0, 6.0);

/// Projection centre (m) and omega, phi, kappa (degrees) of each frame: strip 1 is flown east,
/// strip 2 west, so that its images are upside down.
#[rustfmt::skip]
const FRAMES: [(&str, [f64; 3], [f64; 3]); 6] = [
    ("s1_01.png", [-301.2, -198.4, 1306.1], [ 0.61, -0.42,   0.31]),
    ("s1_02.png", [   4.7, -203.9, 1302.6], [-0.27,  1.12,  -1.84]),
    ("s1_03.png", [ 296.8, -196.1, 1298.3], [-0.93,  0.56,   0.77]),
    ("s2_01.png", [ 303.5,  201.3, 1304.9], [-0.44,  0.88, 179.12]),
    ("s2_02.png", [  -3.1,  197.2, 1299.5], [ 0.35, -0.67, 181.46]),
    ("s2_03.png", [-298.9,  204.6, 1301.7], [ 0.72,  0.29, 178.55]),
];

/// The six crop cameras.
fn strip_cameras(size: u32) -> Vec<(String, Camera)> {
    FRAMES
        .iter()
        .map(|(name, center, angles_deg)| {
            let [omega, phi, kappa] = angles_deg.map(f64::to_radians);
            let k = Matrix3::new(FOCAL_PX, 0.0, 0.0, 0.0, FOCAL_PX, 0.0, 0.0, 0.0, 1.0);
            let r = rotation_from_omega_phi_kappa(omega, phi, kappa);
            let mut camera = Camera::new(k, r, Point3::from(*center), size, size);
            let target = camera.project(&TARGET).expect("the frames look down");
            // Crops start at whole pixels of the frame: the principal point moves by whole pixels.
            camera.k[(0, 2)] = (f64::from(size) / 2.0 - target.x).round() + 0.25;
            camera.k[(1, 2)] = (f64::from(size) / 2.0 - target.y).round() - 0.25;
            ((*name).to_owned(), camera)
        })
        .collect()
}

/// A drone's cameras: strips 8 m apart flown there and back, photographs 7 m apart, tilted by some
/// degrees.
fn drone_cameras(size: u32) -> Vec<(String, Camera)> {
    let focal = 0.9 * f64::from(size);
    let middle = f64::from(size) / 2.0;
    let k = Matrix3::new(focal, 0.0, middle, 0.0, focal, middle, 0.0, 0.0, 1.0);
    (0..9)
        .map(|i| {
            let (along, strip) = (f64::from(i % 3) - 1.0, f64::from(i / 3) - 1.0);
            // Small numbers that differ from photograph to photograph.
            let vary = |n: i32| f64::from((i * n) % 7 - 3) / 3.0;
            let center = Point3::new(
                7.0 * along + 0.8 * vary(5),
                8.0 * strip + 0.6 * vary(3),
                46.5 + 1.2 * vary(2),
            );
            let kappa = if i / 3 == 1 { 180.0 } else { 0.0 } + 4.0 * vary(4);
            let angles = [
                8.0 * strip + 2.0 * vary(6),
                -8.0 * along + 2.0 * vary(5),
                kappa,
            ];
            let [omega, phi, kappa] = angles.map(f64::to_radians);
            let r = rotation_from_omega_phi_kappa(omega, phi, kappa);
            (format!("d{i}.png"), Camera::new(k, r, center, size, size))
        })
        .collect()
}

/// Cameras around the house that look at it from 35 and 50 degrees off the vertical.
fn oblique_cameras(size: u32) -> Vec<(String, Camera)> {
    let middle = f64::from(size) / 2.0;
    (0..12)
        .map(|i| {
            let off = [35.0f64, 50.0][i % 2].to_radians();
            let azimuth = (30.0 * i as f64 + 7.0).to_radians();
            let (s, c) = crate::base::math::sin_cos(off);
            let (sa, ca) = crate::base::math::sin_cos(azimuth);
            let forward = Vector3::new(-s * ca, -s * sa, -c);
            let right = forward.cross(&Vector3::z()).normalize();
            let down = forward.cross(&right);
            let r = Matrix3::from_rows(&[right, down, forward].map(|v| v.transpose()));
            let k = Matrix3::new(1600.0, 0.0, middle, 0.0, 1600.0, middle, 0.0, 0.0, 1.0);
            let center = TARGET - forward * 80.0;
            let r = nalgebra::Rotation3::from_matrix_unchecked(r);
            (
                format!("o{i:02}.png"),
                Camera::new(k, r, center, size, size),
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::{Segment3, sides, vector_area};
    use nalgebra::Point2;

    #[test]
    fn every_view_shows_the_whole_roof() {
        for (scene, truth) in [gable_scene(320), l_scene(320)] {
            assert_eq!(scene.views.len(), 6);
            for view in &scene.views {
                for corner in truth.facets.iter().flat_map(|(_, ring)| ring) {
                    let p = view.camera.project(corner).unwrap();
                    assert!(view.camera.contains(&p, 4.0), "{} {p}", view.name);
                }
                let ground_pixel = view.camera.ground_pixel(&TARGET);
                assert!((0.08..0.09).contains(&ground_pixel));
            }
        }
    }

    #[test]
    fn facets_are_planar_oriented_and_bounded_by_the_edges() {
        for (truth, facets, edges) in [
            (building::gable().truth, 2, 7),
            (building::l_shape().truth, 5, 16),
        ] {
            assert_eq!((truth.facets.len(), truth.edges.len()), (facets, edges));
            for (plane, ring) in &truth.facets {
                assert!(plane.normal.z > 0.5);
                for ends in sides(ring) {
                    assert!(plane.signed_distance(&ends[0]).abs() < 1e-9);
                    let has_side = |e: &Segment3| ends.iter().all(|p| e.line_distance(p) < 1e-9);
                    assert!(truth.edges.iter().any(has_side));
                }
                let area = vector_area(ring.iter().copied());
                assert!(area.z > 0.0, "counter-clockwise from above");
            }
        }
    }

    #[test]
    fn edges_are_where_the_cameras_put_them() {
        // Across the middle of the ridge the image changes from one facet's shade to the other's.
        let (scene, truth) = gable_scene(320);
        let ridge = truth
            .edges
            .iter()
            .max_by(|a, b| a.p0.z.min(a.p1.z).total_cmp(&b.p0.z.min(b.p1.z)))
            .unwrap();
        for view in &scene.views {
            let (a, b) = (
                view.camera.project(&ridge.p0),
                view.camera.project(&ridge.p1),
            );
            let image = crate::base::geometry::Segment2::new(a.unwrap(), b.unwrap());
            let mean = |offset: f64| {
                let sum: f32 = (1..20)
                    .map(|i| {
                        let p: Point2<f64> =
                            image.at(f64::from(i) / 20.0) + image.normal() * offset;
                        view.gray.sample(p.x as f32, p.y as f32).unwrap()
                    })
                    .sum();
                sum / 19.0
            };
            let step = (mean(1.5) - mean(-1.5)).abs();
            assert!(step > 0.08, "{}: {step}", view.name);
            assert!((mean(4.0) - mean(1.5)).abs() < 0.5 * step, "{}", view.name);
        }
    }

    #[test]
    fn the_bytes_never_change() {
        // Native and wasm builds both run this: the same sum on every target.
        let (scene, _) = gable_scene(64);
        let hash = scene
            .views
            .iter()
            .flat_map(|v| v.rgb.as_raw())
            .fold(0xcbf2_9ce4_8422_2325u64, |h, &b| {
                (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3)
            });
        assert_eq!(hash, 0x625e_4fad_46d0_b39a, "{hash:#x}");
    }
}
