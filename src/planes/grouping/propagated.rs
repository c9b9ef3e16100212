//! Half-planes where the texture is too weak for a sweep, propagated from a plane next to them.
//!
//! Of the strips of a saw-tooth roof all slope alike, and the sweep finds some. Beside a level line
//! that runs along a neighbouring plane, a side without a half-plane is offered one parallel to
//! that plane. The lines are then grouped as with any half-plane (B99 4.2); each is then tested by
//! its photo-consistency ([`crate::planes::hypotheses::hypothesis`]).

use super::growth::{grow_all, infer_sides};
use super::plane_group::{GroupingInput, PlaneGroup};
use crate::base::geometry::Plane;
use crate::base::ids::{HalfPlaneId, LineId};
use crate::base::params::RoofParams;
use crate::lines::lines3d::{Side, ThetaFrame};
use crate::planes::half_planes::{HalfPlane, is_wall};
use crate::planes::terrain::Ground;

/// Length from which on a line is offered planes, metres. Assumption: of a roof, not of a dormer.
const LEAST_LENGTH: f64 = 3.0;
/// Sine of the least slope that is propagated (6 degrees); level planes need no line that runs
/// along them.
pub(crate) const LEAST_SLOPE_SINE: f64 = 0.1;
/// Sine of the angle (3 degrees) to the horizontal, and to the neighbour's level direction, below
/// which a line runs along it.
const ALONG_SINE: f64 = 0.055;
/// Angle below which two planes through a line are one, radians (6 degrees).
const SAME: f64 = 0.1;
/// Standard deviation of the angle of a propagated half-plane, radians (3 degrees). Assumption:
/// that of a swept one on weak texture.
const SIGMA_THETA: f64 = 0.05;

/// The half-planes that the sweep found, and behind them those propagated from a group next to
/// their line. These have no views ([`HalfPlane::is_swept`]).
pub(super) fn with_propagated(
    input: &GroupingInput,
    groups: &[PlaneGroup],
    ground: &Ground,
    params: &RoofParams,
) -> Vec<HalfPlane> {
    let mut groups_of_line = vec![Vec::new(); input.lines.len()];
    for group in groups {
        let lines = group.lines();
        (lines.iter()).for_each(|line| groups_of_line[line.index()].push(group));
    }
    let mut has_half_plane = vec![[false; 2]; input.lines.len()];
    for h in input.half_planes {
        has_half_plane[h.line.index()][h.side as usize] = true;
    }
    let mut half_planes = input.half_planes.to_vec();
    for id in (0..input.lines.len()).map(LineId::from_index) {
        let segment = &input.lines[id.index()].segment;
        let on_ground = ground.is_near(segment, params.min_height_m);
        if segment.length() < LEAST_LENGTH || on_ground {
            continue;
        }
        let own = &groups_of_line[id.index()];
        let neighbours = &input.neighbours;
        let around = (neighbours.direct[id.index()].iter())
            .chain(&neighbours.around_corners[id.index()])
            .flat_map(|line| &groups_of_line[line.index()]);
        let planes: Vec<Plane> = (around.chain(own))
            .filter(|group| !group.half_planes().is_empty())
            .map(|group| group.plane)
            .filter(|plane| runs_along(&segment.direction(), plane))
            .collect();
        for side in [Side::Left, Side::Right] {
            let Some(frame) = ThetaFrame::new(segment, side) else {
                continue;
            };
            if has_half_plane[id.index()][side as usize] {
                continue;
            }
            let mut offered: Vec<Plane> = own.iter().map(|group| group.plane).collect();
            for neighbour in &planes {
                let theta = frame.theta_of(neighbour);
                let plane = frame.plane(segment, theta);
                if is_wall(&plane) || offered.iter().any(|o| o.angle_to(&plane) < SAME) {
                    continue;
                }
                offered.push(plane);
                half_planes.push(half_plane(id, side, theta, plane));
            }
        }
    }
    half_planes
}

/// Is a direction level, and the plane sloped across it?
fn runs_along(direction: &nalgebra::Vector3<f64>, plane: &Plane) -> bool {
    let down = plane.normal.xy();
    let along = down.dot(&direction.xy()).abs();
    direction.z.abs() < ALONG_SINE
        && down.norm() > LEAST_SLOPE_SINE
        && along < ALONG_SINE * down.norm()
}

/// A propagated half-plane: no view has shown it.
pub(crate) fn half_plane(line: LineId, side: Side, theta: f64, plane: Plane) -> HalfPlane {
    HalfPlane {
        line,
        side,
        theta,
        sigma_theta: SIGMA_THETA,
        similarity: 0.0,
        curvature: 0.0,
        amplitude: 0.0,
        probability: 0.0,
        views: Vec::new(),
        plane,
    }
}

