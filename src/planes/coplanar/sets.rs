//! Sets of coplanar 3D lines (B99 2: Leuven; 5: "grouping of at least two neighbouring coplanar
//! lines").
//!
//! Two lines that are neighbours in plan start a set where the odds are that they span one plane.
//! It grows by the neighbour that most likely lies in it, as long as one more likely does than not
//! and the views agree on the plane over what the hull gains. A line may belong to several sets: a
//! ridge lies in two planes.

use nalgebra::Point2;

use super::image_evidence::ImageEvidence;
use super::uncertain_plane::{UncertainPlane, ends_of};
use crate::base::geometry::{Plane, convex_hull};
use crate::base::ids::LineId;
use crate::lines::lines3d::Line3d;
use crate::planes::grouping::line_neighbours;
use crate::planes::half_planes::is_wall;

/// Lines in one plane.
#[derive(Clone, Debug)]
pub(super) struct LineSet {
    /// The lines, in the order in which they joined.
    pub lines: Vec<LineId>,
    /// Their plane.
    pub plane: UncertainPlane,
    /// Logarithm of the odds that they lie in one plane, by their ends alone.
    pub nats: f64,
}

/// The lines with what is known of all of them.
pub(super) struct LineSpace<'a> {
    /// All lines.
    pub lines: &'a [Line3d],
    /// Size of a ground pixel, metres.
    pub pixel_m: f64,
    /// Range of their heights, metres: what the height of a line could be.
    pub range_m: f64,
}

impl<'a> LineSpace<'a> {
    /// Of all lines of a scene.
    pub(super) fn new(lines: &'a [Line3d], pixel_m: f64) -> Self {
        let heights = || lines.iter().flat_map(|l| [l.segment.p0.z, l.segment.p1.z]);
        let low = heights().fold(f64::INFINITY, f64::min);
        let high = heights().fold(f64::NEG_INFINITY, f64::max);
        Self {
            lines,
            pixel_m,
            range_m: (high - low).max(pixel_m),
        }
    }

    /// A line by its id.
    pub(super) fn line(&self, id: LineId) -> &'a Line3d {
        &self.lines[id.index()]
    }

    /// The plane of some lines.
    fn fit(&self, lines: &[LineId]) -> Option<UncertainPlane> {
        let ends: Vec<_> = (lines.iter())
            .flat_map(|&l| ends_of(self.line(l)))
            .collect();
        let plane = UncertainPlane::fit(&ends, self.pixel_m)?;
        (!is_wall(&plane.plane())).then_some(plane)
    }

    /// The hull of the ends of some lines in plan, counter-clockwise.
    pub(super) fn hull(&self, lines: &[LineId]) -> Vec<Point2<f64>> {
        let segments = lines.iter().map(|&l| &self.line(l).segment);
        let ends = segments.flat_map(|s| [s.p0.xy(), s.p1.xy()]);
        convex_hull(&ends.collect::<Vec<_>>())
    }

    /// Two lines as a set: the plane of three ends says where the fourth should be.
    fn pair(&self, first: LineId, second: LineId) -> Option<LineSet> {
        let [a, b] = ends_of(self.line(first));
        let [near, far] = ends_of(self.line(second));
        let nats = |known, tested| {
            let plane = UncertainPlane::fit(&[a, b, known], self.pixel_m)?;
            Some(plane.nats_of_end(tested, self.pixel_m, self.range_m))
        };
        let either = [nats(near, &far), nats(far, &near)];
        let nats = either.into_iter().flatten().fold(f64::INFINITY, f64::min);
        let lines = vec![first, second];
        let plane = self.fit(&lines)?;
        (nats.is_finite() && nats > 0.0).then_some(LineSet { lines, plane, nats })
    }
}

/// All sets of two lines or more that the views do not contradict, the most likely pairs first.
pub(super) fn coplanar_line_sets(space: &LineSpace, images: &ImageEvidence) -> Vec<LineSet> {
    let neighbours = line_neighbours(space.lines);
    let around = |line: LineId| {
        let i = line.index();
        neighbours.direct[i]
            .iter()
            .chain(&neighbours.around_corners[i])
    };
    let ids: Vec<LineId> = (0..space.lines.len()).map(LineId::from_index).collect();
    let pairs = crate::base::execution::map(&ids, |_, &first| {
        let later = around(first).filter(|second| **second > first);
        let pairs = later.filter_map(|&second| space.pair(first, second));
        pairs.collect::<Vec<_>>()
    });
    let mut seeds = pairs.concat();
    seeds.sort_by(|a, b| b.nats.total_cmp(&a.nats).then(a.lines.cmp(&b.lines)));
    let mut sets: Vec<LineSet> = Vec::new();
    for seed in seeds {
        let known = |set: &LineSet| seed.lines.iter().all(|l| set.lines.contains(l));
        let is_seen = || images.inside(&seed.plane.plane(), &space.hull(&seed.lines), &[]) > 0.0;
        if !sets.iter().any(known) && is_seen() {
            sets.push(grown(space, images, seed, around));
        }
    }
    without_parts(sets)
}

/// A set with all neighbours that lie in its plane.
fn grown<'n, I: Iterator<Item = &'n LineId>>(
    space: &LineSpace,
    images: &ImageEvidence,
    mut set: LineSet,
    around: impl Fn(LineId) -> I,
) -> LineSet {
    let mut refused: Vec<LineId> = Vec::new();
    loop {
        let mut candidates: Vec<LineId> = (set.lines.iter())
            .flat_map(|&l| around(l))
            .filter(|l| !set.lines.contains(l) && !refused.contains(l))
            .copied()
            .collect();
        candidates.sort();
        candidates.dedup();
        let nats = |&l: &LineId| {
            set.plane
                .nats_of_line(space.line(l), space.pixel_m, space.range_m)
        };
        let likely = candidates.iter().map(|l| (*l, nats(l)));
        let best = (likely.filter(|(_, nats)| *nats > 0.0))
            .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        let Some((line, nats)) = best else {
            return set;
        };
        let lines = [&set.lines[..], &[line]].concat();
        let (before, after) = (space.hull(&set.lines), space.hull(&lines));
        let is_seen = |plane: &Plane| images.inside(plane, &after, &before) >= 0.0;
        match space.fit(&lines).filter(|fitted| is_seen(&fitted.plane())) {
            Some(plane) => {
                set = LineSet {
                    lines,
                    plane,
                    nats: set.nats + nats,
                };
            }
            None => refused.push(line),
        }
    }
}

/// The sets whose lines are not all in another one.
fn without_parts(mut sets: Vec<LineSet>) -> Vec<LineSet> {
    sets.sort_by_key(|set| std::cmp::Reverse(set.lines.len()));
    let mut kept: Vec<LineSet> = Vec::new();
    for set in sets {
        let is_part = |k: &LineSet| set.lines.iter().all(|l| k.lines.contains(l));
        if !kept.iter().any(is_part) {
            kept.push(set);
        }
    }
    kept
}
