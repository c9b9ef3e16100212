//! A model as its CityJSON file has it: corners in whole steps, numbers rounded, and what the file
//! does not say left out. So the report of a run is that of its file, without reading it.

use nalgebra::{Point2, Point3, center};

use super::super::cityjson::{in_plan, whole_corners, written_frame};
use super::super::format::rounded;
use super::super::measured::Measured;
use super::read::plane_of;
use super::reported::{ReportedModel, ReportedWalls};
use crate::base::geometry::plan_sides;
use crate::base::ids::{BuildingId, FacetId};
use crate::orienting::scene::{Scene, Survey};
use crate::roofs::model::{
    BuildingWalls, CornerUncertainty, Facet, FacetUncertainty, Obstruction, RoofModel,
    SideUncertainty, Surface,
};
use crate::roofs::solids::WRITTEN_STEP_M;

type Rings = Vec<Vec<Point3<f64>>>;

impl ReportedModel {
    /// What the CityJSON file of a model says of it.
    pub fn of(scene: &Scene, model: &RoofModel, walls: &[BuildingWalls]) -> Self {
        Self::of_measured(scene, (model, walls), &Measured::new(scene, model))
    }

    pub(in super::super) fn of_measured(
        scene: &Scene,
        (model, walls): (&RoofModel, &[BuildingWalls]),
        measured: &Measured,
    ) -> Self {
        let Survey { epsg, anchor, .. } = &scene.survey;
        let mut written = Self {
            origin: scene.origin,
            system: scene.survey.describe(),
            survey: Survey {
                epsg: *epsg,
                anchor: anchor.filter(|_| epsg.is_none()),
                frame_sigma: written_frame(scene),
                ..Survey::default()
            },
            ..Self::default()
        };
        for (i, building) in model.buildings.iter().enumerate() {
            let steps = |steps: [i64; 3]| Point3::from(steps.map(|n| n as f64 * WRITTEN_STEP_M));
            let corners: Vec<Point3<f64>> = whole_corners(&building.solid).map(steps).collect();
            let corner = |&v: &u32| corners[v as usize];
            let faces = building.solid.faces.iter().map(|face| {
                let rings = face.rings.iter();
                let rings: Rings = rings
                    .map(|ring| ring.iter().map(corner).collect())
                    .collect();
                let surface = match face.surface {
                    Surface::Roof(id) => written.add_facet(scene, (model, measured), id, &rings),
                    Surface::Ground => Surface::Ground,
                    Surface::Wall | Surface::Ceiling => Surface::Wall,
                };
                (surface, rings)
            });
            let faces = faces.collect();
            let ground_m = rounded(building.ground_z + scene.origin.z, 4);
            if written.add_building(faces, Some(ground_m - scene.origin.z)) {
                written.names.push(BuildingId::from_index(i).name());
                written.walls.push(
                    walls
                        .get(i)
                        .map_or_else(ReportedWalls::default, written_walls),
                );
            }
        }
        written
    }

    /// Adds a facet over these rings; a wall where it does not look up.
    fn add_facet(
        &mut self,
        scene: &Scene,
        (model, measured): (&RoofModel, &Measured),
        id: FacetId,
        rings: &Rings,
    ) -> Surface {
        let Some(plane) = plane_of(rings) else {
            return Surface::Wall;
        };
        let facet = &model.facets[id.index()];
        let next = FacetId::from_index(self.model.facets.len());
        self.model.facets.push(Facet {
            building: BuildingId::from_index(self.model.buildings.len()),
            plane,
            outer: rings[0].clone(),
            holes: rings[1..].to_vec(),
            similarity: rounded(facet.similarity, 4),
            real_ratio: rounded(facet.real_ratio, 4),
            probability: rounded(facet.probability, 4),
            uncertainty: written_uncertainty(facet, rings),
            lines: Vec::new(),
            half_planes: Vec::new(),
            proposals: Vec::new(),
            obstructions: (facet.obstructions.iter())
                .map(|obstruction| written_obstruction(scene, obstruction))
                .collect(),
        });
        self.photographs
            .push(measured.photographs[id.index()].clone());
        Surface::Roof(next)
    }
}

/// As the file states it, and as it is read.
fn written_obstruction(scene: &Scene, obstruction: &Obstruction) -> Obstruction {
    let coordinate = |p: &Point2<f64>, k| in_plan(scene, p, k) - scene.origin[k];
    let outline = obstruction.outline.iter();
    Obstruction {
        outline: outline
            .map(|p| [0, 1].map(|k| coordinate(p, k)).into())
            .collect(),
        height_m: rounded(obstruction.height_m, 4),
        height_sigma_m: obstruction.height_sigma_m.map(|sigma| rounded(sigma, 4)),
        probability: rounded(obstruction.probability, 4),
    }
}

fn written_walls(walls: &BuildingWalls) -> ReportedWalls {
    let seen = walls.walls.iter().filter(|wall| wall.seen).count();
    ReportedWalls {
        count: Some([walls.walls.len(), seen].map(|n| n as u64)),
        volume_m3: walls.volume_m3.map(|volume| rounded(volume, 3)),
    }
}

/// A file has no numbers that are not finite.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then(|| rounded(value, 4))
}

/// The file states corners and sides in the order of the facet's rings, for those of the solid.
fn written_uncertainty(facet: &Facet, rings: &Rings) -> Option<FacetUncertainty> {
    let known = facet.uncertainty.as_ref()?;
    let corner = |(at, of): (&Point3<f64>, &Point3<f64>)| {
        let [x, y, z] = known.at(of)?.into();
        let sigma_m = [finite(x)?, finite(y)?, finite(z)?].into();
        Some(CornerUncertainty { at: *at, sigma_m })
    };
    let corners: Vec<_> = (rings[0].iter().zip(&facet.outer))
        .map(corner)
        .collect::<Option<_>>()?;
    if corners.len() < rings[0].len() {
        return None;
    }
    let side = |(ends, [p, q]): ([Point2<f64>; 2], [Point2<f64>; 2])| {
        let side = known.side(&center(&p, &q))?;
        let sigma_m = finite(side.sigma_m)?;
        let support = side.support;
        Some(SideUncertainty {
            ends,
            sigma_m,
            support,
        })
    };
    let pairs = || rings.iter().zip(facet.rings());
    let sides = pairs().flat_map(|(ring, of)| plan_sides(ring).zip(plan_sides(of)));
    let is_all =
        rings.len() <= 1 + facet.holes.len() && pairs().all(|(ring, of)| ring.len() <= of.len());
    Some(FacetUncertainty {
        height_m: finite(known.height_m)?,
        slope_deg: finite(known.slope_deg)?,
        corners,
        sides: sides.filter_map(side).filter(|_| is_all).collect(),
    })
}
