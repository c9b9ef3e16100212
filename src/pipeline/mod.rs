//! The order of the stages, and what each of them left: the command line, the wasm session and the
//! tests all run a reconstruction through [`Run`].
//!
//! ```text
//! B99:  Scene -> segments -> matches -> lines -> halfplanes -> facets -> model -> files
//! W96:  Scene -> regions -> directions -> clusters -> rectangles      -> model -> files
//! both: Scene -> those of W96, then those of B99, which take in its lines and planes
//! ```
//!
//! Invariant: no geometry here. Invariant: a result in a [`Run`] always belongs to the current
//! parameters and to the current results before it; what is out of date is dropped, never shown.

mod adjustment;
mod report;
mod shared;
mod stage;
mod summary;

pub use adjustment::{adjust_orientation, load_adjusted};
pub use shared::PackedView;
pub use stage::Stage;
pub use summary::StageSummary;

use std::borrow::Cow;

use crate::buildings::{RoofTrace, verify_lines, reconstruct_roofs};
use crate::execution::{Known, map_shared, with_known};
use crate::execution::{Listener, progress};
use crate::export;
use crate::export::export_all;
use crate::facets::FacetInput;
use crate::linematch::{MatchTrace, match_lines};
use crate::lines2d::{ImageSegment, SegmentTrace, detect_segments};
use crate::lines3d::LineTrack;
use crate::lines3d::{Line3d, LineTrace, reconstruct_lines};
use crate::model::RoofModel;
use crate::objectspace::ClusterTrace;
use crate::objectspace::{
    FoundLine, RectangleTrace, Window, WindowTrace, adopted_lines, find_clusters, find_directions,
    find_rectangles, find_regions, image_segments, proposed_planes, world_lines,
};
use crate::objectspace::{RegionLine, Segmentation};
use crate::params::{Method, Params};
use crate::planes::{HalfPlane, SweepTrace, sweep_half_planes};
use crate::scene::Scene;
use crate::terrain::Ground;
use crate::texture::{TextureTrace, TexturedModel, texture_model};

/// What a stage found, and its diary.
#[derive(Clone, Debug)]
pub struct Outcome<V, T> {
    /// The result.
    pub value: V,
    /// How it came about, and why other things were refused.
    pub trace: T,
}

impl<V, T> From<(V, T)> for Outcome<V, T> {
    fn from((value, trace): (V, T)) -> Self {
        Self { value, trace }
    }
}

/// The results of the stages; `None` for what has not run.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// Segments of each view, in the order of the views.
    pub segments: Option<Outcome<Vec<Vec<ImageSegment>>, Vec<SegmentTrace>>>,
    /// Matches.
    pub matches: Option<Outcome<Vec<LineTrack>, MatchTrace>>,
    /// 3D lines.
    pub lines: Option<Outcome<Vec<Line3d>, LineTrace>>,
    /// The ground, which comes before half-planes.
    pub ground: Option<Ground>,
    /// Half-planes.
    pub half_planes: Option<Outcome<Vec<HalfPlane>, SweepTrace>>,
    /// Facets and buildings.
    pub roof: Option<Outcome<RoofModel, RoofTrace>>,
    /// W96: lines on the boundaries of the regions of each view, in the order of the views.
    pub regions: Option<Outcome<Vec<Vec<RegionLine>>, Vec<Segmentation>>>,
    /// W96: windows with their main directions.
    pub directions: Option<Outcome<Vec<Window>, WindowTrace>>,
    /// W96: 3D lines; a trace for each window and direction.
    pub clusters: Option<Outcome<Vec<FoundLine>, Vec<ClusterTrace>>>,
    /// W96: planes and buildings.
    pub rectangles: Option<Outcome<RoofModel, RectangleTrace>>,
    /// Textures of the model.
    pub textured: Option<Outcome<TexturedModel, TextureTrace>>,
}

impl Results {
    /// The roof model of whichever method ran; of both, that to which both came.
    pub fn model(&self) -> Option<&RoofModel> {
        let lines = self.roof.as_ref().map(|r| &r.value);
        lines.or(self.rectangles.as_ref().map(|r| &r.value))
    }

    /// The 3D lines of B99, by their ids (matched ones, then those adopted of W96), and then the new lines of the model, which
    /// says of each whether it stands.
    pub fn all_lines(&self) -> Option<Vec<Line3d>> {
        let mut lines = self.lines.as_ref()?.value.clone();
        let trace = &self.roof.as_ref()?.trace;
        lines.extend_from_slice(&trace.new_lines);
        for (line, why) in &trace.refuted_lines {
            lines[line.index()].refuted = Some(*why);
        }
        Some(lines)
    }
}

/// One reconstruction: a scene, the parameters, and the results so far.
#[derive(Clone, Debug)]
pub struct Run {
    scene: Scene,
    params: Params,
    results: Results,
    summaries: Vec<StageSummary>,
}

