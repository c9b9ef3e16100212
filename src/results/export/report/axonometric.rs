//! A building from above and aside, in parallel projection: no face hides what is in front of it.
//!
//! Faces are drawn from the back to the front. Of two faces whose pictures overlap, the one nearer
//! to the viewer in the middle of the overlap comes later; faces of a closed solid do not cross.

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::reported::ReportedModel;
use super::svg::{Drawing, place_inside};
use crate::base::geometry::{Polygon, bounds, signed_area};
use crate::base::math::{atan2, sin_cos};
use crate::roofs::model::{Building, Surface};

/// The largest picture, millimetres: four of them fit above a plan.
const PAGE: Vector2<f64> = Vector2::new(87.0, 44.0);

/// Room around it, millimetres.
const MARGIN: f64 = 2.0;

/// Height of the viewer above the horizon, degrees.
const ELEVATION_DEG: f64 = 38.0;

/// The longest eave is seen under this angle, degrees: not edge on, and not from the front.
const TURN_DEG: f64 = 32.0;

/// Faces seen at a smaller angle than this (its sine) are lines.
const EDGE_ON: f64 = 1e-3;

/// Overlaps below this area are rounding, square metres.
const LEAST_OVERLAP_M2: f64 = 1e-4;

/// Where the viewer is.
struct Viewer {
    right: Vector3<f64>,
    up: Vector3<f64>,
    towards: Vector3<f64>,
}

impl Viewer {
    /// One that sees lines of this direction obliquely, and stands as far in the south as may be
    /// (side 0), or by so many quarters further round.
    fn beside(direction: Vector2<f64>, side: usize) -> Self {
        let along = atan2(direction.y, direction.x).to_degrees();
        let angles = [0.0, 90.0, 180.0, 270.0].map(|quarter| along + TURN_DEG + quarter);
        let place = |angle: f64| {
            let (sin, cos) = sin_cos(angle.to_radians());
            Vector2::new(cos, sin)
        };
        let places = angles.map(place);
        let is_farther = |i: &usize, j: &usize| places[*i].y.total_cmp(&places[*j].y);
        let south = (0..4).min_by(is_farther).expect("there are four");
        let from = places[(south + side) % 4];
        let (sin, cos) = sin_cos(ELEVATION_DEG.to_radians());
        Self {
            right: Vector3::new(-from.y, from.x, 0.0),
            up: Vector3::new(-from.x * sin, -from.y * sin, cos),
            towards: Vector3::new(from.x * cos, from.y * cos, sin),
        }
    }

    /// Metres in the picture, x right, y up.
    fn project(&self, p: &Point3<f64>) -> Point2<f64> {
        Point2::new(self.right.dot(&p.coords), self.up.dot(&p.coords))
    }
}

/// A face that the viewer sees.
struct SeenFace {
    surface: Surface,
    picture: Polygon,
    normal: Vector3<f64>,
    corner: Point3<f64>,
}

impl SeenFace {
    /// How far in front a face is at a place in the picture, metres.
    fn nearness(&self, viewer: &Viewer, p: &Point2<f64>) -> f64 {
        let through = viewer.right * p.x + viewer.up * p.y;
        let distance = self.normal.dot(&(self.corner.coords - through));
        distance / self.normal.dot(&viewer.towards)
    }
}

/// The picture of a building from one of four sides, its facets with their numbers.
pub(super) fn axonometric(reported: &ReportedModel, index: usize, side: usize) -> String {
    let building = &reported.model.buildings[index];
    let edges = reported.buildings[index].edges.iter();
    let longest = edges.max_by(|a, b| a.length_m.value.total_cmp(&b.length_m.value));
    let direction = longest.map_or_else(Vector2::x, |e| e.edge.segment.direction().xy());
    let viewer = Viewer::beside(direction, side);
    let faces = seen_faces(building, &viewer);
    let [low, high] = bounds(faces.iter().flat_map(|f| f.picture.bounds()));
    let (extent, room) = (high - low, PAGE - Vector2::repeat(2.0 * MARGIN));
    let scale = (room.x / extent.x.max(1e-6)).min(room.y / extent.y.max(1e-6));
    let size = extent * scale + Vector2::repeat(2.0 * MARGIN);
    let on_paper = |p: &Point2<f64>| {
        let x = (p.x - low.x) * scale + MARGIN;
        Point2::new(x, (high.y - p.y) * scale + MARGIN)
    };
    let title = format!("{} from above and aside", reported.names[index]);
    let mut drawing = Drawing::new(size, &title);
    for face in back_to_front(&faces, &viewer) {
        let face = &faces[face];
        let picture = face.picture.mapped(on_paper);
        drawing.area(
            &picture,
            &format!("class=\"face\" fill=\"{}\"", colour(face)),
        );
        if let Surface::Roof(facet) = face.surface {
            drawing.words(
                place_inside(&picture),
                0.0,
                "number",
                &facet.number().to_string(),
            );
        }
    }
    drawing.finish()
}

