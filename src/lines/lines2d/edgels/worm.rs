//! Tangent discontinuities of a chain, found by a worm (B99 3.2).
//!
//! The worm is two arms of a few edgels that crawl along the chain joined at an edgel; it breaks
//! the chain where the angle between its arms is largest and above a threshold. An arm's direction
//! is that of its orthogonal regression line.

use nalgebra::{Point2, Vector2};

use crate::base::params::SegmentParams;
use crate::lines::lines2d::regression::RegressionLine;

/// Positions in the chain at which the tangent breaks, ascending, never the first or the last.
pub(crate) fn tangent_breaks(points: &[Point2<f64>], params: &SegmentParams) -> Vec<usize> {
    let arm = params.worm_arm_edgels;
    if points.len() < 2 * arm + 1 {
        return Vec::new();
    }
    // arms[i] is the direction of the arm that begins at i; the worm at i ends one and begins one.
    let arms: Vec<Vector2<f64>> = points.windows(arm + 1).map(arm_direction).collect();
    let sine2: Vec<f64> = (arm..points.len() - arm)
        .map(|i| bend(&arms[i - arm], &arms[i]))
        .collect();
    let limit = 1.0 - crate::base::math::cos(params.worm_bend_deg.to_radians());
    (0..sine2.len())
        .filter(|&i| sine2[i] > limit && is_peak(&sine2, i, arm))
        .map(|i| i + arm)
        .collect()
}

/// Unit direction of a run of edgels, pointing from its first to its last.
fn arm_direction(points: &[Point2<f64>]) -> Vector2<f64> {
    RegressionLine::new(points).direction
}

/// One minus the cosine of the angle between two arms: 0 when straight, 1 at a right angle.
fn bend(before: &Vector2<f64>, after: &Vector2<f64>) -> f64 {
    1.0 - before.dot(after)
}

/// Whether nothing within `reach` is larger (the first one of equals counts).
fn is_peak(values: &[f64], i: usize, reach: usize) -> bool {
    let from = i.saturating_sub(reach);
    let to = (i + reach + 1).min(values.len());
    values[from..i].iter().all(|v| *v < values[i])
        && values[i + 1..to].iter().all(|v| *v <= values[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(turn_deg: f64) -> Vec<Point2<f64>> {
        let (s, c) = crate::base::math::sin_cos(turn_deg.to_radians());
        let before = (0..20).map(|i| Point2::new(f64::from(i), 0.0));
        let after = (1..20).map(|i| Point2::new(19.0 + f64::from(i) * c, f64::from(i) * s));
        before.chain(after).collect()
    }

    #[test]
    fn a_corner_is_one_break_at_its_place() {
        let params = SegmentParams::default();
        for turn in [30.0, -45.0, 90.0, -120.0] {
            assert_eq!(
                tangent_breaks(&corner(turn), &params),
                [19],
                "{turn} degrees"
            );
        }
    }

    #[test]
    fn straight_and_short_chains_have_no_break() {
        let params = SegmentParams::default();
        assert!(tangent_breaks(&corner(5.0), &params).is_empty());
        assert!(tangent_breaks(&corner(90.0)[16..22], &params).is_empty());
    }
}
