//! Boundary leakage: what a facet covers beyond a line that bounds it (B99 4.3, figure 21 a).
//!
//! Where two roofs stand close together one may reach over the gap to the other: its eave and the
//! edge of its neighbour are both real lines, the gap is dark and narrow and gives little evidence,
//! and the labelling pays for one border instead of two. As a whole the facet passes verification,
//! so the part beyond a line that bounds it is tested by itself.

use std::collections::BTreeMap;

use nalgebra::{Point2, Point3};

use super::displaced_plane::{CLEAR_MARGIN, displaced_plane_margin};
use super::interior::{InteriorWindows, visible_interior};
use super::rejection::{FacetRejection, RejectedFacet};
use crate::facets::borders::{Arrangement, lies_in};
use crate::facets::competing_planes::CompetingPlanes;
use crate::facets::delineation::Outline;
use crate::geometry::{Segment3, clip, covered, mean_point};
use crate::ids::ViewId;
use crate::model::{Facet, Occluders};
use crate::params::RoofParams;
use crate::photoconsistency::{ConsistencyMap, WINDOW};
use crate::scene::Scene;

/// Share of a part's length along the line that is on it, from which on the line parts it from the
/// rest. Measured on rendered scenes: of the parts that are beyond the roof three quarters have
/// 0.93 and more.
const ALONG: f64 = 0.75;
/// Smallest part that is tested, square metres. Assumption: less holds too few windows.
const LEAST_PART_M2: f64 = 0.5;

/// Texture weight, summed over the windows inside a part, below which they are no evidence: that of
/// a row of windows from one to the next beside it. Measured: parts that are beyond the roof have
/// 13 and more, the corners of hips 3 and less.
const LEAST_WEIGHT: f64 = WINDOW as f64;

/// The cells of a verified facet that lie beyond a line that bounds it and that the views
/// contradict: of several such parts the one contradicted most.
pub(crate) fn boundary_leakage(
    competing: &CompetingPlanes,
    facet: &Facet,
    outline: &Outline,
    occluders: &Occluders,
    params: &RoofParams,
) -> Option<(Vec<usize>, RejectedFacet)> {
    let map = &competing.maps[outline.plane as usize];
    let hidden = competing.hidden_by(occluders);
    let in_plane = competing
        .bounding
        .iter()
        .filter(|l| lies_in(&facet.plane, l));
    let parts = in_plane.filter_map(|line| Some((line, part_beyond(facet, line)?)));
    let refused = parts.filter_map(|(line, part)| {
        let least = params.min_correlation;
        let (short, reason) = leakage(&competing.scene, &part, map, &hidden, least)?;
        Some((short, line, part, reason))
    });
    let (_, line, part, reason) = refused.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let cells = cells_beyond(line, &part, &outline.cells, &competing.arrangement);
    let refused = RejectedFacet {
        group: outline.plane,
        outline: part.outer,
        reason,
    };
    (!cells.is_empty() && cells.len() < outline.cells.len()).then_some((cells, refused))
}

/// By how much the views agree less than by chance inside a part of a facet that fails the
/// displaced-plane test too; `None` for a good part. `map` is that of all views on the plane, and
/// `hidden` tells which of them do not see a point of it.
fn leakage(
    scene: &Scene,
    part: &Facet,
    map: &ConsistencyMap,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
    min_correlation: f64,
) -> Option<(f64, FacetRejection)> {
    if !InteriorWindows::of(part, map)
        .sums(min_correlation)
        .is_doubtful()
    {
        return None;
    }
    let step = map.grid.step;
    let seen = visible_interior(scene, part, step, hidden, min_correlation);
    let short = -seen.beyond_chance();
    if short <= 0.0
        || seen.weight < LEAST_WEIGHT
        || displaced_plane_margin(scene, part, step, 0.0, hidden) >= CLEAR_MARGIN
    {
        return None;
    }
    let similarity = seen.overall / seen.weight;
    Some((short, FacetRejection::BoundaryLeakage { similarity }))
}

/// The smaller part of a facet beside a line, in plan, where the line runs along most of it.
fn part_beyond(facet: &Facet, line: &Segment3) -> Option<Facet> {
    let along = (line.p1 - line.p0).xy().try_normalize(1e-6)?;
    let offset = |p: &Point3<f64>| along.perp(&(p.xy() - line.p0.xy()));
    let sides = [1.0, -1.0].map(|sign| {
        let clipped = |ring: &Vec<Point3<f64>>| clip(ring, |p| sign * offset(p));
        Facet {
            outer: clipped(&facet.outer),
            holes: facet.holes.iter().map(clipped).collect(),
            ..facet.clone()
        }
    });
    let part = sides
        .into_iter()
        .min_by(|a, b| a.plan_area().total_cmp(&b.plan_area()))?;
    let positions = part
        .outer
        .iter()
        .map(|p| along.dot(&(p.xy() - line.p0.xy())));
    let [from, to] = positions.fold([f64::MAX, f64::MIN], |[a, b], t| [a.min(t), b.max(t)]);
    let length = (line.p1 - line.p0).xy().norm();
    let on_line = covered(std::iter::once([0.0, length]), [from, to]);
    (part.plan_area() >= LEAST_PART_M2 && on_line >= ALONG * (to - from)).then_some(part)
}

