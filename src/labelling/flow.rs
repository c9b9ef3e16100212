//! The minimum cut behind a [`super::cut`], by a maximum flow.
//!
//! Nodes hold a surplus or a deficit and surpluses flow along arcs to deficits (Goldberg and Tarjan
//! 1988: a node may keep what does not get on). Distances to the nearest deficit are taken anew in
//! rounds, from the deficits outwards and no farther than the nearest surplus, because most
//! deficits are met by their neighbours. Half of every arc is filled to begin with: where two cells
//! of one label may move together, this cancels what each would pay without the other, and few
//! deficits are left. A library's flow, which visited every arc in every round, took six times as
//! long.

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
    /// Residual capacity in that direction.
    left: i64,
}

/// No distance yet.
const FAR: u32 = u32::MAX;
/// Distances are taken so much farther than the nearest surplus. Of 0, 1, 2, 4, 8 and 16 the third
/// took least time.
const BEYOND: u32 = 2;

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
                left: capacity - filled,
            };
            halves[back as usize] = HalfArc {
                to: from as u32,
                twin: out,
                left: filled,
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
        let mut wanting: Vec<u32> = (0..self.surplus.len() as u32)
            .filter(|&i| self.surplus[i as usize] < 0)
            .collect();
        let mut distance = vec![FAR; self.surplus.len()];
        let mut near = Vec::new();
        while self.approach(&wanting, &mut distance, &mut near) {
            // The farthest first: what they give flows on from the next ones in the same round.
            for &node in near[wanting.len()..].iter().rev() {
                self.push(node, &distance);
            }
            near.iter().for_each(|&i| distance[i as usize] = FAR);
            wanting.retain(|&i| self.surplus[i as usize] < 0);
        }
        -(wanting.iter().map(|&i| self.surplus[i as usize])).sum::<i64>()
    }

    /// Lists the nodes near those that want, by their distance against the flow; false when no
    /// surplus can reach any.
    fn approach(&self, wanting: &[u32], distance: &mut [u32], near: &mut Vec<u32>) -> bool {
        near.clear();
        near.extend(wanting);
        near.iter().for_each(|&i| distance[i as usize] = 0);
        let (mut at, mut last) = (0, FAR);
        while at < near.len() && distance[near[at] as usize] < last {
            let here = distance[near[at] as usize];
            for arc in self.arcs_of(near[at]) {
                let arc = &self.arcs[arc];
                let node = arc.to as usize;
                if distance[node] == FAR && self.arcs[arc.twin as usize].left > 0 {
                    distance[node] = here + 1;
                    near.push(arc.to);
                    if self.surplus[node] > 0 {
                        last = last.min(here + 1 + BEYOND);
                    }
                }
            }
            at += 1;
        }
        last != FAR
    }

    /// Moves the surplus of a node to nodes that are nearer to those that want.
    fn push(&mut self, node: u32, distance: &[u32]) {
        let mut surplus = self.surplus[node as usize];
        let nearer = distance[node as usize].wrapping_sub(1);
        for k in self.arcs_of(node) {
            if surplus <= 0 {
                break;
            }
            let HalfArc { to, twin, left } = self.arcs[k];
            if left > 0 && distance[to as usize] == nearer {
                let moved = surplus.min(left);
                self.arcs[k].left -= moved;
                self.arcs[twin as usize].left += moved;
                self.surplus[to as usize] += moved;
                surplus -= moved;
            }
        }
        self.surplus[node as usize] = surplus;
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
                if arc.left > 0 && !reached[arc.to as usize] {
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
    use crate::testing::uniform;

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
