//! What a reconstruction starts from: oriented views in one local frame.

use nalgebra::{Matrix3, Vector3};

use crate::adjust::ViewAdjustment;
use crate::camera::Camera;
use crate::doctor::{self, ViewShift};
use crate::ids::ViewId;
use crate::orientation::Anchor;
use crate::raster::{Channel, Gray, Warmth, noise_of};

/// One photograph with its orientation.
#[derive(Clone, Debug)]
pub struct View {
    /// The image's file name without its folder: how messages and outputs call the view.
    pub name: String,
    /// The camera, an exact pinhole (distortion is removed on loading).
    pub camera: Camera,
    /// Grey values, 0 to 1, of the camera's size.
    pub gray: Gray,
    /// Colours for textures, of the camera's size.
    pub rgb: image::RgbImage,
    /// Standard deviation of the noise of one pixel of `gray`.
    pub noise: f64,
    /// The warmth of the colours, of the camera's size; `None` for a photograph without colour.
    pub warmth: Option<Warmth>,
}

impl View {
    /// A view, whose noise is measured.
    pub fn new(name: String, camera: Camera, gray: Gray, rgb: image::RgbImage) -> Self {
        let (noise, warmth) = (noise_of(&gray), Warmth::of(&rgb));
        Self {
            name,
            camera,
            gray,
            rgb,
            noise,
            warmth,
        }
    }

    /// A channel of the view, and the standard deviation of the noise of one of its pixels. Grey values stand for a
    /// warmth that is not there.
    pub fn channel(&self, channel: Channel) -> (&Gray, f64) {
        match (&self.warmth, channel) {
            (Some(warmth), Channel::Warmth) => (&warmth.image, warmth.noise),
            _ => (&self.gray, self.noise),
        }
    }
}

/// What the files and the images say about the world and about the orientation, beyond the cameras.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// EPSG's number of the world's reference system, where it is known.
    pub epsg: Option<u32>,
    /// Where on the Earth the world's zero lies, for a world of x east, y north, z up.
    pub anchor: Option<Anchor>,
    /// How far each view is shifted against the others, where the images show enough to tell.
    pub shifts: Vec<ViewShift>,
    /// How each view was adjusted to its matched lines; empty where nobody asked for it.
    pub adjustments: Vec<ViewAdjustment>,
    /// How well the images agree with the orientation that is used; `None` where nobody asked them.
    pub doctor: Option<doctor::Report>,
}

/// Oriented views and what is known about the ground.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The views, sorted by name.
    pub views: Vec<View>,
    /// Scene origin, metres: add it to local coordinates for the input's world frame.
    pub origin: Vector3<f64>,
    /// Height of the ground in the local frame, metres, when the user gave it.
    pub ground_z: Option<f64>,
    /// What the readers had to say (duplicate orientation, ignored files, ...).
    pub warnings: Vec<String>,
    /// Reference system and quality of the orientation.
    pub survey: Survey,
}

impl Survey {
    /// What the coordinates of the results are, in words; `None` where the files do not say.
    pub fn describe(&self) -> Option<String> {
        let of_anchor = |a: &Anchor| {
            let Anchor {
                lon_deg,
                lat_deg,
                height_m,
            } = a;
            format!(
                "east, north, up from longitude {lon_deg}, latitude {lat_deg}, ellipsoidal height {height_m} m (WGS84)"
            )
        };
        let of_epsg = self.epsg.map(|epsg| format!("EPSG:{epsg}"));
        of_epsg.or_else(|| self.anchor.as_ref().map(of_anchor))
    }
}

impl Scene {
    /// The view with this id.
    pub fn view(&self, id: ViewId) -> &View {
        &self.views[id.index()]
    }

    /// The camera of a view.
    pub fn camera(&self, id: ViewId) -> &Camera {
        &self.views[id.index()].camera
    }

    /// The same scene with the grey images reduced by a whole factor (mean of each block); without colours.
    pub fn reduced(&self, factor: usize) -> Scene {
        let scale = 1.0 / factor as f64;
        let views = self.views.iter().map(|v| {
            let gray = v.gray.reduced(factor);
            let k = Matrix3::new(scale, 0.0, 0.0, 0.0, scale, 0.0, 0.0, 0.0, 1.0) * v.camera.k;
            let camera = Camera {
                k,
                width: gray.width as u32,
                height: gray.height as u32,
                ..v.camera.clone()
            };
            View::new(v.name.clone(), camera, gray, image::RgbImage::new(0, 0))
        });
        Scene {
            views: views.collect(),
            origin: self.origin,
            ground_z: self.ground_z,
            warnings: Vec::new(),
            survey: Survey::default(),
        }
    }

    /// All view ids in order.
    pub fn view_ids(&self) -> impl Iterator<Item = ViewId> + use<> {
        (0..self.views.len()).map(ViewId::from_index)
    }
}
