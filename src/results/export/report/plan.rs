//! Plans, north up, to a round scale: of one building with dimensions, and of all buildings.

use nalgebra::{Point2, Point3, Vector2};

use super::html::in_feet;
use super::reported::ReportedModel;
use super::svg::{Drawing, place_inside};
use crate::base::geometry::Polygon;
use crate::base::math::atan2;
use crate::results::roof_report::{BuildingReport, RoofEdge};
use crate::roofs::model::Facet;

/// The largest plan that fits a page of A4 or letter, millimetres.
const PAGE: Vector2<f64> = Vector2::new(178.0, 128.0);

/// Room around it for words, millimetres.
const MARGIN: f64 = 7.0;

/// Edges shorter than this on paper have no dimension; it is in the table. Millimetres.
const LEAST_WITH_DIMENSION: f64 = 7.5;

/// Dimensions stand so far from their edge, millimetres.
const DIMENSION_OFFSET_MM: f64 = 1.7;

/// A plan, and the scale that it is drawn to, as 200 for 1:200.
pub(super) struct Plan {
    pub(super) svg: String,
    pub(super) scale: f64,
}

/// From the model to the paper.
struct Sheet {
    low: Point2<f64>,
    high: Point2<f64>,
    mm_per_m: f64,
}

impl Sheet {
    fn new<'a>(points: impl Iterator<Item = &'a Point3<f64>>) -> (Self, f64) {
        let [low, high] = crate::base::geometry::bounds(points.map(Point3::xy));
        let room = PAGE - Vector2::repeat(2.0 * MARGIN);
        let extent = high - low;
        // 1 : 20, 25, 50, 100, 200, ...
        let steps = [20.0, 25.0, 50.0, 100.0];
        let decades = (0..6).scan(1.0, |d, _| Some(std::mem::replace(d, *d * 10.0)));
        let scales = decades.flat_map(|decade| steps.map(|s| s * decade));
        let fits = |scale: &f64| (0..2).all(|i| extent[i] * 1000.0 / scale <= room[i]);
        let scale = scales.clone().find(fits).unwrap_or(1e8);
        let mm_per_m = 1000.0 / scale;
        (
            Self {
                low,
                high,
                mm_per_m,
            },
            scale,
        )
    }

    fn size(&self) -> Vector2<f64> {
        let size = (self.high - self.low) * self.mm_per_m + Vector2::repeat(2.0 * MARGIN);
        // Room for the scale bar and the arrow.
        Vector2::new(size.x.max(50.0), size.y + 6.0)
    }

    fn at(&self, p: &Point3<f64>) -> Point2<f64> {
        let x = (p.x - self.low.x) * self.mm_per_m;
        let y = (self.high.y - p.y) * self.mm_per_m;
        Point2::new(x + MARGIN, y + MARGIN)
    }

    fn picture(&self, facet: &Facet) -> Polygon {
        let ring = |ring: &Vec<Point3<f64>>| ring.iter().map(|p| self.at(p)).collect();
        Polygon {
            rings: facet.rings().map(ring).collect(),
        }
    }

    /// A bar of a round length and an arrow to the north.
    fn draw_scale(&self, drawing: &mut Drawing) {
        let lengths = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];
        let fitting = lengths
            .into_iter()
            .rev()
            .find(|l| l * self.mm_per_m <= 30.0);
        let length = fitting.unwrap_or(1.0);
        let y = self.size().y - 3.0;
        let (a, b) = (
            Point2::new(MARGIN, y),
            Point2::new(MARGIN + length * self.mm_per_m, y),
        );
        drawing.line(a, b, "bar");
        for end in [a, b] {
            let tick = Vector2::new(0.0, 1.0);
            drawing.line(end - tick, end + tick, "bar");
        }
        let at = b + Vector2::new(6.0, 1.0);
        drawing.words(at, 0.0, "small m", &format!("{length} m"));
        let feet = in_feet(length, 1);
        drawing.words(at, 0.0, "small ft", &format!("{feet:.1} ft"));
        let foot = Point2::new(self.size().x - 5.0, y + 1.5);
        let tip = foot - Vector2::new(0.0, 7.0);
        drawing.line(foot, tip, "bar");
        for side in [-1.2, 1.2] {
            drawing.line(tip, tip + Vector2::new(side, 2.2), "bar");
        }
        drawing.words(foot - Vector2::new(3.0, 0.5), 0.0, "small", "N");
    }
}

