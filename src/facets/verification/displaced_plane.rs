//! How a facet stands out from its plane moved up and down: the sweep of B99 4.1 once more, of heights instead of angles,
//! and over the whole facet at once.
//!
//! What views correlate by chance depends on the place: on its texture, its shading, what grows there. The moved plane shows the same place with
//! the same chances, so that no limit need be known: a roof is where the views agree better than above and below it. Pooled
//! over a facet this tells weak texture from none, and a slope between two roofs from a roof.

use nalgebra::{Point2, Point3, Vector2};

use super::interior::{Inside, Interior, map_inside};
use super::rejection::FacetRejection;
use crate::geometry::Plane;
use crate::ids::ViewId;
use crate::math::larger;
use crate::model::Facet;
use crate::photoconsistency::PlanGrid;
use crate::scene::Scene;

/// Standard deviations by which a facet stands out from its plane moved up and down that show it, though it falls short of a limit. Measured on
/// rendered scenes: true facets that do have 1.1 and more, false ones less than 0.5.
pub const PROMINENT: f64 = 1.0;
/// Share of its outline on lines from which on a facet is bounded by them on three sides of four: a level roof beside a higher wall, which shades it and hides it
/// from half of the views, stands out little.
const THREE_SIDES: f64 = 0.75;
/// How far the plane of a true roof may lie beside it, metres. Measured: 0.2 on a corrugated roof of real-barns.
const WRONG_BY: f64 = 0.25;
/// Least parallax between the two views farthest apart by which the plane is moved, cells: half a window. Rendered scenes give the same models
/// from 4 to 5.
const PARALLAX: f64 = 5.0;
/// How far the plane is moved, in such steps.
const STEPS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];
/// Side of the parts of a facet that are seen or not as a whole, cells: half a window.
const PART: f64 = 5.0;
/// Least difference of two rays' slopes for a parallax. Assumption: that of neighbours in a strip of normal-angle photographs is 0.3.
const LEAST_SLOPE: f64 = 0.1;

/// Does a facet stay, if `agreed` is what the images say of it by themselves, and by so many standard deviations they agree better on it than on its
/// plane moved by at least so many metres? One that falls short stays where it stands out, and goes where others are better.
pub fn stands_out(
    agreed: Result<(), FacetRejection>,
    facet: &Facet,
    interior: &Interior,
    prominence: impl Fn(f64) -> f64,
) -> Result<(), FacetRejection> {
    // A bridge stands out where it touches the two roofs.
    let is_bridge = matches!(agreed, Err(FacetRejection::Bridge { .. }));
    if agreed.is_err() && (is_bridge || prominence(0.0) < PROMINENT) {
        return agreed;
    }
    if may_be_displaced(facet, interior) {
        let sigmas = prominence(2.0 * WRONG_BY);
        if sigmas < least_prominence(facet, interior) {
            return Err(FacetRejection::Displaced { sigmas: -sigmas });
        }
    }
    Ok(())
}

/// Might the views agree better on the plane moved up or down? Not where lines bound the facet on most sides, nor where a half-plane and a clear inside
/// say that they do not.
fn may_be_displaced(facet: &Facet, interior: &Interior) -> bool {
    let confirmed = !facet.half_planes.is_empty() && interior.is_clear();
    facet.real_ratio < THREE_SIDES && !confirmed
}

/// The least that a facet not bounded by lines on most sides must stand out by. With a half-plane, which is evidence from inside it, others must be
/// clearly better, if the views agree by more than chance.
fn least_prominence(facet: &Facet, interior: &Interior) -> f64 {
    match facet.half_planes.is_empty() || interior.beyond_chance() < 0.0 {
        true => 0.0,
        false => -PROMINENT,
    }
}

/// By how many standard deviations the views agree better on the facet's plane than on the one of some moved ones that they agree on best, inside the facet. The planes are
/// moved by `least_m` metres or more. `scene` has pixels about `step` (metres) wide, `hidden` says which views do not see a point of the facet.
/// Zero where no window tells.
pub fn prominence(
    scene: &Scene,
    facet: &Facet,
    step: f64,
    least_m: f64,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
) -> f64 {
    let sight = Sight::new(scene, facet, step, hidden);
    // What stands in front of the facet does so of the moved one, and the facet itself is in nobody's way.
    let hidden = |view: ViewId, p: &Point3<f64>| sight.is_hidden(view, &p.xy());
    let map = map_inside(scene, facet, step, &hidden);
    let inside = Inside::of(facet, &map);
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
        inside.advantage_of(&map_inside(scene, &moved, step, &hidden))
    });
    -behind.into_iter().fold(f64::NEG_INFINITY, larger)
}

/// Which views do not see the parts of a facet.
struct Sight {
    parts: PlanGrid,
    /// By view, then row by row.
    hidden: Vec<Vec<bool>>,
}

impl Sight {
    /// Asks for one point of every part, [`PART`] cells wide.
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

/// Largest difference of the slopes (plan over height) of the rays from a point to the views that see it.
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
            prominence(scene, &facet, 0.1, 0.0, &|_, _| false)
        };
        assert!(raised(&scene, 0.0) > 3.0);
        // Farther than the views' rays, whose slopes differ by 0.4 and more, are apart by half a window of cells of 0.1 m.
        for by in [-1.25, 1.25] {
            assert!(raised(&scene, by) < -3.0, "{by}");
        }
        // Views of something else have nothing to say.
        (scene.views.iter_mut().enumerate()).for_each(|(i, v)| v.gray.data.rotate_left(7919 * i));
        assert!(raised(&scene, 0.0) < 1.0);
        assert_eq!(
            prominence(&scene, &testing::facet(ring), 0.1, 0.0, &|_, _| true),
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
    fn inside(beyond: f64) -> Interior {
        Interior {
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
        let judged =
            |reason, sigmas: f64| stands_out(Err(reason), &facet(0.9, 0), &inside(0.2), |_| sigmas);
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
            stands_out(Ok(()), &facet, &inside(beyond), by_distance)
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
