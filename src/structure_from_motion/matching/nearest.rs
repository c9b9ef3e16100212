//! The nearest descriptors: all squared distances of two sets, sixteen products at a time.

use wide::i16x16;

use crate::structure_from_motion::features::Descriptor;

/// Products in one instruction.
const LANES: usize = 16;

/// Vectors of a descriptor.
const PARTS: usize = 128 / LANES;

/// A descriptor as the processor multiplies it.
pub(super) struct Wide {
    parts: [i16x16; PARTS],
    /// Its squared length.
    square: i32,
}

impl Wide {
    pub(super) fn new(descriptor: &Descriptor) -> Self {
        let part = |p: usize| {
            i16x16::new(std::array::from_fn(|i| {
                i16::from(descriptor[p * LANES + i])
            }))
        };
        Self {
            parts: std::array::from_fn(part),
            square: descriptor
                .iter()
                .map(|&v| i32::from(v) * i32::from(v))
                .sum(),
        }
    }
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

/// Rows and columns of a block: as many sums as registers hold.
const ROWS: usize = 4;
const COLUMNS: usize = 2;

/// All distances between two sets.
pub(super) fn nearest(first: &[Wide], second: &[Wide]) -> NearestBothWays {
    let none = Nearest {
        index: usize::MAX,
        best: i32::MAX,
        next: i32::MAX,
    };
    let mut rows = vec![none; first.len()];
    let mut columns = vec![none; second.len()];
    for (block, quad) in first.chunks(ROWS).enumerate() {
        let top = block * ROWS;
        // A block that is not full repeats its last row, whose results are not used.
        let quad: [&Wide; ROWS] = std::array::from_fn(|r| &quad[r.min(quad.len() - 1)]);
        for (pair_number, pair) in second.chunks(COLUMNS).enumerate() {
            let left = pair_number * COLUMNS;
            let pair: [&Wide; COLUMNS] = [&pair[0], &pair[pair.len() - 1]];
            let products = products(&quad, &pair);
            for (r, of_row) in products.iter().enumerate() {
                let i = top + r;
                if i >= first.len() {
                    break;
                }
                for (c, product) in of_row.iter().enumerate() {
                    let j = left + c;
                    if j < second.len() {
                        let distance = quad[r].square + pair[c].square - 2 * product;
                        rows[i].take(j, distance);
                        columns[j].take(i, distance);
                    }
                }
            }
        }
    }
    NearestBothWays {
        rows,
        columns: columns.into_iter().map(|nearest| nearest.index).collect(),
    }
}

impl Nearest {
    #[inline]
    fn take(&mut self, index: usize, distance: i32) {
        if distance < self.next {
            if distance < self.best {
                self.next = self.best;
                self.best = distance;
                self.index = index;
            } else {
                self.next = distance;
            }
        }
    }
}

#[inline]
fn products(rows: &[&Wide; ROWS], columns: &[&Wide; COLUMNS]) -> [[i32; COLUMNS]; ROWS] {
    let mut sums = [[wide::i32x8::ZERO; COLUMNS]; ROWS];
    for p in 0..PARTS {
        let (a, b) = (columns[0].parts[p], columns[1].parts[p]);
        for (sum, row) in sums.iter_mut().zip(rows) {
            let part = row.parts[p];
            sum[0] += part.dot(a);
            sum[1] += part.dot(b);
        }
    }
    sums.map(|of_row| of_row.map(|sum| sum.reduce_add()))
}
