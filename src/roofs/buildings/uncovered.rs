//! Where a roof may be and the model has none: nothing that was seen stays silent.
//!
//! Two witnesses are asked. A facet that was weighed and rejected says so with its probability; a
//! surface of dense matching that is likelier a building than not, where no facet covers it.

use std::collections::BTreeSet;

use nalgebra::{Point2, Point3};
use serde::Serialize;

use crate::base::evidence::Evidence;
use crate::base::geometry::{Polygon, mean_point};
use crate::planes::dense::{DensePlane, DenseTrace, least_rectangle};
use crate::roofs::facets::{FacetRejection, RejectedFacet};
use crate::roofs::model::RoofModel;

/// A place where a roof may be and no facet of the model is.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct UncoveredRoof {
    /// Its outline, in one plane, counter-clockwise from above, metres, local frame; around a
    /// surface of dense matching the least rectangle.
    pub outline: Vec<Point3<f64>>,
    /// Area in plan that no facet covers, square metres.
    pub area_m2: f64,
    /// Probability that a roof is there, 0 to 1.
    pub probability: f64,
    /// Why no facet is there.
    pub why: WhyUncovered,
}

/// Why a place where a roof may be has no facet.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum WhyUncovered {
    /// A facet there was rejected as improbable.
    Rejected {
        /// Its place among the rejected facets.
        facet: usize,
        /// What speaks for it and against it.
        evidence: Evidence,
    },
    /// Dense matching has a surface there, and no plane won the place.
    NoPlane,
}

/// From this probability on a person is asked: what is likelier no roof, but not by far.
pub(crate) const ASKED_PROBABILITY: f64 = 0.1;

/// The places where a roof may be and `model` has none, the largest first.
pub fn uncovered_roofs(
    model: &RoofModel,
    rejected: &[RejectedFacet],
    surfaces: Option<(&[DensePlane], &DenseTrace)>,
) -> Vec<UncoveredRoof> {
    let mut covered: Vec<Polygon> = model.facets.iter().map(|facet| facet.plan()).collect();
    let of_rejected = of_rejected(rejected);
    let surfaces = surfaces.map(|surfaces| of_surfaces(&covered, surfaces));
    let mut found = surfaces.unwrap_or_default();
    for roof in &mut found {
        let middle = mean_point(&roof.outline).xy();
        let tried = of_rejected
            .iter()
            .find(|one| plan(&one.outline).contains(&middle));
        roof.why = tried.map_or(WhyUncovered::NoPlane, |one| one.why.clone());
    }
    covered.extend(found.iter().map(|roof| plan(&roof.outline)));
    // Several planes at one place are one roof: the largest.
    for roof in of_rejected {
        if !is_covered(&covered, &mean_point(&roof.outline).xy()) {
            covered.push(plan(&roof.outline));
            found.push(roof);
        }
    }
    found.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    found
}

/// Rejected facets that may be roofs, the largest first.
fn of_rejected(rejected: &[RejectedFacet]) -> Vec<UncoveredRoof> {
    let may_be_roof = |(facet, rejected): (usize, &RejectedFacet)| {
        let FacetRejection::Improbable { evidence } = &rejected.reason else {
            return None;
        };
        let evidence = evidence.clone();
        let probability = evidence.probability();
        (probability >= ASKED_PROBABILITY).then(|| UncoveredRoof {
            outline: rejected.outline.clone(),
            area_m2: plan(&rejected.outline).area(),
            probability,
            why: WhyUncovered::Rejected { facet, evidence },
        })
    };
    let mut candidates: Vec<UncoveredRoof> = rejected
        .iter()
        .enumerate()
        .filter_map(may_be_roof)
        .collect();
    candidates.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
    candidates
}

