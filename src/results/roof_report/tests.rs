use nalgebra::{Point2, Point3, Vector2, Vector3};
use proptest::prelude::*;

use super::*;
use crate::base::geometry::{Plane, plan_sides};
use crate::orienting::synthetic::gable_scene;
use crate::roofs::model::{CornerUncertainty, FacetUncertainty, SideSupport, SideUncertainty};
use crate::roofs::solids::close_buildings;
use crate::roofs::testing::uniform;

/// A facet over a plan ring on `z = z0 + gx x + gy y`.
pub(super) fn roof(ring: &[(f64, f64)], [z0, gx, gy]: [f64; 3]) -> Facet {
    let lift = |&(x, y): &(f64, f64)| Point3::new(x, y, z0 + gx * x + gy * y);
    crate::roofs::testing::facet(&ring.iter().map(lift).collect::<Vec<_>>())
}

/// 10 x 8 m, eaves at 5 m, the ridge at y = 4 and 7 m.
pub(super) fn gable() -> Vec<Facet> {
    vec![
        roof(
            &[(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (0.0, 4.0)],
            [5.0, 0.0, 0.5],
        ),
        roof(
            &[(0.0, 4.0), (10.0, 4.0), (10.0, 8.0), (0.0, 8.0)],
            [9.0, 0.0, -0.5],
        ),
    ]
}

/// 12 x 8 m, equal slopes on four sides.
pub(super) fn hip() -> Vec<Facet> {
    vec![
        roof(
            &[(0.0, 0.0), (12.0, 0.0), (8.0, 4.0), (4.0, 4.0)],
            [5.0, 0.0, 0.5],
        ),
        roof(&[(12.0, 0.0), (12.0, 8.0), (8.0, 4.0)], [11.0, -0.5, 0.0]),
        roof(
            &[(12.0, 8.0), (0.0, 8.0), (4.0, 4.0), (8.0, 4.0)],
            [9.0, 0.0, -0.5],
        ),
        roof(&[(0.0, 8.0), (0.0, 0.0), (4.0, 4.0)], [5.0, 0.5, 0.0]),
    ]
}

/// Two wings with ridges at y = 3 and x = 13: a hip outside and a valley inside.
pub(super) fn l_shape() -> Vec<Facet> {
    vec![
        roof(
            &[(0.0, 0.0), (16.0, 0.0), (13.0, 3.0), (0.0, 3.0)],
            [5.0, 0.0, 0.5],
        ),
        roof(
            &[(0.0, 3.0), (13.0, 3.0), (10.0, 6.0), (0.0, 6.0)],
            [8.0, 0.0, -0.5],
        ),
        roof(
            &[(16.0, 0.0), (16.0, 12.0), (13.0, 12.0), (13.0, 3.0)],
            [13.0, -0.5, 0.0],
        ),
        roof(
            &[(13.0, 3.0), (13.0, 12.0), (10.0, 12.0), (10.0, 6.0)],
            [0.0, 0.5, 0.0],
        ),
    ]
}

/// A flat roof of 6 x 6 m at 8 m, and a lean-to that falls away from it, 2 m below.
pub(super) fn lean_to() -> Vec<Facet> {
    vec![
        roof(
            &[(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)],
            [8.0, 0.0, 0.0],
        ),
        roof(
            &[(6.0, 0.0), (9.0, 0.0), (9.0, 6.0), (6.0, 6.0)],
            [9.0, -0.5, 0.0],
        ),
    ]
}

fn report_of(facets: &[Facet]) -> BuildingReport {
    let (model, trace) = close_buildings(facets, |_| 0.0);
    assert_eq!(trace.rejected, []);
    let mut buildings = roof_report(&model, &[]);
    assert_eq!(buildings.len(), 1);
    buildings.remove(0)
}

/// The lengths that are there, by name.
fn named(lengths: &Lengths) -> Vec<(&'static str, f64)> {
    let of =
        |(kind, length): (RoofEdgeKind, &Option<Estimate>)| Some((kind.name(), (*length)?.value));
    (RoofEdgeKind::ALL.into_iter().zip(lengths))
        .filter_map(of)
        .collect()
}

fn assert_lengths(lengths: &Lengths, wanted: &[(&str, f64)]) {
    let found = named(lengths);
    let close = |(a, b): (&(&str, f64), &(&str, f64))| a.0 == b.0 && (a.1 - b.1).abs() < 1e-6;
    let same = found.len() == wanted.len() && found.iter().zip(wanted).all(close);
    assert!(same, "{found:?} instead of {wanted:?}");
}

#[test]
fn a_gable_has_a_ridge_two_eaves_and_four_rakes() {
    let report = report_of(&gable());
    let rake = 20f64.sqrt();
    assert_lengths(
        &report.lengths,
        &[("ridge", 10.0), ("eave", 20.0), ("rake", 4.0 * rake)],
    );
    let south = &report.facets[0];
    assert_lengths(
        &south.lengths,
        &[("ridge", 10.0), ("eave", 10.0), ("rake", 2.0 * rake)],
    );
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} instead of {b}");
    near(south.plan_area_m2.value, 40.0);
    near(south.area_m2.value, 10.0 * rake);
    near(
        south.slope_deg.value,
        crate::base::math::atan(0.5).to_degrees(),
    );
    near(south.azimuth_deg.unwrap().value, 180.0);
    near(report.facets[1].azimuth_deg.unwrap().value, 0.0);
    near(south.lowest_m.value, 5.0);
    near(report.highest_m.value, 7.0);
    near(report.volume_m3.value, 80.0 * 6.0);
    assert_eq!(report.edges.len(), 7);
}

