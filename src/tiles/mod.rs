//! Large areas as overlapping tiles, one at a time, whose models join.
//!
//! ```text
//! plan_tiles   cores that cover the area without gap or overlap, and regions with a margin around them
//! Tile::keep   of the buildings of a region, those whose middle lies in the core or next to it
//! Area         one tile after the other
//! join         one model: each building once, ids renumbered, image positions of the whole images, one atlas
//! ```
//!
//! A building is reconstructed whole in the tile that holds its middle, as long as it reaches less
//! than [`MARGIN_M`] beyond the core; so there is no seam through a building. Buildings that touch
//! each other and come from different tiles may overlap by the accuracy of their eaves.

mod area;
mod join;

pub use area::{Area, TileReport};
pub use join::{Joined, TilePart, join};

use nalgebra::{Point2, Vector3};
use serde::Serialize;

use crate::error::{Error, Result};
use crate::geometry::Plane;
use crate::ids::BuildingId;
use crate::ids::FacetId;
use crate::model::{Building, RoofModel, Surface};

/// Width of the margin around a core, metres. Assumption: a house and its neighbours' eaves, which
/// take part in what its lines mean.
pub const MARGIN_M: f64 = 30.0;

/// Buildings whose middle lies this far beyond the core are kept until the tiles are joined,
/// metres: the neighbour may see their middle on this side.
const SLACK_M: f64 = 3.0;

/// Most tiles of an area.
const MOST_TILES: f64 = 100_000.0;

/// A part of the area: x0, y0, x1, y1 in metres, world frame of the input.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tile {
    /// What the tile is responsible for.
    pub core: [f64; 4],
    /// What it looks at.
    pub region: [f64; 4],
}

/// Tiles of about `tile_m` metres that cover an area; from west to east, then from south to north.
pub fn plan_tiles(area: [f64; 4], tile_m: f64) -> Result<Vec<Tile>> {
    let [x0, y0, x1, y1] = area;
    let sizes = [x1 - x0, y1 - y0];
    let counts = sizes.map(|size| (size / tile_m).ceil().max(1.0));
    if !(tile_m >= MARGIN_M
        && sizes.iter().all(|&s| s > 0.0 && s.is_finite())
        && counts[0] * counts[1] <= MOST_TILES)
    {
        return Err(Error::Scene {
            problem: format!(
                "{:.0} x {:.0} m cannot be divided into tiles of {tile_m} m",
                sizes[0], sizes[1]
            ),
            advice: format!(
                "choose tiles of {MARGIN_M:.0} m or more, and no more than {MOST_TILES:.0} of them"
            ),
        });
    }
    let edge = |from: f64, axis: usize, i: usize| from + sizes[axis] * i as f64 / counts[axis];
    let mut tiles = Vec::new();
    for j in 0..counts[1] as usize {
        for i in 0..counts[0] as usize {
            let core = [
                edge(x0, 0, i),
                edge(y0, 1, j),
                edge(x0, 0, i + 1),
                edge(y0, 1, j + 1),
            ];
            let [a, b, c, d] = core;
            tiles.push(Tile {
                core,
                region: [a - MARGIN_M, b - MARGIN_M, c + MARGIN_M, d + MARGIN_M],
            });
        }
    }
    Ok(tiles)
}

impl Tile {
    /// How far a place lies inside the core, metres; negative outside.
    fn depth(&self, p: &Point2<f64>) -> f64 {
        let [x0, y0, x1, y1] = self.core;
        (p.x - x0).min(x1 - p.x).min(p.y - y0).min(y1 - p.y)
    }

    /// Does the core hold this place? Cores share no place.
    fn holds(&self, p: &Point2<f64>) -> bool {
        let [x0, y0, x1, y1] = self.core;
        p.x >= x0 && p.x < x1 && p.y >= y0 && p.y < y1
    }

    /// The buildings that this tile may be responsible for. `origin` is that of the model's frame.
    pub fn keep(&self, model: &RoofModel, origin: &Vector3<f64>) -> RoofModel {
        let near = |b: &Building| self.depth(&(middle(b) + origin.xy())) > -SLACK_M;
        let chosen: Vec<usize> = (0..model.buildings.len())
            .filter(|&b| near(&model.buildings[b]))
            .collect();
        subset(model, &chosen)
    }
}

/// The middle of a building's box in plan.
fn middle(building: &Building) -> Point2<f64> {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for p in &building.solid.vertices {
        low = [low[0].min(p.x), low[1].min(p.y)];
        high = [high[0].max(p.x), high[1].max(p.y)];
    }
    Point2::new(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]))
}

