//! Whether a cell may hold a building that it is responsible for, asked as soon as lines and ground
//! are there: dense matching and facets of all the rest of its region are for nothing where not.
//!
//! A building has its middle in the core, but for the slack that joining allows. It is found by
//! lines that are higher than any eave's least height, or by surfaces that the views agree on where
//! no line is. So a core is vacant where
//!
//! 1. no such line comes nearer to it than a facet may reach from that line, and
//! 2. dense matching of the core by itself finds no surface so high, and
//! 3. nothing that is known beforehand may be a building there.
//!
//! Whatever stands there, a tree or a mast, the cell goes on: this only says what is certain. What
//! it would overlook are a court without a roof that reaches over the whole core, all of whose
//! wings stand farther from it than facets reach, and roofs in which the views agree nowhere and
//! that show no line.

use nalgebra::Point2;

use super::tile::{Cell, SLACK_M};
use crate::base::geometry::Segment3;
use crate::base::math::{larger, smaller};
use crate::base::params::RoofParams;
use crate::lines::lines3d::Line3d;
use crate::orienting::scene::Scene;
use crate::pipeline::{Run, Stage};
use crate::planes::dense::highest_surface;
use crate::planes::terrain::Ground;

/// The stage after which it is asked: the last one that takes little time.
pub(super) const ASKED_AFTER: Stage = Stage::HalfPlanes;

/// May no building of a cell be found by the stages behind [`ASKED_AFTER`]? Never where a source
/// has planes without matched lines.
pub(super) fn is_vacant(run: &Run, cell: &Cell) -> bool {
    let (scene, results) = (run.scene(), run.results());
    let [x, y] = [scene.origin.x, scene.origin.y];
    let [x0, y0, x1, y1] = cell.core;
    let low = Point2::new(x0 - x - SLACK_M, y0 - y - SLACK_M);
    let high = Point2::new(x1 - x + SLACK_M, y1 - y + SLACK_M);
    let (Some(lines), Some(ground)) = (&results.lines, &results.ground) else {
        return false;
    };
    let (lines, roof) = (&lines.value, &run.params().roof);
    run.params()
        .sources()
        .iter()
        .all(|source| source.is_of_lines())
        && is_nothing_known(scene, [low, high])
        && is_nothing_high(scene, lines, ground, [low, high], roof)
}

/// Neither a footprint there, nor points of roofs anywhere.
fn is_nothing_known(scene: &Scene, part: [Point2<f64>; 2]) -> bool {
    let footprints = scene.known.footprints.iter().flat_map(|r| &r.footprints);
    let mut boxes = footprints.map(|footprint| footprint.bounds());
    scene.known.point_cloud.is_none() && !boxes.any(|[low, high]| meets(part, low, high, 0.0))
}

/// No line and no surface that is as high above the ground as eaves are.
fn is_nothing_high(
    scene: &Scene,
    lines: &[Line3d],
    ground: &Ground,
    part: [Point2<f64>; 2],
    params: &RoofParams,
) -> bool {
    // A facet's height may differ from its lines' by what they may lie off its plane.
    let eave_m = params.min_height_m - 3.0 * params.coplanar_distance_m;
    let is_high = |line: &Segment3| !ground.is_near(line, eave_m);
    if (lines.iter()).any(|line| is_high(&line.segment) && reaches(&line.segment, part, params)) {
        return false;
    }
    let highest = highest_surface(scene, lines, ground, part);
    highest.is_none_or(|height_m| height_m < eave_m)
}

/// May a facet at a line reach a part of the plan? As far from it as regions of planes do.
fn reaches(line: &Segment3, part: [Point2<f64>; 2], params: &RoofParams) -> bool {
    let (a, b) = (line.p0.xy(), line.p1.xy());
    let depth = ((b - a).norm()).clamp(params.min_facet_depth_m, params.max_facet_depth_m);
    let low = Point2::new(smaller(a.x, b.x), smaller(a.y, b.y));
    let high = Point2::new(larger(a.x, b.x), larger(a.y, b.y));
    meets(part, low, high, depth)
}

