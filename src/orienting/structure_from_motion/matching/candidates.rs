//! Pairs of photographs that may overlap: by a quick match of the keypoints of the largest scales
//! (Wu 2013, "Towards linear-time incremental structure from motion", section 3), among the
//! nearest by their stated positions where there are many photographs.

use nalgebra::Point3;

use super::matches_of;
use crate::base::execution::{Sharded, map, sharded_map};
use crate::orienting::structure_from_motion::features::{Descriptor, Features};

/// Keypoints of a photograph in the quick match.
const QUICK_KEYPOINTS: usize = 400;

/// Fewest quick matches for a pair.
const FEWEST_QUICK_MATCHES: usize = 4;

/// Photographs nearest by position that a photograph is compared with at all.
const NEAREST_PHOTOGRAPHS: usize = 40;

/// Photographs nearest by position that a photograph is matched with in any case.
const IN_ANY_CASE: usize = 4;

/// Most partners that a photograph asks for: the ones with the most quick matches.
const PARTNERS: usize = 12;

/// A pair of photographs that is matched in full.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in super::super) struct Candidate {
    /// The photograph with the smaller index.
    pub first: usize,
    /// The other one.
    pub second: usize,
}

/// The pairs to match, in the order of their indices. Positions are metric, where stated.
pub(in super::super) fn candidate_pairs(
    features: &[&Features],
    positions: &[Option<Point3<f64>>],
    part: std::ops::Range<f64>,
) -> Sharded<Vec<Candidate>> {
    let n = features.len();
    let near = near_ones(positions);
    let is_near = |i: usize, j: usize, among: usize| match (&near[i], &near[j]) {
        (Some(a), Some(b)) => {
            let within = |list: &[usize], k: usize| list.iter().take(among).any(|&p| p == k);
            within(a, j) || within(b, i)
        }
        // Without a position anything may be near.
        _ => among == NEAREST_PHOTOGRAPHS,
    };
    let quick: Vec<Vec<Descriptor>> = map(features, |_, f| of_largest_scales(f));
    let asked: Vec<Candidate> = (0..n)
        .flat_map(|i| {
            (i + 1..n).map(move |j| Candidate {
                first: i,
                second: j,
            })
        })
        .filter(|c| is_near(c.first, c.second, NEAREST_PHOTOGRAPHS))
        .collect();
    let counts: Vec<usize> = sharded_map("overlaps", &asked, part, |_, c| {
        matches_of(&quick[c.first], &quick[c.second]).len()
    })?;
    let mut partners: Vec<Vec<(usize, usize)>> = vec![Vec::new(); n];
    for (c, &count) in asked.iter().zip(&counts) {
        if count >= FEWEST_QUICK_MATCHES {
            partners[c.first].push((count, c.second));
            partners[c.second].push((count, c.first));
        }
    }
    for list in &mut partners {
        list.sort_unstable_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        list.truncate(PARTNERS);
    }
    let wants = |i: usize, j: usize| partners[i].iter().any(|p| p.1 == j);
    let wanted = asked.into_iter().filter(|c| {
        wants(c.first, c.second)
            || wants(c.second, c.first)
            || is_near(c.first, c.second, IN_ANY_CASE)
    });
    Ok(wanted.collect())
}

/// For each photograph with a position the others with one, the nearest first.
fn near_ones(positions: &[Option<Point3<f64>>]) -> Vec<Option<Vec<usize>>> {
    let of_one = |i: usize, at: &Point3<f64>| {
        let mut others: Vec<(f64, usize)> = (positions.iter().enumerate())
            .filter(|&(j, _)| j != i)
            .filter_map(|(j, p)| p.map(|p| ((p - at).norm(), j)))
            .collect();
        others.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        others.truncate(NEAREST_PHOTOGRAPHS);
        others.into_iter().map(|(_, j)| j).collect()
    };
    (positions.iter().enumerate())
        .map(|(i, p)| p.as_ref().map(|p| of_one(i, p)))
        .collect()
}

/// Large scales are few, and a photograph of the same place shows the same ones.
fn of_largest_scales(features: &Features) -> Vec<Descriptor> {
    let mut order: Vec<usize> = (0..features.keypoints.len()).collect();
    order.sort_by(|&a, &b| {
        let scale = |i: usize| features.keypoints[i].scale;
        scale(b).total_cmp(&scale(a)).then(a.cmp(&b))
    });
    order.truncate(QUICK_KEYPOINTS);
    order.iter().map(|&i| features.descriptors[i]).collect()
}
