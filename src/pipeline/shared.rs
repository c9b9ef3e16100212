//! What passes between the instances that share a run: views of the scene, results of earlier stages, and the
//! shares of a stage's maps. See [`crate::execution::shard`] for the order of things.

use nalgebra::Vector3;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::stage::Stage;
use super::{Outcome, Run};
use crate::camera::Camera;
use crate::execution::{Known, Task, share};
use crate::execution::{Listener, progress};
use crate::model::RoofModel;
use crate::objectspace::{PlaneCandidate, RectangleTrace};
use crate::params::Params;
use crate::planes::{HalfPlane, SweepTrace};
use crate::raster::Gray;
use crate::scene::{Scene, Survey, View};
use crate::terrain::Ground;

impl Stage {
    /// The maps of this stage that instances may share, in the order in which they are called.
    pub fn shared_maps(self) -> &'static [&'static str] {
        match self {
            Self::Segments | Self::Regions => &["views"],
            Self::Matches => &["heights", "pairs", "triples", "bundles"],
            Self::HalfPlanes => &["ground", "sides"],
            Self::Facets => &["planes"],
            Self::Directions => &["tiles"],
            Self::Clusters => &["clusters"],
            Self::Rectangles => &["planes", "behind"],
            Self::Lines | Self::Model => &[],
        }
    }

    /// Does this stage need colours of the views where it is shared, or grey values only?
    pub fn shares_colours(self) -> bool {
        matches!(self, Self::Segments | Self::Matches | Self::Regions)
    }
}

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
            warnings: Vec::new(),
            survey: Survey::default(),
        };
        Self::new(scene, params)
    }

    /// What a stage found, as far as shared maps of later stages need it; empty where none do, or it has not run.
    pub fn hand_over(&self, stage: Stage) -> Vec<u8> {
        let r = &self.results;
        match stage {
            Stage::Segments => packed(&r.segments),
            Stage::Lines => packed(&r.lines),
            Stage::HalfPlanes => {
                let half_planes = r.half_planes.as_ref().map(|found| &found.value);
                let found = half_planes.zip(r.ground.as_ref());
                found.map_or_else(Vec::new, |found| bytes_of(&found))
            }
            Stage::Regions => packed(&r.regions),
            Stage::Directions => packed(&r.directions),
            Stage::Clusters => packed(&r.clusters),
            // What facets are made of: the planes, not the buildings.
            Stage::Rectangles if self.includes(Stage::Facets) => {
                let found = r.rectangles.as_ref().map(|found| &found.trace);
                found.map_or_else(Vec::new, |t| bytes_of(&(&t.candidates, &t.chosen)))
            }
            Stage::Rectangles | Stage::Matches | Stage::Facets | Stage::Model => Vec::new(),
        }
    }

    /// Takes what a stage found in another instance, without its diary. False where the bytes are not that.
    pub fn take_over(&mut self, stage: Stage, bytes: &[u8]) -> bool {
        let r = &mut self.results;
        match stage {
            Stage::Segments => unpacked(&mut r.segments, bytes),
            Stage::Lines => unpacked(&mut r.lines, bytes),
            Stage::HalfPlanes => {
                let found: Option<(Vec<HalfPlane>, Ground)> = postcard::from_bytes(bytes).ok();
                let (half_planes, ground) = found.unzip();
                r.half_planes = half_planes.map(|value| (value, SweepTrace::default()).into());
                r.ground = ground;
                r.half_planes.is_some()
            }
            Stage::Regions => unpacked(&mut r.regions, bytes),
            Stage::Directions => unpacked(&mut r.directions, bytes),
            Stage::Clusters => unpacked(&mut r.clusters, bytes),
            Stage::Rectangles => {
                let found: Option<(Vec<PlaneCandidate>, Vec<usize>)> =
                    postcard::from_bytes(bytes).ok();
                r.rectangles = found.map(|(candidates, chosen)| {
                    let trace = RectangleTrace {
                        candidates,
                        chosen,
                        ..RectangleTrace::default()
                    };
                    (RoofModel::default(), trace).into()
                });
                r.rectangles.is_some()
            }
            Stage::Matches | Stage::Facets | Stage::Model => false,
        }
    }

    /// This instance's share of a map of a stage, with the results of the maps before it; the results of the stage
    /// itself and of later ones are dropped. Empty where an earlier stage is missing.
    pub fn share(
        &mut self,
        stage: Stage,
        task: Task,
        known: Known,
        progress: &Listener,
    ) -> Vec<u8> {
        if !self.is_ready(stage) {
            return Vec::new();
        }
        self.drop_from(stage);
        let bytes = progress::with_listener(Listener::clone(progress), || {
            share(task, known, || self.run_stage(stage))
        });
        self.drop_from(stage);
        bytes
    }

    /// Has the chosen method this stage?
    fn includes(&self, stage: Stage) -> bool {
        self.stages().contains(&stage)
    }

    /// Are the results there that a shared stage starts from?
    fn is_ready(&self, stage: Stage) -> bool {
        let r = &self.results;
        let has_lines = || r.segments.is_some() && r.lines.is_some();
        let has_rectangles = || r.rectangles.is_some() || !self.includes(Stage::Rectangles);
        match stage {
            Stage::Segments | Stage::Regions => true,
            Stage::Matches => r.segments.is_some(),
            Stage::HalfPlanes => r.lines.is_some(),
            Stage::Facets => has_lines() && r.half_planes.is_some() && has_rectangles(),
            Stage::Directions => r.regions.is_some(),
            Stage::Clusters => r.regions.is_some() && r.directions.is_some(),
            Stage::Rectangles => r.directions.is_some() && r.clusters.is_some(),
            Stage::Lines | Stage::Model => false,
        }
    }
}

fn packed<V: Serialize, T>(outcome: &Option<Outcome<V, T>>) -> Vec<u8> {
    (outcome.as_ref()).map_or_else(Vec::new, |o| bytes_of(&o.value))
}

fn bytes_of<V: Serialize>(value: &V) -> Vec<u8> {
    postcard::to_stdvec(value).expect("results can be written to memory")
}

fn unpacked<V: DeserializeOwned, T: Default>(to: &mut Option<Outcome<V, T>>, bytes: &[u8]) -> bool {
    let value: Option<V> = postcard::from_bytes(bytes).ok();
    *to = value.map(|value| Outcome {
        value,
        trace: T::default(),
    });
    to.is_some()
}
