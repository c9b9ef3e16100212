//! The final matching set (B99 3.2): winner takes all.
//!
//! "Whenever a line belongs to several triples, only the triple with the best score is retained."
//! With N views the unit is the bundle of triples of one pair: bundles are taken in the order of
//! their evidence, completed to lines over all views, and own their segments from then on.
//! Segments of a superseded bundle that lie on the winner's line were adopted by it (merging); the
//! others remain free for the next bundle.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::ahead::{Ahead, Hypothesis};
use super::nview::{CompletedLine, MatchContext, MatchRejection};
use super::pairs::{SegmentPair, SegmentPairs};
use super::pass::Pass;
use super::segment_geometry::SegmentRef;
use super::triples::{TripleBundle, Verification};
use crate::base::execution::{SILENT, Sharded, reached, sharded_map};
use crate::lines::lines2d::ImageSegment;

/// The outcome of a bundle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BundleOutcome {
    /// It became this line.
    Accepted(usize),
    /// Its segments belong to this line.
    Superseded(usize),
    /// It was rejected by itself.
    Rejected(MatchRejection),
}

/// The lines, and the outcome of each bundle.
pub(crate) struct Selection {
    /// Accepted lines, the best first.
    pub lines: Vec<CompletedLine>,
    /// One for each bundle.
    pub outcomes: Vec<BundleOutcome>,
    /// For each view and segment, the line that owns it.
    pub owners: Vec<Vec<Option<usize>>>,
}

/// Takes bundles by falling evidence; `selection` holds what an earlier pass has taken.
pub(super) fn winner_takes_all(
    context: &MatchContext,
    pairs: &SegmentPairs,
    bundles: &[TripleBundle],
    pass: Pass,
    selection: &mut Selection,
) -> Sharded<()> {
    let mut outcomes = vec![BundleOutcome::Rejected(MatchRejection::NoFit); bundles.len()];
    let weighed = sharded_map(pass.map_name("bundles"), bundles, SILENT, |_, b| {
        evidence(context, &pairs.pairs[b.pair], b)
    })?;
    let mut queue: BinaryHeap<QueuedBundle> = (weighed.into_iter().enumerate())
        .map(|(bundle, evidence)| QueuedBundle { evidence, bundle })
        .collect();
    let mut ahead = Ahead::default();
    while let Some(entry) = queue.pop() {
        let bundle = &bundles[entry.bundle];
        let pair = &pairs.pairs[bundle.pair];
        if let Some(owner) = selection.owner(pair.a).or(selection.owner(pair.b)) {
            outcomes[entry.bundle] = BundleOutcome::Superseded(owner);
            continue;
        }
        // Segments that other lines have taken meanwhile do not count: it is queued again with the
        // rest.
        let free = |v: &Verification| selection.owner(v.segment).is_none();
        let rest = TripleBundle {
            pair: bundle.pair,
            verified: bundle.verified.iter().copied().filter(free).collect(),
        };
        if rest.verified.len() < bundle.verified.len() {
            let evidence = evidence(context, pair, &rest);
            if evidence < entry.evidence {
                queue.push(QueuedBundle { evidence, ..entry });
                continue;
            }
        }
        let taken = |s: SegmentRef| selection.owner(s).is_some();
        let mut passed = Vec::new();
        let next = std::iter::from_fn(|| {
            let next = queue.pop()?;
            passed.push(next);
            let hypothesis = hypothesis(pairs, next.bundle, &bundles[next.bundle]);
            let has_all = !hypothesis.seeds.iter().any(|s| taken(*s));
            Some(has_all.then_some(hypothesis))
        });
        let turn = hypothesis(pairs, entry.bundle, &rest);
        let completed = ahead.complete(context, turn, next, &taken);
        queue.extend(passed);
        outcomes[entry.bundle] = match completed {
            Ok(line) => selection.accept(line),
            Err(reason) => BundleOutcome::Rejected(reason),
        };
        if pass == Pass::First {
            reached(0.6 + 0.4 * (1.0 - queue.len() as f64 / bundles.len() as f64));
        }
    }
    selection.outcomes.extend(outcomes);
    Ok(())
}

