//! How what lies beside a drawn edge falls: theta of the plane through the edge (B99 4.1), by all
//! that the photographs show of the half of the facet on that side.
//!
//! ```text
//! ln p(views | theta) = sum over sides    steps along the side, lifted onto the plane at theta
//!                     + sum over windows  what their correlation says of that plane
//! ```
//!
//! In plan the outline of the half is known; its heights follow from theta. So its eaves and hips
//! tell theta where the roof is plain, and its windows where it has texture. Beforehand the plane
//! that it has otherwise is as likely as all others: the posterior of B99 5 with that plane in the
//! place of none.
//!
//! Deviation from B99 4.1: the whole half is swept, not a strip beside the line.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector2};

use crate::base::geometry::{Plane, Segment3, contains, mean_point, plan_sides, sides};
use crate::base::params::{Params, SweepParams};
use crate::lines::linematch::shown_along;
use crate::lines::lines3d::{Line3d, Side, ThetaFrame};
use crate::orienting::scene::Scene;
use crate::planes::half_planes::Posterior;
use crate::planes::photoconsistency::{PlanGrid, consistency_map};
use crate::roofs::facets::FINEST_CELL_M;
use crate::roofs::model::Facet;

/// A place this far beside a line is on that side of it, metres: less than the width of any facet.
pub(super) const SIDE_OFFSET_M: f64 = 0.01;
/// An edge is longer, metres.
pub(super) const SHORTEST_EDGE_M: f64 = 0.1;
/// Most cells of the windows; of a larger half they are coarser.
const MOST_CELLS: f64 = 5000.0;
/// Samples of theta in the first step of the sweep: at a decimetre a pixel a side 5 m from the edge
/// moves by about one between two of them.
const SAMPLES_IN_STEP: usize = 10;
/// Windows are compared at every so many of them, then at each beside the likeliest.
const COARSE_STRIDE: usize = 5;
/// Likelier than not.
const LEAST_PROBABILITY: f64 = 0.5;

/// What lies beside the line of a drawn edge.
#[derive(Clone, Copy)]
pub(super) struct Beside<'a> {
    pub scene: &'a Scene,
    pub line: &'a Line3d,
    pub params: &'a Params,
}

/// A plane through the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slope {
    pub plane: Plane,
    /// Standard deviation of theta, radians.
    pub sigma_theta: f64,
}

impl Beside<'_> {
    /// The plane on a side of the line, of which half of a facet is there; `otherwise` where the
    /// photographs do not show another one.
    pub(super) fn slope(&self, side: Side, half: &Facet, otherwise: Plane) -> Slope {
        self.shown(side, half, &otherwise).unwrap_or(Slope {
            plane: otherwise,
            sigma_theta: 0.0,
        })
    }

    fn shown(&self, side: Side, half: &Facet, otherwise: &Plane) -> Option<Slope> {
        let line = &self.line.segment;
        let frame = ThetaFrame::new(line, side)?;
        let thetas = samples(&self.params.sweep);
        let mut planes: Vec<Plane> = thetas.iter().map(|t| frame.plane(line, *t)).collect();
        planes.push(*otherwise);
        let sides = self.of_sides(half, &planes);
        let windows = Windows::new(self.scene, half)?;
        let coarse = (0..thetas.len()).step_by(COARSE_STRIDE);
        let mut of_windows = windows.of_planes(&planes, coarse.chain([thetas.len()]));
        let best = likeliest(&evidence(&sides, &of_windows));
        let near = best.saturating_sub(COARSE_STRIDE)..(best + COARSE_STRIDE).min(thetas.len());
        of_windows.extend(windows.of_planes(&planes, near));
        let evidence = evidence(&sides, &of_windows);
        let best = likeliest(&evidence);
        let posterior = Posterior::new(&thetas, &evidence);
        let reach = self.params.sweep.first_step_deg.to_radians();
        let is_likely = posterior.probability(&thetas, thetas[best], reach) >= LEAST_PROBABILITY;
        is_likely.then(|| {
            let (theta, sigma_theta) = mean_near(&posterior, &thetas, thetas[best], reach);
            Slope {
                plane: frame.plane(line, theta),
                sigma_theta,
            }
        })
    }

    /// What the views show along the sides of a half if it lay on each of some planes, nats but
    /// for what is common to all. A single view decides nothing: the one that says most is left
    /// out.
    fn of_sides(&self, half: &Facet, planes: &[Plane]) -> Vec<f64> {
        let candidates: Vec<Vec<Option<Segment3>>> = (self.sides_of(half).iter())
            .map(|[p, q]| {
                let on = |plane: &Plane| Segment3::new(plane.lift(p.x, p.y), plane.lift(q.x, q.y));
                planes.iter().map(|plane| Some(on(plane))).collect()
            })
            .collect();
        let (mut total, mut most) = (vec![0.0; planes.len()], vec![0.0f64; planes.len()]);
        for view in self.scene.view_ids() {
            let mut of_view = vec![0.0; planes.len()];
            for lines in &candidates {
                let shown = shown_along(self.scene, &[view], lines);
                of_view
                    .iter_mut()
                    .zip(shown)
                    .for_each(|(sum, nats)| *sum += nats);
            }
            for (k, nats) in of_view.into_iter().enumerate() {
                total[k] += nats;
                most[k] = most[k].max(nats);
            }
        }
        total
            .iter()
            .zip(most)
            .map(|(total, most)| total - most)
            .collect()
    }

    /// The sides of a half but for the drawn one, as long as an edge that can be measured.
    fn sides_of(&self, half: &Facet) -> Vec<[Point3<f64>; 2]> {
        let line = &self.line.segment;
        let along = (line.p1.xy() - line.p0.xy()).normalize();
        let is_on_line =
            |p: &Point3<f64>| along.perp(&(p.xy() - line.p0.xy())).abs() < SHORTEST_EDGE_M;
        let pixel_m = self.scene.median_ground_pixel(&line.at(0.5));
        let least_m = self.params.matching.min_edgels as f64 * pixel_m.unwrap_or(0.0);
        (half.rings().flat_map(|ring| sides(ring)))
            .filter(|[p, q]| (q - p).xy().norm() >= least_m.max(SHORTEST_EDGE_M))
            .filter(|[p, q]| !(is_on_line(p) && is_on_line(q)))
            .filter(|[p, q]| bounds_half(half, p, q))
            .collect()
    }
}

