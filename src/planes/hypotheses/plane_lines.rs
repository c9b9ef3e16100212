//! New lines in a plane: image segments of several views that coincide when projected onto it.
//!
//! An eave above moving ground, or a rake in weak contrast, is often missed by line matching
//! although every view shows a segment there. Once a half-plane is known, casting each view's
//! segments onto its plane is a test that needs no correlation: segments of true lines in the plane
//! fall onto each other, those of anything above or below it are driven apart by parallax. (B99 5
//! asks to combine the single-line method with the grouping of coplanar lines; this is the cheaper
//! direction of that combination, plane first.)

use nalgebra::{Point2, Point3, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::base::geometry::{Plane, Segment3};
use crate::base::ids::ViewId;
use crate::base::line_linker::LineLinker;
use crate::base::plan_index::PlanIndex;
use crate::lines::linematch::EDGE_MARGIN_PX;
use crate::lines::lines2d::ImageSegment;
use crate::orienting::scene::Scene;
use crate::photographs::camera::{Camera, FEWEST_VIEWS};
use crate::planes::grouping::PlanRegion;

/// A line in a plane that several views show.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlaneLine {
    /// End points in the plane, metres.
    pub segment: Segment3,
    /// The views whose segments make it, ascending.
    pub views: Vec<ViewId>,
}

/// Fewer views show a line where no more than these have the place in their image, ...
const FEW: usize = 3;
/// ... those that must show it there. Measured on rendered scenes: of pairs of segments that meet
/// by chance one in four lies on a roof's edge where six views could show it, one in two where
/// three could.
const MIN_OF_FEW: usize = 2;
/// Shortest line from the only view of a place, metres. Assumption: shorter ones bound no facet.
const LEAST_SINGLE_VIEW_M: f64 = 1.0;

/// A segment cast onto the plane, in plan.
#[derive(Clone, Copy)]
struct CastSegment {
    view: ViewId,
    a: Point2<f64>,
    b: Point2<f64>,
}

impl CastSegment {
    fn ends(&self) -> [Point2<f64>; 2] {
        [self.a, self.b]
    }

    fn length(&self) -> f64 {
        (self.b - self.a).norm()
    }
}

/// Rays through the ends of every view's segments.
pub(crate) type EndRays = Vec<Vec<[Vector3<f64>; 2]>>;

/// The rays through the ends of the segments, which every plane is cut by.
pub(crate) fn rays_through_ends(scene: &Scene, segments: &[Vec<ImageSegment>]) -> EndRays {
    let of_view = |(view, list): (ViewId, &Vec<ImageSegment>)| {
        let camera = scene.camera(view);
        let rays = |s: &ImageSegment| [&s.segment.p0, &s.segment.p1].map(|p| camera.ray(p));
        list.iter().map(rays).collect()
    };
    scene.view_ids().zip(segments).map(of_view).collect()
}

/// The lines in `plane` over `region` that at least three views show, or two where no more than
/// three have the place in their image, or one view only, if the surface `ends_at` such a line;
/// `rays` are those through the ends of all segments.
pub(crate) fn lines_in_plane(
    scene: &Scene,
    rays: &EndRays,
    plane: &Plane,
    region: &PlanRegion,
    ends_at: impl Fn(&Segment3) -> bool,
) -> Vec<PlaneLine> {
    let [low, high] = region.bounds();
    let middle = Point2::from((low.coords + high.coords) * 0.5);
    let pixel = scene
        .views
        .iter()
        .map(|v| v.camera.ground_pixel(&plane.lift(middle.x, middle.y)))
        .fold(f64::INFINITY, f64::min);
    let mut casts: Vec<CastSegment> = Vec::new();
    for (view, list) in scene.view_ids().zip(rays) {
        let center = scene.camera(view).center;
        let above = -plane.signed_distance(&center);
        casts.extend(list.iter().filter_map(|[p0, p1]| {
            let cast = |ray: &Vector3<f64>| cast(&center, above, plane, ray);
            let (a, b) = (cast(p0)?, cast(p1)?);
            let inside = region.contains(&a) && region.contains(&b);
            (inside && (b - a).norm() > 1e-6).then_some(CastSegment { view, a, b })
        }));
    }
    // Longest first: it is the best known direction.
    casts.sort_by(|p, q| {
        q.length()
            .total_cmp(&p.length())
            .then(p.view.cmp(&q.view))
            .then(p.a.x.total_cmp(&q.a.x))
    });
    let index = PlanIndex::new(casts.iter().map(CastSegment::ends));
    let linker = LineLinker::cast_onto_plane(pixel);
    let mut used = vec![false; casts.len()];
    let mut found = Vec::new();
    for i in 0..casts.len() {
        if used[i] {
            continue;
        }
        let near = index.touching(casts[i].ends(), linker.apart);
        let mut members: Vec<usize> = (near.map(|j| j as usize))
            .filter(|&j| !used[j] && linker.connects(&casts[i].ends(), &casts[j].ends()))
            .collect();
        members.sort();
        let mut views: Vec<ViewId> = members.iter().map(|&j| casts[j].view).collect();
        views.sort();
        views.dedup();
        if views.len() < MIN_OF_FEW {
            let CastSegment { a, b, .. } = casts[i];
            let line = Segment3::new(plane.lift(a.x, a.y), plane.lift(b.x, b.y));
            let only_view_ends = || views_containing(scene, &line.at(0.5)) == 1 && ends_at(&line);
            if line.length() >= LEAST_SINGLE_VIEW_M && only_view_ends() {
                used[i] = true;
                found.push(PlaneLine {
                    segment: line,
                    views,
                });
            }
            continue;
        }
        let shown: Vec<CastSegment> = members.iter().map(|&j| casts[j]).collect();
        let line = common_line(&shown, |p| views_containing(scene, &plane.lift(p.x, p.y)));
        let few = |(a, b): &(Point2<f64>, Point2<f64>)| {
            let middle = nalgebra::center(a, b);
            views_containing(scene, &plane.lift(middle.x, middle.y)) <= FEW
        };
        if views.len() < FEWEST_VIEWS && !line.as_ref().is_some_and(few) {
            continue;
        }
        members.iter().for_each(|&j| used[j] = true);
        if let Some((a, b)) = line {
            found.push(PlaneLine {
                segment: Segment3::new(plane.lift(a.x, a.y), plane.lift(b.x, b.y)),
                views,
            });
        }
    }
    found
}