#[test]
fn a_hip_roof_has_hips_an_l_has_a_valley() {
    let report = report_of(&hip());
    // Each hip runs over 4 x 4 m and rises by 2 m.
    assert_lengths(
        &report.lengths,
        &[("ridge", 4.0), ("hip", 24.0), ("eave", 40.0)],
    );
    let azimuths: Vec<f64> = (report.facets.iter())
        .map(|f| f.azimuth_deg.unwrap().value)
        .collect();
    for (found, wanted) in azimuths.iter().zip([180.0, 90.0, 0.0, 270.0]) {
        assert!((found - wanted).abs() < 1e-6);
    }
    let report = report_of(&l_shape());
    let diagonal = (9.0f64 + 9.0 + 2.25).sqrt();
    let rakes = 4.0 * 11.25f64.sqrt();
    assert_lengths(
        &report.lengths,
        &[
            ("ridge", 13.0 + 9.0),
            ("hip", diagonal),
            ("valley", diagonal),
            ("eave", 16.0 + 10.0 + 12.0 + 6.0),
            ("rake", rakes),
        ],
    );
}

#[test]
fn a_lower_roof_abuts_a_wall_and_the_higher_one_ends_there() {
    let report = report_of(&lean_to());
    let rake = 11.25f64.sqrt();
    assert_lengths(
        &report.lengths,
        &[
            ("eave", 24.0 + 6.0),
            ("rake", 2.0 * rake),
            ("abutment", 6.0),
        ],
    );
    assert_eq!(report.facets[0].azimuth_deg, None);
    assert_lengths(&report.facets[0].lengths, &[("eave", 24.0)]);
    // Alone it has a top, and where it meets the flat roof the slope changes.
    let alone = report_of(&lean_to()[1..]);
    assert_lengths(
        &alone.lengths,
        &[("eave", 6.0), ("rake", 2.0 * rake), ("top_edge", 6.0)],
    );
    let mut meeting = lean_to();
    meeting[1] = roof(
        &[(6.0, 0.0), (9.0, 0.0), (9.0, 6.0), (6.0, 6.0)],
        [11.0, -0.5, 0.0],
    );
    let report = report_of(&meeting);
    assert_lengths(
        &report.lengths,
        &[("transition", 6.0), ("eave", 24.0), ("rake", 2.0 * rake)],
    );
}

#[test]
fn a_corner_of_a_neighbour_does_not_divide_an_edge() {
    // The eave is 10 m long, with a corner on it where a courtyard wall might begin.
    let mut facets = gable();
    facets[0].outer.insert(1, Point3::new(3.0, 0.0, 5.0));
    let members: Vec<_> = (facets.iter().enumerate())
        .map(|(i, f)| (FacetId::from_index(i), f))
        .collect();
    let edges = roof_edges(&members);
    let eaves = edges.iter().filter(|e| e.kind == RoofEdgeKind::Eave);
    let mut lengths: Vec<f64> = eaves.map(|e| e.segment.length()).collect();
    lengths.sort_by(f64::total_cmp);
    assert_eq!(lengths, [10.0, 10.0]);
    // What welding leaves at a corner is no edge.
    let mut welded = gable();
    welded[0].outer.insert(1, Point3::new(9.999, 0.002, 5.001));
    assert_eq!(roof_edges(&[(FacetId(0), &welded[0])]).len(), 4);
    // Also where the ring begins in the middle of it.
    facets[0].outer.rotate_left(1);
    let members = [(FacetId(0), &facets[0])];
    assert_eq!(roof_edges(&members).len(), 4);
}

