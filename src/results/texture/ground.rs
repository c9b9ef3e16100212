//! The ground around the buildings, from the photographs: an orthophoto on one plane.

use nalgebra::{Matrix3, Point2, Point3, Vector3, center};

use super::exposure::exposures;
use super::occlusion::FaceImages;
use super::paint::paint;
use super::patch::{FacePlane, TexturePatch};
use super::{MAX_TEXEL_GROUND_PIXELS, faces_of};
use crate::base::geometry::bounds;
use crate::base::params::TextureParams;
use crate::orienting::scene::Scene;
use crate::roofs::model::RoofModel;

/// Most texels along a side: what a page draws and a worker paints in about a second.
const MAX_TEXELS: f64 = 1024.0;

/// Ground shown around the buildings, as a share of the longer side of the box around them.
const MARGIN: f64 = 0.5;

/// Share of the picture over which it fades out, at each border.
const FADE: f64 = 0.15;

/// The ground below a model as a picture.
#[derive(Clone, Debug)]
pub struct GroundTexture {
    /// Corners of the picture, metres, local frame: its upper left (north west), upper right, lower
    /// right and lower left.
    pub corners: [Point3<f64>; 4],
    /// Its colours; transparent where no photograph shows the ground, and more and more so towards
    /// the border. What buildings hide is continued smoothly.
    pub image: image::RgbaImage,
}

/// Paints the ground around a model's buildings; `None` for a model without a building.
pub fn texture_ground(
    scene: &Scene,
    model: &RoofModel,
    params: &TextureParams,
) -> Option<GroundTexture> {
    let plane = ground_rectangle(model)?;
    let middle = plane.middle();
    let pixels = scene.views.iter().map(|v| v.camera.ground_pixel(&middle));
    let [low, high] = plane.bounds();
    let smallest = (high - low).max() / MAX_TEXELS;
    let pixel = pixels.fold(f64::MAX, f64::min);
    let texel_m = (params.texel_px * pixel).clamp(smallest, MAX_TEXEL_GROUND_PIXELS * smallest);
    let patch = TexturePatch::new(&plane, texel_m);

    let (_, mut faces) = faces_of(model);
    let images = FaceImages::of_views(scene, &faces);
    let exposures = exposures(scene, &faces, &images, params.overhang_m);
    faces.push(plane);
    let ground = faces.len() - 1;
    let mut painted = paint(
        scene,
        &faces,
        ground,
        &patch,
        &FaceImages::of_views(scene, &faces),
        &exposures,
        params.overhang_m,
    );
    painted.fill(&patch);

    let plane = &faces[ground];
    let texel = |x: u32, y: u32| {
        let at = plane.lift(&patch.point_of(f64::from(x) + 0.5, f64::from(y) + 0.5));
        let in_view = |camera: &crate::photographs::camera::Camera| {
            camera
                .project(&at)
                .is_some_and(|p| camera.contains(&p, 0.5))
        };
        let is_shown = scene.views.iter().any(|v| in_view(&v.camera));
        let [r, g, b] = painted.colours[y as usize * patch.width + x as usize]
            .to_array()
            .map(|c| c.round().clamp(0.0, 255.0) as u8);
        let opacity = if is_shown {
            fade(x, patch.width) * fade(y, patch.height)
        } else {
            0.0
        };
        image::Rgba([r, g, b, (255.0 * opacity).round() as u8])
    };
    let (width, height) = (patch.width as f64, patch.height as f64);
    let corner = |x: f64, y: f64| plane.lift(&patch.point_of(x, y));
    Some(GroundTexture {
        corners: [
            corner(0.0, 0.0),
            corner(width, 0.0),
            corner(width, height),
            corner(0.0, height),
        ],
        image: image::RgbaImage::from_fn(patch.width as u32, patch.height as u32, texel),
    })
}

/// How opaque a column of `count` is: 0 at both borders, 1 in the middle.
fn fade(column: u32, count: usize) -> f64 {
    let at = (f64::from(column) + 0.5) / count as f64;
    (at.min(1.0 - at) / FADE).min(1.0)
}

