//! The outline of a building in plan.

use nalgebra::{Point2, Vector2, Vector3};

/// An outline as a file has it, in the world frame.
pub(super) struct Outline {
    pub name: String,
    /// The outer ring and its holes; the last corner is not the first one again.
    pub rings: Vec<Vec<[f64; 2]>>,
}

/// The outline of a building, local frame, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Footprint {
    /// Its name in the register.
    pub name: String,
    /// The outer ring, then its holes.
    rings: Vec<Vec<Point2<f64>>>,
    /// South-western and north-eastern corner of its bounding box.
    bounds: [Point2<f64>; 2],
}

/// Most corners of a ring. Assumption: no building has more.
const MOST_CORNERS: usize = 5000;

impl Footprint {
    /// A footprint of an outline, less the origin of the scene; otherwise why it is none.
    pub(super) fn new(outline: Outline, origin: Vector3<f64>) -> Result<Self, String> {
        let mut rings = Vec::new();
        for (k, ring) in outline.rings.iter().enumerate() {
            let local = |p: &[f64; 2]| Point2::new(p[0] - origin.x, p[1] - origin.y);
            let mut ring: Vec<Point2<f64>> = ring.iter().map(local).collect();
            ring.dedup();
            if ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            let what = if k == 0 {
                "its outline"
            } else {
                "a hole of it"
            };
            match ring.len() {
                n if n < 3 => return Err(format!("{what} has fewer than three corners")),
                n if n > MOST_CORNERS => return Err(format!("{what} has {n} corners")),
                _ => {}
            }
            if let Some([i, j]) = crossing(&ring) {
                return Err(format!("{what} crosses itself after corners {i} and {j}"));
            }
            rings.push(ring);
        }
        let outer = rings.first().ok_or("it has no outline")?;
        if area(outer).abs() < 1.0 {
            return Err("it is smaller than a square metre".to_owned());
        }
        let extreme = |f: fn(f64, f64) -> f64, start: f64| {
            let x = outer.iter().map(|p| p.x).fold(start, f);
            let y = outer.iter().map(|p| p.y).fold(start, f);
            Point2::new(x, y)
        };
        let bounds = [
            extreme(f64::min, f64::INFINITY),
            extreme(f64::max, f64::NEG_INFINITY),
        ];
        Ok(Self {
            name: outline.name,
            rings,
            bounds,
        })
    }

    /// Its bounding box: the south-western and the north-eastern corner.
    pub fn bounds(&self) -> [Point2<f64>; 2] {
        self.bounds
    }

    /// The outer ring, then its holes.
    pub fn rings(&self) -> &[Vec<Point2<f64>>] {
        &self.rings
    }

    /// Area without its holes, square metres.
    pub fn area(&self) -> f64 {
        let areas: Vec<f64> = self.rings.iter().map(|ring| area(ring).abs()).collect();
        areas[0] - areas[1..].iter().sum::<f64>()
    }

    /// Does it contain a position? (even-odd)
    pub fn contains(&self, p: &Point2<f64>) -> bool {
        let crossed = self.edges().filter(|[a, b]| {
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)
        });
        crossed.count() % 2 == 1
    }

    /// Distance of a position inside from the border, metres; negative outside.
    pub fn depth(&self, p: &Point2<f64>) -> f64 {
        let distances = self.edges().map(|[a, b]| {
            let along: Vector2<f64> = b - a;
            let t = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            (p - (a + along * t)).norm()
        });
        let nearest = distances.fold(f64::INFINITY, f64::min);
        if self.contains(p) { nearest } else { -nearest }
    }

    /// All edges of its rings.
    pub fn edges(&self) -> impl Iterator<Item = [Point2<f64>; 2]> + '_ {
        self.rings.iter().flat_map(|ring| {
            let ends = ring.iter().cycle().skip(1);
            ring.iter().zip(ends).map(|(a, b)| [*a, *b])
        })
    }
}

/// The numbers, from 1, of two edges that cross in their insides.
fn crossing(ring: &[Point2<f64>]) -> Option<[usize; 2]> {
    let edge = |i: usize| (ring[i], ring[(i + 1) % ring.len()]);
    let side = |p: Point2<f64>, q: Point2<f64>, r: Point2<f64>| (q - p).perp(&(r - p));
    for i in 1..ring.len() {
        let (a, b) = edge(i);
        for j in 0..i {
            let (c, d) = edge(j);
            if side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
                return Some([j + 1, i + 1]);
            }
        }
    }
    None
}

/// Positive for counter-clockwise rings.
fn area(ring: &[Point2<f64>]) -> f64 {
    let at = |i: usize| ring[i % ring.len()] - ring[0];
    0.5 * (1..ring.len()).map(|i| at(i).perp(&at(i + 1))).sum::<f64>()
}
