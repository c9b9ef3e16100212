//! Buildings that touch themselves in a corner of the plan, parted from themselves there.
//!
//! Where a building goes around a stretch of outside and comes back to its own corner, four walls
//! would stand on one vertical line: no solid of ISO 19107, whose edges have two faces each. The
//! narrower stretch of outside is drawn back from such a corner, so that its neighbours meet along
//! a short edge instead of in a point.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::Vector2;

use super::partition::{PlanPartition, Welder};
use crate::base::math::{atan2, sin_cos};

/// The outside is drawn back by so much, metres: corners closer than a millimetre count as one in
/// the checks of other programs, and nobody sees half a centimetre.
const DRAWN_BACK_M: f64 = 5e-3;
/// Edges shorter than so many times that stay as they are.
const SHORTEST_EDGE_RATIO: f64 = 4.0;

/// A stretch of outside at a vertex, counter-clockwise between two borders.
struct Outside {
    /// Where the border that arrives comes from, and the facet on its left.
    from: (u32, usize),
    /// Where the border that departs goes to, and the facet on its left.
    to: (u32, usize),
    azimuth: f64,
    angle: f64,
}

impl PlanPartition {
    /// Parts buildings that touch themselves.
    pub(super) fn part_touching(&mut self, welder: &mut Welder) {
        let groups = self.groups();
        let (mut behind, mut before) = (BTreeMap::new(), BTreeMap::new());
        for (vertex, all) in self.outside() {
            for joined in touching(all, &groups) {
                let (s, c) = sin_cos(joined.azimuth + 0.5 * joined.angle);
                let at = self.positions[vertex as usize];
                let ends = [joined.from.0, joined.to.0].map(|v| self.positions[v as usize]);
                if ends
                    .iter()
                    .any(|p| (p - at).norm() < SHORTEST_EDGE_RATIO * DRAWN_BACK_M)
                {
                    continue;
                }
                let back = welder.weld(at + Vector2::new(c, s) * DRAWN_BACK_M);
                before.insert((joined.from.0, vertex), back);
                behind.insert((vertex, joined.to.0), back);
            }
        }
        if before.is_empty() {
            return;
        }
        let kept = self.clone();
        self.positions = welder.positions.clone();
        self.facets = self.led_by(|edge| {
            let stops = [behind.get(&edge), before.get(&edge)];
            stops.into_iter().flatten().copied().collect()
        });
        if !self.conflicting().is_empty() {
            self.facets = kept.facets;
        }
    }

    /// For every facet the number of its building: facets that share an edge have the same.
    fn groups(&self) -> Vec<usize> {
        let left_of = self.facet_left_of();
        let mut beside = vec![Vec::new(); self.facets.len()];
        for (&(a, b), &f) in &left_of {
            beside[f].extend(left_of.get(&(b, a)).copied());
        }
        let mut groups = vec![usize::MAX; self.facets.len()];
        for first in 0..self.facets.len() {
            let mut open = vec![first];
            while let Some(f) = open.pop() {
                if groups[f] == usize::MAX {
                    groups[f] = first;
                    open.extend(&beside[f]);
                }
            }
        }
        groups
    }

    /// The stretches of outside around every vertex that has more than one.
    fn outside(&self) -> Vec<(u32, Vec<Outside>)> {
        type Borders = Vec<(u32, usize)>;
        let left_of = self.facet_left_of();
        let mut borders: BTreeMap<u32, [Borders; 2]> = BTreeMap::new();
        for (&(a, b), &f) in &left_of {
            if !left_of.contains_key(&(b, a)) {
                borders.entry(b).or_default()[0].push((a, f));
                borders.entry(a).or_default()[1].push((b, f));
            }
        }
        let azimuth = |at: u32, to: u32| {
            let d = self.positions[to as usize] - self.positions[at as usize];
            atan2(d.y, d.x)
        };
        let around = |(vertex, [arriving, departing]): (u32, [Borders; 2])| {
            let stretch = |&from: &(u32, usize)| {
                let start = azimuth(vertex, from.0);
                let angle = |to: u32| (azimuth(vertex, to) - start).rem_euclid(TAU);
                let angles = departing.iter().map(|&to| (angle(to.0), to));
                let (angle, to) = angles.min_by(|a, b| a.0.total_cmp(&b.0))?;
                Some(Outside {
                    from,
                    to,
                    azimuth: start,
                    angle,
                })
            };
            (vertex, arriving.iter().filter_map(stretch).collect())
        };
        let several = borders.into_iter().filter(|(_, [all, _])| all.len() > 1);
        several.map(around).collect()
    }
}

/// The stretches to draw back from a vertex: the narrower ones between facets of one building, as
/// many as make it one fan around the vertex.
fn touching(mut all: Vec<Outside>, groups: &[usize]) -> Vec<Outside> {
    let mut fans: BTreeMap<usize, usize> = BTreeMap::new();
    for stretch in &all {
        *fans.entry(groups[stretch.from.1]).or_default() += 1;
    }
    all.sort_by(|a, b| a.angle.total_cmp(&b.angle));
    all.retain(|stretch| {
        let [group, other] = [stretch.from.1, stretch.to.1].map(|f| groups[f]);
        let left = fans
            .get_mut(&group)
            .filter(|left| group == other && **left > 1);
        left.map(|left| *left -= 1).is_some()
    });
    all
}
