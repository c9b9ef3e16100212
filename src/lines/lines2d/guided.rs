//! Edges measured again where a line is expected: "the third view without a segment" of B99 3.2,
//! for every view of 3.4.
//!
//! A detector does not know the other views: it breaks a weak edge into fragments, misses it, or
//! follows a gutter for half of its way along an eave. Once two views predict a line, the edge is
//! measured along the prediction: the profile across it is averaged over short pieces, so that a
//! step far below the noise of a pixel shows, each piece gives one offset, and a robust line
//! through the offsets is the measurement. Grey values decide whether there is an edge, linear
//! light where it is ([`crate::photographs::raster::Channel::to_linear_light`]). A view in which
//! the pieces do not line up has no edge there.
//!
//! Deviation: the paper verifies a view without a segment by correlation alone. Correlation says
//! that the surroundings are alike, not where the line is; a measured offset takes part in the
//! fit.

use nalgebra::{Matrix2, Point2};

use super::segment::SegmentKind;
use crate::base::geometry::Segment2;
use crate::base::ids::ViewId;
use crate::base::least_squares::Loss;
use crate::base::math::SURE_RESIDUAL_SIGMAS;
use crate::photographs::raster::Gray;

/// Shortest piece whose profile is averaged, px.
pub(crate) const PIECE_PX: f64 = 5.0;
/// Distance from the prediction up to which an edge is sought, px. Assumption: half the least
/// distance of two edges that a detector with a smoothing of one pixel keeps apart.
const REACH_PX: f64 = 1.5;
/// Step of the profile, px: two samples a pixel.
const PROFILE_STEP_PX: f64 = 0.5;
/// Half the base of the derivative, in steps: one pixel.
const BASE: usize = 2;
/// Samples of the profile: the reach, a neighbour for the maximum test and the base on either side.
const SAMPLES: usize = PROFILE_STEPS + 2 * BASE;
/// Steps of the profile: three of the reach and a neighbour on either side, and the middle.
const PROFILE_STEPS: usize = 2 * (3 + 1) + 1;
/// Offset from the robust line beyond which a piece does not belong to the edge, px.
const INLIER_PX: f64 = 0.6;
/// Scale of the robust loss, px.
const LOSS_PX: f64 = 0.3;
/// Least standard deviation of a piece's offset, px.
const FLOOR_PX: f64 = 0.1;
/// Least number of pieces on the edge.
const MIN_PIECES: usize = 3;
/// Least share of the pieces inside the image that lie on the edge.
const MIN_SHARE: f64 = 0.5;

/// An edge measured along a predicted line.
#[derive(Clone, Debug, PartialEq)]
pub struct GuidedEdge {
    /// The view.
    pub view: ViewId,
    /// In which channel it shows.
    pub kind: SegmentKind,
    /// The edge, from its first to its last piece, px.
    pub segment: Segment2,
    /// Covariance of (offset along the normal at the middle in px, angle in rad).
    pub covariance: Matrix2<f64>,
    /// The pieces on it, px.
    pub pieces: Vec<Segment2>,
}

/// A piece of the prediction: place along it and offset of the edge across it, px.
#[derive(Clone, Copy)]
struct ProfilePiece {
    along: f64,
    /// `None` without a significant edge in reach.
    offset: Option<f64>,
}

