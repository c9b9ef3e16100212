//! From an image to its straight segments: the stage (B99 3.2, "Implementation details").

use nalgebra::Point2;
use serde::Serialize;

use super::ImageSegment;
use super::canny::{Edgel, Gradient, suppress};
use super::chain::link_chains;
use super::fit::{LineFit, Piece, straight_pieces};
use super::noise::LocalGradients;
use super::significance::ln_false_alarms;
use super::worm::tangent_breaks;
use crate::geometry::Segment2;
use crate::params::SegmentParams;
use crate::raster::Gray;

/// Why a straight piece of a chain is not a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SegmentRejection {
    /// Shorter than the minimum length.
    TooShort,
    /// Part of a curve.
    Curved,
    /// Not distinguishable from the texture around it.
    NotSignificant,
}

/// A piece that was refused, with the reason.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RejectedSegment {
    /// The piece, px.
    pub segment: Segment2,
    /// Why it was refused.
    pub reason: SegmentRejection,
}

/// What the detector did in one view.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SegmentTrace {
    /// Edgels above the low threshold.
    pub edgels: usize,
    /// Chains of edgels after hysteresis.
    pub chains: usize,
    /// Where the worm broke a chain, px.
    pub worm_breaks: Vec<Point2<f64>>,
    /// Straight pieces that are too short.
    pub too_short: usize,
    /// Straight pieces that belong to a curve.
    pub curved: usize,
    /// Straight pieces that the texture around them explains.
    pub not_significant: usize,
    /// The refused pieces of at least the minimum length.
    pub rejected: Vec<RejectedSegment>,
}

/// The straight segments of an image, directed by contrast, ordered as their chains are.
pub fn detect_segments(gray: &Gray, params: &SegmentParams) -> (Vec<ImageSegment>, SegmentTrace) {
    let gradient = Gradient::new(gray, params.edgels.smoothing_px);
    let local = LocalGradients::new(&gradient);
    let edgels = suppress(&gradient, &local, params.edgels.low);
    let chains = link_chains(&edgels, params.edgels.high);
    let mut trace = SegmentTrace {
        edgels: edgels.len(),
        chains: chains.len(),
        ..SegmentTrace::default()
    };
    let mut candidates = Vec::new();
    for chain in &chains {
        let members: Vec<Edgel> = chain.edgels.iter().map(|&i| edgels[i as usize]).collect();
        candidates.extend(pieces_of(&members, params, &mut trace));
    }
    trace.too_short = candidates.len();
    candidates.retain(|c| c.segment.length() >= params.min_length_px);
    trace.too_short -= candidates.len();
    let tests = candidates.len();
    let mut segments = Vec::new();
    for candidate in &candidates {
        match judge(candidate, &local, tests, params) {
            None => segments.push(finish(candidate, gray, params)),
            Some(reason) => trace.rejected.push(RejectedSegment {
                segment: candidate.segment,
                reason,
            }),
        }
    }
    let refused = |reason| trace.rejected.iter().filter(|r| r.reason == reason).count();
    trace.curved = refused(SegmentRejection::Curved);
    trace.not_significant = refused(SegmentRejection::NotSignificant);
    (segments, trace)
}

/// A straight piece with its edgels.
struct Candidate {
    edgels: Vec<Edgel>,
    points: Vec<Point2<f64>>,
    line: LineFit,
    segment: Segment2,
}

impl Candidate {
    fn new(edgels: &[Edgel], points: &[Point2<f64>], piece: &Piece) -> Self {
        let points = points[piece.from..piece.to].to_vec();
        let line = piece.line;
        let along = points.iter().map(|p| line.along(p));
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), t| {
            (l.min(t), h.max(t))
        });
        Self {
            edgels: edgels[piece.from..piece.to].to_vec(),
            segment: Segment2::new(
                line.centroid + line.direction * low,
                line.centroid + line.direction * high,
            ),
            points,
            line,
        }
    }
}

fn pieces_of(edgels: &[Edgel], params: &SegmentParams, trace: &mut SegmentTrace) -> Vec<Candidate> {
    let points: Vec<Point2<f64>> = edgels.iter().map(|e| e.position).collect();
    let breaks = tangent_breaks(&points, params);
    trace.worm_breaks.extend(breaks.iter().map(|&i| points[i]));
    let starts = std::iter::once(0).chain(breaks.iter().copied());
    let ends = breaks.iter().map(|b| b + 1).chain([points.len()]);
    starts
        .zip(ends)
        .flat_map(|(from, to)| straight_pieces(&points, from, to, params))
        .map(|piece| Candidate::new(edgels, &points, &piece))
        .collect()
}

fn judge(
    candidate: &Candidate,
    local: &LocalGradients,
    tests: usize,
    params: &SegmentParams,
) -> Option<SegmentRejection> {
    let (curvature, sigma) = candidate.line.curvature(&candidate.points);
    let correlated = 2.0 * params.edgels.smoothing_px;
    let sigma = sigma * correlated.sqrt();
    if curvature.abs() > 3.0 * sigma && curvature.abs() * params.min_radius_px > 1.0 {
        return Some(SegmentRejection::Curved);
    }
    let normal = candidate.line.normal();
    let sum: f64 = candidate
        .edgels
        .iter()
        .map(|e| {
            let (x, y) = e.pixel();
            let across = e.gradient.cast::<f64>().dot(&normal).max(0.0);
            f64::from(local.surprise(x, y, across as f32))
        })
        .sum();
    let n = candidate.edgels.len() as f64 / correlated;
    let alarms = ln_false_alarms(tests, n, sum / correlated);
    (alarms > params.max_ln_false_alarms).then_some(SegmentRejection::NotSignificant)
}

fn finish(candidate: &Candidate, gray: &Gray, params: &SegmentParams) -> ImageSegment {
    let segment = candidate.segment;
    let line = &candidate.line;
    ImageSegment {
        segment,
        contrast: contrast(gray, &segment, params.contrast_distance_px),
        edgels: u32::try_from(line.count).expect("fewer than 2^32 edgels"),
        covariance: line.covariance(
            line.along(&segment.midpoint()),
            params.edgels.smoothing_px,
            params.edgel_floor_px,
        ),
    }
}

/// Mean grey-value difference between the two sides, `distance_px` off the segment.
fn contrast(gray: &Gray, segment: &Segment2, distance_px: f64) -> f32 {
    let steps = segment.length().ceil().max(1.0) as usize;
    let normal = segment.normal() * distance_px;
    let at = |p: Point2<f64>| gray.sample(p.x as f32, p.y as f32);
    let (mut sum, mut count) = (0.0, 0.0);
    for i in 0..steps {
        let p = segment.at((i as f64 + 0.5) / steps as f64);
        if let (Some(bright), Some(dark)) = (at(p + normal), at(p - normal)) {
            sum += bright - dark;
            count += 1.0;
        }
    }
    if count > 0.0 {
        (sum / count).max(0.0)
    } else {
        0.0
    }
}
