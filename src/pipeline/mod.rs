//! The order of the stages, and what each of them left: the command line, the wasm session and the
//! tests all run a reconstruction through [`Run`].
//!
//! ```text
//! B99:  segments -> matches -> adjustment -> lines -> ground -> sources of planes -> groups
//!                      ^           |   -> facets -> refinement -> corrections -> model
//!                      +-----------+ where views moved
//! W96:  regions -> directions -> clusters -> ground -> rectangles -> corrections -> model
//! both: segments to adjustment, those of W96 up to the clusters, lines and ground of both, then
//!       the planes of each
//! ```
//!
//! `stages` has a file for each of them, and how to add one; `sharding` is what passes between
//! instances that divide a stage; `report` and `summary` are what people read; `adjustment` keeps
//! the cameras; `preliminary` is a first look at the model.
//!
//! Invariant: no geometry here. Invariant: a result in a [`Run`] always belongs to the current
//! parameters and to the current results before it; what is out of date is dropped, never shown.

mod adjustment;
#[cfg(test)]
mod changed_params;
#[cfg(test)]
mod page_table;
mod preliminary;
mod report;
mod sharding;
mod stages;
mod summary;

pub use crate::lines::adjustment::AdjustmentRound;
pub use sharding::PackedView;
pub use stages::{Outcome, Results, Stage};
pub use summary::{StageSummary, counted};

use std::borrow::Cow;

use serde_json::Value;

use crate::base::evidence::{Candidates, Evidence, JudgedLine};
use crate::base::execution::{Listener, progress};
use crate::base::execution::{MergedShards, Sharded, run_merged};
use crate::base::params::Params;
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::{Line3d, LineOutcome};
use crate::orienting::scene::Scene;
use crate::photographs::camera::Camera;
use crate::planes::half_planes::HalfPlane;
use crate::planes::objectspace::{image_segments, world_lines};
use crate::planes::terrain::Ground;
use crate::results::export;
use crate::results::export::{ReportedModel, corrected_file, export_all};
use crate::results::texture::TexturedModel;
use crate::roofs::buildings::{OtherGround, RefinementTrace, other_ground};
use crate::roofs::model::{BuildingWalls, RoofModel};

/// Segments of all views, and 3D lines.
pub type SegmentsAndLines<'a> = (Cow<'a, [Vec<ImageSegment>]>, Cow<'a, [Line3d]>);

impl Results {
    /// The roof model, with what was corrected by hand, once that stage has run.
    pub fn roof_model(&self) -> Option<&RoofModel> {
        let corrected = self.corrections.as_ref().map(|r| &r.value);
        corrected.or_else(|| self.found_model())
    }

    /// The roof model before corrections by hand, as far as it has been refined.
    pub fn found_model(&self) -> Option<&RoofModel> {
        let refined = self.refinement.as_ref().map(|r| &r.value);
        let lines = refined.or(self.facets.as_ref().map(|r| &r.value));
        lines.or(self.rectangles.as_ref().map(|r| &r.value))
    }

    /// The buildings that do not stand on the ground of the terrain model that counted.
    fn other_ground(&self, scene: &Scene) -> Vec<OtherGround> {
        let model = self.roof_model().zip(self.ground.as_ref());
        let known = model.zip(scene.known.terrain.as_ref());
        known.map_or_else(Vec::new, |((model, ground), terrain)| {
            other_ground(model, ground, terrain)
        })
    }

    /// What speaks for each matched line, and against it, as its views show it: in the order of
    /// the lines.
    pub fn evidence_of_matches(&self) -> Vec<&Evidence> {
        let matches = self.matches.iter().flat_map(|found| &found.value);
        let outcomes = self.lines.iter().flat_map(|found| &found.trace.outcomes);
        let is_line = |outcome: &LineOutcome| matches!(outcome, LineOutcome::Reconstructed { .. });
        let reconstructed = matches
            .zip(outcomes)
            .filter(|(_, outcome)| is_line(outcome));
        reconstructed.map(|(track, _)| &track.evidence).collect()
    }

    /// What the model says of each line, in the order of [`Self::all_lines`]; none before it is
    /// refined.
    pub fn evidence_in_model(&self) -> &[Evidence] {
        let refined = self.refinement.as_ref();
        refined.map_or(&[], |found| &found.trace.lines.evidence)
    }

