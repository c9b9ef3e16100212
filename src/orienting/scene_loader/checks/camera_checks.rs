//! Can these cameras have taken photographs of one place on the ground?
//!
//! Refused are numbers that are no camera, cameras that look up, cameras below the ground, and
//! fewer than three views of any one place. Whether the pixels agree with the cameras is left to
//! the orientation check.

use nalgebra::{Matrix3, Point2, Point3, Vector3};

use crate::base::error::{Error, listed};
use crate::base::geometry::{bounds, mean_point};
use crate::base::plan_index::PlanIndex;
use crate::orienting::orientation::{EXACT_ROTATION, LARGEST_SCENE_M};
use crate::photographs::camera::{Camera, FEWEST_VIEWS};

/// What the cameras give reason to refuse or to warn of.
#[derive(Default)]
pub(crate) struct CameraChecks {
    pub errors: Vec<Error>,
    pub warnings: Vec<String>,
    /// Least and greatest height of the ground at which three views see the same place, local
    /// frame.
    pub heights: Option<[f64; 2]>,
}

/// Grid of the origin, metres: whole hundreds are easy to add.
const ORIGIN_GRID_M: f64 = 100.0;

/// The scene origin: the mean projection centre in plan, rounded to whole hundreds of metres, when
/// coordinates are large; else zero. Heights are small everywhere and stay what they are.
pub(crate) fn scene_origin<'a>(cameras: impl Iterator<Item = &'a Camera>) -> Vector3<f64> {
    let centers: Vec<Point3<f64>> = cameras.map(|c| c.center).collect();
    let is_large = |c: &Point3<f64>| c.x.abs() > LARGEST_SCENE_M || c.y.abs() > LARGEST_SCENE_M;
    if !centers.iter().any(is_large) {
        return Vector3::zeros();
    }
    let mean = mean_point(&centers);
    let round = |v: f64| (v / ORIGIN_GRID_M).round() * ORIGIN_GRID_M;
    Vector3::new(round(mean.x), round(mean.y), 0.0)
}

/// Why these numbers are no camera.
pub(crate) fn numeric_problem(camera: &Camera) -> Option<&'static str> {
    let Camera { k, r, center, .. } = camera;
    let all = || k.iter().chain(r.iter()).chain(center.iter());
    if all().any(|v| !v.is_finite() || v.abs() > 1e12) {
        Some("a number is infinite or not a number")
    } else if k[(0, 0)] <= 0.0 || k[(1, 1)] <= 0.0 {
        Some("the focal length is not positive")
    } else if (r * r.transpose() - Matrix3::identity()).amax() > EXACT_ROTATION
        || r.determinant() < 0.0
    {
        Some("the rotation matrix is not a rotation: its rows are not orthonormal")
    } else {
        None
    }
}

/// Checks of each camera in its world and of all together. `ground_z` in the local frame.
pub(crate) fn check_cameras(cameras: &[(&str, &Camera)], ground_z: Option<f64>) -> CameraChecks {
    let mut found = CameraChecks::default();
    for (name, camera) in cameras {
        found.errors.extend(placement_error(name, camera, ground_z));
    }
    if found.errors.is_empty() {
        check_overlap(cameras, ground_z, &mut found);
    }
    found
}

/// Is the camera above the ground, looking down?
fn placement_error(name: &str, camera: &Camera, ground_z: Option<f64>) -> Option<Error> {
    let refuse = |problem: String, advice: &str| Some(Error::file(name, problem, advice));
    let z = camera.center.z;
    if z.abs() > LARGEST_SCENE_M {
        return refuse(
            format!("its camera is {z:.0} m high"),
            "metres with Z up are needed: map or local coordinates, or geocentric ones throughout",
        );
    }
    if let Some(ground) = ground_z.filter(|&ground| z <= ground) {
        return refuse(
            format!("its camera ({z:.1} m) is below the ground ({ground:.1} m)"),
            "check the height of the ground and the height system of the orientation",
        );
    }
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let middle = camera.ray(&Point2::new(width / 2.0, height / 2.0));
    if middle.z >= 0.0 {
        return refuse(
            "its camera looks up from the horizon".to_owned(),
            "check that Z is up, the order and the unit of the angles, and that image y runs down",
        );
    }
    None
}

