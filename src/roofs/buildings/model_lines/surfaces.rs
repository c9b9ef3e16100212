//! The surfaces of the finished model, and the share of a line that lies on them.

use nalgebra::{Point2, Point3, Vector2};

use crate::lines::lines3d::Line3d;
use crate::planes::terrain::Ground;
use crate::roofs::model::{Facet, Occluders};

/// A line lies on a surface that is no farther than this from it, metres, in plan and, besides its
/// standard deviation, in height.
const SURFACE_TOLERANCE_M: f64 = 0.25;
/// Spacing of the samples along a stretch, metres, and their least and greatest number.
const SAMPLE_SPACING_M: f64 = 0.3;
const PLACES: [usize; 2] = [5, 64];

/// Roofs, the walls below them and the ground.
pub(super) struct Surfaces<'a> {
    /// The roofs.
    pub roofs: Occluders<'a>,
    ground: &'a Ground,
}

impl<'a> Surfaces<'a> {
    /// The surfaces of a model.
    pub(super) fn new(facets: &'a [Facet], ground: &'a Ground) -> Self {
        Self {
            roofs: Occluders::new(facets),
            ground,
        }
    }

    /// The share of a line that lies on roofs, walls or the ground.
    pub(super) fn share_of(&self, line: &Line3d) -> f64 {
        let tolerance = SURFACE_TOLERANCE_M + line.sigma_m;
        let beside = [
            (0.0, 0.0),
            (SURFACE_TOLERANCE_M, 0.0),
            (-SURFACE_TOLERANCE_M, 0.0),
            (0.0, SURFACE_TOLERANCE_M),
            (0.0, -SURFACE_TOLERANCE_M),
        ];
        share_where(line, [0.0, 1.0], |p| {
            // Walls fill what is between the highest and the lowest surface.
            let tops = beside.map(|(x, y)| self.top_at(&(p.xy() + Vector2::new(x, y))));
            let [low, high] = [f64::min, f64::max].map(|f| tops.into_iter().fold(tops[0], f));
            p.z > low - tolerance && p.z < high + tolerance
        })
    }

    /// Height of the highest surface at a plan position, of a roof or of the ground there, metres.
    fn top_at(&self, p: &Point2<f64>) -> f64 {
        let roof = self.roofs.top_at(p);
        roof.unwrap_or_else(|| self.ground.z_at(p))
    }
}

/// The share of a stretch of a line, between two fractions of its length, where a condition holds.
pub(super) fn share_where(
    line: &Line3d,
    [from, to]: [f64; 2],
    condition: impl Fn(&Point3<f64>) -> bool,
) -> f64 {
    let metres = (to - from).abs() * line.segment.length();
    let count = ((metres / SAMPLE_SPACING_M) as usize).clamp(PLACES[0], PLACES[1]);
    let place = |i: usize| line.at(from + (to - from) * (i as f64 + 0.5) / count as f64);
    let fulfilled = (0..count).filter(|&i| condition(&place(i))).count();
    fulfilled as f64 / count as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roofs::buildings::refine::gable;
    use crate::roofs::testing;

    #[test]
    fn a_line_lies_on_roofs_walls_or_the_ground() {
        // The gable reaches from y = -4 to 4, eaves at 6 m, ridge at 9 m.
        let (roof, ground) = (gable(), Ground::level(0.0));
        let surfaces = Surfaces::new(&roof, &ground);
        let of = |p: [f64; 3], q: [f64; 3]| surfaces.share_of(&testing::line(p.into(), q.into()));
        assert_eq!(of([-2.0, 0.0, 9.0], [2.0, 0.0, 9.0]), 1.0, "the ridge");
        assert_eq!(of([-2.0, 0.0, 8.0], [2.0, 0.0, 8.0]), 0.0, "below it");
        assert_eq!(of([-2.0, -4.0, 3.0], [2.0, -4.0, 3.0]), 1.0, "a wall");
        assert_eq!(of([-2.0, -5.0, 3.0], [2.0, -5.0, 3.0]), 0.0, "before it");
        assert_eq!(of([-2.0, -9.0, 0.1], [2.0, -9.0, 0.1]), 1.0, "the ground");
        let half = of([0.0, -9.0, -4.0], [0.0, -5.0, 4.0]);
        assert!(half > 0.0 && half < 0.2, "through the ground: {half}");
    }
}
