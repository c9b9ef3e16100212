//! Straight pieces grown along their own line through the edgels ahead.
//!
//! B99 3.2 links edgels across one-pixel gaps only. On a tiled roof that leaves a weak ridge or
//! eave in fragments shorter than the 15 px that matching requires, although together they are
//! clearly one line. Therefore a piece predicts where its line continues, takes up the edgels
//! there with the same direction, and is fitted again. The whole line must then pass the tight
//! threshold and the test of significance, in which the pixels of its gaps count against it.

use nalgebra::Point2;

use super::edgels::{Edgel, NONE, Raster};
use super::regression::{PointMoments, RegressionLine};
use crate::base::geometry::Segment2;
use crate::base::params::SegmentParams;

/// The edgels of a line in order along it, and the line.
#[derive(Clone, Debug)]
pub(super) struct GrownLine {
    /// Indices into the edgels.
    pub edgels: Vec<u32>,
    /// Their positions, px.
    pub points: Vec<Point2<f64>>,
    /// The line fitted to them.
    pub line: RegressionLine,
}

impl GrownLine {
    /// A line through these edgels.
    pub(super) fn new(all: &[Edgel], edgels: Vec<u32>) -> Self {
        let points: Vec<_> = edgels.iter().map(|&i| all[i as usize].position).collect();
        let line = RegressionLine::new(&points);
        Self {
            edgels,
            points,
            line,
        }
    }

    /// The stretch of the line from its first to its last edgel.
    pub(super) fn extent(&self) -> Segment2 {
        let along = self.points.iter().map(|p| self.line.along(p));
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), t| {
            (l.min(t), h.max(t))
        });
        let at = |t: f64| self.line.centroid + self.line.direction * t;
        Segment2::new(at(low), at(high))
    }

    fn reverse(&mut self) {
        self.edgels.reverse();
        self.points.reverse();
        self.line.direction = -self.line.direction;
    }
}

/// The line of a seed, grown where that keeps it tight and as it is elsewhere.
pub(super) fn grow_tight(
    all: &[Edgel],
    raster: &Raster,
    seed: &[u32],
    free: &impl Fn(u32) -> bool,
    params: &SegmentParams,
) -> GrownLine {
    // Long gaps lead a weak line astray in texture, where short ones may still succeed.
    for gap_px in [params.grow_gap_px, params.grow_gap_px / 3] {
        let grown = grow(all, raster, seed, gap_px, free, params);
        if grown.line.is_tight(&grown.points, params) {
            return grown;
        }
    }
    GrownLine::new(all, seed.to_vec())
}

/// Grows a seed at both ends through the edgels that `free` allows.
fn grow(
    all: &[Edgel],
    raster: &Raster,
    seed: &[u32],
    gap_px: usize,
    free: &impl Fn(u32) -> bool,
    params: &SegmentParams,
) -> GrownLine {
    let mut grown = GrownLine::new(all, seed.to_vec());
    let cosine = crate::base::math::cos(params.grow_turn_deg.to_radians());
    let mut moments = PointMoments::about(grown.points[0]);
    grown.points.iter().for_each(|p| moments.add(p));
    // The direction follows the contrast while growing forward and opposes it while growing back.
    for sense in [1.0, -1.0] {
        while let Some(i) = ahead(all, raster, &grown, gap_px, sense * cosine, free, params) {
            grown.edgels.push(i);
            let position = all[i as usize].position;
            grown.points.push(position);
            moments.add(&position);
            grown.line = moments.line(&grown.line.direction);
        }
        grown.reverse();
    }
    grown
}

/// The next edgel along the line beyond the last one, within the largest gap. `cosine` is that of
/// the largest turn, negative where edgels run against the line.
fn ahead(
    all: &[Edgel],
    raster: &Raster,
    grown: &GrownLine,
    gap_px: usize,
    cosine: f64,
    free: &impl Fn(u32) -> bool,
    params: &SegmentParams,
) -> Option<u32> {
    let line = &grown.line;
    let last = line.along(grown.points.last()?);
    let step = 1.0 / line.direction.x.abs().max(line.direction.y.abs());
    let sense = cosine.signum();
    let fits = |i: u32| {
        let edgel = &all[i as usize];
        line.along(&edgel.position) > last + 0.25
            && line.across(&edgel.position).abs() <= params.max_residual_px
            && edgel.tangent().dot(&line.direction) * sense >= cosine.abs()
            && free(i)
    };
    // Columns of three pixels across the line, one after the other.
    let across_is_y = line.direction.x.abs() >= line.direction.y.abs();
    for k in 1..=gap_px + 1 {
        let p = line.centroid + line.direction * (last + k as f64 * step);
        let (x, y) = (p.x.floor() as isize, p.y.floor() as isize);
        let mut best = (f64::INFINITY, NONE);
        for d in [0, -1, 1] {
            let (x, y) = if across_is_y { (x, y + d) } else { (x + d, y) };
            let i = raster.at(x, y);
            if i != NONE && fits(i) {
                let distance = line.across(&all[i as usize].position).abs();
                if distance < best.0 {
                    best = (distance, i);
                }
            }
        }
        if best.1 != NONE {
            return Some(best.1);
        }
    }
    None
}
