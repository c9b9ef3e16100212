//! What hides a plane from a camera: the buildings below planes that were found already.
//!
//! W96 demands lines in all images and finds that "too restrictive, due to possible occlusion". A
//! low annex beside a tall house is hidden from every second image, and its correlation is then
//! that of the house's roof with its own. Planes of the first selection are therefore taken for
//! solids down to the ground, and the planes beside them are measured again where these leave them
//! visible.

use nalgebra::{Point2, Point3};

use crate::base::geometry::{Plane, mean_point, sides};
use crate::base::math::{larger, smaller};
use crate::orienting::scene::Scene;

/// A solid below a convex roof plane.
#[derive(Clone, Debug)]
pub(crate) struct OccludingSolid {
    /// Outline in plan, counter-clockwise.
    ring: Vec<Point2<f64>>,
    plane: Plane,
}

/// A ray enters a solid only below this depth, metres: roofs that touch do not hide each other.
const LEAST_DEPTH_M: f64 = 0.15;

/// Roofs stand above a plane from this height on, metres. Assumption: more than a plane beside a
/// true one is away.
const LEAST_HEIGHT_M: f64 = 1.0;

/// Do solids stand in front of some of a polygon in some views, and leave all of it visible in two
/// at least?
pub(crate) fn partly_hidden(
    scene: &Scene,
    solids: &[OccludingSolid],
    ring: &[Point3<f64>],
) -> bool {
    let middle = mean_point(ring);
    // Not the corners themselves, which may touch a neighbour.
    let inside = ring.iter().map(|p| p + (middle - p) * 0.2).chain([middle]);
    let hidden = |p: Point3<f64>| {
        let centers = scene.views.iter().map(|v| v.camera.center);
        centers
            .filter(|c| solids.iter().any(|s| s.hides(&p, c)))
            .count()
    };
    let counts: Vec<usize> = inside.map(hidden).collect();
    counts.iter().any(|&n| n > 0) && counts.iter().all(|&n| n + 2 <= scene.views.len())
}

impl OccludingSolid {
    /// Below a ring that runs counter-clockwise seen from above.
    pub(crate) fn new(plane: &Plane, ring: &[Point3<f64>]) -> Self {
        Self {
            ring: ring.iter().map(|p| p.xy()).collect(),
            plane: *plane,
        }
    }

    /// Does its roof stand well above a plane? Others hide none of it.
    pub(crate) fn stands_above(&self, plane: &Plane) -> bool {
        let m = mean_point(&self.ring);
        self.plane.lift(m.x, m.y).z - plane.lift(m.x, m.y).z > LEAST_HEIGHT_M
    }

    /// Does it stand between a point and a camera above?
    pub(crate) fn hides(&self, point: &Point3<f64>, center: &Point3<f64>) -> bool {
        let Some(range) = self.crossed(&point.xy(), &center.xy()) else {
            return false;
        };
        range.iter().any(|&t| {
            let p = point + (center - point) * t;
            self.plane.lift(p.x, p.y).z - p.z > LEAST_DEPTH_M
        })
    }

    /// The part of the way from `p` (0) to `q` (1) that runs over the outline.
    fn crossed(&self, p: &Point2<f64>, q: &Point2<f64>) -> Option<[f64; 2]> {
        let (mut enter, mut leave) = (0.0f64, 1.0f64);
        for [a, b] in sides(&self.ring) {
            let (dp, dq) = (side(&a, &b, p), side(&a, &b, q));
            if dp < 0.0 && dq < 0.0 {
                return None;
            }
            let t = dp / (dp - dq);
            if dp < 0.0 {
                enter = larger(enter, t);
            } else if dq < 0.0 {
                leave = smaller(leave, t);
            }
        }
        (enter < leave).then_some([enter, leave])
    }
}

/// Positive to the left of the line from `a` to `b`.
fn side(a: &Point2<f64>, b: &Point2<f64>, p: &Point2<f64>) -> f64 {
    (b - a).perp(&(p - a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// A flat roof of 4 m by 4 m, 10 m high.
    fn tower() -> OccludingSolid {
        let ring =
            [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(|[x, y]| Point3::new(x, y, 10.0));
        let plane = Plane::from_point_normal(&ring[0], &Vector3::z()).unwrap();
        OccludingSolid::new(&plane, &ring)
    }

    #[test]
    fn a_tower_hides_what_is_behind_it_and_low() {
        let camera = Point3::new(-100.0, 2.0, 100.0);
        // The ray towards the camera rises by 45 degrees and crosses the far wall after x - 4
        // metres.
        assert!(tower().hides(&Point3::new(6.0, 2.0, 3.0), &camera));
        assert!(!tower().hides(&Point3::new(6.0, 2.0, 8.5), &camera));
        assert!(!tower().hides(&Point3::new(-2.0, 2.0, 3.0), &camera));
        assert!(!tower().hides(&Point3::new(6.0, 9.0, 3.0), &camera));
    }

    #[test]
    fn roofs_that_touch_do_not_hide_each_other() {
        let camera = Point3::new(-100.0, 2.0, 100.0);
        assert!(!tower().hides(&Point3::new(4.0, 2.0, 10.0), &camera));
        let roof = tower().plane;
        assert!(!tower().stands_above(&roof));
        let low = Plane {
            d: roof.d + 3.0,
            ..roof
        };
        assert!(tower().stands_above(&low));
    }
}
