//! The model building by building, while it is corrected.

use crate::base::geometry::{Plane, Polygon};
use crate::base::ids::{BuildingId, FacetId};
use crate::roofs::model::{Building, Facet, RoofModel, Surface, WELD_M, check_invariants};
use crate::roofs::solids::{SolidRejection, close_buildings};

use super::outcome::NotApplied;

/// Parts of a polygon below this area are rounding, m^2: a sliver of 1 mm along an eave.
const SLIVER_M2: f64 = 0.02;

/// A facet and the one that it was before the corrections.
#[derive(Clone, Debug)]
pub(super) struct DraftFacet {
    pub facet: Facet,
    pub source: Option<FacetId>,
}

impl DraftFacet {
    /// The same facet with another plane, its outline in it.
    pub(super) fn on(&self, plane: Plane) -> Self {
        let mut moved = self.clone();
        moved.facet.plane = plane;
        let rings = std::iter::once(&mut moved.facet.outer).chain(&mut moved.facet.holes);
        for p in rings.flatten() {
            *p = plane.lift(p.x, p.y);
        }
        moved
    }
}

impl DraftFacet {
    /// The same facet over another polygon, in as many parts as that has, without slivers.
    pub(super) fn over(&self, polygon: &Polygon) -> Vec<Self> {
        let parts = polygon.parts().into_iter();
        let over = parts
            .filter(|part| part.signed_area() > SLIVER_M2)
            .map(|part| Self {
                facet: self.facet.over(&part),
                source: self.source,
            });
        over.collect()
    }
}

/// A building; its solid refers to its own facets by their place among them.
#[derive(Clone, Debug)]
pub(super) struct House {
    pub facets: Vec<DraftFacet>,
    pub building: Building,
}

/// Where a facet is: its house, and its place in that.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct At {
    pub house: usize,
    pub facet: usize,
}

/// A model in the course of its corrections.
#[derive(Clone, Debug)]
pub(super) struct Draft {
    pub houses: Vec<House>,
}

impl Draft {
    pub(super) fn new(model: &RoofModel) -> Self {
        let sources: Vec<Option<FacetId>> = (0..model.facets.len())
            .map(|i| Some(FacetId::from_index(i)))
            .collect();
        Self {
            houses: houses_of(model, &sources),
        }
    }

    /// The model, and for each of its facets the one that it was.
    pub(super) fn into_model(self) -> (RoofModel, Vec<Option<FacetId>>) {
        let (mut model, mut sources) = (RoofModel::default(), Vec::new());
        for House {
            facets,
            mut building,
        } in self.houses
        {
            let first = model.facets.len();
            let id = |i: usize| FacetId::from_index(first + i);
            for face in &mut building.solid.faces {
                if let Surface::Roof(facet) = &mut face.surface {
                    *facet = id(facet.index());
                }
            }
            building.facets = (0..facets.len()).map(id).collect();
            let own = BuildingId::from_index(model.buildings.len());
            for DraftFacet { facet, source } in facets {
                model.facets.push(Facet {
                    building: own,
                    ..facet
                });
                sources.push(source);
            }
            model.buildings.push(building);
        }
        (model, sources)
    }

    pub(super) fn get(&self, at: At) -> &DraftFacet {
        &self.houses[at.house].facets[at.facet]
    }

    pub(super) fn facet_mut(&mut self, at: At) -> &mut Facet {
        &mut self.houses[at.house].facets[at.facet].facet
    }

    /// Every facet, with where it is.
    pub(super) fn facets(&self) -> impl Iterator<Item = (At, &DraftFacet)> {
        self.houses.iter().enumerate().flat_map(|(house, of)| {
            let facets = of.facets.iter().enumerate();
            facets.map(move |(facet, f)| (At { house, facet }, f))
        })
    }

    /// Puts other facets in the place of a house, and closes them. Houses that they reach are
    /// closed with them.
    pub(super) fn rebuild(
        &mut self,
        house: usize,
        facets: Vec<DraftFacet>,
    ) -> Result<(), NotApplied> {
        let ground_z = self.houses[house].building.ground_z;
        self.replace(Some(house), facets, ground_z)
    }

