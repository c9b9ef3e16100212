//! The nearest descriptors: all squared distances of two sets, eight at a time.
//!
//! The second set is stored so that one vector holds the same two numbers of eight descriptors;
//! multiplied by two numbers of a descriptor of the first set, repeated eight times, it gives parts
//! of eight scalar products, which no lane has to add to another.

use wide::{i16x16, i32x8};

use crate::orienting::structure_from_motion::features::{Descriptor, LENGTH};

/// Descriptors in one vector.
const LANES: usize = 8;

/// Pairs of numbers of a descriptor.
const PAIRS: usize = LENGTH / 2;

/// Descriptors of the first set that share what was loaded of the second.
const ROWS: usize = 4;

/// Distance of a place without a descriptor.
const NONE: i32 = i32::MAX / 2;

/// Eight descriptors: the same pair of numbers of all of them in each vector.
struct Eight {
    pairs: [i16x16; PAIRS],
    /// Their squared lengths.
    squares: i32x8,
}

impl Eight {
    fn new(descriptors: &[Descriptor]) -> Self {
        let number = |lane: usize, i: usize| descriptors.get(lane).map_or(0, |d| i16::from(d[i]));
        let pair = |p: usize| i16x16::new(std::array::from_fn(|k| number(k / 2, 2 * p + k % 2)));
        let squares: [i32; LANES] =
            std::array::from_fn(|lane| descriptors.get(lane).map_or(NONE, square));
        Self {
            pairs: std::array::from_fn(pair),
            squares: i32x8::new(squares),
        }
    }
}

fn square(descriptor: &Descriptor) -> i32 {
    descriptor
        .iter()
        .map(|&v| i32::from(v) * i32::from(v))
        .sum()
}

/// The nearest descriptor of the other set.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    /// Its index; of equally near ones the first. `usize::MAX` where there is none.
    pub index: usize,
    /// Squared distance.
    pub best: i32,
    /// Squared distance of the second nearest.
    pub next: i32,
}

/// What is nearest in both directions.
pub(super) struct NearestBothWays {
    /// For each of the first set.
    pub rows: Vec<Nearest>,
    /// For each of the second set, the index in the first.
    pub columns: Vec<usize>,
}

/// The nearest of what every lane has seen.
#[derive(Clone, Copy)]
struct Lanes {
    best: i32x8,
    next: i32x8,
    index: i32x8,
}

impl Lanes {
    fn new() -> Self {
        Self {
            best: i32x8::splat(NONE),
            next: i32x8::splat(NONE),
            index: i32x8::splat(-1),
        }
    }

    #[inline]
    fn take(&mut self, distance: i32x8, index: i32) {
        let is_nearer = distance.simd_lt(self.best);
        self.next = self.next.min(self.best.max(distance));
        self.best = self.best.min(distance);
        self.index = self.index ^ ((self.index ^ i32x8::splat(index)) & is_nearer);
    }

    /// Over all lanes, which hold every eighth descriptor.
    fn nearest(&self) -> Nearest {
        let (best, next, block) = (
            self.best.to_array(),
            self.next.to_array(),
            self.index.to_array(),
        );
        let mut nearest = Nearest {
            index: usize::MAX,
            best: NONE,
            next: NONE,
        };
        for lane in 0..LANES {
            if block[lane] < 0 {
                continue;
            }
            let index = block[lane] as usize * LANES + lane;
            let is_first = best[lane] == nearest.best && index < nearest.index;
            let loser = if best[lane] < nearest.best || is_first {
                let loser = nearest.best;
                (nearest.best, nearest.index) = (best[lane], index);
                loser
            } else {
                best[lane]
            };
            nearest.next = nearest.next.min(loser).min(next[lane]);
        }
        nearest
    }
}

/// All distances between two sets.
pub(super) fn nearest(first: &[Descriptor], second: &[Descriptor]) -> NearestBothWays {
    let blocks: Vec<Eight> = second.chunks(LANES).map(Eight::new).collect();
    let mut columns = vec![Lanes::new(); blocks.len()];
    let mut rows = Vec::with_capacity(first.len());
    for (quad_number, quad) in first.chunks(ROWS).enumerate() {
        // A block that is not full repeats its last row, whose results are not used.
        let of_row = |r: usize| &quad[r.min(quad.len() - 1)];
        let repeated: Vec<[i16x16; ROWS]> = (0..PAIRS)
            .map(|p| {
                std::array::from_fn(|r| {
                    let pair = [2 * p, 2 * p + 1].map(|i| i16::from(of_row(r)[i]));
                    i16x16::new(std::array::from_fn(|k| pair[k % 2]))
                })
            })
            .collect();
        let squares: [i32x8; ROWS] = std::array::from_fn(|r| i32x8::splat(square(of_row(r))));
        let mut lanes = [Lanes::new(); ROWS];
        for ((number, block), column) in blocks.iter().enumerate().zip(&mut columns) {
            let mut sums = [i32x8::ZERO; ROWS];
            for (pair, rows) in block.pairs.iter().zip(&repeated) {
                for (sum, row) in sums.iter_mut().zip(rows) {
                    *sum += pair.dot(*row);
                }
            }
            for r in 0..quad.len() {
                let distance = squares[r] + block.squares - (sums[r] + sums[r]);
                lanes[r].take(distance, number as i32);
                column.take(distance, (quad_number * ROWS + r) as i32);
            }
        }
        rows.extend(lanes[..quad.len()].iter().map(Lanes::nearest));
    }
    let of_columns = columns.iter().flat_map(|lanes| lanes.index.to_array());
    let columns = of_columns.take(second.len());
    NearestBothWays {
        rows,
        columns: columns
            .map(|i| usize::try_from(i).unwrap_or(usize::MAX))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::structure_from_motion::random::Random;

    #[test]
    fn all_distances_one_by_one_give_the_same() {
        let mut random = Random::new(14);
        // Few values, so that equal distances occur.
        let mut drawn = |n: usize| -> Vec<Descriptor> {
            (0..n)
                .map(|_| std::array::from_fn(|i| if i < 3 { random.below(3) as u8 } else { 9 }))
                .collect()
        };
        let (first, second) = (drawn(23), drawn(37));
        let found = nearest(&first, &second);
        let distance = |a: &Descriptor, b: &Descriptor| -> i32 {
            a.iter()
                .zip(b)
                .map(|(x, y)| (i32::from(*x) - i32::from(*y)) * (i32::from(*x) - i32::from(*y)))
                .sum()
        };
        for (a, row) in first.iter().zip(&found.rows) {
            let mut all: Vec<(i32, usize)> = second
                .iter()
                .enumerate()
                .map(|(j, b)| (distance(a, b), j))
                .collect();
            all.sort_unstable();
            assert_eq!((row.best, row.index), all[0]);
            assert_eq!(row.next, all[1].0);
        }
        for (b, &column) in second.iter().zip(&found.columns) {
            let all = first.iter().enumerate().map(|(i, a)| (distance(a, b), i));
            assert_eq!(all.min().unwrap().1, column);
        }
    }
}
