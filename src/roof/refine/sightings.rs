//! The image edges that belong to the sides of a wireframe.
//!
//! The image of a side is where the model expects an edge. A side may lie off by more than a guided
//! measurement reaches (a closing line where nothing was found, the correlation window that straddles a strong edge),
//! so it is first moved in its facet's plane, and the rows of grey values along it are compared over the views: on the roof
//! they agree, and an edge of the roof stands still, whatever lies on the ground or on a wall moves. From there `measure_edge` (the second look of line matching)
//! measures in every view.

use nalgebra::{Matrix2, Point2, Vector2};

use super::wireframe::{Side, SideKind, State, Wireframe};
use crate::geometry::{Segment2, Segment3, covered};
use crate::halfplane::least_overall;
use crate::ids::ViewId;
use crate::linematch::measure_edge;
use crate::lines3d::Line3d;
use crate::math;
use crate::params::RefineParams;
use crate::raster::Channel;
use crate::roof::Occluders;
use crate::scene::Scene;

/// Half the base of the difference across a side, in steps of half a pixel: one pixel.
const BASE: usize = 2;
/// Most places along a side at which the profile is sampled.
const MAX_SAMPLES: usize = 96;
/// Share of a side at either end that is not looked at: corners are where other edges begin.
const END_SHARE: f64 = 0.06;
/// Least share of a side that a view must see.
const MIN_SEEN: f64 = 0.5;

/// An edge measured in a view for a side.
#[derive(Clone, Debug)]
pub struct Sighting {
    /// Index of the side.
    pub side: usize,
    /// The view.
    pub view: ViewId,
    /// The measured edge, px.
    pub segment: Segment2,
    /// Whitens (offset at the middle in px, angle in rad).
    pub whitening: Matrix2<f64>,
}

/// Measures all sides in all views. Sides without a neighbour may move to another edge first where `search` allows it for their
/// facet; those on one of the matched `lines` go less far for a stronger one, such as the edge of a shadow.
pub fn sight_sides(
    scene: &Scene,
    occluders: &Occluders,
    wireframe: &Wireframe,
    state: &State,
    search: &[bool],
    lines: &[Line3d],
    params: &RefineParams,
) -> Vec<Sighting> {
    let pixel_m = pixel(scene, wireframe, state);
    let reach_of = |side: &Side| match search[side.face] && side.kind != SideKind::Crease {
        true => params.search_m,
        false => params.reach_px * pixel_m,
    };
    let profiles = crate::parallel::map(&wireframe.sides, |_, side| {
        (side.kind != SideKind::Foot).then_some(())?;
        let extent = Extent {
            seen_m: params.search_m,
            compared_m: reach_of(side),
            pixel_m,
        };
        Profiles::new(scene, occluders, wireframe, state, side, extent, params)
    });
    let gains = crate::parallel::map(&profiles, |i, profiles| {
        let (profiles, side) = (profiles.as_ref()?, &wireframe.sides[i]);
        let known_to_m = match is_on_line(&wireframe.segment(state, side), lines) {
            true => params.matched_m,
            false => params.search_m,
        };
        profiles.gains(reach_of(side), known_to_m, params)
    });
    let runs = aligned_runs(wireframe, state, 0.0, |kind| kind == SideKind::Free);
    let of_side = |i: usize, profiles: &Option<Profiles>| {
        let run = runs.iter().find(|run| run.contains(&i));
        let together: Vec<&Gains> = match run {
            Some(run) => run.iter().filter_map(|&j| gains[j].as_ref()).collect(),
            None => gains[i].iter().collect(),
        };
        gains[i].as_ref()?;
        let step = best_step(&together)?;
        Some(profiles.as_ref()?.measure(scene, i, step, params))
    };
    crate::parallel::map(&profiles, of_side)
        .into_iter()
        .flatten()
        .flatten()
        .collect()
}

/// Do matched lines run along most of a side?
fn is_on_line(side: &Segment3, lines: &[Line3d]) -> bool {
    /// Sine of the angle below which they are parallel (4 degrees).
    const PARALLEL: f64 = 0.07;
    /// Distance within which they are the same, metres in plan and in height. Assumption: delineation joins lines within 0.3 m.
    const SAME: [f64; 2] = [0.15, 0.35];
    let beside = lines
        .iter()
        .filter_map(|l| side.alongside(&l.segment, PARALLEL));
    let same = beside.filter(|a| a.apart < SAME[0] && a.rise.abs() < SAME[1]);
    let length = (side.p1.xy() - side.p0.xy()).norm();
    covered(same.map(|a| a.stretch), [0.0, length]) >= 0.5 * length
}

