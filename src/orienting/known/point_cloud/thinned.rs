//! Points around a scene, as many as are of use: a few in each square of half a metre.

use crate::orienting::orientation::LARGEST_SCENE_M;
use nalgebra::{Point3, Vector3};

/// Squares in which points are counted, metres. Assumption: half of what tells roofs apart.
const SQUARE_SIDE_M: f64 = 0.5;
/// Most points that a square keeps, evenly by height: a wall and the roof above it keep both.
const MOST_POINTS_IN_SQUARE: usize = 3;
/// At most so many points are kept, 48 MB, and twice as many before they are thinned.
const MOST_POINTS: usize = 4_000_000;

/// Points of a cloud.
pub(super) struct Thinned {
    within: Option<[f64; 4]>,
    square_m: f64,
    points: Vec<Point3<f32>>,
}

impl Thinned {
    pub(super) fn new(within: Option<[f64; 4]>) -> Self {
        Self {
            within,
            square_m: SQUARE_SIDE_M,
            points: Vec::new(),
        }
    }

    /// Adds a point; what is no number or lies outside of the box is left out.
    pub(super) fn push(&mut self, p: Vector3<f64>) {
        let is_near = |v: f64| v.abs() < LARGEST_SCENE_M;
        let is_inside = (self.within)
            .is_none_or(|[x0, y0, x1, y1]| (x0..=x1).contains(&p.x) && (y0..=y1).contains(&p.y));
        if !(is_inside && p.iter().all(|v| is_near(*v))) {
            return;
        }
        self.points
            .push(Point3::new(p.x as f32, p.y as f32, p.z as f32));
        if self.points.len() >= 2 * MOST_POINTS {
            self.thin();
        }
    }

    /// The points that are kept, by squares.
    pub(super) fn finished(mut self) -> Vec<Point3<f32>> {
        self.thin();
        self.points.shrink_to_fit();
        self.points
    }

    fn thin(&mut self) {
        loop {
            let square = self.square_m as f32;
            let place = |p: &Point3<f32>| [p.y, p.x].map(|v| (v / square).floor() as i32);
            self.points
                .sort_by(|a, b| place(a).cmp(&place(b)).then(a.z.total_cmp(&b.z)));
            let mut kept = Vec::new();
            for of_square in self.points.chunk_by(|a, b| place(a) == place(b)) {
                // Evenly by height: what has two surfaces keeps both.
                let count = of_square.len().min(MOST_POINTS_IN_SQUARE);
                kept.extend(
                    (0..count).map(|i| of_square[(2 * i + 1) * of_square.len() / (2 * count)]),
                );
            }
            self.points = kept;
            if self.points.len() <= MOST_POINTS {
                return;
            }
            self.square_m *= 2.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_keeps_few_points_and_no_number_that_is_none() {
        let mut points = Thinned::new(Some([0.0, 0.0, 2.0, 2.0]));
        for i in 0..4000 {
            let v = f64::from(i);
            let p = Vector3::new(
                v.rem_euclid(7.0) * 0.3,
                (v / 7.0).rem_euclid(2.0),
                v / 4000.0,
            );
            points.push(p);
        }
        points.push(Vector3::new(1.0, 1.0, f64::NAN));
        points.push(Vector3::new(f64::INFINITY, 1.0, 1.0));
        points.push(Vector3::new(9.0, 1.0, 1.0));
        let kept = points.finished();
        // They lie in eight squares.
        assert_eq!(kept.len(), 8 * MOST_POINTS_IN_SQUARE);
        assert!(kept.iter().all(|p| p.iter().all(|v| v.is_finite())));
        assert!(kept.iter().all(|p| p.x <= 2.0));
    }
}