/// The bundle of a pair as the completion of its line takes it.
fn hypothesis(pairs: &SegmentPairs, number: usize, bundle: &TripleBundle) -> Hypothesis {
    let pair = &pairs.pairs[bundle.pair];
    let verified = bundle.verified.iter().map(|v| v.segment);
    Hypothesis {
        bundle: number,
        overlap: pair.overlap,
        seeds: [pair.a, pair.b].into_iter().chain(verified).collect(),
    }
}

/// Evidence for the line of a bundle: its length in the first view times the sum over the views of
/// the best score, weighted by the agreement of the segment with the line that fits them all.
/// Without the weight, a pair of a ridge with the gutter a pixel beside it would count as much as
/// two images of the ridge.
fn evidence(context: &MatchContext, pair: &SegmentPair, bundle: &TripleBundle) -> f64 {
    let scores = [(pair.a, pair.score), (pair.b, pair.score)];
    let verified = bundle.verified.iter().map(|v| (v.segment, v.score));
    let (seeds, scores): (Vec<SegmentRef>, Vec<f64>) = scores.into_iter().chain(verified).unzip();
    let Some(agreement) = context.agreement(&pair.overlap, &seeds) else {
        return 0.0;
    };
    let mut best: Vec<f64> = vec![0.0; context.segments.len()];
    for ((seed, score), agrees) in seeds.iter().zip(scores).zip(agreement) {
        let view = &mut best[seed.view.index()];
        *view = view.max(score * agrees);
    }
    best.iter().sum::<f64>() * pair.overlap_px
}

impl Selection {
    /// The selection without lines, for these segments (one list a view).
    pub(crate) fn empty(segments: &[Vec<ImageSegment>]) -> Self {
        Self {
            lines: Vec::new(),
            outcomes: Vec::new(),
            owners: segments.iter().map(|v| vec![None; v.len()]).collect(),
        }
    }

    /// The line that owns a segment.
    pub(crate) fn owner(&self, s: SegmentRef) -> Option<usize> {
        self.owners[s.view.index()][s.segment.index()]
    }

    fn accept(&mut self, line: CompletedLine) -> BundleOutcome {
        let index = self.lines.len();
        self.own(&line, index);
        self.lines.push(line);
        BundleOutcome::Accepted(index)
    }

    /// Gives the segments of a line to its number.
    pub(crate) fn own(&mut self, line: &CompletedLine, index: usize) {
        for support in &line.supports {
            for segment in &support.segments {
                self.owners[support.view.index()][segment.index()] = Some(index);
            }
        }
    }
}

/// A bundle in the queue: the most evidence first, the lower index on a tie.
#[derive(Clone, Copy)]
struct QueuedBundle {
    evidence: f64,
    bundle: usize,
}

impl Ord for QueuedBundle {
    fn cmp(&self, other: &Self) -> Ordering {
        self.evidence
            .total_cmp(&other.evidence)
            .then(other.bundle.cmp(&self.bundle))
    }
}

impl PartialOrd for QueuedBundle {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for QueuedBundle {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for QueuedBundle {}

#[cfg(test)]
mod tests {
    use super::super::pairs::{PairScope, match_pairs};
    use super::super::segment_geometry::Compatibility;
    use super::super::testing::PlantedRoof;
    use super::super::triples::{Verification, verify_pairs};
    use super::*;
    use crate::base::geometry::Segment3;
    use crate::base::ids::SegmentId;
    use crate::base::ids::ViewId;
    use crate::lines::lines3d::planted;

    const Z_RANGE: [f64; 2] = [-2.0, 8.0];
    const COMPATIBLE: Compatibility = Compatibility {
        contrast: true,
        kind: true,
    };

