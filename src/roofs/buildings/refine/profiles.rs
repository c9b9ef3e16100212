//! Profiles across the sides of a wireframe: rows of grey values along a side, at steps from inside
//! to outside.
//!
//! On the roof the rows of all views agree; an edge of the roof is at the same step in all views,
//! and whatever lies on the ground or on a wall is displaced. The gain of each step as the place of
//! the side is the energy of the labelling, in nats: windows a metre apart are independent, borders
//! cost by the metre.

use nalgebra::Vector2;

use super::wireframe::{Wireframe, WireframeSide, WireframeState};
use crate::base::evidence::ON_LINE;
use crate::base::evidence::WindowEvidenceTable;
use crate::base::geometry::Segment3;
use crate::base::ids::ViewId;
use crate::base::math;
use crate::base::params::{RefineParams, RoofParams};
use crate::orienting::scene::Scene;
use crate::roofs::model::Occluders;

/// Half the base of the difference across a side, in steps of half a pixel: one pixel.
const BASE: usize = 2;
/// Most places along a side at which the profile is sampled.
const MAX_SAMPLES: usize = 96;
/// Share of a side that is left out at either end, because other edges begin at corners.
pub(crate) const END_SHARE: f64 = 0.06;
/// Least share of a side that a view must see.
const MIN_SEEN: f64 = 0.5;

/// Energy gained by moving a side to each step of its profile.
pub(crate) struct ShiftGains {
    /// First step that is allowed, from the side.
    pub first: isize,
    /// For each step from there: the energy gained, nats for the whole side.
    pub gain: Vec<f64>,
    /// For each step from there: how clearly the views share an edge, 1 for the clearest, times the
    /// side's length.
    pub edge: Vec<f64>,
}

/// The profile of one view across a side, at steps from inside to outside; the middle step is the
/// side itself.
pub(crate) struct SideProfile {
    /// The view.
    pub view: ViewId,
    /// Standard deviation of the noise of a grey value.
    noise: f64,
    /// Grey values at every place along the side, step by step; NaN where the view does not see it.
    rows: Vec<Vec<f32>>,
    /// Mean difference across every step.
    pub differences: Vec<f64>,
}

/// Energy of the labelling gained by ending a facet at a step before its side, nats.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CutBackGain {
    /// Gain: the views do not agree on what is cut off, less the cost of the border there.
    pub nats: f64,
    /// What the views say of what remains, as far as the profile reaches.
    pub remaining_nats: f64,
}

/// The profiles of all views across a side.
pub(crate) struct SideProfiles {
    /// The side.
    pub segment: Segment3,
    /// Change in space for a metre of plan across the side, outwards, in the facet's plane.
    pub outward: nalgebra::Vector3<f64>,
    /// Size of a pixel on the side, metres.
    pixel_m: f64,
    /// The views that see enough of it.
    pub views: Vec<SideProfile>,
    /// Places along the side.
    samples: usize,
}

/// How far a profile reaches to either side, metres.
#[derive(Clone, Copy)]
pub(crate) struct Extent {
    /// A view counts for a place only if it sees as far as this.
    pub seen_m: f64,
    /// Grey values are compared as far as this.
    pub compared_m: f64,
    /// Size of a pixel on the side: profiles have steps of half of it.
    pub pixel_m: f64,
}

impl SideProfiles {
    /// SideProfiles on both sides; `None` for a side that is too short.
    pub(crate) fn new(
        scene: &Scene,
        occluders: &Occluders,
        wireframe: &Wireframe,
        state: &WireframeState,
        side: &WireframeSide,
        extent: Extent,
        params: &RefineParams,
    ) -> Option<Self> {
        let pixel_m = extent.pixel_m;
        let segment = wireframe.segment(state, side);
        let along = (segment.p1.xy() - segment.p0.xy()).try_normalize(1e-6)?;
        // The facet lies on the left.
        let across = Vector2::new(along.y, -along.x);
        let at = wireframe.plane_at(side.face);
        let rise = state[at] * across.x + state[at + 1] * across.y;
        let outward = nalgebra::Vector3::new(across.x, across.y, rise);
        let length_px = segment.length() / pixel_m;
        (length_px >= params.min_side_px).then_some(())?;
        let mut profiles = Self {
            segment,
            outward,
            pixel_m,
            views: Vec::new(),
            samples: (length_px.ceil() as usize).min(MAX_SAMPLES),
        };
        let within = |reach_m: f64| (reach_m / (0.5 * pixel_m)).ceil() as usize + BASE + 1;
        let seen = within(extent.seen_m);
        // The strongest difference near a step looks one step farther.
        let compared = (within(extent.compared_m) + 2).min(seen);
        profiles.views = scene
            .view_ids()
            .filter_map(|v| profiles.profile(scene, occluders, v, [seen, compared]))
            .collect();
        Some(profiles)
    }

    /// The step of the profile in plan, metres.
    pub(crate) fn step_m(&self) -> f64 {
        0.5 * self.pixel_m
    }