/// The cells of a facet most of whose area is on a part's side of a line.
fn cells_beyond(
    line: &Segment3,
    part: &Facet,
    cells: &[usize],
    arrangement: &Arrangement,
) -> Vec<usize> {
    let along = (line.p1 - line.p0).xy();
    let offset = |p: &Point2<f64>| along.perp(&(p - line.p0.xy()));
    let side = offset(&mean_point(&part.outer).xy()).signum();
    let mut beyond: BTreeMap<usize, f64> = cells.iter().map(|&c| (c, 0.0)).collect();
    for (corners, cell) in &arrangement.triangles {
        let Some(area) = beyond.get_mut(cell) else {
            continue;
        };
        let [a, b, c] = corners.map(|v| arrangement.vertices[v]);
        let middle = Point2::from((a.coords + b.coords + c.coords) / 3.0);
        if side * offset(&middle) > 0.0 {
            *area += 0.5 * (b - a).perp(&(c - a));
        }
    }
    let most = |(cell, area): (usize, f64)| (area > 0.5 * arrangement.areas[cell]).then_some(cell);
    beyond.into_iter().filter_map(most).collect()
}

#[cfg(test)]
mod tests {
    use super::super::interior::interior_map;
    use super::*;
    use crate::synthetic::gable_scene;
    use crate::testing;

    /// A level facet from the origin to (`x`, `y`), in metres.
    fn level(x: f64, y: f64) -> Facet {
        let corners = [(0.0, 0.0), (x, 0.0), (x, y), (0.0, y)];
        testing::facet(&corners.map(|(x, y)| Point3::new(x, y, 5.0)))
    }

    fn line(from: [f64; 2], to: [f64; 2]) -> Segment3 {
        let [from, to] = [from, to].map(|[x, y]| Point3::new(x, y, 5.0));
        Segment3::new(from, to)
    }

    #[test]
    fn a_line_along_most_of_a_facet_cuts_the_smaller_part_off() {
        let part = |line: Segment3| part_beyond(&level(10.0, 6.0), &line);
        let beyond = part(line([0.0, 4.5], [8.0, 4.5])).expect("runs along 8 m of 10");
        assert!((beyond.plan_area() - 15.0).abs() < 1e-9);
        assert!(beyond.outer.iter().all(|p| p.y > 4.49));
        let below = part(line([10.0, 1.0], [0.0, 1.0])).expect("either way round");
        assert!(below.outer.iter().all(|p| p.y < 1.01));
        assert!(part(line([0.0, 4.5], [7.0, 4.5])).is_none(), "too short");
        assert!(
            part(line([0.0, 5.97], [10.0, 5.97])).is_none(),
            "a splinter"
        );
        assert!(part(line([0.0, 6.5], [10.0, 6.5])).is_none(), "beside it");
    }

    #[test]
    fn cells_that_are_mostly_beyond_the_line_go() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [4.0, 4.0]].map(Point2::from);
        // Only the middle of the upper right one is beyond x + y = 5.
        let arrangement = Arrangement {
            vertices: corners.to_vec(),
            triangles: vec![([0, 1, 2], 0), ([1, 3, 2], 1)],
            cells: 2,
            areas: vec![8.0, 8.0],
            ..Arrangement::default()
        };
        let cut = line([5.0, 0.0], [0.0, 5.0]);
        let mut part = level(4.0, 4.0);
        part.outer = [[4.0, 1.0], [4.0, 4.0], [1.0, 4.0]]
            .map(|[x, y]| Point3::new(x, y, 5.0))
            .to_vec();
        assert_eq!(cells_beyond(&cut, &part, &[0, 1], &arrangement), [1]);
        assert!(cells_beyond(&cut, &part, &[0], &arrangement).is_empty());
    }

    #[test]
    fn what_a_roof_covers_beyond_its_eave_is_not_borne_out_and_what_it_covers_above_is() {
        let (scene, truth) = gable_scene(320);
        let roof = testing::facet(&truth.facets[0].1);
        let lowest = (0..roof.outer.len()).min_by(|&a, &b| {
            let z = |i: usize| roof.outer[i].z + roof.outer[(i + 1) % roof.outer.len()].z;
            z(a).total_cmp(&z(b))
        });
        let eave = lowest.expect("corners");
        let (a, b) = (roof.outer[eave], roof.outer[(eave + 1) % roof.outer.len()]);
        // From the eave up the slope, or down.
        let strip = |by: f64| {
            let along = (b - a).normalize();
            let up = roof.plane.normal.cross(&along) * by;
            let ring = match by > 0.0 {
                true => [a, b, b + up, a + up],
                false => [a + up, b + up, b, a],
            };
            testing::facet(&ring)
        };
        let short = |part: &Facet| {
            let map = interior_map(&scene, part, 0.1, &|_, _| false);
            leakage(&scene, part, &map, &|_, _| false, 0.45)
        };
        assert!(short(&strip(2.0)).is_none());
        // The corner between the eave and the fall line holds few windows, or many.
        let corner = |legs: f64| {
            let along = (b - a).normalize();
            let down = -roof.plane.normal.cross(&along);
            short(&testing::facet(&[a, a + down * legs, a + along * legs]))
        };
        assert!(corner(3.0).is_none() && corner(4.0).is_some());
        let (short, reason) = short(&strip(-2.0)).expect("there is nothing");
        assert!(short > 0.0 && matches!(reason, FacetRejection::BoundaryLeakage { .. }));
    }
}