/// Size of a pixel on the building, metres.
pub(super) fn pixel(scene: &Scene, wireframe: &Wireframe, state: &State) -> f64 {
    let middle = wireframe.corner(state, 0, 0);
    let pixels = scene.views.iter().map(|v| v.camera.ground_pixel(&middle));
    pixels.fold(f64::INFINITY, f64::min)
}

/// Sides of some kinds, of different facets, that go on into each other, such as both halves of a gable's end: they are one edge.
/// From one to the next it may be `gap_m` metres.
pub(super) fn aligned_runs(
    wireframe: &Wireframe,
    state: &State,
    gap_m: f64,
    of_kind: impl Fn(SideKind) -> bool,
) -> Vec<Vec<usize>> {
    /// Sine of the angle below which sides are aligned (4 degrees).
    const ALIGNED: f64 = 0.07;
    let direction = |side: &Side| {
        let s = wireframe.segment(state, side);
        (s.p1.xy() - s.p0.xy()).normalize()
    };
    let mut runs: Vec<Vec<usize>> = Vec::new();
    let mut taken = vec![false; wireframe.sides.len()];
    for first in 0..wireframe.sides.len() {
        if taken[first] || !of_kind(wireframe.sides[first].kind) {
            continue;
        }
        let mut run = vec![first];
        taken[first] = true;
        let mut next = 0;
        while next < run.len() {
            let side = &wireframe.sides[run[next]];
            for (j, other) in wireframe.sides.iter().enumerate() {
                let touch = [[other.ends[0], side.ends[1]], [other.ends[1], side.ends[0]]]
                    .map(|ends| ends.map(|v| wireframe.position(state, v)))
                    .iter()
                    .any(|[p, q]| (p - q).norm() <= gap_m);
                if taken[j] || !of_kind(other.kind) || !touch {
                    continue;
                }
                let (d, e) = (direction(side), direction(other));
                if d.perp(&e).abs() < ALIGNED && d.dot(&e) > 0.0 {
                    taken[j] = true;
                    run.push(j);
                }
            }
            next += 1;
        }
        runs.push(run);
    }
    runs
}

/// What it is worth that a side lies at each step of its profile.
struct Gains {
    /// First step that is allowed, from the side.
    first: isize,
    /// For each step from there: the energy gained, square metres for the whole side.
    gain: Vec<f64>,
    /// For each step from there: how clearly the views share an edge, 1 for the clearest, times the side's length.
    edge: Vec<f64>,
}

/// The best step from the side at which there is an edge, for one side or for several that are one edge.
fn best_step(sides: &[&Gains]) -> Option<isize> {
    let first = sides.iter().map(|g| g.first).max()?;
    let end = sides
        .iter()
        .map(|g| g.first + g.gain.len() as isize)
        .min()?;
    let sum = |of: fn(&Gains) -> &Vec<f64>, k: isize| -> f64 {
        sides.iter().map(|g| of(g)[(k - g.first) as usize]).sum()
    };
    let edge = |k: isize| sum(|g| &g.edge, k);
    (first + 1..end - 1)
        .filter(|&k| edge(k) > 0.0 && edge(k) >= edge(k - 1) && edge(k) > edge(k + 1))
        .max_by(|&i, &j| {
            let gain = |k| sum(|g| &g.gain, k);
            gain(i).total_cmp(&gain(j)).then(j.cmp(&i))
        })
}

/// What one view shows across a side, at steps from inside to outside; the middle one is at the side.
struct Profile {
    view: ViewId,
    /// Standard deviation of the noise of a grey value.
    noise: f64,
    /// Grey values at every place along the side, step by step; NaN where the view does not see it.
    rows: Vec<Vec<f32>>,
    /// Mean difference across every step.
    differences: Vec<f64>,
}

/// What it is worth to end a facet at a step before its side, in the energy of the labelling, square metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worth {
    /// What is cut off does not agree, and a border there costs what it does.
    pub ending: f64,
    /// What agrees in the rest, as far as the profile reaches.
    pub inside: f64,
}

