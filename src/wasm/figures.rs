//! What the page's live figures ask of a project: traces, and [`crate::results::figures`] where the
//! reader points.

use std::borrow::Cow;

use js_sys::{Float32Array, Float64Array};
use serde::Serialize;
use wasm_bindgen::prelude::*;

use super::arrays::end_points_px;
use super::convert::{named_error, to_js};

use super::session::Session;
use crate::base::evidence::Evidence;
use crate::base::ids::SegmentId;
use crate::base::ids::ViewId;
use crate::lines::linematch::{MatchTrace, SegmentRef, StepCount};
use crate::lines::lines2d::{ImageSegment, SegmentRejection};
use crate::lines::lines3d::Side;
use crate::lines::lines3d::SupportKind;
use crate::lines::lines3d::{Line3d, LineContradiction, LineOrigin};
use crate::pipeline::Run;
use crate::planes::half_planes::{PointsOfInterest, SweepRejection};
use crate::planes::objectspace::{image_segments, world_lines};
use crate::results::figures::{correspondence, detected_stretches, segment_matching, warped_views};
use crate::roofs::buildings::{BuildingRefinement, RoofGap, UnrefinedFacets};

/// A 3D line without its geometry, which `lines` gives.
#[derive(Serialize, tsify::Tsify)]
struct LineRecord<'a> {
    origin: LineOrigin,
    /// Why the model leaves it out.
    contradiction: Option<LineContradiction>,
    probability: f64,
    /// What speaks for it and against it, as its views show it; `null` where it was not matched.
    by_views: Option<&'a Evidence>,
    /// The same in the finished model; `null` before there is one.
    in_model: Option<&'a Evidence>,
    sigma_m: f64,
    /// Of the start and of the end point, m^2: xx, xy, xz, yy, yz, zz.
    covariance: [[f64; 6]; 2],
    supports: Vec<SupportRecord<'a>>,
}

/// The evidence for a line in one view.
#[derive(Serialize, tsify::Tsify)]
struct SupportRecord<'a> {
    view: ViewId,
    segments: &'a [SegmentId],
    score: f64,
    kind: SupportKind,
}

/// What matching did, in numbers.
#[derive(Serialize, tsify::Tsify)]
struct MatchRecord<'a> {
    z_range_m: Option<[f64; 2]>,
    view_pairs: &'a [(ViewId, ViewId)],
    candidates: usize,
    pairs: usize,
    triples_before: usize,
    triples_after: usize,
    detected: StepCount,
    matched: StepCount,
    merged: StepCount,
    grown: StepCount,
}

impl<'a> From<&'a MatchTrace> for MatchRecord<'a> {
    fn from(trace: &'a MatchTrace) -> Self {
        Self {
            z_range_m: trace.z_range_m,
            view_pairs: &trace.view_pairs,
            candidates: trace.candidates,
            pairs: trace.pair_count,
            triples_before: trace.triples_before,
            triples_after: trace.triples_after,
            detected: trace.detected,
            matched: trace.matched,
            merged: trace.merged,
            grown: trace.grown,
        }
    }
}

/// One side of a 3D line in the sweep.
#[derive(Serialize, tsify::Tsify)]
struct SideRecord {
    line: usize,
    side: Side,
    rejection: Option<SweepRejection>,
}

/// What became of the buildings after delineation.
#[derive(Serialize, tsify::Tsify)]
struct Refinement<'a> {
    gaps: &'a [RoofGap],
    before: &'a UnrefinedFacets,
    buildings: &'a [BuildingRefinement],
}

/// A picture and what it shows.
#[wasm_bindgen(getter_with_clone)]
pub struct Picture {
    /// What it shows: `WarpedViews` or `GroundPicture`.
    pub about: JsValue,
    /// `4 * width * height` bytes, RGBA row by row.
    pub rgba: js_sys::Uint8ClampedArray,
}

#[wasm_bindgen]
impl Session {
    /// The lines of edgels that are no segments of a view: x0, y0, x1, y1 in pixels, and why (0
    /// curved, 1 not significant, 2 beside an edge) each.
    #[wasm_bindgen(js_name = rejectedSegments)]
    pub fn rejected_segments(&self, view: usize) -> Result<Float32Array, JsValue> {
        let found = self.loaded()?.results().segments.as_ref();
        let trace = found.and_then(|s| s.trace.get(view));
        let mut numbers: Vec<f32> = Vec::new();
        for refused in trace.map_or(&[][..], |t| &t.rejected) {
            numbers.extend(end_points_px(&refused.segment));
            numbers.push(match refused.reason {
                SegmentRejection::TooShort | SegmentRejection::Curved => 0.0,
                SegmentRejection::NotSignificant => 1.0,
                SegmentRejection::BesideEdge => 2.0,
            });
        }
        Ok(Float32Array::from(&numbers[..]))
    }