    /// Everything that was weighed.
    pub fn candidates(&self) -> Candidates {
        let facets = self.facets.as_ref();
        let in_model = self.evidence_in_model();
        let all = self.all_lines().unwrap_or_default();
        let judged = |(line, evidence): (&Line3d, &Evidence)| JudgedLine {
            segment: line.segment,
            evidence: evidence.clone(),
        };
        let matched = self.lines.iter().flat_map(|found| &found.value);
        Candidates {
            lines: (matched.zip(self.evidence_of_matches()).map(judged)).collect(),
            model_lines: all.iter().zip(in_model).map(judged).collect(),
            facets: facets.map_or_else(Vec::new, |found| found.trace.facets.judged.clone()),
            obstructions: (self.refinement.as_ref())
                .map_or_else(Vec::new, |found| found.trace.obstructions.clone()),
            rectangles: (self.rectangles.as_ref())
                .map_or_else(Vec::new, |found| found.trace.judged()),
            surfaces: (self.dense.as_ref())
                .map_or_else(Vec::new, |found| found.trace.judged(&found.value)),
        }
    }

    /// The segments of all views and the 3D lines that go into the files: those that were matched
    /// over the views, those of regions where none were.
    pub fn segments_and_lines(&self, scene: &Scene) -> Option<SegmentsAndLines<'_>> {
        if let (Some(segments), Some(lines)) = (&self.segments, &self.lines) {
            // Without facets nothing contradicts them.
            let all = self
                .all_lines()
                .map_or(Cow::Borrowed(&lines.value[..]), Cow::Owned);
            return Some((Cow::Borrowed(&segments.value), all));
        }
        let (regions, clusters) = (
            &self.regions.as_ref()?.value,
            &self.clusters.as_ref()?.value,
        );
        let lines = world_lines(scene, regions, clusters);
        Some((Cow::Owned(image_segments(regions)), Cow::Owned(lines)))
    }

    /// The 3D lines of B99, by their ids (matched ones, then those adopted of W96), and then the
    /// new lines of the model, which says of each whether it stands.
    pub fn all_lines(&self) -> Option<Vec<Line3d>> {
        let mut lines = self.lines.as_ref()?.value.clone();
        let verified = &self.refinement.as_ref()?.trace.lines;
        lines.extend_from_slice(&verified.new_lines);
        for (line, evidence) in lines.iter_mut().zip(&verified.evidence) {
            line.probability = evidence.probability();
        }
        for (line, why) in &verified.contradicted {
            lines[line.index()].contradiction = Some(*why);
        }
        Some(lines)
    }
}

/// One reconstruction: a scene, the parameters, and the results so far.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its cameras are those that the results so far belong to.
    scene: Scene,
    /// The cameras as the scene came with them.
    stated: Vec<Camera>,
    params: Params,
    results: Results,
    summaries: Vec<StageSummary>,
    /// The CityJSON file whose model takes the place of what photographs show.
    opened: Option<Vec<u8>>,
}

/// Files of what was found in photographs, and those that would say less of an opened model than
/// its own file.
const OF_PHOTOGRAPHS: [&str; 6] = [
    "model.city.jsonl",
    "lines.csv",
    "lines.json",
    "segments.json",
    "halfplanes.json",
    "evidence.json",
];

impl Run {
    /// A run of which no stage has been done.
    pub fn new(scene: Scene, params: Params) -> Self {
        let mut run = Self {
            stated: scene.views.iter().map(|v| v.camera.clone()).collect(),
            scene,
            params,
            results: Results::default(),
            summaries: Vec::new(),
            opened: None,
        };
        run.restore_cameras();
        run
    }

    /// A run on the model of a CityJSON file, without photographs: it is corrected, and written.
    ///
    /// # Errors
    /// Where the file cannot be read, with what was expected and where.
    pub fn of_model(city_json: Vec<u8>, params: Params) -> std::result::Result<Self, String> {
        let read = ReportedModel::read(&city_json)?;
        let mut run = Self::new(read.scene(), params);
        run.results.refinement = Some((read.model().clone(), RefinementTrace::default()).into());
        run.opened = Some(city_json);
        Ok(run)
    }

    /// The scene, its views adjusted as far as the stages have run.
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

    /// The stages that the chosen sources of planes need, in their order.
    pub fn stages(&self) -> Vec<Stage> {
        match self.opened.is_some() {
            true => Stage::WITHOUT_VIEWS.into(),
            false => Stage::of(self.params.sources()),
        }
    }