/// Refuses views of which no three see the same place; warns of single ones.
fn check_overlap(cameras: &[(&str, &Camera)], ground_z: Option<f64>, found: &mut CameraChecks) {
    let cameras_only: Vec<&Camera> = cameras.iter().map(|(_, c)| *c).collect();
    let heights = ground_z.map_or_else(|| candidate_heights(&cameras_only), |z| vec![z]);
    let mut most_seen = vec![1; cameras.len()];
    for &z in &heights {
        let counts = views_together(&cameras_only, z);
        if counts.iter().any(|&n| n >= FEWEST_VIEWS) {
            let [low, high] = found.heights.unwrap_or([z, z]);
            found.heights = Some([low.min(z), high.max(z)]);
        }
        for (most, n) in most_seen.iter_mut().zip(counts) {
            *most = n.max(*most);
        }
    }
    let alone = || (0..cameras.len()).filter(|&i| most_seen[i] < FEWEST_VIEWS);
    if found.heights.is_none() {
        let place = match ground_z {
            Some(z) => format!("at the ground height {z:.1} m"),
            None => "at any height of the ground".to_owned(),
        };
        found.errors.push(Error::scene(
            format!("the views do not overlap: no three of them see the same place {place}"),
            "check that images and orientations belong together (names, unit and order of the \
                     angles, the same coordinate system)",
        ));
    } else if alone().next().is_some() {
        found.warnings.push(format!(
            "views that see no place together with two others: {}",
            listed(alone().map(|i| cameras[i].0))
        ));
    }
}

/// A point this far outside an image still counts as seen, pixels: rounding.
const BORDER_PX: f64 = 0.5;

/// Samples along each side of an image for the overlap.
const GRID: u32 = 4;

/// For each view, the greatest number of views (itself included; counted up to [`FEWEST_VIEWS`],
/// which is all that matters) that see one of its sample points on the ground at height `z`.
fn views_together(cameras: &[&Camera], z: f64) -> Vec<usize> {
    let footprints = PlanIndex::new(cameras.iter().map(|camera| footprint(camera, z)));
    cameras
        .iter()
        .map(|camera| {
            let seen_by = |world: &Point3<f64>| {
                let near = footprints.touching([world.xy(), world.xy()], 0.0);
                let near = near.map(|i| cameras[i as usize]);
                let sees =
                    |c: &&Camera| (c.project(world)).is_some_and(|p| c.contains(&p, -BORDER_PX));
                near.filter(sees).take(FEWEST_VIEWS).count()
            };
            let mut most = 0;
            for world in samples(camera).filter_map(|p| camera.at_height(&p, z)) {
                most = most.max(seen_by(&world));
                // No place counts for more; of a flight the first ones do.
                if most == FEWEST_VIEWS {
                    break;
                }
            }
            most
        })
        .collect()
}

/// A box in plan around what an image shows at height `z`; the whole plane where that has no end.
fn footprint(camera: &Camera, z: f64) -> [Point2<f64>; 2] {
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    let (low, high) = (-BORDER_PX, [w + BORDER_PX, h + BORDER_PX]);
    let corners = [[low, low], [high[0], low], high, [low, high[1]]];
    let ground = corners.map(|[x, y]| camera.at_height(&Point2::new(x, y), z).map(|p| p.xy()));
    if ground.iter().any(Option::is_none) {
        // Farther than any place, and small enough for areas of boxes.
        let far = Point2::new(1e100, 1e100);
        return [-far, far];
    }
    bounds(ground.into_iter().flatten())
}

/// A grid of image points that includes the corners.
fn samples(camera: &Camera) -> impl Iterator<Item = Point2<f64>> {
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    (0..=GRID).flat_map(move |j| {
        (0..=GRID).map(move |i| {
            let t = |n: u32| f64::from(n) / f64::from(GRID);
            Point2::new(w * t(i), h * t(j))
        })
    })
}