/// Groups of the propagated half-planes, as of swept ones: strips next to each other stay apart,
/// pieces of one line come together.
pub(super) fn group_propagated(input: &GroupingInput, params: &RoofParams) -> Vec<PlaneGroup> {
    let mut by_line = vec![Vec::new(); input.lines.len()];
    let mut free = vec![false; input.half_planes.len()];
    for (i, h) in input.half_planes.iter().enumerate() {
        if !h.is_swept() {
            by_line[h.line.index()].push(HalfPlaneId::from_index(i));
            free[i] = true;
        }
    }
    let mut groups = grow_all(input, &by_line, free, params);
    groups.iter_mut().for_each(|g| infer_sides(input, g));
    groups
}

#[cfg(test)]
mod tests {
    use super::super::grouped::group_planes;
    use super::super::neighbourhood::line_neighbours;
    use super::*;
    use crate::base::ids::ViewId;
    use crate::lines::lines3d::Line3d;
    use crate::roofs::testing::line;
    use nalgebra::Point3;

    /// The ridges of a saw-tooth roof at 8 m, 4 m apart; the sweep has found that the first strip
    /// rises to its ridge by 1:2. The second ridge was found in two pieces. The last line is a
    /// wall's foot.
    fn saw_tooth() -> (Vec<Line3d>, HalfPlane) {
        let ridge =
            |x0: f64, x1: f64, y: f64| line(Point3::new(x0, y, 8.0), Point3::new(x1, y, 8.0));
        let foot = line(Point3::new(0.0, 12.5, 0.0), Point3::new(20.0, 12.5, 0.0));
        let lines = vec![
            ridge(0.0, 20.0, 0.0),
            ridge(0.0, 12.0, 4.0),
            ridge(12.5, 20.0, 4.0),
            foot,
        ];
        let frame = ThetaFrame::new(&lines[0].segment, Side::Right).expect("not vertical");
        let theta = -crate::base::math::atan2(1.0, 2.0);
        let swept = HalfPlane {
            views: vec![ViewId(0), ViewId(1)],
            similarity: 0.8,
            ..half_plane(
                LineId(0),
                Side::Right,
                theta,
                frame.plane(&lines[0].segment, theta),
            )
        };
        (lines, swept)
    }

    #[test]
    fn the_strips_of_a_saw_tooth_roof_repeat_the_one_that_was_found() {
        let (lines, swept) = saw_tooth();
        let (swept, params) = ([swept], RoofParams::default());
        let neighbours = line_neighbours(&lines);
        let input = GroupingInput {
            lines: &lines,
            half_planes: &swept,
            neighbours: &neighbours,
            proposals: &[],
        };
        let groups = group_planes(&input, true, &params);
        let half_planes = with_propagated(&input, &groups, &Ground::level(0.0), &params);
        assert_eq!(half_planes[0], swept[0]);
        let propagated = &half_planes[1..];
        assert!(propagated.iter().all(|h| !h.is_swept()));
        // Neither at the foot nor again through the first ridge, and on both sides of the second,
        // whose strip lies on one of them.
        let lines_of: Vec<u32> = propagated.iter().map(|h| h.line.0).collect();
        assert_eq!(lines_of, [1, 1, 2, 2]);
        let fits = |h: &HalfPlane| h.plane.angle_to(&swept[0].plane) < 1e-9;
        assert!(propagated.iter().all(fits), "parallel to it");
        assert!(
            propagated
                .iter()
                .all(|h| (h.plane.z_at(5.0, 4.0) - 8.0).abs() < 1e-9)
        );

        let input = GroupingInput {
            half_planes: &half_planes,
            ..input
        };
        let groups = group_propagated(&input, &params);
        assert_eq!(groups.len(), 1, "both pieces of the ridge have one plane");
        assert_eq!(groups[0].lines(), [LineId(1), LineId(2)]);
        assert!(groups[0].is_propagated(&input));
        assert!((groups[0].plane.z_at(10.0, 2.0) - 7.0).abs() < 1e-6);
        assert!(
            groups[0]
                .without_propagated(&input)
                .half_planes()
                .is_empty()
        );
    }

    #[test]
    fn a_line_across_a_slope_repeats_nothing() {
        let (lines, swept) = saw_tooth();
        let along = lines[0].segment.direction();
        assert!(runs_along(&along, &swept.plane));
        let level = nalgebra::Vector3::new(along.y, -along.x, 0.0);
        assert!(
            !runs_along(&level, &swept.plane),
            "a batten across the strips"
        );
        let rising = nalgebra::Vector3::new(0.9, 0.0, 0.3);
        assert!(!runs_along(&rising, &swept.plane));
        let flat = Plane {
            normal: nalgebra::Vector3::z(),
            d: -8.0,
        };
        assert!(!runs_along(&along, &flat));
    }
}
