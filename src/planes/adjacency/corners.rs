//! The corners of an image, where ends of its segments meet, and their edges in cyclic order.
//!
//! Two ends of segments meet where it is likelier that both should reach the point at which their
//! lines cross than that one lies there by chance. With g the distance of an end from that point
//! along its line, p(g) what is measured of true ends (Laplace), and rho the ends per square pixel:
//!
//! ```text
//! nats = ln p(g1) + ln p(g2) - ln rho + ln(pi / 2)
//! ```
//!
//! The Jacobian of (place of the second end) -> (g1, g2) is the sine of the angle between the
//! lines; directions at corners are spread as pi / 2 times that sine, which cancels it. A further
//! end joins where ln p(g) + ln N(distance of the corner from its line) - ln rho is positive.

use nalgebra::{Matrix2, Point2, Vector2};

use super::graph::{CornerEdge, ImageCorner, ImageGraph};
use super::sectors;
use crate::base::evidence::UncertaintyTable;
use crate::base::ids::SegmentId;
use crate::base::math::{atan2, ln};
use crate::base::plan_index::PlanIndex;
use crate::lines::lines2d::ImageSegment;
use crate::orienting::scene::View;
use crate::planes::coplanar::log_normal;

/// The end of a segment: its index, and whether it is the second end.
type End = (SegmentId, bool);

/// What is needed of one end.
#[derive(Clone, Copy)]
struct EndLine<'a> {
    segment: &'a ImageSegment,
    /// The end.
    at: Point2<f64>,
    /// Unit direction from the end to the far end.
    inwards: Vector2<f64>,
}

impl EndLine<'_> {
    /// Distance along the line that the end falls short of a place, pixels.
    fn gap(&self, p: &Point2<f64>) -> f64 {
        -(p - self.at).dot(&self.inwards)
    }

    /// Distance of a place from the line, pixels, and its variance.
    fn across(&self, p: &Point2<f64>) -> (f64, f64) {
        let middle = self.segment.segment.midpoint();
        let along = (p - middle).dot(&self.segment.segment.direction());
        let c = &self.segment.covariance;
        let variance = c[(0, 0)] + 2.0 * along * c[(0, 1)] + along * along * c[(1, 1)];
        let sigma = UncertaintyTable::fitted()
            .height
            .of(variance.max(0.0).sqrt(), 1.0);
        (
            (p - middle).dot(&self.segment.segment.normal()),
            sigma * sigma,
        )
    }

    /// Standard deviation of the direction, radians: of its two ends as they are stated.
    fn sigma_of_direction(&self) -> f64 {
        let half = 0.5 * self.segment.segment.length();
        let off = self.segment.covariance[(1, 1)].max(0.0).sqrt() * half;
        UncertaintyTable::fitted().height.of(off, 1.0) / half.max(1.0)
    }
}

/// A corner while it grows.
struct Growing {
    ends: Vec<End>,
    at: Point2<f64>,
    covariance: Matrix2<f64>,
    nats: f64,
}

/// What all corners of a view share.
struct Builder<'a> {
    segments: &'a [ImageSegment],
    /// Mean distance of an end from its corner, pixels.
    mean_gap: f64,
    /// Ends per square pixel.
    density: f64,
}

/// The graph of a view. `mean_gap_px` is how far ends of segments lie from the corners that they
/// should reach.
pub(super) fn image_graph(view: &View, segments: &[ImageSegment], mean_gap_px: f64) -> ImageGraph {
    let area = f64::from(view.camera.width) * f64::from(view.camera.height);
    let builder = Builder {
        segments,
        mean_gap: mean_gap_px,
        density: 2.0 * segments.len().max(1) as f64 / area,
    };
    let grown = builder.grow();
    let corners = builder.corners(&grown);
    sectors::with_regions(view, corners)
}