/// Turned about the origin, enlarged and moved.
fn moved(facet: &Facet, angle: f64, scale: f64, shift: Vector3<f64>) -> Facet {
    let turn = crate::base::geometry::rotation_from_axis_angle(&Vector3::new(0.0, 0.0, angle));
    let corners: Vec<_> = (facet.outer.iter())
        .map(|p| turn * p * scale + shift)
        .collect();
    crate::roofs::testing::facet(&corners)
}

proptest! {
    #[test]
    fn lengths_areas_and_kinds_follow_a_turned_and_enlarged_roof(
        angle in 0.0..6.2f64,
        scale in 0.5..3.0f64,
        east in -200.0..200.0f64,
        which in 0..4usize,
    ) {
        let facets = [gable(), hip(), l_shape(), lean_to()][which].clone();
        let shift = Vector3::new(east, -3.0 * east, 2.0);
        let turned: Vec<_> = facets.iter().map(|f| moved(f, angle, scale, shift)).collect();
        let before = report_of(&facets);
        let (model, _) = close_buildings(&turned, |_| 2.0);
        let after = &roof_report(&model, &[])[0];
        let (a, b) = (named(&before.lengths), named(&after.lengths));
        prop_assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(&b) {
            prop_assert_eq!(a.0, b.0);
            prop_assert!((a.1 * scale - b.1).abs() < 0.02, "{:?} {:?}", a, b);
        }
        let ratio = after.area_m2.value / before.area_m2.value;
        prop_assert!((ratio - scale * scale).abs() < 2e-3 * scale * scale);
        let ratio = after.volume_m3.value / before.volume_m3.value;
        prop_assert!((ratio - scale * scale * scale).abs() < 3e-3 * scale * scale * scale);
        let volume = model.buildings[0].solid.volume();
        prop_assert!((after.volume_m3.value - volume).abs() < 1e-2 * volume);
        for (f, g) in before.facets.iter().zip(&after.facets) {
            let (Some(f), Some(g)) = (f.azimuth_deg, g.azimuth_deg) else { continue };
            let turned = f.value - g.value - angle.to_degrees();
            let off = (turned + 900.0).rem_euclid(360.0) - 180.0;
            prop_assert!(off.abs() < 0.1, "{off}");
        }
    }

    #[test]
    fn no_ring_at_all_makes_it_panic(
        corners in prop::collection::vec((-5.0..5.0f64, -5.0..5.0f64), 3..9),
        gx in -2.0..2.0f64,
    ) {
        let mut facet = gable().remove(0);
        facet.plane = Plane::from_point_normal(&Point3::origin(), &Vector3::new(-gx, 0.0, 1.0))
            .expect("a normal");
        facet.outer = corners.iter().map(|&(x, y)| facet.plane.lift(x, y)).collect();
        let members = [(FacetId(0), &facet)];
        prop_assert!(roof_edges(&members).len() <= corners.len());
    }
}

/// What the adjustment states of the facets of [`gable`] here.
pub(super) const SLOPE_DEG: f64 = 0.6;
const HEIGHT_M: f64 = 0.08;
const PLAN_M: [f64; 2] = [0.05, 0.12];
pub(super) const SIDE_M: f64 = 0.07;

pub(super) fn with_uncertainty(mut facets: Vec<Facet>) -> Vec<Facet> {
    for facet in &mut facets {
        let corner = |&at: &Point3<f64>| CornerUncertainty {
            at,
            sigma_m: Vector3::new(PLAN_M[0], PLAN_M[1], 0.1),
        };
        facet.uncertainty = Some(FacetUncertainty {
            height_m: HEIGHT_M,
            slope_deg: SLOPE_DEG,
            corners: facet.outer.iter().map(corner).collect(),
            sides: sides_of(&facet.outer),
        });
    }
    facets
}

/// The sides of a ring, each as uncertain.
fn sides_of(ring: &[Point3<f64>]) -> Vec<SideUncertainty> {
    let side = |ends: [Point2<f64>; 2]| SideUncertainty {
        ends,
        sigma_m: SIDE_M,
        support: SideSupport::Edges,
    };
    plan_sides(ring).map(side).collect()
}

