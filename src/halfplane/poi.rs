//! Points of interest (B99 4.1, figure 13b).
//!
//! "These points are computed by applying an edge detector to the first image, with a very low
//! threshold on gradient. The edges are then linked and regularly sampled to determine the POI."
//!
//! Assumption: gradient of the blurred image, non-maximum suppression along the gradient, one
//! threshold without hysteresis; 8-connected chains; every third edgel, and at least one of each
//! chain. Positions stay on the pixel grid: a correlation window needs no more.

use nalgebra::Point2;

use crate::math;
use crate::params::SweepParams;
use crate::raster::{Gray, gaussian_blur};
use crate::scene::Scene;

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
        let mut edges = thin_edges(gray, params);
        let spacing = params.poi_spacing_px.max(1);
        let mut points = Vec::new();
        for start in 0..edges.data.len() {
            if edges.data[start] {
                let chain = edges.take_chain(start);
                points.extend(
                    chain
                        .iter()
                        .skip(spacing / 2 % chain.len())
                        .step_by(spacing),
                );
            }
        }
        points.sort_unstable();
        Self::from_indices(&points, gray)
    }

    /// Points of interest of every view, in the order of the views.
    pub fn detect_all(scene: &Scene, params: &SweepParams) -> Vec<Self> {
        crate::parallel::map(&scene.views, |_, view| Self::detect(&view.gray, params))
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

/// One-pixel-wide edges: which pixels still belong to no chain.
struct EdgeMap {
    width: usize,
    height: usize,
    data: Vec<bool>,
}

impl EdgeMap {
    /// The chain through `start`, in order along it, removed from the map.
    fn take_chain(&mut self, start: usize) -> Vec<usize> {
        self.data[start] = false;
        let mut chain = self.walk(start);
        chain.reverse();
        chain.push(start);
        chain.extend(self.walk(start));
        chain
    }

    /// The unvisited edgels that follow `from`, one neighbour after the other.
    fn walk(&mut self, from: usize) -> Vec<usize> {
        let mut path = Vec::new();
        let mut at = from;
        while let Some(next) = self.neighbour(at) {
            self.data[next] = false;
            path.push(next);
            at = next;
        }
        path
    }

    /// The next edgel beside `at`: sides before corners, so that a staircase stays one chain.
    fn neighbour(&self, at: usize) -> Option<usize> {
        const STEPS: [(isize, isize); 8] = [
            (1, 0),
            (0, 1),
            (-1, 0),
            (0, -1),
            (1, 1),
            (-1, 1),
            (-1, -1),
            (1, -1),
        ];
        let (x, y) = ((at % self.width) as isize, (at / self.width) as isize);
        STEPS.iter().find_map(|(dx, dy)| {
            let (x, y) = (x + dx, y + dy);
            let inside =
                x >= 0 && y >= 0 && (x as usize) < self.width && (y as usize) < self.height;
            let i = (y * self.width as isize + x) as usize;
            (inside && self.data[i]).then_some(i)
        })
    }
}

/// Pixels where the gradient is above the threshold and a maximum along its own direction.
fn thin_edges(gray: &Gray, params: &SweepParams) -> EdgeMap {
    let (width, height) = (gray.width, gray.height);
    let mut map = EdgeMap {
        width,
        height,
        data: vec![false; width * height],
    };
    if width < 5 || height < 5 {
        return map;
    }
    let blurred = gaussian_blur(gray, params.poi_blur_px).data;
    let gradient = |i: usize| {
        (
            (blurred[i + 1] - blurred[i - 1]) * 0.5,
            (blurred[i + width] - blurred[i - width]) * 0.5,
        )
    };
    let mut magnitude = vec![0.0f32; width * height];
    for y in 1..height - 1 {
        for i in y * width + 1..(y + 1) * width - 1 {
            let (gx, gy) = gradient(i);
            magnitude[i] = (gx * gx + gy * gy).sqrt();
        }
    }
    let threshold = params.poi_min_gradient as f32;
    let diagonal = math::tan(std::f64::consts::FRAC_PI_8) as f32;
    for y in 2..height - 2 {
        for i in y * width + 2..(y + 1) * width - 2 {
            let m = magnitude[i];
            if m < threshold {
                continue;
            }
            let (gx, gy) = gradient(i);
            let step = if gy.abs() < diagonal * gx.abs() {
                1
            } else if gx.abs() < diagonal * gy.abs() {
                width
            } else if gx * gy > 0.0 {
                width + 1
            } else {
                width - 1
            };
            // One strict and one weak comparison keep a plateau of two pixels one pixel wide.
            map.data[i] = m > magnitude[i - step] && m >= magnitude[i + step];
        }
    }
    map
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
