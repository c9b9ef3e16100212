//! A planted hip roof: its graphs, its corners in space, and the planes that they propose.

use nalgebra::{Matrix2, Matrix3, Point2, Point3, Vector2, Vector3};
use proptest::prelude::*;

use super::*;
use crate::base::geometry::{Plane, Segment2};
use crate::lines::lines2d::SegmentKind;
use crate::planes::rendered_planes::{PITCH, RIDGE_Z, level_ground, scene, slope_from, textured};
use crate::roofs::testing::{line, uniform};

/// Half the length and half the depth of the roof, half the length of its ridge, metres.
const HALF: [f64; 3] = [6.0, 4.0, 2.0];
/// Mean distance of an end from its corner, pixels.
const GAP_PX: f64 = 3.0;

/// The slope that falls along a direction.
fn slope(x: f64, y: f64) -> Plane {
    slope_from([HALF[2] * x, 0.0], [x, y])
}

fn is_roof(x: f64, y: f64) -> bool {
    x.abs() < HALF[0] && y.abs() < HALF[1]
}

/// Does the end of a hip roof cover a place?
fn is_end(x: f64, y: f64) -> bool {
    x.abs() - HALF[2] > y.abs()
}

/// Four slopes on level ground.
fn hip() -> Scene {
    scene(&[
        textured(slope(0.0, 1.0), |x, y| {
            is_roof(x, y) && !is_end(x, y) && y >= 0.0
        }),
        textured(slope(0.0, -1.0), |x, y| {
            is_roof(x, y) && !is_end(x, y) && y < 0.0
        }),
        textured(slope(1.0, 0.0), |x, y| {
            is_roof(x, y) && is_end(x, y) && x > 0.0
        }),
        textured(slope(-1.0, 0.0), |x, y| {
            is_roof(x, y) && is_end(x, y) && x < 0.0
        }),
        level_ground(),
    ])
}

/// The corners: south-west, south-east, north-east, north-west, both ends of the ridge.
fn corners() -> [Point3<f64>; 6] {
    let [x, y, ridge] = HALF;
    let eave = RIDGE_Z - PITCH * y;
    [
        Point3::new(-x, -y, eave),
        Point3::new(x, -y, eave),
        Point3::new(x, y, eave),
        Point3::new(-x, y, eave),
        Point3::new(-ridge, 0.0, RIDGE_Z),
        Point3::new(ridge, 0.0, RIDGE_Z),
    ]
}

/// The edges, by their corners.
const EDGES: [[usize; 2]; 9] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
    [4, 5],
    [0, 4],
    [3, 4],
    [1, 5],
    [2, 5],
];

fn image_segment(p0: Point2<f64>, p1: Point2<f64>) -> ImageSegment {
    let length = (p1 - p0).norm();
    ImageSegment {
        kind: SegmentKind::Edge,
        segment: Segment2::new(p0, p1),
        contrast: 0.5,
        edgels: 50,
        covariance: Matrix2::new(0.01, 0.0, 0.0, 0.12 / (length * length)),
    }
}

/// The edges in a view, off by a tenth of a pixel across and up to twice the mean gap short of both
/// corners, and unrelated segments.
fn planted(scene: &Scene, clutter: usize) -> Vec<Vec<ImageSegment>> {
    let mut random = uniform(7);
    let of_view = |view: crate::base::ids::ViewId| {
        let camera = scene.camera(view);
        let mut found = Vec::new();
        for [a, b] in EDGES {
            let [a, b] = [a, b].map(|k| camera.project(&corners()[k]).unwrap());
            let s = Segment2::new(a, b);
            let mut end = |p: Point2<f64>, inwards: Vector2<f64>| {
                let off = s.normal() * (random() - 0.5) * 0.3;
                p + inwards * (random() * GAP_PX) + off
            };
            let (p0, p1) = (end(a, s.direction()), end(b, -s.direction()));
            found.push(match random() < 0.5 {
                true => image_segment(p0, p1),
                false => image_segment(p1, p0),
            });
        }
        for _ in 0..clutter {
            let p = Point2::new(random() * 250.0, random() * 250.0);
            let d = Vector2::new(random() - 0.5, random() - 0.5) * 40.0;
            found.push(image_segment(p, p + d));
        }
        found
    };
    scene.view_ids().map(of_view).collect()
}

