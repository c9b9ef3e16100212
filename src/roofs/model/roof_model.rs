//! Facets, buildings and their closed solids.

use nalgebra::{Point2, Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::uncertainty::FacetUncertainty;
use crate::base::geometry::{
    Plane, Polygon, bounds, contains, mean_point, plan_sides, sides, signed_area,
};
use crate::base::ids::{BuildingId, FacetId, HalfPlaneId, LineId, ProposalOrigin};

/// Plan positions closer than this are one, metres. Ten times the step in which coordinates are
/// written, so that no two corners of a solid become equal in a file.
pub const WELD_M: f64 = 1e-3;

/// A planar roof facet.
///
/// Invariants: every ring is simple; the outer one runs counter-clockwise seen from above, holes
/// clockwise; all corners lie in the plane within 1e-6 m; `plane.normal.z > 0`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Facet {
    /// The building that it covers.
    pub building: BuildingId,
    /// Its plane, local frame.
    pub plane: Plane,
    /// Outer ring, metres, without repeating the first corner.
    pub outer: Vec<Point3<f64>>,
    /// Holes, metres.
    pub holes: Vec<Vec<Point3<f64>>>,
    /// Mean similarity of the views inside the outline, 0 to 1 (B99 4.3, verification).
    pub similarity: f64,
    /// Share of the outline that lies on reconstructed 3D lines: tau_real (B99 4.3).
    pub real_ratio: f64,
    /// Probability that it is a roof's face, 0 to 1 ([`crate::base::evidence`]); 1 where nothing
    /// weighed it.
    pub probability: f64,
    /// How well it is known; `None` where the images show too few of its edges.
    pub uncertainty: Option<FacetUncertainty>,
    /// The 3D lines in its outline or in its plane.
    pub lines: Vec<LineId>,
    /// The half-planes that it was made from.
    pub half_planes: Vec<HalfPlaneId>,
    /// What other sources proposed in its plane.
    pub proposals: Vec<ProposalOrigin>,
    /// What stands on it.
    pub obstructions: Vec<Obstruction>,
}

/// Something that stands on a facet and is no roof itself: a chimney, an air handler, a small
/// dormer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Obstruction {
    /// Its outline from above, metres, without repeating the first corner.
    pub outline: Vec<Point2<f64>>,
    /// Height of its top above the facet, metres: of the facet below its middle.
    pub height_m: f64,
    /// Standard deviation of that, metres; `None` where it was not measured by itself.
    pub height_sigma_m: Option<f64>,
    /// Probability that something stands there, 0 to 1.
    pub probability: f64,
}

impl Obstruction {
    /// Do both stand at one place: do they share half of the smaller one?
    pub fn shares_its_place(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(|o| Polygon::from(o.outline.clone()));
        own.and(&others).area() > 0.5 * own.area().min(others.area())
    }
}

impl Facet {
    /// The outer ring, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<Point3<f64>>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Its outline from above.
    pub fn plan(&self) -> Polygon {
        let in_plan = |ring: &Vec<Point3<f64>>| ring.iter().map(Point3::xy).collect();
        Polygon {
            rings: self.rings().map(in_plan).collect(),
        }
    }

    /// The faces of something that stands on it, counter-clockwise seen from outside: the top, then
    /// the sides. The top is level, or parallel to the facet where that would lie below its base.
    pub fn faces_of(&self, obstruction: &Obstruction) -> Vec<Vec<Point3<f64>>> {
        let lift = |p: &Point2<f64>| self.plane.lift(p.x, p.y);
        let base: Vec<Point3<f64>> = obstruction.outline.iter().map(lift).collect();
        let level = mean_point(&base).z + obstruction.height_m;
        let is_above_all = base.iter().all(|p| p.z < level);
        let top = |p: &Point3<f64>| match is_above_all {
            true => Point3::new(p.x, p.y, level),
            false => p + Vector3::z() * obstruction.height_m,
        };
        let side = |[p, q]: [Point3<f64>; 2]| vec![p, q, top(&q), top(&p)];
        std::iter::once(base.iter().map(top).collect())
            .chain(sides(&base).map(side))
            .collect()
    }

