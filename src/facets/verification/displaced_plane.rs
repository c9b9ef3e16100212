//! Displaced-plane test: a facet against its plane moved up and down, the sweep of B99 4.1 over
//! heights instead of angles and over the whole facet at once.
//!
//! Chance correlation depends on the place: on its texture, its shading, its vegetation. The moved
//! plane shows the same place with the same chance correlation, so no threshold is needed: a roof
//! is where the views agree better than above and below it. Pooled over a facet this separates weak
//! texture from none, and a slope between two roofs from a roof.

use nalgebra::{Point2, Point3, Vector2};

use super::interior::{InteriorSums, InteriorWindows, interior_map};
use super::rejection::FacetRejection;
use crate::geometry::Plane;
use crate::ids::ViewId;
use crate::math::larger;
use crate::model::Facet;
use crate::photoconsistency::PlanGrid;
use crate::scene::Scene;

/// Margin over the displaced planes, in standard deviations, that confirms a facet which falls
/// short of a threshold. Measured on rendered scenes: true facets that do have 1.1 and more, false
/// ones less than 0.5.
pub(super) const CLEAR_MARGIN: f64 = 1.0;
/// Share of its outline on lines from which on a facet is bounded by them on three sides of four: a
/// level roof beside a higher wall, which shades it and hides it from half of the views, stands out
/// little.
const THREE_SIDES: f64 = 0.75;
/// Largest offset of a true roof's plane from the roof, metres. Measured: 0.2 on a corrugated roof
/// of real-barns.
const PLANE_OFFSET_M: f64 = 0.25;
/// Least parallax between the two views farthest apart by which the plane is moved, cells: half a
/// window. Rendered scenes give the same models from 4 to 5.
const PARALLAX: f64 = 5.0;
/// How far the plane is moved, in such steps.
const STEPS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];
/// Side of the parts of a facet whose visibility is sampled once, cells: half a window.
const PART: f64 = 5.0;
/// Least difference of two rays' slopes for a parallax. Assumption: that of neighbours in a strip
/// of normal-angle photographs is 0.3.
const LEAST_SLOPE: f64 = 0.1;

/// Accepts a facet that passed the similarity test (`agreed`) and its margin over planes displaced
/// by at least so many metres, in standard deviations. A facet that failed is accepted for a clear
/// margin, one that passed is rejected where a displaced plane is better.
pub(super) fn displaced_plane_test(
    agreed: Result<(), FacetRejection>,
    facet: &Facet,
    interior: &InteriorSums,
    displaced_plane_margin: impl Fn(f64) -> f64,
) -> Result<(), FacetRejection> {
    // A bridge has a clear margin where it touches the two roofs.
    let is_bridge = matches!(agreed, Err(FacetRejection::Bridge { .. }));
    if agreed.is_err() && (is_bridge || displaced_plane_margin(0.0) < CLEAR_MARGIN) {
        return agreed;
    }
    if may_be_displaced(facet, interior) {
        let sigmas = displaced_plane_margin(2.0 * PLANE_OFFSET_M);
        if sigmas < least_margin(facet, interior) {
            return Err(FacetRejection::Displaced { sigmas: -sigmas });
        }
    }
    Ok(())
}

/// Might the views agree better on the plane moved up or down? Not where lines bound the facet on
/// most sides, nor where a half-plane and a clear interior confirm it.
fn may_be_displaced(facet: &Facet, interior: &InteriorSums) -> bool {
    let confirmed = !facet.half_planes.is_empty() && interior.is_clear();
    facet.real_ratio < THREE_SIDES && !confirmed
}

/// Least margin of a facet that lines do not bound on most sides. With a half-plane, which is
/// evidence from inside it, displaced planes must be clearly better, if the views agree by more
/// than chance.
fn least_margin(facet: &Facet, interior: &InteriorSums) -> f64 {
    match facet.half_planes.is_empty() || interior.beyond_chance() < 0.0 {
        true => 0.0,
        false => -CLEAR_MARGIN,
    }
}