/// Does a box, widened by so many metres, meet a part of the plan?
fn meets(part: [Point2<f64>; 2], low: Point2<f64>, high: Point2<f64>, by: f64) -> bool {
    let beside = |i: usize| low[i] - by <= part[1][i] && high[i] + by >= part[0][i];
    beside(0) && beside(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::execution::progress::silent;
    use crate::base::geometry::Plane;
    use crate::base::params::{Method, Params};
    use crate::orienting::orientation::InputFile;
    use crate::orienting::scene_loader::LoadOptions;
    use crate::orienting::synthetic::{gable_scene, shed_scene, to_files};
    use crate::planes::rendered_planes::{RIDGE_Z, level_ground, scene, slope_from, textured};
    use crate::roofs::testing::line;
    use crate::tiles::Area;
    use nalgebra::{Point3, Vector3};

    /// Is nothing high in the middle 10 m by 10 m of a lawn, with a house whose roof falls towards
    /// it 6 m to the west, and perhaps a flat roof so high on 2.5 m by 3 m of it, of which there is
    /// no line?
    fn is_lawn(roof_m: Option<f64>, more: &[Line3d]) -> bool {
        let flat = Plane {
            normal: Vector3::z(),
            d: -roof_m.unwrap_or(0.0),
        };
        let views = scene(&[
            textured(slope_from([-12.0, 0.0], [1.0, 0.0]), |x, y| {
                x < -8.5 && y.abs() < 6.0
            }),
            textured(flat, |x, y| {
                (1.0..3.5).contains(&x) && (-2.0..1.0).contains(&y)
            }),
            level_ground(),
        ]);
        let at = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
        let mut lines = vec![
            line(at(-12.0, -2.0, RIDGE_Z), at(-12.0, 2.0, RIDGE_Z)),
            line(at(-12.0, -12.0, 0.0), at(12.0, 12.0, 0.0)),
        ];
        lines.extend_from_slice(more);
        let part = [Point2::new(-5.0, -5.0), Point2::new(5.0, 5.0)];
        let roof = Params::default().roof;
        is_nothing_high(&views, &lines, &Ground::level(0.0), part, &roof)
    }

    #[test]
    fn a_low_roof_without_a_line_is_seen_on_a_lawn_and_the_house_beside_it_is_not_there() {
        assert!(is_lawn(None, &[]));
        assert!(is_lawn(Some(0.3), &[]), "a terrace");
        assert!(!is_lawn(Some(1.5), &[]), "a shed");
    }

    #[test]
    fn a_line_counts_as_far_as_a_facet_may_reach_from_it() {
        let eave = |x: f64, z: f64| line(Point3::new(x, -4.0, z), Point3::new(x, 4.0, z));
        assert!(!is_lawn(None, &[eave(12.5, 2.0)]), "8 m from the core");
        assert!(is_lawn(None, &[eave(13.5, 2.0)]), "8.5 m");
        assert!(is_lawn(None, &[eave(12.5, 0.5)]), "a kerb");
    }

    /// The outcome of the tile of an area, east of the house or all around it.
    fn outcome(scene: &Scene, roi: [f64; 4], method: Method) -> (String, Vec<(String, Vec<u8>)>) {
        let files: Vec<InputFile> = (to_files(scene).into_iter())
            .map(|(path, bytes)| InputFile::new(&path, bytes))
            .collect();
        let options = LoadOptions {
            roi: Some(roi),
            ..LoadOptions::default()
        };
        let params = Params {
            method,
            ..Params::default()
        };
        let mut source = &files[..];
        let mut area = Area::plan(&mut source, &options, Some([0.0, 8.0]), &params, 60.0).unwrap();
        let report = area.step(&mut source, &silent()).unwrap().unwrap();
        let outcome = report.outcome.clone();
        (outcome, area.finish(&[]).unwrap())
    }

    const EAST: [f64; 4] = [26.0, -10.0, 33.0, -1.0];

    #[test]
    fn a_square_with_a_house_in_its_margin_only_ends_early_and_one_with_a_shed_does_not() {
        let (lawn, _) = gable_scene(800);
        let (words, files) = outcome(&lawn, EAST, Method::Lines);
        assert_eq!(words, "no building here, ended after the half-planes");
        let report = &files
            .iter()
            .find(|(name, _)| name == "report.json")
            .unwrap()
            .1;
        assert!(String::from_utf8_lossy(report).contains(&words));
        let (words, _) = outcome(&lawn, EAST, Method::Combined);
        assert_eq!(words, "0 buildings");

        let (with_shed, _) = shed_scene(800);
        let (words, _) = outcome(&with_shed, EAST, Method::Lines);
        assert_eq!(words, "1 building");
    }
}