fn seen_faces(building: &Building, viewer: &Viewer) -> Vec<SeenFace> {
    let solid = &building.solid;
    let corner = |v: &u32| solid.vertices[*v as usize];
    let faces = solid.faces.iter().filter_map(|face| {
        let normal = solid.vector_area(&face.rings).try_normalize(1e-9)?;
        let project = |ring: &Vec<u32>| ring.iter().map(|v| viewer.project(&corner(v))).collect();
        (normal.dot(&viewer.towards) > EDGE_ON).then(|| SeenFace {
            surface: face.surface,
            picture: Polygon {
                rings: face.rings.iter().map(project).collect(),
            },
            normal,
            corner: corner(&face.rings[0][0]),
        })
    });
    faces.collect()
}

/// The order in which faces are drawn.
fn back_to_front(faces: &[SeenFace], viewer: &Viewer) -> Vec<usize> {
    let bounds: Vec<_> = faces.iter().map(|f| f.picture.bounds()).collect();
    let apart = |i: usize, j: usize| {
        let ([a, b], [c, d]) = (bounds[i], bounds[j]);
        (0..2).any(|axis| b[axis] <= c[axis] || d[axis] <= a[axis])
    };
    // Which faces must have been drawn before each.
    let mut behind = vec![Vec::new(); faces.len()];
    for i in 0..faces.len() {
        for j in (0..i).filter(|&j| !apart(i, j)) {
            if let Some(place) = common_place(&faces[i].picture, &faces[j].picture) {
                let [a, b] = [i, j].map(|f| faces[f].nearness(viewer, &place));
                let (near, far) = if a > b { (i, j) } else { (j, i) };
                behind[near].push(far);
            }
        }
    }
    let mut order = Vec::new();
    let mut is_drawn = vec![false; faces.len()];
    let depth = |i: &usize| faces[*i].corner.coords.dot(&viewer.towards);
    while order.len() < faces.len() {
        let left = || (0..faces.len()).filter(|&i| !is_drawn[i]);
        let free = left().find(|&i| behind[i].iter().all(|&j| is_drawn[j]));
        // Faces around in a ring: the one farthest away first.
        let farthest = || left().min_by(|a, b| depth(a).total_cmp(&depth(b)));
        let next = free.or_else(farthest).expect("one is left");
        is_drawn[next] = true;
        order.push(next);
    }
    order
}

/// The middle of the largest part that two pictures have in common.
fn common_place(a: &Polygon, b: &Polygon) -> Option<Point2<f64>> {
    let common = a.and(b);
    let area = |ring: &Vec<Point2<f64>>| signed_area(ring.iter().copied());
    let largest = (common.rings.iter()).max_by(|p, q| area(p).total_cmp(&area(q)))?;
    (area(largest) >= LEAST_OVERLAP_M2).then(|| place_inside(&largest.clone().into()))
}

/// Tiles or plaster, in the light from the upper left.
fn colour(face: &SeenFace) -> String {
    let light = Vector3::new(-0.35, -0.25, 0.9).normalize();
    let shade = 0.68 + 0.32 * face.normal.dot(&light).max(0.0);
    let base = match face.surface {
        Surface::Roof(_) => [226.0, 168.0, 140.0],
        Surface::Wall | Surface::Ceiling | Surface::Ground => [238.0, 234.0, 226.0],
    };
    let [r, g, b] = base.map(|c: f64| (c * shade).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::solids::close_buildings;

    #[test]
    fn what_is_in_front_is_drawn_last() {
        // A tower behind a low flat roof, and a chimney-like block in front of both.
        let flat = |x: f64, y: f64, z: f64| {
            let ring = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)];
            let corner = |(dx, dy)| Point3::new(x + dx, y + dy, z);
            crate::roofs::testing::facet(&ring.map(corner))
        };
        let facets = [
            flat(0.0, 0.0, 3.0),
            flat(0.0, 3.0, 9.0),
            flat(0.0, -3.0, 5.0),
        ];
        let (model, _) = close_buildings(&facets, |_| 0.0);
        let viewer = Viewer::beside(Vector2::x(), 0);
        assert!(viewer.towards.y < 0.0, "from the south");
        let faces = seen_faces(&model.buildings[0], &viewer);
        let order = back_to_front(&faces, &viewer);
        // Every place shows the nearest of the faces there.
        let [low, high] = bounds(faces.iter().flat_map(|f| f.picture.bounds()));
        let mut places = 0;
        for i in 0..1600 {
            let share = Vector2::new(f64::from(i % 40) + 0.37, f64::from(i / 40) + 0.61) / 40.0;
            let p = low + (high - low).component_mul(&share);
            let here: Vec<usize> = order
                .iter()
                .copied()
                .filter(|&f| faces[f].picture.contains(&p))
                .collect();
            let nearness = |f: &usize| faces[*f].nearness(&viewer, &p);
            let nearest = here
                .iter()
                .max_by(|a, b| nearness(a).total_cmp(&nearness(b)));
            assert_eq!(here.last(), nearest);
            places += usize::from(here.len() > 1);
        }
        assert!(places > 10, "{places} places with something behind");
    }
}
