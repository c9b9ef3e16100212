//! Edgels linked into chains, jumping a gap of one pixel (B99 3.2).
//!
//! Every edgel looks for the next one along its tangent among its 8 neighbours and, when there is
//! none, in the ring of 16 behind them; a link stands when both ends choose each other. Because
//! tangents are directed by contrast, chains are too, and the outcome does not depend on where the
//! linking starts. Canny's hysteresis is applied to whole chains: one strong edgel keeps all.

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
pub(crate) const NONE: u32 = u32::MAX;

/// Links edgels (one a pixel at most, as [`super::canny::detect_edgels`] gives them) into chains
/// of two and more; chains without any edgel of at least `high` times its noise are dropped.
/// Chains are ordered by their first edgel's index.
pub fn link_chains(edgels: &[Edgel], high: f64) -> Vec<Chain> {
    link_on(edgels, &Raster::new(edgels), high)
}

/// [`link_chains`] on an existing raster of the edgels.
pub(crate) fn link_on(edgels: &[Edgel], raster: &Raster, high: f64) -> Vec<Chain> {
    let (next, previous) = choose(edgels, raster);
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
    // Open chains begin where nothing links in; the remaining ones are closed.
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

/// Each edgel's choice of a follower and of a predecessor.
fn choose(edgels: &[Edgel], raster: &Raster) -> (Vec<u32>, Vec<u32>) {
    let mut next = Vec::with_capacity(edgels.len());
    let mut previous = Vec::with_capacity(edgels.len());
    for from in edgels {
        let around = raster.occupied(from);
        let mut choice = Choice::default();
        choice.look(edgels, raster, from, around & RING_1);
        let near = choice;
        if near.next == NONE || near.previous == NONE {
            choice.look(edgels, raster, from, around & RING_2);
        }
        // Adjacent edgels precede those across a gap.
        next.push(if near.next != NONE {
            near.next
        } else {
            choice.next
        });
        previous.push(if near.previous != NONE {
            near.previous
        } else {
            choice.previous
        });
    }
    (next, previous)
}

/// The 8 pixels around the middle of 5 x 5, one bit each, row by row.
const RING_1: u32 = 0b00000_01110_01010_01110_00000;
/// The 16 pixels around those.
const RING_2: u32 = 0b11111_10001_10001_10001_11111;

/// The cheapest follower and predecessor so far.
#[derive(Clone, Copy)]
struct Choice {
    next: u32,
    next_cost: f64,
    previous: u32,
    previous_cost: f64,
}

impl Default for Choice {
    fn default() -> Self {
        Self {
            next: NONE,
            next_cost: f64::INFINITY,
            previous: NONE,
            previous_cost: f64::INFINITY,
        }
    }
}

impl Choice {
    /// Considers the edgels of these pixels around `from`. The cost of a link is the distance
    /// along the tangent plus twice the distance aside (times the gradient's strength, which is
    /// the same for all); there is none when the other edgel lies more aside than along or its
    /// contrast has turned by more than a right angle.
    fn look(&mut self, edgels: &[Edgel], raster: &Raster, from: &Edgel, pixels: u32) {
        let gradient = from.gradient.cast::<f64>();
        let tangent = Vector2::new(gradient.y, -gradient.x);
        for index in raster.of(from, pixels) {
            let to = &edgels[index as usize];
            let step = to.position - from.position;
            let along = step.dot(&tangent);
            let aside = step.dot(&gradient).abs();
            if aside > 1.5 * along.abs() || from.gradient.dot(&to.gradient) <= 0.0 {
                continue;
            }
            let cost = along.abs() + 2.0 * aside;
            if along > 0.0 && cost < self.next_cost {
                (self.next, self.next_cost) = (index, cost);
            } else if along < 0.0 && cost < self.previous_cost {
                (self.previous, self.previous_cost) = (index, cost);
            }
        }
    }
}

/// Empty pixels around a raster, so that the neighbourhood of an edgel needs no bounds check.
const MARGIN: usize = 2;

/// Which edgel a pixel holds ([`NONE`] elsewhere).
pub(crate) struct Raster {
    width: usize,
    height: usize,
    index: Vec<u32>,
    /// One bit a pixel, `words` words a row: most pixels are empty, and 32 are tested at once.
    occupied: Vec<u32>,
    words: usize,
}

impl Raster {
    /// The raster of edgels that have a pixel each.
    pub(crate) fn new(edgels: &[Edgel]) -> Self {
        let (mut columns, mut rows) = (0, 0);
        for (x, y) in edgels.iter().map(Edgel::pixel) {
            columns = columns.max(x + 1);
            rows = rows.max(y + 1);
        }
        let (width, height) = (columns + 2 * MARGIN, rows + 2 * MARGIN);
        // A word more than the pixels need, because words are read in twos.
        let words = width / 32 + 2;
        let mut index = vec![NONE; width * height];
        let mut occupied = vec![0u32; words * height];
        for (i, (x, y)) in (0..).zip(edgels.iter().map(Edgel::pixel)) {
            let (x, y) = (x + MARGIN, y + MARGIN);
            index[y * width + x] = i;
            occupied[y * words + x / 32] |= 1 << (x % 32);
        }
        Self {
            width,
            height,
            index,
            occupied,
            words,
        }
    }

    /// The edgel of a pixel; none outside.
    pub(crate) fn at(&self, x: isize, y: isize) -> u32 {
        let (x, y) = (x + MARGIN as isize, y + MARGIN as isize);
        if x < 0 || y < 0 || x >= self.width as isize || y >= self.height as isize {
            return NONE;
        }
        self.index[y as usize * self.width + x as usize]
    }

    /// Which of the 5 x 5 pixels around an edgel hold edgels, one bit each, row by row.
    fn occupied(&self, edgel: &Edgel) -> u32 {
        let (x, y) = edgel.pixel();
        let mut bits = 0;
        for row in 0..5 {
            // The pixel's own bit is x + MARGIN, so the first of the five is x.
            let words = &self.occupied[(y + row) * self.words + x / 32..][..2];
            let both = u64::from(words[0]) | u64::from(words[1]) << 32;
            bits |= ((both >> (x % 32)) as u32 & 0b11111) << (5 * row);
        }
        bits
    }

    /// The edgels of some of the 5 x 5 pixels around that of an edgel, row by row; they must be
    /// there.
    fn of(&self, edgel: &Edgel, mut pixels: u32) -> impl Iterator<Item = u32> {
        let (x, y) = edgel.pixel();
        let first = y * self.width + x;
        std::iter::from_fn(move || {
            (pixels != 0).then(|| {
                let bit = pixels.trailing_zeros() as usize;
                pixels &= pixels - 1;
                self.index[first + bit / 5 * self.width + bit % 5]
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lines::lines2d::testing::edgel;

    /// Edgels along a row whose brighter side is below: chains run to the right.
    fn row(columns: &[i32]) -> Vec<Edgel> {
        let at = |&x: &i32| edgel(f64::from(x) + 0.5, 5.5, (0.0, 1.0));
        columns.iter().map(at).collect()
    }

    #[test]
    fn a_gap_of_one_pixel_is_jumped_and_a_wider_one_is_not() {
        let chains = link_chains(&row(&[3, 4, 6, 7, 10, 11]), 1.0);
        let members: Vec<_> = chains.iter().map(|c| c.edgels.clone()).collect();
        assert_eq!(members, [vec![0, 1, 2, 3], vec![4, 5]]);
    }

    #[test]
    fn chains_run_with_the_brighter_side_to_the_right() {
        let mut edgels = row(&[3, 4, 5]);
        assert_eq!(link_chains(&edgels, 1.0)[0].edgels, [0, 1, 2]);
        edgels.iter_mut().for_each(|e| e.gradient = -e.gradient);
        assert_eq!(link_chains(&edgels, 1.0)[0].edgels, [2, 1, 0]);
    }

    #[test]
    fn opposite_contrast_is_not_linked() {
        let mut edgels = row(&[3, 4, 5, 6]);
        edgels[2].gradient = -edgels[2].gradient;
        edgels[3].gradient = -edgels[3].gradient;
        let chains = link_chains(&edgels, 1.0);
        assert_eq!(chains.len(), 2);
        assert_eq!(chains[1].edgels, [3, 2]);
    }

    #[test]
    fn one_strong_edgel_keeps_a_chain() {
        let mut edgels = row(&[3, 4, 5, 20, 21, 22]);
        edgels[4].strength = 3.0 * edgels[4].noise;
        let kept = link_chains(&edgels, 2.5);
        assert_eq!(kept.len(), 1);
        assert_eq!(kept[0].edgels, [3, 4, 5]);
    }

    #[test]
    fn a_ring_is_closed_and_holds_every_edgel_once() {
        let on_circle = |i: i32| {
            let (s, c) = crate::base::math::sin_cos(f64::from(i) / 60.0 * std::f64::consts::TAU);
            edgel(20.5 + 10.0 * c, 20.5 + 10.0 * s, (c as f32, s as f32))
        };
        let mut edgels: Vec<_> = (0..60).map(on_circle).collect();
        edgels.sort_by_key(|e| (e.pixel().1, e.pixel().0));
        edgels.dedup_by_key(|e| e.pixel());
        let chains = link_chains(&edgels, 1.0);
        assert_eq!(chains.len(), 1);
        assert!(chains[0].closed);
        let mut members = chains[0].edgels.clone();
        members.sort_unstable();
        members.dedup();
        assert_eq!(members.len(), chains[0].edgels.len());
        assert!(members.len() * 10 >= edgels.len() * 9);
    }
}