    /// Closes new facets, in the place of a house or as one more, on the ground at `ground_z`.
    pub(super) fn replace(
        &mut self,
        house: Option<usize>,
        facets: Vec<DraftFacet>,
        ground_z: f64,
    ) -> Result<(), NotApplied> {
        let reached: Vec<usize> = (0..self.houses.len())
            .filter(|&h| house != Some(h) && self.reaches(&facets, h))
            .collect();
        let mut grounds = vec![ground_z];
        let mut all: Vec<DraftFacet> = tagged(facets, 0).collect();
        for &other in &reached {
            all.extend(tagged(self.houses[other].facets.clone(), grounds.len()));
            grounds.push(self.houses[other].building.ground_z);
        }
        let closed = closed(&all, &grounds)?;
        let removed: Vec<usize> = house.into_iter().chain(reached).collect();
        let at = removed.iter().copied().min().unwrap_or(self.houses.len());
        let mut kept: Vec<House> = Vec::with_capacity(self.houses.len() + closed.len());
        let mut new = Some(closed);
        for (h, old) in std::mem::take(&mut self.houses).into_iter().enumerate() {
            if h == at {
                kept.extend(new.take().into_iter().flatten());
            }
            if !removed.contains(&h) {
                kept.push(old);
            }
        }
        kept.extend(new.into_iter().flatten());
        self.houses = kept;
        Ok(())
    }

    /// Do facets lie over or beside a house, by their boxes in plan?
    fn reaches(&self, facets: &[DraftFacet], house: usize) -> bool {
        let boxes = |f: &DraftFacet| f.facet.plan_bounds();
        facets.iter().map(boxes).any(|[la, ha]| {
            let others = self.houses[house].facets.iter().map(boxes);
            others.into_iter().any(|[lb, hb]| {
                (0..2).all(|axis| la[axis] < hb[axis] + WELD_M && lb[axis] < ha[axis] + WELD_M)
            })
        })
    }
}

/// Facets whose building is the number of their ground.
fn tagged(facets: Vec<DraftFacet>, ground: usize) -> impl Iterator<Item = DraftFacet> {
    let building = BuildingId::from_index(ground);
    facets.into_iter().map(move |f| DraftFacet {
        facet: Facet {
            building,
            ..f.facet
        },
        source: f.source,
    })
}

/// Closed houses of facets, which are all still there.
fn closed(facets: &[DraftFacet], grounds: &[f64]) -> Result<Vec<House>, NotApplied> {
    let plain: Vec<Facet> = facets.iter().map(|f| f.facet.clone()).collect();
    let below = |members: &[&Facet]| {
        let heights = members.iter().map(|f| grounds[f.building.index()]);
        heights.fold(f64::INFINITY, f64::min)
    };
    let (model, trace) = close_buildings(&plain, below);
    // A sliver may go; a facet may not.
    let is_lost = |&(source, why): &(usize, SolidRejection)| {
        why != SolidRejection::TooSmall || !trace.sources.contains(&source)
    };
    if trace.rejected.iter().any(is_lost) || !check_invariants(&model).is_empty() {
        return Err(NotApplied::WouldNotClose);
    }
    let sources: Vec<Option<FacetId>> = trace.sources.iter().map(|&f| facets[f].source).collect();
    Ok(houses_of(&model, &sources))
}

/// The buildings of a model, each with its own facets.
fn houses_of(model: &RoofModel, sources: &[Option<FacetId>]) -> Vec<House> {
    let house = |building: &Building| {
        let own = &building.facets;
        let facets = own.iter().map(|f| DraftFacet {
            facet: model.facets[f.index()].clone(),
            source: sources[f.index()],
        });
        let mut building = building.clone();
        for face in &mut building.solid.faces {
            if let Surface::Roof(facet) = &mut face.surface {
                let place = own.iter().position(|f| f == facet);
                *facet =
                    FacetId::from_index(place.expect("a roof face is a facet of its building"));
            }
        }
        House {
            facets: facets.collect(),
            building,
        }
    };
    model.buildings.iter().map(house).collect()
}
