//! The trace of the segment stage in a view, with the reasons for rejected lines.

use nalgebra::Point2;
use serde::{Deserialize, Serialize};

use crate::base::geometry::Segment2;

/// Why a straight line of edgels is not a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SegmentRejection {
    /// Shorter than the minimum length.
    TooShort,
    /// Part of a curve.
    Curved,
    /// Not distinguishable from the texture around it.
    NotSignificant,
    /// A colour edge along an edge in grey values that is a segment already.
    BesideEdge,
}

/// A rejected line, with the reason.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RejectedSegment {
    /// The line, px.
    pub segment: Segment2,
    /// Why it was rejected.
    pub reason: SegmentRejection,
}

/// The counts of the detector in one view.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SegmentTrace {
    /// Edgels above the low threshold.
    pub edgels: usize,
    /// Chains of edgels after hysteresis.
    pub chains: usize,
    /// Chains with too few edgels for a straight piece.
    pub short_chains: usize,
    /// Where the worm broke a chain, px.
    pub worm_breaks: Vec<Point2<f64>>,
    /// Straight pieces of chains, from which lines are grown.
    pub seeds: usize,
    /// Seeds most of whose edgels belong to a line already.
    pub taken: usize,
    /// Lines that are too short.
    pub too_short: usize,
    /// Lines that belong to a curve.
    pub curved: usize,
    /// Lines that the texture around them explains.
    pub not_significant: usize,
    /// Colour edges along an edge in grey values that is a segment already.
    pub beside_edge: usize,
    /// The rejected lines of at least the minimum length.
    pub rejected: Vec<RejectedSegment>,
}

impl SegmentTrace {
    /// Adds the trace of an image reduced by `factor`.
    pub(crate) fn add(&mut self, other: Self, factor: usize) {
        self.edgels += other.edgels;
        self.chains += other.chains;
        self.short_chains += other.short_chains;
        self.seeds += other.seeds;
        self.taken += other.taken;
        self.too_short += other.too_short;
        self.curved += other.curved;
        self.not_significant += other.not_significant;
        self.beside_edge += other.beside_edge;
        let factor = factor as f64;
        let breaks = other.worm_breaks.into_iter();
        self.worm_breaks.extend(breaks.map(|p| p * factor));
        let rejected = other.rejected.into_iter().map(|r| RejectedSegment {
            segment: r.segment.enlarged(factor),
            ..r
        });
        self.rejected.extend(rejected);
    }

    /// Counts a rejected line, and keeps it unless it is too short.
    pub(crate) fn reject(&mut self, rejected: RejectedSegment) {
        match rejected.reason {
            SegmentRejection::TooShort => self.too_short += 1,
            SegmentRejection::Curved => self.curved += 1,
            SegmentRejection::NotSignificant => self.not_significant += 1,
            SegmentRejection::BesideEdge => self.beside_edge += 1,
        }
        if rejected.reason != SegmentRejection::TooShort {
            self.rejected.push(rejected);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_seen_in_a_reduced_image_is_drawn_where_it_is() {
        let segment = Segment2::new(Point2::new(1.0, 2.0), Point2::new(9.0, 4.0));
        let reason = SegmentRejection::Curved;
        let mut reduced = SegmentTrace {
            edgels: 7,
            worm_breaks: vec![Point2::new(5.0, 3.0)],
            ..SegmentTrace::default()
        };
        reduced.reject(RejectedSegment { segment, reason });
        let mut trace = SegmentTrace {
            edgels: 3,
            ..SegmentTrace::default()
        };
        trace.add(reduced, 2);
        assert_eq!((trace.edgels, trace.curved), (10, 1));
        assert_eq!(trace.worm_breaks, [Point2::new(10.0, 6.0)]);
        assert_eq!(trace.rejected[0].segment.p1, Point2::new(18.0, 8.0));
    }
}