/// Matched lines, of which the heights are used.
fn heights() -> [Line3d; 2] {
    let [low, high] = [Point3::origin(), Point3::new(0.0, 0.0, RIDGE_Z + 1.0)];
    let level = Vector3::new(5.0, 0.0, 0.0);
    [line(low, low + level), line(high, high + level)]
}

fn found(scene: &Scene, segments: &[Vec<ImageSegment>]) -> (Vec<CornerPlane>, AdjacencyTrace) {
    corner_planes(scene, &heights(), segments, &RoofParams::default())
}

/// The edges of the planted roof at a corner: the corners at their far ends.
fn neighbours(corner: usize) -> Vec<usize> {
    let other = |e: &[usize; 2]| match e {
        [a, b] if *a == corner => Some(*b),
        [a, b] if *b == corner => Some(*a),
        _ => None,
    };
    EDGES.iter().filter_map(other).collect()
}

fn nearest(corners: impl Iterator<Item = Point2<f64>>, p: &Point2<f64>) -> (usize, f64) {
    let off = corners.map(|c| (c - p).norm()).enumerate();
    off.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
}

#[test]
fn a_graph_has_the_corners_with_their_neighbours_in_cyclic_order() {
    let scene = hip();
    let (_, trace) = found(&scene, &planted(&scene, 0));
    for (view, graph) in scene.view_ids().zip(&trace.graphs) {
        let truth = corners().map(|p| scene.camera(view).project(&p).unwrap());
        assert_eq!(graph.corners.len(), 6);
        for (k, p) in truth.iter().enumerate() {
            let (c, off) = nearest(graph.corners.iter().map(|c| c.at), p);
            assert!(off < 1.0, "{off} px");
            let corner = &graph.corners[c];
            let far = |e: &CornerEdge| nearest(truth.iter().copied(), &e.far).0;
            let mut there: Vec<usize> = corner.edges.iter().map(far).collect();
            there.sort_unstable();
            let mut expected = neighbours(k);
            expected.sort_unstable();
            assert_eq!(there, expected);
            // Clockwise on the screen, y down.
            let turns = (0..3).map(|i| {
                let [a, b] = [i, i + 1].map(|i| corner.edges[i % 3].direction);
                crate::base::math::atan2(a.perp(&b), a.dot(&b)).rem_euclid(std::f64::consts::TAU)
            });
            assert!((turns.sum::<f64>() - std::f64::consts::TAU).abs() < 1e-9);
        }
        // Four slopes and the ground: each corner of a slope is a sector of its region.
        let mut sectors: Vec<usize> = graph.regions.iter().map(|r| r.sectors.len()).collect();
        sectors.sort_unstable();
        assert_eq!(sectors, [3, 3, 4, 4, 4]);
        let mut bordering: Vec<usize> = graph.regions.iter().map(|r| r.neighbours.len()).collect();
        bordering.sort_unstable();
        assert_eq!(bordering, [3, 3, 4, 4, 4].map(|n: usize| n.min(4)));
    }
}

#[test]
fn corners_in_space_are_within_their_covariance_and_clutter_is_refused() {
    let scene = hip();
    let (_, trace) = found(&scene, &planted(&scene, 25));
    let mut squares = Vec::new();
    let mut matched = Vec::new();
    for truth in corners() {
        let off = |c: &&SpaceCorner| (c.at - truth).norm();
        let corner = (trace.corners.iter()).min_by(|a, b| off(a).total_cmp(&off(b)));
        let corner = corner.expect("a corner");
        assert!(off(&corner) < 0.15, "{} m", off(&corner));
        assert_eq!(corner.edges.len(), 3);
        assert!(corner.images.len() >= 3 && corner.nats() > 10.0);
        let d = corner.at - truth;
        let inverse = Matrix3::from(corner.covariance).try_inverse().unwrap();
        squares.push(d.dot(&(inverse * d)));
        matched.push(corner.images.clone());
        for edge in &corner.edges {
            let far = edge.far(&corner.at);
            let nearest = corners().map(|p| (p - far).norm());
            assert!(nearest.into_iter().fold(9.0, f64::min) < 0.5, "{far}");
        }
    }
    let mean = squares.iter().sum::<f64>() / 6.0;
    assert!(mean < 6.0, "chi-square of 3 numbers: {squares:?}");
    let others = trace
        .corners
        .iter()
        .filter(|c| !matched.contains(&c.images));
    assert!(
        others.clone().count() <= 1,
        "{:#?}",
        others.collect::<Vec<_>>()
    );
}