/// A number of mean 0 and standard deviation 1 (sum of twelve uniform ones).
fn normal(random: &mut impl FnMut() -> f64) -> f64 {
    (0..12).map(|_| random()).sum::<f64>() - 6.0
}

/// What is measured of a roof whose planes and corners were drawn anew: area of the first facet,
/// its plan area, its azimuth, lengths of the ridge and of a rake, volume below all facets.
fn measured(facets: &[Facet]) -> [f64; 6] {
    let first = &facets[0];
    let length = |a: usize, b: usize| (first.outer[a] - first.outer[b]).norm();
    let fall = first.plane.normal.xy();
    let volume: f64 = (facets.iter())
        .map(|f| {
            // Two triangles: plan area times the mean height of the corners.
            let triangle = |i: [usize; 3]| {
                let [p, q, r] = i.map(|i| f.outer[i]);
                let area = (q - p).xy().perp(&(r - p).xy()) / 2.0;
                area * (p.z + q.z + r.z) / 3.0
            };
            triangle([0, 1, 2]) + triangle([0, 2, 3])
        })
        .sum();
    [
        first.sloped_area(),
        first.plan_area(),
        crate::base::math::atan2(fall.x, -fall.y).to_degrees(),
        length(2, 3),
        length(1, 2),
        volume,
    ]
}

#[test]
fn stated_deviations_are_the_spread_of_perturbed_planes_and_sides() {
    let facets = with_uncertainty(gable());
    let (model, _) = close_buildings(&facets, |_| 0.0);
    let report = &roof_report(&model, &[])[0];
    let south = &report.facets[0];
    let length = |kind: RoofEdgeKind| {
        let edge = report.edges.iter().find(|e| e.edge.kind == kind);
        edge.unwrap().length_m
    };
    let stated = [
        south.area_m2,
        south.plan_area_m2,
        south.azimuth_deg.unwrap(),
        length(RoofEdgeKind::Ridge),
        length(RoofEdgeKind::Rake),
        report.volume_m3,
    ]
    .map(|e| e.sigma.unwrap());

    const DRAWS: usize = 4000;
    let mut random = uniform(7);
    let mut found: Vec<[f64; 6]> = Vec::new();
    for _ in 0..DRAWS {
        let raised = HEIGHT_M * normal(&mut random);
        let at = |y: f64, x: f64| Point2::new(x, y);
        let mut displaced = |by: f64| by + SIDE_M * normal(&mut random);
        let [west, east] = [0.0, 10.0].map(&mut displaced);
        let level = [0.0, 4.0, 8.0].map(&mut displaced);
        let crossings = level.map(|y| [at(y, west), at(y, east)]).concat();
        let gradients: Vec<Vector2<f64>> = (facets.iter())
            .map(|facet| {
                let gradient = edges::gradient(facet);
                let tilt = SLOPE_DEG.to_radians() * (1.0 + gradient.norm_squared());
                gradient + Vector2::from([0, 1].map(|_| tilt * normal(&mut random)))
            })
            .collect();
        let drawn = |corners: &[Point2<f64>]| -> Vec<Facet> {
            let of_facet = |((facet, ring), g): ((&Facet, [usize; 4]), &Vector2<f64>)| {
                let middle = crate::base::geometry::mean_point(&facet.outer);
                let height = |p: &Point2<f64>| middle.z + raised + g.dot(&(p - middle.xy()));
                let ring = ring.map(|i| corners[i]);
                crate::roofs::testing::facet(&ring.map(|p| Point3::new(p.x, p.y, height(&p))))
            };
            let rings = facets.iter().zip([[0, 1, 3, 2], [2, 3, 5, 4]]);
            rings.zip(&gradients).map(of_facet).collect()
        };
        found.push(measured(&drawn(&crossings)));
    }
    for (i, stated) in stated.into_iter().enumerate() {
        let mean = found.iter().map(|m| m[i]).sum::<f64>() / DRAWS as f64;
        let squares = found.iter().map(|m| (m[i] - mean) * (m[i] - mean));
        let spread = (squares.sum::<f64>() / DRAWS as f64).sqrt();
        // The spread of 4000 draws is known within 1.1 %.
        let ratio = stated / spread;
        assert!((ratio - 1.0).abs() < 0.05, "{i}: {stated} for {spread}");
    }
}

