//! Points of interest (B99 4.1, figure 13b).
//!
//! "These points are computed by applying an edge detector to the first image, with a very low
//! threshold on gradient. The edges are then linked and regularly sampled to determine the POI."
//!
//! Edgels and chains are those of the line detector ([`crate::lines::lines2d`]), but with one
//! threshold for the whole image: relative to the surroundings, as for lines, the weak texture of a
//! plain roof is kept only together with its noise, or the texture of a tiled one is lost with it
//! (measured: the share of true line sides found falls from 77 to 75 % at 0.7 and to 63 % at 2
//! times the local noise). Positions are kept to the pixel: a correlation window needs no more.

use nalgebra::Point2;

use crate::base::params::SweepParams;
use crate::lines::lines2d::{detect_edgels, link_chains};
use crate::orienting::scene::Scene;
use crate::photographs::raster::Gray;

/// The points of interest of one view, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct PointsOfInterest {
    /// Columns of the points, ascending within a row.
    columns: Vec<u32>,
    /// The points of row `y` are `columns[starts[y]..starts[y + 1]]`.
    starts: Vec<usize>,
}

impl PointsOfInterest {
    /// Points of interest of one image.
    pub fn detect(gray: &Gray, params: &SweepParams) -> Self {
        let edgels = detect_edgels(gray, params.poi_blur_px, params.poi_min_gradient as f32);
        let spacing = params.poi_spacing_px.max(1);
        let mut points = Vec::new();
        for chain in link_chains(&edgels, 0.0) {
            for &edgel in chain.edgels.iter().step_by(spacing) {
                let (x, y) = edgels[edgel as usize].pixel();
                points.push(y * gray.width + x);
            }
        }
        points.sort_unstable();
        Self::from_indices(&points, gray)
    }

    /// Points of interest of every view, in the order of the views.
    pub fn detect_all(scene: &Scene, params: &SweepParams) -> Vec<Self> {
        crate::base::execution::map(&scene.views, |_, view| Self::detect(&view.gray, params))
    }

    /// The points (pixel centres) in a rectangle, `[min, max)` in pixels, row by row.
    pub fn within(
        &self,
        min: Point2<f64>,
        max: Point2<f64>,
    ) -> impl Iterator<Item = Point2<f64>> + '_ {
        let height = self.starts.len() - 1;
        let first = (min.y.floor().max(0.0) as usize).min(height);
        let last = (max.y.ceil().max(0.0) as usize).min(height);
        (first..last.max(first)).flat_map(move |y| {
            let row = &self.columns[self.starts[y]..self.starts[y + 1]];
            let from = row.partition_point(|&x| f64::from(x) + 0.5 < min.x);
            let to = row.partition_point(|&x| f64::from(x) + 0.5 < max.x);
            row[from..to.max(from)]
                .iter()
                .map(move |&x| Point2::new(f64::from(x) + 0.5, y as f64 + 0.5))
        })
    }

    /// From sorted indices `y * width + x`.
    fn from_indices(points: &[usize], gray: &Gray) -> Self {
        let width = gray.width.max(1);
        let starts = (0..=gray.height)
            .map(|y| points.partition_point(|&i| i < y * width))
            .collect();
        let columns = points.iter().map(|&i| (i % width) as u32).collect();
        Self { columns, starts }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(gray: &Gray) -> Vec<Point2<f64>> {
        PointsOfInterest::detect(gray, &SweepParams::default())
            .within(Point2::new(0.0, 0.0), Point2::new(1e3, 1e3))
            .collect()
    }

    #[test]
    fn a_weak_step_is_sampled_regularly() {
        let gray = Gray::from_fn(60, 40, |x, _| if x < 30 { 0.5 } else { 0.53 });
        let found = points(&gray);
        assert!(found.iter().all(|p| (p.x - 30.0).abs() <= 0.5));
        let spacing = SweepParams::default().poi_spacing_px as f64;
        for pair in found.windows(2) {
            assert!((pair[1].y - pair[0].y - spacing).abs() < 1e-9);
        }
        assert!(found.len() as f64 >= 34.0 / spacing);
    }

    #[test]
    fn a_homogeneous_image_has_none() {
        let gray = Gray::from_fn(40, 40, |x, _| 0.5 + 1e-4 * x as f32);
        assert!(points(&gray).is_empty());
        assert!(points(&Gray::new(3, 3)).is_empty());
    }

    #[test]
    fn a_rectangle_is_half_open() {
        let poi = PointsOfInterest {
            columns: vec![2, 5, 9, 5],
            starts: vec![0, 0, 3, 3, 4],
        };
        let hits: Vec<_> = poi
            .within(Point2::new(2.6, 0.0), Point2::new(9.5, 3.0))
            .collect();
        assert_eq!(hits, vec![Point2::new(5.5, 1.5)]);
        assert_eq!(
            poi.within(Point2::new(0.0, -9.0), Point2::new(99.0, 99.0))
                .count(),
            4
        );
    }
}
