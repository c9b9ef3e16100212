//! Textures for the faces of a model: the best view per face, packed into one atlas (B99 figures 23
//! and 24: "3D view with texture mapping").
//!
//! Every face gets a rectified patch in its own plane, at about the resolution of the image that
//! shows it best (resolution, viewing angle and visibility count in one number: the image pixels
//! that show it). What other faces hide in that view comes from the next views, whose colours are
//! levelled where they meet; what no view shows is filled smoothly. B99 does not say how textures
//! are chosen; a patch per face keeps each independent of the cameras.
//!
//! ```text
//! patch      the raster in the plane of a face
//! occlusion  which texels other faces hide from a view
//! paint      the colours of a patch from all views
//! exposure   the brightness of the views relative to each other
//! atlas      packing
//! ground     the ground around the buildings
//! ```
//!
//! Invariant: every corner of every face has texture coordinates inside the atlas.

mod atlas;
mod exposure;
mod ground;
mod occlusion;
mod paint;
mod patch;

pub use ground::{GroundTexture, texture_ground};
pub use paint::ViewOfFace;

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use self::atlas::{Packing, pack};
use self::exposure::exposures;
use self::occlusion::FaceImages;
use self::paint::{PaintedPatch, paint, pixels_per_m2};
use self::patch::{FacePlane, TexturePatch};
use crate::base::ids::{BuildingId, ViewId};
use crate::base::params::TextureParams;
use crate::orienting::scene::Scene;
use crate::photographs::raster::fill_gaps;
use crate::roofs::model::{RoofModel, Surface};

/// A face seen at a grazing angle gets texels of at most this many ground pixels.
const MAX_TEXEL_GROUND_PIXELS: f64 = 8.0;

/// The colour of faces where nothing at all is seen.
const NEUTRAL: Vec3 = Vec3::splat(128.0);

/// The colour of walls where no view shows one: plaster.
const PLASTER: Vec3 = Vec3::new(205.0, 200.0, 190.0);

/// The texture of one face of a solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FaceTexture {
    /// The view that most of the texture comes from; `None` for a face that no view shows, which
    /// has the mean colour of its kind.
    pub view: Option<ViewId>,
    /// Per ring of the face and per corner: (u, v) in the atlas, 0 to 1, origin at its top left.
    pub uv: Vec<Vec<[f32; 2]>>,
}

/// A texture atlas and where each face lies in it.
#[derive(Clone, Debug)]
pub struct TexturedModel {
    /// The atlas, RGB.
    pub atlas: image::RgbImage,
    /// Per building and per face of its solid.
    pub faces: Vec<Vec<FaceTexture>>,
}

/// How a face was textured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaceTextureTrace {
    /// The building.
    pub building: BuildingId,
    /// Index of the face in its solid.
    pub face: usize,
    /// Side of a texel, metres.
    pub texel_m: f64,
    /// The views that show the face, the chosen one first.
    pub views: Vec<ViewOfFace>,
    /// Share of the face painted from other views than the chosen one.
    pub filled: f64,
    /// Share of the face that no view shows.
    pub unseen: f64,
}

/// How the faces were textured.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TextureTrace {
    /// All faces, by building.
    pub faces: Vec<FaceTextureTrace>,
    /// Width and height of the atlas, pixels.
    pub atlas_px: [u32; 2],
    /// By how much texels were made larger to fit the atlas; 1 where they were not.
    pub coarsened: f64,
}

/// Textures every face of a model from the views that show it best.
pub fn texture_model(
    scene: &Scene,
    model: &RoofModel,
    params: &TextureParams,
) -> (TexturedModel, TextureTrace) {
    let (keys, faces) = faces_of(model);
    let face_images = FaceImages::of_views(scene, &faces);
    let texels = crate::base::execution::map_part(&faces, 0.0..0.2, |i, face| {
        texel_m(scene, i, face, &face_images, params)
    });
    let (patches, packing, coarsened) = lay_out(&faces, &texels, params);
    let exposures = exposures(scene, &faces, &face_images, params.overhang_m);
    let mut painted = crate::base::execution::map_part(&patches, 0.3..0.9, |i, patch| {
        let overhang_m = params.overhang_m;
        paint(
            scene,
            &faces,
            i,
            patch,
            &face_images,
            &exposures,
            overhang_m,
        )
    });
    let kinds: Vec<Surface> = keys
        .iter()
        .map(|&(b, f)| model.buildings[b].solid.faces[f].surface)
        .collect();
    colour_unseen(&mut painted, &kinds);
    for (painted, patch) in painted.iter_mut().zip(&patches) {
        painted.fill(patch);
    }
    let padding = params.padding_px as usize;
    let atlas = draw(&patches, &painted, &packing, padding);
    let mut textured = TexturedModel {
        atlas,
        faces: vec![Vec::new(); model.buildings.len()],
    };
    let mut trace = TextureTrace {
        faces: Vec::new(),
        atlas_px: [packing.width as u32, packing.height as u32],
        coarsened,
    };
    for (i, (&(b, f), painted)) in keys.iter().zip(painted).enumerate() {
        textured.faces[b].push(FaceTexture {
            view: painted.views.first().map(|v| v.view),
            uv: coordinates(&faces[i], &patches[i], packing.places[i], &packing, padding),
        });
        trace.faces.push(FaceTextureTrace {
            building: BuildingId::from_index(b),
            face: f,
            texel_m: patches[i].texel_m,
            views: painted.views,
            filled: painted.filled,
            unseen: painted.unseen,
        });
    }
    (textured, trace)
}

