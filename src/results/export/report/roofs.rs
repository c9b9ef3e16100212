//! The roofs as one JSON file for programs: faces with the fields of Google's Solar API
//! (`roofSegmentStats`), and edges, polygons, standard deviations, what setbacks leave.
//!
//! Positions are `[x, y, z]` in the world frame of the input, metres; `center` and `boundingBox`
//! are latitude and longitude, `null` where the place on the Earth is not known. The schema is
//! `docs/roofs.schema.json`.

use nalgebra::{Point2, Point3, Vector3};
use serde_json::{Value, json};

use super::super::format::{rounded, to_bytes};
use super::reported::ReportedModel;
use crate::base::geometry::{Polygon, bounds, mean_point};
use crate::base::ids::FacetId;
use crate::results::roof_report::{BuildingReport, EdgeReport, Estimate, FacetReport};
use crate::roofs::model::{Facet, Obstruction};

/// The file.
pub(super) fn roofs(reported: &ReportedModel) -> Vec<u8> {
    let setbacks = reported.setbacks.iter().map(|rule| {
        let by_kind = rule.setbacks_m.iter().map(|(kind, m)| (kind.name(), *m));
        json!({
            "name": rule.name,
            "title": rule.title,
            "source": rule.source,
            "aboveSlope": rule.above_slope,
            "obstructionMeters": rule.obstruction_m,
            "setbackMeters": by_kind.collect::<std::collections::BTreeMap<_, _>>(),
        })
    });
    let mut file = json!({
        "coordinates": reported.system,
        "setbacks": setbacks.collect::<Value>(),
        "buildings": (reported.buildings.iter())
            .map(|building| building_of(reported, building))
            .collect::<Value>(),
    });
    if let Some(frame) = &reported.survey.frame_sigma {
        file["frame"] = json!({
            "lengthOf10SigmaMeters": frame.length_of_10_m,
            "heightOver10SigmaMeters": frame.height_over_10_m,
        });
    }
    to_bytes(&file)
}

fn building_of(reported: &ReportedModel, report: &BuildingReport) -> Value {
    let facets = || {
        report
            .facets
            .iter()
            .map(|f| &reported.model.facets[f.facet.index()])
    };
    let corners: Vec<Point3<f64>> = facets().flat_map(|f| f.outer.iter().copied()).collect();
    let usable = (reported.setbacks.iter().zip(&report.usable_m2)).map(|(rule, area)| {
        let mut usable = json!({ "setbacks": rule.name });
        add(&mut usable, "area", "Meters2", *area);
        usable
    });
    json!({
        "name": reported.names[report.building.index()],
        "probability": rounded(report.probability, 4),
        "center": reported.lat_lon(&mean_point(&corners)),
        "boundingBox": bounding_box(reported, &corners),
        "wholeRoofStats": stats(report.area_m2, report.plan_area_m2),
        "usable": usable.collect::<Value>(),
        "roofSegmentStats": (report.facets.iter())
            .map(|facet| segment(reported, facet))
            .collect::<Value>(),
        "edges": report.edges.iter().map(|edge| edge_of(reported, edge)).collect::<Value>(),
    })
}