/// Margin of the facet's plane over the best of some displaced ones, inside the facet, in standard
/// deviations. The planes are moved by `least_m` metres or more. `scene` has pixels about `step`
/// (metres) wide, `hidden` tells which views do not see a point of the facet. Zero without windows.
pub(super) fn displaced_plane_margin(
    scene: &Scene,
    facet: &Facet,
    step: f64,
    least_m: f64,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
) -> f64 {
    let visibility = PartVisibility::new(scene, facet, step, hidden);
    // Occluders are those of the facet itself: the facet must not occlude its own displaced plane.
    let hidden = |view: ViewId, p: &Point3<f64>| visibility.is_hidden(view, &p.xy());
    let map = interior_map(scene, facet, step, &hidden);
    let inside = InteriorWindows::of(facet, &map);
    let places: Vec<Point3<f64>> = (inside.places())
        .map(|p| facet.plane.lift(p.x, p.y))
        .collect();
    let Some(middle) = places.get(places.len() / 2) else {
        return 0.0;
    };
    let shift = larger(
        PARALLAX * step / largest_slope(scene, middle, &hidden),
        least_m,
    );
    let behind = STEPS.map(|steps| {
        let moved = Facet {
            plane: Plane {
                d: facet.plane.d - steps * shift * facet.plane.normal.z,
                ..facet.plane
            },
            ..facet.clone()
        };
        inside.advantage_of(&interior_map(scene, &moved, step, &hidden))
    });
    -behind.into_iter().fold(f64::NEG_INFINITY, larger)
}

/// Visibility of the parts of a facet in each view.
struct PartVisibility {
    parts: PlanGrid,
    /// By view, then row by row.
    hidden: Vec<Vec<bool>>,
}

impl PartVisibility {
    /// Samples one point of every part, [`PART`] cells wide.
    fn new(
        scene: &Scene,
        facet: &Facet,
        step: f64,
        hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
    ) -> Self {
        let [min, max] = facet.plan_bounds();
        let parts = PlanGrid::covering(min, max, PART * step);
        let points: Vec<Point3<f64>> = (0..parts.width * parts.height)
            .map(|k| parts.center(k % parts.width, k / parts.width))
            .map(|p| facet.plane.lift(p.x, p.y))
            .collect();
        let by_view = |v: ViewId| points.iter().map(|p| hidden(v, p)).collect();
        Self {
            parts,
            hidden: scene.view_ids().map(by_view).collect(),
        }
    }

    fn is_hidden(&self, view: ViewId, p: &Point2<f64>) -> bool {
        let part = self.parts.cell(p);
        part.is_some_and(|(c, r)| self.hidden[view.index()][r * self.parts.width + c])
    }
}

