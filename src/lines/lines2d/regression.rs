//! Lines fitted to runs of edgels by orthogonal regression with a tight threshold (B99 3.2).
//!
//! "A very tight threshold is used for the line fitting so that curves are not piecewise linear
//! approximated." A run that does not fit is split where it is farthest from its chord, and
//! neighbouring pieces that fit one line together are joined again. A piece that still bends (a
//! parabola explains it significantly better than the line) belongs to a curve and is rejected.

use nalgebra::{Matrix2, Point2, Vector2};

use crate::base::params::SegmentParams;

/// Fewest edgels of a piece on the way; shorter ones are not split.
const MIN_EDGELS: usize = 4;

/// An orthogonal regression line through points in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RegressionLine {
    /// Mean of the points, px.
    pub centroid: Point2<f64>,
    /// Unit direction, from the first point to the last.
    pub direction: Vector2<f64>,
    /// Number of points.
    pub count: usize,
    /// Sum of squared positions along the line about the centroid, px^2.
    pub spread: f64,
    /// Root mean square distance from the line, px.
    pub rms: f64,
}

impl RegressionLine {
    /// Fits a line to at least two distinct points.
    pub(super) fn new(points: &[Point2<f64>]) -> Self {
        let mut moments = PointMoments::about(points[0]);
        points.iter().for_each(|p| moments.add(p));
        moments.line(&(points[points.len() - 1] - points[0]))
    }

    /// Unit normal (-dy, dx).
    pub(super) fn normal(&self) -> Vector2<f64> {
        Vector2::new(-self.direction.y, self.direction.x)
    }

    /// Position along the line from the centroid, px.
    pub(super) fn along(&self, point: &Point2<f64>) -> f64 {
        self.direction.dot(&(point - self.centroid))
    }

    /// Signed distance from the line, px.
    pub(super) fn across(&self, point: &Point2<f64>) -> f64 {
        self.normal().dot(&(point - self.centroid))
    }

    /// Whether the line fits within the tight threshold.
    pub(super) fn is_tight(&self, points: &[Point2<f64>], params: &SegmentParams) -> bool {
        self.rms <= params.max_rms_px
            && points
                .iter()
                .all(|p| self.across(p).abs() <= params.max_residual_px)
    }

    /// Covariance of (offset along the normal in px, angle in rad) at the position `along` the
    /// line. `correlated` consecutive edgels count as one; `floor_px` is the least standard
    /// deviation of an edgel.
    pub(super) fn covariance(&self, along: f64, correlated: f64, floor_px: f64) -> Matrix2<f64> {
        // Two parameters are taken out of the independent errors.
        let independent = (self.count as f64 / correlated - 2.0).max(1.0);
        let scale = (independent + 2.0) / independent;
        let edgel = (self.rms * self.rms * scale).max(floor_px * floor_px) * correlated;
        let angle = edgel / self.spread;
        let centre = edgel / self.count as f64;
        Matrix2::new(
            centre + angle * along * along,
            angle * along,
            angle * along,
            angle,
        )
    }

    /// How many consecutive edgels err together: 1 + 2 sum of the autocorrelation of their
    /// distances from the line, up to the first lag without any.
    ///
    /// Smoothing alone makes neighbours alike: white noise after a Gaussian of standard deviation
    /// s is correlated as exp(-d^2 / 4 s^2), so that it is 2 sqrt(pi) s at least. Tiles, planks
    /// and shadows reach farther.
    pub(super) fn correlated_edgels(&self, points: &[Point2<f64>], smoothing_px: f64) -> f64 {
        let least = (2.0 * std::f64::consts::PI.sqrt() * smoothing_px).max(1.0);
        let across: Vec<f64> = points.iter().map(|p| self.across(p)).collect();
        let power: f64 = across.iter().map(|d| d * d).sum();
        let mut sum = 1.0;
        for lag in 1..points.len() / 4 {
            let pairs = across.iter().zip(&across[lag..]);
            let product: f64 = pairs.map(|(a, b)| a * b).sum();
            if product <= 0.0 {
                break;
            }
            sum += 2.0 * product / power;
        }
        sum.max(least)
    }