impl Run {
    /// A run of which no stage has been done.
    pub fn new(scene: Scene, params: Params) -> Self {
        Self {
            scene,
            params,
            results: Results::default(),
            summaries: Vec::new(),
        }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The parameters.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// The results so far.
    pub fn results(&self) -> &Results {
        &self.results
    }

    /// What the stages so far had to say, in their order.
    pub fn summaries(&self) -> &[StageSummary] {
        &self.summaries
    }

    /// The stages of the chosen method, in their order.
    pub fn stages(&self) -> &'static [Stage] {
        Stage::of(self.params.method)
    }

    /// Changes the parameters and drops the results that they would change.
    pub fn set_params(&mut self, params: Params) {
        let changed = |stage: &&Stage| depends(**stage, &self.params, &params);
        let first = match params.method == self.params.method {
            true => self.stages().iter().find(changed),
            // Another method leaves nothing of the results.
            false => Stage::ALL.first(),
        };
        let first = first.copied();
        self.params = params;
        if let Some(stage) = first {
            self.drop_from(stage);
        }
    }

    /// Runs one stage, after those before it that have not run yet, and drops the results of those behind
    /// it. `progress` hears fractions of this stage's work from 0 to 1.
    pub fn step(&mut self, stage: Stage, progress: &Listener) -> StageSummary {
        self.step_with(stage, Known::default(), progress)
    }

    /// [`Self::step`], where other instances have done the stage's shared maps ([`Stage::shared_maps`]).
    pub fn step_with(&mut self, stage: Stage, known: Known, progress: &Listener) -> StageSummary {
        for &earlier in self.stages().iter().filter(|&&s| s < stage) {
            if !self.has(earlier) {
                self.run_stage(earlier);
            }
        }
        self.drop_from(stage);
        progress(0.0);
        progress::with_listener(Listener::clone(progress), || {
            with_known(known, || self.run_stage(stage));
        });
        progress(1.0);
        self.summaries.last().expect("just pushed").clone()
    }

    /// Runs all stages, with nobody listening.
    pub fn run_all(&mut self) {
        for &stage in self.stages() {
            self.step(stage, &progress::silent());
        }
    }

    /// Has this stage run?
    pub fn has(&self, stage: Stage) -> bool {
        self.summaries.iter().any(|summary| summary.stage == stage)
    }

    /// The files of a finished run, as (name, bytes): what the command line writes and the page offers.
    /// `seconds` per stage go into `report.json`, in a part of their own, since they alone differ from
    /// run to run. Empty before the last stage has run.
    pub fn files(&self, seconds: &[(Stage, f64)]) -> Vec<(String, Vec<u8>)> {
        let Some(outputs) = self.outputs() else {
            return Vec::new();
        };
        let borrowed = export::ExportInput {
            scene: &self.scene,
            segments: &outputs.segments,
            lines: &outputs.lines,
            half_planes: outputs.half_planes,
            model: outputs.model,
            textured: outputs.textured,
        };
        let mut files = export_all(&borrowed, &self.params.texture);
        files.push(("report.json".into(), report::report(self, seconds)));
        files
    }