/// Measures the edge along `expected` (directed by contrast: bright on the side of its normal).
/// The stretch `core`, px from the start, decides whether there is one; beyond it, pieces on the
/// same edge are kept. With `reversed_contrast` the dark side is on the side of the normal. The
/// image is that of the channel of the `kind`, with the standard deviation of the noise of a pixel.
pub fn measure_edge(
    view: ViewId,
    (image, noise): (&Gray, f64),
    kind: SegmentKind,
    expected: &Segment2,
    core: [f64; 2],
    reversed_contrast: bool,
) -> Option<GuidedEdge> {
    let count = (expected.length() / PIECE_PX) as usize;
    (count >= MIN_PIECES).then_some(())?;
    let size = expected.length() / count as f64;
    let pieces: Vec<ProfilePiece> = (0..count)
        .filter_map(|i| {
            measure_piece(
                image,
                kind,
                expected,
                (i as f64 + 0.5) * size,
                size,
                reversed_contrast,
                noise,
            )
        })
        .collect();
    let inside_core = |p: &&ProfilePiece| p.along >= core[0] && p.along <= core[1];
    let in_core: Vec<ProfilePiece> = pieces.iter().filter(inside_core).copied().collect();
    let line = OffsetLine::robust(&in_core)?;
    let on_edge = in_core.iter().filter(|p| line.contains(p)).count();
    if on_edge < MIN_PIECES || (on_edge as f64) < MIN_SHARE * in_core.len() as f64 {
        return None;
    }
    // A single piece between others off the edge lines up by chance.
    let is_on_edge: Vec<bool> = pieces.iter().map(|p| line.contains(p)).collect();
    let beside =
        |i: usize| (i > 0 && is_on_edge[i - 1]) || is_on_edge.get(i + 1).is_some_and(|on| *on);
    let kept: Vec<ProfilePiece> = (0..pieces.len())
        .filter(|&i| is_on_edge[i] && beside(i))
        .map(|i| pieces[i])
        .collect();
    if kept.len() < MIN_PIECES {
        return None;
    }
    Some(line.edge((view, kind), expected, &kept, size))
}

/// One piece; `None` outside the image.
fn measure_piece(
    image: &Gray,
    kind: SegmentKind,
    expected: &Segment2,
    along: f64,
    size: f64,
    reversed_contrast: bool,
    noise: f64,
) -> Option<ProfilePiece> {
    let (direction, normal) = (expected.direction(), expected.normal());
    let rows = size.round() as usize;
    let mut profile = [0.0f64; SAMPLES];
    for row in 0..rows {
        let at = along + (row as f64 + 0.5) / rows as f64 * size - 0.5 * size;
        let centre = expected.p0 + direction * at;
        for (first, values) in profile.chunks_mut(8).enumerate() {
            // Lanes behind the last sample repeat it.
            let places: [Point2<f64>; 8] = std::array::from_fn(|lane| {
                let k = (8 * first + lane).min(SAMPLES - 1);
                let across = (k as f64 - 0.5 * (SAMPLES - 1) as f64) * PROFILE_STEP_PX;
                centre + normal * across
            });
            let samples =
                image.sample_eight(places.map(|p| p.x as f32), places.map(|p| p.y as f32));
            if samples.is_nan().any() {
                return None;
            }
            for (value, sample) in values.iter_mut().zip(samples.to_array()) {
                *value += f64::from(sample);
            }
        }
    }
    profile.iter_mut().for_each(|v| *v /= rows as f64);
    let mut light = profile;
    kind.channel().to_linear_light(&mut light);
    let [response, light] = [profile, light].map(|p| response(&p, reversed_contrast));
    // The difference of two values has the square root of two times their noise.
    let least = SURE_RESIDUAL_SIGMAS * noise * std::f64::consts::SQRT_2 / (rows as f64).sqrt();
    Some(ProfilePiece {
        along,
        offset: nearest_edge(&response, least).and_then(|k| offset(&light, k)),
    })
}

/// Difference of the grey values one pixel beyond a place and one pixel before it, along a profile:
/// largest on the edge.
fn response(profile: &[f64; SAMPLES], reversed_contrast: bool) -> [f64; PROFILE_STEPS] {
    std::array::from_fn(|k| {
        let (before, behind) = (profile[k], profile[k + 2 * BASE]);
        if reversed_contrast {
            before - behind
        } else {
            behind - before
        }
    })
}

/// Index of the edge nearest to the middle of a profile: a maximum of the response of at least
/// half the largest one.
fn nearest_edge(response: &[f64; PROFILE_STEPS], least: f64) -> Option<usize> {
    let inner = 1..PROFILE_STEPS - 1;
    let largest = response[inner.clone()].iter().copied().fold(0.0, f64::max);
    inner
        .filter(|&k| response[k] >= response[k - 1] && response[k] > response[k + 1])
        .filter(|&k| response[k] >= least.max(0.5 * largest))
        .min_by_key(|&k| k.abs_diff(PROFILE_STEPS / 2))
}

