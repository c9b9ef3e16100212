//! The heights of the surfaces that views show, from their matches, before anything is known of
//! the scene.

use super::epipolar_check::{EpipolarCheck, MIN_POINTS};
use super::subpixel::matches;
use super::view::CheckedView;
use crate::base::math::{larger, smaller};
use crate::photographs::camera::Camera;
use nalgebra::Point2;

/// Lowest and highest height of what all but wrong matches show, metres, local frame: quartiles and
/// one and a half times their distance on both sides (Tukey's fences). `None` where the views have
/// too few matches.
pub fn surface_heights(views: &[CheckedView]) -> Option<[f64; 2]> {
    let check = EpipolarCheck::new(views);
    let cameras: Vec<Camera> = views.iter().map(|v| v.camera.clone()).collect();
    let found = matches(&check, views, &cameras);
    let pairs = check.pairs.iter().zip(&found);
    let mut heights: Vec<f64> = pairs
        .flat_map(|(&(i, j), found)| found.iter().map(move |m| (i, j, m)))
        .filter_map(|(i, j, m)| height(&cameras[i], &m.first, &cameras[j], &m.second))
        .collect();
    if heights.len() < MIN_POINTS {
        return None;
    }
    heights.sort_by(f64::total_cmp);
    let at = |quarter: usize| heights[quarter * (heights.len() - 1) / 4];
    let reach = 1.5 * (at(3) - at(1));
    let (low, high) = (heights[0], heights[heights.len() - 1]);
    Some([larger(low, at(1) - reach), smaller(high, at(3) + reach)])
}

/// Height of the place where the rays of two image points come nearest to each other; `None` where
/// that is behind a camera or the rays are parallel.
fn height(a: &Camera, x: &Point2<f64>, b: &Camera, y: &Point2<f64>) -> Option<f64> {
    let (u, v) = (a.ray(x), b.ray(y));
    let base = b.center - a.center;
    let cosine = u.dot(&v);
    let squared_sine = 1.0 - cosine * cosine;
    if squared_sine < f64::EPSILON {
        return None;
    }
    let s = (base.dot(&u) - cosine * base.dot(&v)) / squared_sine;
    let t = (cosine * base.dot(&u) - base.dot(&v)) / squared_sine;
    let middle = || nalgebra::center(&(a.center + u * s), &(b.center + v * t)).z;
    (s > 0.0 && t > 0.0).then(middle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::synthetic::gable_scene;

    #[test]
    fn the_ground_and_the_ridge_lie_in_the_range_and_little_else() {
        let (scene, truth) = gable_scene(320);
        let views: Vec<CheckedView> = (scene.views.iter().take(4))
            .map(|view| CheckedView {
                name: &view.name,
                camera: view.camera.clone(),
                gray: &view.gray,
                origin: scene.origin,
                angles: None,
                readings: Vec::new(),
                crop: None,
            })
            .collect();
        let [low, high] = surface_heights(&views).expect("the images match");
        let top = truth.edges.iter().map(|e| e.p0.z).fold(f64::MIN, f64::max);
        assert!(
            low < truth.ground_z + 0.5 && low > truth.ground_z - 10.0,
            "{low}"
        );
        assert!(high > truth.ground_z && high < top + 20.0, "{high}");
    }
}