    /// Method "lines": what matching did, in numbers; `null` before that stage.
    #[wasm_bindgen(unchecked_return_type = "MatchRecord | null")]
    pub fn matching(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().matches.as_ref();
        to_js(&found.map(|m| MatchRecord::from(&m.trace)))
    }

    /// Method "lines": a segment's beams, candidates and fate (B99 figures 1, 2 and 4); `null`
    /// before matching.
    #[wasm_bindgen(js_name = segmentStory, unchecked_return_type = "SegmentMatching | null")]
    pub fn segment_matching(&self, view: u32, segment: u32) -> Result<JsValue, JsValue> {
        let run = self.loaded()?;
        let (Some(segments), Some(matches)) = (&run.results().segments, &run.results().matches)
        else {
            return Ok(JsValue::NULL);
        };
        let of = named(view, segment);
        to_js(&segment_matching(
            run.scene(),
            &segments.value,
            &matches.trace,
            of,
        ))
    }

    /// Method "lines": the point at fraction `t` of a segment and the point of a candidate that
    /// corresponds to it (B99 figure 3); `null` where there is none.
    #[wasm_bindgen(unchecked_return_type = "Correspondence | null")]
    pub fn correspondence(
        &self,
        view: u32,
        segment: u32,
        other_view: u32,
        other_segment: u32,
        t: f64,
    ) -> Result<JsValue, JsValue> {
        let run = self.loaded()?;
        let Some(segments) = &run.results().segments else {
            return Ok(JsValue::NULL);
        };
        let (of, other) = (named(view, segment), named(other_view, other_segment));
        to_js(&correspondence(run.scene(), &segments.value, of, other, t))
    }

    /// How certain each 3D line is and what supports it, in the order of `lines`.
    #[wasm_bindgen(js_name = lineRecords, unchecked_return_type = "LineRecord[]")]
    pub fn line_records(&self) -> Result<JsValue, JsValue> {
        let run = self.loaded()?;
        let lines = lines_of(run);
        let by_views = run.results().evidence_of_matches();
        let in_model = run.results().evidence_in_model();
        let record = |(i, line)| LineRecord {
            by_views: by_views.get(i).copied(),
            in_model: in_model.get(i),
            ..line_record(line)
        };
        let records: Vec<LineRecord> = lines.iter().enumerate().map(record).collect();
        to_js(&records)
    }

    /// The parts of the 3D lines that segments showed before merging and growing: index of the
    /// line, then both end points in metres, local frame (B99 figures 5 to 8).
    #[wasm_bindgen(js_name = detectedStretches)]
    pub fn detected_stretches(&self) -> Result<Float64Array, JsValue> {
        let run = self.loaded()?;
        let segments = segments_of(run);
        let mut numbers: Vec<f64> = Vec::new();
        for (k, line) in lines_of(run).iter().enumerate() {
            for s in detected_stretches(run.scene(), &segments, line) {
                numbers.push(k as f64);
                numbers.extend([s.p0, s.p1].iter().flat_map(|p| [p.x, p.y, p.z]));
            }
        }
        Ok(Float64Array::from(&numbers[..]))
    }

    /// Method "lines": every side of every 3D line, and why it has no half-plane.
    #[wasm_bindgen(unchecked_return_type = "SideRecord[]")]
    pub fn sides(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().half_planes.as_ref();
        let sides = found.map_or(&[][..], |h| &h.trace.sides);
        let records: Vec<SideRecord> = sides
            .iter()
            .map(|s| SideRecord {
                line: s.line.index(),
                side: s.side,
                rejection: s.rejection,
            })
            .collect();
        to_js(&records)
    }