fn segment(reported: &ReportedModel, report: &FacetReport) -> Value {
    let facet = &reported.model.facets[report.facet.index()];
    let center = reported.center(report);
    let usable = (reported.setbacks.iter().zip(&report.usable)).map(|(rule, of)| {
        let parts = of.plan.parts();
        let mut usable = json!({
            "setbacks": rule.name,
            "polygons": parts.iter().map(|part| rings(reported, facet, part)).collect::<Value>(),
        });
        add(&mut usable, "area", "Meters2", of.area_m2);
        usable
    });
    let mut segment = json!({
        "facet": report.facet.number(),
        "probability": rounded(report.probability, 4),
        "center": reported.lat_lon(&center),
        "centerMeters": world(reported, &center),
        "boundingBox": bounding_box(reported, &facet.outer),
        "stats": stats(report.area_m2, report.plan_area_m2),
        "polygon": rings(reported, facet, &facet.plan()),
        "usable": usable.collect::<Value>(),
        "obstructions": (facet.obstructions.iter())
            .map(|obstruction| obstruction_of(reported, facet, obstruction))
            .collect::<Value>(),
        "photographs": reported.photographs[report.facet.index()],
        "pvgis": reported.pvgis(report),
    });
    add(&mut segment, "pitch", "Degrees", report.slope_deg);
    // As Google has it, a level face looks to the north.
    let level = Estimate {
        value: 0.0,
        sigma: None,
    };
    let azimuth = reported.azimuth_deg(report).unwrap_or(level);
    add(&mut segment, "azimuth", "Degrees", azimuth);
    let height = Estimate {
        value: center.z + reported.origin.z,
        sigma: facet.uncertainty.as_ref().map(|known| known.height_m),
    };
    add(&mut segment, "planeHeightAtCenter", "Meters", height);
    segment
}

/// What stands on a face: its outline there, and how high it rises above it.
fn obstruction_of(reported: &ReportedModel, facet: &Facet, obstruction: &Obstruction) -> Value {
    let outline = Polygon::from(obstruction.outline.clone());
    let mut value = json!({
        "polygon": rings(reported, facet, &outline),
        "groundAreaMeters2": rounded(outline.area(), 4),
        "probability": rounded(obstruction.probability, 4),
    });
    let height = Estimate {
        value: obstruction.height_m,
        sigma: obstruction.height_sigma_m,
    };
    add(&mut value, "height", "Meters", height);
    value
}

fn edge_of(reported: &ReportedModel, report: &EdgeReport) -> Value {
    let edge = &report.edge;
    let mut value = json!({
        "class": edge.kind.name(),
        "facet": edge.facet.number(),
        "otherFacet": edge.other.map(FacetId::number),
        "from": world(reported, &edge.segment.p0),
        "to": world(reported, &edge.segment.p1),
    });
    add(&mut value, "length", "Meters", report.length_m);
    value
}

fn stats(area: Estimate, in_plan: Estimate) -> Value {
    let mut stats = json!({});
    add(&mut stats, "area", "Meters2", area);
    add(&mut stats, "groundArea", "Meters2", in_plan);
    stats
}

/// Adds a number and its standard deviation, `null` where that is not known.
fn add(to: &mut Value, quantity: &str, unit: &str, estimate: Estimate) {
    let number = |n: Option<f64>| json!(n.map(|n| rounded(n, 4)));
    to[format!("{quantity}{unit}")] = number(Some(estimate.value));
    to[format!("{quantity}Sigma{unit}")] = number(estimate.sigma);
}

fn world(reported: &ReportedModel, p: &Point3<f64>) -> [f64; 3] {
    let p: Vector3<f64> = (p + reported.origin).coords;
    p.map(|c| rounded(c, 4)).into()
}

/// Rings on a facet's plane, not closed.
fn rings(reported: &ReportedModel, facet: &Facet, polygon: &Polygon) -> Value {
    let corner = |p: &Point2<f64>| world(reported, &facet.plane.lift(p.x, p.y));
    let ring = |ring: &Vec<Point2<f64>>| ring.iter().map(corner).collect::<Vec<_>>();
    json!(polygon.rings.iter().map(ring).collect::<Vec<_>>())
}

/// The corners of a box in latitude and longitude.
fn bounding_box(reported: &ReportedModel, corners: &[Point3<f64>]) -> Value {
    let places = corners.iter().map(|p| reported.geographic(p));
    let places: Option<Vec<Point2<f64>>> = places.map(|p| Some(Point2::from(p?))).collect();
    let Some(places) = places else {
        return Value::Null;
    };
    let [sw, ne] = bounds(places).map(|p| ReportedModel::named(p.into()));
    json!({ "sw": sw, "ne": ne })
}