/// What the views show across a side.
pub(super) struct Profiles {
    /// The side.
    segment: Segment3,
    /// Change in space for a metre of plan across the side, outwards, in the facet's plane.
    outward: nalgebra::Vector3<f64>,
    /// Size of a pixel on the side, metres.
    pixel_m: f64,
    /// The views that see enough of it.
    views: Vec<Profile>,
    /// Places along the side.
    samples: usize,
}

/// How far to both sides of a side it is looked at, metres.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    /// A view must see a place as far as this, or it does not see the place at all.
    pub seen_m: f64,
    /// Grey values are compared as far as this.
    pub compared_m: f64,
    /// Size of a pixel on the side: profiles have steps of half of it.
    pub pixel_m: f64,
}

impl Profiles {
    /// Profiles on both sides; `None` for a side that is too short.
    pub(super) fn new(
        scene: &Scene,
        occluders: &Occluders,
        wireframe: &Wireframe,
        state: &State,
        side: &Side,
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
    pub(super) fn step_m(&self) -> f64 {
        0.5 * self.pixel_m
    }

    /// What one view shows within `compared` steps, where it sees `ends` steps; `None` where it sees too little of the side.
    fn profile(
        &self,
        scene: &Scene,
        occluders: &Occluders,
        view: ViewId,
        [ends, compared]: [usize; 2],
    ) -> Option<Profile> {
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
        Some(Profile {
            view,
            noise: scene.view(view).noise,
            differences: (0..count).map(difference).collect(),
            rows,
        })
    }

    /// What each step within `reach_m` is worth; `None` where too few views see the side, or none of them an edge.
    ///
    /// The energy of the labelling in one dimension: what the views agree on inside counts for the facet, a border
    /// on an edge is cheap. Besides, the border that delineation chose is taken for known to `known_to_m`.
    fn gains(&self, reach_m: f64, known_to_m: f64, params: &RefineParams) -> Option<Gains> {
        (self.views.len() >= params.min_views).then_some(())?;
        let middle = self.middle();
        let steps = ((reach_m / self.step_m()) as usize + 1).min(middle - 1);
        let (first, last) = (middle - steps, middle + steps);
        let shared: Vec<f64> = (first..=last).map(|k| self.shared(k)).collect();
        let least = params.least_contrast / (self.samples as f64).sqrt();
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
        let mut inside = 0.0;
        let gain = (first..=last).map(|k| {
            inside += self.agreement(k, params) * self.step_m() * length;
            let moved = (k as f64 - middle as f64) * self.step_m() / known_to_m;
            inside + params.edge_gain_m * (edge[k - first] - moved * moved * length)
        });
        Some(Gains {
            first: -(steps as isize),
            gain: gain.collect(),
            edge,
        })
    }

    /// For every step back from the side, what it is worth that the facet ends there instead. `None` where too few views see
    /// it.
    pub(super) fn worth_of_ending(&self, params: &RefineParams) -> Option<Vec<Worth>> {
        (self.views.len() >= params.min_views).then_some(())?;
        let middle = self.middle();
        let shared: Vec<f64> = (0..=middle).map(|k| self.shared(k)).collect();
        let least = params.least_contrast / (self.samples as f64).sqrt();
        let strongest = shared.iter().copied().fold(least, f64::max);
        let length = self.segment.length();
        let agreement: Vec<f64> = (0..middle)
            .map(|k| self.agreement(k, params) * self.step_m())
            .collect();
        let mut inside: f64 = agreement.iter().sum();
        let mut strip = 0.0;
        let mut worth = Vec::with_capacity(middle);
        for k in (0..middle).rev() {
            strip += agreement[k];
            inside -= agreement[k];
            let edge = params.edge_gain_m * shared[k] / strongest;
            worth.push(Worth {
                ending: length * (edge - params.border_cost_m - strip),
                inside: length * inside,
            });
        }
        Some(worth)
    }

    /// Mean correlation of the rows of all pairs of views at a step, less the correlation at which a plane is as good as none, and
    /// weighted by texture: a row has no width, so unlike a window it does not reach over the edge.
    fn agreement(&self, k: usize, params: &RefineParams) -> f64 {
        let (mut sum, mut pairs) = (0.0, 0.0f64);
        for (i, a) in self.views.iter().enumerate() {
            for b in &self.views[i + 1..] {
                let [saa, sbb, sab] = covariances(&a.rows[k], &b.rows[k]);
                let (texture, variance) = ((saa * sbb).sqrt(), a.noise * b.noise);
                let correlation = if texture > 0.0 { sab / texture } else { 0.0 };
                let weight = texture / (texture + variance);
                sum += weight * (correlation - least_overall(weight, params.min_correlation));
                pairs += 1.0;
            }
        }
        sum / pairs.max(1.0)
    }

    /// The step at the side itself.
    fn middle(&self) -> usize {
        (self.views[0].rows.len() - 1) / 2
    }

    /// The difference that half of the views reach at a step, of either sign: the roof's side of an edge is the same in all
    /// views, what lies behind it is not.
    fn shared(&self, k: usize) -> f64 {
        let mut strengths: Vec<f64> = self
            .views
            .iter()
            .map(|v| strongest_near(&v.differences, k).abs())
            .collect();
        math::median(&mut strengths).unwrap_or(0.0)
    }

    /// The edge in every view that shows it, sought around the side moved by `step` steps.
    fn measure(
        &self,
        scene: &Scene,
        side: usize,
        step: isize,
        params: &RefineParams,
    ) -> Vec<Sighting> {
        let offset = step as f64 * self.step_m();
        let place = (self.middle() as isize + step) as usize;
        let moved = |t: f64| self.segment.at(t) + self.outward * offset;
        let of_view = |profile: &Profile| {
            let view = profile.view;
            let rising = strongest_near(&profile.differences, place) > 0.0;
            let camera = scene.camera(view);
            let image = |t: f64| camera.project(&moved(t));
            let expected = Segment2::new(image(END_SHARE)?, image(1.0 - END_SHARE)?);
            let outside: Point2<f64> = camera.project(&(moved(0.5) + self.outward * 0.5))?;
            let outwards = (outside - expected.midpoint()).dot(&expected.normal()) > 0.0;
            // Directed by contrast: bright on the side of the normal.
            let expected = if outwards == rising {
                expected
            } else {
                expected.reversed()
            };
            let core = [0.0, expected.length()];
            let edge = measure_edge(
                view,
                scene.view(view).channel(Channel::Grey),
                Channel::Grey,
                &expected,
                core,
                false,
            )?;
            Some(Sighting {
                side,
                view,
                segment: edge.segment,
                whitening: whitening(&edge.covariance, edge.segment.length(), params.floor_px),
            })
        };
        let found: Vec<Sighting> = self.views.iter().filter_map(of_view).collect();
        if found.len() < 2 { Vec::new() } else { found }
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
fn strongest_near(differences: &[f64], k: usize) -> f64 {
    let near = &differences[k.saturating_sub(1)..(k + 2).min(differences.len())];
    near.iter()
        .fold(0.0f64, |s, &d| if d.abs() > s.abs() { d } else { s })
}

/// Whitens (offset, angle) of an edge of `length` px with an error of `floor` px at both ends that its covariance does not know.
fn whitening(covariance: &Matrix2<f64>, length: f64, floor: f64) -> Matrix2<f64> {
    let mut c = *covariance;
    c[(0, 0)] += floor * floor;
    c[(1, 1)] += 4.0 * floor * floor / (length * length);
    c.cholesky()
        .and_then(|l| l.l().try_inverse())
        .unwrap_or_else(|| Matrix2::new(1.0 / floor, 0.0, 0.0, 0.5 * length / floor))
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::super::fixture::{facet, facets_of};
    use super::*;
    use crate::geometry::Plane;
    use crate::roof::Facet;
    use crate::synthetic::gable_scene;
    use crate::testing;

    #[test]
    fn a_wall_goes_on_behind_a_jog() {
        // The eaves of two facets that meet at x = 4 m, one 0.2 m behind the other.
        let raised = |(x, y): &(f64, f64)| Point3::new(*x, *y, 3.0 + 0.5 * y);
        let ring = |corners: &[(f64, f64)]| facet(&corners.iter().map(raised).collect::<Vec<_>>());
        let facets = [
            ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 0.2), (4.0, 3.0), (0.0, 3.0)]),
            ring(&[(4.0, 0.2), (8.0, 0.2), (8.0, 3.0), (4.0, 3.0)]),
        ];
        let (wireframe, state) = Wireframe::new(&facets_of(&facets));
        let longest = |gap_m: f64| {
            let runs = aligned_runs(&wireframe, &state, gap_m, |_| true);
            let eaves = runs.iter().filter(|run| {
                let side = wireframe.segment(&state, &wireframe.sides[run[0]]);
                side.direction().x.abs() > 0.9 && side.p0.y < 1.0
            });
            eaves.map(|run| run.len()).max()
        };
        assert_eq!(longest(0.0), Some(1));
        assert_eq!(longest(0.5), Some(2));
    }

