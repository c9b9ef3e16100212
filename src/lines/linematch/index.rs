//! A raster of cells that lists the segments passing through each: the paper's "lines are stored in
//! a raster format, i.e. a pixel indexes a line" (B99 3.2), with coarser cells.

use nalgebra::Point2;

use crate::base::geometry::{Segment2, depth, sides};

/// Side of a cell, pixels. Assumption: about half the length of a typical segment, so that a
/// segment lies in few cells and a cell holds few segments.
const CELL_PX: f64 = 16.0;

/// Which segments pass through which cell of one image.
pub(super) struct SegmentIndex {
    columns: usize,
    rows: usize,
    /// `starts[cell]..starts[cell + 1]` of `segments` are those of a cell.
    starts: Vec<u32>,
    segments: Vec<u32>,
}

impl SegmentIndex {
    /// Indexes segments of an image of the given size.
    pub(super) fn new(width: u32, height: u32, segments: impl Iterator<Item = Segment2>) -> Self {
        let columns = (f64::from(width) / CELL_PX) as usize + 1;
        let rows = (f64::from(height) / CELL_PX) as usize + 1;
        let mut entries: Vec<(u32, u32)> = Vec::new();
        for (id, segment) in segments.enumerate() {
            let steps = (segment.length() / (0.5 * CELL_PX)).ceil() as u32 + 1;
            for step in 0..=steps {
                let p = segment.at(f64::from(step) / f64::from(steps));
                let cell = cell_of(p.y, rows) * columns + cell_of(p.x, columns);
                entries.push((cell as u32, id as u32));
            }
        }
        entries.sort();
        entries.dedup();
        let mut starts = vec![0u32; columns * rows + 1];
        for (cell, _) in &entries {
            starts[*cell as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        Self {
            columns,
            rows,
            starts,
            segments: entries.into_iter().map(|(_, id)| id).collect(),
        }
    }

    /// Segments that may pass within `margin_px` of a quadrilateral (corners in order around it),
    /// by rising index. It may name a few more, never fewer.
    pub(super) fn near_quad(&self, quad: &[Point2<f64>; 4], margin_px: f64) -> Vec<u32> {
        // Half a cell's diagonal, plus what a sampled segment may cut off a cell's corner.
        let reach = margin_px + CELL_PX * 0.71 + CELL_PX * 0.25;
        let bound = |f: fn(f64, f64) -> f64, axis: usize| {
            quad.iter().map(|p| p[axis]).reduce(f).unwrap_or(0.0)
        };
        let (x0, x1) = (bound(f64::min, 0) - reach, bound(f64::max, 0) + reach);
        let (y0, y1) = (bound(f64::min, 1) - reach, bound(f64::max, 1) + reach);
        let mut found = Vec::new();
        if x1 < 0.0
            || y1 < 0.0
            || x0 > self.columns as f64 * CELL_PX
            || y0 > self.rows as f64 * CELL_PX
        {
            return found;
        }
        for row in cell_of(y0, self.rows)..=cell_of(y1, self.rows) {
            for column in cell_of(x0, self.columns)..=cell_of(x1, self.columns) {
                let centre = Point2::new(
                    (column as f64 + 0.5) * CELL_PX,
                    (row as f64 + 0.5) * CELL_PX,
                );
                let cell = row * self.columns + column;
                let (start, end) = (self.starts[cell], self.starts[cell + 1]);
                if start < end && is_near_quad(quad, &centre, reach) {
                    found.extend_from_slice(&self.segments[start as usize..end as usize]);
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Segments that may pass within `margin_px` of a segment.
    pub(super) fn near_segment(&self, s: &Segment2, margin_px: f64) -> Vec<u32> {
        self.near_quad(&[s.p0, s.p1, s.p1, s.p0], margin_px)
    }
}

/// The cell of a coordinate, clamped to the image.
fn cell_of(x: f64, cells: usize) -> usize {
    ((x / CELL_PX).max(0.0) as usize).min(cells - 1)
}

/// Is a point inside a quadrilateral, or this near to it?
fn is_near_quad(quad: &[Point2<f64>; 4], p: &Point2<f64>, reach: f64) -> bool {
    depth(sides(quad), p) >= -reach
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point2<f64>> {
        (0.0..200.0, 0.0..150.0).prop_map(|(x, y)| Point2::new(x, y))
    }

    proptest! {
        #[test]
        fn every_segment_that_touches_the_quad_is_found(
            ends in prop::collection::vec((point(), point()), 1..20),
            a in point(),
            b in point(),
        ) {
            let segments: Vec<_> = ends.iter().map(|(p, q)| Segment2::new(*p, *q)).collect();
            let index = SegmentIndex::new(200, 150, segments.iter().copied());
            let quad = [a, Point2::new(b.x, a.y), b, Point2::new(a.x, b.y)];
            let found = index.near_quad(&quad, 2.0);
            for (id, s) in segments.iter().enumerate() {
                let touches = (0..=200)
                    .any(|i| is_near_quad(&quad, &s.at(f64::from(i) / 200.0), 2.0));
                prop_assert!(!touches || found.contains(&(id as u32)));
            }
        }
    }

    #[test]
    fn a_beam_names_few_segments() {
        let segments = (0..50).map(|i| {
            let x = 20.0 * f64::from(i);
            Segment2::new(Point2::new(x, 0.0), Point2::new(x, 900.0))
        });
        let index = SegmentIndex::new(1000, 1000, segments);
        let s = Segment2::new(Point2::new(400.0, 100.0), Point2::new(400.0, 200.0));
        assert!(index.near_segment(&s, 2.0).len() <= 4);
    }
}
