//! Which pairs of views are matched with each other.

use nalgebra::Point2;

use crate::ids::ViewId;
use crate::params::MatchParams;
use crate::scene::Scene;
use crate::sorting::sort_by;

/// Points of a grid over a view, each way, whose visibility in another view measures the overlap.
const GRID: usize = 5;
/// Least share of a view that the partner must see.
const MIN_OVERLAP: f64 = 0.1;

/// Pairs (lower, higher) of views that see the same ground at the middle of the height range. A
/// view with more candidates than `max_partners` keeps those with the nearest projection centres.
pub fn partner_views(
    scene: &Scene,
    z_range: [f64; 2],
    params: &MatchParams,
) -> Vec<(ViewId, ViewId)> {
    let z = 0.5 * (z_range[0] + z_range[1]);
    let mut pairs = Vec::new();
    for view in scene.view_ids() {
        let center = scene.camera(view).center;
        let distance = |v: &ViewId| (scene.camera(*v).center - center).norm();
        let mut others: Vec<ViewId> = scene
            .view_ids()
            .filter(|v| *v != view && overlap(scene, view, *v, z) >= MIN_OVERLAP)
            .collect();
        sort_by(&mut others, |a, b| {
            distance(a).total_cmp(&distance(b)).then(a.cmp(b))
        });
        others.truncate(params.max_partners);
        pairs.extend(others.into_iter().map(|v| (view.min(v), view.max(v))));
    }
    sort_by(&mut pairs, Ord::cmp);
    pairs.dedup();
    pairs
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
