//! The final matching set (B99 3.2): winner takes all.
//!
//! "Whenever a line belongs to several triples, only the triple with the best score is retained."
//! With N views the unit is the bundle of triples of one pair: bundles are taken in the order of
//! their evidence, completed to lines over all views, and own their segments from then on. The
//! losers' segments are not thrown away: those that lie on the winner's line were adopted by it
//! (merging), the others remain free for the next bundle.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::Pass;
use super::nviews::{Context, Line, Rejection, complete_line};
use super::pairs::{Pair, Pairs};
use super::sight::SegmentRef;
use super::triples::Bundle;
use crate::lines2d::ImageSegment;
use crate::parallel::SILENT;
use crate::progress::reached;
use crate::shares::map_shared;

/// What became of a bundle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fate {
    /// It became this line.
    Won(usize),
    /// Its segments belong to this line.
    Lost(usize),
    /// It failed on its own.
    Rejected(Rejection),
}

/// The lines, and the fate of each bundle.
pub struct Selection {
    /// Accepted lines, the best first.
    pub lines: Vec<Line>,
    /// One for each bundle.
    pub fates: Vec<Fate>,
    /// For each view and segment, the line that owns it.
    pub owners: Vec<Vec<Option<usize>>>,
}

/// Takes bundles by falling evidence; `selection` holds what an earlier pass has taken.
pub fn winner_takes_all(
    context: &Context,
    pairs: &Pairs,
    bundles: &[Bundle],
    pass: Pass,
    selection: &mut Selection,
) {
    let mut fates = vec![Fate::Rejected(Rejection::NoFit); bundles.len()];
    let weighed = map_shared(pass.map("bundles"), bundles, SILENT, |_, b| {
        evidence(context, &pairs.pairs[b.pair], b)
    });
    let mut queue: BinaryHeap<Entry> = (weighed.into_iter().enumerate())
        .map(|(bundle, evidence)| Entry { evidence, bundle })
        .collect();
    while let Some(entry) = queue.pop() {
        let bundle = &bundles[entry.bundle];
        let pair = &pairs.pairs[bundle.pair];
        if let Some(owner) = selection.owner(pair.a).or(selection.owner(pair.b)) {
            fates[entry.bundle] = Fate::Lost(owner);
            continue;
        }
        // What others took since does not count any more: back into the queue with the rest.
        let rest = Bundle {
            pair: bundle.pair,
            verified: bundle
                .verified
                .iter()
                .copied()
                .filter(|v| selection.owner(v.segment).is_none())
                .collect(),
        };
        if rest.verified.len() < bundle.verified.len() {
            let evidence = evidence(context, pair, &rest);
            if evidence < entry.evidence {
                queue.push(Entry { evidence, ..entry });
                continue;
            }
        }
        let mut seeds = vec![pair.a, pair.b];
        seeds.extend(rest.verified.iter().map(|v| v.segment));
        let taken = |s: SegmentRef| selection.owner(s).is_some();
        let fate = match complete_line(context, &pair.overlap, &seeds, taken) {
            Ok(line) => selection.accept(line),
            Err(reason) => Fate::Rejected(reason),
        };
        fates[entry.bundle] = fate;
        if pass == Pass::First {
            reached(0.6 + 0.4 * (1.0 - queue.len() as f64 / bundles.len() as f64));
        }
    }
    selection.fates.extend(fates);
}

/// Evidence for the line of a bundle: seen length times the sum over the views of the best score,
/// each as much as the segment agrees with the line that fits them all. Without that, a pair of a ridge in one
/// view with the gutter a pixel beside it in another counts as much as two images of the ridge.
fn evidence(context: &Context, pair: &Pair, bundle: &Bundle) -> f64 {
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
    /// Of segments (one list a view) none is taken yet.
    pub fn none(segments: &[Vec<ImageSegment>]) -> Self {
        Self {
            lines: Vec::new(),
            fates: Vec::new(),
            owners: segments.iter().map(|v| vec![None; v.len()]).collect(),
        }
    }

    /// The line that owns a segment.
    pub fn owner(&self, s: SegmentRef) -> Option<usize> {
        self.owners[s.view.index()][s.segment.index()]
    }

    fn accept(&mut self, line: Line) -> Fate {
        let index = self.lines.len();
        for support in &line.supports {
            for segment in &support.segments {
                self.owners[support.view.index()][segment.index()] = Some(index);
            }
        }
        self.lines.push(line);
        Fate::Won(index)
    }
}

