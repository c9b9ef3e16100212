//! Filling on small rasters: polygons into masks, gaps with smooth colours.

use crate::base::geometry::{Polygon, crossing};
use glam::Vec3;

/// Sets the pixels of a mask (`width * height`) whose centres lie inside a polygon. Positions are
/// in pixels, y down, pixel (0, 0) has its centre at (0.5, 0.5).
pub(crate) fn mark_inside(polygon: &Polygon, width: usize, height: usize, mask: &mut [bool]) {
    let [low, high] = polygon.bounds();
    let first = (low.y - 0.5).ceil().max(0.0) as usize;
    let end = ((high.y + 0.5).max(0.0) as usize).min(height);
    let mut crossings = Vec::new();
    for row in first..end {
        let y = row as f64 + 0.5;
        crossings.clear();
        crossings.extend(polygon.sides().filter_map(|side| crossing(side, y)));
        crossings.sort_by(f64::total_cmp);
        for span in crossings.chunks_exact(2) {
            let from = (span[0] - 0.5).ceil().max(0.0) as usize;
            let to = ((span[1] - 0.5).ceil().max(0.0) as usize).min(width);
            if from < to {
                mask[row * width + from..row * width + to].fill(true);
            }
        }
    }
}

/// Fills the pixels that are not `known` with smooth colours from the known ones around them
/// (push-pull pyramid, Gortler et al. 1996). Without any known pixel nothing changes.
pub(crate) fn fill_gaps(colours: &mut [Vec3], known: &[bool], width: usize, height: usize) {
    if known.iter().all(|&k| k) || !known.contains(&true) {
        return;
    }
    let (w, h) = (width.div_ceil(2), height.div_ceil(2));
    let mut half = vec![Vec3::ZERO; w * h];
    let mut half_known = vec![false; w * h];
    for y in 0..h {
        for x in 0..w {
            let mut sum = Vec3::ZERO;
            let mut count = 0u8;
            for j in 2 * y..(2 * y + 2).min(height) {
                for i in (2 * x..(2 * x + 2).min(width)).filter(|i| known[j * width + i]) {
                    sum += colours[j * width + i];
                    count += 1;
                }
            }
            if count > 0 {
                half[y * w + x] = sum / f32::from(count);
                half_known[y * w + x] = true;
            }
        }
    }
    fill_gaps(&mut half, &half_known, w, h);
    for y in 0..height {
        for x in (0..width).filter(|x| !known[y * width + x]) {
            colours[y * width + x] = doubled(&half, w, h, x, y);
        }
    }
}

/// The colour of a pixel in a raster of half the size, bilinear.
fn doubled(half: &[Vec3], w: usize, h: usize, x: usize, y: usize) -> Vec3 {
    // The centre of pixel x lies a quarter before or behind the centre of pixel x / 2.
    let near = |i: usize, n: usize| {
        let other = if i.is_multiple_of(2) {
            (i / 2).saturating_sub(1)
        } else {
            (i / 2 + 1).min(n - 1)
        };
        (i / 2, other)
    };
    let ((x0, x1), (y0, y1)) = (near(x, w), near(y, h));
    let row = |y: usize| 0.75 * half[y * w + x0] + 0.25 * half[y * w + x1];
    0.75 * row(y0) + 0.25 * row(y1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn pixels_are_inside_by_their_centres() {
        let ring = vec![
            Point2::new(1.4, 0.6),
            Point2::new(4.6, 0.6),
            Point2::new(4.6, 3.6),
            Point2::new(1.4, 3.6),
        ];
        let hole = vec![
            Point2::new(2.1, 2.1),
            Point2::new(2.9, 2.1),
            Point2::new(2.5, 2.9),
        ];
        let mut mask = vec![false; 6 * 4];
        let rings = vec![ring, hole];
        mark_inside(&Polygon { rings }, 6, 4, &mut mask);
        let rows: Vec<String> = mask
            .chunks(6)
            .map(|row| row.iter().map(|&m| if m { '#' } else { '.' }).collect())
            .collect();
        assert_eq!(rows, ["......", ".####.", ".#.##.", ".####."]);
    }

    #[test]
    fn gaps_take_the_colours_around_them() {
        let (w, h) = (13, 7);
        let mut colours = vec![Vec3::ZERO; w * h];
        let mut known = vec![false; w * h];
        for y in 0..h {
            for x in [0, 1, 11, 12] {
                known[y * w + x] = true;
                colours[y * w + x] = Vec3::new(if x < 6 { 10.0 } else { 90.0 }, 50.0, 0.0);
            }
        }
        fill_gaps(&mut colours, &known, w, h);
        assert!(
            colours
                .iter()
                .all(|c| (10.0..=90.0).contains(&c.x) && c.y == 50.0)
        );
        assert!(colours[3 * w + 3].x < 40.0 && colours[3 * w + 9].x > 60.0);
    }
}
