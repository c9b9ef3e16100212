//! From an image to its straight segments: the stage (B99 3.2, "Implementation details").
//!
//! Deviations: lines grow past the ends of their chains ([`super::grow`]), and a test of significance
//! ([`super::significance`]) stands in for a global threshold of contrast.
//!
//! Tried and left out: evidence from the directions of the edgels besides their strength (the same
//! coverage of true roof edges at the same number of segments), and chains alone without growing (on two
//! rendered views of a suburb, about 880 segments each: 48 % of the true roof edges covered instead of 59 %).

use nalgebra::Point2;
use serde::Serialize;

use super::ImageSegment;
use super::canny::{Edgel, Gradient, suppress};
use super::chain::{Chain, Raster, link_on};
use super::fit::straight_pieces;
use super::grow::{Grown, grow_tight};
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
        let line = grow_tight(&edgels, &raster, seed, &|i| !taken[i as usize], params);
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

#[cfg(test)]
mod tests {
    use super::super::testing::{add_noise, distance_to_edge, step_edge};
    use super::*;

    /// The segment on the planted edge; there must be exactly one.
    fn planted(gray: &Gray, angle: f64) -> ImageSegment {
        let (segments, _) = detect_segments(gray, &SegmentParams::default());
        let on_edge = |s: &&ImageSegment| {
            let end = |p| distance_to_edge(gray, angle, p).abs() < 1.5;
            end(&s.segment.p0) && end(&s.segment.p1)
        };
        let found: Vec<_> = segments.iter().filter(on_edge).collect();
        assert_eq!(found.len(), 1, "at {angle}");
        found[0].clone()
    }

    /// Angle of the segment's normal against that of the planted edge, rad.
    fn turn(found: &ImageSegment, angle: f64) -> f64 {
        let n = found.segment.normal();
        let (s, c) = crate::math::sin_cos(angle);
        crate::math::atan2(n.y * c - n.x * s, n.x * c + n.y * s)
    }

    #[test]
    fn a_planted_edge_is_found_within_a_tenth_of_a_pixel_and_of_a_degree() {
        let (mut offsets, mut turns, mut count) = (0.0, 0.0, 0.0);
        for step in 0..72 {
            let angle = f64::from(step) * 5f64.to_radians() + 0.02;
            let mut gray = step_edge(64, 64, angle, 0.3);
            add_noise(&mut gray, 2.0 / 255.0, step as u64);
            let found = planted(&gray, angle);
            assert!(found.segment.length() > 50.0);
            assert!((found.contrast - 0.3).abs() < 0.02, "{}", found.contrast);
            let offset = distance_to_edge(&gray, angle, &found.segment.midpoint());
            // Within pi/2 only when the brighter side is on the side of the normal.
            let turn = turn(&found, angle);
            assert!(turn.to_degrees().abs() < 0.3, "turn {turn} at {angle}");
            offsets += offset * offset;
            turns += turn * turn;
            count += 1.0;
        }
        let (offset, turn) = ((offsets / count).sqrt(), (turns / count).sqrt());
        assert!(offset <= 0.05, "offset {offset} px rms");
        assert!(
            turn.to_degrees() <= 0.1,
            "turn {} degrees rms",
            turn.to_degrees()
        );
    }

    #[test]
    fn the_covariance_is_that_of_the_errors() {
        let (mut offsets, mut turns, mut count) = (0.0, 0.0, 0.0);
        for seed in 0..200u32 {
            let angle = f64::from(seed) * 0.1;
            let mut gray = step_edge(48, 48, angle, 0.15);
            add_noise(&mut gray, 6.0 / 255.0, u64::from(seed));
            let found = planted(&gray, angle);
            let offset = distance_to_edge(&gray, angle, &found.segment.midpoint());
            let turn = turn(&found, angle);
            offsets += offset * offset / found.covariance[(0, 0)];
            turns += turn * turn / found.covariance[(1, 1)];
            count += 1.0;
        }
        for normalised in [(offsets / count).sqrt(), (turns / count).sqrt()] {
            assert!((0.7..1.4).contains(&normalised), "{normalised} sigma rms");
        }
    }

