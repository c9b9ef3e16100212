//! The trace of matching for the page: heights, pairs, triples, and the outcome of each segment.

use serde::Serialize;

use super::nview::MatchRejection;
use super::pairs::SegmentPairs;
use super::segment_geometry::SegmentRef;
use super::selection::{BundleOutcome, Selection};
use super::triples::{TripleBundle, Verification};
use crate::base::ids::ViewId;
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::SupportKind;

/// Most pairs kept in the trace, the best of each segment first.
const MAX_PAIRS_PER_SEGMENT: usize = 12;

/// The outcome of one segment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum SegmentOutcome {
    /// It belongs to a line track.
    Matched {
        /// Index of the line track.
        line: u32,
    },
    /// No segment in any epipolar beam passed the geometric tests.
    NoCandidate,
    /// No candidate's photometric score reached the threshold.
    BelowThreshold {
        /// The best score, 0 to 1.
        best: f32,
    },
    /// It had pairs, but no line track came of them.
    NotVerified {
        /// Why its best pair failed.
        reason: MatchRejection,
    },
    /// The line track that its best pair became fits better without it.
    LeftOut {
        /// Index of that line track.
        line: u32,
    },
    /// The other segment of its best pair belongs to another line track.
    LostTo {
        /// Index of that line track.
        line: u32,
    },
}

/// A pair hypothesis, with the triples that it is part of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairTrace {
    /// Segment of the view with the lower index.
    pub a: SegmentRef,
    /// Segment of the other view.
    pub b: SegmentRef,
    /// Photometric score, 0 to 1.
    pub score: f32,
    /// Segments of third views at the predicted position: each makes a triple.
    pub verified: Vec<Verification>,
    /// The line track that it became, after winner takes all.
    pub line: Option<u32>,
}

/// Counts and lengths of one step (the rows of B99's results).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct StepCount {
    /// Number of segments or supports.
    pub number: usize,
    /// Their total length in the images, pixels.
    pub length_px: f64,
}

impl StepCount {
    fn add(&mut self, length_px: f64) {
        self.number += 1;
        self.length_px += length_px;
    }
}

/// The trace of [`super::match_lines`].
#[derive(Clone, Debug, Default, Serialize)]
pub struct MatchTrace {
    /// Heights between which lines were sought, metres; [`super::segment_geometry::epipolar_beam`]
    /// draws beams with it.
    pub z_range_m: Option<[f64; 2]>,
    /// Heights found by the sweep that the range rests on, metres, sorted.
    pub heights_m: Vec<f64>,
    /// Pairs of views that were matched.
    pub view_pairs: Vec<(ViewId, ViewId)>,
    /// For each view, the outcome of each segment.
    pub outcomes: Vec<Vec<SegmentOutcome>>,
    /// The best pairs of each segment.
    pub pairs: Vec<PairTrace>,
    /// Number of pairs tested by correlation.
    pub candidates: usize,
    /// Number of pairs above the threshold.
    pub pair_count: usize,
    /// Number of triples before winner takes all.
    pub triples_before: usize,
    /// Number of triples after it.
    pub triples_after: usize,
    /// Segments given.
    pub detected: StepCount,
    /// Segments that belong to a line track.
    pub matched: StepCount,
    /// Of these, the ones joined to another segment of the same view.
    pub merged: StepCount,
    /// Supports that reach past their segments, or have none; the length is that of the grown part.
    pub grown: StepCount,
}

impl MatchTrace {
    /// Fills in everything that follows from the search.
    pub(crate) fn record(
        &mut self,
        segments: &[Vec<ImageSegment>],
        pairs: &SegmentPairs,
        bundles: &[TripleBundle],
        selection: &Selection,
    ) {
        self.candidates = pairs
            .searches
            .iter()
            .flatten()
            .map(|s| s.candidates as usize)
            .sum::<usize>()
            / 2;
        self.pair_count = bundles.len();
        self.triples_before = bundles.iter().map(|b| b.views().count()).sum();
        self.triples_after = selection
            .lines
            .iter()
            .map(|l| l.supports.len().saturating_sub(2))
            .sum();
        self.outcomes = outcomes(segments, pairs, bundles, selection);
        self.pairs = best_pairs(segments, pairs, bundles, selection);
        self.count(segments, selection);
    }

    fn count(&mut self, segments: &[Vec<ImageSegment>], selection: &Selection) {
        for segment in segments.iter().flatten() {
            self.detected.add(segment.segment.length());
        }
        for support in selection.lines.iter().flat_map(|l| &l.supports) {
            let mut detected_px = 0.0;
            for id in &support.segments {
                let length = segments[support.view.index()][id.index()].segment.length();
                detected_px += length;
                self.matched.add(length);
                if support.segments.len() > 1 {
                    self.merged.add(length);
                }
            }
            if support.kind == SupportKind::Grown {
                self.grown
                    .add((support.stretch.length() - detected_px).max(0.0));
            }
        }
    }
}

