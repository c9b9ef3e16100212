//! Lines moved to where the unsmoothed image has its edge.
//!
//! Smoothing reduces noise, but blends two edges closer than about 2 px into one between them: an
//! eave with its fascia below and its gutter in front is full of such pairs. Once the line is
//! known no smoothing is needed, because the pixels along it can be averaged instead (the
//! slanted-edge method of ISO 12233). Stretch by stretch, rows of pixels across the line are
//! shifted to the line and averaged; the edgels of the stretch then move together to the steepest
//! place of the mean profile in linear light ([`Channel::to_linear_light`]).

use nalgebra::{Matrix2, Point2, Vector2};

use super::edgels::Edgel;
use super::grow::GrownLine;
use super::regression::RegressionLine;
use crate::photographs::raster::{Channel, Gray};

/// Edgels in a stretch: as many as smoothing to 1/4 of the noise of a pixel takes.
const STRETCH: usize = 16;
/// Samples on either side of the line, px along the image axis across it.
const REACH: usize = 4;
/// Samples of a profile.
const SAMPLES: usize = 2 * REACH + 1;

/// Standard deviation of a pixel over that of a gradient component after smoothing by 0.8 px, for
/// white noise.
const PIXEL_NOISE: f64 = 4.5;

/// Moves the edgels of a line found on a step and fits the line again. A stretch moves only by
/// more than `sigmas` standard deviations of its steepest place, because unblended edgels are less
/// noisy after smoothing. Returns the covariance of (offset in px, angle in rad) that the noise
/// adds at the middle of the line.
pub(super) fn refine(
    line: &mut GrownLine,
    all: &[Edgel],
    image: &Gray,
    channel: Channel,
    sigmas: f64,
) -> Matrix2<f64> {
    let axes = ProfileAxes::of(&line.line);
    let normal = line.line.normal();
    let scale = axes.across(&normal).abs();
    let count = line.points.len();
    let stretches = (count / STRETCH).max(1);
    let mut variance = 0.0;
    for s in 0..stretches {
        let range = s * count / stretches..(s + 1) * count / stretches;
        let (points, edgels) = (&line.points[range.clone()], &line.edgels[range.clone()]);
        let Some(mut profile) = axes.mean_profile(points, image) else {
            continue;
        };
        channel.to_linear_light(&mut profile);
        let Some(crest) = Crest::of(&profile) else {
            continue;
        };
        let n = points.len() as f64;
        let noise = edgels.iter().map(|&i| all[i as usize].noise).sum::<f32>();
        let sigma = scale * PIXEL_NOISE * f64::from(noise) / n / (n.sqrt() * crest.sharpness);
        let now = points.iter().map(|p| line.line.across(p)).sum::<f64>() / n;
        let shift = crest.position * scale - now;
        if shift.abs() > sigmas * sigma {
            variance += sigma * sigma / stretches as f64;
            line.points[range]
                .iter_mut()
                .for_each(|p| *p += normal * shift);
        }
    }
    line.line = RegressionLine::new(&line.points);
    let m = stretches as f64;
    // m stretches of equal length L/m: the sum of their squared distances from the middle is L^2
    // (m^2 - 1) / 12 m.
    let lever = line.extent().length() * ((m * m - 1.0) / (12.0 * m)).sqrt();
    let angle = if stretches > 1 {
        variance / (lever * lever)
    } else {
        0.0
    };
    Matrix2::new(variance / m, 0.0, 0.0, angle)
}

/// The image axis that is more across a line, and the line as a function of the other one.
struct ProfileAxes {
    /// Whether rows are across the line (columns otherwise).
    rows: bool,
    /// Change of the position across per pixel along.
    slope: f64,
    /// Position across at zero along.
    start: f64,
    /// 1 where the brighter side is at larger coordinates, -1 where it is not.
    sense: f64,
}

impl ProfileAxes {
    fn of(line: &RegressionLine) -> Self {
        let normal = line.normal();
        let mut axes = Self {
            rows: normal.x.abs() >= normal.y.abs(),
            slope: 0.0,
            start: 0.0,
            sense: 1.0,
        };
        axes.sense = axes.across(&normal).signum();
        axes.slope = axes.across(&line.direction) / axes.along(&line.direction);
        let centroid = &line.centroid.coords;
        axes.start = axes.across(centroid) - axes.slope * axes.along(centroid);
        axes
    }

    fn across(&self, v: &Vector2<f64>) -> f64 {
        if self.rows { v.x } else { v.y }
    }

    fn along(&self, v: &Vector2<f64>) -> f64 {
        if self.rows { v.y } else { v.x }
    }