/// Does a half lie to the left of a side, and not to the right? On both sides of a slit it does.
fn bounds_half(half: &Facet, p: &Point3<f64>, q: &Point3<f64>) -> bool {
    let along = (q - p).xy().normalize();
    let aside = Vector2::new(-along.y, along.x) * SIDE_OFFSET_M;
    let middle = p.xy() + (q - p).xy() * 0.5;
    half.covers(&(middle + aside)) && !half.covers(&(middle - aside))
}

/// The windows in a half, at their places in plan.
struct Windows {
    scene: Scene,
    grid: PlanGrid,
    /// Cells inside the half.
    cells: Vec<usize>,
}

impl Windows {
    fn new(scene: &Scene, half: &Facet) -> Option<Self> {
        let pixel_m = scene.median_ground_pixel(&mean_point(&half.outer))?;
        let step = (PlanGrid::cell_of_pixels(pixel_m).max(FINEST_CELL_M))
            .max((half.plan_area() / MOST_CELLS).sqrt());
        let [min, max] = half.plan_bounds();
        let grid = PlanGrid::covering(min, max, step);
        let at = |k: usize| grid.center(k % grid.width, k / grid.width);
        let cells = 0..grid.width * grid.height;
        Some(Self {
            scene: scene.reduced(((grid.of_samples().step / pixel_m) as usize).max(1)),
            cells: cells
                .filter(|&k| contains(plan_sides(&half.outer), &at(k)))
                .collect(),
            grid,
        })
    }

    /// What they say of some of the planes, nats: windows a metre apart are independent.
    fn of_planes(
        &self,
        planes: &[Plane],
        which: impl Iterator<Item = usize>,
    ) -> BTreeMap<usize, f64> {
        let which: Vec<usize> = which.collect();
        let nats = crate::base::execution::map(&which, |_, &k| {
            let map = consistency_map(&self.scene, &planes[k], &self.grid);
            let sum: f64 = self.cells.iter().map(|&cell| map.nats(cell)).sum();
            sum * self.grid.step * self.grid.step
        });
        which.into_iter().zip(nats).collect()
    }
}

/// The angles that are compared, radians.
fn samples(sweep: &SweepParams) -> Vec<f64> {
    let step_deg = sweep.first_step_deg.max(0.1) / SAMPLES_IN_STEP as f64;
    let each_way = (sweep.max_theta_deg.clamp(1.0, 89.0) / step_deg).floor() as i32;
    (-each_way..=each_way)
        .map(|i| (f64::from(i) * step_deg).to_radians())
        .collect()
}

/// How much likelier each plane is than the last one, nats. Between those whose windows are known
/// what these say is linear.
fn evidence(sides: &[f64], of_windows: &BTreeMap<usize, f64>) -> Vec<f64> {
    let last = sides.len() - 1;
    let otherwise = sides[last] + of_windows[&last];
    let windows = |k: usize| {
        let below = of_windows.range(..=k).next_back();
        let above = of_windows.range(k..last).next();
        match (below, above) {
            (Some((a, low)), Some((b, high))) if b > a => {
                low + (high - low) * (k - a) as f64 / (b - a) as f64
            }
            (Some((_, nats)), _) | (None, Some((_, nats))) => *nats,
            (None, None) => 0.0,
        }
    };
    (0..last)
        .map(|k| sides[k] + windows(k) - otherwise)
        .collect()
}

/// The first of the likeliest.
fn likeliest(evidence: &[f64]) -> usize {
    let better = |best: usize, k: usize| match evidence[k] > evidence[best] {
        true => k,
        false => best,
    };
    (0..evidence.len()).reduce(better).unwrap_or(0)
}

