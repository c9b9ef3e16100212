//! The ground as the surface of least energy below matched positions.
//!
//! ```text
//! E(h) = sum_blocks m (A a(h) + B b(h))  +  sum_neighbours |h - h'| / d
//! ```
//!
//! Per block of the plan, h is how far its middle lies above the plane of the ground as a whole, m
//! the share of it that is matched; of that, a lies above h (roofs, crowns) and b below it (wrong
//! matches). A and B are how much likelier, in nats, a position lies on the ground than at one
//! height above or below it; a block is as large as a correlation window or two, so it counts as
//! one observation. Neighbouring blocks differ by d in the mean. A roof pays for its whole rim as
//! many metres as it is high, and a bank for its length only: so the surface passes below the one
//! and follows the other.

use crate::base::labelling::{Energy, Labelling, PairwiseCosts};

/// What lies closer than this to the surface is ground, metres: as rough as ground is.
pub(super) const ROUGHNESS: f64 = 0.5;
/// Density of matched positions per metre of height: on the ground, above it and below it.
/// Source: sixteen random scenes of the fitting seeds (1 to 24), of whose positions .46 lie on the
/// ground (within half a metre), .51 in the ten metres above and .037 in the three metres below.
const ON_GROUND: f64 = 0.46;
const ABOVE: f64 = 0.051;
const BELOW: f64 = 0.012;
/// Mean difference of neighbouring blocks beyond the common plane, metres. Assumption: a slope of
/// three degrees.
const MEAN_STEP: f64 = 0.25;
/// Heights to choose from lie this far apart, metres, or are this many.
const STEP: f64 = 0.25;
const MOST_HEIGHTS: f64 = 100.0;

/// A raster of blocks, each with the heights that are matched in it, metres, ascending.
pub(super) struct Blocks {
    pub(super) columns: usize,
    pub(super) heights: Vec<Vec<f64>>,
}

/// The surface of least energy.
pub(super) struct Surface {
    /// Of each block, metres.
    pub(super) heights: Vec<f64>,
    /// Nats.
    pub(super) energy: f64,
}

/// The surface of least energy below what is matched.
pub(super) fn below(blocks: &Blocks) -> Surface {
    let all = || blocks.heights.iter().flatten().copied();
    let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| {
        (low.min(h), high.max(h))
    });
    if low > high {
        let heights = vec![0.0; blocks.heights.len()];
        return Surface {
            heights,
            energy: 0.0,
        };
    }
    let step = STEP.max((high - low) / MOST_HEIGHTS);
    let choices: Vec<f64> = (0..=((high - low) / step) as usize)
        .map(|i| low + i as f64 * step)
        .collect();
    let whole = blocks.heights.iter().map(Vec::len).max().unwrap_or(0) as f64;
    let costs = crate::base::execution::map(&blocks.heights, |_, heights| {
        let matched = heights.len() as f64 / whole;
        let cost = |h: &f64| matched * cost(heights, *h);
        choices.iter().map(cost).collect::<Vec<f64>>()
    });
    let neighbours = neighbours(blocks.columns, blocks.heights.len());
    // Every block has a height: it costs less than none.
    let bound = costs.iter().flatten().copied().fold(0.0, f64::max) + 1.0;
    let offset = |costs: &Vec<f64>| {
        let offset = costs.iter().map(|cost| cost - bound);
        (0..).zip(offset).collect()
    };
    let energy = Energy {
        unary: costs.iter().map(offset).collect(),
        edges: neighbours.clone(),
        borders: Steps(step),
    };
    let mut labelling = Labelling::new(energy, choices.len() as u32);
    labelling.relabel(vec![0; blocks.heights.len()]);
    labelling.minimise();
    let labels = labelling.labels();
    let label = |k: usize| (labels[k] as usize).min(choices.len() - 1);
    let data: f64 = (0..labels.len()).map(|k| costs[k][label(k)]).sum();
    let rim = |[k, l]: &[usize; 2]| label(*k).abs_diff(label(*l)) as f64 * step / MEAN_STEP;
    Surface {
        heights: (0..labels.len()).map(|k| choices[label(k)]).collect(),
        energy: data + neighbours.iter().map(rim).sum::<f64>(),
    }
}

