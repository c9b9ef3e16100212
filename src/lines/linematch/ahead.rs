//! Completions that are made before their turn, on all cores.
//!
//! Winner takes all is an order: what becomes of a bundle depends on the segments that better lines
//! own. But most bundles lie far from each other. Those that come next and have no segment in
//! common are completed side by side, and what comes of one holds, when its turn comes, if every
//! segment that it found free still is.
//!
//! Invariant: the lines are those that completing one after the other gives.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::nview::{CompletedLine, MatchContext, MatchRejection, complete_line};
use super::segment_geometry::SegmentRef;
use crate::base::execution;
use crate::base::geometry::Segment3;

/// What came of a bundle.
pub(super) type Completed = Result<CompletedLine, MatchRejection>;

/// A bundle that is to be completed.
pub(super) struct Hypothesis {
    pub bundle: usize,
    /// The stretch on which its pair overlaps.
    pub overlap: Segment3,
    pub seeds: Vec<SegmentRef>,
}

/// Completions by bundle.
#[derive(Default)]
pub(super) struct Ahead {
    made: BTreeMap<usize, Made>,
}

struct Made {
    seeds: Vec<SegmentRef>,
    /// The segments of which it was asked whether others own them, and none did.
    free: Vec<SegmentRef>,
    completed: Completed,
}

/// So many bundles a worker are completed at a time, because they take unequally long.
const BUNDLES_PER_WORKER: usize = 4;
/// So many bundles are looked through for each that is completed. Assumption: few of those in a row
/// have no segment in common.
const LOOKED_THROUGH_PER_BUNDLE: usize = 16;

impl Ahead {
    /// What comes of a bundle whose turn it is, while `taken` names the segments of other lines.
    /// Some of those that come `next` and have all their segments (`None` for others) are completed
    /// with it.
    pub(super) fn complete(
        &mut self,
        context: &MatchContext,
        hypothesis: Hypothesis,
        next: impl Iterator<Item = Option<Hypothesis>>,
        taken: &(impl Fn(SegmentRef) -> bool + Sync),
    ) -> Completed {
        let Hypothesis { bundle, seeds, .. } = &hypothesis;
        let known = self
            .made
            .remove(bundle)
            .filter(|made| made.seeds == *seeds && !made.free.iter().any(|s| taken(*s)));
        if let Some(known) = known {
            return known.completed;
        }
        let wanted = match execution::workers() {
            1 => 1,
            workers => workers * BUNDLES_PER_WORKER,
        };
        let mut used: BTreeSet<SegmentRef> = seeds.iter().copied().collect();
        let mut side_by_side = vec![hypothesis];
        for other in next
            .take((wanted - 1) * LOOKED_THROUGH_PER_BUNDLE)
            .flatten()
        {
            if side_by_side.len() == wanted {
                break;
            }
            let is_apart = other.seeds.iter().all(|s| !used.contains(s));
            if is_apart && !self.made.contains_key(&other.bundle) {
                used.extend(&other.seeds);
                side_by_side.push(other);
            }
        }
        let completed = execution::map(&side_by_side, |_, hypothesis| {
            let free = RefCell::new(Vec::new());
            let is_taken = |s: SegmentRef| {
                let is_taken = taken(s);
                if !is_taken {
                    free.borrow_mut().push(s);
                }
                is_taken
            };
            let Hypothesis { overlap, seeds, .. } = hypothesis;
            let completed = complete_line(context, overlap, seeds, &is_taken);
            (completed, free.into_inner())
        });
        let all = side_by_side.into_iter().zip(completed);
        let mut made = all.map(|(Hypothesis { bundle, seeds, .. }, (completed, free))| {
            let made = Made {
                seeds,
                free,
                completed,
            };
            (bundle, made)
        });
        let first = made.next().expect("the one whose turn it is");
        self.made.extend(made);
        first.1.completed
    }
}

// In wasm nothing is completed ahead.
#[cfg(test)]
#[cfg(not(target_arch = "wasm32"))]
mod tests {
    use super::super::testing::PlantedRoof;
    use super::*;
    use crate::base::ids::{SegmentId, ViewId};
    use crate::lines::lines3d::planted;

    fn name(view: u32, edge: u32) -> SegmentRef {
        SegmentRef {
            view: ViewId(view),
            segment: SegmentId(edge),
        }
    }

    /// An edge by its segments in three of five views.
    fn edge(edge: u32) -> Hypothesis {
        Hypothesis {
            bundle: edge as usize,
            overlap: planted::edges()[edge as usize],
            seeds: [0, 1, 3].map(|view| name(view, edge)).to_vec(),
        }
    }

    fn segments_of(line: &CompletedLine) -> Vec<SegmentRef> {
        let of_view = |view: ViewId, segments: &[SegmentId]| {
            let names = segments.iter().map(|&segment| SegmentRef { view, segment });
            names.collect::<Vec<_>>()
        };
        let supports = line.supports.iter();
        supports
            .flat_map(|s| of_view(s.view, &s.segments))
            .collect()
    }

    /// The second edge, after it was completed with the first while every segment was free.
    fn second(taken: &(impl Fn(SegmentRef) -> bool + Sync)) -> CompletedLine {
        let roof = PlantedRoof::new();
        let context = roof.context();
        let mut ahead = Ahead::default();
        let two = rayon::ThreadPoolBuilder::new().num_threads(2).build();
        let next = std::iter::once(Some(edge(1)));
        let first = || ahead.complete(&context, edge(0), next, &|_| false);
        assert!(two.expect("there are threads").install(first).is_ok());
        assert_eq!(ahead.made.len(), 1);
        let second = ahead.complete(&context, edge(1), std::iter::empty(), taken);
        assert!(ahead.made.is_empty());
        second.unwrap_or_else(|why| panic!("it is a line, not {why:?}"))
    }

    #[test]
    fn what_was_completed_ahead_is_taken() {
        let roof = PlantedRoof::new();
        let (context, Hypothesis { overlap, seeds, .. }) = (roof.context(), edge(1));
        let alone = complete_line(&context, &overlap, &seeds, &|_| false);
        let alone = alone.unwrap_or_else(|why| panic!("it is a line, not {why:?}"));
        let found = second(&|_| false);
        assert_eq!(found.segment, alone.segment);
        assert_eq!(segments_of(&found), segments_of(&alone));
        assert!(segments_of(&found).contains(&name(2, 1)));
    }

    #[test]
    fn it_is_completed_again_where_a_segment_of_it_was_taken_meanwhile() {
        let found = second(&|s| s == name(2, 1));
        assert!(!segments_of(&found).contains(&name(2, 1)));
    }
}