    /// Darkens, until texture is hardly seen, what is seen of a plane within `depth_m` inside a line in it, and beyond.
    fn cast_shadow(
        scene: &mut Scene,
        plane: &Plane,
        line: &Segment3,
        inward: Vector2<f64>,
        depth_m: f64,
    ) {
        for view in &mut scene.views {
            let (camera, gray) = (&view.camera, &mut view.gray);
            for k in 0..gray.data.len() {
                let at = [k % gray.width, k / gray.width].map(|i| i as f64 + 0.5);
                let ray = camera.ray(&Point2::from(at));
                let depth = -plane.signed_distance(&camera.center) / plane.normal.dot(&ray);
                let p = camera.center + ray * depth;
                if (p.xy() - line.p0.xy()).dot(&inward) < depth_m {
                    gray.data[k] = 0.1 + 0.1 * gray.data[k];
                }
            }
        }
    }

    #[test]
    fn an_eave_on_a_matched_line_is_not_given_up_for_the_edge_of_a_shadow() {
        let (mut scene, truth) = gable_scene(320);
        let facets: Vec<Facet> = truth.facets.iter().map(|(_, ring)| facet(ring)).collect();
        let (wireframe, state) = Wireframe::new(&facets_of(&facets));
        let eave = |side: &&Side| {
            let s = wireframe.segment(&state, side);
            side.kind == SideKind::Free && (s.p0.z - s.p1.z).abs() < 0.01
        };
        let (index, side) = (wireframe.sides.iter().enumerate())
            .find(|(_, side)| eave(side))
            .expect("an eave");
        let line = wireframe.segment(&state, side);
        let along = (line.p1.xy() - line.p0.xy()).normalize();
        // The facet lies on its left.
        let inward = Vector2::new(-along.y, along.x);
        let plane = facets[side.face].plane;
        cast_shadow(&mut scene, &plane, &line, inward, 0.5);
        let occluders = Occluders::new(&[]);
        // Distance of the measured edges from the eave, in plan, metres.
        let off_by = |lines: &[Line3d]| {
            let params = RefineParams::default();
            let search = [true, true];
            let found = sight_sides(
                &scene, &occluders, &wireframe, &state, &search, lines, &params,
            );
            let offsets = found.iter().filter(|s| s.side == index).map(|s| {
                let camera = scene.camera(s.view);
                let ray = camera.ray(&s.segment.midpoint());
                let depth = -plane.signed_distance(&camera.center) / plane.normal.dot(&ray);
                ((camera.center + ray * depth).xy() - line.p0.xy()).dot(&inward)
            });
            let mut offsets: Vec<f64> = offsets.collect();
            assert!(offsets.len() >= 4, "measured in {} views", offsets.len());
            math::median(&mut offsets).unwrap_or(f64::NAN)
        };
        let matched = testing::line(line.p0, line.p1);
        let by_shadow = off_by(&[]);
        assert!(
            (by_shadow - 0.5).abs() < 0.1,
            "the stronger edge at {by_shadow}"
        );
        let by_line = off_by(&[matched]);
        assert!(by_line.abs() < 0.1, "the eave at {by_line}");
    }

    #[test]
    fn a_side_is_on_a_line_that_runs_along_most_of_it_at_its_height() {
        let side = Segment3::new(Point3::new(0.0, 0.0, 5.0), Point3::new(8.0, 0.0, 6.0));
        let line = |x: [f64; 2], y: f64, lift: f64| {
            let at = |x: f64| Point3::new(x, y, 5.0 + x / 8.0 + lift);
            testing::line(at(x[0]), at(x[1]))
        };
        assert!(is_on_line(&side, &[line([-3.0, 5.0], 0.1, 0.3)]));
        assert!(is_on_line(
            &side,
            &[line([0.0, 2.0], 0.1, 0.0), line([7.9, 5.5], -0.1, 0.0)]
        ));
        assert!(
            !is_on_line(&side, &[line([-3.0, 3.0], 0.1, 0.0)]),
            "along 3 of 8 m"
        );
        assert!(
            !is_on_line(&side, &[line([0.0, 8.0], 0.2, 0.0)]),
            "beside it"
        );
        assert!(
            !is_on_line(&side, &[line([0.0, 8.0], 0.0, -0.5)]),
            "under it"
        );
    }
}