/// How many views have a point in their image, with what is around it.
fn views_containing(scene: &Scene, point: &Point3<f64>) -> usize {
    let has = |camera: &Camera| {
        (camera.project(point)).is_some_and(|p| camera.contains(&p, EDGE_MARGIN_PX))
    };
    scene.views.iter().filter(|v| has(&v.camera)).count()
}

/// Where a ray from a centre meets the plane, in plan; `above` is minus the centre's signed
/// distance from it.
fn cast(
    center: &Point3<f64>,
    above: f64,
    plane: &Plane,
    ray: &Vector3<f64>,
) -> Option<Point2<f64>> {
    let t = above / plane.normal.dot(ray);
    (t.is_finite() && t > 0.0).then(|| (center + ray * t).xy())
}

/// Length-weighted mean line of the casts. It reaches as far as at least two views do, and as far
/// as one where fewer than two have the place in their image; `views_at` counts those.
fn common_line(
    members: &[CastSegment],
    views_at: impl Fn(&Point2<f64>) -> usize,
) -> Option<(Point2<f64>, Point2<f64>)> {
    let weight: f64 = members.iter().map(CastSegment::length).sum();
    let direction = members
        .iter()
        .fold(Vector2::zeros(), |s, c| s + (c.b - c.a));
    let direction = direction / direction.norm();
    let mean = members.iter().fold(Vector2::zeros(), |s, c| {
        s + (c.a.coords + c.b.coords) * (0.5 * c.length())
    }) / weight;
    let mut ends: Vec<(f64, ViewId, i32)> = Vec::new();
    for c in members {
        ends.push(((c.a.coords - mean).dot(&direction), c.view, 1));
        ends.push(((c.b.coords - mean).dot(&direction), c.view, -1));
    }
    ends.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    let outermost = [ends.first()?.0, ends.last()?.0];
    // Open stretches per view, to count views rather than segments.
    let mut open: std::collections::BTreeMap<ViewId, i32> = std::collections::BTreeMap::new();
    let (mut start, mut end) = (None, None);
    for (t, view, step) in ends {
        let before = open.values().filter(|&&n| n > 0).count();
        *open.entry(view).or_default() += step;
        let after = open.values().filter(|&&n| n > 0).count();
        if before < 2 && after >= 2 && start.is_none() {
            start = Some(t);
        }
        if before >= 2 && after < 2 {
            end = Some(t);
        }
    }
    let at = |t: f64| Point2::from(mean + direction * t);
    let reach = |common: f64, outermost: f64| match views_at(&at(0.5 * (common + outermost))) {
        0 | 1 => at(outermost),
        _ => at(common),
    };
    Some((reach(start?, outermost[0]), reach(end?, outermost[1])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planes::rendered_planes;
    use crate::roofs::testing::line;
    use nalgebra::Point3;

    /// A level plane at 6 m with the box of 10 m around the origin that it may cover.
    fn plane_and_region() -> (Plane, PlanRegion) {
        let plane =
            Plane::from_point_normal(&Point3::new(0.0, 0.0, 6.0), &Vector3::z()).expect("upright");
        let ridge = line(Point3::new(-9.0, 0.0, 6.0), Point3::new(9.0, 0.0, 6.0));
        (plane, crate::planes::grouping::region_beside(ridge, plane))
    }

    /// The rays that views have through the ends of the parts of 3D lines that they show.
    fn rays(scene: &Scene, shown: &[&[[[f64; 3]; 2]]]) -> EndRays {
        let views = scene.views.iter().zip(shown);
        let of_view = |(view, lines): (&crate::orienting::scene::View, &&[[[f64; 3]; 2]])| {
            let ray = |p: [f64; 3]| {
                view.camera
                    .ray(&view.camera.project(&Point3::from(p)).unwrap())
            };
            lines.iter().map(|ends| ends.map(ray)).collect()
        };
        views.map(of_view).collect()
    }

    /// A line in the plane, and another a metre above it that no two views cast onto the same
    /// place.
    const IN_PLANE: [[f64; 3]; 2] = [[-4.0, 2.0, 6.0], [3.0, 2.5, 6.0]];
    const ABOVE: [[f64; 3]; 2] = [[-3.0, -4.0, 7.0], [2.0, 3.0, 7.0]];

    fn found(scene: &Scene, shown: &[&[[[f64; 3]; 2]]]) -> Vec<PlaneLine> {
        let (plane, region) = plane_and_region();
        lines_in_plane(scene, &rays(scene, shown), &plane, &region, |_| false)
    }

    fn is_from_to(line: &PlaneLine, from: [f64; 3], to: [f64; 3]) -> bool {
        let near = |p: &Point3<f64>, q: [f64; 3]| (p - Point3::from(q)).norm() < 0.01;
        near(&line.segment.p0, from) && near(&line.segment.p1, to)
    }

    #[test]
    fn segments_that_coincide_in_the_plane_make_a_line_and_those_above_it_do_not() {
        let scene = rendered_planes::scene(&[]);
        let both: &[_] = &[IN_PLANE, ABOVE];
        let lines = found(&scene, &[both; 4]);
        assert_eq!(lines.len(), 1);
        assert!(is_from_to(&lines[0], IN_PLANE[0], IN_PLANE[1]));
        assert_eq!(lines[0].views, scene.view_ids().collect::<Vec<_>>());
        let [from, to] = IN_PLANE;
        let turned = [to, from];
        let opposite: &[_] = &[turned];
        let lines = found(&scene, &[both, both, opposite, &[]]);
        assert!(
            lines.is_empty(),
            "dark and bright sides of two views only agree"
        );
    }

    #[test]
    fn two_views_are_enough_where_three_could_show_the_line() {
        let mut scene = rendered_planes::scene(&[]);
        let one: &[_] = &[IN_PLANE];
        assert!(
            found(&scene, &[one, &[], one, &[]]).is_empty(),
            "two of four"
        );
        scene.views.pop();
        assert_eq!(found(&scene, &[one, &[], one]).len(), 1, "two of three");
        assert!(found(&scene, &[one, &[], &[]]).is_empty(), "one of three");
        let above: &[_] = &[ABOVE];
        assert!(
            found(&scene, &[above, &[], above]).is_empty(),
            "not in the plane"
        );
    }

    #[test]
    fn the_only_view_shows_a_line_where_the_surface_ends() {
        let mut scene = rendered_planes::scene(&[]);
        let (plane, region) = plane_and_region();
        let one: &[_] = &[IN_PLANE];
        let found = |scene: &Scene, ends: bool| {
            let shown = rays(scene, &[one, &[]]);
            lines_in_plane(scene, &shown, &plane, &region, |_| ends)
        };
        scene.views.truncate(2);
        assert!(found(&scene, true).is_empty(), "the other view has none");
        scene.views.truncate(1);
        assert!(found(&scene, false).is_empty(), "a row of tiles");
        let lines = found(&scene, true);
        assert_eq!(lines.len(), 1);
        assert!(is_from_to(&lines[0], IN_PLANE[0], IN_PLANE[1]));
    }

    #[test]
    fn a_line_reaches_as_far_as_two_views_show_it_or_the_only_one_that_could() {
        let mut scene = rendered_planes::scene(&[]);
        scene.views.truncate(2);
        let [from, to] = IN_PLANE;
        let middle: [f64; 3] = std::array::from_fn(|i| 0.5 * (from[i] + to[i]));
        let (whole, half): (&[_], &[_]) = (&[[from, to]], &[[from, middle]]);
        let lines = found(&scene, &[whole, half]);
        assert!(is_from_to(&lines[0], from, middle));
        // Beyond the middle nothing of the second image is left.
        let camera = &mut scene.views[1].camera;
        let end = camera.project(&Point3::from(middle)).expect("in front");
        camera.width = end.x.ceil() as u32;
        let lines = found(&scene, &[whole, half]);
        assert!(is_from_to(&lines[0], from, to), "{:?}", lines[0]);
    }
}