/// The rectangle around the buildings in the plane through their feet, north up.
fn ground_rectangle(model: &RoofModel) -> Option<FacePlane> {
    let feet = model.buildings.iter().flat_map(|b| {
        let vertices = b.solid.vertices.iter();
        vertices.map(|v| Point3::new(v.x, v.y, b.ground_z))
    });
    let feet: Vec<Point3<f64>> = feet.collect();
    if feet.is_empty() {
        return None;
    }
    let [low, high] = bounds(feet.iter().map(|p| p.xy()));
    let middle = center(&low, &high);
    let margin = MARGIN * (high - low).max();
    let half = (high - low) / 2.0 + nalgebra::Vector2::repeat(margin);

    let [rise, east, north] = plane_through(&feet, &middle);
    let normal = Vector3::new(-east, -north, 1.0).normalize();
    let right = Vector3::new(1.0, 0.0, east).normalize();
    let up = normal.cross(&right);
    let origin = Point3::new(middle.x, middle.y, rise);
    let flat: Vec<Point2<f64>> = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| Point2::new(x * half.x, y * half.y))
        .into();
    let lift = |p: &Point2<f64>| origin + right * p.x + up * p.y;
    Some(FacePlane {
        origin,
        right,
        up,
        normal,
        rings: vec![flat.iter().map(lift).collect()],
        flat: flat.into(),
    })
}

/// Height at the middle and slopes to the east and north of the plane that fits the feet best. It
/// is drawn towards the horizontal by as much as one foot at the farthest distance would, so that
/// the feet of a single building give a level plane.
fn plane_through(feet: &[Point3<f64>], middle: &Point2<f64>) -> [f64; 3] {
    let count = feet.len() as f64;
    let reach = feet.iter().map(|p| (p.xy() - middle).norm_squared());
    let prior = reach.fold(0.0, f64::max).max(1.0);
    let mut normal = Matrix3::from_diagonal(&Vector3::new(0.0, prior, prior));
    let mut right = Vector3::zeros();
    for p in feet {
        let row = Vector3::new(1.0, p.x - middle.x, p.y - middle.y);
        normal += row * row.transpose();
        right += row * p.z;
    }
    let solved = normal.try_inverse().map(|inverse| inverse * right);
    let mean = feet.iter().map(|p| p.z).sum::<f64>() / count;
    solved.map_or([mean, 0.0, 0.0], |s| [s.x, s.y, s.z])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::synthetic::gable_scene;
    use crate::{Params, Run};

    #[test]
    fn a_plane_is_found_through_feet_on_a_slope() {
        let feet: Vec<Point3<f64>> = (0..40)
            .flat_map(|i| (0..40).map(move |j| (f64::from(i), f64::from(j))))
            .map(|(x, y)| Point3::new(x, y, 3.0 + 0.05 * (x - 20.0) - 0.1 * (y - 20.0)))
            .collect();
        let [rise, east, north] = plane_through(&feet, &Point2::new(20.0, 20.0));
        assert!((rise - 3.0).abs() < 0.01, "{rise}");
        assert!(
            (east - 0.05).abs() < 0.01 && (north + 0.1).abs() < 0.01,
            "{east} {north}"
        );
    }

    #[test]
    fn the_ground_beside_a_house_has_the_colours_that_the_photographs_show_there() {
        let (scene, _) = gable_scene(320);
        let mut run = Run::new(scene, Params::default());
        run.run_all();
        let model = run.results().roof_model().unwrap();
        let scene = run.scene();
        let ground = texture_ground(scene, model, &TextureParams::default()).unwrap();
        let [upper_left, upper_right, _, lower_left] = ground.corners;
        assert!(upper_left.y > lower_left.y && upper_right.x > upper_left.x);
        // Near its upper left corner no house is in the way.
        let (w, h) = ground.image.dimensions();
        let (x, y) = (w / 6, h / 6);
        let at = upper_left
            + (upper_right - upper_left) * ((f64::from(x) + 0.5) / f64::from(w))
            + (lower_left - upper_left) * ((f64::from(y) + 0.5) / f64::from(h));
        let shown: Vec<[u8; 3]> = scene
            .views
            .iter()
            .filter_map(|v| {
                let p = v
                    .camera
                    .project(&at)
                    .filter(|p| v.camera.contains(p, 1.0))?;
                Some(v.rgb.get_pixel(p.x as u32, p.y as u32).0)
            })
            .collect();
        assert!(!shown.is_empty());
        let painted = ground.image.get_pixel(x, y).0;
        assert_eq!(painted[3], 255);
        let mean =
            |c: usize| shown.iter().map(|p| f64::from(p[c])).sum::<f64>() / shown.len() as f64;
        for c in 0..3 {
            assert!(
                (f64::from(painted[c]) - mean(c)).abs() < 40.0,
                "{painted:?}, not {shown:?}"
            );
        }
    }
}
