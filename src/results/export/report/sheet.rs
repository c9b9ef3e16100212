//! What roofers and planners of solar panels ask for: lengths by class, the covering with waste,
//! what setbacks leave of each facet.

use super::html::{Html, in_feet, measure, with_feet};
use super::reported::ReportedModel;
use super::svg::escaped;
use crate::results::roof_report::{BuildingReport, Estimate, RoofEdgeKind, WasteTable};

/// A kind of edge in words.
pub(super) fn words(kind: RoofEdgeKind) -> &'static str {
    match kind {
        RoofEdgeKind::Ridge => "Ridge",
        RoofEdgeKind::Hip => "Hip",
        RoofEdgeKind::Valley => "Valley",
        RoofEdgeKind::Transition => "Change of slope",
        RoofEdgeKind::Eave => "Eave",
        RoofEdgeKind::Rake => "Rake",
        RoofEdgeKind::TopEdge => "Top edge",
        RoofEdgeKind::Abutment => "Abutment",
    }
}

/// The tables of a building.
pub(super) fn sheet(html: &mut Html, reported: &ReportedModel, report: &BuildingReport) {
    html.push(format_args!(
        "<h3>Lengths of the roof, each edge once</h3>\n"
    ));
    html.head(&["Class", "Edges", "Length, m"]);
    for (kind, length) in RoofEdgeKind::ALL.into_iter().zip(report.lengths) {
        if let Some(length) = length {
            let count = report.edges.iter().filter(|e| e.edge.kind == kind).count();
            html.row(&[words(kind), &count.to_string(), &measure(length, 1, 2)]);
        }
    }
    html.end_table();
    waste(html, report);
    usable(html, reported, report);
}

fn waste(html: &mut Html, report: &BuildingReport) {
    let table = WasteTable::built_in();
    let class = table.class_of(report.cut_m_per_m2());
    html.push(format_args!(
        "<h3>Covering with waste: {}</h3>\n",
        class.words
    ));
    let mut head = vec!["Added".to_owned()];
    head.extend(table.percents.iter().map(|percent| format!("{percent} %")));
    html.head(&head);
    let mut row = |name: &str, field: &dyn Fn(f64) -> String| {
        let mut fields = vec![name.to_owned()];
        fields.extend(table.percents.iter().map(|&percent| {
            let field = field(report.area_m2.value * (1.0 + f64::from(percent) / 100.0));
            match percent == class.percent {
                true => format!("<b>{field}</b>"),
                false => field,
            }
        }));
        html.row(&fields);
    };
    let area = |value| measure(Estimate { value, sigma: None }, 2, 1);
    row(&with_feet("Area, m²"), &area);
    row("Squares of 100 ft²", &|m2| {
        format!("{:.1}", in_feet(m2, 2) / 100.0)
    });
    html.end_table();
}

fn usable(html: &mut Html, reported: &ReportedModel, report: &BuildingReport) {
    html.push(format_args!("<h3>Area that setbacks leave</h3>\n"));
    let mut head = vec!["Facet".to_owned()];
    head.extend(
        reported
            .setbacks
            .iter()
            .map(|rule| format!("{}, m²", rule.name)),
    );
    head.push("<Yield".to_owned());
    html.head(&head);
    for facet in &report.facets {
        let mut fields = vec![facet.facet.number().to_string()];
        fields.extend(facet.usable.iter().map(|of| measure(of.area_m2, 2, 2)));
        let link = reported.pvgis(facet).map(|address| {
            let address = escaped(&address);
            format!("<a href=\"{address}\" target=\"_blank\" rel=\"noopener\">PVGIS</a>")
        });
        fields.push(link.unwrap_or_default());
        html.row(&fields);
    }
    let mut fields = vec!["all".to_owned()];
    fields.extend(report.usable_m2.iter().map(|area| measure(*area, 2, 2)));
    fields.push(String::new());
    html.row(&fields);
    html.end_table();
}

/// Where the rules and the table come from.
pub(super) fn sources(html: &mut Html, reported: &ReportedModel) {
    html.push(format_args!("<h2>Rules</h2>\n<dl class=\"note\">\n"));
    for rule in &reported.setbacks {
        let [name, title, source] = [&rule.name, &rule.title, &rule.source].map(|s| escaped(s));
        let setbacks = rule.setbacks_m.iter().filter(|(_, m)| **m > 0.0);
        let setbacks = setbacks.map(|(kind, m)| format!(" {} {m} m.", words(*kind)));
        let setbacks: String = setbacks.collect();
        html.push(format_args!(
            "<dt>{name}: {title}</dt>\n<dd>{source}{setbacks}</dd>\n"
        ));
    }
    let source = escaped(&WasteTable::built_in().source);
    let yields = "A link opens PVGIS of the Joint Research Centre with the place, slope and direction of the \
                  facet, which thereby leave this computer.";
    html.push(format_args!(
        "<dt>Waste</dt>\n<dd>{source}</dd>\n<dt>Yield</dt>\n<dd>{yields}</dd>\n</dl>\n"
    ));
}
