//! Two models of one place: what they share, and by how much it differs.

use std::collections::BTreeMap;

use nalgebra::Point2;
use serde::Serialize;

use super::facet_slope_deg;
use crate::base::geometry::Polygon;
use crate::base::ids::{BuildingId, FacetId};
use crate::base::plan_index::PlanIndex;
use crate::roofs::model::{Facet, RoofModel};

/// Parts share their place where what they share in plan is more than this of the smaller one.
const SHARED: f64 = 0.5;

/// Two models in one frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Buildings of both, then those of the first alone, then those of the second alone.
    pub buildings: Vec<Compared<BuildingId>>,
    /// The same of facets.
    pub facets: Vec<Compared<FacetId>>,
}

/// A part of the first model, the part of the second in its place, or both.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Compared<Id> {
    /// Which part of the first model.
    pub first: Option<Id>,
    /// Which part of the second model.
    pub second: Option<Id>,
    /// What both share in plan, of what they cover together: 0 to 1.
    pub overlap: f64,
    /// Area on its planes in the first and in the second model, square metres.
    pub area_m2: [f64; 2],
    /// By how much the first lies above the second, metres: the mean over what they share in plan.
    pub above_m: Option<f64>,
    /// The largest difference of heights there, metres.
    pub largest_m: Option<f64>,
    /// Slope in the first and in the second model, degrees; of a facet alone.
    pub slope_deg: Option<[f64; 2]>,
}

/// How the heights of two facets differ over a part of the plan.
#[derive(Clone, Copy, Debug, Default)]
struct Difference {
    shared_m2: f64,
    /// Integral of the difference, cubic metres.
    volume_m3: f64,
    largest_m: f64,
}

impl<Id> Compared<Id> {
    /// The same with names for the parts of the first and of the second model.
    pub fn named<Name>(
        self,
        first: impl Fn(Id) -> Name,
        second: impl Fn(Id) -> Name,
    ) -> Compared<Name> {
        Compared {
            first: self.first.map(first),
            second: self.second.map(second),
            overlap: self.overlap,
            area_m2: self.area_m2,
            above_m: self.above_m,
            largest_m: self.largest_m,
            slope_deg: self.slope_deg,
        }
    }
}

impl Difference {
    /// Of the first facet above the second; planes differ linearly, so that the mean is that at the
    /// centroid, and the largest that at a corner.
    fn of(first: &Facet, second: &Facet, shared: &Polygon) -> Self {
        let at = |p: &Point2<f64>| first.plane.lift(p.x, p.y).z - second.plane.lift(p.x, p.y).z;
        let shared_m2 = shared.area();
        Self {
            shared_m2,
            volume_m3: (shared.centroid()).map_or(0.0, |center| shared_m2 * at(&center)),
            largest_m: (shared.rings.iter().flatten())
                .map(|p| at(p).abs())
                .fold(0.0, f64::max),
        }
    }

    fn and(self, other: Self) -> Self {
        Self {
            shared_m2: self.shared_m2 + other.shared_m2,
            volume_m3: self.volume_m3 + other.volume_m3,
            largest_m: self.largest_m.max(other.largest_m),
        }
    }
}

/// The areas of the parts of a model, square metres.
struct Areas {
    plan: Vec<f64>,
    /// On their planes.
    sloped: Vec<f64>,
}

impl Areas {
    fn of_facets(model: &RoofModel) -> Self {
        let plan = Vec::from_iter(model.facets.iter().map(|facet| facet.plan().area()));
        let planes = model.facets.iter().map(|facet| &facet.plane);
        Self {
            sloped: planes
                .zip(&plan)
                .map(|(p, area)| area / p.normal.z)
                .collect(),
            plan,
        }
    }

    fn of_buildings(&self, model: &RoofModel) -> Self {
        let sums = |areas: &[f64]| {
            let mut sums = vec![0.0; model.buildings.len()];
            for (facet, area) in model.facets.iter().zip(areas) {
                sums[facet.building.index()] += area;
            }
            sums
        };
        Self {
            plan: sums(&self.plan),
            sloped: sums(&self.sloped),
        }
    }
}

/// What two parts share, by their indices in their models.
type Shared = BTreeMap<(usize, usize), Difference>;

/// Compares two models, whose coordinates are of one frame.
pub fn compare(first: &RoofModel, second: &RoofModel) -> Comparison {
    let (mut facets, mut buildings) = (Shared::new(), Shared::new());
    let index = PlanIndex::new(second.facets.iter().map(Facet::plan_bounds));
    for (i, facet) in first.facets.iter().enumerate() {
        for j in index.touching(facet.plan_bounds(), 0.0) {
            let other = &second.facets[j as usize];
            let difference = Difference::of(facet, other, &facet.plan().and(&other.plan()));
            facets.insert((i, j as usize), difference);
        }
    }
    for ((i, j), difference) in &facets {
        let of = [&first.facets[*i], &second.facets[*j]].map(|f| f.building.index());
        let sum = buildings.entry(of.into()).or_default();
        *sum = sum.and(*difference);
    }
    let models = [first, second];
    let areas = models.map(Areas::of_facets);
    let of_buildings = [0, 1].map(|k| areas[k].of_buildings(models[k]));
    let mut compared = paired(facets, &areas, FacetId::from_index);
    for part in &mut compared {
        let slope = |model: &RoofModel, id: FacetId| facet_slope_deg(&model.facets[id.index()]);
        let both = part.first.zip(part.second);
        part.slope_deg = both.map(|(i, j)| [slope(first, i), slope(second, j)]);
    }
    Comparison {
        buildings: paired(buildings, &of_buildings, BuildingId::from_index),
        facets: compared,
    }
}

