//! The colours of one patch: from the view that shows most of it, gaps from the next ones.

use glam::{DVec3, Vec3};
use nalgebra::{Matrix2, Matrix3x2};
use serde::Serialize;

use super::occlusion::{FaceImages, WallMargins, occluded_texels};
use super::patch::{FacePlane, TexturePatch};
use crate::base::ids::ViewId;
use crate::orienting::scene::Scene;
use crate::photographs::camera::Camera;
use crate::photographs::raster::{colour_at, fill_gaps};

/// Most samples along one side of a texel.
const MAX_SUPERSAMPLING: usize = 4;

/// Colours are balanced between views within this factor. Assumption: larger ratios come from
/// different things in sight (a crane, a cloud's shadow), not from exposure.
pub(super) const MAX_GAIN: f32 = 2.0;

/// Most grey values by which colours are shifted at a seam. Assumption: larger differences are
/// those of different things.
const MAX_SHIFT: f32 = 32.0;

/// How well a view shows a face.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ViewOfFace {
    /// The view.
    pub view: ViewId,
    /// Share of the face that lies in the image and that no other face hides, 0 to 1.
    pub visible: f64,
    /// Image pixels that show a square metre of the face: resolution and viewing angle in one
    /// number.
    pub pixels_per_m2: f64,
}

/// A painted patch.
pub(super) struct PaintedPatch {
    /// `width * height` colours, 0 to 255; meaningless where no texel is known.
    pub colours: Vec<Vec3>,
    /// Texels inside the face that some view shows.
    pub known: Vec<bool>,
    /// The views that show some of the face, the one that shows most pixels of it first.
    pub views: Vec<ViewOfFace>,
    /// Share of the face painted from other views than the first.
    pub filled: f64,
    /// Share of the face that no view shows.
    pub unseen: f64,
}

/// Pixels of a view that show a square metre of the face around its middle; zero from behind.
pub(super) fn pixels_per_m2(plane: &FacePlane, camera: &Camera) -> f64 {
    if plane.height(&camera.center) <= 0.0 {
        return 0.0;
    }
    let axes = Matrix3x2::from_columns(&[plane.right, plane.up]);
    let jacobian: Option<Matrix2<f64>> = camera.project_jacobian(&plane.middle()).map(|j| j * axes);
    jacobian.map_or(0.0, |j| j.determinant().abs())
}

/// Paints the patch of face number `face` from all views, each brightened by its factors
/// `exposures`.
pub(super) fn paint(
    scene: &Scene,
    faces: &[FacePlane],
    face: usize,
    patch: &TexturePatch,
    face_images: &[FaceImages],
    exposures: &[Vec3],
    overhang_m: f64,
) -> PaintedPatch {
    let seen = views_of(scene, faces, face, patch, face_images, overhang_m);
    let total = texels_inside(&patch.inside(&faces[face].flat));
    let (colours, known) = compose(scene, &faces[face], patch, &seen, exposures);
    let share = |mask: &[bool]| mask.iter().filter(|&&k| k).count() as f64 / total;
    let first = seen.first().map_or(0.0, |(v, _)| v.visible);
    let (filled, unseen) = (share(&known) - first, 1.0 - share(&known));
    let views = seen.into_iter().map(|(v, _)| v).collect();
    PaintedPatch {
        colours,
        known,
        views,
        filled,
        unseen,
    }
}

/// A view of a face, and which texels of its patch it shows.
pub(super) type FaceView = (ViewOfFace, Vec<bool>);

/// The views that show some of a face, the one that shows most pixels of it first.
pub(super) fn views_of(
    scene: &Scene,
    faces: &[FacePlane],
    face: usize,
    patch: &TexturePatch,
    face_images: &[FaceImages],
    overhang_m: f64,
) -> Vec<FaceView> {
    let plane = &faces[face];
    let inside = patch.inside(&plane.flat);
    let total = texels_inside(&inside);
    let margins = WallMargins::new(plane, patch, &inside, overhang_m);
    let mut seen: Vec<FaceView> = Vec::new();
    for view in scene.view_ids() {
        let (camera, face_images) = (scene.camera(view), &face_images[view.index()]);
        if !face_images.shows(face, camera) {
            continue;
        }
        let mut hidden = occluded_texels(face, patch, faces, face_images, &camera.center);
        if let Some(margins) = &margins {
            margins.hide(plane, patch, &camera.center, &mut hidden);
        }
        let mask = visible_texels(&inside, &hidden, plane, patch, camera);
        let visible = mask.iter().filter(|&&v| v).count() as f64 / total;
        if visible > 0.0 {
            let pixels_per_m2 = pixels_per_m2(plane, camera);
            let of_face = ViewOfFace {
                view,
                visible,
                pixels_per_m2,
            };
            seen.push((of_face, mask));
        }
    }
    // A stable sort: equal views stay in order.
    seen.sort_by(|(a, _), (b, _)| {
        (b.visible * b.pixels_per_m2).total_cmp(&(a.visible * a.pixels_per_m2))
    });
    seen
}

