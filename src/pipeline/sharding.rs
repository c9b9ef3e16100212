//! What passes between the instances that divide a run between them: views of the scene, results of
//! earlier stages, and the shards of a stage's maps. See [`crate::base::execution::shard`] for the
//! order of things.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Run, Stage};
use crate::base::execution::{Listener, progress};
use crate::base::execution::{MergedShards, Origin, ShardTask, run_shard};
use crate::base::params::Params;
use crate::orienting::scene::{Scene, View};
use crate::photographs::camera::Camera;
use crate::photographs::raster::Gray;

/// A view with what every instance must know of its scene.
#[derive(Debug, Serialize, Deserialize)]
pub struct PackedView {
    origin: Vector3<f64>,
    ground_z: Option<f64>,
    name: String,
    camera: Camera,
    gray: Vec<f32>,
    /// Empty where colours are not needed.
    rgb: Vec<u8>,
}

impl PackedView {
    /// Packs a view of a scene; `None` where there is no such view.
    pub fn new(scene: &Scene, view: usize, with_colours: bool) -> Option<Self> {
        let view = scene.views.get(view)?;
        let rgb = match with_colours {
            true => view.rgb.as_raw().clone(),
            false => Vec::new(),
        };
        Some(Self {
            origin: scene.origin,
            ground_z: scene.ground_z,
            name: view.name.clone(),
            camera: view.camera.clone(),
            gray: view.gray.data.clone(),
            rgb,
        })
    }

    /// As bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        postcard::to_stdvec(self).expect("bytes can be written to memory")
    }

    /// From bytes; `None` where they are not those of a packed view.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        postcard::from_bytes(bytes).ok()
    }

    fn unpack(self) -> View {
        let (width, height) = (self.camera.width, self.camera.height);
        let rgb = image::RgbImage::from_raw(width, height, self.rgb);
        let gray = Gray {
            width: width as usize,
            height: height as usize,
            data: self.gray,
        };
        View::new(self.name, self.camera, gray, rgb.unwrap_or_default())
    }
}

impl Run {
    /// A run on views that another instance packed, in their order.
    pub fn of_packed(views: Vec<PackedView>, params: Params) -> Self {
        let first = views.first();
        let scene = Scene {
            origin: first.map(|v| v.origin).unwrap_or_default(),
            ground_z: first.and_then(|v| v.ground_z),
            views: views.into_iter().map(PackedView::unpack).collect(),
            // Lines outside of the region are left out by the instance that runs the stage, before
            // any shard, and what is known is weighed there too.
            ..Scene::default()
        };
        Self::new(scene, params)
    }

    /// The cameras, for [`Self::take_cameras`] of the other instances before each stage: the
    /// adjustment and other parameters move them.
    pub fn pack_cameras(&self) -> Vec<u8> {
        let cameras: Vec<&Camera> = self.scene.views.iter().map(|v| &v.camera).collect();
        postcard::to_stdvec(&cameras).expect("bytes can be written to memory")
    }

    /// Takes the cameras of another instance. False where the bytes are not that, or of another
    /// scene.
    pub fn take_cameras(&mut self, bytes: &[u8]) -> bool {
        let cameras: Option<Vec<Camera>> = postcard::from_bytes(bytes).ok();
        let Some(cameras) = cameras.filter(|c| c.len() == self.scene.views.len()) else {
            return false;
        };
        for (view, camera) in self.scene.views.iter_mut().zip(cameras) {
            view.camera = camera;
        }
        true
    }

    /// What a stage found, as far as sharded maps of later stages read it; empty where none do, or
    /// it has not run.
    pub fn hand_over(&self, stage: Stage) -> Vec<u8> {
        let packed = || (stage.row().pack)(&self.results);
        let is_read = self.stages().into_iter().any(|later| {
            let needs = later.needs(self.params.sources());
            !later.shard_maps().is_empty() && needs.contains(&stage)
        });
        is_read.then(packed).flatten().unwrap_or_default()
    }

    /// Takes what a stage found in another instance, without its trace. False where the bytes are
    /// not that.
    pub fn take_over(&mut self, stage: Stage, bytes: &[u8]) -> bool {
        (stage.row().unpack)(&mut self.results, bytes)
    }

    /// The shard of instance `index` of so many of a map of a stage, with the merged results of the
    /// maps before it; the results of the stage itself and of later ones are dropped. Empty where
    /// there is no such map or instance, or an earlier stage is missing.
    pub fn run_shard(
        &mut self,
        stage: Stage,
        map: &str,
        [index, of]: [usize; 2],
        merged: MergedShards,
        progress: &Listener,
    ) -> Vec<u8> {
        let task = ShardTask::new(stage.shard_maps(), map, index, of);
        let needs = stage.needs(self.params.sources());
        let is_ready = (needs.iter()).all(|needed| (needed.row().is_found)(&self.results));
        let Some(task) = task.filter(|_| is_ready) else {
            return Vec::new();
        };
        self.drop_from(stage);
        let origin = self.shards_origin(stage);
        let bytes = progress::with_listener(Listener::clone(progress), || {
            run_shard(task, origin, merged, || self.run_stage(stage))
        });
        self.drop_from(stage);
        bytes
    }

    /// What the shards of a stage are made of: instances whose scenes or parameters differ do not
    /// share.
    pub(super) fn shards_origin(&self, stage: Stage) -> Origin {
        let scene = &self.scene;
        let views: Vec<(&str, &Camera)> = (scene.views.iter())
            .map(|view| (view.name.as_str(), &view.camera))
            .collect();
        let params = super::as_json(&self.params).to_string();
        let of = (
            stage.name(),
            scene.origin.as_slice(),
            scene.ground_z,
            views,
            params,
        );
        Origin::of(&postcard::to_stdvec(&of).expect("bytes can be written to memory"))
    }
}
