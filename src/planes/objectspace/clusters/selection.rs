//! Contradictions removed: each image line supports one 3D line.

use super::cluster_line::{ClusterLine, ClusterTrace};
use super::cluster_plane::overlap;
use super::search::{ClusterCandidate, ClusterSearch};
use crate::base::geometry::Segment3;

/// Most rejected clusters kept for the plot.
const MAX_REJECTED_SHOWN: usize = 200;

impl ClusterSearch<'_> {
    /// Takes the best candidate, removes its image lines from the others, and so on.
    pub(crate) fn select(
        &self,
        candidates: &mut Vec<ClusterCandidate>,
        trace: &mut ClusterTrace,
    ) -> Vec<ClusterLine> {
        let mut taken: Vec<Vec<[f64; 2]>> = vec![Vec::new(); self.rays.len()];
        let mut selected = Vec::new();
        candidates.retain(|c| c.gain > 0.0);
        let order = |a: &ClusterCandidate, b: &ClusterCandidate| {
            b.gain
                .total_cmp(&a.gain)
                .then(a.at.x.total_cmp(&b.at.x))
                .then(a.at.y.total_cmp(&b.at.y))
        };
        candidates.sort_by(order);
        // Candidates from many proposals are the same cluster again.
        let mut queue: std::collections::VecDeque<ClusterCandidate> =
            std::mem::take(candidates).into();
        while let Some(best) = queue.pop_front() {
            let free: Vec<_> = best
                .members
                .iter()
                .filter(|m| {
                    taken[m.0]
                        .iter()
                        .all(|t| overlap(*t, m.1) < 0.3 * (m.1[1] - m.1[0]))
                })
                .copied()
                .collect();
            let place = [best.at.x, best.at.y];
            if free.len() < best.members.len() {
                let again = self
                    .fitted(&free)
                    .and_then(|at| self.candidate(at, best.forward, best.stretch, free));
                match again.filter(|c| c.gain > 0.0) {
                    Some(c) => {
                        let k = queue.partition_point(|other| order(other, &c).is_lt());
                        queue.insert(k, c);
                    }
                    None if trace.refused.len() < MAX_REJECTED_SHOWN => {
                        trace.refused.push((place, best.gain))
                    }
                    None => {}
                }
                continue;
            }
            for m in &best.members {
                taken[m.0].push([m.1[0].max(best.stretch[0]), m.1[1].min(best.stretch[1])]);
            }
            trace.selected.push((place, best.gain));
            selected.push(self.line(&best));
        }
        selected
    }

    fn line(&self, c: &ClusterCandidate) -> ClusterLine {
        let n = c.members.len().max(1) as f64;
        let mean: f64 = c.members.iter().map(|m| m.2).sum::<f64>() / n;
        let scale = self.rays[c.members[0].0].scale;
        ClusterLine {
            segment: Segment3::new(
                self.axes.point(c.stretch[0], c.at.x, c.at.y),
                self.axes.point(c.stretch[1], c.at.x, c.at.y),
            ),
            supports: c
                .members
                .iter()
                .map(|m| self.rays[m.0].image_line)
                .collect(),
            gain_bits: c.gain,
            coverage: c.coverage.clone(),
            // Rays across each other by some 20 degrees.
            sigma_m: 3.0 * (mean / n).sqrt().max(0.05) / scale,
        }
    }
}
