//! Clusters grown from proposals: all image lines vote, and the gain in description length is
//! computed.

use nalgebra::{Matrix2, Point2, Vector2};

use super::cluster_plane::{ClusterAxes, PlaneRay, overlap};
use crate::base::geometry::covered;
use crate::base::ids::ViewId;
use crate::base::least_squares::Loss;
use crate::base::params::ClusterParams;
use crate::orienting::scene::Scene;
use crate::planes::objectspace::image_lines::ImageLine;

/// Standard deviation of an image line, px. Assumption: the precision of region boundaries.
pub(crate) const SIGMA_PX: f64 = 0.4;
/// A view that covers less of a line does not count. Assumption.
pub(crate) const LEAST_COVERAGE: f64 = 0.25;
/// What an image line costs on its own, bits. Assumption: one of 64 positions.
const POSITION_BITS: f64 = 6.0;
/// What it costs that a view misses a line, bits. Assumption.
const MISS_BITS: f64 = 1.0;

/// A place in the cluster plane and the stretch that two image lines propose.
pub(crate) struct ClusterProposal {
    pub at: Vector2<f64>,
    pub stretch: [f64; 2],
    pub forward: bool,
}

/// A cluster before selection.
pub(crate) struct ClusterCandidate {
    pub at: Vector2<f64>,
    pub forward: bool,
    pub stretch: [f64; 2],
    /// Image lines with their stretches and mean square residuals, px^2.
    pub members: Vec<(usize, [f64; 2], f64)>,
    pub gain: f64,
    pub coverage: Vec<(ViewId, f64)>,
}

pub(crate) struct ClusterSearch<'a> {
    pub scene: &'a Scene,
    pub image_lines: &'a [ImageLine<'a>],
    pub axes: ClusterAxes,
    pub rays: Vec<PlaneRay>,
    pub z_range: [f64; 2],
    pub params: &'a ClusterParams,
}

impl ClusterSearch<'_> {
    /// The stretch along the main direction that an image line covers at a height.
    pub(crate) fn stretch(&self, image_line: usize, z: f64) -> [f64; 2] {
        let [a, b] = self.image_lines[image_line]
            .ends_at(z)
            .map(|p| self.axes.u.dot(&p.coords));
        [a.min(b), a.max(b)]
    }

    /// Lets all image lines vote for a proposal; `None` where too few views agree.
    pub(crate) fn grow(&self, p: &ClusterProposal) -> Option<ClusterCandidate> {
        let all: Vec<usize> = (0..self.rays.len())
            .filter(|&k| self.rays[k].forward == p.forward)
            .collect();
        let mut at = p.at;
        let mut stretch = p.stretch;
        // Assumption: a place that lines agree on moves little after the second.
        const VOTING_ROUNDS: usize = 3;
        for _ in 0..VOTING_ROUNDS {
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
    ) -> Option<ClusterCandidate> {
        let stretch = self.supported(&members, stretch)?;
        let members: Vec<_> = members
            .into_iter()
            .filter(|m| overlap(m.1, stretch) > 0.0)
            .collect();
        let (gain, coverage) = self.gain(&at, stretch, &members);
        (coverage.len() >= self.params.min_views.min(self.scene.views.len())).then_some(
            ClusterCandidate {
                at,
                forward,
                stretch,
                members,
                gain,
                coverage,
            },
        )
    }

    /// The image lines through a place: (index among the rays, stretch, mean square residual).
    fn members(&self, among: &[usize], at: &Vector2<f64>) -> Vec<(usize, [f64; 2], f64)> {
        let near = |&k: &usize| {
            let ray = &self.rays[k];
            let away = (ray.normal.dot(at) - ray.offset).abs() * ray.scale;
            (away <= 2.0 * self.params.gate_px).then_some(())?;
            let stretch = self.stretch(ray.image_line, at.y);
            let residual = stretch.map(|u| {
                self.image_lines[ray.image_line].distance_px(&self.axes.point(u, at.x, at.y))
            });
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
            let view = self.image_lines[self.rays[*k].image_line].view;
            events.push((s[0], true, view));
            events.push((s[1], false, view));
        }
        events.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)).then(a.2.cmp(&b.2)));
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
            let weight = (s[1] - s[0]) * Loss::Cauchy(SIGMA_PX).weight(*r2);
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
        let evidence = 0.5 * crate::base::math::log2(1.0 + length);
        let variance = SIGMA_PX * SIGMA_PX;
        let mut gain = -self.params.line_bits;
        let mut coverage = Vec::new();
        for view in self.scene.view_ids() {
            let own: Vec<_> = members
                .iter()
                .filter(|m| self.image_lines[self.rays[m.0].image_line].view == view)
                .collect();
            let covered = covered(own.iter().map(|m| m.1), stretch) / length;
            if covered > LEAST_COVERAGE {
                let residual = own.iter().map(|m| m.2 * overlap(m.1, stretch)).sum::<f64>()
                    / own
                        .iter()
                        .map(|m| overlap(m.1, stretch))
                        .sum::<f64>()
                        .max(1e-9);
                let bits = POSITION_BITS - residual / (2.0 * variance * std::f64::consts::LN_2);
                gain += covered * bits * evidence;
                coverage.push((view, covered));
            } else if self.sees(view, at, stretch) {
                gain -= MISS_BITS;
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