    /// Curvature of the best parabola (1/px) and its standard deviation.
    pub(super) fn curvature(&self, points: &[Point2<f64>]) -> (f64, f64) {
        // Orthogonal polynomial of degree 2 on the positions along the line: t^2 - b t - m.
        let n = points.len() as f64;
        let m = self.spread / n;
        let cube: f64 = points.iter().map(|p| cubed(self.along(p))).sum();
        let b = cube / self.spread.max(1e-12);
        let (mut top, mut bottom) = (0.0, 0.0);
        for p in points {
            let t = self.along(p);
            let basis = t * t - b * t - m;
            top += basis * self.across(p);
            bottom += basis * basis;
        }
        let bottom = bottom.max(1e-12);
        (2.0 * top / bottom, 2.0 * self.rms / bottom.sqrt())
    }
}

fn cubed(t: f64) -> f64 {
    t * t * t
}

/// Sums over points from which their line follows, to which points can be added one by one.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointMoments {
    /// What the sums are about, near the points: sums about the image's corner would lose digits.
    origin: Point2<f64>,
    count: usize,
    sum: Vector2<f64>,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl PointMoments {
    /// Of no points yet.
    pub(super) fn about(origin: Point2<f64>) -> Self {
        Self {
            origin,
            count: 0,
            sum: Vector2::zeros(),
            xx: 0.0,
            xy: 0.0,
            yy: 0.0,
        }
    }

    /// Adds a point.
    pub(super) fn add(&mut self, point: &Point2<f64>) {
        let d = point - self.origin;
        self.count += 1;
        self.sum += d;
        self.xx += d.x * d.x;
        self.xy += d.x * d.y;
        self.yy += d.y * d.y;
    }

    /// The orthogonal regression line, in the sense of `chord`.
    pub(super) fn line(&self, chord: &Vector2<f64>) -> RegressionLine {
        let n = self.count as f64;
        let mean = self.sum / n;
        let xx = self.xx - n * mean.x * mean.x;
        let xy = self.xy - n * mean.x * mean.y;
        let yy = self.yy - n * mean.y * mean.y;
        let (half_sum, half_difference) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let radius = (half_difference * half_difference + xy * xy).sqrt();
        // The eigenvector of the larger eigenvalue, from the better conditioned row.
        let axis = if half_difference >= 0.0 {
            Vector2::new(half_difference + radius, xy)
        } else {
            Vector2::new(xy, radius - half_difference)
        };
        let axis = if axis.dot(chord) < 0.0 { -axis } else { axis };
        let norm = axis.norm();
        RegressionLine {
            centroid: self.origin + mean,
            direction: if norm > 0.0 {
                axis / norm
            } else {
                Vector2::x()
            },
            count: self.count,
            spread: half_sum + radius,
            rms: ((half_sum - radius).max(0.0) / n).sqrt(),
        }
    }
}

/// A stretch of a chain (`points[from..to]`) with its line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StraightPiece {
    /// First point.
    pub from: usize,
    /// One past the last point.
    pub to: usize,
    /// The line.
    pub line: RegressionLine,
}

/// The straight pieces of one smooth run `points[from..to]`, in order.
pub(super) fn straight_pieces(
    points: &[Point2<f64>],
    from: usize,
    to: usize,
    params: &SegmentParams,
) -> Vec<StraightPiece> {
    let mut pieces = Vec::new();
    split(points, from, to, params, &mut pieces);
    let mut joined: Vec<StraightPiece> = Vec::new();
    for piece in pieces {
        let piece = match joined.last() {
            Some(last) => match join(points, last, &piece, params) {
                Some(both) => {
                    joined.pop();
                    both
                }
                None => piece,
            },
            None => piece,
        };
        joined.push(piece);
    }
    joined
}

fn split(
    points: &[Point2<f64>],
    from: usize,
    to: usize,
    params: &SegmentParams,
    pieces: &mut Vec<StraightPiece>,
) {
    if to - from < MIN_EDGELS {
        return;
    }
    let run = &points[from..to];
    let line = RegressionLine::new(run);
    if line.is_tight(run, params) {
        pieces.push(StraightPiece { from, to, line });
        return;
    }
    let middle = from + farthest_from_chord(run);
    split(points, from, middle + 1, params, pieces);
    split(points, middle, to, params, pieces);
}