#[test]
fn lengths_scatter_as_stated_where_sides_meet_askew() {
    let corners = [[0.0, 0.0], [10.0, 0.0], [8.0, 4.0], [3.0, 5.0]].map(Point2::from);
    let ring = corners.map(|p| Point3::new(p.x, p.y, 3.0));
    let mut facet = crate::roofs::testing::facet(&ring);
    let of_sides = [0.08, 0.03, 0.05, 0.02];
    let mut sides = sides_of(&facet.outer);
    for (side, sigma_m) in sides.iter_mut().zip(of_sides) {
        side.sigma_m = sigma_m;
    }
    facet.uncertainty = Some(FacetUncertainty {
        height_m: HEIGHT_M,
        slope_deg: 1e-6,
        corners: Vec::new(),
        sides,
    });
    let (model, _) = close_buildings(&[facet], |_| 0.0);
    let report = &roof_report(&model, &[])[0];
    let mut random = uniform(5);
    let mut found = Vec::new();
    for _ in 0..4000 {
        let lines: Vec<(Point2<f64>, Vector2<f64>)> = (0..4)
            .map(|i| {
                let along = (corners[(i + 1) % 4] - corners[i]).normalize();
                let aside = Vector2::new(-along.y, along.x) * (of_sides[i] * normal(&mut random));
                (corners[i] + aside, along)
            })
            .collect();
        let corner = |i: usize| {
            let ((p, d), (q, e)) = (lines[(i + 3) % 4], lines[i]);
            p + d * ((q - p).perp(&e) / d.perp(&e))
        };
        found.push([0, 1, 2, 3].map(|i| (corner((i + 1) % 4) - corner(i)).norm()));
    }
    for i in 0..4 {
        let middle = nalgebra::center(&ring[i], &ring[(i + 1) % 4]);
        let is_it = |e: &&EdgeReport| {
            let at = nalgebra::center(&e.edge.segment.p0, &e.edge.segment.p1);
            (at - middle).norm() < 0.01
        };
        let edge = report
            .edges
            .iter()
            .find(is_it)
            .expect("an edge of the facet");
        let mean = found.iter().map(|l| l[i]).sum::<f64>() / 4000.0;
        let variance = found
            .iter()
            .map(|l| (l[i] - mean) * (l[i] - mean))
            .sum::<f64>()
            / 4000.0;
        let ratio = edge.length_m.sigma.expect("known") / variance.sqrt();
        assert!((ratio - 1.0).abs() < 0.05, "{i}: {ratio}");
    }
}

#[test]
fn what_is_not_known_has_no_deviation_and_spoils_only_what_it_is_part_of() {
    let mut facets = with_uncertainty(gable());
    facets[1].uncertainty = None;
    let (model, _) = close_buildings(&facets, |_| 0.0);
    let report = &roof_report(&model, &[])[0];
    assert!(report.facets[0].area_m2.sigma.is_some());
    assert_eq!(report.facets[1].area_m2.sigma, None);
    assert_eq!(report.volume_m3.sigma, None);
    let ridge = (report.edges.iter()).find(|e| e.edge.kind == RoofEdgeKind::Ridge);
    assert!(ridge.unwrap().length_m.sigma.is_some(), "of the south side");
}

#[test]
fn a_facet_is_shown_by_the_views_above_it_that_no_roof_blocks() {
    let (mut scene, _) = gable_scene(64);
    let (model, _) = close_buildings(&gable(), |_| 0.0);
    let camera = |x: f64, y: f64, z: f64| {
        let mut view = scene.views[0].clone();
        view.camera = crate::photographs::camera::Camera::new(
            nalgebra::Matrix3::new(400.0, 0.0, 400.0, 0.0, 400.0, 400.0, 0.0, 0.0, 1.0),
            nalgebra::Rotation3::face_towards(
                &(Point3::new(5.0, 4.0, 6.0) - Point3::new(x, y, z)),
                &Vector3::z(),
            )
            .inverse(),
            Point3::new(x, y, z),
            800,
            800,
        );
        view
    };
    // From above both, from low in the south one, and from below none.
    let views = vec![
        camera(5.0, 3.0, 60.0),
        camera(5.0, -60.0, 15.0),
        camera(5.0, -60.0, 1.0),
    ];
    scene.views = views;
    let seen: Vec<Vec<usize>> = (views_of_facets(&scene, &model).iter())
        .map(|views| views.iter().map(|v| v.index()).collect())
        .collect();
    assert_eq!(seen, [vec![0, 1, 2], vec![0]]);
}
