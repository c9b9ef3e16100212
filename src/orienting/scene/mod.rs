//! What a reconstruction starts from: oriented views in one local frame.

mod excess_green;
mod survey;

pub(crate) use excess_green::excess_green;
pub use survey::{Survey, ViewAdjustment, ViewShift};

use nalgebra::{Matrix3, Point3, Vector3};

use crate::base::ids::ViewId;
use crate::orienting::known::Known;
use crate::photographs::camera::Camera;
use crate::photographs::raster::{
    Channel, Gray, RedBlueDifference, colours_of_blocks, estimate_noise,
};

/// One photograph with its orientation.
#[derive(Clone, Debug)]
pub struct View {
    /// The image's file name without its folder, which messages and outputs use.
    pub name: String,
    /// The camera, an exact pinhole (distortion is removed on loading).
    pub camera: Camera,
    /// Grey values, 0 to 1, of the camera's size.
    pub gray: Gray,
    /// Colours for textures, of the camera's size.
    pub rgb: image::RgbImage,
    /// Standard deviation of the noise of one pixel of `gray`.
    pub noise: f64,
    /// Red less blue, of the camera's size; `None` for a photograph without colour.
    pub red_blue: Option<RedBlueDifference>,
}

impl View {
    /// A view, whose noise is measured.
    pub fn new(name: String, camera: Camera, gray: Gray, rgb: image::RgbImage) -> Self {
        let (noise, red_blue) = (estimate_noise(&gray), RedBlueDifference::of(&rgb));
        Self {
            name,
            camera,
            gray,
            rgb,
            noise,
            red_blue,
        }
    }

    /// A channel of the view, and the standard deviation of the noise of one of its pixels. Grey
    /// values replace a missing red-blue difference.
    pub fn channel(&self, channel: Channel) -> (&Gray, f64) {
        match (&self.red_blue, channel) {
            (Some(red_blue), Channel::RedBlue) => (&red_blue.image, red_blue.noise),
            _ => (&self.gray, self.noise),
        }
    }
}

/// Oriented views, the ground and the reference system.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The views, sorted by name.
    pub views: Vec<View>,
    /// Scene origin, metres: add it to local coordinates for the input's world frame.
    pub origin: Vector3<f64>,
    /// Height of the ground in the local frame, metres, when the user gave it.
    pub ground_z: Option<f64>,
    /// Region of interest in plan, x0, y0, x1, y1, metres, local frame: what lies outside is not
    /// searched.
    pub region: Option<[f64; 4]>,
    /// Terrain and footprints that are known beforehand.
    pub known: Known,
    /// Warnings of the readers (duplicate orientation, ignored files, ...).
    pub warnings: Vec<String>,
    /// Reference system and quality of the orientation.
    pub survey: Survey,
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

    /// The same scene with the grey images reduced by a whole factor (mean of each block); without
    /// colours.
    pub fn reduced(&self, factor: usize) -> Scene {
        self.reduced_with(factor, |_| image::RgbImage::new(0, 0))
    }

    /// The same with colours.
    pub fn reduced_in_colour(&self, factor: usize) -> Scene {
        self.reduced_with(factor, |view| colours_of_blocks(&view.rgb, factor as u32))
    }

    fn reduced_with(&self, factor: usize, rgb: impl Fn(&View) -> image::RgbImage) -> Scene {
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
            View::new(v.name.clone(), camera, gray, rgb(v))
        });
        Scene {
            views: views.collect(),
            origin: self.origin,
            ground_z: self.ground_z,
            region: self.region,
            ..Scene::default()
        }
    }

    /// Median over the views of the size of a pixel at a place, metres; `None` without views.
    pub(crate) fn median_ground_pixel(&self, place: &Point3<f64>) -> Option<f64> {
        let of_view = |v: &View| v.camera.ground_pixel(place);
        let mut pixels: Vec<f64> = self.views.iter().map(of_view).collect();
        crate::base::math::median(&mut pixels)
    }

    /// All view ids in order.
    pub fn view_ids(&self) -> impl Iterator<Item = ViewId> + use<> {
        (0..self.views.len()).map(ViewId::from_index)
    }
}
