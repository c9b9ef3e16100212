//! Where clusters may be: intersections of image lines of different views.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::cluster_plane::PlaneRay;
use super::search::{ClusterProposal, ClusterSearch};

/// Intersections nearer than this are one, metres. Assumption.
const CELL_M: f64 = 0.15;
/// Largest difference of the grey values on one side at least, grey range 1. Assumption; W96 4
/// proposes to use radiometry here.
const LARGEST_GREY_DIFFERENCE: f64 = 0.08;

impl ClusterSearch<'_> {
    /// Intersections of image lines of different views that may show the same stretch, one for each
    /// small cell; and how many there were.
    pub(crate) fn proposals(&self) -> (Vec<ClusterProposal>, usize) {
        let mut cells: BTreeMap<[i64; 4], (f64, ClusterProposal)> = BTreeMap::new();
        let mut count = 0;
        for (i, a) in self.rays.iter().enumerate() {
            for b in &self.rays[i + 1..] {
                let Some((weight, proposal)) = self.propose(a, b) else {
                    continue;
                };
                count += 1;
                let middle = 0.5 * (proposal.stretch[0] + proposal.stretch[1]);
                let cell = |x: f64, size: f64| (x / size).floor() as i64;
                let key = [
                    cell(proposal.at.x, CELL_M),
                    cell(proposal.at.y, CELL_M),
                    cell(middle, 4.0),
                    i64::from(proposal.forward),
                ];
                match cells.entry(key) {
                    Entry::Vacant(e) => {
                        e.insert((weight, proposal));
                    }
                    Entry::Occupied(mut e) => {
                        if weight > e.get().0 {
                            e.insert((weight, proposal));
                        }
                    }
                }
            }
        }
        (cells.into_values().map(|(_, p)| p).collect(), count)
    }

    fn propose(&self, a: &PlaneRay, b: &PlaneRay) -> Option<(f64, ClusterProposal)> {
        let (s, t) = (
            &self.image_lines[a.image_line],
            &self.image_lines[b.image_line],
        );
        if s.view == t.view || a.forward != b.forward {
            return None;
        }
        let at = a.meet(b)?;
        (at.y >= self.z_range[0] && at.y <= self.z_range[1]).then_some(())?;
        // The same surface on one side at least.
        let alike = (0..2).any(|k| (s.sides[k] - t.sides[k]).abs() <= LARGEST_GREY_DIFFERENCE);
        alike.then_some(())?;
        let (p, q) = (
            self.stretch(a.image_line, at.y),
            self.stretch(b.image_line, at.y),
        );
        let stretch = [p[0].max(q[0]), p[1].min(q[1])];
        let shared = stretch[1] - stretch[0];
        let shorter = (p[1] - p[0]).min(q[1] - q[0]);
        let forward = a.forward;
        let proposal = ClusterProposal {
            at,
            stretch,
            forward,
        };
        (shared > 0.4 * shorter).then_some((shared, proposal))
    }
}
