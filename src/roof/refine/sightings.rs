//! The image edges that belong to the sides of a wireframe.
//!
//! The image of a side is where the model expects an edge. A side may lie off by more than a guided
//! measurement reaches (a closing line where nothing was found, the correlation window that straddles a strong edge),
//! so it is first moved in its facet's plane, and the profiles across it are compared over the views: an edge of
//! the roof stands still then, whatever lies on the ground or on a wall moves. Of the edges that stand still the
//! outermost distinct one bounds the facet. From there `measure_edge` (the second look of line matching)
//! measures in every view.

use nalgebra::{Matrix2, Point2, Vector2};

use super::sight::Sight;
use super::wireframe::{Side, SideKind, State, Wireframe};
use crate::geometry::{Segment2, Segment3};
use crate::ids::ViewId;
use crate::linematch::measure_edge;
use crate::params::RefineParams;
use crate::scene::Scene;

/// Half the base of the difference across a side, in steps of half a pixel: one pixel.
const BASE: usize = 2;
/// Most places along a side at which the profile is sampled.
const MAX_SAMPLES: usize = 48;
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

/// Measures all sides in all views. `search` allows free sides to move to another edge first.
pub fn sight_sides(
    scene: &Scene,
    sight: &Sight,
    wireframe: &Wireframe,
    state: &State,
    search: bool,
    params: &RefineParams,
) -> Vec<Sighting> {
    let sides: Vec<usize> = (0..wireframe.sides.len()).collect();
    let of_side = |_: usize, &side: &usize| {
        let model = &wireframe.sides[side];
        let profiles = Profiles::new(scene, sight, wireframe, state, model, params)?;
        let reach = if search && model.kind != SideKind::Crease {
            params.search_m
        } else {
            params.reach_px * profiles.pixel_m
        };
        let (offset, rising) = profiles.edge(reach, params)?;
        Some(profiles.measure(scene, side, offset, rising, params))
    };
    crate::parallel::map(&sides, of_side)
        .into_iter()
        .flatten()
        .flatten()
        .collect()
}

/// What the views show across a side.
struct Profiles {
    /// The side.
    segment: Segment3,
    /// Change in space for a metre of plan across the side, outwards, in the facet's plane.
    outward: nalgebra::Vector3<f64>,
    /// Size of a pixel on the side, metres.
    pixel_m: f64,
    /// Per view the differences across the side, from inside to outside, at every step; the middle one is at the side.
    views: Vec<(ViewId, Vec<f64>)>,
    /// Places along the side.
    samples: usize,
}

impl Profiles {
    fn new(
        scene: &Scene,
        sight: &Sight,
        wireframe: &Wireframe,
        state: &State,
        side: &Side,
        params: &RefineParams,
    ) -> Option<Self> {
        let segment = wireframe.segment(state, side);
        let along = (segment.p1.xy() - segment.p0.xy()).try_normalize(1e-6)?;
        // The facet lies on the left.
        let across = Vector2::new(along.y, -along.x);
        let at = wireframe.plane_at(side.face);
        let rise = state[at] * across.x + state[at + 1] * across.y;
        let outward = nalgebra::Vector3::new(across.x, across.y, rise);
        let middle = segment.at(0.5);
        let pixels = scene.views.iter().map(|v| v.camera.ground_pixel(&middle));
        let pixel_m = pixels.fold(f64::INFINITY, f64::min);
        let length_px = segment.length() / pixel_m;
        (length_px >= params.min_side_px).then_some(())?;
        let mut profiles = Self {
            segment,
            outward,
            pixel_m,
            views: Vec::new(),
            samples: (length_px.ceil() as usize).min(MAX_SAMPLES),
        };
        let steps = (params.search_m / (0.5 * pixel_m)).ceil() as usize + BASE + 1;
        profiles.views = scene
            .view_ids()
            .filter_map(|v| Some((v, profiles.differences(scene, sight, v, steps)?)))
            .collect();
        Some(profiles)
    }

    /// The step of the profile in plan, metres.
    fn step_m(&self) -> f64 {
        0.5 * self.pixel_m
    }

