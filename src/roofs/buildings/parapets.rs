//! Roofs below their parapets.
//!
//! The edges that bound a flat roof are often those of a parapet that stands above it. Matched
//! lines and the adjustment put the plane there, and vents and machines rise above the roof as
//! well. Inside, the views show at which height most of it lies and what stands on it
//! ([`ClutterTable`]), and so do the points of a cloud. A facet that meets no other one is moved
//! down there where that is likelier. The parapet itself is no part of the model: walls end at the
//! roof.

use nalgebra::Point3;
use serde::Serialize;

use crate::base::evidence::ClutterTable;
use crate::base::geometry::Plane;
use crate::base::ids::ViewId;
use crate::orienting::scene::Scene;
use crate::planes::photoconsistency::{MAX_VIEWS, PlanGrid, WINDOW, consistency_map_behind};
use crate::roofs::facets::{CloudEvidence, PartVisibility, largest_slope, windows_inside};
use crate::roofs::model::{Facet, Occluders};
use crate::roofs::obstructions::FINEST_SAMPLE_M;

/// A roof lies at most so far below its edges, metres. Assumption: the height of a balustrade.
const HIGHEST_M: f64 = 1.2;
/// Two vertices at one place are no farther apart, metres.
const SAME_PLACE: f64 = 0.01;

/// A roof that lies below the edges that bound it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Parapet {
    /// Index of its facet among the refined ones.
    pub facet: usize,
    /// How far its edges stand above the roof, metres.
    pub height_m: f64,
    /// What speaks for it, nats.
    pub nats: f64,
}

/// Moves facets that lie below their parapets down to the height of the roof.
pub(super) fn below_parapets(
    scene: &Scene,
    facets: &[Facet],
    cloud: Option<&CloudEvidence>,
) -> (Vec<Facet>, Vec<Parapet>) {
    let Some(middle) = facets.first().and_then(|f| f.outer.first()) else {
        return (facets.to_vec(), Vec::new());
    };
    let pixels = scene.views.iter().map(|v| v.camera.ground_pixel(middle));
    let pixel = pixels.fold(f64::INFINITY, f64::min);
    let sample = pixel.max(FINEST_SAMPLE_M);
    let reduced = scene.reduced(((sample / pixel) as usize).max(1));
    let step = PlanGrid::cell_of_pixels(sample);
    let found = crate::base::execution::map(facets, |i, facet| {
        let others: Vec<Facet> = (facets.iter().enumerate())
            .filter(|(j, _)| i != *j)
            .map(|(_, f)| f.clone())
            .collect();
        if others.iter().any(|other| meet(facet, other)) {
            return None;
        }
        let occluders = Occluders::new(&others);
        let (height_m, nats) = parapet_of(&reduced, facet, step, &occluders, cloud)?;
        Some(Parapet {
            facet: i,
            height_m,
            nats,
        })
    });
    let parapets: Vec<Parapet> = found.into_iter().flatten().collect();
    let mut facets = facets.to_vec();
    for parapet in &parapets {
        facets[parapet.facet] = lowered(&facets[parapet.facet], parapet.height_m);
    }
    (facets, parapets)
}

/// Do two facets share a corner in space?
fn meet(a: &Facet, b: &Facet) -> bool {
    let corners = |f: &'_ Facet| -> Vec<Point3<f64>> {
        f.outer
            .iter()
            .chain(f.holes.iter().flatten())
            .copied()
            .collect()
    };
    let (a, b) = (corners(a), corners(b));
    a.iter()
        .any(|p| b.iter().any(|q| (p - q).norm() < SAME_PLACE))
}

/// How far a facet's edges stand above the roof, metres, and what speaks for it, nats; `None` where
/// it is likelier at the height of its edges.
fn parapet_of(
    scene: &Scene,
    facet: &Facet,
    step: f64,
    occluders: &Occluders,
    cloud: Option<&CloudEvidence>,
) -> Option<(f64, f64)> {
    let table = ClutterTable::fitted();
    let [min, max] = facet.plan_bounds();
    let grid = PlanGrid::covering(min, max, step);
    let inside = windows_inside(facet, &grid);
    let place = inside.get(inside.len() / 2)?;
    let place = grid.center(place % grid.width, place / grid.width);
    let place = facet.plane.lift(place.x, place.y);
    let hidden = |v: ViewId, p: &Point3<f64>| occluders.hide(p, &scene.camera(v).center);
    let visibility = PartVisibility::new(scene, facet, step, &hidden);
    let hidden = |v: ViewId, p: &Point3<f64>| visibility.is_hidden(v, &p.xy());
    let views = scene.view_ids().filter(|v| {
        let image = scene.camera(*v).project(&place);
        image.is_some_and(|x| scene.camera(*v).contains(&x, 0.0)) && !hidden(*v, &place)
    });
    let views = views.count().min(MAX_VIEWS);
    // A sample between the two views farthest apart.
    let apart = grid.of_samples().step / largest_slope(scene, &place, &hidden);
    let lowest = (HIGHEST_M / apart).ceil() as usize;
    let reach = (table.highest_m / apart).ceil() as usize;
    // The likelihoods of the heights by window, from the lowest to the highest.
    let plane_at = |k: usize| raised(&facet.plane, (k as f64 - lowest as f64) * apart);
    let by_height: Vec<Vec<f64>> = (0..=lowest + reach)
        .map(|k| {
            let map = consistency_map_behind(scene, &plane_at(k), &grid, &hidden);
            let nats = |&k: &usize| table.nats_of_height(map.correlation(k), views);
            inside.iter().map(nats).collect()
        })
        .collect();
    let mut said = vec![0.0; lowest + 1];
    let mut likelihoods = vec![0.0; by_height.len()];
    for window in 0..inside.len() {
        let best = by_height.iter().fold(0.0, |m: f64, h| m.max(h[window]));
        for (likelihood, nats) in likelihoods.iter_mut().zip(&by_height) {
            *likelihood = crate::base::math::exp(nats[window] - best);
        }
        let mean = likelihoods.iter().sum::<f64>() / likelihoods.len() as f64;
        for (k, said) in said.iter_mut().enumerate() {
            let above = &likelihoods[k + 1..=k + reach];
            let above = above.iter().sum::<f64>() / reach as f64;
            *said += table.nats_of_roof(likelihoods[k] / mean, above / mean);
        }
    }
    // Windows side by side are independent, others share cells.
    said.iter_mut().for_each(|s| *s /= (WINDOW * WINDOW) as f64);
    if let Some(cloud) = cloud {
        for (k, said) in said.iter_mut().enumerate() {
            *said += cloud.prefers(facet, &plane_at(k), &facet.plane);
        }
    }
    let best = (0..lowest).max_by(|&i, &j| said[i].total_cmp(&said[j]).then(i.cmp(&j)))?;
    let nats = said[best] - said[lowest] + table.prior_of_rim(lowest);
    let below = said[best.saturating_sub(1)];
    let bend = 2.0 * said[best] - below - said[best + 1];
    let between = match bend > 0.0 {
        true => 0.5 * (said[best + 1] - below) / bend,
        false => 0.0,
    };
    let height = (lowest - best) as f64 - between.clamp(-0.5, 0.5);
    (nats > 0.0).then_some((height * apart, nats))
}