    /// Changes the parameters and drops the results that they would change.
    pub fn set_params(&mut self, params: Params) {
        let first = if params.sources() == self.params.sources() || self.opened.is_some() {
            let (old, new) = (as_json(&self.params), as_json(&params));
            let reads_change = |stage: &Stage| {
                let mut paths = stage.reads().iter();
                paths.any(|path| at_path(&old, path) != at_path(&new, path))
            };
            self.stages().into_iter().find(reads_change)
        } else {
            // Other sources leave nothing of the results.
            Stage::ALL.first().copied()
        };
        self.params = params;
        if let Some(stage) = first {
            self.drop_from(stage);
            if stage <= Stage::Adjustment {
                self.restore_cameras();
            }
        }
    }

    /// Runs one stage, after those before it that have not run yet, and drops the results of those
    /// behind it. `progress` hears fractions of this stage's work from 0 to 1.
    pub fn step(&mut self, stage: Stage, progress: &Listener) -> StageSummary {
        self.step_merged(stage, MergedShards::default(), progress)
    }

    /// [`Self::step`], where instances have divided the stage's maps ([`Stage::shard_maps`])
    /// between them.
    pub fn step_merged(
        &mut self,
        stage: Stage,
        merged: MergedShards,
        progress: &Listener,
    ) -> StageSummary {
        let mut summary = self.step_once(stage, merged, progress);
        while !self.has(stage) {
            summary = self.step_once(stage, MergedShards::default(), progress);
        }
        summary
    }

    /// One round of the adjustment, as [`Self::step`] where all views stay. `None` where views
    /// moved: the stages from the matches on have not run then, and instances may divide them.
    pub fn adjust_once(&mut self, progress: &Listener) -> Option<StageSummary> {
        let summary = self.step_once(Stage::Adjustment, MergedShards::default(), progress);
        self.has(Stage::Adjustment).then_some(summary)
    }

    fn step_once(
        &mut self,
        stage: Stage,
        merged: MergedShards,
        progress: &Listener,
    ) -> StageSummary {
        let missing = |run: &Self| {
            let mut earlier = run.stages().into_iter().take_while(|&s| s < stage);
            earlier.find(|&s| !run.has(s))
        };
        while let Some(earlier) = missing(self) {
            let origin = self.shards_origin(earlier);
            run_merged(origin, MergedShards::default(), || self.run_stage(earlier));
        }
        self.drop_from(stage);
        progress(0.0);
        let origin = self.shards_origin(stage);
        let summary = progress::with_listener(Listener::clone(progress), || {
            run_merged(origin, merged, || self.run_stage(stage))
        });
        progress(1.0);
        summary
    }

    /// Takes the ground as it is known already, instead of running its stage, and drops the results
    /// of the stages behind it.
    pub(crate) fn take_ground(&mut self, ground: Ground) {
        self.drop_from(Stage::Ground);
        self.results.ground = Some(ground);
        self.summaries.push(StageSummary {
            stage: Stage::Ground,
            counts: Vec::new(),
            warnings: Vec::new(),
        });
    }

    /// Runs all stages, with nobody listening.
    pub fn run_all(&mut self) {
        for stage in self.stages() {
            self.step(stage, &progress::silent());
        }
    }

    /// Has this stage run?
    pub fn has(&self, stage: Stage) -> bool {
        self.summaries.iter().any(|summary| summary.stage == stage)
    }

    /// The files of a finished run, as (name, bytes): what the command line writes and the page
    /// offers. `seconds` per stage go into `report.json`, in a part of their own, since they alone
    /// differ from run to run. Empty before the last stage has run.
    pub fn files(&self, seconds: &[(Stage, f64)]) -> Vec<(String, Vec<u8>)> {
        let Some(outputs) = self.outputs() else {
            return Vec::new();
        };
        let borrowed = export::ExportInput {
            scene: &self.scene,
            segments: &outputs.segments,
            lines: &outputs.lines,
            half_planes: outputs.half_planes,
            candidates: &self.results.candidates(),
            model: outputs.model,
            walls: outputs.walls,
            textured: outputs.textured,
        };
        let mut files = export_all(&borrowed, &self.params.texture);
        if let (Some(opened), Some(corrected)) = (&self.opened, &self.results.corrections) {
            files.retain(|(name, _)| !OF_PHOTOGRAPHS.contains(&&name[..]));
            // One that holds a building a line is written as one object.
            let sources = &corrected.trace.sources;
            if let Ok(bytes) = corrected_file(opened, &corrected.value, sources) {
                files[0].1 = bytes;
            }
        }
        let known = report::KnownReport {
            terrain: (self.results.ground.as_ref())
                .and_then(|ground| ground.terrain())
                .map(|compared| report::TerrainReport {
                    compared,
                    contradicted_below: self.results.other_ground(&self.scene),
                }),
            footprints: (self.results.facets.as_ref())
                .and_then(|found| found.trace.facets.register.as_ref()),
            point_cloud: (self.results.dense.as_ref())
                .and_then(|found| found.trace.point_cloud.as_ref()),
        };
        let uncovered = (self.results.model.as_ref()).map_or(&[][..], |found| &found.uncovered);
        let beside = (known, uncovered);
        let report = report::report(&self.scene, &self.params, &self.summaries, beside, seconds);
        files.push(("report.json".into(), report));
        files
    }

