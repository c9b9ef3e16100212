//! Occlusion by roofs: is there one between a point and a camera?

use nalgebra::{Point2, Point3};

use super::roof_model::Facet;
use crate::base::geometry::{contains, plan_sides};

/// A roof hides what lies deeper below it, metres: a point must not be occluded by its own facet,
/// nor by a neighbour known to a few decimetres only.
const LEAST_DEPTH_M: f64 = 0.3;
/// Step along the ray in plan, metres: finer than any roof.
const STEP_M: f64 = 0.4;

/// The roofs of a model as seen by rays that go up.
pub struct Occluders<'a> {
    roofs: Vec<Roof<'a>>,
    highest: f64,
}

impl<'a> Occluders<'a> {
    /// For these facets.
    pub fn new(facets: &'a [Facet]) -> Self {
        let corners = facets.iter().flat_map(|f| &f.outer);
        Self {
            roofs: facets.iter().map(Roof::new).collect(),
            highest: corners.fold(f64::MIN, |h, p| h.max(p.z)),
        }
    }

    /// Does a roof, or a wall below it, stand between the point and the camera?
    pub fn hide(&self, point: &Point3<f64>, center: &Point3<f64>) -> bool {
        let places = self.places(point, center);
        let (Some(first), Some(last)) = (places.clone().next(), places.clone().next_back()) else {
            return false;
        };
        let mut above = self.roofs.iter().filter(|r| r.is_above(&first, &last));
        above.any(|roof| places.clone().any(|p| roof.covers(&p)))
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
    ) -> impl DoubleEndedIterator<Item = Point3<f64>> + Clone + use<> {
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
        self.roofs.iter().any(|roof| roof.covers(p))
    }

    /// Height of the highest roof over a plan position, metres.
    pub fn top_at(&self, p: &Point2<f64>) -> Option<f64> {
        let heights = self.roofs_at(p).map(|f| f.plane.z_at(p.x, p.y));
        heights.reduce(f64::max)
    }

    /// The facets over a plan position.
    fn roofs_at<'s>(&'s self, p: &'s Point2<f64>) -> impl Iterator<Item = &'a Facet> + 's {
        let roofs = self.roofs.iter().filter(|roof| roof.is_over(p));
        roofs.map(|roof| roof.facet)
    }
}

/// A roof, with its outline by rows, since a ray is compared with it at many places.
struct Roof<'a> {
    facet: &'a Facet,
    low: Point2<f64>,
    high: Point2<f64>,
    /// No place of it is higher, metres.
    top: f64,
    /// The sides that pass through each row of [`ROW_M`] from the lowest y.
    rows: Vec<Vec<[Point2<f64>; 2]>>,
}

/// Height of a row in plan, metres: a few sides of an outline pass through one.
const ROW_M: f64 = 0.5;
/// More rows than any roof's.
const MOST_ROWS: f64 = 4096.0;

impl<'a> Roof<'a> {
    fn new(facet: &'a Facet) -> Self {
        let [low, high] = facet.plan_bounds();
        let corners = [low, high].map(|x| [low, high].map(|y| facet.plane.z_at(x.x, y.y)));
        let tops = corners.into_iter().flatten();
        let mut roof = Self {
            facet,
            low,
            high,
            // More by what rounding may add.
            top: tops.fold(f64::MIN, f64::max) + 1e-6,
            rows: Vec::new(),
        };
        roof.rows.resize(roof.row(high.y) + 1, Vec::new());
        for [a, b] in plan_sides(&facet.outer) {
            for row in roof.row(a.y.min(b.y))..=roof.row(a.y.max(b.y)) {
                roof.rows[row].push([a, b]);
            }
        }
        roof
    }

    fn row(&self, y: f64) -> usize {
        ((y - self.low.y) / ROW_M).min(MOST_ROWS) as usize
    }

    /// May it cover a place between two?
    fn is_above(&self, first: &Point3<f64>, last: &Point3<f64>) -> bool {
        let is_beside = |i: usize| {
            first[i].min(last[i]) <= self.high[i] && first[i].max(last[i]) >= self.low[i]
        };
        is_beside(0) && is_beside(1) && self.top - first.z.min(last.z) > LEAST_DEPTH_M
    }

    /// Is a place inside or below it?
    fn covers(&self, p: &Point3<f64>) -> bool {
        let depth = || self.facet.plane.z_at(p.x, p.y) - p.z;
        self.has_in_bounds(&p.xy()) && depth() > LEAST_DEPTH_M && self.is_over(&p.xy())
    }

    fn has_in_bounds(&self, p: &Point2<f64>) -> bool {
        p.x >= self.low.x && p.y >= self.low.y && p.x <= self.high.x && p.y <= self.high.y
    }

    /// Does it lie over a plan position?
    fn is_over(&self, p: &Point2<f64>) -> bool {
        self.has_in_bounds(p) && contains(self.rows[self.row(p.y)].iter().copied(), p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::buildings::gable;

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

    #[test]
    fn a_ray_is_hidden_where_any_roof_is_over_any_place_of_it() {
        let mut next = crate::roofs::testing::uniform(11);
        let mut draw = |low: f64, high: f64| low + (high - low) * next();
        let shape = [
            [0.0, 0.0],
            [9.0, 1.2],
            [8.0, 4.3],
            [4.0, 3.1],
            [3.5, 8.4],
            [-1.0, 7.3],
        ];
        let roofs: Vec<Facet> = (0..12)
            .map(|_| {
                let (x, y, z) = (draw(-20.0, 20.0), draw(-20.0, 20.0), draw(3.0, 9.0));
                let slopes = [draw(-0.8, 0.8), draw(-0.8, 0.8)];
                let lift =
                    |[u, v]: [f64; 2]| Point3::new(x + u, y + v, z + u * slopes[0] + v * slopes[1]);
                crate::roofs::testing::facet(&shape.map(lift))
            })
            .collect();
        let occluders = Occluders::new(&roofs);
        let covers = |f: &Facet, p: &Point3<f64>| {
            contains(plan_sides(&f.outer), &p.xy()) && f.plane.z_at(p.x, p.y) - p.z > LEAST_DEPTH_M
        };
        let mut hidden = 0;
        for _ in 0..2000 {
            let point = Point3::new(draw(-25.0, 25.0), draw(-25.0, 25.0), draw(0.0, 9.0));
            let center = Point3::new(draw(-90.0, 90.0), draw(-90.0, 90.0), draw(0.0, 80.0));
            let mut places = occluders.places(&point, &center);
            let expected = places.any(|p| roofs.iter().any(|f| covers(f, &p)));
            assert_eq!(
                occluders.hide(&point, &center),
                expected,
                "{point} {center}"
            );
            hidden += u32::from(expected);
        }
        assert!((200..1800).contains(&hidden), "{hidden}");
    }
}
