//! Where the nodes of a partition are, so that no boundary is moved over one.

use super::integrals::Lattice;

/// Which lattice points are nodes, a bit each.
pub(crate) struct Occupied {
    width: usize,
    words_per_row: usize,
    words: Vec<u64>,
}

impl Occupied {
    pub(super) fn new(width: usize, height: usize) -> Self {
        let words_per_row = width.div_ceil(64);
        Self {
            width,
            words_per_row,
            words: vec![0; words_per_row * height],
        }
    }

    pub(super) fn covers(&self, at: Lattice) -> bool {
        let height = self.words.len() / self.words_per_row;
        (0..self.width as i32).contains(&at.x) && (0..height as i32).contains(&at.y)
    }

    pub(super) fn get(&self, at: Lattice) -> bool {
        let word = self.words[at.y as usize * self.words_per_row + at.x as usize / 64];
        word >> (at.x as usize % 64) & 1 == 1
    }

    pub(super) fn set(&mut self, at: Lattice, value: bool) {
        let word = &mut self.words[at.y as usize * self.words_per_row + at.x as usize / 64];
        let bit = 1u64 << (at.x as usize % 64);
        if value { *word |= bit } else { *word &= !bit }
    }

    /// Is there a node in the closed triangle besides its corners?
    pub(super) fn within(&self, corners: [Lattice; 3]) -> bool {
        let [a, b, c] = corners;
        let (top, bottom) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        (top..=bottom).any(|y| {
            let (mut low, mut high) = (i64::MAX, i64::MIN);
            for (p, q) in [(a, b), (b, c), (c, a)] {
                let (p, q) = if p.y <= q.y { (p, q) } else { (q, p) };
                if y < p.y || y > q.y {
                    continue;
                }
                if p.y == q.y {
                    low = low.min(i64::from(p.x.min(q.x)));
                    high = high.max(i64::from(p.x.max(q.x)));
                    continue;
                }
                let (dx, dy) = (i64::from(q.x - p.x), i64::from(q.y - p.y));
                let n = dx * i64::from(y - p.y);
                low = low.min(i64::from(p.x) - (-n).div_euclid(dy));
                high = high.max(i64::from(p.x) + n.div_euclid(dy));
            }
            (low <= high) && self.any_in_row(y as usize, low as usize, high as usize, &corners)
        })
    }

    fn any_in_row(&self, y: usize, low: usize, high: usize, except: &[Lattice; 3]) -> bool {
        let row = &self.words[y * self.words_per_row..(y + 1) * self.words_per_row];
        (low / 64..=high / 64).any(|k| {
            let mut word = row[k];
            if k == low / 64 {
                word &= u64::MAX << (low % 64);
            }
            if k == high / 64 {
                word &= u64::MAX >> (63 - high % 64);
            }
            for p in except
                .iter()
                .filter(|p| p.y as usize == y && p.x as usize / 64 == k)
            {
                word &= !(1u64 << (p.x as usize % 64));
            }
            word != 0
        })
    }
}
