//! The minimum cut behind a [`super::cut`], by a maximum flow.
//!
//! Nodes hold a surplus or a deficit and surpluses flow along arcs to deficits (Goldberg and Tarjan
//! 1988: a node may keep what does not get on). Deficits are few, so it is they that pull, first in
//! first out, from what is nearer to a surplus; what lies beyond a gap in the distances is left
//! alone (Cherkassky and Goldberg 1997). Half of every arc is filled to begin with: where two cells
//! of one label may move together, this cancels what each would pay without the other, and few
//! deficits are left.

use std::collections::VecDeque;

/// From, to, capacity in units.
pub(super) type Arc = (usize, usize, i64);

/// A flow on its way to the greatest.
pub(super) struct Flow {
    /// The arcs at node i, in either direction, are `arcs[starts[i]..starts[i + 1]]`.
    starts: Vec<u32>,
    arcs: Vec<HalfArc>,
    /// Surplus of each node; negative for a deficit.
    surplus: Vec<i64>,
}

/// An arc as one of its ends sees it.
#[derive(Clone, Copy, Default)]
struct HalfArc {
    to: u32,
    /// The same arc as the other end sees it.
    twin: u32,
    /// Residual capacity from the other end to this one.
    left: i64,
}

/// No surplus reaches it.
const FAR: u32 = u32::MAX;

impl Flow {
    /// Half of every arc is filled.
    pub(super) fn new(mut surplus: Vec<i64>, arcs: &[Arc]) -> Self {
        let mut starts = vec![0u32; surplus.len() + 1];
        for node in arcs.iter().flat_map(|a| [a.0, a.1]) {
            starts[node + 1] += 1;
        }
        for node in 0..surplus.len() {
            starts[node + 1] += starts[node];
        }
        let mut next = starts.clone();
        let mut place = |node: usize| {
            next[node] += 1;
            next[node] - 1
        };
        let mut halves = vec![HalfArc::default(); 2 * arcs.len()];
        for &(from, to, capacity) in arcs {
            let (out, back) = (place(from), place(to));
            let filled = capacity / 2;
            halves[out as usize] = HalfArc {
                to: to as u32,
                twin: back,
                left: filled,
            };
            halves[back as usize] = HalfArc {
                to: from as u32,
                twin: out,
                left: capacity - filled,
            };
            surplus[from] -= filled;
            surplus[to] += filled;
        }
        Self {
            starts,
            arcs: halves,
            surplus,
        }
    }

    /// Lets everything flow that can; returns the deficit that is left.
    pub(super) fn run(&mut self) -> i64 {
        let nodes = 0..self.surplus.len() as u32;
        let mut wanting: VecDeque<u32> = nodes.filter(|&i| self.surplus[i as usize] < 0).collect();
        // From the nearest surplus, along the flow; never more than it is.
        let mut distance: Vec<u32> = self.surplus.iter().map(|s| u32::from(*s <= 0)).collect();
        let mut at_distance = vec![0u32; self.surplus.len() + 2];
        distance.iter().for_each(|&d| at_distance[d as usize] += 1);
        let mut left = 0;
        while let Some(node) = wanting.pop_front() {
            self.pull(node, &distance, &mut wanting);
            let (surplus, here) = (self.surplus[node as usize], distance[node as usize]);
            if surplus == 0 || here == FAR {
                left -= surplus;
                continue;
            }
            let inwards = self.arcs_of(node).filter(|&k| self.arcs[k].left > 0);
            let nearest = inwards.map(|k| distance[self.arcs[k].to as usize]).min();
            let farther = nearest.map_or(FAR, |d| d.saturating_add(1));
            distance[node as usize] = farther;
            if let Some(count) = at_distance.get_mut(farther as usize) {
                *count += 1;
            }
            at_distance[here as usize] -= 1;
            if at_distance[here as usize] == 0 {
                // Nothing flows across the gap any more.
                let beyond = distance.iter_mut().filter(|d| **d > here);
                beyond.for_each(|d| *d = FAR);
                at_distance[here as usize..].fill(0);
            }
            wanting.push_back(node);
        }
        left
    }

    /// Meets the deficit of a node from nodes that are nearer to a surplus.
    fn pull(&mut self, node: u32, distance: &[u32], wanting: &mut VecDeque<u32>) {
        let mut deficit = -self.surplus[node as usize];
        for k in self.arcs_of(node) {
            let HalfArc { to, twin, left } = self.arcs[k];
            if left > 0 && distance[to as usize] < distance[node as usize] {
                let moved = deficit.min(left);
                self.arcs[k].left -= moved;
                self.arcs[twin as usize].left += moved;
                let surplus = &mut self.surplus[to as usize];
                if (0..moved).contains(surplus) {
                    wanting.push_back(to);
                }
                *surplus -= moved;
                deficit -= moved;
                if deficit == 0 {
                    break;
                }
            }
        }
        self.surplus[node as usize] = -deficit;
    }