    /// Method "lines": Sim(theta) of one side of a 3D line (B99 figures 12 to 14); `null` before
    /// the sweep.
    #[wasm_bindgen(unchecked_return_type = "SideTrace | null")]
    pub fn side(&self, line: usize, left: bool) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().half_planes.as_ref();
        let side = side_of(left);
        let sides = found.map_or(&[][..], |h| &h.trace.sides);
        to_js(
            &sides
                .iter()
                .find(|s| s.line.index() == line && s.side == side),
        )
    }

    /// Method "lines": all views warped by H(theta) onto one side of a 3D line (B99 figures 10 and
    /// 11); `undefined` where nothing can be compared.
    pub fn warped(
        &mut self,
        line: usize,
        left: bool,
        theta: f64,
    ) -> Result<Option<Picture>, JsValue> {
        self.detect_points()?;
        let run = self.loaded()?;
        let lines = lines_of(run);
        let line = lines
            .get(line)
            .ok_or_else(|| named_error("RangeError", &format!("there is no line {line}")))?;
        let points = self.points.as_deref().unwrap_or_default();
        let (segment, params) = (&line.segment, &run.params().sweep);
        let found = warped_views(run.scene(), points, segment, side_of(left), theta, params);
        found
            .map(|warped| {
                Ok(Picture {
                    about: to_js(&warped)?,
                    rgba: js_sys::Uint8ClampedArray::from(&warped.rgba[..]),
                })
            })
            .transpose()
    }

    /// Method "lines": groups, lines found in planes, and border lines (B99 figures 17 to 22);
    /// `null` before that stage.
    #[wasm_bindgen(unchecked_return_type = "GroupingTrace | null")]
    pub fn grouping(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().groups.as_ref();
        to_js(&found.map(|r| &r.trace))
    }

    /// Method "lines": the facets that were weighed, and the rejected ones (B99 figure 23); `null`
    /// before that stage.
    #[wasm_bindgen(unchecked_return_type = "FacetTrace | null")]
    pub fn verification(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().facets.as_ref();
        to_js(&found.map(|r| &r.trace.facets))
    }

    /// Method "lines": the buildings before refinement, what their images said, the relations that
    /// were tested, and the gaps that were opened (B99 2); `null` before that stage.
    #[wasm_bindgen(unchecked_return_type = "Refinement | null")]
    pub fn refinement(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().refinement.as_ref();
        to_js(&found.map(|r| Refinement {
            gaps: &r.trace.gaps,
            before: &r.trace.unrefined,
            buildings: &r.trace.buildings,
        }))
    }

    /// Where a roof may be and the model has none, the largest first; `null` before the last stage.
    #[wasm_bindgen(unchecked_return_type = "UncoveredRoof[] | null")]
    pub fn uncovered(&self) -> Result<JsValue, JsValue> {
        let found = self.loaded()?.results().model.as_ref();
        to_js(&found.map(|r| &r.uncovered))
    }

    /// The points of interest of all views, once for each set of parameters.
    fn detect_points(&mut self) -> Result<(), JsValue> {
        if self.points.is_none() {
            let run = self.loaded()?;
            let found = PointsOfInterest::detect_all(run.scene(), &run.params().sweep);
            self.points = Some(found);
        }
        Ok(())
    }
}

fn line_record(line: &Line3d) -> LineRecord<'_> {
    let supports = line.supports.iter().map(|s| SupportRecord {
        view: s.view,
        segments: &s.segments,
        score: s.score,
        kind: s.kind,
    });
    LineRecord {
        origin: line.origin,
        contradiction: line.contradiction,
        probability: line.probability,
        by_views: None,
        in_model: None,
        sigma_m: line.sigma_m,
        covariance: line
            .covariance
            .map(|c| [c.m11, c.m12, c.m13, c.m22, c.m23, c.m33]),
        supports: supports.collect(),
    }
}

/// The segments of the method; where both run, those of regions until there are lines of both.
pub(crate) fn segments_of(run: &Run) -> Cow<'_, [Vec<ImageSegment>]> {
    let r = run.results();
    match (&r.segments, &r.regions, &r.lines) {
        (_, Some(regions), None) => Cow::Owned(image_segments(&regions.value)),
        (Some(segments), ..) => Cow::Borrowed(&segments.value),
        (None, ..) => Cow::Borrowed(&[]),
    }
}

/// The 3D lines of the method (where both run, those of regions until there are more), with the new
/// lines of the model once there is one.
pub(crate) fn lines_of(run: &Run) -> Cow<'_, [Line3d]> {
    let r = run.results();
    match (&r.lines, &r.regions, &r.clusters) {
        (Some(lines), ..) => r
            .all_lines()
            .map_or(Cow::Borrowed(&lines.value[..]), Cow::Owned),
        (None, Some(regions), Some(found)) => {
            Cow::Owned(world_lines(run.scene(), &regions.value, &found.value))
        }
        _ => Cow::Borrowed(&[]),
    }
}

fn named(view: u32, segment: u32) -> SegmentRef {
    SegmentRef {
        view: ViewId(view),
        segment: SegmentId(segment),
    }
}

fn side_of(left: bool) -> Side {
    if left { Side::Left } else { Side::Right }
}
