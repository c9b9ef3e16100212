//! From edgels to the significant straight lines among them.
//!
//! Chains, straight pieces, growth along the line, and then the tests of length, curvature and
//! significance.

use nalgebra::Point2;

use super::edgels::{Chain, Edgel, LocalStrengths, Raster, link_on, tangent_breaks};
use super::grow::{GrownLine, grow_tight};
use super::regression::straight_pieces;
use super::significance::FalseAlarms;
use super::trace::{RejectedSegment, SegmentRejection, SegmentTrace};
use crate::base::geometry::Segment2;
use crate::base::params::SegmentParams;

/// The lines of some edgels, those of the longest pieces first.
pub(super) fn significant_lines(
    edgels: &[Edgel],
    local: &LocalStrengths,
    params: &SegmentParams,
    trace: &mut SegmentTrace,
) -> Vec<GrownLine> {
    let raster = Raster::new(edgels);
    let chains = link_on(edgels, &raster, params.edgels.high);
    let mut seeds: Vec<Vec<u32>> = chains
        .iter()
        .flat_map(|chain| seeds_of(chain, edgels, params, trace))
        .collect();
    // The longest predict best and come first; the stable sort keeps the order of the chains.
    seeds.sort_by_key(|seed| std::cmp::Reverse(seed.len()));
    trace.edgels += edgels.len();
    trace.chains += chains.len();
    trace.seeds += seeds.len();

    let mut alarms = FalseAlarms::new(seeds.len());
    let mut taken = vec![false; edgels.len()];
    let mut lines = Vec::new();
    for seed in &seeds {
        if seed.iter().filter(|&&i| taken[i as usize]).count() * 2 > seed.len() {
            trace.taken += 1;
            continue;
        }
        let line = grow_tight(edgels, &raster, seed, &|i| !taken[i as usize], params);
        let segment = line.extent();
        match rejection_of(&line, &segment, edgels, local, &mut alarms, params) {
            None => {
                line.edgels.iter().for_each(|&i| taken[i as usize] = true);
                lines.push(line);
            }
            Some(reason) => trace.reject(RejectedSegment { segment, reason }),
        }
    }
    lines
}

/// The straight pieces of a chain, as edgel indices.
fn seeds_of(
    chain: &Chain,
    edgels: &[Edgel],
    params: &SegmentParams,
    trace: &mut SegmentTrace,
) -> Vec<Vec<u32>> {
    if chain.edgels.len() < params.seed_edgels {
        trace.short_chains += 1;
        return Vec::new();
    }
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

/// Why the line is no segment, if it is none.
fn rejection_of(
    grown: &GrownLine,
    segment: &Segment2,
    edgels: &[Edgel],
    local: &LocalStrengths,
    alarms: &mut FalseAlarms,
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
    let surprisal = |&i: &u32| {
        let edgel = &edgels[i as usize];
        let (x, y) = edgel.pixel();
        let across = edgel.gradient.cast::<f64>().dot(&normal).max(0.0);
        f64::from(local.surprisal(x, y, across as f32))
    };
    let sum: f64 = grown.edgels.iter().map(surprisal).sum();
    // One edgel a pixel along the main axis, were there no gaps.
    let step = segment.p1 - segment.p0;
    let pixels = (step.x.abs().max(step.y.abs()) + 1.0).max(grown.edgels.len() as f64);
    let alarms = alarms.ln(pixels / correlated, sum / correlated);
    (alarms > params.max_ln_false_alarms).then_some(SegmentRejection::NotSignificant)
}
