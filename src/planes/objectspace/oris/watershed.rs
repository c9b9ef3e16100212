//! The initial fine partition: the catchment basins of the gradient.
//!
//! Every local minimum of the gradient's magnitude starts a region, and the regions grow over the
//! pixels in the order of their gradient until they meet: borders run along the crests of the
//! gradient, where edges are. Assumption: W96 does not say how the fine partition is made. Single
//! pixels as regions would be the finest, at fifteen times the cost and with the same edges.

use super::integrals::CHANNELS;
use crate::photographs::raster::Gray;

/// Labels of the pixels of a blurred image, row by row, counted from 0, and the number of regions.
pub(super) fn watershed(smooth: &[Gray; CHANNELS]) -> (Vec<u32>, usize) {
    let level = gradient_levels(smooth);
    let (w, h) = (smooth[0].width, smooth[0].height);
    let (mut labels, count) = minima(&level, w, h);
    let mut queue = BucketQueue::new(&level);
    for k in 0..w * h {
        if labels[k] != UNLABELLED {
            queue.push(k, level[k]);
        }
    }
    while let Some(k) = queue.pop() {
        for n in neighbours(k, w, h) {
            if labels[n] == UNLABELLED {
                labels[n] = labels[k];
                queue.push(n, level[n].max(level[k]));
            }
        }
    }
    (labels, count)
}

/// A pixel that no region has reached.
const UNLABELLED: u32 = u32::MAX;

/// Steps of the gradient magnitude per grey range: a quarter grey level of 255 per pixel.
const LEVELS_PER_GREY_RANGE: f32 = 1020.0;

/// Gradient magnitude in whole steps.
fn gradient_levels(smooth: &[Gray; CHANNELS]) -> Vec<u16> {
    let (w, h) = (smooth[0].width, smooth[0].height);
    let mut levels = Vec::with_capacity(w * h);
    for y in 0..h {
        let (above, below) = (y.saturating_sub(1), (y + 1).min(h - 1));
        for x in 0..w {
            let square = |g: &Gray| {
                let gx = g.get((x + 1).min(w - 1), y) - g.get(x.saturating_sub(1), y);
                let gy = g.get(x, below) - g.get(x, above);
                gx * gx + gy * gy
            };
            let sum: f32 = smooth.iter().map(square).sum();
            levels.push((sum.sqrt() * LEVELS_PER_GREY_RANGE).round() as u16);
        }
    }
    levels
}

/// Labels the plateaus that have no lower neighbour; everything else is [`UNLABELLED`].
fn minima(level: &[u16], w: usize, h: usize) -> (Vec<u32>, usize) {
    let mut labels = vec![UNLABELLED; w * h];
    let mut seen = vec![false; w * h];
    let mut count = 0;
    let mut plateau = Vec::new();
    for start in 0..w * h {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        plateau.clear();
        plateau.push(start);
        let (mut next, mut lowest) = (0, true);
        while let Some(&k) = plateau.get(next) {
            next += 1;
            for n in neighbours(k, w, h) {
                if level[n] < level[k] {
                    lowest = false;
                } else if level[n] == level[k] && !seen[n] {
                    seen[n] = true;
                    plateau.push(n);
                }
            }
        }
        if lowest {
            plateau.iter().for_each(|&k| labels[k] = count);
            count += 1;
        }
    }
    (labels, count as usize)
}

/// The four neighbours of a pixel.
fn neighbours(k: usize, w: usize, h: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (k % w, k / w);
    [
        (x > 0).then(|| k - 1),
        (x + 1 < w).then(|| k + 1),
        (y > 0).then(|| k - w),
        (y + 1 < h).then(|| k + w),
    ]
    .into_iter()
    .flatten()
}

/// First in, first out within each level; levels ascend.
struct BucketQueue {
    buckets: Vec<Vec<u32>>,
    level: usize,
    next: usize,
}

impl BucketQueue {
    fn new(level: &[u16]) -> Self {
        let top = level.iter().copied().max().unwrap_or(0);
        Self {
            buckets: vec![Vec::new(); usize::from(top) + 1],
            level: 0,
            next: 0,
        }
    }

    fn push(&mut self, k: usize, level: u16) {
        self.buckets[usize::from(level).max(self.level)].push(k as u32);
    }

    fn pop(&mut self) -> Option<usize> {
        while let Some(bucket) = self.buckets.get_mut(self.level) {
            if let Some(&k) = bucket.get(self.next) {
                self.next += 1;
                return Some(k as usize);
            }
            *bucket = Vec::new();
            self.level += 1;
            self.next = 0;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn basins_meet_at_the_edge() {
        let gray = Gray::from_fn(12, 9, |x, _| if x < 5 { 0.2 } else { 0.8 });
        let (labels, count) = watershed(&[gray.clone(), Gray::new(12, 9), Gray::new(12, 9)]);
        assert_eq!(count, 2);
        for (k, label) in labels.iter().enumerate() {
            assert_eq!(*label, u32::from(k % 12 >= 5), "pixel {k}");
        }
    }
}
