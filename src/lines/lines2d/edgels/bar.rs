//! Bars: thin bright or dark lines, found where the second derivative is strong (B99 section 5).
//!
//! B99 5 asks for "a bar detector" besides the edge detector: a ridge cap, a gutter or a joint is
//! a line one or two pixels wide, on which an edge detector finds two edges that blur has pushed
//! apart, or nothing. After Steger 1998, "An unbiased detector of curvilinear structures": with g
//! the gradient and H the Hessian of the smoothed image, n the eigenvector of H whose eigenvalue
//! is largest in size, the line point is where the derivative along n vanishes, t = -(g . n) / (n'
//! H n) from the pixel's centre; it counts when it lies inside the pixel. Beside a step edge the
//! second derivative is strong too, but the first one does not vanish there: edges are no bars.
//!
//! A bar has no brighter side and its normal no sign, which linking needs. Therefore the edgels
//! come in two fans: normals within 60 degrees of the x axis, pointing to the right, and normals
//! within 60 degrees of the y axis, pointing down. A line belongs to the fan of its nearer axis
//! ([`Fan::contains`]); the overlap keeps lines near 45 degrees whole.

use nalgebra::{Point2, Vector2};

use super::canny::Edgel;
use super::noise::LocalStrengths;
use crate::photographs::raster::Gray;

/// Sine of the half-opening of a fan.
const FAN_SINE: f32 = 0.866_025_4;
/// Largest distance of the vanishing first derivative from the centre of the pixel, px (Steger:
/// 0.6, because noise may shift it out of all pixels).
const REACH_PX: f32 = 0.6;

/// Bars with normals near one of the axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fan {
    /// Normals to the right.
    Right,
    /// Normals downwards.
    Down,
}

impl Fan {
    /// Whether a line with this normal belongs here; every normal belongs to exactly one fan.
    pub(crate) fn contains(self, normal: &Vector2<f64>) -> bool {
        (normal.x.abs() >= normal.y.abs()) == (self == Self::Right)
    }

    /// The unit normal with the fan's sign; `None` outside its opening.
    fn directed(self, normal: Vector2<f32>) -> Option<Vector2<f32>> {
        let (along, across) = match self {
            Self::Right => (normal.x, normal.y),
            Self::Down => (normal.y, normal.x),
        };
        (across.abs() <= FAN_SINE).then(|| normal * along.signum())
    }
}

/// A point of a bar.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BarPoint {
    /// Position, px, inside the pixel that found it.
    position: Point2<f64>,
    /// Unit normal, of either sign.
    normal: Vector2<f32>,
    /// Second derivative across the bar, grey values per px^2: negative on a bright bar.
    second: f32,
    /// Local scale of the second derivative.
    noise: f32,
}

/// Second derivatives of a smoothed image.
pub(crate) struct Hessian {
    width: usize,
    height: usize,
    /// Size of the eigenvalue that is largest in size, grey values per px^2, row by row.
    pub strength: Vec<f32>,
}

impl Hessian {
    /// Differentiates a smoothed image twice; zero on the border pixels.
    pub(crate) fn new(smooth: &Gray) -> Self {
        let (w, h) = (smooth.width, smooth.height);
        let mut strength = vec![0.0; w * h];
        if w >= 3 {
            for y in 1..h.saturating_sub(1) {
                strength_row(
                    &smooth.data,
                    w,
                    y,
                    &mut strength[y * w + 1..(y + 1) * w - 1],
                );
            }
        }
        Self {
            width: w,
            height: h,
            strength,
        }
    }

    /// Statistics of the strength.
    pub(crate) fn statistics(&self) -> LocalStrengths {
        LocalStrengths::new(&self.strength, self.width, self.height)
    }
}

fn strength_row(smooth: &[f32], w: usize, y: usize, out: &mut [f32]) {
    let row = |y: usize| &smooth[y * w..(y + 1) * w];
    let (above, here, below) = (row(y - 1), row(y), row(y + 1));
    let n = out.len();
    let (a0, a1, a2) = (&above[..n], &above[1..=n], &above[2..n + 2]);
    let (h0, h1, h2) = (&here[..n], &here[1..=n], &here[2..n + 2]);
    let (b0, b1, b2) = (&below[..n], &below[1..=n], &below[2..n + 2]);
    for (i, out) in out.iter_mut().enumerate() {
        let xx = h0[i] - 2.0 * h1[i] + h2[i];
        let yy = a1[i] - 2.0 * h1[i] + b1[i];
        let xy = 0.25 * (a0[i] - a2[i] - b0[i] + b2[i]);
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        *out = mean.abs() + (half * half + xy * xy).sqrt();
    }
}

/// The points of bars stronger than `low` times the local noise, row by row; at most one a pixel.
pub(crate) fn bar_points(
    smooth: &Gray,
    hessian: &Hessian,
    local: &LocalStrengths,
    low: f64,
) -> Vec<BarPoint> {
    let (w, h) = (hessian.width, hessian.height);
    let low = low as f32;
    let mut points = Vec::new();
    let mut noise = vec![0.0; w];
    for y in 2..h.saturating_sub(2) {
        local.noise_row(y, &mut noise);
        let strength = &hessian.strength[y * w..(y + 1) * w];
        for x in 2..w.saturating_sub(2) {
            if strength[x] > low * noise[x] {
                points.extend(bar_point(smooth, x, y, noise[x]));
            }
        }
    }
    points
}

/// The point of a bar inside a pixel, if there is one.
fn bar_point(smooth: &Gray, x: usize, y: usize, noise: f32) -> Option<BarPoint> {
    let i = y * smooth.width + x;
    let (s, w) = (&smooth.data, smooth.width);
    let gradient = 0.5 * Vector2::new(s[i + 1] - s[i - 1], s[i + w] - s[i - w]);
    let xx = s[i - 1] - 2.0 * s[i] + s[i + 1];
    let yy = s[i - w] - 2.0 * s[i] + s[i + w];
    let xy = 0.25 * (s[i - w - 1] - s[i - w + 1] - s[i + w - 1] + s[i + w + 1]);
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let radius = (half * half + xy * xy).sqrt();
    let second = if mean < 0.0 {
        mean - radius
    } else {
        mean + radius
    };
    // (H - second I) n = 0, from the better conditioned row.
    let normal = if (half >= 0.0) == (mean >= 0.0) {
        Vector2::new(second - yy, xy)
    } else {
        Vector2::new(xy, second - xx)
    };
    let length = normal.norm();
    if length <= 0.0 || second == 0.0 {
        return None;
    }
    let normal = normal / length;
    let offset = normal * (-gradient.dot(&normal) / second);
    if offset.amax().is_nan() || offset.amax() > REACH_PX {
        return None;
    }
    // Just inside the pixel, so that its index follows from the position.
    let offset = offset.map(|v| f64::from(v).clamp(-0.499, 0.499));
    Some(BarPoint {
        position: Point2::new(x as f64 + 0.5, y as f64 + 0.5) + offset,
        normal,
        second,
        noise,
    })
}

/// The points of bright or dark bars in one fan as edgels: their gradient is the normal times the
/// size of the second derivative.
pub(crate) fn fan_edgels(points: &[BarPoint], bright: bool, fan: Fan) -> Vec<Edgel> {
    let of_kind = points.iter().filter(|p| (p.second < 0.0) == bright);
    of_kind
        .filter_map(|p| {
            let strength = p.second.abs();
            Some(Edgel {
                position: p.position,
                gradient: fan.directed(p.normal)? * strength,
                strength,
                noise: p.noise,
            })
        })
        .collect()
}
