//! Occlusion by roofs: is there one between a point and a camera?

use nalgebra::{Point2, Point3};

use super::roof_model::Facet;

/// A roof hides what lies deeper below it, metres: a point must not be occluded by its own facet,
/// nor by a neighbour known to a few decimetres only.
const LEAST_DEPTH_M: f64 = 0.3;
/// Step along the ray in plan, metres: finer than any roof.
const STEP_M: f64 = 0.4;

/// The roofs of a model as seen by rays that go up.
pub struct Occluders<'a> {
    roofs: Vec<(&'a Facet, [Point2<f64>; 2])>,
    highest: f64,
}

impl<'a> Occluders<'a> {
    /// For these facets.
    pub fn new(facets: &'a [Facet]) -> Self {
        let with_bounds = |f: &'a Facet| (f, f.plan_bounds());
        let corners = facets.iter().flat_map(|f| &f.outer);
        Self {
            roofs: facets.iter().map(with_bounds).collect(),
            highest: corners.fold(f64::MIN, |h, p| h.max(p.z)),
        }
    }

    /// Does a roof, or a wall below it, stand between the point and the camera?
    pub fn hide(&self, point: &Point3<f64>, center: &Point3<f64>) -> bool {
        self.places(point, center).any(|p| self.covers(&p))
    }

    /// The same where walls stand back below their eaves: a ray may pass under a roof for
    /// `overhang_m` in plan, but through none.
    pub fn hide_past_eaves(
        &self,
        point: &Point3<f64>,
        center: &Point3<f64>,
        overhang_m: f64,
    ) -> bool {
        let mut below = 0;
        self.places(point, center).any(|p| {
            if self.covers(&p) {
                below += 1;
                return below as f64 * STEP_M > overhang_m;
            }
            let through = below > 0 && self.roofs_at(&p.xy()).next().is_some();
            below = 0;
            through
        })
    }

    /// Places along the ray from a point to a camera, up to the height of the highest roof.
    fn places(
        &self,
        point: &Point3<f64>,
        center: &Point3<f64>,
    ) -> impl Iterator<Item = Point3<f64>> + use<> {
        let (point, ray) = (*point, center - point);
        let is_above_all = ray.z <= 0.0 || self.highest <= point.z + LEAST_DEPTH_M;
        let end = match is_above_all {
            true => 0.0,
            false => ((self.highest - point.z) / ray.z).min(1.0),
        };
        let steps = (ray.xy().norm() * end / STEP_M).ceil() as usize;
        (1..=steps).map(move |i| point + ray * (end * i as f64 / steps as f64))
    }

    /// Is the point inside or below a roof?
    fn covers(&self, p: &Point3<f64>) -> bool {
        let q = p.xy();
        let mut roofs = self.roofs_at(&q);
        roofs.any(|f| f.plane.z_at(q.x, q.y) - p.z > LEAST_DEPTH_M)
    }

    /// Height of the highest roof over a plan position, metres.
    pub fn top_at(&self, p: &Point2<f64>) -> Option<f64> {
        let heights = self.roofs_at(p).map(|f| f.plane.z_at(p.x, p.y));
        heights.reduce(f64::max)
    }

    /// The facets over a plan position.
    fn roofs_at<'s>(&'s self, p: &'s Point2<f64>) -> impl Iterator<Item = &'a Facet> + 's {
        let near = |[low, high]: &[Point2<f64>; 2]| {
            p.x >= low.x && p.y >= low.y && p.x <= high.x && p.y <= high.y
        };
        let roofs = self.roofs.iter().filter(move |(_, bounds)| near(bounds));
        roofs.map(|(f, _)| *f).filter(|f| inside(&f.outer, p))
    }
}

/// Is a plan position inside a ring (even-odd rule)?
pub(crate) fn inside(ring: &[Point3<f64>], p: &Point2<f64>) -> bool {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).fold(false, |odd, (a, b)| {
        let crosses =
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y);
        odd != crosses
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::buildings::gable;

    #[test]
    fn a_roof_hides_what_lies_behind_and_below() {
        let roof = gable();
        let occluders = Occluders::new(&roof);
        let south = Point3::new(0.0, -1000.0, 1000.0);
        // The gable reaches from y = -4 to 4, eaves at 6 m, ridge at 9 m; rays rise by a metre for
        // a metre.
        assert!(occluders.hide(&Point3::new(0.0, 5.0, 3.0), &south));
        assert!(!occluders.hide(&Point3::new(0.0, 9.0, 3.0), &south));
        assert!(!occluders.hide(&Point3::new(0.0, -6.0, 3.0), &south));
        assert!(!occluders.hide(&Point3::new(0.0, 0.0, 9.0), &south));
    }

    #[test]
    fn a_wall_below_an_eave_is_seen_past_it_but_not_the_inside() {
        let roof = gable();
        let occluders = Occluders::new(&roof);
        let south = Point3::new(0.0, -1000.0, 1000.0);
        let hide =
            |y, z, overhang| occluders.hide_past_eaves(&Point3::new(0.0, y, z), &south, overhang);
        // The wall stands back by 0.7 m below the eave at y = -4: one step of the ray is below the
        // roof.
        assert!(occluders.hide(&Point3::new(0.0, -3.3, 1.0), &south));
        assert!(!hide(-3.3, 1.0, 0.8) && hide(-3.3, 1.0, 0.2));
        assert!(hide(-1.0, 3.0, 0.8), "3 m to the wall");
        assert!(hide(0.5, 7.9, 0.8), "through the other side of the roof");
        assert!(hide(5.0, 3.0, 0.8), "behind the house");
        assert!(!hide(-6.0, 3.0, 0.8) && !hide(0.0, 9.0, 0.8));
    }
}