#[test]
fn a_corner_without_a_counterpart_is_refused() {
    let scene = hip();
    let mut segments = planted(&scene, 0);
    // One in each view, on the beams of none of the others.
    let places = [[30.0, 30.0], [220.0, 40.0], [40.0, 200.0], [200.0, 225.0]];
    for (view, [x, y]) in segments.iter_mut().zip(places) {
        let p = Point2::new(x, y);
        view.push(image_segment(p, p + Vector2::new(18.0, 2.0)));
        view.push(image_segment(p, p + Vector2::new(-2.0, 18.0)));
    }
    let (_, trace) = found(&scene, &segments);
    assert!(trace.graphs.iter().all(|g| g.corners.len() == 7));
    assert_eq!(trace.corners.len(), 6);
    for corner in &trace.corners {
        let off = corners().map(|p| (p - corner.at).norm());
        assert!(off.into_iter().fold(9.0, f64::min) < 0.15);
    }
}

#[test]
fn the_end_of_a_ridge_proposes_its_three_planes_and_the_eaves_confirm_them() {
    let scene = hip();
    let (planes, trace) = found(&scene, &planted(&scene, 25));
    let slopes = [[0.0, 1.0], [0.0, -1.0], [1.0, 0.0], [-1.0, 0.0]].map(|[x, y]| slope(x, y));
    let plane_of = |slope: &Plane| {
        let is_it = |p: &&CornerPlane| p.is_verified() && p.plane.angle_to(slope) < 0.02;
        let found: Vec<&CornerPlane> = planes.iter().filter(is_it).collect();
        assert_eq!(found.len(), 1, "{planes:#?}");
        found[0]
    };
    for (slope, regions) in slopes.iter().zip([4, 4, 3, 3]) {
        let plane = plane_of(slope);
        assert_eq!(
            (plane.regions.len(), plane.polygon.len()),
            (regions, regions)
        );
        assert!(plane.coplanar_nats > 3.0 && plane.covariance[0][0].sqrt() < 0.1);
        let off = |p: &Point3<f64>| corners().map(|c| (c - p).norm());
        let worst = plane
            .polygon
            .iter()
            .map(|p| off(p).into_iter().fold(9.0, f64::min));
        assert!(worst.fold(0.0, f64::max) < 0.3, "{:?}", plane.polygon);
    }
    // The end of the ridge in the east is in three of them, each corner of the eaves in two.
    for (truth, expected) in corners().iter().zip([2, 2, 2, 2, 3, 3]) {
        let near = |c: &SpaceCorner| (c.at - truth).norm() < 0.15;
        let k = trace.corners.iter().position(near).unwrap() as u32;
        let of = (planes.iter()).filter(|p| p.regions.iter().any(|r| r[0] == k));
        assert_eq!(of.count(), expected);
    }
}

#[test]
fn the_order_of_views_and_segments_does_not_matter_to_a_run() {
    let scene = hip();
    let segments = planted(&scene, 25);
    let once = found(&scene, &segments);
    let again = found(&scene, &segments);
    assert_eq!(once.0, again.0);
    assert_eq!(once.1.corners, again.1.corners);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn two_ends_meet_where_their_lines_cross(
        from in 0.0..std::f64::consts::TAU, opening in 0.4..2.7f64, gaps in prop::array::uniform2(0.0..2.0f64),
        turned in prop::array::uniform2(any::<bool>()),
    ) {
        let at = Point2::new(125.0, 125.0);
        let edge = |angle: f64, gap: f64, turned: bool| {
            let (s, c) = crate::base::math::sin_cos(angle);
            let d = Vector2::new(c, s);
            let (p, q) = (at + d * gap, at + d * 50.0);
            if turned { image_segment(q, p) } else { image_segment(p, q) }
        };
        let segments =
            [edge(from, gaps[0], turned[0]), edge(from + opening, gaps[1], turned[1])];
        let view = &hip_view();
        let graph = corners::image_graph(view, &segments, GAP_PX);
        prop_assert_eq!(graph.corners.len(), 1);
        let corner = &graph.corners[0];
        let off = corner.at - at;
        let inverse = corner.covariance().try_inverse().unwrap();
        prop_assert!(off.dot(&(inverse * off)) < 9.0, "{} {}", off, corner.covariance());
        // Both regions border each other and nothing else.
        prop_assert_eq!(graph.regions.len(), 2);
        prop_assert_eq!(&graph.regions[0].neighbours, &vec![1]);
    }
}

fn hip_view() -> crate::orienting::scene::View {
    scene(&[]).views.remove(0)
}