impl<'a> Builder<'a> {
    fn end(&self, (id, second): End) -> EndLine<'a> {
        let segment = &self.segments[id.index()];
        let s = &segment.segment;
        let d = s.direction();
        match second {
            false => EndLine {
                segment,
                at: s.p0,
                inwards: d,
            },
            true => EndLine {
                segment,
                at: s.p1,
                inwards: -d,
            },
        }
    }

    fn log_gap(&self, gap: f64) -> f64 {
        -gap.abs() / self.mean_gap - ln(2.0 * self.mean_gap)
    }

    /// Are the directions of two lines likelier different than the same?
    fn differ(a: &EndLine, b: &EndLine) -> bool {
        let [s, t] = [a, b].map(EndLine::sigma_of_direction);
        let angle = atan2(
            a.inwards.perp(&b.inwards).abs(),
            a.inwards.dot(&b.inwards).abs(),
        );
        log_normal(angle, s * s + t * t) < -ln(std::f64::consts::PI)
    }

    /// What speaks for two ends meeting, nats.
    fn nats_of_pair(&self, a: &EndLine, b: &EndLine) -> Option<f64> {
        Self::differ(a, b).then_some(())?;
        let p = a.at + a.inwards * (b.at - a.at).perp(&b.inwards) / a.inwards.perp(&b.inwards);
        let gaps = self.log_gap(a.gap(&p)) + self.log_gap(b.gap(&p));
        Some(gaps - ln(self.density) + ln(std::f64::consts::FRAC_PI_2))
    }

    /// What speaks for an end reaching a corner, nats.
    fn nats_of_end(&self, corner: &Growing, end: &EndLine) -> f64 {
        let (off, variance) = end.across(&corner.at);
        let n = end.segment.segment.normal();
        let variance = variance + n.dot(&(corner.covariance * n));
        self.log_gap(end.gap(&corner.at)) + log_normal(off, variance) - ln(self.density)
    }

    /// The place where the lines of some ends meet: weighted least squares, each end with its
    /// distance along its line as well.
    fn meet(&self, ends: &[End]) -> (Point2<f64>, Matrix2<f64>) {
        let along = 0.5 / (self.mean_gap * self.mean_gap);
        let first = self.end(ends[0]).at;
        let mut at = first;
        let mut covariance = Matrix2::identity();
        // Variances depend on the place; they change little after the first round.
        for _ in 0..2 {
            let (mut information, mut sum) = (Matrix2::zeros(), Vector2::zeros());
            for end in ends.iter().map(|&e| self.end(e)) {
                let (_, variance) = end.across(&at);
                let n = end.segment.segment.normal();
                let weight =
                    n * n.transpose() / variance + end.inwards * end.inwards.transpose() * along;
                information += weight;
                sum += weight * (end.at - first);
            }
            covariance = (information.try_inverse()).expect("each end has both directions");
            at = first + covariance * sum;
        }
        (at, covariance)
    }

    /// Ends joined to corners, the likeliest pairs first.
    fn grow(&self) -> Vec<Growing> {
        let ids = (0..self.segments.len()).map(SegmentId::from_index);
        let ends: Vec<End> = ids.flat_map(|id| [(id, false), (id, true)]).collect();
        let index = PlanIndex::new(ends.iter().map(|&e| [self.end(e).at; 2]));
        let bound =
            -2.0 * ln(2.0 * self.mean_gap) - ln(self.density) + ln(std::f64::consts::FRAC_PI_2);
        let reach = self.mean_gap * bound.max(0.0);
        let mut pairs = Vec::new();
        for (i, &first) in ends.iter().enumerate() {
            let a = self.end(first);
            for j in index.touching([a.at; 2], reach) {
                let second = ends[j as usize];
                if j as usize <= i || second.0 == first.0 {
                    continue;
                }
                let nats = self.nats_of_pair(&a, &self.end(second));
                pairs.extend(nats.filter(|n| *n > 0.0).map(|n| (n, first, second)));
            }
        }
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut corner_of = std::collections::BTreeMap::<End, usize>::new();
        let mut found: Vec<Growing> = Vec::new();
        for (nats, a, b) in pairs {
            match (corner_of.get(&a).copied(), corner_of.get(&b).copied()) {
                (None, None) => {
                    let (at, covariance) = self.meet(&[a, b]);
                    corner_of.extend([(a, found.len()), (b, found.len())]);
                    found.push(Growing {
                        ends: vec![a, b],
                        at,
                        covariance,
                        nats,
                    });
                }
                (Some(k), None) | (None, Some(k)) => {
                    let new = if corner_of.contains_key(&a) { b } else { a };
                    let line = self.end(new);
                    let corner = &mut found[k];
                    let has_it = corner.ends.iter().any(|e| e.0 == new.0);
                    let is_new = |e: &End| Self::differ(&line, &self.end(*e));
                    let nats = self.nats_of_end(corner, &line);
                    if nats > 0.0 && !has_it && corner.ends.iter().all(is_new) {
                        corner.ends.push(new);
                        (corner.at, corner.covariance) = self.meet(&corner.ends);
                        corner.nats += nats;
                        corner_of.insert(new, k);
                    }
                }
                (Some(_), Some(_)) => {}
            }
        }
        found
    }

    /// Corners with their edges in cyclic order; regions are still to come.
    fn corners(&self, grown: &[Growing]) -> Vec<ImageCorner> {
        let sorted: Vec<Vec<End>> = (grown.iter())
            .map(|corner| {
                let mut ends = corner.ends.clone();
                let angle = |e: &End| {
                    let d = self.end(*e).inwards;
                    atan2(d.y, d.x)
                };
                ends.sort_by(|a, b| angle(a).total_cmp(&angle(b)).then(a.cmp(b)));
                ends
            })
            .collect();
        let mut place = std::collections::BTreeMap::<End, [u32; 2]>::new();
        for (c, ends) in sorted.iter().enumerate() {
            place.extend(
                ends.iter()
                    .enumerate()
                    .map(|(k, e)| (*e, [c as u32, k as u32])),
            );
        }
        let edge = |&(id, second): &End| {
            let end = self.end((id, second));
            let neighbour = place.get(&(id, !second)).copied();
            let far = self.end((id, !second)).at;
            CornerEdge {
                segment: id.0,
                far: neighbour.map_or(far, |[c, _]| grown[c as usize].at),
                direction: end.inwards,
                sigma: end.sigma_of_direction(),
                neighbour,
                region: 0,
            }
        };
        let corner = |(corner, ends): (&Growing, &Vec<End>)| ImageCorner {
            at: corner.at,
            covariance: corner.covariance.into(),
            edges: ends.iter().map(edge).collect(),
            nats: corner.nats,
        };
        grown.iter().zip(&sorted).map(corner).collect()
    }
}
