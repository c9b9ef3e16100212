//! The greedy descent of the description length: the two moves of ORIS by a priority queue.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::code_length::{CodeLength, LEAST_GAIN};
use super::integrals::RegionMoments;
use super::partition::{ImagePartition, OUTSIDE_REGION};
use super::settle::settle;
use crate::base::params::OrisParams;

/// Moves made, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Moves {
    /// Break points dropped.
    pub dropped: usize,
    /// Regions merged into others.
    pub merged: usize,
    /// Nodes moved to a better place.
    pub moved: usize,
}

/// Makes moves in the order of their gain until none gains.
pub(crate) fn minimise(p: &mut ImagePartition, params: &OrisParams) -> Moves {
    let mut descent = Descent {
        code: CodeLength::new(params),
        queue: BinaryHeap::new(),
        moves: Moves::default(),
    };
    // Boundaries along pixels have many needless break points, which would make every merger look
    // cheap: these go first.
    descent.offer_all_nodes(p);
    descent.run(p);
    loop {
        descent.offer_all_nodes(p);
        descent.offer_all_pairs(p);
        // Offers that came to gain by changes around them are found by looking at all of them
        // again.
        let changed = descent.run(p);
        let moved = settle(p, &descent.code);
        descent.moves.moved += moved;
        if !changed && moved == 0 {
            return descent.moves;
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Move {
    Drop(u32),
    Merge(u32, u32),
}

/// A move and what it gained when it was offered.
struct Offer {
    gain: f64,
    what: Move,
}

impl PartialEq for Offer {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Offer {}

impl PartialOrd for Offer {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Offer {
    fn cmp(&self, other: &Self) -> Ordering {
        self.gain
            .total_cmp(&other.gain)
            .then(other.what.cmp(&self.what))
    }
}

/// A boundary may move by this without cost, pixels: the pixels on an edge mix both regions, and
/// the staircase of whole pixels along a slanted edge holds no information. (Without this,
/// staircases between regions without noise stay: each step alone would cost more than its vector.)
/// More rounds corners off.
const MIXED_WIDTH_PX: f64 = 0.5;
struct Descent {
    code: CodeLength,
    queue: BinaryHeap<Offer>,
    moves: Moves,
}

impl Descent {
    /// Works the queue off; did anything change?
    fn run(&mut self, p: &mut ImagePartition) -> bool {
        let before = self.moves;
        while let Some(offer) = self.queue.pop() {
            let Some(gain) = self.gain(p, offer.what).filter(|&g| g > LEAST_GAIN) else {
                continue;
            };
            // The surroundings may have changed since the offer: it has to stand in line again.
            if gain < offer.gain - LEAST_GAIN {
                self.queue.push(Offer { gain, ..offer });
                continue;
            }
            self.make(p, offer.what);
        }
        before != self.moves
    }

    fn make(&mut self, p: &mut ImagePartition, what: Move) {
        match what {
            Move::Drop(node) => {
                let straightening = p.straightening(node).expect("its gain was computed");
                for end in p.drop_node(node, &straightening) {
                    self.offer(p, Move::Drop(end));
                }
                self.moves.dropped += 1;
            }
            Move::Merge(i, j) => {
                let (kept, neighbours, touched) = p.merge(i, j);
                for other in neighbours {
                    self.offer(p, pair(kept, other));
                }
                for node in touched {
                    self.offer(p, Move::Drop(node));
                }
                self.moves.merged += 1;
            }
        }
    }

    fn offer(&mut self, p: &ImagePartition, what: Move) {
        if let Some(gain) = self.gain(p, what).filter(|&g| g > LEAST_GAIN) {
            self.queue.push(Offer { gain, what });
        }
    }

    fn offer_all_nodes(&mut self, p: &ImagePartition) {
        for node in 0..p.nodes.len() {
            self.offer(p, Move::Drop(node as u32));
        }
    }

    fn offer_all_pairs(&mut self, p: &ImagePartition) {
        for (i, region) in p.regions.iter().enumerate().skip(1) {
            for &j in region.shared.keys().filter(|&&j| j as usize > i) {
                self.offer(p, Move::Merge(i as u32, j));
            }
        }
    }

    /// By how much a move shortens the description, bits; `None` where it cannot be made.
    fn gain(&self, p: &ImagePartition, what: Move) -> Option<f64> {
        match what {
            Move::Drop(node) => self.drop_gain(p, node),
            Move::Merge(i, j) => self.merge_gain(p, i, j),
        }
    }

    fn drop_gain(&self, p: &ImagePartition, node: u32) -> Option<f64> {
        let s = p.straightening(node)?;
        if s.moved == RegionMoments::default() {
            return Some(self.code.vector_bits);
        }
        if s.sides.contains(&OUTSIDE_REGION) {
            return None;
        }
        let [left, right] = s.sides.map(|r| p.regions[r as usize].moments);
        let (new_left, new_right) = (left + s.moved, right - s.moved);
        if new_left.count < 1 || new_right.count < 1 {
            return None;
        }
        if s.height_px <= MIXED_WIDTH_PX || (s.step && s.height_px < 1.0) {
            return Some(self.code.vector_bits);
        }
        let change = self.code.region(&new_left) + self.code.region(&new_right)
            - self.code.region(&left)
            - self.code.region(&right);
        Some(self.code.vector_bits - change)
    }

    fn merge_gain(&self, p: &ImagePartition, i: u32, j: u32) -> Option<f64> {
        let (a, b) = (&p.regions[i as usize], &p.regions[j as usize]);
        if !a.alive || !b.alive || i == OUTSIDE_REGION {
            return None;
        }
        let shared = f64::from(*a.shared.get(&j)?);
        let change = self.code.region(&(a.moments + b.moments))
            - self.code.region(&a.moments)
            - self.code.region(&b.moments);
        Some(self.code.vector_bits * shared - change)
    }
}

fn pair(i: u32, j: u32) -> Move {
    Move::Merge(i.min(j), i.max(j))
}
