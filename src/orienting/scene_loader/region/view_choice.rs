//! The views that say most about a region, where more show it than are wanted.
//!
//! A view measures a place across its rays, each of its pixels once more: of a piece of level
//! surface it has the information (Fisher)
//!
//! ```text
//! q cos(zenith distance of the ray) / s^2  (I - r r^T)   r its direction, s size of a pixel there
//! ```
//!
//! q being the share of what a sharp and well exposed photograph tells, and views together the sum
//! of theirs. The choice is greedy and D-optimal: the next view is the
//! one that raises the sum of log det over the region most. A view that repeats another adds
//! little, one across the first baselines or from the side much.

use nalgebra::{Matrix3, Point3};

use crate::base::math::ln;
use crate::photographs::camera::{Camera, FEWEST_VIEWS};

/// A piece of level surface that the views are to measure.
struct Patch {
    place: Point3<f64>,
    /// Of the views that are chosen, and before them: metres to the minus two.
    information: Matrix3<f64>,
}

/// Indices of cameras, in their order, that say most about surfaces at these places, of photographs
/// with such `shares` of the information that they could have; places are
/// known to within `unknown_m` metres before: at most `most`, or so many more that a place is seen
/// by half as many in the mean. Views that show a part of the places only are read in part.
pub(crate) fn most_telling(
    cameras: &[Camera],
    shares: &[f64],
    places: &[Point3<f64>],
    unknown_m: f64,
    most: usize,
) -> Vec<usize> {
    if cameras.len() <= most {
        return (0..cameras.len()).collect();
    }
    let before = Matrix3::identity() / (unknown_m * unknown_m);
    let patch = |place: &Point3<f64>| Patch {
        place: *place,
        information: before,
    };
    let mut patches: Vec<Patch> = places.iter().map(patch).collect();
    let mut chosen = Vec::new();
    let mut waiting: Vec<usize> = (0..cameras.len()).collect();
    // Places beyond the border of a flight are not waited for.
    let is_shown =
        |patch: &&Patch| cameras.iter().filter(|c| sees(c, patch)).count() >= FEWEST_VIEWS;
    let shown = patches.iter().filter(is_shown).count();
    let mut seen = 0;
    while chosen.len() < most || 2 * seen < most * shown {
        let gains = crate::base::execution::map(&waiting, |_, &view| {
            gain(&cameras[view], shares[view], &patches)
        });
        // Of equal ones the first.
        let best = (0..gains.len())
            .rev()
            .max_by(|&i, &j| gains[i].total_cmp(&gains[j]));
        let Some(best) = best else { break };
        let view = waiting.remove(best);
        for patch in &mut patches {
            patch.information += information(&cameras[view], patch) * shares[view];
        }
        seen += (patches.iter())
            .filter(|patch| sees(&cameras[view], patch))
            .count();
        chosen.push(view);
    }
    chosen.sort_unstable();
    chosen
}

/// By how much a view more raises the sum of log det over all patches, nats.
fn gain(camera: &Camera, share: f64, patches: &[Patch]) -> f64 {
    let of_patch = |patch: &Patch| {
        let with = patch.information + information(camera, patch) * share;
        ln(with.determinant()) - ln(patch.information.determinant())
    };
    patches.iter().map(of_patch).sum()
}

fn sees(camera: &Camera, patch: &Patch) -> bool {
    let image = camera.project(&patch.place);
    image.is_some_and(|x| camera.contains(&x, 0.0))
}