/// Offset of an edge, px, by the maximum of the light's response at or beside its index.
fn offset(light: &[f64; PROFILE_STEPS], edge: usize) -> Option<f64> {
    let near = edge.max(2) - 1..=(edge + 1).min(PROFILE_STEPS - 2);
    let k = near.max_by(|&i, &j| light[i].total_cmp(&light[j]))?;
    let bend = light[k - 1] - 2.0 * light[k] + light[k + 1];
    let shift = 0.5 * (light[k - 1] - light[k + 1]) / bend.min(-1e-12);
    let offset = (k as f64 + shift.clamp(-1.0, 1.0) - (PROFILE_STEPS / 2) as f64) * PROFILE_STEP_PX;
    (offset.abs() <= REACH_PX).then_some(offset)
}

/// Offset as a linear function of the place along the prediction.
struct OffsetLine {
    middle: f64,
    offset: f64,
    slope: f64,
}

impl OffsetLine {
    /// The robust line through the offsets: iteratively reweighted least squares from their median.
    fn robust(pieces: &[ProfilePiece]) -> Option<Self> {
        let points: Vec<(f64, f64)> = pieces
            .iter()
            .filter_map(|p| Some((p.along, p.offset?)))
            .collect();
        (points.len() >= MIN_PIECES).then_some(())?;
        let mut offsets: Vec<f64> = points.iter().map(|p| p.1).collect();
        offsets.sort_by(f64::total_cmp);
        let mut line = Self {
            middle: 0.0,
            offset: offsets[offsets.len() / 2],
            slope: 0.0,
        };
        for _ in 0..6 {
            line = line.reweighted(&points);
        }
        Some(line)
    }

    /// One step with Cauchy weights.
    fn reweighted(&self, points: &[(f64, f64)]) -> Self {
        let weight = |&(t, o): &(f64, f64)| {
            let r = o - self.at(t);
            Loss::Cauchy(LOSS_PX).weight(r * r)
        };
        let sum = |f: &dyn Fn(&(f64, f64)) -> f64| -> f64 {
            points.iter().map(|p| weight(p) * f(p)).sum()
        };
        let total = sum(&|_| 1.0);
        let (middle, offset) = (sum(&|p| p.0) / total, sum(&|p| p.1) / total);
        let spread = sum(&|p| (p.0 - middle) * (p.0 - middle));
        let slope = sum(&|p| (p.0 - middle) * (p.1 - offset)) / spread.max(1e-9);
        Self {
            middle,
            offset,
            slope,
        }
    }

    fn at(&self, along: f64) -> f64 {
        self.offset + self.slope * (along - self.middle)
    }

    fn contains(&self, piece: &ProfilePiece) -> bool {
        piece
            .offset
            .is_some_and(|o| (o - self.at(piece.along)).abs() <= INLIER_PX)
    }