    impl PlantedRoof {
        fn select(
            &self,
            pairs: &SegmentPairs,
            bundles: &[TripleBundle],
            mut selection: Selection,
        ) -> Selection {
            winner_takes_all(
                &self.context(),
                pairs,
                bundles,
                Pass::Second,
                &mut selection,
            )
            .unwrap();
            selection
        }

        fn nothing_taken(&self) -> Selection {
            Selection::empty(&self.segments)
        }
    }

    fn name(view: u32, edge: u32) -> SegmentRef {
        SegmentRef {
            view: ViewId(view),
            segment: SegmentId(edge),
        }
    }

    /// The pair of an edge's segments in two views.
    fn pair(edge: u32, [a, b]: [u32; 2], score: f64) -> SegmentPair {
        SegmentPair {
            a: name(a, edge),
            b: name(b, edge),
            overlap: planted::edges()[edge as usize],
            overlap_px: 60.0,
            score,
        }
    }

    /// The bundle of a pair with segments that verify it, all of one score.
    fn bundle(pair: usize, verified: &[SegmentRef], score: f64) -> TripleBundle {
        let verified = verified
            .iter()
            .map(|&segment| Verification { segment, score });
        TripleBundle {
            pair,
            verified: verified.collect(),
        }
    }

    fn all(pairs: impl Into<Vec<SegmentPair>>) -> SegmentPairs {
        SegmentPairs {
            pairs: pairs.into(),
            searches: Vec::new(),
        }
    }

    #[test]
    fn of_two_bundles_that_share_a_segment_the_one_with_more_evidence_wins() {
        let roof = PlantedRoof::new();
        // Both are of edge 1 and its segment in view 0.
        let pairs = all([pair(1, [0, 2], 0.9), pair(1, [0, 3], 0.9)]);
        for (scores, outcomes) in [
            (
                [0.5, 0.8],
                [BundleOutcome::Superseded(0), BundleOutcome::Accepted(0)],
            ),
            (
                [0.8, 0.5],
                [BundleOutcome::Accepted(0), BundleOutcome::Superseded(0)],
            ),
        ] {
            let bundles = [
                bundle(0, &[name(3, 1), name(4, 1)], scores[0]),
                bundle(1, &[name(2, 1), name(4, 1)], scores[1]),
            ];
            let selection = roof.select(&pairs, &bundles, roof.nothing_taken());
            assert_eq!(selection.outcomes, outcomes);
            assert_eq!(selection.lines.len(), 1);
            for view in 0..5 {
                assert_eq!(selection.owner(name(view, 1)), Some(0), "view {view}");
            }
            // Either wins where it is alone.
            for bundle in bundles {
                let selection = roof.select(&pairs, &[bundle], roof.nothing_taken());
                assert_eq!(selection.outcomes, [BundleOutcome::Accepted(0)]);
            }
        }
    }

    #[cfg(not(target_arch = "wasm32"))]
    #[test]
    fn it_does_not_matter_how_many_bundles_are_completed_ahead() {
        let roof = PlantedRoof::new();
        let mut next = crate::roofs::testing::uniform(11);
        let (mut pairs, mut bundles) = (Vec::new(), Vec::new());
        for edge in 0..planted::edges().len() as u32 {
            for views in [[0, 1], [0, 2], [1, 3], [2, 4], [3, 4]] {
                let others = (0..5).filter(|v| !views.contains(v));
                let verified: Vec<SegmentRef> = others
                    .filter(|_| next() < 0.6)
                    .map(|v| name(v, edge))
                    .collect();
                let score = 0.5 + 0.4 * next();
                bundles.push(bundle(pairs.len(), &verified, score));
                pairs.push(pair(edge, views, score));
            }
        }
        let pairs = all(pairs);
        let selected = |workers: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(workers);
            let select = || roof.select(&pairs, &bundles, roof.nothing_taken());
            let found = pool.build().unwrap().install(select);
            let lines: Vec<Segment3> = found.lines.iter().map(|l| l.segment).collect();
            (found.outcomes, found.owners, lines)
        };
        let one_by_one = selected(1);
        assert_eq!(one_by_one.2.len(), 4);
        for workers in [2, 5] {
            assert_eq!(selected(workers), one_by_one);
        }
    }