fn raised(plane: &Plane, by: f64) -> Plane {
    Plane {
        d: plane.d - by * plane.normal.z,
        ..*plane
    }
}

/// The same facet so many metres lower.
fn lowered(facet: &Facet, by: f64) -> Facet {
    let mut facet = facet.clone();
    facet.plane = raised(&facet.plane, -by);
    let corners = (facet.outer.iter_mut()).chain(facet.holes.iter_mut().flatten());
    corners.for_each(|p| p.z -= by);
    let known = facet.uncertainty.iter_mut().flat_map(|u| &mut u.corners);
    known.for_each(|corner| corner.at.z -= by);
    facet
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planes::rendered_planes::{level_ground, scene, textured};
    use crate::roofs::testing;

    /// A facet of 10 m by 8 m at a height.
    fn facet(z: f64) -> Facet {
        let corners = [(-5.0, -4.0), (5.0, -4.0), (5.0, 4.0), (-5.0, 4.0)];
        testing::facet(&corners.map(|(x, y)| Point3::new(x, y, z)))
    }

    /// A roof at 5 m with a parapet of 0.4 m and machines of 0.8 m.
    fn rimmed() -> Scene {
        let machines = |x: f64, y: f64| (1.0..3.5).contains(&x) && (-2.0..1.0).contains(&y);
        let roof = |x: f64, y: f64| x.abs() < 4.7 && y.abs() < 3.7;
        let parapet =
            |x: f64, y: f64| x.abs() < 5.0 && y.abs() < 4.0 && !(x.abs() < 4.7 && y.abs() < 3.7);
        scene(&[
            textured(Plane::level(5.8), machines),
            textured(Plane::level(5.0), roof),
            textured(Plane::level(5.4), parapet),
            level_ground(),
        ])
    }

    #[test]
    fn a_roof_is_found_below_its_parapet_and_what_stands_on_it() {
        let rimmed = rimmed();
        let (facets, parapets) = below_parapets(&rimmed, &[facet(5.4)], None);
        assert_eq!(parapets.len(), 1);
        assert!((parapets[0].height_m - 0.4).abs() < 0.05, "{parapets:?}");
        assert!((facets[0].plane.z_at(0.0, 0.0) - 5.0).abs() < 0.05);
        assert!(facets[0].outer.iter().all(|p| (p.z - 5.0).abs() < 0.05));
        let (facets, parapets) = below_parapets(&rimmed, &[facet(5.0)], None);
        assert_eq!((facets, parapets), (vec![facet(5.0)], Vec::new()));
    }

    #[test]
    fn points_of_a_cloud_speak_for_the_height_at_which_they_lie() {
        let rimmed = rimmed();
        let nats = |z: Option<f64>| {
            let cloud = z.map(|z| CloudEvidence::of_level_points(z, 1.0 - 1e-6));
            below_parapets(&rimmed, &[facet(5.4)], cloud.as_ref()).1[0].nats
        };
        let photographs = nats(None);
        // On the edges: all that they can say, which is that the cloud is hardly of elsewhere.
        assert!((nats(Some(5.4)) - photographs - crate::base::math::ln(1e-6)).abs() < 0.1);
        assert!(nats(Some(5.0)) > photographs + 50.0);
    }

    #[test]
    fn facets_that_meet_keep_their_ridge() {
        let slope = |sign: f64| {
            let (x, y) = (5.0 * sign, 4.0 * sign);
            let corners = [(0.0, -y, 7.0), (x, -y, 5.0), (x, y, 5.0), (0.0, y, 7.0)];
            testing::facet(&corners.map(|(x, y, z)| Point3::new(x, y, z)))
        };
        assert!(meet(&slope(1.0), &slope(-1.0)));
        assert!(!meet(&facet(5.0), &facet(8.0)));
    }
}