/// Some buildings of a model, with their facets; ids follow the new order.
fn subset(model: &RoofModel, buildings: &[usize]) -> RoofModel {
    let mut found = RoofModel::default();
    for &b in buildings {
        append(&mut found, model, b);
    }
    found
}

/// Appends a building with its facets.
fn append(to: &mut RoofModel, from: &RoofModel, building: usize) {
    let mut copy = from.buildings[building].clone();
    let id = BuildingId::from_index(to.buildings.len());
    let old = std::mem::take(&mut copy.facets);
    for facet in &old {
        copy.facets.push(FacetId::from_index(to.facets.len()));
        let mut facet = from.facets[facet.index()].clone();
        facet.building = id;
        to.facets.push(facet);
    }
    for face in &mut copy.solid.faces {
        if let Surface::Roof(facet) = &mut face.surface {
            let place = old
                .iter()
                .position(|f| f == facet)
                .expect("a solid's roofs are facets of its building");
            *facet = copy.facets[place];
        }
    }
    to.buildings.push(copy);
}

/// Moves a model to a frame whose origin lies `by` further.
fn moved(mut model: RoofModel, by: &Vector3<f64>) -> RoofModel {
    for facet in &mut model.facets {
        facet
            .outer
            .iter_mut()
            .chain(facet.holes.iter_mut().flatten())
            .for_each(|p| *p -= by);
        facet.plane = moved_plane(&facet.plane, by);
    }
    for building in &mut model.buildings {
        building.solid.vertices.iter_mut().for_each(|p| *p -= by);
        building.ground_z -= by.z;
    }
    model
}

fn moved_plane(plane: &Plane, by: &Vector3<f64>) -> Plane {
    Plane {
        normal: plane.normal,
        d: plane.d + plane.normal.dot(by),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::model::Facet;
    use crate::solids::close_buildings;
    use nalgebra::Point3;

    /// A house of 8 x 8 m with a mono-pitch roof, its middle at a place.
    pub(crate) fn house([x, y]: [f64; 2]) -> RoofModel {
        let plane =
            Plane::from_point_normal(&Point3::new(x, y, 6.0), &Vector3::new(-0.3, 0.0, 1.0))
                .expect("a plane");
        let corners = [[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]];
        let facet = Facet {
            building: BuildingId(0),
            plane,
            outer: corners.map(|[dx, dy]| plane.lift(x + dx, y + dy)).into(),
            holes: Vec::new(),
            similarity: 0.9,
            real_ratio: 0.8,
            lines: Vec::new(),
            half_planes: Vec::new(),
            rectangles: Vec::new(),
        };
        close_buildings(&[facet], |_| 0.0).0
    }

    #[test]
    fn only_buildings_near_the_core_are_kept() {
        let tile = plan_tiles([0.0, 0.0, 100.0, 50.0], 50.0).unwrap()[0];
        let origin = Vector3::new(-1000.0, 0.0, 0.0);
        let mut model = RoofModel::default();
        for x in [70.0, 20.0, 52.0] {
            append(&mut model, &house([x + 1000.0, 25.0]), 0);
        }
        let kept = tile.keep(&model, &origin);
        let middles: Vec<f64> = kept
            .buildings
            .iter()
            .map(|b| middle(b).x - 1000.0)
            .collect();
        assert_eq!(middles, [20.0, 52.0]);
        assert_eq!(crate::model::check_invariants(&kept), []);
    }

    #[test]
    fn every_place_lies_in_one_core() {
        let tiles = plan_tiles([100.0, -50.0, 351.0, 49.0], 50.0).unwrap();
        assert_eq!(tiles.len(), 6 * 2);
        for i in 0..1000 {
            let t = f64::from(i) / 1000.0;
            let p = Point2::new(100.0 + 251.0 * t, -50.0 + 99.0 * (t * 37.0).fract());
            assert_eq!(tiles.iter().filter(|tile| tile.holds(&p)).count(), 1, "{p}");
        }
        assert!(tiles.iter().all(|t| t.core[0] - t.region[0] == MARGIN_M));
        for (area, size) in [
            ([0.0, 0.0, 1.0, 1.0], 5.0),
            ([0.0, 0.0, 1e9, 1e9], 100.0),
            ([0.0, 0.0, f64::NAN, 1.0], 100.0),
        ] {
            assert!(
                plan_tiles(area, size)
                    .unwrap_err()
                    .to_string()
                    .contains("cannot be divided")
            );
        }
    }
}