/// Largest difference of the slopes (plan over height) of the rays from a point to the views that
/// see it.
fn largest_slope(
    scene: &Scene,
    point: &Point3<f64>,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
) -> f64 {
    let sees = |v: &ViewId| {
        let camera = scene.camera(*v);
        let image = camera.project(point);
        image.is_some_and(|x| camera.contains(&x, 0.0)) && !hidden(*v, point)
    };
    let rays = scene.view_ids().filter(sees);
    let slopes: Vec<Vector2<f64>> = rays
        .map(|v| scene.camera(v).center - point)
        .map(|ray| ray.xy() / ray.z)
        .collect();
    let pairs = (slopes.iter()).flat_map(|a| slopes.iter().map(move |b| (a - b).norm()));
    pairs.fold(LEAST_SLOPE, larger)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::HalfPlaneId;
    use crate::synthetic::gable_scene;
    use crate::testing;
    use nalgebra::Vector3;

    #[test]
    fn a_roof_stands_out_and_a_plane_beside_it_does_not() {
        let (mut scene, truth) = gable_scene(320);
        let ring = &truth.facets[0].1;
        let raised = |scene: &Scene, by: f64| {
            let ring = ring.iter().map(|p| p + Vector3::z() * by);
            let facet = testing::facet(&ring.collect::<Vec<_>>());
            displaced_plane_margin(scene, &facet, 0.1, 0.0, &|_, _| false)
        };
        assert!(raised(&scene, 0.0) > 3.0);
        // Farther than the views' rays, whose slopes differ by 0.4 and more, are apart by half a
        // window of cells of 0.1 m.
        for by in [-1.25, 1.25] {
            assert!(raised(&scene, by) < -3.0, "{by}");
        }
        // Unrelated views give no margin.
        (scene.views.iter_mut().enumerate()).for_each(|(i, v)| v.gray.data.rotate_left(7919 * i));
        assert!(raised(&scene, 0.0) < 1.0);
        assert_eq!(
            displaced_plane_margin(&scene, &testing::facet(ring), 0.1, 0.0, &|_, _| true),
            0.0,
            "nobody sees it"
        );
    }

    /// A facet with so much of its outline on lines, and so many half-planes.
    fn facet(real_ratio: f64, half_planes: usize) -> Facet {
        let corners = [(0.0, 0.0), (9.0, 0.0), (9.0, 4.0)];
        Facet {
            real_ratio,
            half_planes: (0..half_planes).map(HalfPlaneId::from_index).collect(),
            ..testing::facet(&corners.map(|(x, y)| Point3::new(x, y, 5.0)))
        }
    }

    /// What a facet shows whose views correlate by so much more than by chance.
    fn inside(beyond: f64) -> InteriorSums {
        InteriorSums {
            windows: 100,
            weight: 100.0,
            correlation: 100.0 * (0.45 + beyond),
            least: 45.0,
            overall: 45.0,
            least_overall: 45.0,
        }
    }

    #[test]
    fn a_facet_that_falls_short_stays_where_it_stands_out() {
        let short = FacetRejection::Dissimilar { similarity: 0.4 };
        let bridge = FacetRejection::Bridge { similarity: 0.4 };
        let judged = |reason, sigmas: f64| {
            displaced_plane_test(Err(reason), &facet(0.9, 0), &inside(0.2), |_| sigmas)
        };
        assert_eq!(judged(short, 1.1), Ok(()));
        assert_eq!(judged(short, 0.9), Err(short));
        assert_eq!(judged(bridge, 2.0), Err(bridge), "at its two roofs");
    }

    #[test]
    fn a_facet_goes_where_its_plane_moved_farther_than_true_ones_lie_beside_their_roofs_is_better()
    {
        let judged_inside = |beyond: f64, half_planes: usize, near: f64, far: f64| {
            let by_distance = |least_m: f64| if least_m < 0.3 { near } else { far };
            let facet = facet(0.6, half_planes);
            displaced_plane_test(Ok(()), &facet, &inside(beyond), by_distance)
        };
        let judged = |half_planes, near, far| judged_inside(0.2, half_planes, near, far);
        let displaced = |sigmas| Err(FacetRejection::Displaced { sigmas });
        assert_eq!(judged(0, -2.0, 0.1), Ok(()), "as on corrugated roofs");
        assert_eq!(judged(0, 2.0, -0.1), displaced(0.1));
        assert_eq!(judged(1, 2.0, -0.9), Ok(()), "a half-plane speaks for it");
        assert_eq!(judged(1, 2.0, -1.1), displaced(1.1));
        assert_eq!(
            judged_inside(-0.2, 1, 2.0, -0.9),
            displaced(0.9),
            "by chance"
        );
    }

    #[test]
    fn a_facet_that_lines_or_its_inside_confirm_is_not_moved() {
        let (clear, faint) = (inside(0.6), inside(0.2));
        assert!(may_be_displaced(&facet(0.6, 1), &faint));
        assert!(may_be_displaced(&facet(0.6, 0), &clear), "a gap may be");
        assert!(!may_be_displaced(&facet(0.6, 1), &clear));
        assert!(
            !may_be_displaced(&facet(0.8, 0), &faint),
            "three sides of four"
        );
    }
}