    /// The edge in the image, with the covariance that its pieces' scatter gives.
    fn edge(
        &self,
        (view, kind): (ViewId, SegmentKind),
        expected: &Segment2,
        kept: &[ProfilePiece],
        size: f64,
    ) -> GuidedEdge {
        let n = kept.len() as f64;
        let residual = |p: &ProfilePiece| p.offset.unwrap_or(0.0) - self.at(p.along);
        let squares: f64 = kept.iter().map(|p| residual(p) * residual(p)).sum();
        let variance = (squares / (n - 2.0).max(1.0)).max(FLOOR_PX * FLOOR_PX);
        let centre = kept.iter().map(|p| p.along).sum::<f64>() / n;
        let spread: f64 = kept
            .iter()
            .map(|p| (p.along - centre) * (p.along - centre))
            .sum();
        let angle = variance / spread.max(1e-9);

        let place = |along: f64| -> Point2<f64> {
            expected.p0 + expected.direction() * along + expected.normal() * self.at(along)
        };
        let piece = |p: &ProfilePiece| {
            Segment2::new(place(p.along - 0.5 * size), place(p.along + 0.5 * size))
        };
        let (first, last) = (
            kept[0].along - 0.5 * size,
            kept[kept.len() - 1].along + 0.5 * size,
        );
        let lever = 0.5 * (first + last) - centre;
        GuidedEdge {
            view,
            kind,
            segment: Segment2::new(place(first), place(last)),
            covariance: Matrix2::new(
                variance / n + angle * lever * lever,
                angle * lever,
                angle * lever,
                angle,
            ),
            pieces: kept.iter().map(piece).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;
    use crate::roofs::testing::uniform;

    /// A soft step of `height` across `edge`, bright on its right, with reproducible noise.
    fn step(edge: &Segment2, height: f32, noise: f64, seed: u32) -> Gray {
        let line = edge.line();
        let mut next = uniform(seed);
        Gray::from_fn(120, 120, |x, y| {
            let d = line.x * (x as f64 + 0.5) + line.y * (y as f64 + 0.5) + line.z;
            let mut even = || next() - 0.5;
            let white = (even() + even() + even()) * 2.0 * noise;
            0.4 + height * (1.0 / (1.0 + math::exp(-2.5 * d))) as f32 + white as f32
        })
    }

    fn measured(image: &Gray, expected: &Segment2, reversed_contrast: bool) -> Option<GuidedEdge> {
        let core = [0.0, expected.length()];
        measure_edge(
            ViewId(0),
            (image, 0.006),
            SegmentKind::Color,
            expected,
            core,
            reversed_contrast,
        )
    }

    fn edge() -> Segment2 {
        Segment2::new(Point2::new(20.0, 30.0), Point2::new(95.0, 62.0))
    }

    fn shifted(by: f64, turned: f64) -> Segment2 {
        let (e, n) = (edge(), edge().normal());
        Segment2::new(e.p0 + n * (by - turned), e.p1 + n * (by + turned))
    }

    #[test]
    fn a_faint_edge_is_found_beside_its_prediction() {
        // Six grey levels at a noise of two: a single pixel hardly shows it.
        let gray = step(&edge(), 6.0 / 255.0, 2.0 / 255.0, 1);
        let expected = shifted(0.7, 0.4);
        let strong = step(&edge(), 20.0 / 255.0, 2.0 / 255.0, 1);
        for (image, tolerance) in [(&gray, 0.4), (&strong, 0.1)] {
            let found = measured(image, &expected, false).unwrap();
            let line = edge().line();
            for p in [found.segment.p0, found.segment.p1] {
                let d = line.x * p.x + line.y * p.y + line.z;
                assert!(d.abs() < tolerance, "{d}");
            }
        }
    }

    #[test]
    fn the_other_contrast_and_flat_ground_are_no_edge() {
        let gray = step(&edge(), 0.1, 0.004, 1);
        let reversed_contrast = Segment2::new(edge().p1, edge().p0);
        assert!(measured(&gray, &reversed_contrast, false).is_none());
        let flat = step(&edge(), 0.0, 0.004, 1);
        assert!(measured(&flat, &edge(), false).is_none());
        // Where the view is known to show the other contrast it is one, in the same place.
        let found = measured(&gray, &reversed_contrast, true).unwrap();
        for p in [found.segment.p0, found.segment.p1] {
            let line = edge().line();
            assert!((line.x * p.x + line.y * p.y + line.z).abs() < 0.1);
        }
        assert!(measured(&gray, &edge(), true).is_none());
        // An edge out of reach is another edge.
        let beside = shifted(4.0, 0.0);
        assert!(measured(&gray, &beside, false).is_none());
    }

    #[test]
    fn the_covariance_is_that_of_the_scatter() {
        let expected = edge();
        let line = edge().line();
        let (mut sum, mut count) = (0.0, 0.0);
        for seed in 0..40 {
            let gray = step(&edge(), 0.05, 3.0 / 255.0, 977 * seed + 1);
            let Some(found) = measured(&gray, &expected, false) else {
                continue;
            };
            let m = found.segment.at(0.5);
            let d = line.x * m.x + line.y * m.y + line.z;
            sum += d * d / found.covariance[(0, 0)];
            count += 1.0;
        }
        assert!(count > 20.0);
        let ratio = sum / count;
        assert!(ratio > 0.2 && ratio < 3.0, "{ratio}");
    }
}
