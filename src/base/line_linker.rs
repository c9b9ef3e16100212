//! Is this the same line?
//!
//! Two lines are one where every part of the answer says so: the angle between them, the distance
//! across, the stretch that they share. Each part is 1 where nothing separates the two and 0 at its
//! limit, and the least of them is the score (LIMAP, `base/line_linker.h`). Where a line's standard
//! deviation is known, the distance counts beside three of them.
//!
//! All answers are presets of one configuration, for lines in an image, in plan and in space.

use nalgebra::{Point, SVector};

use crate::base::math::{larger, smaller};

/// The ends of a line.
pub(crate) type Ends<const D: usize> = [Point<f64, D>; 2];

/// When two lines are one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LineLinker {
    /// Sine of the largest angle between them; more than 1 for any.
    pub sine: f64,
    /// Must they run the same way?
    pub is_directed: bool,
    /// Largest distance across, in the unit of the lines.
    pub apart: f64,
    /// Largest standard deviation with which a line can be compared, in the same unit.
    pub max_sigma: f64,
    /// So far a line goes on beyond its ends, in the same unit.
    pub beyond: f64,
    /// Least share of the other line that is along the first.
    pub share: f64,
}

/// Sines of 3 and of 10 degrees.
const SINE_3: f64 = 0.052_335_956_242_943_83;
const SINE_10: f64 = 0.173_648_177_666_930_35;

/// A line that is shorter is a point, which has no direction.
const LEAST: f64 = f64::MIN_POSITIVE;

impl LineLinker {
    /// Lines at any angle and distance that overlap.
    const ANY: Self = Self {
        sine: f64::INFINITY,
        is_directed: false,
        apart: f64::INFINITY,
        max_sigma: f64::INFINITY,
        beyond: 0.0,
        share: 0.0,
    };

    /// A colour edge beside an edge in grey values, px: nearer than the detector separates edges,
    /// at both ends of what they share, one is the blur of the other.
    pub(crate) const fn blurred_edge(clear_px: f64) -> Self {
        Self {
            apart: clear_px,
            ..Self::ANY
        }
    }

    /// A segment on the predicted image of a line, px: ends are unreliable, so its distance counts
    /// and its direction only as far as it could not be a crossing edge.
    pub(crate) const fn predicted_image(gate_px: f64) -> Self {
        Self {
            sine: 0.435_889_894_354_067_4,
            apart: gate_px,
            ..Self::ANY
        }
    }

    /// A piece of a measured edge on a segment of another line, px. Assumption: three times the
    /// scatter of the edges of one line (`position_floor_px`).
    pub(crate) const fn measured_edge() -> Self {
        Self {
            apart: 0.3,
            ..Self::ANY
        }
    }

    /// Fragments of one line in space, metres: parallel, and no farther apart along it than a gap
    /// may be; how far beside each other is asked of their images.
    pub(crate) const fn fragments(max_gap_m: f64) -> Self {
        Self {
            sine: SINE_10,
            beyond: max_gap_m,
            ..Self::ANY
        }
    }

    /// An edge on the image of a line, px: what is vaguer than two pixels is on too many edges to
    /// be on one.
    pub(crate) const fn reprojected_fragment(gate_px: f64) -> Self {
        Self {
            apart: gate_px,
            max_sigma: 2.0,
            ..Self::ANY
        }
    }

    /// A line of which another one shows nearly all.
    pub(crate) const fn contained() -> Self {
        Self {
            share: 0.9,
            ..Self::ANY
        }
    }

    /// A line that shows an edge again: parallel to a better one that runs along nearly all of it;
    /// how far beside each other is asked of their images.
    pub(crate) const fn duplicate() -> Self {
        Self {
            sine: SINE_10,
            ..Self::contained()
        }
    }

    /// An edge on the image of a line that shows it again, px: each is asked of the other, so the
    /// more certain one decides, however vague the other.
    pub(crate) const fn reprojected_duplicate(gate_px: f64) -> Self {
        Self {
            apart: gate_px,
            ..Self::ANY
        }
    }

    /// Segments of several views cast onto one plane, metres: those of a line in it have the same
    /// bright side and fall onto each other to a pixel and a half, those of others by chance only.
    pub(crate) const fn cast_onto_plane(pixel_m: f64) -> Self {
        Self {
            sine: 0.06,
            is_directed: true,
            apart: 1.5 * pixel_m,
            share: 0.3,
            ..Self::ANY
        }
    }