/// What a block says against ground at a height, nats; nothing where nothing is matched.
fn cost(heights: &[f64], height: f64) -> f64 {
    if heights.is_empty() {
        return 0.0;
    }
    let lower_than = |h: f64| heights.partition_point(|z| *z < h);
    let below = lower_than(height - ROUGHNESS);
    let above = heights.len() - lower_than(height + ROUGHNESS);
    let odds = |density: f64| crate::base::math::ln(ON_GROUND / density);
    (above as f64 * odds(ABOVE) + below as f64 * odds(BELOW)) / heights.len() as f64
}

/// Pairs of blocks that touch along a side.
pub(super) fn neighbours(columns: usize, count: usize) -> Vec<[usize; 2]> {
    let of = |k: usize| {
        let right = (!(k + 1).is_multiple_of(columns)).then_some([k, k + 1]);
        let above = (k + columns < count).then_some([k, k + columns]);
        right.into_iter().chain(above)
    };
    (0..count).flat_map(of).collect()
}

/// Steps between neighbouring blocks, a label being this many metres.
struct Steps(f64);

impl PairwiseCosts for Steps {
    fn cost(&self, _: usize, left: u32, right: u32) -> f64 {
        self.0 * f64::from(left.abs_diff(right)) / MEAN_STEP
    }

    // All edges cost the same.
    fn reorder(&mut self, _: &[usize]) {}

    fn upper_bound(&self, _: usize) -> f64 {
        self.0 * MOST_HEIGHTS / MEAN_STEP
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten by ten blocks of twenty positions at heights by column and row.
    fn blocks(height: impl Fn(usize, usize) -> f64) -> Blocks {
        let of = |k: usize| vec![height(k % 10, k / 10); 20];
        Blocks {
            columns: 10,
            heights: (0..100).map(of).collect(),
        }
    }

    #[test]
    fn the_surface_passes_below_a_roof() {
        let roof = |c: usize, r: usize| (3..6).contains(&c) && (3..5).contains(&r);
        let found = below(&blocks(|c, r| if roof(c, r) { 3.0 } else { 0.0 }));
        assert!(
            found.heights.iter().all(|h| h.abs() <= STEP),
            "{:?}",
            found.heights
        );
        // Six blocks of a hundred lie above it, and nothing else costs.
        let expected = 6.0 * crate::base::math::ln(ON_GROUND / ABOVE);
        assert!((found.energy - expected).abs() < 1e-9, "{}", found.energy);
    }

    #[test]
    fn the_surface_rises_with_a_bank() {
        let found = below(&blocks(|c, _| if c > 4 { 2.0 } else { 0.0 }));
        for (k, h) in found.heights.iter().enumerate() {
            let bank = if k % 10 > 4 { 2.0 } else { 0.0 };
            assert!(
                (h - bank).abs() <= ROUGHNESS,
                "{h} m at {}, {}",
                k % 10,
                k / 10
            );
        }
    }

    #[test]
    fn a_few_wrong_matches_below_do_not_lower_it() {
        let wrong = |c: usize, r: usize| c == 0 && r < 3;
        let found = below(&blocks(|c, r| if wrong(c, r) { -6.0 } else { 0.0 }));
        assert!(
            found.heights.iter().all(|h| h.abs() <= ROUGHNESS),
            "{:?}",
            found.heights
        );
    }

    #[test]
    fn blocks_without_matches_cost_nothing() {
        let empty = Blocks {
            columns: 2,
            heights: vec![Vec::new(); 4],
        };
        let found = below(&empty);
        assert_eq!((found.heights, found.energy), (vec![0.0; 4], 0.0));
    }
}
