//! Facets divided along the line of an edge.

use nalgebra::{Point2, Point3, Vector2};

use super::draft::{At, Draft, DraftFacet};
use super::outcome::NotApplied;
use super::place::corners;
use super::shape::{LEAST_AREA_M2, OFF_PLANE_M, turned, without};
use super::slope::{Beside, SHORTEST_EDGE_M, SIDE_OFFSET_M, Slope};
use crate::base::geometry::{Plane, Polygon, Segment3};
use crate::lines::lines3d::{Line3d, Side};
use crate::roofs::model::{Facet, SideSupport, SideUncertainty};

/// Planes and places farther apart than this many standard deviations are two.
const DIFFERENCE_SIGMAS: f64 = 3.0;

/// A stretch of a line in plan across a facet, from side to side.
struct Chord {
    /// Metres from the start of the line, in plan.
    stretch: [f64; 2],
    /// How much of it is drawn, metres.
    drawn_m: f64,
}

/// Divides the facets along a line, most of whose way across them is drawn, or else the one across
/// which it is drawn farthest. On either side the plane that the photographs show takes the place
/// of the facet's plane where it is another one; where they show none, the half turns about a line
/// off its plane, nearest to its other corners. Along a line without supports exactly one half must
/// turn. Returns the ends of the new edges.
pub(super) fn divide(
    draft: &mut Draft,
    beside: &Beside,
) -> Result<Vec<[Point3<f64>; 2]>, NotApplied> {
    let line = beside.line;
    let mut chords: Vec<Chord> = (draft.facets())
        .filter_map(|(_, f)| chord(&f.facet, &line.segment))
        .collect();
    let is_drawn = |c: &Chord| c.drawn_m >= 0.5 * (c.stretch[1] - c.stretch[0]);
    match chords.iter().any(is_drawn) {
        true => chords.retain(is_drawn),
        false => {
            chords.sort_by(|a, b| b.drawn_m.total_cmp(&a.drawn_m));
            chords.truncate(1);
        }
    }
    let mut divided = draft.clone();
    let mut edges = Vec::new();
    for Chord { stretch, .. } in chords {
        // Dividing one facet changes the place of the others among them.
        let middle = in_plan(&line.segment, 0.5 * (stretch[0] + stretch[1]));
        let at = divided.facet_below(&middle).ok_or(NotApplied::NoFacet)?;
        if let Some((facets, ends)) = halves(&divided, at, beside, stretch) {
            divided.rebuild(at.house, facets)?;
            edges.push(ends);
        }
    }
    if edges.is_empty() {
        return Err(NotApplied::NotDivided);
    }
    *draft = divided;
    Ok(edges)
}

/// The facets of a house, one of them divided, and the ends of the new edge; `None` where the edge
/// leaves nothing on one side.
fn halves(
    draft: &Draft,
    at: At,
    beside: &Beside,
    stretch: [f64; 2],
) -> Option<(Vec<DraftFacet>, [Point3<f64>; 2])> {
    let (whole, line) = (draft.get(at), beside.line);
    let own = &whole.facet.plane;
    let [from, to] = stretch.map(|t| at_corner(&in_plan(&line.segment, t), &whole.facet, line));
    let along = (to - from).try_normalize(SHORTEST_EDGE_M)?;
    let regions = regions_beside(&whole.facet, &(from + (to - from) * 0.5), &along)?;
    let on_line = [from, to].map(|p| Point3::new(p.x, p.y, height_above(&line.segment, &p)));
    let reach_m = DIFFERENCE_SIGMAS * line.sigma_m.max(OFF_PLANE_M);
    let is_off = on_line
        .iter()
        .any(|e| (own.z_at(e.x, e.y) - e.z).abs() > reach_m);
    let lifted = is_off.then(|| Segment3::new(on_line[0], on_line[1]));
    let turned_to = [Side::Left, Side::Right].map(|side| {
        other_plane(
            &whole.over(&regions[side as usize]),
            side,
            own,
            beside,
            &lifted,
        )
    });
    // What no other photograph shows lies on the facet, and bounds what does not: one half.
    let turning = turned_to.iter().flatten().count();
    if line.supports.is_empty() && turning != 1 {
        return None;
    }
    // Where one half keeps the plane of the facet, the edge lies in that.
    let ends = match turning {
        2 => on_line,
        _ => [from, to].map(|p| own.lift(p.x, p.y)),
    };
    let edge = Segment3::new(ends[0], ends[1]);
    let mut facets = without(&draft.houses[at.house].facets, &[at.facet]);
    for side in [0, 1] {
        for mut part in whole.over(&regions[side]) {
            let plane = turned_to[side].map(|plane| through(&edge, &plane));
            if let Some(plane) = plane {
                part = part.on(plane);
                part.facet.uncertainty = None;
            }
            if let Some(known) = &mut part.facet.uncertainty {
                known.sides.push(SideUncertainty {
                    ends: ends.map(|p| p.xy()),
                    sigma_m: line.sigma_m,
                    support: SideSupport::Edges,
                });
            }
            facets.push(part);
        }
    }
    Some((facets, ends))
}