    #[test]
    fn a_bundle_whose_segments_were_taken_waits_for_those_that_have_more_evidence_than_its_rest() {
        let roof = PlantedRoof::new();
        let pairs = all([pair(1, [0, 3], 0.8), pair(3, [0, 3], 0.7)]);
        let bundles = [
            bundle(0, &[name(1, 1), name(2, 1), name(4, 1)], 0.8),
            bundle(1, &[name(1, 3), name(2, 3), name(4, 3)], 0.7),
        ];
        let outcomes_where_taken = |taken: &[SegmentRef]| {
            // A line of an earlier pass, whose supports do not matter here.
            let mut selection = roof.nothing_taken();
            let segment = Segment3::new(planted::edges()[0].p0, planted::edges()[0].p1);
            let fit = crate::lines::lines3d::LineFit {
                line: segment,
                across: [nalgebra::Vector3::y(), nalgebra::Vector3::z()],
                covariance: nalgebra::Matrix4::identity(),
                residuals: Vec::new(),
            };
            selection.accept(CompletedLine {
                segment,
                fit,
                supports: Vec::new(),
                evidence: crate::base::evidence::Evidence {
                    prior: 3.0,
                    terms: Vec::new(),
                },
            });
            for s in taken {
                selection.owners[s.view.index()][s.segment.index()] = Some(0);
            }
            roof.select(&pairs, &bundles, selection).outcomes
        };
        assert_eq!(
            outcomes_where_taken(&[]),
            [BundleOutcome::Accepted(1), BundleOutcome::Accepted(2)]
        );
        // Four views that score 0.8 are less than five that score 0.7.
        assert_eq!(
            outcomes_where_taken(&[name(2, 1)]),
            [BundleOutcome::Accepted(2), BundleOutcome::Accepted(1)]
        );
        // A segment of the pair itself is no rest to go on with.
        assert_eq!(
            outcomes_where_taken(&[name(3, 1)]),
            [BundleOutcome::Superseded(0), BundleOutcome::Accepted(1)]
        );
    }

    #[test]
    fn the_order_of_the_bundles_does_not_matter() {
        let roof = PlantedRoof::new();
        let views = 0..roof.scene.views.len() as u32;
        let view_pairs: Vec<_> = views
            .clone()
            .flat_map(|a| (a + 1..views.end).map(move |b| (ViewId(a), ViewId(b))))
            .collect();
        let scope = PairScope {
            scene: &roof.scene,
            prepared: &roof.prepared,
            view_pairs: &view_pairs,
            z_range: Z_RANGE,
            params: &roof.params,
            compatibility: COMPATIBLE,
        };
        let pairs = match_pairs(&scope, |_| false, Pass::Second).unwrap();
        let bundles = verify_pairs(&scope, &pairs, Pass::Second).unwrap();
        assert!(bundles.len() > 20);
        let expected = roof.select(&pairs, &bundles, roof.nothing_taken());
        assert_eq!(expected.lines.len(), 4);
        let count = bundles.len();
        // Backwards, and every second one before the others.
        for order in [
            (0..count).rev().collect::<Vec<_>>(),
            (0..count).step_by(2).chain((1..count).step_by(2)).collect(),
        ] {
            let shuffled: Vec<_> = order.iter().map(|&i| bundles[i].clone()).collect();
            let selection = roof.select(&pairs, &shuffled, roof.nothing_taken());
            assert_eq!(selection.owners, expected.owners);
            for (&i, outcome) in order.iter().zip(&selection.outcomes) {
                assert_eq!(*outcome, expected.outcomes[i], "bundle {i}");
            }
            for (line, other) in selection.lines.iter().zip(&expected.lines) {
                assert_eq!(line.segment, other.segment);
                assert_eq!(line.supports, other.supports);
            }
        }
    }
}