/// How many texels of a patch lie in its face, at least one.
fn texels_inside(inside: &[bool]) -> f64 {
    inside.iter().filter(|&&i| i).count().max(1) as f64
}

impl PaintedPatch {
    /// Extends the colours smoothly over the texels that no view shows and those beside the face.
    pub(super) fn fill(&mut self, patch: &TexturePatch) {
        fill_gaps(&mut self.colours, &self.known, patch.width, patch.height);
    }
}

/// The texels of a face that lie in the image and are not hidden.
fn visible_texels(
    inside: &[bool],
    hidden: &[bool],
    plane: &FacePlane,
    patch: &TexturePatch,
    camera: &Camera,
) -> Vec<bool> {
    let mut visible = vec![false; inside.len()];
    for (i, v) in visible.iter_mut().enumerate() {
        if inside[i] && !hidden[i] {
            let (x, y) = (
                (i % patch.width) as f64 + 0.5,
                (i / patch.width) as f64 + 0.5,
            );
            let image = camera.project(&plane.lift(&patch.point_of(x, y)));
            // Bilinear sampling needs half a pixel around.
            *v = image.is_some_and(|p| camera.contains(&p, 0.5));
        }
    }
    visible
}

/// The colours of a face in a view, where it shows them.
pub(super) fn colours_in(
    scene: &Scene,
    plane: &FacePlane,
    patch: &TexturePatch,
    (of_face, mask): &FaceView,
) -> Vec<Option<Vec3>> {
    let view = scene.view(of_face.view);
    let texel_px = patch.texel_m * of_face.pixels_per_m2.sqrt();
    let samples = (texel_px.round() as usize).clamp(1, MAX_SUPERSAMPLING);
    let colour = |i| texel(&view.rgb, &view.camera, plane, patch, i, samples);
    (mask.iter().enumerate())
        .map(|(i, shown)| shown.then(|| colour(i)))
        .collect()
}

/// Takes every texel from the first view that shows it, levelled to what is painted already.
fn compose(
    scene: &Scene,
    plane: &FacePlane,
    patch: &TexturePatch,
    seen: &[FaceView],
    exposures: &[Vec3],
) -> (Vec<Vec3>, Vec<bool>) {
    let count = patch.width * patch.height;
    let (mut colours, mut known) = (vec![Vec3::ZERO; count], vec![false; count]);
    for view in seen {
        if (0..count).all(|i| known[i] || !view.1[i]) {
            continue;
        }
        let mut shown = colours_in(scene, plane, patch, view);
        expose(&mut shown, exposures[view.0.view.index()]);
        if known.contains(&true) {
            let gain = gain_to(&colours, &known, &shown);
            shown
                .iter_mut()
                .flatten()
                .for_each(|colour| *colour *= gain);
            level(&mut shown, &colours, &known, patch.width);
        }
        for i in 0..count {
            if let (Some(colour), false) = (shown[i], known[i]) {
                colours[i] = colour.clamp(Vec3::ZERO, Vec3::splat(255.0));
                known[i] = true;
            }
        }
    }
    (colours, known)
}

/// Brightens dark colours by a factor per channel, and light ones less, so that what is white in
/// the photograph stays white.
fn expose(shown: &mut [Option<Vec3>], factor: Vec3) {
    for colour in shown.iter_mut().flatten() {
        *colour *= factor / (1.0 + (factor - 1.0) * *colour / 255.0);
    }
}

/// Shifts a view's colours so that no seam shows where they meet those already painted: by the
/// difference of both where both are known, continued smoothly to where only the new ones are.
fn level(shown: &mut [Option<Vec3>], colours: &[Vec3], known: &[bool], width: usize) {
    let common: Vec<bool> = (shown.iter().zip(known))
        .map(|(new, known)| new.is_some() && *known)
        .collect();
    let most = Vec3::splat(MAX_SHIFT);
    let mut shifts: Vec<Vec3> = (shown.iter().zip(colours))
        .map(|(new, old)| (old - new.unwrap_or_default()).clamp(-most, most))
        .collect();
    fill_gaps(&mut shifts, &common, width, known.len() / width);
    if common.contains(&true) {
        for (colour, shift) in shown.iter_mut().zip(&shifts) {
            let Some(colour) = colour else { continue };
            *colour += *shift;
        }
    }
}