/// The plan of a building: facets with their numbers and slopes, edges with their kinds and
/// lengths.
pub(super) fn building_plan(reported: &ReportedModel, report: &BuildingReport) -> Plan {
    let facets = || {
        report
            .facets
            .iter()
            .map(|f| &reported.model.facets[f.facet.index()])
    };
    let (sheet, scale) = Sheet::new(facets().flat_map(|f| &f.outer));
    let name = &reported.names[report.building.index()];
    let mut drawing = Drawing::new(sheet.size(), &format!("Plan of {name}"));
    for facet in facets() {
        drawing.area(&sheet.picture(facet), "class=\"facet\"");
    }
    for edge in &report.edges {
        let segment = &edge.edge.segment;
        let class = format!("edge {}", edge.edge.kind.name());
        drawing.line(sheet.at(&segment.p0), sheet.at(&segment.p1), &class);
    }
    for edge in &report.edges {
        draw_dimension(&sheet, &mut drawing, &edge.edge, edge.length_m.value);
    }
    for (facet, of) in facets().zip(&report.facets) {
        let middle = place_inside(&sheet.picture(facet));
        if of.azimuth_deg.is_some() {
            // Downhill, on paper.
            let fall = facet.plane.normal.xy().normalize();
            let fall = Vector2::new(fall.x, -fall.y);
            let left = Vector2::new(-fall.y, fall.x);
            let (from, to) = (middle + fall * 2.4, middle + fall * 5.4);
            drawing.line(from, to, "fall");
            for side in [left, -left] {
                drawing.line(to, to - fall * 1.2 + side * 0.7, "fall");
            }
        }
        drawing.words(middle, 0.0, "number", &of.facet.number().to_string());
        let slope = format!("{:.0}°", of.slope_deg.value);
        let side = if facet.plane.normal.y < 0.0 {
            -3.0
        } else {
            2.8
        };
        drawing.words(middle + Vector2::new(0.0, side), 0.0, "small", &slope);
    }
    sheet.draw_scale(&mut drawing);
    Plan {
        svg: drawing.finish(),
        scale,
    }
}

/// The length of an edge along it, outside of its facet, readable from below or from the right.
fn draw_dimension(sheet: &Sheet, drawing: &mut Drawing, edge: &RoofEdge, length: f64) {
    let (a, b) = (sheet.at(&edge.segment.p0), sheet.at(&edge.segment.p1));
    let along = b - a;
    if along.norm() < LEAST_WITH_DIMENSION {
        return;
    }
    // The facet lies to the left seen from above; y points down here.
    let out = Vector2::new(-along.y, along.x).normalize();
    let mut turn = atan2(along.y, along.x).to_degrees();
    if turn > 90.0 {
        turn -= 180.0;
    } else if turn <= -90.0 {
        turn += 180.0;
    }
    let at = nalgebra::center(&a, &b) + out * DIMENSION_OFFSET_MM;
    drawing.words(at, turn, "dimension m", &format!("{length:.2}"));
    let feet = in_feet(length, 1);
    drawing.words(at, turn, "dimension ft", &format!("{feet:.2}"));
}

/// The plan of all buildings with their numbers.
pub(super) fn overview(reported: &ReportedModel) -> Plan {
    let (sheet, scale) = Sheet::new(reported.model.facets.iter().flat_map(|f| &f.outer));
    let mut drawing = Drawing::new(sheet.size(), "Plan of all buildings");
    for facet in &reported.model.facets {
        drawing.area(&sheet.picture(facet), "class=\"facet thin\"");
    }
    for report in &reported.buildings {
        let facets = report.facets.iter();
        let largest = facets.max_by(|a, b| a.plan_area_m2.value.total_cmp(&b.plan_area_m2.value));
        let largest = largest.expect("a building has facets");
        let facet = &reported.model.facets[largest.facet.index()];
        let number = report.building.number().to_string();
        drawing.words(place_inside(&sheet.picture(facet)), 0.0, "number", &number);
    }
    sheet.draw_scale(&mut drawing);
    Plan {
        svg: drawing.finish(),
        scale,
    }
}
