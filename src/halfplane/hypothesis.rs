//! Plane hypotheses ready to compete: a group, where it may reach, what the images say there, its lines.

use nalgebra::{Point2, Vector2};

use super::Side;
use super::consistency::{ConsistencyMap, consistency_map, least_correlation};
use super::grouping::{GroupingInput, PlaneGroup};
use super::plan::PlanGrid;
use super::plane_lines::{PlaneLine, lines_in_plane, rays_through_ends};
use super::region::Region;
use crate::geometry::Segment3;
use crate::lines2d::ImageSegment;
use crate::params::RoofParams;
use crate::scene::Scene;
use crate::shares::map_shared;

/// A plane with its evidence.
pub struct Hypothesis {
    /// Lines, half-planes and plane.
    pub group: PlaneGroup,
    /// The part of the plan that it may cover.
    pub region: Region,
    /// Similarity of the views on the plane, over the region.
    pub map: ConsistencyMap,
    /// Lines found in the plane that may bound it.
    pub lines: Vec<PlaneLine>,
}

/// Compares the views (in `reduced`, whose pixels are about `step` wide) on every group's plane; planes of two lines that the images contradict beside their own lines
/// are dropped.
pub fn hypotheses(
    scene: &Scene,
    reduced: &Scene,
    segments: &[Vec<ImageSegment>],
    input: &GroupingInput,
    groups: Vec<PlaneGroup>,
    step: f64,
    params: &RoofParams,
) -> Vec<Hypothesis> {
    let rays = rays_through_ends(scene, segments);
    let built = map_shared("planes", &groups, 0.2..0.6, |_, group| {
        let region = Region::new(input, group, params);
        let (min, max) = region.bounds();
        let map = consistency_map(reduced, &group.plane, &PlanGrid::covering(min, max, step));
        let proposed_by_lines = group.half_planes().is_empty() && group.rectangles.is_empty();
        if proposed_by_lines && !supported(input, group, &map, params) {
            return None;
        }
        let mut lines = lines_in_plane(scene, &rays, &group.plane, &region);
        lines.retain(|l| !crosses_surface(&map, &l.segment));
        Some((region, map, lines))
    });
    groups
        .into_iter()
        .zip(built)
        .filter_map(|(group, built)| {
            built.map(|(region, map, lines)| Hypothesis {
                group,
                region,
                map,
                lines,
            })
        })
        .collect()
}

/// Correlation and texture weight from which on a position clearly shows the plane's surface.
pub const ON_SURFACE: f32 = 0.65;
/// See [`ON_SURFACE`].
pub const TEXTURED: f32 = 0.3;

/// Does the plane's surface clearly go on at both sides of the line? Rows of tiles do that, borders do not.
pub fn crosses_surface(map: &ConsistencyMap, line: &Segment3) -> bool {
    [Side::Left, Side::Right].into_iter().all(|side| {
        let seen = beside(map, line, side);
        let on = seen
            .iter()
            .filter(|(c, w)| *c >= ON_SURFACE && *w >= TEXTURED)
            .count();
        !seen.is_empty() && on * 5 >= seen.len() * 4
    })
}

/// Do the images, where they can tell, agree with the plane beside at least two of its lines?
fn supported(
    input: &GroupingInput,
    group: &PlaneGroup,
    map: &ConsistencyMap,
    params: &RoofParams,
) -> bool {
    let excesses = group.members.iter().filter_map(|m| {
        let seen = beside(map, &input.lines[m.line.index()].segment, m.side?);
        let excess = |(c, w): &(f32, f32)| {
            let (c, w) = (f64::from(*c), f64::from(*w));
            w * (c - least_correlation(w, params.min_correlation))
        };
        let weight: f64 = seen.iter().map(|(_, w)| f64::from(*w)).sum();
        (weight > 0.0).then(|| (seen.iter().map(excess).sum::<f64>(), weight))
    });
    let excesses: Vec<(f64, f64)> = excesses.collect();
    let agreeing = excesses.iter().filter(|(e, w)| *e >= -SCATTER * w);
    agreeing.clone().count() >= 2 && agreeing.map(|(e, _)| e).sum::<f64>() >= 0.0
}

/// Scatter of the mean correlation beside a line. Assumption: some ten independent windows.
const SCATTER: f64 = 0.05;

/// Correlation and weight at positions beside a line, farther from it than half a window.
fn beside(map: &ConsistencyMap, line: &Segment3, side: Side) -> Vec<(f32, f32)> {
    let (a, b) = (line.p0.xy(), line.p1.xy());
    let length = (b - a).norm();
    if length < 1e-6 {
        return Vec::new();
    }
    let d = (b - a) / length;
    let left = Vector2::new(-d.y, d.x) * (8.0 * map.grid.step);
    let across = if side == Side::Left { left } else { -left };
    let count = (length / (3.0 * map.grid.step)).ceil();
    (0..count as usize)
        .filter_map(|i| {
            let p: Point2<f64> = a + (b - a) * ((i as f64 + 0.5) / count) + across;
            let (c, r) = map.grid.cell(&p)?;
            let k = r * map.grid.width + c;
            Some((map.correlation(k), map.weight(k)))
        })
        .collect()
}