/// A bundle in the queue: the most evidence first, the lower index on a tie.
#[derive(Clone, Copy)]
struct Entry {
    evidence: f64,
    bundle: usize,
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        self.evidence
            .total_cmp(&other.evidence)
            .then(other.bundle.cmp(&self.bundle))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Entry {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::ViewId;
    use crate::linematch::pairs::{PairScope, match_pairs};
    use crate::linematch::planted;
    use crate::linematch::sight::{Alike, Sights};
    use crate::linematch::triples::verify_pairs;
    use crate::params::{Lines3dParams, MatchParams};

    /// The selection from the planted scene, whose last view has its first segment twice, from all bundles as `order` puts them.
    fn selected(order: impl Fn(&mut Vec<Bundle>)) -> (Pairs, Vec<Bundle>, Selection) {
        let scene = planted::scene();
        let mut segments = planted::segments(&scene);
        let again = segments[4][0].clone();
        segments[4].push(again);
        let partners: Vec<_> = (0..5)
            .flat_map(|a| (a + 1..5).map(move |b| (ViewId(a), ViewId(b))))
            .collect();
        let sights = Sights::new(&scene, &segments);
        let (params, fitting) = (MatchParams::default(), Lines3dParams::default());
        let alike = Alike {
            contrast: true,
            kind: true,
        };
        let scope = PairScope {
            scene: &scene,
            sights: &sights,
            partners: &partners,
            z_range: [-2.0, 8.0],
            params: &params,
            alike,
        };
        let context = Context {
            scene: &scene,
            segments: &segments,
            sights: &sights,
            z_range: [-2.0, 8.0],
            params: &params,
            fitting: &fitting,
            alike,
        };
        let pairs = match_pairs(&scope, |_| false, Pass::Second);
        let mut bundles = verify_pairs(&scope, &pairs, Pass::Second);
        order(&mut bundles);
        let mut selection = Selection::none(&segments);
        winner_takes_all(&context, &pairs, &bundles, Pass::Second, &mut selection);
        (pairs, bundles, selection)
    }

    #[test]
    fn every_segment_has_one_owner_and_losers_know_whom_they_lost_to() {
        let (pairs, bundles, selection) = selected(|_| ());
        assert_eq!(selection.lines.len(), 4);
        let mut owned = 0;
        for (index, line) in selection.lines.iter().enumerate() {
            for support in &line.supports {
                for segment in &support.segments {
                    let name = SegmentRef {
                        view: support.view,
                        segment: *segment,
                    };
                    assert_eq!(
                        selection.owner(name),
                        Some(index),
                        "{name:?} is in one line"
                    );
                    owned += 1;
                }
            }
        }
        // Four in each view, one of them broken in two, one there twice: both lie on the winner.
        assert_eq!(owned, 5 * 4 + 2);
        let (mut won, mut lost) = (0, 0);
        for (bundle, fate) in bundles.iter().zip(&selection.fates) {
            let pair = &pairs.pairs[bundle.pair];
            match *fate {
                Fate::Won(line) => {
                    won += 1;
                    assert_eq!(selection.owner(pair.a), Some(line));
                    assert_eq!(selection.owner(pair.b), Some(line));
                }
                Fate::Lost(line) => {
                    lost += 1;
                    assert!(
                        [pair.a, pair.b]
                            .iter()
                            .any(|s| selection.owner(*s) == Some(line))
                    );
                }
                Fate::Rejected(_) => {}
            }
        }
        assert!(won == 4 && lost > 4, "{won} won, {lost} lost");
    }

    #[test]
    fn the_best_wins_whatever_comes_first() {
        let owners = |order: fn(&mut Vec<Bundle>)| selected(order).2.owners;
        let first = owners(|_| ());
        assert_eq!(first, owners(|bundles| bundles.reverse()));
        assert_eq!(first, owners(|bundles| bundles.rotate_left(7)));
    }

    #[test]
    fn the_most_evidence_comes_first() {
        let entry = |evidence, bundle| Entry { evidence, bundle };
        let mut queue: BinaryHeap<Entry> = [entry(2.0, 5), entry(3.0, 1), entry(3.0, 0)].into();
        let order: Vec<usize> = std::iter::from_fn(|| queue.pop().map(|e| e.bundle)).collect();
        assert_eq!(
            order,
            [0, 1, 5],
            "the most first, of equals the lower index"
        );
    }
}