/// Surfaces of dense matching that are buildings, where no facet covers them. Windows reach over
/// the borders of roofs: only places with open ones all around count, and what touches these.
fn of_surfaces(
    facets: &[Polygon],
    (planes, trace): (&[DensePlane], &DenseTrace),
) -> Vec<UncoveredRoof> {
    let cell = |patch: &usize| {
        let at = trace.patches.get(*patch)?.middle / trace.spacing_m;
        Some([at.x, at.y].map(|v| v.floor() as i64))
    };
    let middle = |[x, y]: [i64; 2]| Point2::new(x as f64 + 0.5, y as f64 + 0.5) * trace.spacing_m;
    let is_building = |plane: &&DensePlane| plane.class.is_building();
    let buildings: Vec<&DensePlane> = planes.iter().filter(is_building).collect();
    let open = |plane: &&DensePlane| -> BTreeSet<[i64; 2]> {
        let cells = plane.patches.iter().filter_map(cell);
        cells
            .filter(|cell| !is_covered(facets, &middle(*cell)))
            .collect()
    };
    let of_planes: Vec<BTreeSet<[i64; 2]>> = buildings.iter().map(open).collect();
    let of_all: BTreeSet<[i64; 2]> = of_planes.iter().flatten().copied().collect();
    let is_inner = |cell: &[i64; 2]| around(cell).all(|next| of_all.contains(&next));
    let mut found = Vec::new();
    for (DensePlane { plane, class, .. }, open) in buildings.into_iter().zip(&of_planes) {
        for part in connected(open.iter().copied().filter(is_inner).collect(), open) {
            let middles: Vec<Point2<f64>> = part.iter().copied().map(middle).collect();
            let corners = least_rectangle(&middles, 0.5 * trace.spacing_m, plane);
            found.push(UncoveredRoof {
                outline: corners.map(|p| plane.lift(p.x, p.y)).to_vec(),
                area_m2: part.len() as f64 * trace.spacing_m * trace.spacing_m,
                probability: class.building,
                why: WhyUncovered::NoPlane,
            });
        }
    }
    found
}

/// Connected inner cells with the open ones that touch them.
fn connected(mut inner: BTreeSet<[i64; 2]>, open: &BTreeSet<[i64; 2]>) -> Vec<BTreeSet<[i64; 2]>> {
    let mut parts = Vec::new();
    while let Some(start) = inner.pop_first() {
        let (mut part, mut front) = (BTreeSet::from([start]), vec![start]);
        while let Some(cell) = front.pop() {
            part.extend(around(&cell).filter(|next| open.contains(next)));
            front.extend(around(&cell).filter(|next| inner.remove(next)));
        }
        parts.push(part);
    }
    parts
}

/// The eight cells around one.
fn around(&[x, y]: &[i64; 2]) -> impl Iterator<Item = [i64; 2]> {
    let offsets = (-1..=1).flat_map(|row| (-1..=1).map(move |column| [column, row]));
    (offsets.filter(|offset| *offset != [0, 0])).map(move |[column, row]| [x + column, y + row])
}

fn plan(ring: &[Point3<f64>]) -> Polygon {
    Polygon {
        rings: vec![ring.iter().map(Point3::xy).collect()],
    }
}