    /// Border lines in plan, metres: closer ones would cut slivers from facets.
    pub(crate) const fn border() -> Self {
        Self {
            sine: 0.09,
            apart: 0.3,
            ..Self::ANY
        }
    }

    /// A border of a facet along a real line in plan, metres: where it is, its height is that of
    /// the line; detected ends are unreliable by as much as the distance.
    pub(crate) const fn border_on_line() -> Self {
        Self {
            sine: 0.12,
            apart: 0.25,
            beyond: 0.25,
            ..Self::ANY
        }
    }

    /// An edge of the model along a line, metres: farther than two pixels and a half from it an
    /// edge is another one.
    pub(crate) const fn explained_edge(pixel_m: f64) -> Self {
        Self {
            sine: SINE_3,
            apart: 2.5 * pixel_m,
            beyond: 2.5 * pixel_m,
            ..Self::ANY
        }
    }

    /// An image line of a cluster along the image of a matched line, px; a short one's direction is
    /// as uncertain as its ends.
    pub(crate) const fn explained_image_line(sine: f64, gate_px: f64) -> Self {
        Self {
            sine,
            apart: gate_px,
            beyond: gate_px,
            ..Self::ANY
        }
    }

    /// The side of a facet on an edge that a person names by its ends, metres. Assumption: nobody
    /// means an edge that is farther away.
    pub(crate) const fn named_edge() -> Self {
        Self {
            apart: 0.4,
            beyond: 0.4,
            ..Self::ANY
        }
    }

    /// The same where a line is known to a standard deviation, in its unit: the distance counts
    /// beside three of them, and nothing is the same as one that is too vague.
    pub(crate) fn known_to(self, sigma: f64) -> Self {
        let apart = match sigma <= self.max_sigma {
            true => (self.apart * self.apart + 9.0 * sigma * sigma).sqrt(),
            false => 0.0,
        };
        Self { apart, ..self }
    }

    /// Is a line the same as another one?
    pub(crate) fn connects<const D: usize>(&self, line: &Ends<D>, other: &Ends<D>) -> bool {
        self.score(line, other) >= 0.0
    }

    /// The least of the parts: 1 for the same line, 0 where one of them is at its limit. The
    /// distance is that of the other line's ends from the infinite line.
    pub(crate) fn score<const D: usize>(&self, line: &Ends<D>, other: &Ends<D>) -> f64 {
        let along = Along::new(line);
        let by = other[1] - other[0];
        let angle = self.angle(&along.direction, &by);
        let [s, t] = [&other[0], &other[1]].map(|p| along.of(p));
        let overlap = along.overlap(s, t, self.beyond);
        let length = by.norm();
        let shared = (overlap[1] - overlap[0] - self.share * length) / larger(length, LEAST);
        let [a, b] = [&other[0], &other[1]].map(|p| self.distance(along.across(p)));
        [shared, a, b].into_iter().fold(angle, smaller)
    }

    /// Does a line pass by a point, between its ends or a little beyond them?
    pub(crate) fn passes<const D: usize>(&self, line: &Ends<D>, point: &Point<f64, D>) -> bool {
        let along = Along::new(line);
        let t = along.of(point);
        t >= -self.beyond
            && t <= along.length + self.beyond
            && self.distance(along.across(point)) >= 0.0
    }

    /// The stretch of a line along which another one stays beside it, from its start; `None`
    /// without one, or where the other one is too far from it at an end of the stretch.
    pub(crate) fn shared<const D: usize>(
        &self,
        line: &Ends<D>,
        other: &Ends<D>,
    ) -> Option<[f64; 2]> {
        let along = Along::new(line);
        let by = other[1] - other[0];
        let [s, t] = [&other[0], &other[1]].map(|p| along.of(p));
        let [from, to] = along.overlap(s, t, self.beyond);
        let is_beside = |at: f64| {
            let place = other[0] + by * ((at - s) / (t - s));
            self.distance(along.across(&place)) >= 0.0
        };
        let is_same = to > from
            && self.angle(&along.direction, &by) >= 0.0
            && is_beside(from)
            && is_beside(to);
        is_same.then_some([from, to])
    }

    /// The part of the angle between two directions, the first a unit vector.
    pub(crate) fn angle<const D: usize>(
        &self,
        unit: &SVector<f64, D>,
        other: &SVector<f64, D>,
    ) -> f64 {
        let along = unit.dot(other);
        let sine = (other - unit * along).norm() / larger(other.norm(), LEAST);
        match self.is_directed && along < 0.0 {
            true => -1.0,
            false => 1.0 - sine / self.sine,
        }
    }

