//! `report.json`: counts per stage, parameters, version and warnings of a run.

use std::collections::BTreeMap;

use serde::Serialize;

use super::stages::Stage;
use super::summary::StageSummary;
use crate::base::params::Params;
use crate::orienting::known::KnownComparison;
use crate::orienting::scene::{Scene, ViewAdjustment, ViewShift};
use crate::planes::dense::CloudComparison;
use crate::roofs::buildings::{OtherGround, UncoveredRoof};
use crate::roofs::facets::RegisterTrace;

/// The content of `report.json`.
#[derive(Serialize)]
struct Report<'a> {
    version: &'static str,
    views: Vec<ReportView<'a>>,
    origin: [f64; 3],
    /// Reference system of the world, where it is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    coordinates: Option<String>,
    stages: &'a [StageSummary],
    /// What was known beforehand, compared with the images.
    #[serde(skip_serializing_if = "KnownReport::is_empty")]
    known: KnownReport<'a>,
    /// Where a roof may be and the model has none, local frame.
    uncovered: &'a [UncoveredRoof],
    /// Warnings of the readers; those of the stages stand with them.
    warnings: &'a [String],
    params: &'a Params,
    /// Wall-clock seconds per stage: the only part that differs between runs of the same input.
    seconds: BTreeMap<&'static str, f64>,
}

/// What was known beforehand, compared with the images.
#[derive(Clone, Default, Serialize)]
pub(crate) struct KnownReport<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub terrain: Option<TerrainReport<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub footprints: Option<&'a RegisterTrace>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point_cloud: Option<&'a CloudComparison>,
}

/// A terrain model compared with the images.
#[derive(Clone, Serialize)]
pub(crate) struct TerrainReport<'a> {
    #[serde(flatten)]
    pub compared: &'a KnownComparison,
    /// The buildings below which the images contradict it.
    pub contradicted_below: Vec<OtherGround>,
}

impl KnownReport<'_> {
    fn is_empty(&self) -> bool {
        self.terrain.is_none() && self.footprints.is_none() && self.point_cloud.is_none()
    }
}

#[derive(Serialize)]
struct ReportView<'a> {
    view: &'a str,
    width: u32,
    height: u32,
    /// Shift against the other views, where they show enough to tell.
    #[serde(skip_serializing_if = "Option::is_none")]
    orientation: Option<&'a ViewShift>,
    /// What the adjustment to matched lines did, where it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    adjustment: Option<&'a ViewAdjustment>,
}

/// The bytes of `report.json`; `seconds` may be empty.
pub(crate) fn report(
    scene: &Scene,
    params: &Params,
    stages: &[StageSummary],
    (known, uncovered): (KnownReport, &[UncoveredRoof]),
    seconds: &[(Stage, f64)],
) -> Vec<u8> {
    let views = scene.views.iter().enumerate().map(|(i, view)| ReportView {
        view: &view.name,
        width: view.camera.width,
        height: view.camera.height,
        orientation: scene.survey.shifts.get(i),
        adjustment: scene.survey.adjustments.get(i),
    });
    let mut by_stage = BTreeMap::new();
    by_stage.extend(seconds.iter().map(|(stage, s)| (stage.name(), *s)));
    let report = Report {
        version: env!("CARGO_PKG_VERSION"),
        views: views.collect(),
        origin: scene.origin.into(),
        coordinates: scene.survey.describe(),
        stages,
        known,
        uncovered,
        warnings: &scene.warnings,
        params,
        seconds: by_stage,
    };
    let mut bytes =
        serde_json::to_vec_pretty(&report).expect("a report holds only numbers and strings");
    bytes.push(b'\n');
    bytes
}
