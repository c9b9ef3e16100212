//! 3D lines of a main direction, by clustering in the plane across it (W96 3.5, figures 6 to 8).
//!
//! Seen along a main direction, a line of that direction is a point of the cluster plane (across,
//! height), and the interpretation plane of an image line is a line in it. Where the lines of
//! several images meet, there may be a 3D line. All images take part at once: two image lines only
//! propose a place, every other one then votes.
//!
//! The description length selects (Axelsson's principle). Without a 3D line each image line is
//! coded by a position of its own; a 3D line in the place of many costs its two coordinates once:
//!
//! ```text
//! gain = sum over views  c (B - r^2 / (2 s^2 ln 2)) e  -  miss (views that should see it and do not)  -  K
//!
//! c    share of the line's extent that the view's image lines cover
//! B    position_bits, what an image line costs on its own
//! r    distance of the image lines from the projected line, s = sigma_px
//! e    log2(1 + extent in metres) / 2: a long coincidence is less likely by chance than a short one
//! K    line_bits
//! ```
//!
//! The best cluster takes its image lines away from all others (contradictions), and so on while
//! there is a gain. A view in which the line is hidden costs `miss_bits`; W96 demands all views.
//! Endless lines are truncated where fewer than the least number of views support them; gaps up to
//! `max_gap_m` are bridged (a chimney), longer ones part a line.

mod cluster_plane;
mod proposals;
mod selection;

pub(crate) use cluster_plane::{Axes, overlap};

use nalgebra::{Matrix2, Point2, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use self::cluster_plane::PlaneRay;
use self::proposals::Proposal;
use super::sight::Sight;
use crate::geometry::{Segment3, covered};
use crate::ids::ViewId;
use crate::params::ClusterParams;
use crate::scene::Scene;
use crate::sorting::sort_by;

/// A 3D line of a main direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClusterLine {
    /// Its end points, metres; it runs along the main direction.
    pub segment: Segment3,
    /// The image lines that support it, as indices into the sights.
    pub supports: Vec<usize>,
    /// By how many bits it shortens the description.
    pub gain_bits: f64,
    /// Share of the extent that each supporting view covers.
    pub coverage: Vec<(ViewId, f64)>,
    /// Standard deviation across the line, metres.
    pub sigma_m: f64,
}

/// The plot of a cluster plane (figures 7 and 8).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ClusterTrace {
    /// Azimuth of the direction, radians.
    pub azimuth: f64,
    /// The image lines of this direction: view, and two points (across, height) of their line in
    /// the cluster plane, metres.
    pub lines: Vec<(ViewId, [[f64; 2]; 2])>,
    /// Intersections proposed and, after those too near each other, looked at.
    pub proposals: [usize; 2],
    /// The selected clusters: (across, height) and gain in bits.
    pub selected: Vec<([f64; 2], f64)>,
    /// The best of the others: they contradict better ones or gain nothing.
    pub refused: Vec<([f64; 2], f64)>,
}

/// Finds the 3D lines of one direction between two heights.
pub fn cluster_lines(
    scene: &Scene,
    sights: &[Sight],
    direction: &Vector3<f64>,
    z_range: [f64; 2],
    params: &ClusterParams,
) -> (Vec<ClusterLine>, ClusterTrace) {
    let axes = Axes::new(direction);
    let rays: Vec<PlaneRay> = (0..sights.len())
        .filter_map(|k| PlaneRay::new(k, &sights[k], &axes, z_range, params))
        .collect();
    let search = Search {
        scene,
        sights,
        axes,
        rays,
        z_range,
        params,
    };
    let (proposals, proposed) = search.proposals();
    let mut candidates: Vec<Candidate> = crate::execution::map(&proposals, |_, p| search.grow(p))
        .into_iter()
        .flatten()
        .collect();
    let mut trace = ClusterTrace {
        azimuth: crate::math::atan2(direction.y, direction.x),
        lines: search
            .rays
            .iter()
            .map(|r| (sights[r.sight].view, r.drawn(z_range)))
            .collect(),
        proposals: [proposed, proposals.len()],
        ..ClusterTrace::default()
    };
    let selected = search.select(&mut candidates, &mut trace);
    (selected, trace)
}

/// A cluster before selection.
pub(crate) struct Candidate {
    pub at: Vector2<f64>,
    pub forward: bool,
    pub stretch: [f64; 2],
    /// Sights with their stretches and mean square residuals, px^2.
    pub members: Vec<(usize, [f64; 2], f64)>,
    pub gain: f64,
    pub coverage: Vec<(ViewId, f64)>,
}

pub(crate) struct Search<'a> {
    pub scene: &'a Scene,
    pub sights: &'a [Sight<'a>],
    pub axes: Axes,
    pub rays: Vec<PlaneRay>,
    pub z_range: [f64; 2],
    pub params: &'a ClusterParams,
}