    /// The part of the distance across.
    pub(crate) fn distance(&self, across: f64) -> f64 {
        1.0 - across.abs() / self.apart
    }
}

/// Places along a line and across it.
struct Along<'l, const D: usize> {
    start: &'l Point<f64, D>,
    direction: SVector<f64, D>,
    length: f64,
}

impl<'l, const D: usize> Along<'l, D> {
    fn new(line: &'l Ends<D>) -> Self {
        let by = line[1] - line[0];
        let length = by.norm();
        Self {
            start: &line[0],
            direction: by / length,
            length,
        }
    }

    /// From the start to the place that is nearest to a point.
    fn of(&self, point: &Point<f64, D>) -> f64 {
        self.direction.dot(&(point - self.start))
    }

    /// Distance of a point from the infinite line.
    fn across(&self, point: &Point<f64, D>) -> f64 {
        let r = point - self.start;
        (r - self.direction * self.direction.dot(&r)).norm()
    }

    /// The stretch between two places that the line covers; the end before the start without one.
    fn overlap(&self, s: f64, t: f64, beyond: f64) -> [f64; 2] {
        [s.min(t).max(-beyond), s.max(t).min(self.length + beyond)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point2, Point3};

    fn flat(x: [f64; 2], y: [f64; 2]) -> Ends<2> {
        [Point2::new(x[0], y[0]), Point2::new(x[1], y[1])]
    }

    const LINKER: LineLinker = LineLinker {
        sine: 0.1,
        is_directed: false,
        apart: 0.5,
        max_sigma: 1.0,
        beyond: 0.0,
        share: 0.5,
    };

    #[test]
    fn each_part_separates_two_lines() {
        let line = flat([0.0, 10.0], [0.0, 0.0]);
        let score = |other: &Ends<2>| LINKER.score(&line, other);
        assert_eq!(score(&flat([2.0, 6.0], [0.0, 0.0])), 0.5, "what is shared");
        assert!((score(&flat([2.0, 6.0], [0.4, 0.4])) - 0.2).abs() < 1e-12);
        assert!(score(&flat([2.0, 6.0], [-0.25, 0.25])) < 0.0, "askew");
        assert!(score(&flat([2.0, 6.0], [0.6, 0.6])) < 0.0, "beside it");
        assert!(score(&flat([8.0, 14.0], [0.0, 0.0])) < 0.0, "beyond it");
        let back = flat([6.0, 2.0], [0.0, 0.0]);
        assert!(LINKER.connects(&line, &back));
        let directed = LineLinker {
            is_directed: true,
            ..LINKER
        };
        assert!(!directed.connects(&line, &back));
    }

    #[test]
    fn a_gap_is_bridged_as_far_as_lines_go_on() {
        let line = [Point3::origin(), Point3::new(10.0, 0.0, 0.0)];
        let beyond = [Point3::new(12.0, 0.0, 0.1), Point3::new(15.0, 0.0, 0.1)];
        assert!(LineLinker::fragments(2.5).connects(&line, &beyond));
        assert!(LineLinker::fragments(2.5).connects(&beyond, &line));
        assert!(!LineLinker::fragments(1.5).connects(&line, &beyond));
    }

    #[test]
    fn the_shared_stretch_is_as_far_as_both_reach() {
        let line = flat([0.0, 10.0], [0.0, 0.0]);
        let shared = |other: &Ends<2>| LINKER.shared(&line, other);
        assert_eq!(shared(&flat([12.0, 4.0], [0.3, 0.3])), Some([4.0, 10.0]));
        assert_eq!(shared(&flat([4.0, 12.0], [0.0, 0.7])), None, "too far off");
        assert_eq!(shared(&flat([11.0, 12.0], [0.0, 0.0])), None, "beyond it");
    }

    #[test]
    fn a_vague_line_is_the_same_as_more_until_it_says_nothing() {
        let line = flat([0.0, 10.0], [0.0, 0.0]);
        let place = Point2::new(5.0, 1.0);
        assert!(!LINKER.passes(&line, &place));
        assert!(LINKER.known_to(0.3).passes(&line, &place));
        assert!(!LINKER.known_to(1.1).passes(&line, &Point2::new(5.0, 0.0)));
        let end = Point2::new(10.2, 0.0);
        assert!(!LINKER.passes(&line, &end));
        let longer = LineLinker {
            beyond: 0.2 + 1e-9,
            ..LINKER
        };
        assert!(longer.passes(&line, &end));
    }
}
