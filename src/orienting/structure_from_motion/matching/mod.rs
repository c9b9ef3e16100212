//! Which keypoints of two photographs show the same place, by their descriptors alone.
//!
//! ```text
//! nearest      the two nearest descriptors of each, in one pass for both directions
//! candidates   which pairs of photographs are worth that
//! ```

mod candidates;
mod nearest;

pub(super) use candidates::{Candidate, candidate_pairs};

use super::features::{Descriptor, Features};
use nearest::nearest;

/// Largest ratio of the distances to the nearest and the second nearest descriptor (Lowe 2004,
/// section 7.1).
const RATIO: f32 = 0.8;

/// Largest distance of two descriptors, in those of length 512: about 40 degrees.
const MOST_DISTANCE: f32 = 360.0;

/// Pairs of keypoints that are each other's nearest and pass the ratio test, by the first's index.
pub(super) fn mutual_matches(first: &Features, second: &Features) -> Vec<(usize, usize)> {
    matches_of(&first.descriptors, &second.descriptors)
}

fn matches_of(first: &[Descriptor], second: &[Descriptor]) -> Vec<(usize, usize)> {
    let found = nearest(first, second);
    let is_distinct = |best: i32, next: i32| {
        let (best, next) = (best as f32, next as f32);
        best <= MOST_DISTANCE * MOST_DISTANCE && best < RATIO * RATIO * next
    };
    (found.rows.iter().enumerate())
        .filter(|(i, row)| {
            is_distinct(row.best, row.next) && found.columns.get(row.index) == Some(i)
        })
        .map(|(i, row)| (i, row.index))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::structure_from_motion::random::Random;

    #[test]
    fn noisy_copies_are_found_and_strangers_are_not() {
        let mut random = Random::new(2);
        let mut drawn = || -> Descriptor { std::array::from_fn(|_| random.below(90) as u8) };
        let first: Vec<Descriptor> = (0..101).map(|_| drawn()).collect();
        let mut second: Vec<Descriptor> = (0..53).map(|_| drawn()).collect();
        for (i, copied) in first.iter().enumerate().take(40) {
            second[i + 7] = copied.map(|v| v.saturating_add((i % 5) as u8));
        }
        let expected: Vec<_> = (0..40).map(|i| (i, i + 7)).collect();
        assert_eq!(matches_of(&first, &second), expected);
        let turned: Vec<_> = expected.iter().map(|&(i, j)| (j, i)).collect();
        assert_eq!(matches_of(&second, &first), turned);
        assert!(matches_of(&first, &[]).is_empty());
    }

    #[test]
    fn what_repeats_matches_nothing() {
        let mut random = Random::new(9);
        let one: Descriptor = std::array::from_fn(|_| random.below(90) as u8);
        assert!(matches_of(&[one], &[one, one]).is_empty());
    }
}