fn is_covered(polygons: &[Polygon], p: &Point2<f64>) -> bool {
    polygons.iter().any(|polygon| polygon.contains(p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::Plane;
    use crate::planes::dense::{Patch, SurfaceClass};
    use crate::roofs::model::Facet;
    use crate::roofs::testing::facet;
    use nalgebra::{Vector2, Vector3};

    const ROOF_Z: f64 = 5.0;
    const SPACING_M: f64 = 0.5;

    /// A level surface over 10 m by 6 m from the origin, likelier a building or not.
    fn surface(building: f64) -> (Vec<DensePlane>, DenseTrace) {
        let places = (0..12).flat_map(|row| (0..20).map(move |column| (column, row)));
        let middle = |(column, row): (i32, i32)| {
            Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5) * SPACING_M
        };
        let patch = |place| Patch {
            middle: middle(place),
            z: ROOF_Z,
            gradient: Vector2::zeros(),
            correlation: 0.9,
            weight: 1.0,
        };
        let trace = DenseTrace {
            patches: places.map(patch).collect(),
            spacing_m: SPACING_M,
            ..DenseTrace::default()
        };
        let plane = DensePlane {
            plane: Plane {
                normal: Vector3::z(),
                d: -ROOF_Z,
            },
            covariance: [[0.0; 3]; 3],
            ring: Vec::new(),
            patches: (0..trace.patches.len()).collect(),
            area_m2: 60.0,
            rms_m: 0.0,
            class: SurfaceClass {
                building,
                ground: 1.0 - building,
                vegetation: 0.0,
            },
        };
        (vec![plane], trace)
    }

    fn level([[x0, y0], [x1, y1]]: [[f64; 2]; 2]) -> Facet {
        let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
        facet(&corners.map(|[x, y]| Point3::new(x, y, ROOF_Z)))
    }

    fn with(facets: &[[[f64; 2]; 2]]) -> RoofModel {
        RoofModel {
            facets: facets.iter().copied().map(level).collect(),
            ..RoofModel::default()
        }
    }

    fn uncovered(model: &RoofModel, building: f64) -> Vec<UncoveredRoof> {
        let (planes, trace) = surface(building);
        uncovered_roofs(model, &[], Some((&planes, &trace)))
    }

    #[test]
    fn a_building_without_a_facet_is_named_with_its_place() {
        let found = uncovered(&with(&[]), 0.8);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].why, WhyUncovered::NoPlane);
        assert!((found[0].area_m2 - 60.0).abs() < 1e-9 && found[0].probability == 0.8);
        let outline = plan(&found[0].outline);
        assert!((outline.area() - 60.0).abs() < 1e-9 && outline.signed_area() > 0.0);
        assert!(found[0].outline.iter().all(|p| (p.z - ROOF_Z).abs() < 1e-9));
        assert!(uncovered(&with(&[]), 0.4).is_empty(), "likelier ground");
    }

    #[test]
    fn what_a_facet_covers_and_a_strip_beside_it_is_no_open_place() {
        assert!(uncovered(&with(&[[[0.0, 0.0], [10.0, 6.0]]]), 0.8).is_empty());
        // Windows over the eave reach a metre beyond it.
        assert!(uncovered(&with(&[[[0.0, 0.0], [9.0, 6.0]]]), 0.8).is_empty());
        let beside = uncovered(&with(&[[[0.0, 0.0], [6.0, 6.0]]]), 0.8);
        assert_eq!(beside.len(), 1);
        assert!((beside[0].area_m2 - 24.0).abs() < 1e-9);
        // A facet across the middle leaves two.
        let halves = uncovered(&with(&[[[4.0, -1.0], [5.0, 7.0]]]), 0.8);
        let areas: Vec<f64> = halves.iter().map(|roof| roof.area_m2).collect();
        assert_eq!(areas, [30.0, 24.0]);
    }

    #[test]
    fn a_surface_says_which_facet_was_rejected_there() {
        let rejected = |prior: f64| {
            let evidence = Evidence {
                prior,
                terms: Vec::new(),
            };
            [RejectedFacet {
                group: 0,
                outline: level([[1.0, 1.0], [9.0, 5.0]]).outer,
                reason: FacetRejection::Improbable { evidence },
            }]
        };
        let (planes, trace) = surface(0.8);
        let surfaces = || Some((&planes[..], &trace));
        let found = uncovered_roofs(&with(&[]), &rejected(-1.0), surfaces());
        let is_rejected =
            |roof: &UncoveredRoof| matches!(roof.why, WhyUncovered::Rejected { facet: 0, .. });
        assert!(found.len() == 1 && is_rejected(&found[0]) && found[0].area_m2 > 59.0);
        let alone = uncovered_roofs(&with(&[]), &rejected(-1.0), None);
        assert!(alone.len() == 1 && is_rejected(&alone[0]));
        assert!((alone[0].area_m2 - 32.0).abs() < 1e-9);
        let covered = with(&[[[0.0, 0.0], [10.0, 6.0]]]);
        assert!(uncovered_roofs(&covered, &rejected(-1.0), surfaces()).is_empty());
        let found = uncovered_roofs(&with(&[]), &rejected(-4.0), surfaces());
        assert_eq!(
            found[0].why,
            WhyUncovered::NoPlane,
            "the rejected one is no roof"
        );
    }
}
