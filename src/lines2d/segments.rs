//! From an image to its straight segments: the stage (B99 3.2, "Implementation details").

use nalgebra::Point2;
use serde::Serialize;

use super::ImageSegment;
use super::canny::{Edgel, Gradient, suppress};
use super::chain::{Chain, Raster, link_on};
use super::fit::straight_pieces;
use super::grow::{Grown, grow};
use super::noise::LocalGradients;
use super::significance::ln_false_alarms;
use super::worm::tangent_breaks;
use crate::geometry::Segment2;
use crate::params::SegmentParams;
use crate::raster::Gray;

/// Why a straight line of edgels is not a segment.
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

/// A line that was refused, with the reason.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RejectedSegment {
    /// The line, px.
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
    /// Straight pieces of chains, from which lines are grown.
    pub seeds: usize,
    /// Seeds that a longer one has swallowed.
    pub taken: usize,
    /// Lines that are too short.
    pub too_short: usize,
    /// Lines that belong to a curve.
    pub curved: usize,
    /// Lines that the texture around them explains.
    pub not_significant: usize,
    /// The refused lines of at least the minimum length.
    pub rejected: Vec<RejectedSegment>,
}

/// The straight segments of an image, directed by contrast, those of the longest pieces first.
pub fn detect_segments(gray: &Gray, params: &SegmentParams) -> (Vec<ImageSegment>, SegmentTrace) {
    let gradient = Gradient::new(gray, params.edgels.smoothing_px);
    let local = LocalGradients::new(&gradient);
    let edgels = suppress(&gradient, &local, params.edgels.low);
    let raster = Raster::new(&edgels);
    let chains = link_on(&edgels, &raster, params.edgels.high);
    let mut trace = SegmentTrace {
        edgels: edgels.len(),
        chains: chains.len(),
        ..SegmentTrace::default()
    };
    let mut seeds: Vec<Vec<u32>> = chains
        .iter()
        .flat_map(|chain| seeds_of(chain, &edgels, params, &mut trace))
        .collect();
    trace.seeds = seeds.len();
    // The longest first: they predict best. The sort is stable, equals stay in the order of their chains.
    seeds.sort_by_key(|seed| std::cmp::Reverse(seed.len()));

    let tests = seeds.len();
    let mut taken = vec![false; edgels.len()];
    let mut segments = Vec::new();
    for seed in &seeds {
        if seed.iter().filter(|&&i| taken[i as usize]).count() * 2 > seed.len() {
            trace.taken += 1;
            continue;
        }
        let line = grow(&edgels, &raster, seed, &|i| !taken[i as usize], params);
        let line = if line.line.is_tight(&line.points, params) {
            line
        } else {
            Grown::new(&edgels, seed.clone())
        };
        let segment = extent(&line);
        match judge(&line, &segment, &edgels, &local, tests, params) {
            None => {
                line.edgels.iter().for_each(|&i| taken[i as usize] = true);
                segments.push(finish(&line, segment, gray, params));
            }
            Some(SegmentRejection::TooShort) => trace.too_short += 1,
            Some(reason) => trace.rejected.push(RejectedSegment { segment, reason }),
        }
    }
    let refused = |reason| trace.rejected.iter().filter(|r| r.reason == reason).count();
    trace.curved = refused(SegmentRejection::Curved);
    trace.not_significant = refused(SegmentRejection::NotSignificant);
    (segments, trace)
}

/// The straight pieces of a chain, as edgel indices.
fn seeds_of(
    chain: &Chain,
    edgels: &[Edgel],
    params: &SegmentParams,
    trace: &mut SegmentTrace,
) -> Vec<Vec<u32>> {
    let position = |&i: &u32| edgels[i as usize].position;
    let points: Vec<Point2<f64>> = chain.edgels.iter().map(position).collect();
    let breaks = tangent_breaks(&points, params);
    trace.worm_breaks.extend(breaks.iter().map(|&i| points[i]));
    let starts = std::iter::once(0).chain(breaks.iter().copied());
    let ends = breaks.iter().map(|b| b + 1).chain([points.len()]);
    starts
        .zip(ends)
        .flat_map(|(from, to)| straight_pieces(&points, from, to, params))
        .filter(|piece| piece.to - piece.from >= params.seed_edgels)
        .map(|piece| chain.edgels[piece.from..piece.to].to_vec())
        .collect()
}

/// The stretch of the line from its first to its last edgel.
fn extent(grown: &Grown) -> Segment2 {
    let line = &grown.line;
    let along = grown.points.iter().map(|p| line.along(p));
    let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), t| {
        (l.min(t), h.max(t))
    });
    let at = |t: f64| line.centroid + line.direction * t;
    Segment2::new(at(low), at(high))
}

/// Why the line is no segment, if it is none.
fn judge(
    grown: &Grown,
    segment: &Segment2,
    edgels: &[Edgel],
    local: &LocalGradients,
    tests: usize,
    params: &SegmentParams,
) -> Option<SegmentRejection> {
    if segment.length() < params.min_length_px {
        return Some(SegmentRejection::TooShort);
    }
    let line = &grown.line;
    let correlated = 2.0 * params.edgels.smoothing_px;
    let (curvature, sigma) = line.curvature(&grown.points);
    let sigma = sigma * correlated.sqrt();
    if curvature.abs() > 3.0 * sigma && curvature.abs() * params.min_radius_px > 1.0 {
        return Some(SegmentRejection::Curved);
    }
    let normal = line.normal();
    let surprise = |&i: &u32| {
        let edgel = &edgels[i as usize];
        let (x, y) = edgel.pixel();
        let across = edgel.gradient.cast::<f64>().dot(&normal).max(0.0);
        f64::from(local.surprise(x, y, across as f32))
    };
    let sum: f64 = grown.edgels.iter().map(surprise).sum();
    // One edgel a pixel along the main axis, were there no gaps.
    let step = segment.p1 - segment.p0;
    let pixels = (step.x.abs().max(step.y.abs()) + 1.0).max(grown.edgels.len() as f64);
    let alarms = ln_false_alarms(tests, pixels / correlated, sum / correlated);
    (alarms > params.max_ln_false_alarms).then_some(SegmentRejection::NotSignificant)
}

fn finish(grown: &Grown, segment: Segment2, gray: &Gray, params: &SegmentParams) -> ImageSegment {
    let line = &grown.line;
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