    #[test]
    fn a_weak_edge_is_found_when_it_is_long() {
        // One and a half times the noise of a pixel.
        let mut gray = step_edge(160, 160, 0.4, 0.03);
        add_noise(&mut gray, 0.02, 3);
        let (segments, _) = detect_segments(&gray, &SegmentParams::default());
        let on_edge = |s: &&ImageSegment| {
            distance_to_edge(&gray, 0.4, &s.segment.midpoint()).abs() < 1.0
                && turn(s, 0.4).abs() < 0.1
        };
        let found: f64 = segments
            .iter()
            .filter(on_edge)
            .map(|s| s.segment.length())
            .sum();
        assert!(found > 80.0, "{found} px of 170");
    }

    #[test]
    fn noise_has_few_segments_and_none_that_are_long() {
        let mut gray = Gray::from_fn(400, 400, |_, _| 0.5);
        add_noise(&mut gray, 0.05, 11);
        let (segments, trace) = detect_segments(&gray, &SegmentParams::default());
        assert!(trace.edgels > 5000);
        assert!(segments.len() <= 40, "{}", segments.len());
        assert!(segments.iter().all(|s| s.segment.length() < 45.0));
    }

    #[test]
    fn a_disc_is_not_cut_into_chords() {
        for radius in [20.0, 60.0, 120.0] {
            let gray = Gray::from_fn(300, 300, |x, y| {
                let d = crate::math::hypot(x as f64 - 150.0, y as f64 - 150.0) - radius;
                (0.4 + 0.3 * (0.5 - 0.5 * libm::erf(d))) as f32
            });
            let (segments, trace) = detect_segments(&gray, &SegmentParams::default());
            assert!(trace.chains > 0);
            assert!(
                segments.is_empty(),
                "{} chords of radius {radius}",
                segments.len()
            );
        }
    }

    #[test]
    fn a_line_that_texture_interrupts_is_one_segment() {
        // Bright crumbs on the edge, every 16 px, end the chains.
        let mut gray = step_edge(120, 120, std::f64::consts::FRAC_PI_2, 0.2);
        for x in (10..120).step_by(16) {
            for y in 58..62 {
                for x in x..x + 2 {
                    gray.data[y * 120 + x] = 0.9;
                }
            }
        }
        let params = SegmentParams::default();
        let longest = |params: &SegmentParams| {
            let (segments, _) = detect_segments(&gray, params);
            let lengths = segments.iter().map(|s| s.segment.length());
            lengths.fold(0.0, f64::max)
        };
        assert!(longest(&params) > 90.0, "{}", longest(&params));
        let without = SegmentParams {
            grow_gap_px: 0,
            ..params
        };
        assert!(longest(&without) < 30.0, "{}", longest(&without));
    }

    #[test]
    fn a_square_has_four_sides_that_run_around_it() {
        let gray = Gray::from_fn(80, 80, |x, y| {
            let inside = |v: usize| (20..60).contains(&v);
            if inside(x) && inside(y) { 0.7 } else { 0.3 }
        });
        let (segments, trace) = detect_segments(&gray, &SegmentParams::default());
        assert_eq!(segments.len(), 4);
        for s in &segments {
            let inwards = Point2::new(40.0, 40.0) - s.segment.midpoint();
            assert!(s.segment.normal().dot(&inwards) > 19.0, "{s:?}");
            assert!((s.segment.length() - 40.0).abs() < 5.0);
        }
        assert!(trace.worm_breaks.len() >= 3);
    }

    #[test]
    fn empty_and_broken_rasters_have_no_segments() {
        let params = SegmentParams::default();
        for (w, h) in [(0, 0), (1, 70), (70, 1), (4, 4)] {
            assert!(detect_segments(&Gray::new(w, h), &params).0.is_empty());
        }
        let nan = Gray::from_fn(50, 50, |_, _| f32::NAN);
        assert!(detect_segments(&nan, &params).0.is_empty());
    }
}
