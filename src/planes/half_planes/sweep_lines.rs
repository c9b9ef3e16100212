//! Half-planes at both sides of every line (B99 4.1).
//!
//! Lines on the ground are not swept: they bound no roof, and in a suburb more than half of all
//! lines lie there.

use super::half_plane::HalfPlane;
use super::poi::PointsOfInterest;
use super::similarity::LineSide;
use super::theta_search::ThetaSearch;
use super::trace::{SideTrace, SimilarityCurve, SweepRejection, SweepTrace};
use crate::base::execution::{Sharded, sharded_map};
use crate::base::geometry::Segment3;
use crate::base::ids::LineId;
use crate::base::params::SweepParams;
use crate::lines::lines3d::{Line3d, Side};
use crate::orienting::scene::Scene;
use crate::planes::terrain::Ground;

/// Half-planes of both sides of every line above the ground, in the order of the lines, left before
/// right. Sides that are `explained` without one are not swept.
pub fn sweep_half_planes(
    scene: &Scene,
    lines: &[Line3d],
    ground: &Ground,
    explained: &(dyn Fn(LineId, Side) -> bool + Sync),
    params: &SweepParams,
) -> Sharded<(Vec<HalfPlane>, SweepTrace)> {
    let points = match lines {
        [] => Vec::new(),
        _ => PointsOfInterest::detect_all(scene, params),
    };
    let sides: Vec<(usize, Side)> = (0..lines.len())
        .flat_map(|i| [(i, Side::Left), (i, Side::Right)])
        .collect();
    let swept = sharded_map("sides", &sides, 0.05..1.0, |_, &(i, side)| {
        let mut counts = SweepTrace::default();
        let line = LineId::from_index(i);
        if ground.is_near(&lines[i].segment, params.min_height_m) {
            counts.reject(line, side, SweepRejection::OnGround);
            return (None, counts);
        }
        if explained(line, side) {
            counts.reject(line, side, SweepRejection::Explained);
            return (None, counts);
        }
        let half_plane = sweep_side(scene, &points, line, &lines[i], side, params, &mut counts);
        (half_plane, counts)
    })?;
    let mut trace = SweepTrace::default();
    let mut half_planes = Vec::new();
    for (half_plane, counts) in swept {
        half_planes.extend(half_plane);
        trace.sides.extend(counts.sides);
        trace.correlations += counts.correlations;
        trace.warped_pixels += counts.warped_pixels;
    }
    Ok((half_planes, trace))
}

/// The half-plane of one side of one line, if there is one. Appends to the trace. `points` are
/// those of every view of the scene.
pub fn sweep_side(
    scene: &Scene,
    points: &[PointsOfInterest],
    id: LineId,
    line: &Line3d,
    side: Side,
    params: &SweepParams,
    trace: &mut SweepTrace,
) -> Option<HalfPlane> {
    let mut curve = SimilarityCurve::default();
    let result = LineSide::new(scene, points, &line.segment, side, params).and_then(|line_side| {
        let mut search = ThetaSearch::new(line_side, params);
        let result = search.run();
        trace.correlations += search.line_side.count;
        trace.warped_pixels += search.line_side.pixels;
        curve = search.curve();
        result.map(|found| found.half_plane(&search, id, line, side))
    });
    trace.sides.push(SideTrace {
        line: id,
        side,
        rejection: result.as_ref().err().copied(),
        curve,
    });
    result.ok()
}