    /// What one view shows within `compared` steps, where it sees `ends` steps; `None` where it
    /// sees too little of the side.
    fn profile(
        &self,
        scene: &Scene,
        occluders: &Occluders,
        view: ViewId,
        [ends, compared]: [usize; 2],
    ) -> Option<SideProfile> {
        let (camera, gray) = (scene.camera(view), &scene.view(view).gray);
        // Homogeneous image coordinates are linear across the side.
        let to_image = camera.k * camera.r;
        let step = to_image * self.outward * self.step_m();
        let count = 2 * compared + 1;
        let mut rows = vec![vec![f32::NAN; self.samples]; count];
        let mut seen = 0usize;
        let mut hidden = false;
        for i in 0..self.samples {
            let t = (i as f64 + 0.5) / self.samples as f64;
            let p = self.segment.at(END_SHARE + (1.0 - 2.0 * END_SHARE) * t);
            if i % 8 == 0 {
                hidden = occluders.hide(&p, &camera.center);
            }
            let middle = to_image * (p - camera.center);
            let across = |steps: f64| {
                let x = middle + step * steps;
                if x.z > 1e-9 {
                    [(x.x / x.z) as f32, (x.y / x.z) as f32]
                } else {
                    [f32::NAN; 2]
                }
            };
            let is_seen = |[x, y]: [f32; 2]| gray.sample(x, y).is_some();
            // Seen from end to end or not at all.
            if hidden || !is_seen(across(-(ends as f64))) || !is_seen(across(ends as f64)) {
                continue;
            }
            seen += 1;
            for (first, rows) in rows.chunks_mut(8).enumerate() {
                let places: [[f32; 2]; 8] = std::array::from_fn(|lane| {
                    let k = (8 * first + lane).min(count - 1);
                    across(k as f64 - compared as f64)
                });
                let samples = gray.sample_eight(places.map(|p| p[0]), places.map(|p| p[1]));
                for (row, sample) in rows.iter_mut().zip(samples.to_array()) {
                    row[i] = sample;
                }
            }
        }
        if (seen as f64) < MIN_SEEN * self.samples as f64 {
            return None;
        }
        let means: Vec<f64> = rows.iter().map(|row| mean(row)).collect();
        let difference =
            |k: usize| means[(k + BASE).min(count - 1)] - means[k.saturating_sub(BASE)];
        Some(SideProfile {
            view,
            noise: scene.view(view).noise,
            differences: (0..count).map(difference).collect(),
            rows,
        })
    }

    /// Energy gained by moving the side to each step within `reach_m`; `None` where too few views
    /// see the side, or no edge stands out.
    ///
    /// The energy of the labelling in one dimension: what the views agree on inside counts for the
    /// facet, a border on an edge is cheap. The border that delineation chose is a prior with the
    /// standard deviation `known_to_m`.
    pub(crate) fn shift_gains(
        &self,
        reach_m: f64,
        known_to_m: f64,
        params: &RoofParams,
    ) -> Option<ShiftGains> {
        (self.views.len() >= params.refine.min_views).then_some(())?;
        let middle = self.middle();
        let steps = ((reach_m / self.step_m()) as usize + 1).min(middle - 1);
        let (first, last) = (middle - steps, middle + steps);
        let shared: Vec<f64> = (first..=last).map(|k| self.shared(k)).collect();
        let least = params.refine.least_contrast / (self.samples as f64).sqrt();
        let strongest = shared.iter().copied().fold(0.0, f64::max);
        (strongest >= least).then_some(())?;
        let length = self.segment.length();
        let edge = |s: &f64| {
            if *s >= least {
                s / strongest * length
            } else {
                0.0
            }
        };
        let edge: Vec<f64> = shared.iter().map(edge).collect();
        let on_edge = (1.0 - ON_LINE) * params.border_nats_per_m;
        let mut inside = 0.0;
        let gain = (first..=last).map(|k| {
            inside += self.nats_per_m2(k) * self.step_m() * length;
            let moved = (k as f64 - middle as f64) * self.step_m() / known_to_m;
            inside + on_edge * edge[k - first] - 0.5 * moved * moved * length
        });
        Some(ShiftGains {
            first: -(steps as isize),
            gain: gain.collect(),
            edge,
        })
    }

    /// Energy gained by ending the facet at each step back from the side; `None` where too few
    /// views see the side.
    pub(crate) fn cut_back_gains(&self, params: &RoofParams) -> Option<Vec<CutBackGain>> {
        (self.views.len() >= params.refine.min_views).then_some(())?;
        let middle = self.middle();
        let shared: Vec<f64> = (0..=middle).map(|k| self.shared(k)).collect();
        let least = params.refine.least_contrast / (self.samples as f64).sqrt();
        let strongest = shared.iter().copied().fold(least, f64::max);
        let length = self.segment.length();
        let agreement: Vec<f64> = (0..middle)
            .map(|k| self.nats_per_m2(k) * self.step_m())
            .collect();
        let mut inside: f64 = agreement.iter().sum();
        let mut strip = 0.0;
        let mut gains = Vec::with_capacity(middle);
        for k in (0..middle).rev() {
            strip += agreement[k];
            inside -= agreement[k];
            let border = 1.0 - (1.0 - ON_LINE) * shared[k] / strongest;
            gains.push(CutBackGain {
                nats: -length * (params.border_nats_per_m * border + strip),
                remaining_nats: length * inside,
            });
        }
        Some(gains)
    }