    /// What goes into the files; `None` before the last stage has run.
    fn outputs(&self) -> Option<Outputs<'_>> {
        let r = &self.results;
        let (model, textured) = (r.model()?, &r.textured.as_ref()?.value);
        Some(match self.params.method {
            Method::Lines | Method::Combined => Outputs {
                segments: Cow::Borrowed(&r.segments.as_ref()?.value),
                lines: Cow::Owned(r.all_lines()?),
                half_planes: &r.half_planes.as_ref()?.value,
                model,
                textured,
            },
            Method::Rectangles => {
                let lines = &r.regions.as_ref()?.value;
                let found = &r.clusters.as_ref()?.value;
                Outputs {
                    segments: Cow::Owned(image_segments(lines)),
                    lines: Cow::Owned(world_lines(&self.scene, lines, found)),
                    half_planes: &[],
                    model,
                    textured,
                }
            }
        })
    }

    fn run_stage(&mut self, stage: Stage) {
        let (scene, params, r) = (&self.scene, &self.params, &mut self.results);
        match stage {
            Stage::Segments => {
                let per_view = map_shared("views", &scene.views, 0.0..1.0, |_, view| {
                    detect_segments(&view.gray, view.red_blue.as_ref(), &params.segments)
                });
                let (value, trace) = per_view.into_iter().unzip();
                r.segments = Some(Outcome { value, trace });
            }
            Stage::Matches => {
                let segments = before(&r.segments);
                let found = match_lines(scene, segments, &params.matching, &params.lines3d);
                r.matches = Some(found.into());
            }
            Stage::Lines => {
                let matches = before(&r.matches);
                let (mut lines, trace) = reconstruct_lines(scene, matches, &params.lines3d);
                if let (Some(regions), Some(found)) = (&r.regions, &r.clusters) {
                    let (regions, found) = (&regions.value, &found.value);
                    let clusters = &params.objectspace.clusters;
                    lines.extend(adopted_lines(scene, regions, found, &lines, clusters));
                }
                r.lines = Some((lines, trace).into());
            }
            Stage::HalfPlanes => {
                let lines = before(&r.lines);
                let ground = Ground::estimate(scene, lines);
                let found = sweep_half_planes(scene, lines, &ground, &params.sweep);
                r.ground = Some(ground);
                r.half_planes = Some(found.into());
            }
            Stage::Facets => {
                let segments = before(&r.segments);
                let (lines, half_planes) = (before(&r.lines), before(&r.half_planes));
                let rectangles = r.rectangles.as_ref();
                let rectangles =
                    rectangles.map_or_else(Vec::new, |found| proposed_planes(&found.trace));
                let evidence = FacetInput {
                    segments,
                    lines,
                    half_planes,
                    ground: r.ground.as_ref().expect("found with half-planes"),
                    rectangles: &rectangles,
                };
                let (model, mut trace) = reconstruct_roofs(scene, &evidence, &params.roof);
                let (new_lines, refuted) =
                    verify_lines(scene, lines, &model, evidence.ground, params);
                (trace.new_lines, trace.refuted_lines) = (new_lines, refuted);
                r.roof = Some((model, trace).into());
            }
            Stage::Regions => r.regions = Some(find_regions(scene, &params.objectspace).into()),
            Stage::Directions => {
                let lines = before(&r.regions);
                r.directions = Some(find_directions(scene, lines, &params.objectspace).into());
            }
            Stage::Clusters => {
                let (lines, windows) = (before(&r.regions), before(&r.directions));
                let found = find_clusters(scene, lines, windows, &params.objectspace);
                r.clusters = Some(found.into());
            }
            Stage::Rectangles => {
                let (lines, windows) = (before(&r.regions), before(&r.directions));
                let clusters = before(&r.clusters);
                let found = find_rectangles(scene, lines, windows, clusters, &params.objectspace);
                r.rectangles = Some(found.into());
            }
            Stage::Model => {
                let model = r.model().expect("stages run in their order");
                r.textured = Some(texture_model(scene, model, &params.texture).into());
            }
        }
        self.summaries
            .push(summary::summarise(stage, &self.scene, &self.results));
    }

    fn drop_from(&mut self, stage: Stage) {
        self.summaries.retain(|summary| summary.stage < stage);
        let r = &mut self.results;
        for later in Stage::ALL.into_iter().filter(|&s| s >= stage) {
            match later {
                Stage::Segments => r.segments = None,
                Stage::Matches => r.matches = None,
                Stage::Lines => r.lines = None,
                Stage::HalfPlanes => (r.ground, r.half_planes) = (None, None),
                Stage::Facets => r.roof = None,
                Stage::Regions => r.regions = None,
                Stage::Directions => r.directions = None,
                Stage::Clusters => r.clusters = None,
                Stage::Rectangles => r.rectangles = None,
                Stage::Model => r.textured = None,
            }
        }
    }
}

/// What goes into the files.
struct Outputs<'a> {
    segments: Cow<'a, [Vec<ImageSegment>]>,
    lines: Cow<'a, [Line3d]>,
    half_planes: &'a [HalfPlane],
    model: &'a RoofModel,
    textured: &'a TexturedModel,
}

/// The result of an earlier stage.
fn before<V, T>(outcome: &Option<Outcome<V, T>>) -> &V {
    &outcome.as_ref().expect("stages run in their order").value
}

/// Do the two sets of parameters differ in what this stage reads?
fn depends(stage: Stage, a: &Params, b: &Params) -> bool {
    match stage {
        Stage::Segments => a.segments != b.segments,
        // Matching fits 3D lines too, to tell which segments agree.
        Stage::Matches => a.matching != b.matching || a.lines3d != b.lines3d,
        Stage::Lines => a.lines3d != b.lines3d,
        Stage::HalfPlanes => a.sweep != b.sweep,
        Stage::Facets => a.roof != b.roof,
        Stage::Regions => a.objectspace.oris != b.objectspace.oris,
        // Windows are found with clusters and the ground, too.
        Stage::Directions => {
            let (a, b) = (&a.objectspace, &b.objectspace);
            a.windows != b.windows
                || a.directions != b.directions
                || a.clusters != b.clusters
                || a.planes.min_height_m != b.planes.min_height_m
        }
        Stage::Clusters => a.objectspace.clusters != b.objectspace.clusters,
        Stage::Rectangles => a.objectspace.planes != b.objectspace.planes,
        Stage::Model => a.texture != b.texture,
    }
}
