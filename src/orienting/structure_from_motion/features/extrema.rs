//! Extrema of differences of Gaussians over place and scale, to a fraction of a pixel (Lowe 2004,
//! sections 3.1 and 4; Brown, Lowe 2002).

use nalgebra::{Matrix3, Vector3};

use super::scale_space::{Octave, SCALES, ScaleSpace, sigma_at};

/// Least difference of Gaussians, grey range 1: of 0.02 for an octave in one step (Lowe: 0.03 to
/// 0.04), a third for each of three scales.
const LEAST_RESPONSE: f32 = 0.02 / SCALES as f32;

/// Largest ratio of the principal curvatures (section 4.1).
const EDGE_RATIO: f64 = 10.0;

/// Pixels at the border of an octave that have no keypoint.
const BORDER: usize = 5;

/// Moves of the fit to a neighbouring pixel.
const MOVES: usize = 5;

/// An extremum.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extremum {
    /// Column and row in the working image, pixels (centre of the first one at (0.5, 0.5)).
    pub position: [f64; 2],
    /// Blur, pixels of the working image.
    pub scale: f64,
    /// Absolute difference of Gaussians there.
    pub response: f32,
    /// Number of its octave.
    pub octave: usize,
    /// Column, row and scale index within the octave.
    pub in_octave: [f64; 3],
}

/// All extrema of a scale space, by octave, scale, row and column.
pub(super) fn find(space: &ScaleSpace) -> Vec<Extremum> {
    let mut found = Vec::new();
    for (number, octave) in space.octaves.iter().enumerate() {
        let differences = differences(octave);
        let (w, h) = (octave.images[0].width, octave.images[0].height);
        for scale in 1..=SCALES {
            for y in BORDER..h.saturating_sub(BORDER) {
                for x in BORDER..w.saturating_sub(BORDER) {
                    let value = differences[scale][y * w + x];
                    // Nearly all pixels end here.
                    if value.abs() < 0.5 * LEAST_RESPONSE
                        || !is_extremum(&differences, w, x, y, scale)
                    {
                        continue;
                    }
                    let fitted = fit(&differences, [w, h], [x, y, scale]);
                    found.extend(
                        fitted.map(|(at, response)| in_image(octave, number, at, response)),
                    );
                }
            }
        }
    }
    found
}

fn in_image(octave: &Octave, number: usize, at: [f64; 3], response: f32) -> Extremum {
    let place = |p: f64| p * octave.pixel + octave.first_center;
    Extremum {
        position: [place(at[0]), place(at[1])],
        scale: sigma_at(at[2]) * octave.pixel,
        response,
        octave: number,
        in_octave: at,
    }
}

fn differences(octave: &Octave) -> Vec<Vec<f32>> {
    let pairs = octave.images.windows(2);
    pairs
        .map(|pair| {
            let values = pair[1].data.iter().zip(&pair[0].data);
            values.map(|(more, less)| more - less).collect()
        })
        .collect()
}

/// Is the value the largest or the least of the 27 around it?
fn is_extremum(differences: &[Vec<f32>], w: usize, x: usize, y: usize, scale: usize) -> bool {
    let value = differences[scale][y * w + x];
    let sign = if value > 0.0 { 1.0 } else { -1.0 };
    let value = value * sign;
    // Its own scale first: there the most fail.
    for layer in [scale, scale - 1, scale + 1] {
        for row in y - 1..=y + 1 {
            for &v in &differences[layer][row * w + x - 1..=row * w + x + 1] {
                if v * sign > value {
                    return false;
                }
            }
        }
    }
    true
}

/// Column, row and scale of the vertex of a quadratic through the 27 values, and the value there;
/// `None` on edges and where contrast is low.
fn fit(d: &[Vec<f32>], [w, h]: [usize; 2], start: [usize; 3]) -> Option<([f64; 3], f32)> {
    let [mut x, mut y, mut s] = start;
    for _ in 0..MOVES {
        let at = |dx: isize, dy: isize, ds: isize| {
            let i = (y as isize + dy) * w as isize + x as isize + dx;
            f64::from(d[(s as isize + ds) as usize][i as usize])
        };
        let center = at(0, 0, 0);
        let gradient = 0.5
            * Vector3::new(
                at(1, 0, 0) - at(-1, 0, 0),
                at(0, 1, 0) - at(0, -1, 0),
                at(0, 0, 1) - at(0, 0, -1),
            );
        let xx = at(1, 0, 0) + at(-1, 0, 0) - 2.0 * center;
        let yy = at(0, 1, 0) + at(0, -1, 0) - 2.0 * center;
        let ss = at(0, 0, 1) + at(0, 0, -1) - 2.0 * center;
        let xy = 0.25 * (at(1, 1, 0) + at(-1, -1, 0) - at(1, -1, 0) - at(-1, 1, 0));
        let xs = 0.25 * (at(1, 0, 1) + at(-1, 0, -1) - at(1, 0, -1) - at(-1, 0, 1));
        let ys = 0.25 * (at(0, 1, 1) + at(0, -1, -1) - at(0, 1, -1) - at(0, -1, 1));
        let hessian = Matrix3::new(xx, xy, xs, xy, yy, ys, xs, ys, ss);
        let offset = -(hessian.try_inverse()? * gradient);
        if offset.amax() <= 0.6 {
            let response = (center + 0.5 * gradient.dot(&offset)).abs() as f32;
            let (trace, determinant) = (xx + yy, xx * yy - xy * xy);
            let most = (EDGE_RATIO + 1.0) * (EDGE_RATIO + 1.0) / EDGE_RATIO;
            let is_corner = determinant > 0.0 && trace * trace < most * determinant;
            let place = [
                x as f64 + offset.x,
                y as f64 + offset.y,
                s as f64 + offset.z,
            ];
            return (is_corner && response >= LEAST_RESPONSE).then_some((place, response));
        }
        let moved = |p: usize, by: f64, low: usize, high: usize| {
            let step = by.clamp(-1.0, 1.0).round() as isize;
            let p = p as isize + step;
            (p >= low as isize && p < high as isize).then_some(p as usize)
        };
        x = moved(x, offset.x, BORDER, w - BORDER)?;
        y = moved(y, offset.y, BORDER, h - BORDER)?;
        s = moved(s, offset.z, 1, SCALES + 1)?;
    }
    None
}