/// Each part with at most one of the other model, those that share most first; then the others.
fn paired<Id: Copy>(
    shared: Shared,
    areas: &[Areas; 2],
    id: impl Fn(usize) -> Id,
) -> Vec<Compared<Id>> {
    let [first, second] = areas;
    let mut shared: Vec<_> = (shared.into_iter())
        .filter(|((i, j), d)| d.shared_m2 > SHARED * first.plan[*i].min(second.plan[*j]))
        .collect();
    shared.sort_by(|(_, a), (_, b)| b.shared_m2.total_cmp(&a.shared_m2));
    let mut is_taken = areas.each_ref().map(|areas| vec![false; areas.plan.len()]);
    let mut compared = Vec::new();
    for ((i, j), difference) in shared {
        if is_taken[0][i] || is_taken[1][j] {
            continue;
        }
        (is_taken[0][i], is_taken[1][j]) = (true, true);
        let together = first.plan[i] + second.plan[j] - difference.shared_m2;
        compared.push(Compared {
            first: Some(id(i)),
            second: Some(id(j)),
            overlap: difference.shared_m2 / together,
            area_m2: [first.sloped[i], second.sloped[j]],
            above_m: Some(difference.volume_m3 / difference.shared_m2),
            largest_m: Some(difference.largest_m),
            slope_deg: None,
        });
    }
    for (side, taken) in is_taken.iter().enumerate() {
        for i in (0..taken.len()).filter(|&i| !taken[i]) {
            let of_side = |k: usize| (k == side).then(|| id(i));
            let mut area_m2 = [0.0; 2];
            area_m2[side] = areas[side].sloped[i];
            compared.push(Compared {
                first: of_side(0),
                second: of_side(1),
                overlap: 0.0,
                area_m2,
                above_m: None,
                largest_m: None,
                slope_deg: None,
            });
        }
    }
    compared
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::super::tests::{gable, hip, roof};
    use super::*;
    use crate::base::math::atan;
    use crate::roofs::solids::close_buildings;

    fn model(facets: Vec<Facet>) -> RoofModel {
        close_buildings(&facets, |_| 0.0).0
    }

    #[test]
    fn a_model_is_like_itself() {
        let model = model(hip());
        let found = compare(&model, &model);
        assert_eq!(found.facets.len(), 4);
        for part in &found.facets {
            assert_eq!(part.first, part.second);
            assert!((part.overlap - 1.0).abs() < 1e-9 && part.above_m.unwrap().abs() < 1e-9);
        }
        assert_eq!(found.buildings.len(), 1);
    }

    #[test]
    fn a_raised_and_shifted_copy_differs_by_that() {
        let (raise, shift) = (0.3, 0.5);
        let own = model(gable());
        // Along the ridge, so that the slopes stay above each other.
        let by = Vector3::new(shift, 0.0, raise);
        let found = compare(&own.clone().relative_to(&-by), &own);
        let [building] = &found.buildings[..] else {
            panic!("{found:?}");
        };
        let expected = (10.0 - shift) / (10.0 + shift);
        assert!((building.overlap - expected).abs() < 1e-9, "{building:?}");
        assert!((building.above_m.unwrap() - raise).abs() < 1e-9);
        assert!((building.largest_m.unwrap() - raise).abs() < 1e-9);
        let area = 80.0 * 1.25f64.sqrt();
        assert!(building.area_m2.iter().all(|own| (own - area).abs() < 1e-9));
        assert_eq!(found.facets.len(), 2);
        let [slope, other] = found.facets[0].slope_deg.unwrap();
        assert!((slope - atan(0.5).to_degrees()).abs() < 1e-9 && (slope - other).abs() < 1e-9);
    }

    #[test]
    fn what_only_one_has_is_named() {
        let both = model(gable());
        let mut more = gable();
        more.push(roof(
            &[(30.0, 0.0), (34.0, 0.0), (34.0, 4.0), (30.0, 4.0)],
            [3.0, 0.0, 0.0],
        ));
        let found = compare(&both, &model(more));
        let alone: Vec<_> = found
            .buildings
            .iter()
            .filter(|b| b.first.is_none())
            .collect();
        assert_eq!(alone.len(), 1);
        assert_eq!((alone[0].area_m2, alone[0].above_m), ([0.0, 16.0], None));
        let turned = compare(&model(vec![]), &both);
        assert!(
            turned
                .facets
                .iter()
                .all(|f| f.first.is_none() && f.second.is_some())
        );
        assert_eq!(turned.facets.len(), 2);
    }
}
