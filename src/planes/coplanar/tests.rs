//! A planted gable roof: its sets, their polygons, and how they are corrected.

use nalgebra::{Matrix2, Point2, Point3};
use proptest::prelude::*;

use super::outline::{ClosingKind, Outline};
use super::sets::{LineSet, LineSpace};
use super::uncertain_plane::{UncertainPlane, ends_of};
use super::*;
use crate::base::geometry::{Segment2, Segment3, sides};
use crate::lines::lines2d::{GuidedEdge, SegmentKind};
use crate::lines::lines3d::{LineSupport, SupportKind};
use crate::planes::rendered_planes::{PITCH, RIDGE_Z, level_ground, scene, slope_from, textured};
use crate::roofs::testing::{line, uniform};

/// Half the length and half the depth of the roof, metres.
const HALF: [f64; 2] = [6.0, 4.0];

fn slope(to_the_north: f64) -> Plane {
    slope_from([0.0, 0.0], [0.0, to_the_north])
}

fn at(x: f64, y: f64) -> Point3<f64> {
    Point3::new(x, y, RIDGE_Z - PITCH * y.abs())
}

/// Two slopes on level ground.
fn gable() -> Scene {
    scene(&[
        textured(slope(1.0), |x, y| {
            x.abs() < HALF[0] && (0.0..HALF[1]).contains(&y)
        }),
        textured(slope(-1.0), |x, y| {
            x.abs() < HALF[0] && (-HALF[1]..0.0).contains(&y)
        }),
        level_ground(),
    ])
}

/// A line with its measured edge in every view, off by up to `noise_px` at both ends.
fn seen(scene: &Scene, p0: Point3<f64>, p1: Point3<f64>, noise_px: f64, seed: u32) -> Line3d {
    let mut random = uniform(seed);
    let mut noise = || (random() - 0.5) * 2.0 * noise_px;
    let support = |view| {
        let camera = scene.camera(view);
        let mut image = |p| camera.project(&p).unwrap() + nalgebra::Vector2::new(noise(), noise());
        let segment = Segment2::new(image(p0), image(p1));
        LineSupport {
            view,
            segments: Vec::new(),
            stretch: segment,
            score: 1.0,
            kind: SupportKind::Matched,
            edge: Some(GuidedEdge {
                view,
                kind: SegmentKind::Edge,
                segment,
                covariance: Matrix2::new(0.01, 0.0, 0.0, 1e-5),
                pieces: Vec::new(),
            }),
        }
    };
    let supports = scene.view_ids().map(support).collect();
    Line3d {
        supports,
        covariance: [nalgebra::Matrix3::from_diagonal_element(4e-4); 2],
        ..line(p0, p1)
    }
}

fn segments(scene: &Scene, lines: &[Line3d]) -> Vec<Vec<ImageSegment>> {
    let in_view = |view: crate::base::ids::ViewId| {
        let edges = lines.iter().map(|l| &l.supports[view.index()].stretch);
        let found = edges.map(|segment| ImageSegment {
            kind: SegmentKind::Edge,
            segment: *segment,
            contrast: 0.5,
            edgels: 50,
            covariance: Matrix2::identity() * 0.01,
        });
        found.collect()
    };
    scene.view_ids().map(in_view).collect()
}

/// The sets of some lines, where the photographs show all edges of the gable.
fn found(lines: &[Line3d]) -> (Vec<CoplanarSet>, CoplanarTrace) {
    let scene = gable();
    let segments = segments(&scene, &gable_lines(0.0, true));
    coplanar_sets(&scene, lines, &segments, &RoofParams::default())
}

/// Ridge, eaves and the rakes; `short` metres of each eave are missing at both ends.
fn gable_lines(short: f64, rakes: bool) -> Vec<Line3d> {
    let scene = gable();
    let [x, y] = HALF;
    let mut ends = vec![(at(-x, 0.0), at(x, 0.0))];
    ends.extend([-y, y].map(|y| (at(short - x, y), at(x - short, y))));
    if rakes {
        ends.extend([[-x, -y], [-x, y], [x, -y], [x, y]].map(|[x, y]| (at(x, 0.0), at(x, y))));
    }
    let seen =
        |(i, (p0, p1)): (usize, (Point3<f64>, Point3<f64>))| seen(&scene, p0, p1, 0.2, i as u32);
    ends.into_iter().enumerate().map(seen).collect()
}