fn outcomes(
    segments: &[Vec<ImageSegment>],
    pairs: &SegmentPairs,
    bundles: &[TripleBundle],
    selection: &Selection,
) -> Vec<Vec<SegmentOutcome>> {
    let mut outcomes: Vec<Vec<SegmentOutcome>> = segments
        .iter()
        .zip(&pairs.searches)
        .map(|(view, searches)| {
            (0..view.len())
                .map(|i| match searches[i] {
                    s if s.candidates == 0 => SegmentOutcome::NoCandidate,
                    s => SegmentOutcome::BelowThreshold {
                        best: s.best as f32,
                    },
                })
                .collect()
        })
        .collect();
    // Weak pairs first, so that the best one decides.
    let mut order: Vec<usize> = (0..bundles.len()).collect();
    order.sort_by(|&i, &j| {
        let score = |b: usize| pairs.pairs[bundles[b].pair].score;
        score(i).total_cmp(&score(j)).then(j.cmp(&i))
    });
    for i in order {
        let outcome = match selection.outcomes[i] {
            BundleOutcome::Accepted(line) => SegmentOutcome::LeftOut { line: line as u32 },
            BundleOutcome::Superseded(line) => SegmentOutcome::LostTo { line: line as u32 },
            BundleOutcome::Rejected(reason) => SegmentOutcome::NotVerified { reason },
        };
        let pair = &pairs.pairs[bundles[i].pair];
        for s in [pair.a, pair.b] {
            outcomes[s.view.index()][s.segment.index()] = outcome;
        }
    }
    for (view, owners) in outcomes.iter_mut().zip(&selection.owners) {
        for (outcome, owner) in view.iter_mut().zip(owners) {
            if let Some(line) = owner {
                *outcome = SegmentOutcome::Matched { line: *line as u32 };
            }
        }
    }
    outcomes
}

/// The pairs above the threshold, at most so many a segment.
fn best_pairs(
    segments: &[Vec<ImageSegment>],
    pairs: &SegmentPairs,
    bundles: &[TripleBundle],
    selection: &Selection,
) -> Vec<PairTrace> {
    let mut order: Vec<usize> = (0..bundles.len()).collect();
    order.sort_by(|&i, &j| {
        let score = |b: usize| pairs.pairs[bundles[b].pair].score;
        score(j).total_cmp(&score(i)).then(i.cmp(&j))
    });
    let mut kept: Vec<Vec<usize>> = segments.iter().map(|v| vec![0; v.len()]).collect();
    order
        .into_iter()
        .filter_map(|i| {
            let pair = &pairs.pairs[bundles[i].pair];
            let count = &mut kept[pair.a.view.index()][pair.a.segment.index()];
            *count += 1;
            (*count <= MAX_PAIRS_PER_SEGMENT).then(|| PairTrace {
                a: pair.a,
                b: pair.b,
                score: pair.score as f32,
                verified: bundles[i].verified.clone(),
                line: match selection.outcomes[i] {
                    BundleOutcome::Accepted(line) => Some(line as u32),
                    _ => None,
                },
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::pairs::{PairSearch, SegmentPair};
    use super::*;
    use crate::base::geometry::Segment3;
    use crate::base::ids::SegmentId;
    use crate::lines::lines3d::planted;
    use nalgebra::Point3;

    #[test]
    fn every_segment_has_the_reason_why_it_is_matched_or_not() {
        let one = planted::segments(&planted::scene())[0][0].clone();
        let segments = vec![vec![one; 6]; 2];
        let name = |view, segment| SegmentRef {
            view: ViewId(view),
            segment: SegmentId(segment),
        };
        // The pairs of segments 1 to 4 of both views, and a weaker one of segment 4 with its
        // neighbour.
        let pair = |a, b, score| SegmentPair {
            a: name(0, a),
            b: name(1, b),
            overlap: Segment3::new(Point3::origin(), Point3::new(1.0, 0.0, 0.0)),
            overlap_px: 20.0,
            score,
        };
        let found = |candidates, best| PairSearch { candidates, best };
        let searches = vec![
            found(0, 0.0),
            found(1, 0.9),
            found(1, 0.8),
            found(1, 0.7),
            found(2, 0.6),
            found(1, 0.1),
        ];
        let pairs = SegmentPairs {
            pairs: vec![
                pair(4, 3, 0.5),
                pair(1, 1, 0.9),
                pair(2, 2, 0.8),
                pair(3, 3, 0.7),
                pair(4, 4, 0.6),
            ],
            searches: vec![searches; 2],
        };
        let bundles: Vec<TripleBundle> = (0..5)
            .map(|pair| TripleBundle {
                pair,
                verified: Vec::new(),
            })
            .collect();
        let mut selection = Selection::empty(&segments);
        selection.outcomes = vec![
            BundleOutcome::Superseded(0),
            BundleOutcome::Accepted(0),
            BundleOutcome::Superseded(0),
            BundleOutcome::Rejected(MatchRejection::TooShort),
            BundleOutcome::Accepted(1),
        ];
        // Line 1 was fitted without the segment of the second view.
        selection.owners[0][1] = Some(0);
        selection.owners[1][1] = Some(0);
        selection.owners[0][4] = Some(1);
        let outcome_of = outcomes(&segments, &pairs, &bundles, &selection);
        let first = [
            SegmentOutcome::NoCandidate,
            SegmentOutcome::Matched { line: 0 },
            SegmentOutcome::LostTo { line: 0 },
            SegmentOutcome::NotVerified {
                reason: MatchRejection::TooShort,
            },
            SegmentOutcome::Matched { line: 1 },
            SegmentOutcome::BelowThreshold { best: 0.1 },
        ];
        assert_eq!(outcome_of[0], first);
        assert_eq!(outcome_of[1][..4], first[..4]);
        assert_eq!(outcome_of[1][4], SegmentOutcome::LeftOut { line: 1 });
    }
}