impl Search<'_> {
    /// The stretch along the main direction that an image line covers at a height.
    pub(crate) fn stretch(&self, sight: usize, z: f64) -> [f64; 2] {
        let [a, b] = self.sights[sight]
            .ends_at(z)
            .map(|p| self.axes.u.dot(&p.coords));
        [a.min(b), a.max(b)]
    }

    /// Lets all image lines vote for a proposal; `None` where too few views agree.
    fn grow(&self, p: &Proposal) -> Option<Candidate> {
        let all: Vec<usize> = (0..self.rays.len())
            .filter(|&k| self.rays[k].forward == p.forward)
            .collect();
        let mut at = p.at;
        let mut stretch = p.stretch;
        const ROUNDS: usize = 3;
        for _ in 0..ROUNDS {
            let members = self.members(&all, &at);
            stretch = self.supported(&members, stretch)?;
            let near: Vec<_> = members
                .into_iter()
                .filter(|m| overlap(m.1, stretch) > 0.0)
                .collect();
            at = self.fitted(&near)?;
        }
        if at.y < self.z_range[0] || at.y > self.z_range[1] {
            return None;
        }
        let members = self.members(&all, &at);
        self.candidate(at, p.forward, stretch, members)
    }

    pub(crate) fn candidate(
        &self,
        at: Vector2<f64>,
        forward: bool,
        stretch: [f64; 2],
        members: Vec<(usize, [f64; 2], f64)>,
    ) -> Option<Candidate> {
        let stretch = self.supported(&members, stretch)?;
        let members: Vec<_> = members
            .into_iter()
            .filter(|m| overlap(m.1, stretch) > 0.0)
            .collect();
        let (gain, coverage) = self.gain(&at, stretch, &members);
        (coverage.len() >= self.params.min_views.min(self.scene.views.len())).then_some(Candidate {
            at,
            forward,
            stretch,
            members,
            gain,
            coverage,
        })
    }

    /// The image lines through a place: (index among the rays, stretch, mean square residual).
    fn members(&self, among: &[usize], at: &Vector2<f64>) -> Vec<(usize, [f64; 2], f64)> {
        let near = |&k: &usize| {
            let ray = &self.rays[k];
            let away = (ray.normal.dot(at) - ray.offset).abs() * ray.scale;
            (away <= 2.0 * self.params.gate_px).then_some(())?;
            let stretch = self.stretch(ray.sight, at.y);
            let residual = stretch
                .map(|u| self.sights[ray.sight].distance_px(&self.axes.point(u, at.x, at.y)));
            let [Some(r), Some(s)] = residual else {
                return None;
            };
            (r.abs().max(s.abs()) <= self.params.gate_px).then_some((
                k,
                stretch,
                0.5 * (r * r + s * s),
            ))
        };
        among.iter().filter_map(near).collect()
    }

    /// The stretch around `start` that enough views support.
    fn supported(&self, members: &[(usize, [f64; 2], f64)], start: [f64; 2]) -> Option<[f64; 2]> {
        let enough = self.params.min_views.min(self.scene.views.len());
        let runs = self.runs(members, enough);
        let best = runs.iter().max_by(|a, b| {
            overlap(**a, start)
                .total_cmp(&overlap(**b, start))
                .then(b[0].total_cmp(&a[0]))
        })?;
        (overlap(*best, start) > 0.0 && best[1] - best[0] >= self.params.min_length_m)
            .then_some(*best)
    }

    /// Maximal stretches that at least `enough` views cover, gaps bridged.
    fn runs(&self, members: &[(usize, [f64; 2], f64)], enough: usize) -> Vec<[f64; 2]> {
        let mut events: Vec<(f64, bool, ViewId)> = Vec::with_capacity(2 * members.len());
        for (k, s, _) in members {
            let view = self.sights[self.rays[*k].sight].view;
            events.push((s[0], true, view));
            events.push((s[1], false, view));
        }
        sort_by(&mut events, |a, b| {
            a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)).then(a.2.cmp(&b.2))
        });
        let mut open = vec![0u32; self.scene.views.len()];
        let (mut views, mut start) = (0, 0.0);
        let mut runs: Vec<[f64; 2]> = Vec::new();
        for (u, begins, view) in events {
            let n = &mut open[view.index()];
            let before = views;
            if begins {
                *n += 1;
                views += usize::from(*n == 1);
            } else {
                *n -= 1;
                views -= usize::from(*n == 0);
            }
            if before < enough && views >= enough {
                start = u;
            } else if before >= enough && views < enough {
                match runs.last_mut() {
                    Some(last) if start - last[1] <= self.params.max_gap_m => last[1] = u,
                    _ => runs.push([start, u]),
                }
            }
        }
        runs
    }

    /// The place by least squares, long image lines counting more.
    pub(crate) fn fitted(&self, members: &[(usize, [f64; 2], f64)]) -> Option<Vector2<f64>> {
        let (mut a, mut b) = (Matrix2::zeros(), Vector2::zeros());
        for (k, s, r2) in members {
            let ray = &self.rays[*k];
            let weight = (s[1] - s[0]) / (1.0 + r2 / (self.params.sigma_px * self.params.sigma_px));
            a += ray.normal * ray.normal.transpose() * weight;
            b += ray.normal * (ray.offset * weight);
        }
        let trace = a.trace();
        (a.determinant() > 1e-4 * trace * trace).then_some(())?;
        Some(a.try_inverse()? * b)
    }

    fn gain(
        &self,
        at: &Vector2<f64>,
        stretch: [f64; 2],
        members: &[(usize, [f64; 2], f64)],
    ) -> (f64, Vec<(ViewId, f64)>) {
        let length = stretch[1] - stretch[0];
        let evidence = 0.5 * crate::math::log2(1.0 + length);
        let variance = self.params.sigma_px * self.params.sigma_px;
        let mut gain = -self.params.line_bits;
        let mut coverage = Vec::new();
        for view in self.scene.view_ids() {
            let own: Vec<_> = members
                .iter()
                .filter(|m| self.sights[self.rays[m.0].sight].view == view)
                .collect();
            let covered = covered(own.iter().map(|m| m.1), stretch) / length;
            if covered > self.params.min_coverage {
                let residual = own.iter().map(|m| m.2 * overlap(m.1, stretch)).sum::<f64>()
                    / own
                        .iter()
                        .map(|m| overlap(m.1, stretch))
                        .sum::<f64>()
                        .max(1e-9);
                let bits = self.params.position_bits
                    - residual / (2.0 * variance * std::f64::consts::LN_2);
                gain += covered * bits * evidence;
                coverage.push((view, covered));
            } else if self.sees(view, at, stretch) {
                gain -= self.params.miss_bits;
            }
        }
        (gain, coverage)
    }

    fn sees(&self, view: ViewId, at: &Vector2<f64>, stretch: [f64; 2]) -> bool {
        let camera = self.scene.camera(view);
        stretch.iter().all(|&u| {
            let p: Option<Point2<f64>> = camera.project(&self.axes.point(u, at.x, at.y));
            p.is_some_and(|p| camera.contains(&p, 2.0))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{planted_lines, rig};
    use super::super::sight::sights;
    use super::*;
    use crate::geometry::Segment3;
    use crate::params::ClusterParams;
    use nalgebra::Point3;

    fn planted() -> [Segment3; 3] {
        [[1.0, 6.0], [-4.0, 3.0], [5.5, 4.0]]
            .map(|[y, z]| Segment3::new(Point3::new(-5.0, y, z), Point3::new(5.0, y, z)))
    }

    /// Three planted lines among as many unrelated ones, six views.
    fn found() -> Vec<ClusterLine> {
        let scene = rig(6);
        let lines = planted_lines(&scene, &planted(), 0.5, &[]);
        let sights = sights(&scene, &lines);
        let params = ClusterParams::default();
        cluster_lines(&scene, &sights, &Vector3::x(), [0.0, 12.0], &params).0
    }

    #[test]
    fn lines_are_found_among_as_many_outliers() {
        let lines = found();
        for truth in planted() {
            let near = |l: &&ClusterLine| {
                let [p, q] = [l.segment.p0, truth.p0];
                (p.y - q.y).abs() < 0.1 && (p.z - q.z).abs() < 0.1
            };
            let best = lines
                .iter()
                .find(near)
                .expect("a line where one is planted");
            for p in [best.segment.p0, best.segment.p1] {
                assert!((p.x.abs() - 5.0).abs() < 0.3, "{p}");
            }
            assert_eq!(best.coverage.len(), 6);
        }
    }

    #[test]
    fn a_line_hidden_in_two_views_is_found_at_a_cost() {
        let scene = rig(6);
        let truth = Segment3::new(Point3::new(-5.0, 1.0, 6.0), Point3::new(5.0, 1.0, 6.0));
        let best = |hidden: &[usize]| {
            let lines = planted_lines(&scene, &[truth], 0.0, hidden);
            let sights = sights(&scene, &lines);
            cluster_lines(
                &scene,
                &sights,
                &Vector3::x(),
                [0.0, 12.0],
                &ClusterParams::default(),
            )
            .0
        };
        let (all, four, two) = (best(&[]), best(&[1, 4]), best(&[0, 1, 3, 4]));
        assert_eq!((all.len(), four.len(), two.len()), (1, 1, 0));
        assert!(four[0].gain_bits < all[0].gain_bits);
    }

    #[test]
    fn an_image_line_supports_one_3d_line_only() {
        let lines = found();
        let mut used: Vec<usize> = lines.iter().flat_map(|l| l.supports.clone()).collect();
        let count = used.len();
        used.sort_unstable();
        used.dedup();
        assert_eq!(used.len(), count);
    }
}
