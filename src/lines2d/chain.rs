//! Edgels linked into chains, jumping a gap of one pixel (B99 3.2).
//!
//! Every edgel looks for the next one along its tangent among its 8 neighbours and, when there is
//! none, in the ring of 16 behind them; a link stands when both ends choose each other. Because tangents are
//! directed by contrast, chains are too, and the outcome does not depend on where the linking starts.
//! Canny's hysteresis is applied to whole chains: one strong edgel keeps all.

use nalgebra::Vector2;
use serde::Serialize;

use super::canny::Edgel;

/// Edgels in order, the brighter side to the right as seen on the screen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Chain {
    /// Indices into the edgels.
    pub edgels: Vec<u32>,
    /// Whether the last edgel is followed by the first.
    pub closed: bool,
}

/// No edgel.
pub const NONE: u32 = u32::MAX;

/// Links edgels (one a pixel at most, as [`super::detect_edgels`] gives them) into chains of two
/// and more; chains without any edgel of at least `high` times its noise are dropped. Chains are
/// ordered by their first edgel's index.
pub fn link_chains(edgels: &[Edgel], high: f64) -> Vec<Chain> {
    link_on(edgels, &Raster::new(edgels), high)
}

/// [`link_chains`] on a raster of the edgels that is at hand.
pub fn link_on(edgels: &[Edgel], raster: &Raster, high: f64) -> Vec<Chain> {
    let next = choose(edgels, raster, 1.0);
    let previous = choose(edgels, raster, -1.0);
    let mutual = |i: u32| {
        let j = next[i as usize];
        (j != NONE && previous[j as usize] == i).then_some(j)
    };
    let has_previous = |i: u32| {
        let j = previous[i as usize];
        j != NONE && next[j as usize] == i
    };
    let high = high as f32;
    let mut seen = vec![false; edgels.len()];
    let mut chains = Vec::new();
    let count = u32::try_from(edgels.len()).expect("fewer than 2^32 edgels");
    // Open chains begin where nothing links in; what is left after them are rings.
    for rings in [false, true] {
        for start in 0..count {
            if seen[start as usize] || (!rings && has_previous(start)) {
                continue;
            }
            let chain = walk(start, rings, &mutual, &mut seen);
            let strong = |&i: &u32| edgels[i as usize].strength >= high * edgels[i as usize].noise;
            if chain.edgels.len() >= 2 && chain.edgels.iter().any(strong) {
                chains.push(chain);
            }
        }
    }
    chains.sort_by_key(|chain| chain.edgels[0]);
    chains
}

fn walk(start: u32, closed: bool, next: &impl Fn(u32) -> Option<u32>, seen: &mut [bool]) -> Chain {
    let mut edgels = vec![start];
    seen[start as usize] = true;
    let mut at = start;
    while let Some(i) = next(at) {
        if seen[i as usize] {
            break;
        }
        seen[i as usize] = true;
        edgels.push(i);
        at = i;
    }
    Chain { edgels, closed }
}

/// Each edgel's choice of a follower (`sense` 1) or a predecessor (-1).
fn choose(edgels: &[Edgel], raster: &Raster, sense: f64) -> Vec<u32> {
    edgels
        .iter()
        .map(|e| {
            let near = best(edgels, raster, e, sense, 1);
            if near != NONE {
                near
            } else {
                best(edgels, raster, e, sense, 2)
            }
        })
        .collect()
}

/// The cheapest edgel on the ring of pixels at Chebyshev distance `ring`.
fn best(edgels: &[Edgel], raster: &Raster, from: &Edgel, sense: f64, ring: isize) -> u32 {
    let (x, y) = from.pixel();
    let tangent = from.tangent() * sense;
    let mut best = (f64::INFINITY, NONE);
    for dy in -ring..=ring {
        let step = if dy.abs() == ring { 1 } else { 2 * ring };
        for dx in (-ring..=ring).step_by(step as usize) {
            let index = raster.at(x as isize + dx, y as isize + dy);
            if index == NONE {
                continue;
            }
            let cost = link_cost(from, &edgels[index as usize], &tangent);
            if cost < best.0 {
                best = (cost, index);
            }
        }
    }
    best.1
}

/// How far apart two edgels are, sideways distance counted double; infinite when the second does not lie
/// ahead or its contrast has turned by more than a right angle.
fn link_cost(from: &Edgel, to: &Edgel, tangent: &Vector2<f64>) -> f64 {
    let step = to.position - from.position;
    let ahead = step.dot(tangent);
    let aside = (step.x * tangent.y - step.y * tangent.x).abs();
    if ahead <= 0.0 || aside > 1.5 * ahead || from.gradient.dot(&to.gradient) <= 0.0 {
        return f64::INFINITY;
    }
    ahead + 2.0 * aside
}

/// Which edgel a pixel holds ([`NONE`] elsewhere).
pub struct Raster {
    width: isize,
    height: isize,
    index: Vec<u32>,
}

impl Raster {
    /// The raster of edgels that have a pixel each.
    pub fn new(edgels: &[Edgel]) -> Self {
        let (mut columns, mut rows) = (0, 0);
        for (x, y) in edgels.iter().map(Edgel::pixel) {
            columns = columns.max(x + 1);
            rows = rows.max(y + 1);
        }
        let mut index = vec![NONE; columns * rows];
        for (i, (x, y)) in (0..).zip(edgels.iter().map(Edgel::pixel)) {
            index[y * columns + x] = i;
        }
        Self {
            width: columns as isize,
            height: rows as isize,
            index,
        }
    }

    /// The edgel of a pixel; none outside.
    pub fn at(&self, x: isize, y: isize) -> u32 {
        if x < 0 || y < 0 || x >= self.width || y >= self.height {
            return NONE;
        }
        self.index[(y * self.width + x) as usize]
    }
}
