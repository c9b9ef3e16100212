use nalgebra::{Point2, Point3};
use proptest::prelude::*;

use super::tests::{SIDE_M, SLOPE_DEG, gable, hip, l_shape, lean_to, roof, with_uncertainty};
use super::*;
use crate::roofs::solids::close_buildings;

fn report_of(facets: &[Facet], rules: &[SetbackRule]) -> BuildingReport {
    let (model, trace) = close_buildings(facets, |_| 0.0);
    assert_eq!(trace.rejected, []);
    roof_report(&model, rules).remove(0)
}

fn rule(setbacks_m: &str) -> SetbackRule {
    SetbackRule::read(&format!(
        r#"{{"name":"own","setbacks_m":{{{setbacks_m}}}}}"#
    ))
    .unwrap()
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-4, "{a} instead of {b}");
}

#[test]
fn a_gable_loses_its_ridge_and_its_rakes() {
    let rules = SetbackRule::built_in();
    let names: Vec<&str> = rules.iter().map(|rule| &rule.name[..]).collect();
    assert_eq!(names, ["none", "ifc-1205", "ifc-1205-large", "mbo-32"]);
    let report = report_of(&with_uncertainty(gable()), &rules);
    let south = &report.facets[0];
    let rake = 20f64.sqrt();
    let of = |rule: usize| &south.usable[rule];
    assert_eq!(of(0).area_m2, south.area_m2);
    let [wide, high] = [10.0 - 2.0 * 0.914, rake - 0.457];
    near(of(1).area_m2.value, wide * high);
    near(of(2).area_m2.value, wide * (rake - 0.914));
    near(of(3).area_m2.value, 9.0 * rake);
    near(report.usable_m2[1].value, 2.0 * wide * high);
    let [low, top] = of(1).plan.bounds();
    near(low.x, 0.914);
    near(top.x, 10.0 - 0.914);
    near(top.y, high * 0.8f64.sqrt());
    // Both rakes, ridge and eave across themselves in plan, and the tilt.
    let stretch = 1.25f64.sqrt();
    let tilt = SLOPE_DEG.to_radians() * 1.25 * wide * high / stretch * 0.5 / stretch;
    let sides = SIDE_M * SIDE_M * 2.0 * (high * high + wide * wide * 1.25);
    let sigma = of(1).area_m2.sigma.unwrap();
    assert!(
        (sigma / (sides + tilt * tilt).sqrt() - 1.0).abs() < 1e-3,
        "{sigma}"
    );
}

#[test]
fn strips_of_hips_meet_and_what_is_flat_is_exempt() {
    let report = report_of(&hip(), &[rule(r#""hip": 0.5"#)]);
    // The triangle in the east, 8 m by sqrt(20) m on its plane, between hips of 6 m.
    let triangle = &report.facets[1];
    let share = 1.0 - 0.5 * 2.0 * 6.0 / (8.0 * 20f64.sqrt());
    near(
        triangle.usable[0].area_m2.value,
        triangle.area_m2.value * share * share,
    );
    let eaves = SetbackRule {
        above_slope: 0.1667,
        ..rule(r#""eave": 1.0"#)
    };
    let report = report_of(&lean_to(), &[eaves]);
    near(report.facets[0].usable[0].area_m2.value, 36.0);
    near(
        report.facets[1].usable[0].area_m2.value,
        6.0 * (11.25f64.sqrt() - 1.0),
    );
}

#[test]
fn a_courtyard_is_a_hole_of_what_is_left() {
    let mut facet = roof(
        &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)],
        [6.0, 0.0, 0.0],
    );
    let hole = [[3.0, 3.0], [3.0, 7.0], [7.0, 7.0], [7.0, 3.0]];
    facet.holes = vec![hole.map(|[x, y]| Point3::new(x, y, 6.0)).to_vec()];
    let left = |m: f64| {
        let report = report_of(&[facet.clone()], &[rule(&format!(r#""eave": {m}"#))]);
        report.facets[0].usable[0].clone()
    };
    let ring = left(1.0);
    near(ring.area_m2.value, 64.0 - 36.0);
    assert_eq!(ring.plan.rings.len(), 2);
    assert!(
        ring.plan.contains(&Point2::new(1.5, 5.0)) && !ring.plan.contains(&Point2::new(5.0, 5.0))
    );
    let nothing = left(1.6);
    assert_eq!((nothing.area_m2.value, nothing.plan.rings.len()), (0.0, 0));
}

#[test]
fn a_rule_that_cannot_be_is_refused() {
    for (text, words) in [
        ("{", "no rule"),
        (r#"{"name":"a","setbacks_m":{"rim":1}}"#, "rim"),
        (r#"{"name":"a","setbacks_m":{"rake":-1}}"#, "0 or more"),
        (r#"{"name":"a","setbacks":{}}"#, "setbacks"),
    ] {
        let problem = SetbackRule::read(text).unwrap_err();
        assert!(problem.contains(words), "{problem}");
    }
    let own = SetbackRule::with(r#"{"name":"mbo-32","setbacks_m":{"rake":1.25}}"#).unwrap();
    assert_eq!(own.len(), SetbackRule::built_in().len());
    assert_eq!(own[3].setbacks_m[&RoofEdgeKind::Rake], 1.25);
}

#[test]
fn waste_grows_with_hips_and_valleys() {
    let table = WasteTable::built_in();
    let percent = |facets: &[Facet]| {
        table
            .class_of(report_of(facets, &[]).cut_m_per_m2())
            .percent
    };
    assert_eq!(
        [percent(&gable()), percent(&hip()), percent(&l_shape())],
        [10, 15, 15]
    );
    for facets in [gable(), hip()] {
        assert!(table.percents.contains(&percent(&facets)));
    }
}

proptest! {
    #[test]
    fn usable_areas_fall_as_setbacks_grow(
        which in 0..4usize,
        setbacks in prop::collection::vec(0.0..2.0f64, RoofEdgeKind::ALL.len()),
        more in 1.0..2.0f64,
    ) {
        let facets = [gable(), hip(), l_shape(), lean_to()][which].clone();
        let scaled = |by: f64| SetbackRule {
            setbacks_m: RoofEdgeKind::ALL.into_iter().zip(setbacks.iter().map(|m| m * by)).collect(),
            ..rule("")
        };
        let report = report_of(&facets, &[scaled(0.0), scaled(1.0), scaled(more)]);
        for facet in &report.facets {
            let areas: Vec<f64> = facet.usable.iter().map(|of| of.area_m2.value).collect();
            prop_assert!((areas[0] - facet.area_m2.value).abs() < 1e-9);
            prop_assert!(areas[0] >= areas[1] - 1e-6 && areas[1] >= areas[2] - 1e-6, "{areas:?}");
            prop_assert!(areas[2] >= 0.0);
        }
    }
}
