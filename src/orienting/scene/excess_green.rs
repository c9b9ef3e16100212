//! Is a surface green, as plants are? Crowns and hedges are textured, and from above nearly as
//! plane as roofs.
//!
//! The measure is the excess green of weed detection (Woebbecke et al. 1995), (2 G - R - B) / (R +
//! G + B): the same in sun and in shade. Painted and copper roofs are green, too, so it only speaks
//! against a roof and rejects none by itself. Photographs without colour, and colour infrared
//! ones, in which plants are red, give no evidence.

use nalgebra::Point3;

use super::{Scene, View};

/// Excess green at some points: of each view that sees them in the mean, and of the views the
/// median. 0 where no view does.
pub(crate) fn excess_green(scene: &Scene, points: &[Point3<f64>]) -> f64 {
    let mut of_views: Vec<f64> = (scene.views.iter())
        .filter_map(|view| of_view(view, points))
        .collect();
    crate::base::math::median(&mut of_views).unwrap_or(0.0)
}

fn of_view(view: &View, points: &[Point3<f64>]) -> Option<f64> {
    let (mut green, mut all) = (0.0, 0.0);
    for p in points {
        let Some(x) = view.camera.project(p) else {
            continue;
        };
        if !view.camera.contains(&x, 1.0) {
            continue;
        }
        // An instance that only shares the work has no colours.
        let Some(pixel) = view.rgb.get_pixel_checked(x.x as u32, x.y as u32) else {
            continue;
        };
        let [r, g, b] = pixel.0.map(f64::from);
        green += 2.0 * g - r - b;
        all += r + g + b;
    }
    (all > 0.0).then(|| green / all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::synthetic::gable_scene;
    use image::Rgb;

    #[test]
    fn what_is_green_in_most_views_is_green_in_sun_and_shade() {
        let (mut scene, truth) = gable_scene(320);
        let points: Vec<Point3<f64>> = truth.facets[0].1.clone();
        let mut paint = |colours: &[[u8; 3]]| {
            for (view, colour) in scene.views.iter_mut().zip(colours.iter().cycle()) {
                view.rgb.pixels_mut().for_each(|p| *p = Rgb(*colour));
            }
            excess_green(&scene, &points)
        };
        let (lawn, shaded, tile) = ([90, 120, 60], [30, 40, 20], [180, 90, 60]);
        assert!((paint(&[lawn]) - 1.0 / 3.0).abs() < 1e-9);
        assert!((paint(&[lawn, shaded]) - 1.0 / 3.0).abs() < 1e-9);
        assert!(
            (paint(&[lawn, lawn, tile]) - 1.0 / 3.0).abs() < 1e-9,
            "a view that sees something else"
        );
        assert!(paint(&[tile]) < -0.1 && paint(&[[80, 80, 80]]) == 0.0);
        assert_eq!(excess_green(&scene, &[]), 0.0);
    }
}