    /// Mean grey values across the line, from the dark to the bright side; `None` too near the
    /// border.
    fn mean_profile(&self, points: &[Point2<f64>], gray: &Gray) -> Option<[f64; SAMPLES]> {
        let (step, stride, length) = if self.rows {
            (1, gray.width, gray.width)
        } else {
            (gray.width, 1, gray.height)
        };
        let mut sum = [0.0f32; SAMPLES];
        let mut count = 0.0;
        for p in points {
            let along = self.along(&p.coords).floor();
            let at = self.start + self.slope * (along + 0.5) - 0.5;
            let first = at.floor() as isize - REACH as isize - 1;
            if first < 0 || first as usize + SAMPLES + 3 > length {
                continue;
            }
            let base = along as usize * stride + first as usize * step;
            let weights = catmull_rom((at - at.floor()) as f32);
            for (k, s) in sum.iter_mut().enumerate() {
                let i = base + k * step;
                for (tap, w) in weights.iter().enumerate() {
                    *s += w * gray.data[i + tap * step];
                }
            }
            count += 1.0;
        }
        if self.sense < 0.0 {
            sum.reverse();
        }
        (count > 0.0).then(|| sum.map(|s| f64::from(s) / count))
    }
}

/// Weights of the four samples around a position, a fraction `f` after the second.
fn catmull_rom(f: f32) -> [f32; 4] {
    let (f2, f3) = (f * f, f * f * f);
    [
        0.5 * (2.0 * f2 - f - f3),
        0.5 * (3.0 * f3 - 5.0 * f2) + 1.0,
        0.5 * (4.0 * f2 + f - 3.0 * f3),
        0.5 * (f3 - f2),
    ]
}

/// Where a profile rises most.
struct Crest {
    /// Position, samples from the middle.
    position: f64,
    /// Second difference of the rises there, negated, grey values: noise of a standard deviation s
    /// in the profile moves the crest by s over this.
    sharpness: f64,
}

impl Crest {
    /// The steepest rise within 1.5 samples of the middle, if it is a crest.
    fn of(profile: &[f64; SAMPLES]) -> Option<Self> {
        // Rise j lies at j - REACH + 0.5 samples from the middle.
        let rise = |j: usize| profile[j + 1] - profile[j];
        let mut best = REACH - 2;
        for j in REACH - 2..REACH + 2 {
            if rise(j) > rise(best) {
                best = j;
            }
        }
        let (before, top, after) = (rise(best - 1), rise(best), rise(best + 1));
        if top <= before || top < after || top <= 0.0 {
            return None;
        }
        let sharpness = 2.0 * top - before - after;
        // A blurred step has a Gaussian derivative: its logarithm is a parabola.
        let t = if before > 0.0 && after > 0.0 {
            let ln = crate::base::math::ln;
            0.5 * (ln(after) - ln(before)) / (2.0 * ln(top) - ln(before) - ln(after))
        } else {
            0.5 * (after - before) / sharpness
        };
        Some(Self {
            position: best as f64 + 0.5 - REACH as f64 + t,
            sharpness,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{distance_to_edge, edgel, lit_edge, step_edge};
    use super::*;

    /// A line of edgels beside the planted edge, at this distance towards the brighter side, px.
    fn beside(gray: &Gray, angle: f64, off: f64) -> (Vec<Edgel>, GrownLine) {
        let (s, c) = crate::base::math::sin_cos(angle);
        let centre = Point2::new(
            gray.width as f64 / 2.0 + 0.2,
            gray.height as f64 / 2.0 - 0.3,
        );
        let at = |t: f64| centre + Vector2::new(c, s) * off + Vector2::new(s, -c) * t;
        let all: Vec<Edgel> = (-25..25)
            .map(|t| at(f64::from(t)))
            .map(|p| edgel(p.x, p.y, (c as f32, s as f32)))
            .map(|e| Edgel { noise: 0.001, ..e })
            .collect();
        let grown = GrownLine::new(&all, (0..50).collect());
        (all, grown)
    }

    #[test]
    fn a_line_beside_an_edge_moves_onto_it() {
        for step in 0..24 {
            let angle = f64::from(step) * 15f64.to_radians() + 0.03;
            let gray = step_edge(80, 80, angle, 0.3);
            for off in [-0.6, 0.0, 0.4] {
                let (all, mut line) = beside(&gray, angle, off);
                refine(&mut line, &all, &gray, Channel::RedBlue, 3.0);
                let miss = distance_to_edge(&gray, angle, &line.line.centroid);
                assert!(miss.abs() < 0.03, "{miss} px from {off} at {angle}");
            }
        }
    }

    #[test]
    fn an_edge_is_where_its_light_is() {
        for step in 0..12 {
            let angle = f64::from(step) * 30f64.to_radians() + 0.03;
            let gray = lit_edge(80, 80, angle, 0.5);
            let miss = |channel| {
                let (all, mut line) = beside(&gray, angle, 0.0);
                refine(&mut line, &all, &gray, channel, 0.0);
                distance_to_edge(&gray, angle, &line.line.centroid)
            };
            let (light, value) = (miss(Channel::Grey), miss(Channel::RedBlue));
            assert!(light.abs() < 0.05, "{light} px at {angle}");
            assert!(value < -0.15, "{value} px at {angle}: on the dark side");
        }
    }

    #[test]
    fn a_line_without_a_step_stays() {
        let gray = Gray::from_fn(80, 80, |_, _| 0.5);
        let (all, mut line) = beside(&gray, 0.3, 0.4);
        let before = line.line;
        refine(&mut line, &all, &gray, Channel::RedBlue, 3.0);
        assert_eq!(line.line, before);
    }
}
