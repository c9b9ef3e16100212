//! Where walls stand below overhanging eaves.
//!
//! Roofs end in eaves, and walls stand inside of them. Views that look under an eave from the side
//! show both the wall and the ground before it:
//!
//! ```text
//!    roof      d      camera
//!   ____---___|<->|  /
//!             |    \/      rays below the rim hit the ground
//!        wall |    /\      before the wall (x < d),
//!             |___/__\_    or the wall
//!               x      ground
//! ```
//!
//! So a depth d claims of every such ray what it hits. Views are compared on the wall at each
//! depth, and on the ground up to there, in long narrow windows; what their correlations say is a
//! fitted table, and the nats of all windows add to the logarithm of the prior. A wall is seen
//! where the odds that it stands within [`DEPTH_TOLERANCE_M`] of the likeliest place reach
//! [`LEAST_ODDS_NATS`]. Otherwise its depth is assumed: that of the seen walls of the building,
//! under the eave where none is.
//!
//! ```text
//! strips  the windows of a side, and what they say of each depth
//! depth   the posterior of the depth
//! ```

mod depth;
mod strips;

pub use depth::{DEPTH_TOLERANCE_M, LEAST_ODDS_NATS};

use nalgebra::{Point3, Vector3};

use self::depth::DepthEstimate;
use self::strips::Strips;
use crate::base::geometry::{Plane, Segment3};
use crate::base::ids::FacetId;
use crate::orienting::scene::Scene;
use crate::planes::terrain::Ground;
use crate::roofs::model::{
    Building, BuildingWalls, Facet, Occluders, RoofModel, Solid, Surface, Wall, check_invariants,
};
use crate::roofs::solids::{RIM_M, Side, close_below_overhangs, outline_sides};

/// Walls nearer to the rim of the roof than this stand below it, metres: less than a pixel.
const LEAST_DEPTH_M: f64 = 0.05;

/// Ground that is this much higher at one corner of a building than at another has walls of
/// different heights, metres: less is the error of the ground itself.
const LEAST_SLOPE_M: f64 = 0.3;

/// The walls of every building of a model. Where the ground is not known its height below each
/// building is taken.
pub fn place_walls(
    scene: &Scene,
    model: &RoofModel,
    ground: Option<&Ground>,
) -> Vec<BuildingWalls> {
    let all: Vec<usize> = (0..model.buildings.len()).collect();
    place_walls_of(scene, model, &all, ground)
}

/// The walls of some buildings, by their indices, among the roofs of all.
pub fn place_walls_of(
    scene: &Scene,
    model: &RoofModel,
    buildings: &[usize],
    ground: Option<&Ground>,
) -> Vec<BuildingWalls> {
    let occluders = Occluders::new(&model.facets);
    crate::base::execution::map(buildings, |_, &building| {
        let building = &model.buildings[building];
        let members: Vec<(FacetId, &Facet)> = (building.facets.iter())
            .map(|f| (*f, &model.facets[f.index()]))
            .collect();
        let ground = ground_plane(ground, building, &members);
        let sides = outline_sides(&members.iter().map(|(_, f)| *f).collect::<Vec<_>>());
        let estimates = sides.iter().map(|side| {
            Strips::new(scene, side, &ground.plane, &occluders)
                .map(|strips| DepthEstimate::of(&strips.nats()))
        });
        let estimates: Vec<Option<DepthEstimate>> = estimates.collect();
        let walls = walls(&sides, &estimates);
        with_solid(model, building, &members, &sides, walls, &ground)
    })
}

/// The ground below a building.
struct GroundBelow {
    plane: Plane,
    /// Highest less lowest corner, metres.
    slope_m: f64,
}

/// The plane of the ground below the corners of a building; level at its height where the ground
/// is not known, or its corners are too few.
fn ground_plane(
    ground: Option<&Ground>,
    building: &Building,
    members: &[(FacetId, &Facet)],
) -> GroundBelow {
    let corners = || members.iter().flat_map(|(_, f)| &f.outer);
    let heights = |z: &dyn Fn(&Point3<f64>) -> f64| {
        let fold = |f: fn(f64, f64) -> f64, start| corners().map(z).fold(start, f);
        fold(f64::max, f64::MIN) - fold(f64::min, f64::MAX)
    };
    let fitted = ground.and_then(|ground| {
        let below = |p: &Point3<f64>| Point3::new(p.x, p.y, ground.z_at(&p.xy()));
        let points: Vec<_> = corners().map(|p| (below(p), 1.0)).collect();
        Plane::fit(&points).map(Plane::upwards)
    });
    // Ground is no wall.
    let fitted = fitted.filter(|plane| plane.normal.z > 0.9);
    let level = || Plane {
        normal: Vector3::z(),
        d: -building.ground_z,
    };
    let plane = fitted.unwrap_or_else(level);
    GroundBelow {
        slope_m: heights(&|p| plane.z_at(p.x, p.y)),
        plane,
    }
}

