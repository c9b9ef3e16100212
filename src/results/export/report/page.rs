//! The page: one HTML file that needs no other, for the screen and for paper (A4 and letter).

use nalgebra::{Point2, Vector2};

use super::axonometric::axonometric;
use super::html::{Html, area_with_unit, measure, with_sigma};
use super::plan::{Plan, building_plan, overview};
use super::reported::ReportedModel;
use super::sheet::{sheet, sources, words};
use super::svg::{Drawing, escaped};
use crate::base::math::sin_cos;
use crate::results::roof_report::{BuildingReport, Estimate, FacetReport, RoofEdgeKind};

const STYLE: &str = include_str!("style.css");

/// What the figures are and what is assumed of their standard deviations.
const EXPLANATION: &str = "Lengths and areas are those of the roof's facets, without thickness and \
    overhang below; heights and volumes are above the ground as the model has it. After ± stands one \
    standard deviation, from the adjustment of the roof to the edges in all photographs; how well \
    the ground is known is not in it. Corners are taken as known independently of each other, \
    heights of one building as off by the same. A figure without ± belongs to a facet of which the \
    photographs show too few edges.";

/// The whole page.
pub(super) fn page(reported: &ReportedModel) -> String {
    let mut html = Html::default();
    html.push(format_args!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>Roof report</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>Roof report</h1>\n\
         <input type=\"checkbox\" id=\"feet\"/><label for=\"feet\">Feet</label>\n<main>\n"
    ));
    let photographs = photographs(reported);
    summary(&mut html, reported);
    for (index, report) in reported.buildings.iter().enumerate() {
        building(&mut html, reported, index, report, &photographs);
    }
    if !photographs.is_empty() {
        html.push(format_args!("<section>\n<h2>Photographs</h2>\n"));
        html.head(&["Number", "<Photograph", "Facets that it shows"]);
        for (i, name) in photographs.iter().enumerate() {
            let shows = |of: &&Vec<String>| of.contains(name);
            let facets = reported.photographs.iter().filter(shows).count();
            html.row(&[(i + 1).to_string(), escaped(name), facets.to_string()]);
        }
        html.end_table();
        let note = "It shows a facet that it sees at least half of, past the other roofs.";
        html.push(format_args!("<p class=\"note\">{note}</p>\n</section>\n"));
    }
    sources(&mut html, reported);
    html.push(format_args!("</main>\n</body>\n</html>\n"));
    html.text
}

/// All photographs that show a facet, sorted.
fn photographs(reported: &ReportedModel) -> Vec<String> {
    let mut names: Vec<String> = reported.photographs.concat();
    names.sort();
    names.dedup();
    names
}

/// What the figures are, and what the frame is worth where that is stated.
fn explanation(reported: &ReportedModel) -> String {
    let frame = reported.survey.frame_sigma.as_ref();
    let frame = frame.map(|frame| {
        let words = frame.words().replace("+-", "±");
        format!(" The frame is in it, too: {words}.")
    });
    EXPLANATION.to_owned() + &frame.unwrap_or_default()
}

fn summary(html: &mut Html, reported: &ReportedModel) {
    let buildings = &reported.buildings;
    let facets: usize = buildings.iter().map(|b| b.facets.len()).sum();
    let area = area_with_unit(buildings.iter().map(|b| b.area_m2.value).sum());
    let system = match &reported.system {
        Some(system) => format!("Coordinates: {}.", escaped(system)),
        None => "The coordinate system is that of the input, which does not name it.".into(),
    };
    if buildings.is_empty() {
        html.push(format_args!(
            "<p>No building was found.</p>\n<p class=\"note\">{system}</p>\n"
        ));
        return;
    }
    html.push(format_args!(
        "<p>Buildings: {}. Roof facets: {facets}, {area} in all. {system}</p>\n<p class=\"note\">{}</p>\n",
        buildings.len(),
        explanation(reported)
    ));
    figure(
        html,
        &overview(reported),
        "All buildings with their numbers",
    );
    legend(html);
    html.head(&[
        "Building",
        "Facets",
        "Roof area, m²",
        "In plan, m²",
        "Lowest eave, m",
        "Highest point, m",
        "Volume, m³",
        "Walls seen",
        "Within walls, m³",
        "Probability",
    ]);
    let named = reported.names.iter().zip(&reported.walls);
    for (report, (name, walls)) in buildings.iter().zip(named) {
        let seen = walls.count.map(|[all, seen]| format!("{seen} of {all}"));
        let within = walls.volume_m3.map(|value| Estimate { value, sigma: None });
        let within = within.map(|volume| measure(volume, 3, 0));
        html.row(&[
            &escaped(name),
            &report.facets.len().to_string(),
            &measure(report.area_m2, 2, 1),
            &measure(report.plan_area_m2, 2, 1),
            &measure(report.lowest_m, 1, 2),
            &measure(report.highest_m, 1, 2),
            &measure(report.volume_m3, 3, 0),
            &seen.unwrap_or_default(),
            &within.unwrap_or_default(),
            &percent(report.probability),
        ]);
    }
    html.end_table();
}

