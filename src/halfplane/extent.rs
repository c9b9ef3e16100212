//! How far the images bear a plane out: closing lines where it seems to end (B99 4.3).
//!
//! B99 closes a facet by the convex hull of its lines when no line was found at one of its sides. A side whose
//! edge is in no image strongly enough still shows: the views agree on the plane up to it and not beyond.
//! The positions of agreement are counted in strips along and across the plane's longest line; where the
//! counts end, a line may bound the facet. It earns nothing by itself, it only lets the facet end there.

use nalgebra::{Point2, Vector2};

use super::borders::{Border, BorderKind};
use super::grouping::GroupingInput;
use super::hypothesis::{Hypothesis, ON_SURFACE, TEXTURED};

/// Width of a strip, metres: about a correlation window of fine images.
const STRIP_M: f64 = 0.25;
/// A strip with less than this share of the fullest one's positions is beyond the end. A hip's strips become
/// shorter to its corners.
const END_SHARE: f64 = 0.15;
/// Strips without agreement that do not end a plane yet: a dormer, a shadow.
const GAP_STRIPS: usize = 4;
/// Planes with less agreement, square metres, have no end to speak of.
const LEAST_AGREEMENT_M2: f64 = 4.0;
/// How far an end goes beyond the sides across it, metres, to meet their lines.
const OVER_M: f64 = 0.5;

/// Lines where planes seem to end, four for each plane with a half-plane.
pub fn extent_lines(input: &GroupingInput, hypotheses: &[Hypothesis]) -> Vec<Border> {
    crate::parallel::map(hypotheses, |_, h| sides(input, h).unwrap_or_default())
        .into_iter()
        .flatten()
        .collect()
}

/// The four sides of the rectangle along the longest line in which the views agree on a plane.
fn sides(input: &GroupingInput, h: &Hypothesis) -> Option<Vec<Border>> {
    if h.group.half_planes().is_empty() {
        return None;
    }
    let longest = (h.group.members.iter())
        .map(|m| &input.lines[m.line.index()].segment)
        .max_by(|a, b| a.length().total_cmp(&b.length()))?;
    let start = longest.p0.xy();
    let along = (longest.p1.xy() - start).try_normalize(1e-6)?;
    let across = Vector2::new(-along.y, along.x);
    let agreeing = agreeing_positions(h);
    if agreeing.len() as f64 * h.map.grid.step * h.map.grid.step < LEAST_AGREEMENT_M2 {
        return None;
    }
    let extent = |axis: &Vector2<f64>| extent(agreeing.iter().map(|p| (p - start).dot(axis)));
    let ((t0, t1), (u0, u1)) = (extent(&along), extent(&across));
    let at = |t: f64, u: f64| start + along * t + across * u;
    let side = |a, b| Border {
        kind: BorderKind::Closing,
        a,
        b,
    };
    let (o0, o1) = (-OVER_M, OVER_M);
    Some(vec![
        side(at(t0 + o0, u0), at(t1 + o1, u0)),
        side(at(t0 + o0, u1), at(t1 + o1, u1)),
        side(at(t0, u0 + o0), at(t0, u1 + o1)),
        side(at(t1, u0 + o0), at(t1, u1 + o1)),
    ])
}

/// The centres of the plan cells in the plane's region where the views clearly agree on it.
fn agreeing_positions(h: &Hypothesis) -> Vec<Point2<f64>> {
    let grid = &h.map.grid;
    (0..grid.width * grid.height)
        .filter(|&k| h.map.correlation(k) >= ON_SURFACE && h.map.weight(k) >= TEXTURED)
        .map(|k| grid.center(k % grid.width, k / grid.width))
        .filter(|p| h.region.contains(p))
        .collect()
}

/// From the fullest strip to the last ones, on both sides, that hold more than a share of its count.
fn extent(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.clone().fold(f64::NEG_INFINITY, f64::max);
    let mut strips = vec![0usize; ((high - low) / STRIP_M) as usize + 1];
    values.for_each(|v| strips[((v - low) / STRIP_M) as usize] += 1);
    let fullest = (0..strips.len())
        .max_by_key(|&i| (strips[i], usize::MAX - i))
        .unwrap_or(0);
    let least = (END_SHARE * strips[fullest] as f64) as usize;
    let last = |outward: &mut dyn Iterator<Item = usize>| {
        let mut last = fullest;
        for i in outward {
            let gap = i.abs_diff(last);
            if strips[i] > least {
                last = i;
            } else if gap > GAP_STRIPS {
                break;
            }
        }
        last
    };
    let first = last(&mut (0..fullest).rev());
    let end = last(&mut (fullest + 1..strips.len()));
    (
        low + first as f64 * STRIP_M,
        low + (end + 1) as f64 * STRIP_M,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_ends_where_agreement_does() {
        // Agreement from 2 m to 9 m with a hole of 0.5 m, and a chance match at 14 m.
        let positions = (0..700)
            .map(|i| 2.0 + f64::from(i) * 0.01)
            .filter(|v| !(5.0..5.5).contains(v))
            .chain([14.0, 14.001]);
        let (first, last) = extent(positions);
        assert!((first - 2.0).abs() <= STRIP_M, "{first}");
        assert!((last - 9.0).abs() <= STRIP_M, "{last}");
    }
}