    /// Mean differences of grey values across the side in one view; `None` where it sees too little of it.
    fn differences(
        &self,
        scene: &Scene,
        sight: &Sight,
        view: ViewId,
        steps: usize,
    ) -> Option<Vec<f64>> {
        let (camera, gray) = (scene.camera(view), &scene.view(view).gray);
        let count = 2 * steps + 1;
        let mut sums = vec![0.0f64; count];
        let mut seen = 0usize;
        let mut row = vec![0.0f64; count];
        let mut hidden = false;
        for i in 0..self.samples {
            let t = (i as f64 + 0.5) / self.samples as f64;
            let p = self.segment.at(END_SHARE + (1.0 - 2.0 * END_SHARE) * t);
            if i % 4 == 0 {
                hidden = sight.hidden(&p, &camera.center);
            }
            if hidden {
                continue;
            }
            let whole = row.iter_mut().enumerate().all(|(k, value)| {
                let s = (k as f64 - steps as f64) * self.step_m();
                let sample = camera
                    .project(&(p + self.outward * s))
                    .and_then(|x| gray.sample(x.x as f32, x.y as f32));
                *value = f64::from(sample.unwrap_or(0.0));
                sample.is_some()
            });
            if whole {
                seen += 1;
                sums.iter_mut().zip(&row).for_each(|(s, v)| *s += v);
            }
        }
        if (seen as f64) < MIN_SEEN * self.samples as f64 {
            return None;
        }
        let mean = |k: usize| sums[k] / seen as f64;
        Some(
            (BASE..count - BASE)
                .map(|k| mean(k + BASE) - mean(k - BASE))
                .collect(),
        )
    }

    /// Offset (metres of plan, outwards) of the edge that the views share within `reach_m`, and whether it
    /// grows brighter outwards.
    fn edge(&self, reach_m: f64, params: &RefineParams) -> Option<(f64, bool)> {
        (self.views.len() >= params.min_views).then_some(())?;
        let count = self.views[0].1.len();
        let middle = (count - 1) / 2;
        let steps = ((reach_m / self.step_m()) as usize).min(middle - 1);
        let shared: Vec<(f64, f64)> = (0..count).map(|k| self.shared(k)).collect();
        let least = params.least_contrast / (self.samples as f64).sqrt();
        let peaks: Vec<usize> = (middle - steps..=middle + steps)
            .filter(|&k| {
                let [a, b, c] = [k - 1, k, k + 1].map(|i| shared[i].0.abs());
                b >= a && b > c && b >= least && shared[k].1 >= params.least_agreement
            })
            .collect();
        let strength = |k: &usize| shared[*k].0.abs();
        let strongest = peaks.iter().map(strength).fold(0.0, f64::max);
        let chosen = peaks
            .into_iter()
            .filter(|k| strength(k) >= params.distinct_share * strongest)
            .max()?;
        let offset = (chosen as f64 - middle as f64) * self.step_m();
        Some((offset, shared[chosen].0 > 0.0))
    }

    /// Mean of the views' differences at a step, and how many standard deviations of that mean it is.
    fn shared(&self, k: usize) -> (f64, f64) {
        /// Standard deviation of a mean difference that texture leaves, grey range 1.
        const FLOOR: f64 = 0.004;
        let n = self.views.len() as f64;
        let mean = self.views.iter().map(|v| v.1[k]).sum::<f64>() / n;
        let squares: f64 = self
            .views
            .iter()
            .map(|v| (v.1[k] - mean) * (v.1[k] - mean))
            .sum();
        let variance = squares / (n - 1.0).max(1.0) + FLOOR * FLOOR;
        (mean, mean.abs() / (variance / n).sqrt())
    }

    /// The edge in every view that shows it, sought around the side moved by `offset`.
    fn measure(
        &self,
        scene: &Scene,
        side: usize,
        offset: f64,
        rising: bool,
        params: &RefineParams,
    ) -> Vec<Sighting> {
        let moved = |t: f64| self.segment.at(t) + self.outward * offset;
        let of_view = |&(view, _): &(ViewId, Vec<f64>)| {
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
            let edge = measure_edge(view, &scene.view(view).gray, &expected, core, params.noise)?;
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

/// Whitens (offset, angle) of an edge of `length` px with an error of `floor` px at both ends that its covariance does not know.
fn whitening(covariance: &Matrix2<f64>, length: f64, floor: f64) -> Matrix2<f64> {
    let mut c = *covariance;
    c[(0, 0)] += floor * floor;
    c[(1, 1)] += 4.0 * floor * floor / (length * length);
    c.cholesky()
        .and_then(|l| l.l().try_inverse())
        .unwrap_or_else(|| Matrix2::new(1.0 / floor, 0.0, 0.0, 0.5 * length / floor))
}