/// A sample of each kind of edge.
fn legend(html: &mut Html) {
    html.push(format_args!("<ul class=\"legend\">"));
    for kind in RoofEdgeKind::ALL {
        let mut sample = Drawing::new(Vector2::new(10.0, 2.0), words(kind));
        let (a, b) = (Point2::new(0.5, 1.0), Point2::new(9.5, 1.0));
        sample.line(a, b, &format!("edge {}", kind.name()));
        html.push(format_args!(
            "<li>{}{}</li>",
            sample.finish().trim_end(),
            words(kind)
        ));
    }
    html.push(format_args!("</ul>\n"));
}

fn building(
    html: &mut Html,
    reported: &ReportedModel,
    index: usize,
    report: &BuildingReport,
    photographs: &[String],
) {
    let name = escaped(&reported.names[index]);
    html.push(format_args!("<section>\n<h2>{name}</h2>\n"));
    let sides = [0, 1, 2, 3].map(|side| axonometric(reported, index, side));
    let sides = sides.concat();
    html.push(format_args!("<figure class=\"sides\">{sides}</figure>\n"));
    let caption = "Lengths along the roof; numbers of facets with slope and fall";
    figure(html, &building_plan(reported, report), caption);
    html.push(format_args!("<h3>Facets</h3>\n"));
    html.head(&[
        "Facet",
        "Area, m²",
        "In plan, m²",
        "Slope, °",
        "Pitch",
        "Falls to, °",
        "Lowest, m",
        "Highest, m",
        "Probability",
        "<Photographs",
    ]);
    for facet in &report.facets {
        let own = &reported.photographs[facet.facet.index()];
        let numbers = own
            .iter()
            .filter_map(|name| photographs.binary_search(name).ok());
        let numbers: Vec<String> = numbers.map(|i| (i + 1).to_string()).collect();
        html.row(&[
            &facet.facet.number().to_string(),
            &measure(facet.area_m2, 2, 2),
            &measure(facet.plan_area_m2, 2, 2),
            &with_sigma(facet.slope_deg, 1),
            &pitch(facet.slope_deg.value),
            &facet.azimuth_deg.map_or_else(|| "level".into(), direction),
            &measure(facet.lowest_m, 1, 2),
            &measure(facet.highest_m, 1, 2),
            &percent(facet.probability),
            &numbers.join(" "),
        ]);
    }
    html.end_table();
    html.push(format_args!("<h3>Lengths of facets</h3>\n"));
    lengths(html, report);
    sheet(html, reported, report);
    html.push(format_args!("</section>\n"));
}

/// Lengths by kind, of every facet.
fn lengths(html: &mut Html, report: &BuildingReport) {
    let kinds = || (0..RoofEdgeKind::ALL.len()).filter(|&k| report.lengths[k].is_some());
    let mut head = vec!["Facet".to_owned()];
    head.extend(kinds().map(|k| format!("{}, m", words(RoofEdgeKind::ALL[k]))));
    html.head(&head);
    for FacetReport { facet, lengths, .. } in &report.facets {
        let field = |k: usize| lengths[k].map_or_else(String::new, |l| measure(l, 1, 2));
        let mut fields = vec![facet.number().to_string()];
        fields.extend(kinds().map(field));
        html.row(&fields);
    }
    html.end_table();
}

fn figure(html: &mut Html, plan: &Plan, caption: &str) {
    let Plan { svg, scale } = plan;
    html.push(format_args!(
        "<figure>{svg}<figcaption>{caption}; 1:{scale} where it is printed at its size.</figcaption></figure>\n"
    ));
}

/// A slope as its rise on a run of twelve.
fn pitch(slope_deg: f64) -> String {
    let (sin, cos) = sin_cos(slope_deg.to_radians());
    format!("{:.1}:12", 12.0 * sin / cos)
}

/// A direction as an angle and a point of the compass.
fn direction(azimuth: Estimate) -> String {
    const POINTS: [&str; 8] = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"];
    let point = (azimuth.value / 45.0).round() as usize % POINTS.len();
    format!("{} {}", with_sigma(azimuth, 1), POINTS[point])
}

fn percent(probability: f64) -> String {
    format!("{:.0} %", 100.0 * probability)
}
