//! What a photo-consistency map shows on both sides of a line.

use nalgebra::{Point2, Vector2};

use crate::base::evidence::WindowEvidenceTable;
use crate::base::geometry::Segment3;
use crate::lines::lines3d::Side;
use crate::planes::photoconsistency::{ConsistencyMap, PlanGrid};

/// Distance from a line at which its sides are sampled, cells: farther than half a window.
pub(super) const NEXT_TO: f64 = 4.0;
/// Distance of the places beside a line, cells: windows share most of their cells with the next.
const APART: f64 = 1.5;
/// What a window says of a plane, nats, whose surface it clearly shows, ln 3: three times likelier
/// than not. Of one that clearly shows another surface it is as much below zero.
pub(super) const CLEAR_NATS: f64 = 1.1;

/// Does the plane's surface clearly continue on both sides of the line? Rows of tiles do that,
/// borders do not.
pub(crate) fn crosses_surface(map: &ConsistencyMap, line: &Segment3) -> bool {
    let table = WindowEvidenceTable::fitted();
    [Side::Left, Side::Right].into_iter().all(|side| {
        let seen = beside(map, line, side, NEXT_TO);
        let on = seen
            .iter()
            .filter(|(c, w)| table.nats_of(*w, *c) >= CLEAR_NATS);
        let on = on.count();
        !seen.is_empty() && on * 5 >= seen.len() * 4
    })
}

/// Horizontal unit vector across a line to a side.
pub(super) fn across(line: &Segment3, side: Side) -> Vector2<f64> {
    let d = line.direction().xy().normalize();
    match side {
        Side::Left => Vector2::new(-d.y, d.x),
        Side::Right => Vector2::new(d.y, -d.x),
    }
}

/// Correlation and weight at positions beside a line, some cells away from it.
pub(super) fn beside(
    map: &ConsistencyMap,
    line: &Segment3,
    side: Side,
    cells: f64,
) -> Vec<(f32, f32)> {
    places_beside(&map.grid, line, side, cells)
        .map(|k| (map.correlation(k), map.weight(k)))
        .collect()
}

/// Positions of a grid (row by row) beside a line, some cells away from it.
pub(super) fn places_beside(
    grid: &PlanGrid,
    line: &Segment3,
    side: Side,
    cells: f64,
) -> impl Iterator<Item = usize> + Clone {
    let (a, b) = (line.p0.xy(), line.p1.xy());
    let length = (b - a).norm();
    let count = match length < 1e-6 {
        true => 0.0,
        false => (length / (APART * grid.step)).ceil(),
    };
    let across = across(line, side) * (cells * grid.step);
    (0..count as usize).filter_map(move |i| {
        let p: Point2<f64> = a + (b - a) * ((i as f64 + 0.5) / count) + across;
        let (c, r) = grid.cell(&p)?;
        Some(r * grid.width + c)
    })
}