    /// The nodes that what is left of the surplus could still reach, once nothing flows any more:
    /// of all minimum cuts the side of the surpluses that is smallest.
    pub(super) fn reached(&self) -> Vec<bool> {
        let mut reached: Vec<bool> = self.surplus.iter().map(|s| *s > 0).collect();
        let mut open: Vec<u32> = (0..reached.len() as u32)
            .filter(|&i| reached[i as usize])
            .collect();
        while let Some(node) = open.pop() {
            for arc in &self.arcs[self.arcs_of(node)] {
                if self.arcs[arc.twin as usize].left > 0 && !reached[arc.to as usize] {
                    reached[arc.to as usize] = true;
                    open.push(arc.to);
                }
            }
        }
        reached
    }

    fn arcs_of(&self, node: u32) -> std::ops::Range<usize> {
        let node = node as usize;
        self.starts[node] as usize..self.starts[node + 1] as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::testing::uniform;

    /// What a choice of the wanting side costs: surpluses on it are lost, deficits off it are
    /// gained, arcs into it are torn.
    fn gain(surplus: &[i64], arcs: &[Arc], side: u32) -> i64 {
        let on = |node: usize| side >> node & 1 == 1;
        let own: i64 = (surplus.iter().enumerate())
            .filter(|(i, _)| on(*i))
            .map(|(_, s)| -s)
            .sum();
        let torn = arcs.iter().filter(|(i, j, _)| !on(*i) && on(*j));
        own - torn.map(|a| a.2).sum::<i64>()
    }

    #[test]
    fn the_cut_is_the_best_and_of_equals_the_one_with_most_on_the_wanting_side() {
        const NODES: usize = 8;
        let mut next = uniform(3);
        for _ in 0..300 {
            // Few different numbers make many ties.
            let mut draw = |levels: f64| (next() * levels) as i64;
            let surplus: Vec<i64> = (0..NODES).map(|_| draw(7.0) - 3).collect();
            let arcs: Vec<Arc> = (0..12)
                .map(|_| (draw(8.0) as usize, draw(8.0) as usize, draw(4.0)))
                .filter(|a| a.0 != a.1)
                .collect();
            let best = (0..1u32 << NODES)
                .max_by_key(|&side| (gain(&surplus, &arcs, side), side.count_ones()))
                .unwrap();
            let mut flow = Flow::new(surplus.clone(), &arcs);
            assert_eq!(flow.run(), gain(&surplus, &arcs, best));
            let reached = flow.reached();
            assert!((0..NODES).all(|i| reached[i] != (best >> i & 1 == 1)));
        }
    }

    #[test]
    fn the_flow_in_a_large_grid_is_the_greatest() {
        const SIDE: usize = 30;
        for seed in 1..30 {
            let mut next = uniform(seed);
            let mut draw = |levels: f64| (next() * levels) as i64;
            // Blocks of deficits that their surroundings cannot meet, and single ones they can.
            let is_in_block = |i: usize| (i % SIDE / 8 + i / SIDE / 8).is_multiple_of(3);
            let surplus =
                (0..SIDE * SIDE).map(|i| draw(40.0) - if is_in_block(i) { 25 } else { 15 });
            let surplus: Vec<i64> = surplus.collect();
            let across = (0..SIDE * SIDE - 1).filter(|i| i % SIDE + 1 < SIDE);
            let across = across.map(|i| (i, i + 1));
            let pairs = across.chain((0..SIDE * (SIDE - 1)).map(|i| (i, i + SIDE)));
            let arcs: Vec<Arc> = pairs.map(|(i, j)| (i, j, draw(30.0))).collect();
            let mut flow = Flow::new(surplus.clone(), &arcs);
            let left = flow.run();
            let reached = flow.reached();
            assert!(left > 0 && reached.contains(&true));
            // No cut gains more than what is left of the deficits: one that does is the best.
            let own = (0..SIDE * SIDE)
                .filter(|i| !reached[*i])
                .map(|i| -surplus[i]);
            let torn = arcs.iter().filter(|a| reached[a.0] && !reached[a.1]);
            assert_eq!(left, own.sum::<i64>() - torn.map(|a| a.2).sum::<i64>());
        }
    }

    #[test]
    fn a_surplus_reaches_a_deficit_at_the_end_of_a_long_row() {
        let row: Vec<Arc> = (0..99).map(|i| (i, i + 1, 5)).collect();
        let mut surplus = vec![0; 100];
        (surplus[0], surplus[99]) = (8, -7);
        let mut flow = Flow::new(surplus, &row);
        assert_eq!(flow.run(), 2);
        let reached = flow.reached();
        assert!(reached[0] && !reached[99]);
    }
}