/// What a view tells of the position of a piece of surface, metres to the minus two.
fn information(camera: &Camera, patch: &Patch) -> Matrix3<f64> {
    if !sees(camera, patch) {
        return Matrix3::zeros();
    }
    let ray = (camera.center - patch.place).normalize();
    let pixel_m = camera.ground_pixel(&patch.place);
    let facing = ray.z.max(0.0);
    (Matrix3::identity() - ray * ray.transpose()) * (facing / (pixel_m * pixel_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// A camera of 400 x 400 pixels that looks down.
    fn nadir(x: f64, y: f64, z: f64) -> Camera {
        Camera {
            k: Matrix3::new(300.0, 0.0, 200.0, 0.0, 300.0, 200.0, 0.0, 0.0, 1.0),
            r: Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)),
            center: Point3::new(x, y, z),
            width: 400,
            height: 400,
        }
    }

    fn at(x: f64, y: f64) -> Camera {
        nadir(x, y, 100.0)
    }

    #[test]
    fn where_views_show_a_part_only_more_are_taken() {
        // Each sees 133 m by 133 m.
        let places: Vec<Point3<f64>> = (0..25)
            .map(|i| Point3::new(f64::from(i % 5) * 100.0, f64::from(i / 5) * 100.0, 0.0))
            .collect();
        let cameras: Vec<Camera> = (0..300)
            .map(|i| at(f64::from(i % 20) * 21.0, f64::from(i / 20) * 28.0))
            .collect();
        let chosen = most_telling(&cameras, &[1.0; 300][..cameras.len()], &places, 60.0, 12);
        let seen_by = |place: &Point3<f64>| {
            let sees = |&&i: &&usize| {
                let image = cameras[i].project(place);
                image.is_some_and(|x| cameras[i].contains(&x, 0.0))
            };
            chosen.iter().filter(sees).count()
        };
        let seen: Vec<usize> = places.iter().map(seen_by).collect();
        let mean = seen.iter().sum::<usize>() as f64 / seen.len() as f64;
        assert!((6.0..6.5).contains(&mean), "{seen:?}");
        assert!(seen.iter().all(|n| *n >= 3), "{seen:?}");
        assert!(chosen.len() > 12 && chosen.len() < 150, "{}", chosen.len());
    }

    #[test]
    fn a_repeated_view_is_left_out_and_a_cross_baseline_taken() {
        let cameras = [at(0.0, 0.0), at(0.2, 0.0), at(30.0, 0.0), at(0.0, 30.0)];
        let chosen = most_telling(
            &cameras,
            &[1.0; 300][..cameras.len()],
            &[Point3::origin()],
            60.0,
            3,
        );
        assert_eq!(chosen.len(), 3);
        assert!(chosen.contains(&2) && chosen.contains(&3), "{chosen:?}");
    }

    #[test]
    fn views_that_do_not_show_the_place_come_last() {
        let cameras = [at(900.0, 0.0), at(0.0, 0.0), at(20.0, 0.0), at(0.0, 20.0)];
        assert_eq!(
            most_telling(
                &cameras,
                &[1.0; 300][..cameras.len()],
                &[Point3::origin()],
                60.0,
                3
            ),
            [1, 2, 3]
        );
    }

    #[test]
    fn few_enough_views_are_all_taken() {
        let cameras = [at(0.0, 0.0), at(900.0, 0.0)];
        assert_eq!(
            most_telling(
                &cameras,
                &[1.0; 300][..cameras.len()],
                &[Point3::origin()],
                60.0,
                2
            ),
            [0, 1]
        );
    }

    #[test]
    fn of_two_like_views_the_sharper_is_taken_but_for_what_only_the_other_shows() {
        let cameras = [at(0.0, 0.0), at(1.0, 0.0), at(30.0, 0.0)];
        let place = [Point3::origin()];
        let chosen = |shares: [f64; 3]| most_telling(&cameras, &shares, &place, 60.0, 2);
        assert_eq!(chosen([0.1, 1.0, 1.0]), [1, 2]);
        assert_eq!(chosen([1.0, 0.1, 1.0]), [0, 2]);
        // A baseline tells more than a repetition, though it is blurred.
        assert!(chosen([1.0, 1.0, 0.5]).contains(&2));
    }

    #[test]
    fn the_nearer_of_two_like_views_is_taken() {
        let low = nadir(0.0, 0.0, 50.0);
        let cameras = [at(0.0, 0.0), low];
        assert_eq!(
            most_telling(
                &cameras,
                &[1.0; 300][..cameras.len()],
                &[Point3::origin()],
                60.0,
                1
            ),
            [1]
        );
    }
}