/// Mean and standard deviation of theta within reach of the likeliest one, radians. The samples
/// are known to half their step.
fn mean_near(posterior: &Posterior, thetas: &[f64], best: f64, reach: f64) -> (f64, f64) {
    let near = || {
        let all = thetas.iter().zip(&posterior.density);
        all.filter(|(theta, _)| (**theta - best).abs() <= reach)
    };
    let mass: f64 = near().map(|(_, density)| density).sum();
    let mean = near().map(|(theta, density)| theta * density).sum::<f64>() / mass;
    let square = |theta: f64| (theta - mean) * (theta - mean);
    let variance = near()
        .map(|(theta, density)| square(*theta) * density)
        .sum::<f64>()
        / mass;
    let half_step = 0.5 * (thetas[1] - thetas[0]);
    (mean, variance.sqrt().max(half_step))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planes::rendered_planes::{TexturedPlane, level_ground, scene};
    use crate::roofs::testing::{facet, line};

    const FALL_DEG: f64 = -30.0;

    fn ridge() -> Line3d {
        line(Point3::new(-5.0, 0.0, 8.0), Point3::new(5.0, 0.0, 8.0))
    }

    /// The plane to the left of the ridge at an angle.
    fn left(theta_deg: f64) -> Plane {
        let frame = ThetaFrame::new(&ridge().segment, Side::Left).expect("level");
        frame.plane(&ridge().segment, theta_deg.to_radians())
    }

    /// Four metres to the left of the ridge, thought to rise by 20 degrees.
    fn half() -> Facet {
        let corners = [(-5.0, 0.0), (5.0, 0.0), (5.0, 4.0), (-5.0, 4.0)];
        facet(&corners.map(|(x, y)| left(20.0).lift(x, y)))
    }

    /// Theta that is found, degrees.
    fn found_deg(scene: &Scene) -> f64 {
        let params = Params::default();
        let beside = Beside {
            scene,
            line: &ridge(),
            params: &params,
        };
        let slope = beside.slope(Side::Left, &half(), left(20.0));
        let frame = ThetaFrame::new(&ridge().segment, Side::Left).expect("level");
        frame.theta_of(&slope.plane).to_degrees()
    }

    #[test]
    fn windows_tell_the_slope_of_a_roof_whose_eaves_nobody_sees() {
        let endless = TexturedPlane {
            plane: left(FALL_DEG),
            exists: |_, _| true,
            texture: 0.3,
        };
        let found = found_deg(&scene(&[endless]));
        assert!((found - FALL_DEG).abs() < 1.0, "{found}");
    }

    /// A roof that is bright, and even.
    fn plain_roof() -> Scene {
        let plain = TexturedPlane {
            plane: left(FALL_DEG),
            exists: |x, y| x.abs() <= 5.0 && (0.0..=4.0).contains(&y),
            texture: 0.0,
        };
        let mut scene = scene(&[plain, level_ground()]);
        let gray = scene.views.iter_mut().flat_map(|v| &mut v.gray.data);
        gray.filter(|g| **g == 0.5).for_each(|g| *g = 0.9);
        scene
    }

    #[test]
    fn eaves_tell_the_slope_of_a_plain_roof() {
        let found = found_deg(&plain_roof());
        assert!((found - FALL_DEG).abs() < 1.0, "{found}");
    }

    #[test]
    fn sides_alone_tell_the_slope_unless_a_single_view_shows_them() {
        let planes: Vec<Plane> = (-60..=60).map(|deg| left(f64::from(deg))).collect();
        let params = Params::default();
        let told = |scene: &Scene| {
            let beside = Beside {
                scene,
                line: &ridge(),
                params: &params,
            };
            beside.of_sides(&half(), &planes)
        };
        let mut scene = plain_roof();
        let found = told(&scene);
        let best = likeliest(&found) as f64 - 60.0;
        assert!((best - FALL_DEG).abs() <= 1.0, "{best}");
        let most = |nats: &[f64]| nats.iter().fold(0.0, |most: f64, n| most.max(n.abs()));
        (scene.views.iter_mut().skip(1)).for_each(|view| view.gray.data.fill(0.5));
        let one = told(&scene);
        assert!(
            most(&one) < 0.1 * most(&found),
            "{} {}",
            most(&one),
            most(&found)
        );
    }

    #[test]
    fn where_nothing_is_shown_the_plane_stays() {
        assert!((found_deg(&scene(&[])) - 20.0).abs() < 1e-9);
    }

    #[test]
    fn the_drawn_side_and_slits_tell_nothing() {
        let params = Params::default();
        let beside = Beside {
            scene: &scene(&[]),
            line: &ridge(),
            params: &params,
        };
        let corners = [
            (-5.0, 0.0),
            (5.0, 0.0),
            (5.0, 4.0),
            (9.0, 4.0),
            (5.0, 4.0),
            (-5.0, 4.0),
        ];
        let half = facet(&corners.map(|(x, y)| Point3::new(x, y, 8.0)));
        let lengths = beside
            .sides_of(&half)
            .into_iter()
            .map(|[p, q]| (q - p).norm());
        assert_eq!(lengths.collect::<Vec<_>>(), [4.0, 10.0, 4.0]);
    }
}