/// All faces of a model, with building and index of each.
fn faces_of(model: &RoofModel) -> (Vec<(usize, usize)>, Vec<FacePlane>) {
    let keys: Vec<(usize, usize)> = (0..model.buildings.len())
        .flat_map(|b| (0..model.buildings[b].solid.faces.len()).map(move |f| (b, f)))
        .collect();
    let plane = |&(b, f): &(usize, usize)| {
        let solid = &model.buildings[b].solid;
        FacePlane::new(solid, &solid.faces[f])
    };
    let faces = keys.iter().map(plane).collect();
    (keys, faces)
}

/// The texel size for a face, metres: a pixel of the view that shows it with the most pixels. Faces
/// in no image get a single texel.
fn texel_m(
    scene: &Scene,
    index: usize,
    face: &FacePlane,
    face_images: &[FaceImages],
    params: &TextureParams,
) -> f64 {
    let middle = face.middle();
    let shown = scene
        .view_ids()
        .filter(|v| face_images[v.index()].shows(index, scene.camera(*v)));
    shown
        .map(|view| {
            let camera = scene.camera(view);
            let ground_pixel = camera.ground_pixel(&middle);
            let pixel = 1.0 / pixels_per_m2(face, camera).max(1e-12).sqrt();
            params.texel_px * pixel.min(MAX_TEXEL_GROUND_PIXELS * ground_pixel)
        })
        .filter(|texel| texel.is_finite() && *texel > 0.0)
        .min_by(f64::total_cmp)
        .unwrap_or_else(|| {
            let [low, high] = face.bounds();
            (high - low).max().max(1e-3)
        })
}

/// Patches of the wanted texel sizes, or of larger ones until they fit into the atlas; and by how
/// much larger.
fn lay_out(
    faces: &[FacePlane],
    texels: &[f64],
    params: &TextureParams,
) -> (Vec<TexturePatch>, Packing, f64) {
    let border = 2 * params.padding_px as usize;
    let mut coarsened = 1.0;
    loop {
        let patches: Vec<TexturePatch> = faces
            .iter()
            .zip(texels)
            .map(|(f, t)| TexturePatch::new(f, t * coarsened))
            .collect();
        let sizes: Vec<_> = patches
            .iter()
            .map(|p| (p.width + border, p.height + border))
            .collect();
        if let Some(packing) = pack(&sizes, params.max_atlas_px as usize) {
            return (patches, packing, coarsened);
        }
        // Nothing more to gain: every patch is a single texel. Let the atlas grow.
        if patches.iter().all(|p| p.width * p.height == 1) {
            let packing = pack(&sizes, 1 << 24).expect("any size fits");
            return (patches, packing, coarsened);
        }
        coarsened *= 1.05;
    }
}

/// Gives faces that no view shows the mean colour of the faces of their kind, or of all.
fn colour_unseen(painted: &mut [PaintedPatch], kinds: &[Surface]) {
    let mean = |keep: &dyn Fn(&Surface) -> bool| {
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        for (p, _) in painted.iter().zip(kinds).filter(|(_, kind)| keep(kind)) {
            for (colour, _) in p.colours.iter().zip(&p.known).filter(|(_, known)| **known) {
                sum += colour.as_dvec3();
                count += 1.0;
            }
        }
        (count > 0.0).then(|| (sum / count).as_vec3())
    };
    let any = mean(&|_| true).unwrap_or(NEUTRAL);
    let roof = mean(&|kind| matches!(kind, Surface::Roof(_))).unwrap_or(any);
    let wall = mean(&|kind| *kind == Surface::Wall).unwrap_or(PLASTER);
    for (p, kind) in painted
        .iter_mut()
        .zip(kinds)
        .filter(|(p, _)| p.views.is_empty())
    {
        let colour = match kind {
            Surface::Roof(_) => roof,
            Surface::Wall | Surface::Ceiling => wall,
            Surface::Ground => any,
        };
        p.colours.fill(colour);
        p.known.fill(true);
    }
}

/// Draws the patches with their border of smoothly continued colours.
fn draw(
    patches: &[TexturePatch],
    painted: &[PaintedPatch],
    packing: &Packing,
    padding: usize,
) -> image::RgbImage {
    let (w, h) = (packing.width, packing.height);
    let mut colours = vec![Vec3::ZERO; w * h];
    let mut known = vec![false; w * h];
    for ((patch, painted), &(x0, y0)) in patches.iter().zip(painted).zip(&packing.places) {
        for y in 0..patch.height + 2 * padding {
            for x in 0..patch.width + 2 * padding {
                // The border repeats the outermost texels.
                let column = x.saturating_sub(padding).min(patch.width - 1);
                let row = y.saturating_sub(padding).min(patch.height - 1);
                let i = (y0 + y) * w + x0 + x;
                colours[i] = painted.colours[row * patch.width + column];
                known[i] = true;
            }
        }
    }
    fill_gaps(&mut colours, &known, w, h);
    let bytes = colours
        .iter()
        .flat_map(Vec3::to_array)
        .map(|c| c.round().clamp(0.0, 255.0) as u8)
        .collect();
    image::RgbImage::from_raw(w as u32, h as u32, bytes).expect("three bytes a pixel")
}

/// Texture coordinates of the corners of a face.
fn coordinates(
    face: &FacePlane,
    patch: &TexturePatch,
    place: (usize, usize),
    packing: &Packing,
    padding: usize,
) -> Vec<Vec<[f32; 2]>> {
    let (x0, y0) = ((place.0 + padding) as f64, (place.1 + padding) as f64);
    let uv = |p: &nalgebra::Point2<f64>| {
        let t = patch.texel_of(p);
        [
            ((x0 + t.x) / packing.width as f64) as f32,
            ((y0 + t.y) / packing.height as f64) as f32,
        ]
    };
    face.flat
        .rings
        .iter()
        .map(|ring| ring.iter().map(uv).collect())
        .collect()
}
