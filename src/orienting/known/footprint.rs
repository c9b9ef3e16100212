//! The outline of a building in plan.

use nalgebra::{Point2, Vector3};

use crate::base::geometry::{Polygon, bounds, sides, signed_area};
use crate::orienting::orientation::A_M;

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
    /// In plan: the outer ring, then its holes.
    pub outline: Polygon,
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
            let around_the_earth = std::f64::consts::TAU * A_M;
            if ring.iter().any(|p| p.coords.amax() > around_the_earth) {
                return Err(format!("{what} has a corner that is no place on the Earth"));
            }
            if let Some([i, j]) = crossing(&ring) {
                return Err(format!("{what} crosses itself after corners {i} and {j}"));
            }
            rings.push(ring);
        }
        let outer = rings.first().ok_or("it has no outline")?;
        if signed_area(outer.iter().copied()).abs() < 1.0 {
            return Err("it is smaller than a square metre".to_owned());
        }
        Ok(Self {
            name: outline.name,
            bounds: bounds(outer.iter().copied()),
            outline: Polygon { rings }.oriented(),
        })
    }

    /// Its bounding box: the south-western and the north-eastern corner.
    pub fn bounds(&self) -> [Point2<f64>; 2] {
        self.bounds
    }
}

/// The numbers, from 1, of two edges that cross in their insides.
fn crossing(ring: &[Point2<f64>]) -> Option<[usize; 2]> {
    let edges: Vec<[Point2<f64>; 2]> = sides(ring).collect();
    let side = |p: Point2<f64>, q: Point2<f64>, r: Point2<f64>| (q - p).perp(&(r - p));
    for (i, &[a, b]) in edges.iter().enumerate() {
        for (j, &[c, d]) in edges[..i].iter().enumerate() {
            if side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
                return Some([j + 1, i + 1]);
            }
        }
    }
    None
}