/// Index of the inner point farthest from the chord between the ends.
fn farthest_from_chord(run: &[Point2<f64>]) -> usize {
    let chord = run[run.len() - 1] - run[0];
    let mut best = (-1.0, 0);
    for (i, p) in run.iter().enumerate().take(run.len() - 1).skip(1) {
        let d = p - run[0];
        let distance = (d.x * chord.y - d.y * chord.x).abs();
        if distance > best.0 {
            best = (distance, i);
        }
    }
    best.1
}

fn join(
    points: &[Point2<f64>],
    a: &StraightPiece,
    b: &StraightPiece,
    params: &SegmentParams,
) -> Option<StraightPiece> {
    let run = &points[a.from..b.to];
    let line = RegressionLine::new(run);
    line.is_tight(run, params).then_some(StraightPiece {
        from: a.from,
        to: b.to,
        line,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_planted_line_is_recovered(angle in 0.0..std::f64::consts::TAU, offset in -50.0..50.0f64) {
            let (s, c) = crate::base::math::sin_cos(angle);
            let (direction, normal) = (Vector2::new(c, s), Vector2::new(-s, c));
            let at = |t: i32| Point2::from(direction * f64::from(t) + normal * offset);
            let points: Vec<_> = (0..20).map(at).collect();
            let line = RegressionLine::new(&points);
            prop_assert!((line.direction - direction).norm() < 1e-9);
            prop_assert!((line.normal().dot(&line.centroid.coords) - offset).abs() < 1e-9);
            prop_assert!(line.rms < 1e-6);
            prop_assert!((line.spread - 665.0).abs() < 1e-6);
        }
    }

    /// Points of a circle through the origin, curved to the side of the normal for a positive
    /// radius.
    fn arc(radius: f64, count: i32) -> Vec<Point2<f64>> {
        let at = |i: i32| {
            let (s, c) = crate::base::math::sin_cos(f64::from(i) / radius.abs());
            Point2::new(radius.abs() * s, radius * (1.0 - c))
        };
        (0..count).map(at).collect()
    }

    #[test]
    fn the_curvature_of_an_arc_is_one_over_its_radius() {
        for radius in [150.0, -400.0] {
            let points = arc(radius, 40);
            let (curvature, sigma) = RegressionLine::new(&points).curvature(&points);
            assert!((curvature * radius - 1.0).abs() < 0.02, "{curvature}");
            assert!(curvature.abs() > 3.0 * sigma);
        }
    }

    #[test]
    fn a_tight_bend_is_split_where_it_is_farthest_from_its_chord() {
        let mut points: Vec<_> = (0..30).map(|i| Point2::new(f64::from(i), 0.0)).collect();
        points.extend((1..30).map(|i| Point2::new(29.0 + f64::from(i), 0.3 * f64::from(i))));
        let pieces = straight_pieces(&points, 0, points.len(), &SegmentParams::default());
        let cuts: Vec<_> = pieces.iter().map(|p| (p.from, p.to)).collect();
        assert_eq!(cuts, [(0, 30), (29, 59)]);
    }

    #[test]
    fn the_covariance_follows_from_independent_edgels() {
        // Without smoothing: sigma^2 / n for the offset and sigma^2 / sum t^2 for the angle.
        let points: Vec<_> = (0..40)
            .map(|i| Point2::new(f64::from(i), if i % 2 == 0 { 0.1 } else { -0.1 }))
            .collect();
        let line = RegressionLine::new(&points);
        let c = line.covariance(0.0, 1.0, 0.0);
        let sigma2 = 0.01 * 40.0 / 38.0;
        assert!((c[(0, 0)] / (sigma2 / 40.0) - 1.0).abs() < 0.01);
        assert!((c[(1, 1)] / (sigma2 / 5330.0) - 1.0).abs() < 0.01);
        // Ten pixels from the centroid the offset takes up the angle's uncertainty.
        let off = line.covariance(10.0, 1.0, 0.0);
        assert!((off[(0, 0)] - c[(0, 0)] - 100.0 * c[(1, 1)]).abs() < 1e-12);
        assert!((off[(0, 1)] - 10.0 * c[(1, 1)]).abs() < 1e-12);
    }
}
