//! Moving nodes to where the description is shortest.
//!
//! The two moves of ORIS only take vectors away: a break point that is left stands on a crack
//! between two basins, and where the straightening of a staircase took the corner itself, on the
//! crack beside it. This third move is not in W96's list, but its principle: among the lattice
//! points nearby a node goes to the one with the shortest description. Nothing is added or taken
//! away, so that only grey values count. A vertex of two or more boundaries drags all of them.

use std::collections::VecDeque;

use super::code_length::{CodeLength, LEAST_GAIN};
use super::edge_grid::EdgeGrid;
use super::integrals::{Lattice, RegionMoments};
use super::partition::{ImagePartition, OUTSIDE_REGION};

/// All steps up to this are tried in either axis, pixels: boundaries run in any direction, and a
/// node that slides along one needs steps in that direction. Assumption.
const SHORT_STEPS_PX: i32 = 2;
/// ... and one longer step in each of eight directions, pixels, where single steps each lose what
/// several gain. Assumption.
const LONG_STEP_PX: i32 = 4;

/// Moves nodes while any of these steps shortens the description; returns how many moves it took.
pub(crate) fn settle(p: &mut ImagePartition, code: &CodeLength) -> usize {
    let mut grid = EdgeGrid::new(p);
    let movable = |n: &u32| p.nodes[*n as usize].edges().len() > 1;
    let mut queue: VecDeque<u32> = (0..p.nodes.len() as u32).filter(movable).collect();
    let mut waiting = vec![true; p.nodes.len()];
    let mut moves = 0;
    while let Some(node) = queue.pop_front() {
        waiting[node as usize] = false;
        let Some((to, shift)) = best_step(p, &grid, code, node) else {
            continue;
        };
        p.move_node(node, to, &shift);
        grid.add_around(p, node);
        moves += 1;
        for n in p.around(node).chain([node]) {
            if !std::mem::replace(&mut waiting[n as usize], true) {
                queue.push_back(n);
            }
        }
    }
    moves
}

/// What a step gains, where it leads, and the pixels that each region wins by it.
type Step = (f64, Lattice, Vec<(u32, RegionMoments)>);

/// The step with the largest gain, and the pixels that each region wins by it; `None` where none
/// gains.
fn best_step(
    p: &ImagePartition,
    grid: &EdgeGrid,
    code: &CodeLength,
    node: u32,
) -> Option<(Lattice, Vec<(u32, RegionMoments)>)> {
    let at = p.nodes[node as usize].at;
    let mut steps: Vec<Step> = Vec::new();
    for (dx, dy) in offsets() {
        let to = Lattice {
            x: at.x + dx,
            y: at.y + dy,
        };
        if p.covers(to) {
            let shift = p.shift(node, to);
            let gain = gain(p, code, &shift);
            if gain > LEAST_GAIN {
                steps.push((gain, to, shift));
            }
        }
    }
    // Few steps gain, so only these are tested for crossings.
    steps.sort_by(|a, b| b.0.total_cmp(&a.0));
    let free = |to: Lattice| p.may_move(node, to) && !grid.crossed(p, node, to);
    let best = steps.into_iter().find(|s| free(s.1));
    best.map(|(_, to, shift)| (to, shift))
}

fn offsets() -> impl Iterator<Item = (i32, i32)> {
    let square = |r: i32| (-r..=r).flat_map(move |y| (-r..=r).map(move |x| (x, y)));
    let far = square(1).map(|(x, y)| (LONG_STEP_PX * x, LONG_STEP_PX * y));
    square(SHORT_STEPS_PX).chain(far).filter(|d| *d != (0, 0))
}

/// By how many bits the regions get shorter; minus infinity where one would lose all its pixels.
fn gain(p: &ImagePartition, code: &CodeLength, shift: &[(u32, RegionMoments)]) -> f64 {
    let mut gain = 0.0;
    for (region, won) in shift.iter().filter(|s| s.0 != OUTSIDE_REGION) {
        let old = p.regions[*region as usize].moments;
        let new = old + *won;
        if new.count < 1 {
            return f64::NEG_INFINITY;
        }
        gain += code.region(&old) - code.region(&new);
    }
    gain
}