    /// The model as the roof report states it, for another one of it; `None` before the last stage
    /// has run.
    pub fn reported(&self) -> Option<ReportedModel> {
        let Outputs { model, walls, .. } = self.outputs()?;
        Some(ReportedModel::of(&self.scene, model, walls))
    }

    /// What goes into the files; `None` before the last stage has run.
    fn outputs(&self) -> Option<Outputs<'_>> {
        let r = &self.results;
        let model = r.roof_model()?;
        let last = r.model.as_ref()?;
        let (walls, textured) = (&last.walls[..], &last.value);
        let (segments, lines) = match self.opened {
            Some(_) => (Cow::Borrowed(&[][..]), Cow::Borrowed(&[][..])),
            None => r.segments_and_lines(&self.scene)?,
        };
        Some(Outputs {
            segments,
            lines,
            half_planes: r.half_planes.as_ref().map_or(&[], |found| &found.value),
            model,
            walls,
            textured,
        })
    }

    fn run_stage(&mut self, stage: Stage) -> Sharded<StageSummary> {
        (stage.row().run)(&self.scene, &self.params, &mut self.results)?;
        let findings = (stage.row().summary)(&self.scene, &self.results);
        let summary = StageSummary {
            stage,
            counts: findings.counts,
            warnings: findings.warnings,
        };
        self.summaries.push(summary.clone());
        if stage == Stage::Adjustment {
            self.take_round();
        }
        Ok(summary)
    }

    fn drop_from(&mut self, stage: Stage) {
        self.summaries.retain(|summary| summary.stage < stage);
        for later in Stage::ALL.iter().filter(|later| **later >= stage) {
            (later.row().discard)(&mut self.results);
        }
    }
}

/// What goes into the files.
struct Outputs<'a> {
    segments: Cow<'a, [Vec<ImageSegment>]>,
    lines: Cow<'a, [Line3d]>,
    half_planes: &'a [HalfPlane],
    model: &'a RoofModel,
    walls: &'a [BuildingWalls],
    textured: &'a TexturedModel,
}

fn as_json(params: &Params) -> Value {
    let text = serde_json::to_string(params).expect("parameters are numbers and names");
    serde_json::from_str(&text).expect("it has just been written")
}

/// The parameters at a path of names; `None` where there are none.
fn at_path<'a>(params: &'a Value, path: &str) -> Option<&'a Value> {
    path.split('.')
        .try_fold(params, |group, name| group.get(name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::params::Source;

    /// Does one path lead to the other or to a part of it?
    fn leads_to(path: &str, to: &str) -> bool {
        let rest = to.strip_prefix(path);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    }

    #[test]
    fn stages_read_parameters_that_there_are_and_all_of_them() {
        let params = as_json(&Params::default());
        let read: Vec<&str> = (Stage::ALL.iter().flat_map(|stage| stage.reads()))
            .copied()
            .collect();
        for path in &read {
            assert!(at_path(&params, path).is_some(), "{path}");
        }
        let groups = params.as_object().unwrap().iter();
        // Which stages there are is no stage's parameter.
        for (name, group) in groups.filter(|(name, _)| !["method", "sources"].contains(&&name[..]))
        {
            let paths: Vec<String> = match group.as_object() {
                Some(fields) => fields
                    .keys()
                    .map(|field| format!("{name}.{field}"))
                    .collect(),
                None => vec![name.clone()],
            };
            for path in paths {
                let is_read = read.iter().any(|one| leads_to(one, &path));
                assert!(is_read, "no stage depends on {path}");
            }
        }
    }

    #[test]
    fn stages_need_what_runs_before_them() {
        for stage in Stage::ALL {
            assert!(
                stage
                    .needs(&Source::ALL)
                    .iter()
                    .all(|needed| needed < stage)
            );
            assert_eq!(Stage::from_name(stage.name()), Some(*stage));
        }
    }
}
