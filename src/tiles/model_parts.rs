//! Parts of roof models: some buildings of one, appended to another, in another frame.

use nalgebra::{Point2, Point3, Vector3};

use crate::base::geometry::bounds;
use crate::base::ids::{BuildingId, FacetId};
use crate::roofs::model::{Building, BuildingWalls, RoofModel, Solid, Surface};

/// The middle of a building's box in plan.
pub(super) fn middle(building: &Building) -> Point2<f64> {
    let [low, high] = bounds(building.solid.vertices.iter().map(Point3::xy));
    nalgebra::center(&low, &high)
}

/// Some buildings of a model, with their facets; ids follow the new order.
pub(super) fn subset(model: &RoofModel, buildings: &[usize]) -> RoofModel {
    let mut found = RoofModel::default();
    for &b in buildings {
        append(&mut found, model, b);
    }
    found
}

/// Appends a building with its facets.
pub(super) fn append(to: &mut RoofModel, from: &RoofModel, building: usize) {
    let mut copy = from.buildings[building].clone();
    let id = BuildingId::from_index(to.buildings.len());
    let old = std::mem::take(&mut copy.facets);
    for facet in &old {
        copy.facets.push(FacetId::from_index(to.facets.len()));
        let mut facet = from.facets[facet.index()].clone();
        facet.building = id;
        to.facets.push(facet);
    }
    renumber(&mut copy.solid, &old, &copy.facets);
    to.buildings.push(copy);
}

/// Has the roofs of a building's solid refer to other numbers of the same facets.
fn renumber(solid: &mut Solid, old: &[FacetId], new: &[FacetId]) {
    for face in &mut solid.faces {
        if let Surface::Roof(facet) = &mut face.surface {
            let place = (old.iter().position(|f| f == facet))
                .expect("a solid's roofs are facets of its building");
            *facet = new[place];
        }
    }
}

/// The walls of a building as those of the same building in another model, in a frame whose origin
/// lies `by` further.
pub(super) fn walls_of(
    walls: &BuildingWalls,
    from: &Building,
    to: &Building,
    by: &Vector3<f64>,
) -> BuildingWalls {
    let mut walls = walls.clone();
    for wall in &mut walls.walls {
        wall.side.p0 -= by;
        wall.side.p1 -= by;
    }
    if let Some(solid) = &mut walls.solid {
        renumber(solid, &from.facets, &to.facets);
        solid.vertices.iter_mut().for_each(|p| *p -= by);
    }
    walls
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, center};

    use super::*;
    use crate::roofs::model::{
        CornerUncertainty, FacetUncertainty, Obstruction, SideSupport, SideUncertainty,
    };
    use crate::tiles::fixture::house;

    #[test]
    fn what_is_known_of_a_facet_and_stands_on_it_moves_with_it() {
        let mut model = house([3.0, 4.0]);
        let facet = &mut model.facets[0];
        let corner = |&at: &Point3<f64>| CornerUncertainty {
            at,
            sigma_m: Vector3::repeat(0.1),
        };
        let side = |ends| SideUncertainty {
            ends,
            sigma_m: 0.2,
            support: SideSupport::Edges,
        };
        facet.uncertainty = Some(FacetUncertainty {
            height_m: 0.1,
            slope_deg: 1.0,
            corners: facet.outer.iter().map(corner).collect(),
            sides: facet.plan().sides().map(side).collect(),
        });
        facet.obstructions.push(Obstruction {
            outline: facet.outer.iter().map(|p| p.xy()).collect(),
            height_m: 1.0,
            height_sigma_m: None,
            probability: 1.0,
        });
        let model = model.relative_to(&Vector3::new(100.0, -50.0, 7.0));
        let facet = &model.facets[0];
        let known = facet.uncertainty.as_ref().unwrap();
        for (corner, [p, q]) in facet.outer.iter().zip(facet.plan().sides()) {
            assert!(known.at(corner).is_some() && known.side(&center(&p, &q)).is_some());
            assert!(facet.obstructions[0].outline.contains(&p));
        }
    }
}