/// The factor per channel that brings a view's colours to those already painted.
fn gain_to(colours: &[Vec3], known: &[bool], shown: &[Option<Vec3>]) -> Vec3 {
    let (mut painted, mut offered) = (DVec3::ZERO, DVec3::ZERO);
    for i in (0..colours.len()).filter(|&i| known[i]) {
        if let Some(colour) = shown[i] {
            painted += colours[i].as_dvec3();
            offered += colour.as_dvec3();
        }
    }
    let offers = offered.cmpgt(DVec3::ZERO);
    let gain = DVec3::select(offers, painted / offered, DVec3::ONE).as_vec3();
    gain.clamp(Vec3::splat(1.0 / MAX_GAIN), Vec3::splat(MAX_GAIN))
}

/// Mean colour of a texel over `samples * samples` positions in the image.
fn texel(
    rgb: &image::RgbImage,
    camera: &Camera,
    plane: &FacePlane,
    patch: &TexturePatch,
    index: usize,
    samples: usize,
) -> Vec3 {
    let (column, row) = ((index % patch.width) as f64, (index / patch.width) as f64);
    let step = 1.0 / samples as f64;
    let mut sum = Vec3::ZERO;
    let mut count = 0u8;
    for k in 0..samples * samples {
        let x = column + ((k % samples) as f64 + 0.5) * step;
        let y = row + ((k / samples) as f64 + 0.5) * step;
        let image = camera.project(&plane.lift(&patch.point_of(x, y)));
        if let Some(colour) = image.and_then(|p| colour_at(rgb, &p)) {
            sum += colour;
            count += 1;
        }
    }
    sum / f32::from(count.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A roof of 40 by 10 texels, brighter to the right, `offset` darker in a second view. The
    /// first shows the columns up to 20, the second those from 12 on. Their painted colours, red,
    /// of the first row.
    fn levelled(offset: f32) -> Vec<f32> {
        let shade = |i: usize| 100.0 + (i % 40) as f32;
        let known: Vec<bool> = (0..400).map(|i| i % 40 < 20).collect();
        let colours: Vec<Vec3> = (0..400).map(|i| Vec3::new(shade(i), 90.0, 80.0)).collect();
        let mut shown: Vec<Option<Vec3>> = (0..400)
            .map(|i| (i % 40 >= 12).then(|| Vec3::new(shade(i) - offset, 90.0 - offset, 80.0)))
            .collect();
        level(&mut shown, &colours, &known, 40);
        (0..40)
            .map(|i| {
                if known[i] {
                    colours[i].x
                } else {
                    shown[i].unwrap().x
                }
            })
            .collect()
    }

    #[test]
    fn no_seam_is_left_where_two_views_meet() {
        for offset in [0.0, 14.0, -9.0] {
            for (column, red) in levelled(offset).iter().enumerate() {
                let expected = 100.0 + column as f32;
                assert!((red - expected).abs() < 0.5, "{offset} at {column}: {red}");
            }
        }
    }

    #[test]
    fn what_looks_quite_different_is_hardly_changed() {
        let red = levelled(80.0);
        assert!(
            (red[30] - (130.0 - 80.0 + MAX_SHIFT)).abs() < 0.5,
            "{}",
            red[30]
        );
    }

    #[test]
    fn exposure_leaves_black_and_white() {
        for factor in [0.7, 1.0, 1.4] {
            let mut shown = [0.0, 1.0, 255.0].map(|grey| Some(Vec3::splat(grey)));
            expose(&mut shown, Vec3::new(factor, 1.0, 1.0));
            let [black, dark, white] = shown.map(|colour| colour.unwrap().x);
            assert_eq!(black, 0.0);
            assert!((dark - factor).abs() < 0.01, "{dark} by {factor}");
            assert!((white - 255.0).abs() < 1e-3);
            assert_eq!(shown[1].unwrap(), Vec3::new(dark, 1.0, 1.0));
        }
    }

    #[test]
    fn views_without_a_texel_in_common_stay_as_they_are() {
        let known = [true, true, false, false];
        let shown = [None, None, Some(Vec3::splat(50.0)), Some(Vec3::splat(60.0))];
        let mut levelled = shown;
        level(&mut levelled, &[Vec3::splat(90.0); 4], &known, 4);
        assert_eq!(levelled, shown);
    }
}
