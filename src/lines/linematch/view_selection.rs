//! The pairs of views that are matched with each other.

use nalgebra::{Point2, Vector2};

use super::height::nearest_views;
use crate::base::ids::ViewId;
use crate::base::math;
use crate::base::params::MatchParams;
use crate::orienting::scene::Scene;

/// Points of a grid over a view, each way, whose visibility in another view measures the overlap.
const GRID: usize = 5;
/// Least share of a view that the other view must see.
const MIN_OVERLAP: f64 = 0.1;

/// Pairs (lower, higher) of views that see the same ground at the middle of the height range. A
/// view with more candidates than `max_partners` keeps the nearest ones, equally many in every
/// direction: pairs along the strip alone would leave lines along the flight undetermined.
pub(super) fn select_view_pairs(
    scene: &Scene,
    z_range: [f64; 2],
    params: &MatchParams,
) -> Vec<(ViewId, ViewId)> {
    let z = 0.5 * (z_range[0] + z_range[1]);
    let mut pairs = Vec::new();
    for view in scene.view_ids() {
        let center = scene.camera(view).center;
        let mut others = nearest_views(scene, view);
        others.retain(|v| overlap(scene, view, *v, z) >= MIN_OVERLAP);
        let others = in_all_directions(others, params.max_partners, |v| {
            scene.camera(*v).center.xy() - center.xy()
        });
        pairs.extend(others.into_iter().map(|v| (view.min(v), view.max(v))));
    }
    pairs.sort();
    pairs.dedup();
    pairs
}

/// At most `count` of `nearest_first`: the nearest of each of four sectors of baseline directions
/// in plan, then the second nearest, and so on. Opposite baselines share a sector, and the first
/// sector is centred on the nearest view.
fn in_all_directions(
    nearest_first: Vec<ViewId>,
    count: usize,
    baseline: impl Fn(&ViewId) -> Vector2<f64>,
) -> Vec<ViewId> {
    // Of half a turn, because opposite baselines measure alike. Assumption: along, across and both
    // diagonals of a flight.
    const SECTORS: usize = 4;
    const SECTOR_WIDTH: f64 = std::f64::consts::PI / SECTORS as f64;
    let angle = |v: &ViewId| {
        let b = baseline(v);
        math::atan2(b.y, b.x)
    };
    let Some(first) = nearest_first.first().map(angle) else {
        return nearest_first;
    };
    let mut met = [0; SECTORS];
    let mut ranked: Vec<(usize, ViewId)> = (nearest_first.into_iter())
        .map(|v| {
            let sector = ((angle(&v) - first) / SECTOR_WIDTH).round() as i64;
            let met = &mut met[sector.rem_euclid(SECTORS as i64) as usize];
            *met += 1;
            (*met, v)
        })
        .collect();
    ranked.sort_by_key(|(rank, _)| *rank);
    ranked.truncate(count);
    ranked.into_iter().map(|(_, v)| v).collect()
}

/// Share of a grid over one view that another view sees at height `z`.
fn overlap(scene: &Scene, view: ViewId, other: ViewId, z: f64) -> f64 {
    let (first, second) = (scene.camera(view), scene.camera(other));
    let place = |i: usize, size: u32| (i as f64 + 0.5) / GRID as f64 * f64::from(size);
    let seen = (0..GRID * GRID)
        .filter(|i| {
            let x = Point2::new(place(i % GRID, first.width), place(i / GRID, first.height));
            let y = first.at_height(&x, z).and_then(|p| second.project(&p));
            y.is_some_and(|y| second.contains(&y, 0.0))
        })
        .count();
    seen as f64 / (GRID * GRID) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lines::lines3d::planted;
    use std::f64::consts::PI;

    /// Two strips of nine views, 20 m apart in the strip and 200 m across.
    fn block() -> Scene {
        let place = |i: usize| {
            let (along, strip) = (i % 9, i / 9);
            let kappa = if strip == 0 { 0.0 } else { PI };
            (
                20.0 * along as f64 - 80.0,
                200.0 * strip as f64 - 100.0,
                kappa,
            )
        };
        planted::views_from(&(0..18).map(place).collect::<Vec<_>>())
    }

    fn pairs(max_partners: usize) -> Vec<(ViewId, ViewId)> {
        let params = MatchParams {
            max_partners,
            ..MatchParams::default()
        };
        select_view_pairs(&block(), [0.0, 6.0], &params)
    }

    #[test]
    fn every_view_is_paired_across_its_strip() {
        let strip = |v: ViewId| v.index() / 9;
        let few = pairs(4);
        assert!(few.len() <= 18 * 4);
        for view in (0..18).map(ViewId) {
            let own = |&&(a, b): &&(ViewId, ViewId)| a == view || b == view;
            let own: Vec<_> = few.iter().filter(own).collect();
            assert!(own.iter().any(|(a, b)| strip(*a) != strip(*b)), "{view:?}");
            // The next view of its own strip is the nearest of all.
            let beside = |(a, b): &(ViewId, ViewId)| a.index().abs_diff(b.index()) == 1;
            assert!(own.iter().any(|pair| beside(pair)), "{view:?}");
        }
    }

    #[test]
    fn where_all_may_stay_all_do() {
        assert_eq!(pairs(17).len(), 18 * 17 / 2);
    }

    #[test]
    fn views_of_other_ground_are_not_paired() {
        let mut scene = planted::views_from(&[(0.0, 0.0, 0.0), (20.0, 0.0, 0.0), (40.0, 0.0, 0.0)]);
        // The last one looks past the ground of the others.
        scene.views[2].camera.k[(0, 2)] += 400.0;
        let found = select_view_pairs(&scene, [0.0, 6.0], &MatchParams::default());
        assert_eq!(found, [(ViewId(0), ViewId(1))]);
    }
}
