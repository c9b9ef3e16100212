//! The best non-overlapping set of planes (W96 3.6: "secondly to select the best nonoverlapping
//! planes").
//!
//! Candidates that overlap in plan exclude each other. The set with the largest sum of measures is
//! found exactly where few candidates stand in each other's way, by branch and bound; larger groups
//! of conflicts start from the greedy set and exchange one candidate for those that it excludes
//! while the sum grows.

use nalgebra::Point3;

use super::candidate::PlaneCandidate;
use crate::base::geometry::Polygon;

/// Candidates that overlap by more than this share of the smaller one exclude each other.
/// Assumption: what errors of their ends do at shared sides.
const MOST_OVERLAP: f64 = 0.08;
/// Most candidates in a group of conflicts that is solved exactly. Assumption: what branch and
/// bound takes no time for.
const EXACTLY_SOLVED: usize = 24;

/// Indices of the chosen candidates, ascending.
pub(crate) fn best_set(candidates: &[PlaneCandidate]) -> Vec<usize> {
    let n = candidates.len();
    let mut conflicts: Vec<Vec<usize>> = vec![Vec::new(); n];
    for i in 0..n {
        for j in i + 1..n {
            if exclude(&candidates[i], &candidates[j]) {
                conflicts[i].push(j);
                conflicts[j].push(i);
            }
        }
    }
    let weights: Vec<f64> = candidates.iter().map(|c| c.measure_nats).collect();
    let mut chosen = Vec::new();
    for conflict_group in conflict_groups(&conflicts) {
        if conflict_group.len() <= EXACTLY_SOLVED {
            chosen.extend(exact(&conflict_group, &conflicts, &weights));
        } else {
            chosen.extend(exchanged(&conflict_group, &conflicts, &weights));
        }
    }
    chosen.sort_unstable();
    chosen
}

/// Do two candidates cover the same ground?
fn exclude(a: &PlaneCandidate, b: &PlaneCandidate) -> bool {
    let [a, b] = [a, b].map(|c| Polygon::from(c.ring.iter().map(Point3::xy).collect::<Vec<_>>()));
    let most = MOST_OVERLAP * a.signed_area().min(b.signed_area());
    a.and(&b).signed_area() > most
}

/// Connected groups of conflicts.
fn conflict_groups(conflicts: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut seen = vec![false; conflicts.len()];
    let mut groups = Vec::new();
    for first in 0..conflicts.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let mut group = vec![first];
        let mut next = 0;
        while next < group.len() {
            for &n in &conflicts[group[next]] {
                if !std::mem::replace(&mut seen[n], true) {
                    group.push(n);
                }
            }
            next += 1;
        }
        groups.push(group);
    }
    groups
}

fn heaviest_first(conflict_group: &[usize], weights: &[f64]) -> Vec<usize> {
    let mut order = conflict_group.to_vec();
    order.sort_by(|&a, &b| weights[b].total_cmp(&weights[a]).then(a.cmp(&b)));
    order
}

/// Branch and bound over a conflict_group, the heaviest first.
fn exact(conflict_group: &[usize], conflicts: &[Vec<usize>], weights: &[f64]) -> Vec<usize> {
    let order = heaviest_first(conflict_group, weights);
    let mut best = (0.0, Vec::new());
    branch(&order, conflicts, weights, 0.0, &mut Vec::new(), &mut best);
    best.1
}

fn branch(
    rest: &[usize],
    conflicts: &[Vec<usize>],
    weights: &[f64],
    sum: f64,
    chosen: &mut Vec<usize>,
    best: &mut (f64, Vec<usize>),
) {
    if sum > best.0 {
        *best = (sum, chosen.clone());
    }
    let bound: f64 = rest.iter().map(|&k| weights[k]).sum();
    let Some((&first, others)) = rest.split_first() else {
        return;
    };
    if sum + bound <= best.0 {
        return;
    }
    let compatible: Vec<usize> = others
        .iter()
        .copied()
        .filter(|k| !conflicts[first].contains(k))
        .collect();
    chosen.push(first);
    branch(
        &compatible,
        conflicts,
        weights,
        sum + weights[first],
        chosen,
        best,
    );
    chosen.pop();
    branch(others, conflicts, weights, sum, chosen, best);
}

/// Greedy, then exchanges: one candidate for those that it excludes, or several for the one that
/// excludes them.
fn exchanged(conflict_group: &[usize], conflicts: &[Vec<usize>], weights: &[f64]) -> Vec<usize> {
    let order = heaviest_first(conflict_group, weights);
    let mut inside = vec![false; conflicts.len()];
    // Each exchange raises the sum, so this ends.
    loop {
        let gain = |k: usize, inside: &[bool]| {
            let lost = conflicts[k].iter().filter(|&&c| inside[c]);
            weights[k] - lost.map(|&c| weights[c]).sum::<f64>()
        };
        if let Some(&k) = order
            .iter()
            .find(|&&k| !inside[k] && gain(k, &inside) > 1e-9)
        {
            conflicts[k].iter().for_each(|&c| inside[c] = false);
            inside[k] = true;
            continue;
        }
        let better = order.iter().filter(|&&k| inside[k]).find_map(|&k| {
            let freed = freed_by(k, &order, conflicts, &inside);
            let sum: f64 = freed.iter().map(|&f| weights[f]).sum();
            (sum > weights[k] + 1e-9).then_some((k, freed))
        });
        let Some((k, freed)) = better else {
            break;
        };
        inside[k] = false;
        freed.into_iter().for_each(|f| inside[f] = true);
    }
    order.into_iter().filter(|&k| inside[k]).collect()
}

/// What could stand in the place of one candidate, greedily.
fn freed_by(gone: usize, order: &[usize], conflicts: &[Vec<usize>], inside: &[bool]) -> Vec<usize> {
    let mut freed: Vec<usize> = Vec::new();
    for &k in order {
        let blocked = |c: &usize| (inside[*c] && *c != gone) || freed.contains(c);
        if conflicts[k].contains(&gone) && !conflicts[k].iter().any(blocked) {
            freed.push(k);
        }
    }
    freed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_facets_beat_the_false_plane_over_both() {
        // 0 lies over 1 and 2; 3 stands alone.
        let conflicts = vec![vec![1, 2], vec![0], vec![0], vec![]];
        let weights = [5.0, 3.0, 4.0, 1.0];
        for solve in [exact, exchanged] {
            let mut chosen: Vec<usize> = conflict_groups(&conflicts)
                .iter()
                .flat_map(|t| solve(t, &conflicts, &weights))
                .collect();
            chosen.sort_unstable();
            assert_eq!(chosen, [1, 2, 3]);
        }
    }

    #[test]
    fn exact_is_never_worse_than_exchanging() {
        let mut state = 7u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as f64 / (1u64 << 24) as f64
        };
        for _ in 0..50 {
            let weights: Vec<f64> = (0..12).map(|_| random()).collect();
            let mut conflicts = vec![Vec::new(); 12];
            for i in 0..12 {
                for j in i + 1..12 {
                    if random() < 0.3 {
                        conflicts[i].push(j);
                        conflicts[j].push(i);
                    }
                }
            }
            let all: Vec<usize> = (0..12).collect();
            let sum = |s: Vec<usize>| {
                for &i in &s {
                    assert!(s.iter().all(|j| !conflicts[i].contains(j)));
                }
                s.iter().map(|&k| weights[k]).sum::<f64>()
            };
            assert!(
                sum(exact(&all, &conflicts, &weights))
                    >= sum(exchanged(&all, &conflicts, &weights)) - 1e-12
            );
        }
    }
}