/// What of a facet lies to the left and to the right of an edge; `None` where that is nothing.
fn regions_beside(
    facet: &Facet,
    middle: &Point2<f64>,
    along: &Vector2<f64>,
) -> Option<[Polygon; 2]> {
    let aside = Vector2::new(-along.y, along.x) * SIDE_OFFSET_M;
    let region = facet.plan();
    let left = part_at(&region.left_of(middle, along), &(middle + aside));
    let right = part_at(&region.without(&left), &(middle - aside));
    // Beyond its ends the edge divides nothing: what lies there belongs to the half beside it.
    let regions = [region.without(&right), right];
    let is_too_small = |half: &Polygon| half.area() < LEAST_AREA_M2;
    (!regions.iter().any(is_too_small)).then_some(regions)
}

/// The plane of a half whose largest part falls otherwise than the facet does; `lifted` is its edge
/// where that lies off the facet.
fn other_plane(
    parts: &[DraftFacet],
    side: Side,
    own: &Plane,
    beside: &Beside,
    lifted: &Option<Segment3>,
) -> Option<Plane> {
    let area = |part: &&DraftFacet| part.facet.plan_area();
    let half = &parts
        .iter()
        .max_by(|a, b| area(a).total_cmp(&area(b)))?
        .facet;
    let otherwise = match lifted {
        Some(edge) => turned(half, edge),
        None => *own,
    };
    let slope = beside.slope(side, half, otherwise);
    is_other(&slope, half, own, beside.line).then_some(slope.plane)
}

/// The connected part at a place, with its holes; nothing where the polygon is not.
fn part_at(polygon: &Polygon, p: &Point2<f64>) -> Polygon {
    let mut at = polygon.parts().into_iter().filter(|part| part.contains(p));
    at.next().unwrap_or_default()
}

/// Is a plane beside a line, at the corners of a facet, another one than that of the facet?
fn is_other(slope: &Slope, facet: &Facet, own: &Plane, line: &Line3d) -> bool {
    facet.outer.iter().any(|p| {
        let rise = slope.plane.z_at(p.x, p.y) - own.z_at(p.x, p.y);
        let turn_m = slope.sigma_theta * line.segment.line_distance(p);
        let sigma_m = (turn_m * turn_m + line.sigma_m * line.sigma_m).sqrt();
        rise.abs() > DIFFERENCE_SIGMAS * sigma_m
    })
}

/// The plane through an edge that falls across it as another one does.
fn through(edge: &Segment3, plane: &Plane) -> Plane {
    let direction = edge.direction();
    let normal = plane.normal - direction * plane.normal.dot(&direction);
    Plane::from_point_normal(&edge.p0, &normal).map_or(*plane, Plane::upwards)
}

/// The way of a line across a facet on which most of it is drawn.
fn chord(facet: &Facet, line: &Segment3) -> Option<Chord> {
    let (start, along) = (line.p0.xy(), plan_direction(line));
    let length = (line.p1.xy() - start).norm();
    let mut crossings: Vec<f64> = Vec::new();
    for [p, q] in facet.plan().sides() {
        let [a, b] = [p, q].map(|p| along.perp(&(p - start)));
        if (a > 0.0) != (b > 0.0) {
            let at = p + (q - p) * (a / (a - b));
            crossings.push(along.dot(&(at - start)));
        }
    }
    crossings.sort_by(f64::total_cmp);
    let all = crossings.chunks_exact(2).map(|c| Chord {
        stretch: [c[0], c[1]],
        drawn_m: c[1].min(length) - c[0].max(0.0),
    });
    let longest = all.max_by(|a, b| a.drawn_m.total_cmp(&b.drawn_m))?;
    (longest.drawn_m > 0.0).then_some(longest)
}

fn plan_direction(line: &Segment3) -> Vector2<f64> {
    (line.p1.xy() - line.p0.xy()).normalize()
}

/// The place of a line at a distance in plan from its start.
fn in_plan(line: &Segment3, t: f64) -> Point2<f64> {
    line.p0.xy() + plan_direction(line) * t
}

/// Height of a line beside a place in plan.
fn height_above(line: &Segment3, p: &Point2<f64>) -> f64 {
    let t = plan_direction(line).dot(&(p - line.p0.xy()));
    line.p0.z + (line.p1.z - line.p0.z) * t / (line.p1.xy() - line.p0.xy()).norm()
}

/// The corner of a facet from which a line's place cannot be told, or else that place.
fn at_corner(p: &Point2<f64>, facet: &Facet, line: &Line3d) -> Point2<f64> {
    let near = corners(facet)
        .map(|q| ((q.xy() - p).norm(), q.xy()))
        .filter(|(apart, _)| *apart <= DIFFERENCE_SIGMAS * line.sigma_m);
    let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map_or(*p, |(_, corner)| corner)
}