    /// Does it lie over or under a plan position?
    pub fn covers(&self, p: &Point2<f64>) -> bool {
        contains(self.rings().flat_map(|ring| plan_sides(ring)), p)
    }

    /// The same facet over one part of another polygon, with what stands there.
    pub fn over(&self, part: &Polygon) -> Self {
        let lift = |p: &Point2<f64>| self.plane.lift(p.x, p.y);
        let mut rings = (part.rings.iter()).map(|ring| ring.iter().map(lift).collect());
        let stands_there = |o: &&Obstruction| part.contains(&mean_point(&o.outline));
        Self {
            outer: rings.next().unwrap_or_default(),
            holes: rings.collect(),
            obstructions: self
                .obstructions
                .iter()
                .filter(stands_there)
                .cloned()
                .collect(),
            ..self.clone()
        }
    }

    /// The part of the plan that it lies in: least and largest x and y, metres.
    pub fn plan_bounds(&self) -> [Point2<f64>; 2] {
        bounds(self.outer.iter().map(Point3::xy))
    }

    /// Area inside the outer ring in plan, square metres.
    pub fn plan_area(&self) -> f64 {
        signed_area(self.outer.iter().map(Point3::xy))
    }

    /// Area inside the outer ring on its plane, square metres.
    pub fn sloped_area(&self) -> f64 {
        self.plan_area() / self.plane.normal.z
    }
}

/// What a face of a solid is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Surface {
    /// A roof facet.
    Roof(FacetId),
    /// A vertical face: an eave extruded to the ground, or a step between roofs.
    Wall,
    /// The underside of a roof that overhangs a wall.
    Ceiling,
    /// The footprint on the ground.
    Ground,
}

/// A planar face of a solid; rings index into [`Solid::vertices`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SolidFace {
    /// What it is.
    pub surface: Surface,
    /// The outer ring (counter-clockwise seen from outside the solid), then holes (clockwise).
    pub rings: Vec<Vec<u32>>,
}

/// A closed polyhedron. Invariants: every edge of a ring is run through once in each direction by
/// the rings of all faces together (closed, oriented 2-manifold); faces are planar within
/// [`super::PLANAR_M`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Solid {
    /// Corners, metres, local frame.
    pub vertices: Vec<Point3<f64>>,
    /// Faces.
    pub faces: Vec<SolidFace>,
}

/// A building: facets that touch in plan, closed by walls and a ground face.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Building {
    /// Its roof facets.
    pub facets: Vec<FacetId>,
    /// Height of the ground below it, metres, local frame.
    pub ground_z: f64,
    /// The closed solid.
    pub solid: Solid,
}

/// The result of every method.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RoofModel {
    /// All facets of all buildings.
    pub facets: Vec<Facet>,
    /// The buildings.
    pub buildings: Vec<Building>,
}

impl RoofModel {
    /// The same model in a frame whose origin lies `by` further, metres.
    pub fn relative_to(mut self, by: &Vector3<f64>) -> Self {
        for facet in &mut self.facets {
            let rings = std::iter::once(&mut facet.outer).chain(&mut facet.holes);
            rings.flatten().for_each(|p| *p -= by);
            facet.plane = facet.plane.relative_to(by);
            let standing = facet.obstructions.iter_mut();
            standing.for_each(|o| o.outline.iter_mut().for_each(|p| *p -= by.xy()));
            if let Some(known) = &mut facet.uncertainty {
                known.corners.iter_mut().for_each(|corner| corner.at -= by);
                let ends = known.sides.iter_mut().flat_map(|side| &mut side.ends);
                ends.for_each(|p| *p -= by.xy());
            }
        }
        for building in &mut self.buildings {
            building.solid.vertices.iter_mut().for_each(|p| *p -= by);
            building.ground_z -= by.z;
        }
        self
    }

    /// Probability of a corner of a facet, 0 to 1: that all facets of the building which have it
    /// are faces of a roof, each taken by itself.
    pub fn probability_of_corner(&self, building: BuildingId, corner: &Point3<f64>) -> f64 {
        let has_it = |facet: &&Facet| {
            let mut corners = facet.rings().flatten();
            facet.building == building && corners.any(|p| (p - corner).norm() < WELD_M)
        };
        (self.facets.iter().filter(has_it))
            .map(|facet| facet.probability)
            .product()
    }
}