/// The seen walls, and where the others are assumed.
fn walls(sides: &[Side], estimates: &[Option<DepthEstimate>]) -> Vec<Wall> {
    let seen = |i: usize| estimates[i].filter(DepthEstimate::is_seen);
    // On eaves as on the other eaves, on rakes as on the other rakes, else as on any.
    let assumed = |side: &Side| {
        let all = || (0..sides.len()).filter_map(|i| Some((&sides[i], seen(i)?)));
        let same = || all().filter(|(other, _)| other.is_level() == side.is_level());
        let mean = |walls: &mut dyn Iterator<Item = (&Side, DepthEstimate)>| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for (other, estimate) in walls {
                sum += other.length() * estimate.depth_m;
                weights += other.length();
            }
            (weights > 0.0).then(|| sum / weights)
        };
        mean(&mut same())
            .or_else(|| mean(&mut all()))
            .unwrap_or(0.0)
    };
    let depth = |depth: f64| if depth < LEAST_DEPTH_M { 0.0 } else { depth };
    (sides.iter().enumerate())
        .map(|(i, side)| Wall {
            side: Segment3::new(side.start(), side.end()),
            depth_m: depth(seen(i).map_or_else(|| assumed(side), |e| e.depth_m)),
            seen: seen(i).is_some(),
            probability: estimates[i].map(|e| e.probability),
            sigma_m: seen(i).map(|e| e.sigma_m),
        })
        .collect()
}

/// The walls with their solid, where it differs from that of the building and is sound: with all
/// walls, else with those alone that are seen.
fn with_solid(
    model: &RoofModel,
    building: &Building,
    members: &[(FacetId, &Facet)],
    sides: &[Side],
    walls: Vec<Wall>,
    ground: &GroundBelow,
) -> BuildingWalls {
    let all: Vec<f64> = walls.iter().map(|w| w.depth_m).collect();
    let only_seen: Vec<f64> = (walls.iter())
        .map(|w| if w.seen { w.depth_m } else { 0.0 })
        .collect();
    let none = vec![0.0; all.len()];
    let differs =
        |depths: &[f64]| ground.slope_m > LEAST_SLOPE_M || depths.iter().any(|depth| *depth > 0.0);
    let closed = [all, only_seen, none].into_iter().find_map(|depths| {
        let solid = differs(&depths)
            .then(|| close_below_overhangs(members, sides, &depths, &ground.plane))??;
        is_sound(model, building, &solid).then_some((depths, solid))
    });
    let (depths, solid) = closed.map_or((vec![0.0; walls.len()], None), |(d, s)| (d, Some(s)));
    let stands = |(wall, depth_m): (Wall, f64)| Wall {
        seen: wall.seen && (wall.depth_m - depth_m).abs() < LEAST_DEPTH_M,
        sigma_m: wall
            .sigma_m
            .filter(|_| (wall.depth_m - depth_m).abs() < LEAST_DEPTH_M),
        depth_m,
        ..wall
    };
    BuildingWalls {
        walls: walls.into_iter().zip(depths).map(stands).collect(),
        volume_m3: solid.as_ref().map(volume_within_walls),
        solid,
    }
}

/// Does a solid of a building keep the invariants of models?
fn is_sound(model: &RoofModel, building: &Building, solid: &Solid) -> bool {
    let first = building.facets.first().map_or(0, |f| f.index());
    // The facets of a building follow each other.
    let facets = building.facets.iter().map(|f| Facet {
        building: crate::base::ids::BuildingId(0),
        ..model.facets[f.index()].clone()
    });
    let renumbered = |id: &FacetId| FacetId::from_index(id.index() - first);
    let mut solid = solid.clone();
    for face in &mut solid.faces {
        if let Surface::Roof(id) = &mut face.surface {
            *id = renumbered(id);
        }
    }
    let alone = RoofModel {
        facets: facets.collect(),
        buildings: vec![Building {
            facets: building.facets.iter().map(renumbered).collect(),
            solid,
            ..building.clone()
        }],
    };
    check_invariants(&alone).is_empty()
}

/// Without the slab that overhangs.
fn volume_within_walls(solid: &Solid) -> f64 {
    let ceilings = solid.faces.iter().filter(|f| f.surface == Surface::Ceiling);
    let plan_area: f64 = ceilings.map(|f| -solid.vector_area(&f.rings).z).sum();
    solid.volume() - RIM_M * plan_area
}

#[cfg(test)]
mod tests;