    /// What the rows of the views at a step say of the plane, nats for a square metre, by the table
    /// of the windows: a row has no width, so unlike a window it does not reach over the edge.
    fn nats_per_m2(&self, k: usize) -> f64 {
        let (mut sum, mut weights, mut pairs) = (0.0, 0.0, 0.0f64);
        for (i, a) in self.views.iter().enumerate() {
            for b in &self.views[i + 1..] {
                let [saa, sbb, sab] = covariances(&a.rows[k], &b.rows[k]);
                let (texture, variance) = ((saa * sbb).sqrt(), a.noise * b.noise);
                let correlation = if texture > 0.0 { sab / texture } else { 0.0 };
                let weight = texture / (texture + variance);
                sum += weight * correlation;
                weights += weight;
                pairs += 1.0;
            }
        }
        if weights <= 0.0 {
            return 0.0;
        }
        let (weight, correlation) = (weights / pairs, sum / weights);
        let table = WindowEvidenceTable::fitted();
        table.nats_of(weight as f32, correlation as f32) + weight * table.prior
    }

    /// The step at the side itself.
    pub(crate) fn middle(&self) -> usize {
        (self.views[0].rows.len() - 1) / 2
    }

    /// The difference that half of the views reach at a step, of either sign: the roof's side of an
    /// edge is the same in all views, what lies behind it is not.
    fn shared(&self, k: usize) -> f64 {
        let mut strengths: Vec<f64> = self
            .views
            .iter()
            .map(|v| strongest_near(&v.differences, k).abs())
            .collect();
        math::median(&mut strengths).unwrap_or(0.0)
    }
}

/// Mean of the values that are seen.
fn mean(row: &[f32]) -> f64 {
    let seen = row.iter().filter(|v| !v.is_nan());
    let (sum, n) = seen.fold((0.0, 0.0f64), |(s, n), &v| (s + f64::from(v), n + 1.0));
    sum / n.max(1.0)
}

/// Variances and covariance of two rows where both are seen.
fn covariances(a: &[f32], b: &[f32]) -> [f64; 3] {
    let mut n = 0.0f64;
    let mut sums = [0.0f64; 5];
    for (&x, &y) in a.iter().zip(b) {
        if x.is_nan() || y.is_nan() {
            continue;
        }
        let (x, y) = (f64::from(x), f64::from(y));
        n += 1.0;
        for (sum, v) in sums.iter_mut().zip([x, y, x * x, y * y, x * y]) {
            *sum += v;
        }
    }
    let [sx, sy, xx, yy, xy] = sums.map(|s| s / n.max(1.0));
    [xx - sx * sx, yy - sy * sy, xy - sx * sy].map(|v| if n > 2.0 { v } else { 0.0 })
}

/// The largest difference at a step and its neighbours, with its sign.
pub(crate) fn strongest_near(differences: &[f64], k: usize) -> f64 {
    let near = &differences[k.saturating_sub(1)..(k + 2).min(differences.len())];
    near.iter()
        .fold(0.0f64, |s, &d| if d.abs() > s.abs() { d } else { s })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};

    /// Rows of two views with a standard deviation of `texture` that correlate by a quarter, at a
    /// noise of 0.01.
    fn two_views(texture: f64) -> SideProfiles {
        // Orthogonal patterns of unit variance.
        let pattern = |i: usize, period: usize| [1.0, -1.0][i / period % 2];
        let row = |own: f64| -> Vec<f32> {
            let value = |i| 0.25 * pattern(i, 1) + own * pattern(i, 2);
            (0..64).map(|i| (0.5 + texture * value(i)) as f32).collect()
        };
        // Covariance 0.0625 of variances 0.25.
        let own = (0.25f64 - 0.0625).sqrt();
        let other = |i: usize| 0.25 * pattern(i, 1) + own * pattern(i, 4);
        let views = [
            row(own),
            (0..64).map(|i| (0.5 + texture * other(i)) as f32).collect(),
        ];
        let profile = |(i, row): (usize, Vec<f32>)| SideProfile {
            view: ViewId(i as u32),
            noise: 0.01,
            rows: vec![row],
            differences: vec![0.0],
        };
        SideProfiles {
            segment: Segment3::new(Point3::origin(), Point3::new(6.4, 0.0, 0.0)),
            outward: Vector3::y(),
            pixel_m: 0.1,
            views: views.into_iter().enumerate().map(profile).collect(),
            samples: 64,
        }
    }

    #[test]
    fn moderate_correlation_speaks_against_a_plane_where_there_is_texture_alone() {
        let (weak, strong) = (two_views(0.004), two_views(0.4));
        assert!(weak.nats_per_m2(0) > 0.0, "more than chance");
        assert!(strong.nats_per_m2(0) < 0.0, "no roof");
    }
}