/// Heights at which the ground may lie: where rays of pairs of views pass each other, thinned out,
/// and a series of depths below the lowest camera for views whose axes are parallel.
fn candidate_heights(cameras: &[&Camera]) -> Vec<f64> {
    // Heights at each of which the views of all places are counted: tried as many as the time of a
    // check allows. Assumption.
    const MOST_CROSSINGS: usize = 60;
    // Neighbours in the list and far ones: every offset that is a power of two keeps large blocks
    // quick.
    let offsets = [1usize, 2, 3, 4, 8, 16, 32, 64];
    let mut crossings: Vec<f64> = (0..cameras.len())
        .flat_map(|i| offsets.iter().map(move |o| (i, i + o)))
        .filter(|&(_, j)| j < cameras.len())
        .flat_map(|(i, j)| pair_heights(cameras[i], cameras[j]))
        .collect();
    crossings.sort_by(f64::total_cmp);
    let step = crossings.len().div_ceil(MOST_CROSSINGS).max(1);
    let lowest = cameras
        .iter()
        .map(|c| c.center.z)
        .fold(f64::INFINITY, f64::min);
    // From indoor distances to the height of an airliner.
    let mut heights: Vec<f64> = crossings.iter().copied().step_by(step).collect();
    let mut depth = 2.0;
    while depth < 12_000.0 {
        heights.push(lowest - depth);
        depth *= 1.1;
    }
    heights
}

/// Heights at which the middle ray of `a` passes nearest to rays of `b`, where that is in front of
/// both.
fn pair_heights(a: &Camera, b: &Camera) -> Vec<f64> {
    let middle = |c: &Camera| Point2::new(f64::from(c.width) / 2.0, f64::from(c.height) / 2.0);
    let ray = a.ray(&middle(a));
    let rays = std::iter::once(middle(b)).chain(samples(b));
    let heights = rays.filter_map(|p| {
        let other = b.ray(&p);
        let base = b.center - a.center;
        let cosine = ray.dot(&other);
        let sine2 = 1.0 - cosine * cosine;
        // Rays within a third of a degree of parallel cross nowhere in particular.
        if sine2 < 3e-5 {
            return None;
        }
        let s = (base.dot(&ray) - cosine * base.dot(&other)) / sine2;
        let t = (cosine * base.dot(&ray) - base.dot(&other)) / sine2;
        (s > 0.0 && t > 0.0).then(|| 0.5 * ((a.center + ray * s).z + (b.center + other * t).z))
    });
    heights.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::rotation_from_axis_angle;

    /// Cameras over 300 m by 300 m, some of which look at the horizon.
    fn flight(count: usize) -> Vec<Camera> {
        let mut random = crate::roofs::testing::uniform(11);
        let mut camera = || {
            let at = Point3::new(300.0 * random(), 300.0 * random(), 60.0 + 20.0 * random());
            let tilt = if random() < 0.2 { 1.4 } else { 0.3 * random() };
            let turn = rotation_from_axis_angle(&Vector3::new(0.0, 0.0, 6.0 * random()));
            let down =
                rotation_from_axis_angle(&Vector3::new(std::f64::consts::PI + tilt, 0.0, 0.0));
            let k = Matrix3::new(400.0, 0.0, 200.0, 0.0, 400.0, 150.0, 0.0, 0.0, 1.0);
            Camera::new(k, down * turn, at, 400, 300)
        };
        (0..count).map(|_| camera()).collect()
    }

    #[test]
    fn asking_the_cameras_around_a_place_counts_as_asking_all() {
        let cameras = flight(60);
        let cameras: Vec<&Camera> = cameras.iter().collect();
        for z in [-20.0, 0.0, 55.0] {
            let sees = |c: &&Camera, place: &Point3<f64>| {
                (c.project(place)).is_some_and(|p| c.contains(&p, -BORDER_PX))
            };
            let of_all = |camera: &&Camera| {
                let places = samples(camera).filter_map(|p| camera.at_height(&p, z));
                let counts = places.map(|x| cameras.iter().filter(|c| sees(c, &x)).count().min(3));
                counts.max().unwrap_or(0)
            };
            let all: Vec<usize> = cameras.iter().map(of_all).collect();
            assert_eq!(views_together(&cameras, z), all, "{z}");
            assert!(all.contains(&3), "{all:?}");
        }
        let seen_alone = views_together(&cameras[..1], 0.0);
        assert!(seen_alone[0] <= 1);
    }
}
