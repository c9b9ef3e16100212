//! New lines in a plane: image segments of several views that coincide when cast onto it.
//!
//! An eave above moving ground, or a rake in weak contrast, is often missed by line matching although every
//! view shows a segment there. Once a half-plane is known, casting each view's segments onto its plane is a
//! test that needs no correlation: segments of true lines in the plane fall onto each other, those of anything
//! above or below it are driven apart by parallax. (B99 5 asks to combine the single-line method with the
//! grouping of coplanar lines; this is the cheaper direction of that combination, plane first.)

use nalgebra::{Point2, Point3, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use super::region::Region;
use crate::geometry::{Plane, Segment3};
use crate::ids::ViewId;
use crate::lines2d::ImageSegment;
use crate::scene::Scene;
use crate::sorting::sort_by;

/// A line in a plane that several views show.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaneLine {
    /// End points in the plane, metres.
    pub segment: Segment3,
    /// The views whose segments make it, ascending.
    pub views: Vec<ViewId>,
}

/// Views that must show a line.
const MIN_VIEWS: usize = 3;
/// Segments cast onto the plane belong to one line within this many ground pixels, ...
const SAME_LINE_PX: f64 = 1.5;
/// ... and this sine of the angle.
const SAME_LINE_SINE: f64 = 0.06;

/// A segment cast onto the plane, in plan.
#[derive(Clone, Copy)]
struct Cast {
    view: ViewId,
    a: Point2<f64>,
    b: Point2<f64>,
}

impl Cast {
    fn length(&self) -> f64 {
        (self.b - self.a).norm()
    }
}

/// Rays through the ends of every view's segments.
pub type EndRays = Vec<Vec<[Vector3<f64>; 2]>>;

/// The rays through the ends of the segments, which every plane is cut by.
pub fn rays_through_ends(scene: &Scene, segments: &[Vec<ImageSegment>]) -> EndRays {
    let of_view = |(view, list): (ViewId, &Vec<ImageSegment>)| {
        let camera = scene.camera(view);
        let rays = |s: &ImageSegment| [&s.segment.p0, &s.segment.p1].map(|p| camera.ray(p));
        list.iter().map(rays).collect()
    };
    scene.view_ids().zip(segments).map(of_view).collect()
}

/// The lines in `plane` over `region` that at least three views show; `rays` are those through the ends of all segments.
pub fn lines_in_plane(
    scene: &Scene,
    rays: &EndRays,
    plane: &Plane,
    region: &Region,
) -> Vec<PlaneLine> {
    let [low, high] = region.bounds();
    let middle = Point2::from((low.coords + high.coords) * 0.5);
    let pixel = scene
        .views
        .iter()
        .map(|v| v.camera.ground_pixel(&plane.lift(middle.x, middle.y)))
        .fold(f64::INFINITY, f64::min);
    let mut casts: Vec<Cast> = Vec::new();
    for (view, list) in scene.view_ids().zip(rays) {
        let center = scene.camera(view).center;
        let above = -plane.signed_distance(&center);
        casts.extend(list.iter().filter_map(|[p0, p1]| {
            let cast = |ray: &Vector3<f64>| cast(&center, above, plane, ray);
            let (a, b) = (cast(p0)?, cast(p1)?);
            let inside = region.contains(&a) && region.contains(&b);
            (inside && (b - a).norm() > 1e-6).then_some(Cast { view, a, b })
        }));
    }
    // Longest first: it is the best known direction.
    sort_by(&mut casts, |p, q| {
        q.length()
            .total_cmp(&p.length())
            .then(p.view.cmp(&q.view))
            .then(p.a.x.total_cmp(&q.a.x))
    });
    let mut used = vec![false; casts.len()];
    let mut found = Vec::new();
    for i in 0..casts.len() {
        if used[i] {
            continue;
        }
        let members: Vec<usize> = (0..casts.len())
            .filter(|&j| !used[j] && coincide(&casts[i], &casts[j], SAME_LINE_PX * pixel))
            .collect();
        let mut views: Vec<ViewId> = members.iter().map(|&j| casts[j].view).collect();
        sort_by(&mut views, Ord::cmp);
        views.dedup();
        if views.len() < MIN_VIEWS {
            continue;
        }
        members.iter().for_each(|&j| used[j] = true);
        let members: Vec<Cast> = members.into_iter().map(|j| casts[j]).collect();
        if let Some((a, b)) = common_line(&members) {
            found.push(PlaneLine {
                segment: Segment3::new(plane.lift(a.x, a.y), plane.lift(b.x, b.y)),
                views,
            });
        }
    }
    found
}

/// Where a ray from a centre meets the plane, in plan; `above` is minus the centre's signed distance from it.
fn cast(
    center: &Point3<f64>,
    above: f64,
    plane: &Plane,
    ray: &Vector3<f64>,
) -> Option<Point2<f64>> {
    let t = above / plane.normal.dot(ray);
    (t.is_finite() && t > 0.0).then(|| (center + ray * t).xy())
}

/// Same direction (by contrast too), same line, overlapping.
fn coincide(reference: &Cast, other: &Cast, tolerance: f64) -> bool {
    let d = (reference.b - reference.a) / reference.length();
    let e = (other.b - other.a) / other.length();
    if d.dot(&e) < 0.0 || d.perp(&e).abs() > SAME_LINE_SINE {
        return false;
    }
    let offset = |p: &Point2<f64>| d.perp(&(p - reference.a)).abs();
    let along = |p: &Point2<f64>| (p - reference.a).dot(&d);
    let overlap = along(&other.b).min(reference.length()) - along(&other.a).max(0.0);
    offset(&other.a) <= tolerance && offset(&other.b) <= tolerance && overlap > 0.3 * other.length()
}

/// Length-weighted mean line of the casts; it reaches as far as at least two views do.
fn common_line(members: &[Cast]) -> Option<(Point2<f64>, Point2<f64>)> {
    let weight: f64 = members.iter().map(Cast::length).sum();
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
    sort_by(&mut ends, |p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
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
    Some((at(start?), at(end?)))
}