fn verified(sets: &[CoplanarSet], truth: &Plane) -> Vec<usize> {
    let is_it = |i: &usize| sets[*i].is_verified() && sets[*i].plane.angle_to(truth) < 0.05;
    (0..sets.len()).filter(is_it).collect()
}

fn farthest(polygon: &[Point3<f64>], truth: &[Point3<f64>]) -> f64 {
    let nearest = |p: &Point3<f64>| truth.iter().map(|t| (t - p).norm()).fold(9.0, f64::min);
    polygon.iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn both_slopes_of_a_gable_are_sets_with_the_ridge_in_both() {
    let mut lines = gable_lines(0.0, true);
    lines.push(seen(
        &gable(),
        Point3::new(-5.0, 6.0, 0.0),
        Point3::new(5.0, 7.0, 0.0),
        0.2,
        9,
    ));
    let (sets, _) = found(&lines);
    for (north, members) in [(-1.0, [0, 1, 3, 5]), (1.0, [0, 2, 4, 6])] {
        let which = verified(&sets, &slope(north));
        assert_eq!(which.len(), 1, "{sets:#?}");
        let set = &sets[which[0]];
        let mut ids: Vec<u32> = set.lines.iter().map(|l| l.0).collect();
        ids.sort_unstable();
        assert_eq!(ids, members);
        let [x, y] = [HALF[0], HALF[1] * north];
        let truth = [at(-x, 0.0), at(x, 0.0), at(-x, y), at(x, y)];
        assert_eq!(set.polygon.len(), 4);
        assert!(farthest(&set.polygon, &truth) < 0.1, "{:?}", set.polygon);
        assert!(set.covariance[0][0].sqrt() < 0.05 && set.covariance[0][0] > 0.0);
    }
    let uphill = sets
        .iter()
        .filter(|s| s.is_verified() && s.lines.contains(&LineId(7)));
    assert_eq!(uphill.count(), 0, "the line on the ground lies in no roof");
}

#[test]
fn a_gable_without_rakes_is_square_after_symmetry_and_not_before() {
    let (sets, trace) = found(&gable_lines(0.7, false));
    for north in [-1.0, 1.0] {
        let which = verified(&sets, &slope(north));
        let set = &sets[*which.first().expect("the slope")];
        let [x, y] = [HALF[0], HALF[1] * north];
        let truth = [at(-x, 0.0), at(x, 0.0), at(-x, y), at(x, y)];
        assert!(farthest(&set.hull, &truth) > 0.6);
        assert!(farthest(&set.polygon, &truth) < 0.25, "{:?}", set.polygon);
        let closing = &trace.sets[which[0]].closing;
        assert!(closing.len() == 2 && closing.iter().all(|c| c.kind == ClosingKind::Square));
    }
}

/// Four sides of a planted polygon as a set in a level plane, each shorter by a share of its length
/// at both ends.
fn set_of(corners: &[Point2<f64>], short: f64, lines: &mut Vec<Line3d>) -> LineSet {
    let n = corners.len();
    lines.extend(sides(corners).map(|side| {
        let [p, q] = side.map(|p| Point3::new(p.x, p.y, 5.0));
        let s = Segment3::new(p, q);
        line(s.at(short), s.at(1.0 - short))
    }));
    let ends: Vec<_> = lines.iter().flat_map(ends_of).collect();
    LineSet {
        lines: (0..n).map(LineId::from_index).collect(),
        plane: UncertainPlane::fit(&ends, 0.1).unwrap(),
        nats: 1.0,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn corners_of_any_quadrilateral_are_closed(
        radii in prop::array::uniform4(4.0..8.0f64), turn in 0.0..6.0f64, short in 0.0..0.04f64,
    ) {
        let corner = |k: usize| {
            let (s, c) = crate::base::math::sin_cos(turn + k as f64 * std::f64::consts::FRAC_PI_2);
            Point2::new(radii[k] * c, radii[k] * s)
        };
        let planted: Vec<Point2<f64>> = (0..4).map(corner).collect();
        let mut lines = Vec::new();
        let set = set_of(&planted, short, &mut lines);
        let space = LineSpace { lines: &lines, pixel_m: 0.1, range_m: 5.0 };
        let outline = Outline::of_hull(&space, &set).unwrap().with_closed_corners();
        prop_assert_eq!(outline.len(), 4);
        for p in &outline.corners {
            let off = planted.iter().map(|t| (t - p).norm()).fold(9.0, f64::min);
            prop_assert!(off < 0.6, "{}", off);
        }
    }
}