/// `Sim(theta)` of one line side at given angles (radians), in total and per view. `points` are
/// those of every view of the scene ([`PointsOfInterest::detect_all`]).
pub fn similarity_curve(
    scene: &Scene,
    points: &[PointsOfInterest],
    line: &Segment3,
    side: Side,
    thetas: &[f64],
    params: &SweepParams,
) -> Result<SimilarityCurve, SweepRejection> {
    let line_side = LineSide::new(scene, points, line, side, params)?;
    let mut search = ThetaSearch::new(line_side, params);
    for &theta in thetas {
        search.evaluate(theta);
    }
    search.valid = search
        .best()
        .map(|i| search.valid_at(i))
        .unwrap_or_default();
    Ok(search.curve())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::Plane;
    use crate::base::ids::ViewId;
    use crate::lines::lines3d::ThetaFrame;
    use crate::planes::rendered_planes::{TexturedPlane, scene};
    use crate::roofs::testing::line;
    use nalgebra::{Point3, Vector3};

    /// A ridge along x at a height of 8 m: falls by 30 degrees to the left (north) and by 20
    /// degrees to the right (south).
    fn ridge() -> Line3d {
        line(Point3::new(-5.0, 0.0, 8.0), Point3::new(5.0, 0.0, 8.0))
    }

    fn slope(
        line: &Line3d,
        side: Side,
        theta_deg: f64,
        exists: fn(f64, f64) -> bool,
    ) -> TexturedPlane {
        let frame = ThetaFrame::new(&line.segment, side).unwrap();
        TexturedPlane {
            plane: frame.plane(&line.segment, f64::to_radians(theta_deg)),
            exists,
            texture: 0.3,
        }
    }

    fn horizontal(z: f64) -> TexturedPlane {
        TexturedPlane {
            plane: Plane::from_point_normal(&Point3::new(0.0, 0.0, z), &Vector3::z()).unwrap(),
            exists: |_, _| true,
            texture: 0.3,
        }
    }

    fn north(_: f64, y: f64) -> bool {
        y > 0.0
    }

    fn south(_: f64, y: f64) -> bool {
        y <= 0.0
    }

    fn gable() -> Scene {
        scene(&[
            slope(&ridge(), Side::Left, -30.0, north),
            slope(&ridge(), Side::Right, -20.0, south),
        ])
    }

    fn theta_deg(half_planes: &[HalfPlane], line: u32, side: Side) -> f64 {
        half_planes
            .iter()
            .find(|h| h.line == LineId(line) && h.side == side)
            .unwrap()
            .theta
            .to_degrees()
    }

    /// The sweep where nothing is explained.
    fn swept(
        scene: &Scene,
        lines: &[Line3d],
        ground: &Ground,
        params: &SweepParams,
    ) -> Sharded<(Vec<HalfPlane>, SweepTrace)> {
        sweep_half_planes(scene, lines, ground, &|_, _| false, params)
    }

    #[test]
    fn sides_that_coplanar_lines_explain_are_not_swept() {
        let params = SweepParams::default();
        let explained = |line, side| line == LineId(0) && side == Side::Left;
        let (scene, ground) = (gable(), Ground::level(0.0));
        let (found, trace) =
            sweep_half_planes(&scene, &[ridge()], &ground, &explained, &params).unwrap();
        assert_eq!(
            found.iter().map(|h| h.side).collect::<Vec<_>>(),
            [Side::Right]
        );
        assert_eq!(trace.sides[0].rejection, Some(SweepRejection::Explained));
    }

    #[test]
    fn negative_theta_falls_away_from_the_line() {
        let height = |side, y| slope(&ridge(), side, -30.0, north).plane.z_at(0.0, y);
        let drop = 2.0 / 3.0f64.sqrt();
        assert!((height(Side::Left, 2.0) - 8.0 + drop).abs() < 1e-9);
        assert!((height(Side::Right, -2.0) - 8.0 + drop).abs() < 1e-9);
    }

    #[test]
    fn both_sides_of_a_ridge_are_recovered() {
        let reversed = line(ridge().segment.p1, ridge().segment.p0);
        let (found, trace) = swept(
            &gable(),
            &[ridge(), reversed],
            &Ground::level(0.0),
            &SweepParams::default(),
        )
        .unwrap();
        assert_eq!(found.len(), 4);
        for (line, side, planted) in [
            (0, Side::Left, -30.0),
            (0, Side::Right, -20.0),
            (1, Side::Left, -20.0),
            (1, Side::Right, -30.0),
        ] {
            let theta = theta_deg(&found, line, side);
            assert!((theta - planted).abs() < 2.0, "{theta} for {planted}");
        }
        assert!(
            found
                .iter()
                .all(|h| h.views.len() == 3 && h.similarity > 0.8)
        );
        assert!(trace.sides.iter().all(|s| s.rejection.is_none()));
        assert!(trace.correlations > 0 && trace.warped_pixels > trace.correlations);
    }

    #[test]
    fn lines_on_the_ground_are_not_swept() {
        let sweep = |ground: f64, min_height_m: f64| {
            let params = SweepParams {
                min_height_m,
                ..SweepParams::default()
            };
            swept(&gable(), &[ridge()], &Ground::level(ground), &params).unwrap()
        };
        // The ridge is 8 m high.
        let (found, trace) = sweep(7.0, 1.4);
        assert!(found.is_empty() && trace.correlations == 0);
        let reasons = trace.sides.iter().map(|s| (s.side, s.rejection));
        let on_ground = Some(SweepRejection::OnGround);
        assert!(reasons.eq([Side::Left, Side::Right].map(|side| (side, on_ground))));
        assert_eq!(sweep(6.0, 1.4).0.len(), 2);
        assert_eq!(sweep(7.0, 0.9).0.len(), 2);
    }

    #[test]
    fn a_sloping_line_rises_with_its_plane() {
        // A hip: one side falls, the other one rises away from it.
        let hip = line(Point3::new(-5.0, -3.0, 6.0), Point3::new(5.0, 3.0, 9.0));
        let scene = scene(&[
            slope(&hip, Side::Left, 25.0, |x, y| y > 0.6 * x),
            slope(&hip, Side::Right, -40.0, |x, y| y <= 0.6 * x),
        ]);
        let (found, _) =
            swept(&scene, &[hip], &Ground::level(0.0), &SweepParams::default()).unwrap();
        assert!((theta_deg(&found, 0, Side::Left) - 25.0).abs() < 2.0);
        assert!((theta_deg(&found, 0, Side::Right) + 40.0).abs() < 2.0);
    }

    #[test]
    fn beyond_an_eave_there_is_no_half_plane() {
        // B99 figure 12: the roof ends at the line, the ground lies 8 m lower.
        let scene = scene(&[slope(&ridge(), Side::Left, 15.0, north), horizontal(0.0)]);
        let (found, trace) = swept(
            &scene,
            &[ridge()],
            &Ground::level(0.0),
            &SweepParams::default(),
        )
        .unwrap();
        assert_eq!(found.len(), 1);
        assert!((theta_deg(&found, 0, Side::Left) - 15.0).abs() < 2.0);
        assert!(trace.sides[1].rejection.is_some());
        assert!(!trace.sides[1].curve.thetas.is_empty());
    }

    #[test]
    fn an_occluded_view_is_not_valid() {
        let mut scene = gable();
        let covered = gable_covered().views.swap_remove(1);
        scene.views[1].gray = covered.gray;
        let (found, trace) = swept(
            &scene,
            &[ridge()],
            &Ground::level(0.0),
            &SweepParams::default(),
        )
        .unwrap();
        for (h, side) in found.iter().zip(&trace.sides) {
            assert_ne!(side.curve.reference, Some(ViewId(1)));
            assert!(!h.views.contains(&ViewId(1)));
            assert_eq!(h.views.len(), 2);
            let curve = &side.curve.views;
            assert!(curve.iter().all(|v| v.valid == (v.view != ViewId(1))));
        }
        assert!((theta_deg(&found, 0, Side::Left) + 30.0).abs() < 2.0);
        assert!((theta_deg(&found, 0, Side::Right) + 20.0).abs() < 2.0);
    }

    /// The gable below a horizontal cover, with less texture so that it is not the reference.
    fn gable_covered() -> Scene {
        let mut cover = horizontal(12.0);
        cover.texture = 0.01;
        scene(&[cover])
    }

    #[test]
    fn identical_views_are_entirely_similar() {
        let mut scene = gable();
        let first = scene.views[0].clone();
        scene.views = vec![first.clone(), first.clone(), first];
        let params = SweepParams::default();
        let points = PointsOfInterest::detect_all(&scene, &params);
        let thetas = [-0.9, -0.3, 0.0, 0.4, 1.0];
        let curve = similarity_curve(
            &scene,
            &points,
            &ridge().segment,
            Side::Left,
            &thetas,
            &params,
        )
        .unwrap();
        assert_eq!(curve.thetas, thetas);
        assert!(curve.similarity.iter().all(|s| (s - 1.0).abs() < 1e-3));
    }

    #[test]
    fn the_curve_of_every_view_peaks_at_the_plane() {
        let scene = gable();
        let params = SweepParams::default();
        let points = PointsOfInterest::detect_all(&scene, &params);
        let thetas: Vec<f64> = (-60..=60)
            .step_by(5)
            .map(|d| f64::from(d).to_radians())
            .collect();
        let curve = similarity_curve(
            &scene,
            &points,
            &ridge().segment,
            Side::Left,
            &thetas,
            &params,
        )
        .unwrap();
        for view in &curve.views {
            let best = (0..thetas.len())
                .max_by(|&a, &b| view.similarity[a].total_cmp(&view.similarity[b]))
                .unwrap();
            assert!((thetas[best].to_degrees() + 30.0).abs() < 5.1);
        }
        let frame = ThetaFrame::new(&ridge().segment, Side::Left).unwrap();
        for p in &curve.points {
            let world = scene
                .camera(curve.reference.unwrap())
                .at_height(p, 8.0)
                .unwrap();
            assert!((world - Point3::new(0.0, 0.0, 8.0)).dot(&frame.outward) > 0.0);
        }
    }

    #[test]
    fn rejections_name_the_reason() {
        let mut smooth = horizontal(8.0);
        smooth.texture = 0.0;
        let scene = scene(&[smooth]);
        let up = line(Point3::new(0.0, 0.0, 8.0), Point3::new(0.0, 0.0, 12.0));
        let short = line(Point3::new(0.0, 0.0, 8.0), Point3::new(0.5, 0.0, 8.0));
        let outside = line(Point3::new(0.0, 0.0, 8.0), Point3::new(50.0, 0.0, 8.0));
        let (found, trace) = swept(
            &scene,
            &[up, short, outside, ridge()],
            &Ground::level(0.0),
            &SweepParams::default(),
        )
        .unwrap();
        assert!(found.is_empty());
        let reasons: Vec<_> = trace.sides.iter().map(|s| s.rejection.unwrap()).collect();
        use SweepRejection::{NoFrame, NoPointsOfInterest, TooShort};
        assert_eq!(
            reasons[..6],
            [NoFrame, NoFrame, TooShort, TooShort, TooShort, TooShort]
        );
        assert_eq!(reasons[6..], [NoPointsOfInterest; 2]);
    }
}
