//! From an image to its straight segments: the stage (B99 3.2, "Implementation details").
//!
//! Deviations: lines grow past the ends of their chains ([`super::grow`]), and a test of
//! significance ([`super::significance`]) replaces a global threshold of contrast.
//!
//! B99 has grey photographs. Where there is colour, the same detector also runs on the red-blue
//! difference ([`crate::photographs::raster::RedBlueDifference`]), and its segments count where no
//! edge in grey values runs along them: on six views of a rendered suburb the segments then cover
//! 81 % of the true roof edges instead of 62 %. Each kind is matched with its own, in its own
//! channel, because lines of both together lay up to 0.2 m off on photographs with chromatic
//! aberration.
//!
//! The accuracy of a segment is limited by the roof, not by the image: along true edges of two
//! rendered scenes, the steepest place of the mean profile itself scatters by 0.2 to 0.3 px on
//! eaves and rakes, whose visible fascias and gutters are 0.5 to 2 px wide, and by 0.08 to 0.15 px
//! on hips, which have none. The covariance has a term for it. About a quarter of that scatter
//! came from stored grey values; profiles are now taken in linear light
//! ([`crate::photographs::raster::Channel::to_linear_light`]).
//!
//! Rejected: evidence from the directions of the edgels besides their strength (the same coverage
//! of true roof edges at the same number of segments), and chains without growing (on two rendered
//! views of a suburb with about 880 segments each, 48 % of the true roof edges covered instead of
//! 59 %).

use nalgebra::{Matrix2, Point2};

use super::edgels::{Gradient, suppress};
use super::grow::GrownLine;
use super::overlap::add_without_overlap;
use super::refine::refine;
use super::segment::{ImageSegment, SegmentKind};
use super::significant_lines::significant_lines;
use super::trace::SegmentTrace;
use crate::base::geometry::Segment2;
use crate::base::params::SegmentParams;
use crate::photographs::raster::{Gray, RedBlueDifference, gaussian_blur};

/// The straight segments of an image, directed by contrast: edges in grey values first, then in
/// colour. `gray` and `red_blue` are of one size; a photograph without colour has no `red_blue`.
pub fn detect_segments(
    gray: &Gray,
    red_blue: Option<&RedBlueDifference>,
    params: &SegmentParams,
) -> (Vec<ImageSegment>, SegmentTrace) {
    let smooth = gaussian_blur(gray, params.edgels.smoothing_px);
    let mut trace = SegmentTrace::default();
    let mut segments = edge_segments(gray, &smooth, SegmentKind::Edge, params, &mut trace);
    if params.colors.detect
        && let Some(red_blue) = red_blue
    {
        let found = color_segments(red_blue, params, &mut trace);
        add_without_overlap(&mut segments, found, params.colors.clear_px, &mut trace);
    }
    (segments, trace)
}

/// Segments on steps of colour, detected at the resolution in which colour is stored.
fn color_segments(
    red_blue: &RedBlueDifference,
    params: &SegmentParams,
    trace: &mut SegmentTrace,
) -> Vec<ImageSegment> {
    let image = red_blue.at_full_color();
    let smooth = gaussian_blur(&image, params.edgels.smoothing_px);
    let mut own = SegmentTrace::default();
    let found = edge_segments(&image, &smooth, SegmentKind::Color, params, &mut own);
    trace.add(own, red_blue.subsampling);
    let enlarged = found.into_iter().map(|s| s.enlarged(red_blue.subsampling));
    enlarged.collect()
}

/// Segments on steps of `image`, which is `smooth` before smoothing.
fn edge_segments(
    image: &Gray,
    smooth: &Gray,
    kind: SegmentKind,
    params: &SegmentParams,
    trace: &mut SegmentTrace,
) -> Vec<ImageSegment> {
    let gradient = Gradient::new(smooth);
    let local = gradient.statistics();
    let noise_row = |y: usize, row: &mut [f32]| local.noise_row(y, row);
    let edgels = suppress(&gradient, &noise_row, params.edgels.low);
    significant_lines(&edgels, &local, params, trace)
        .into_iter()
        .map(|mut line| {
            let noise = refine(
                &mut line,
                &edgels,
                image,
                kind.channel(),
                params.refine_sigmas,
            );
            let mut segment = finish(&line, kind, image, params);
            segment.covariance += noise;
            segment
        })
        .collect()
}

fn finish(
    grown: &GrownLine,
    kind: SegmentKind,
    gray: &Gray,
    params: &SegmentParams,
) -> ImageSegment {
    let line = &grown.line;
    let segment = grown.extent();
    ImageSegment {
        kind,
        contrast: contrast(gray, &segment, params.contrast_distance_px).max(0.0),
        edgels: u32::try_from(line.count).expect("fewer than 2^32 edgels"),
        covariance: covariance(grown, &segment, params),
        segment,
    }
}

/// Covariance of (offset, angle) at the midpoint of the segment: that of the fit, and at either
/// end an independent distance between the edge in the image and that of the roof.
fn covariance(grown: &GrownLine, segment: &Segment2, params: &SegmentParams) -> Matrix2<f64> {
    let line = &grown.line;
    let correlated = line.correlated_edgels(&grown.points, params.edgels.smoothing_px);
    let along = line.along(&segment.midpoint());
    let mut covariance = line.covariance(along, correlated, params.edgel_floor_px);
    let end = params.edge_floor_px * params.edge_floor_px;
    let length = segment.length();
    covariance[(0, 0)] += 0.5 * end;
    covariance[(1, 1)] += 2.0 * end / (length * length);
    covariance
}

/// Mean grey-value difference between the two sides, `distance_px` off the segment.
fn contrast(gray: &Gray, segment: &Segment2, distance_px: f64) -> f32 {
    let steps = segment.length().ceil().max(1.0) as usize;
    let normal = segment.normal() * distance_px;
    let at = |p: Point2<f64>| gray.sample(p.x as f32, p.y as f32);
    let (mut sum, mut count) = (0.0, 0.0);
    for i in 0..steps {
        let p = segment.at((i as f64 + 0.5) / steps as f64);
        if let (Some(bright), Some(dark)) = (at(p + normal), at(p - normal)) {
            sum += bright - dark;
            count += 1.0;
        }
    }
    if count > 0.0 { sum / count } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{add_noise, distance_to_edge, lit_edge, step_edge};
    use super::*;
    use crate::base::params::EdgelParams;

    /// The segments of a photograph without colour.
    fn detect_in_grey(gray: &Gray, params: &SegmentParams) -> (Vec<ImageSegment>, SegmentTrace) {
        detect_segments(gray, None, params)
    }

    /// Thresholds above what noise alone reaches anywhere in a small image.
    fn strict() -> SegmentParams {
        SegmentParams {
            edgels: EdgelParams {
                low: 1.8,
                high: 2.5,
                ..EdgelParams::default()
            },
            ..SegmentParams::default()
        }
    }

    /// A planted edge between two colours of one grey value, the difference one on the side where
    /// a step edge is bright.
    #[test]
    fn an_edge_between_colours_of_one_grey_is_found() {
        for step in 0..12 {
            let angle = f64::from(step) * 30f64.to_radians() + 0.02;
            let mut difference = step_edge(64, 64, angle, 0.2);
            let mut gray = Gray::from_fn(64, 64, |_, _| 0.5);
            add_noise(&mut difference, 2.0 / 255.0, step as u64);
            add_noise(&mut gray, 2.0 / 255.0, 100 + step as u64);
            let difference = RedBlueDifference::new(difference);
            let (segments, _) = detect_segments(&gray, Some(&difference), &strict());
            assert_eq!(segments.len(), 1, "at {angle}");
            let found = &segments[0];
            assert_eq!(found.kind, SegmentKind::Color);
            assert!((found.contrast - 0.2).abs() < 0.02, "{}", found.contrast);
            assert!(found.segment.length() > 50.0);
            let miss = distance_to_edge(&gray, angle, &found.segment.midpoint());
            assert!(miss.abs() < 0.1, "{miss} px at {angle}");
            let turn = turn(found, angle).to_degrees();
            assert!(turn.abs() < 0.3, "{turn} degrees at {angle}");
            // Where grey values show it too, only the edge in grey values remains.
            let params = SegmentParams::default();
            let (both, trace) = detect_segments(&difference.image, Some(&difference), &params);
            assert!(both.iter().all(|s| s.kind == SegmentKind::Edge));
            assert!(trace.beside_edge > 0);
        }
    }

    /// The image with one value stored for four pixels, interpolated as decoders do it.
    fn subsampled(image: &Gray) -> Gray {
        let kept = image.reduced(2);
        Gray::from_fn(image.width, image.height, |x, y| {
            let near = |i: usize, size: usize| {
                let other = if i.is_multiple_of(2) {
                    (i / 2).saturating_sub(1)
                } else {
                    i / 2 + 1
                };
                [(i / 2, 0.75), (other.min(size - 1), 0.25)]
            };
            let columns = near(x, kept.width);
            let rows = near(y, kept.height).into_iter();
            rows.flat_map(|(r, v)| columns.map(|(c, w)| v * w * kept.get(c, r)))
                .sum()
        })
    }

    #[test]
    fn an_edge_between_colours_kept_for_four_pixels_is_found_where_it_is() {
        for step in 0..12 {
            let angle = f64::from(step) * 30f64.to_radians() + 0.02;
            let mut difference = step_edge(128, 128, angle, 0.2);
            let gray = Gray::from_fn(128, 128, |_, _| 0.5);
            add_noise(&mut difference, 2.0 / 255.0, step as u64);
            let own = RedBlueDifference::new(difference.clone());
            let shared = RedBlueDifference::new(subsampled(&difference));
            assert_eq!((own.subsampling, shared.subsampling), (1, 2), "at {angle}");
            let ratio = shared.noise / own.noise;
            // Interpolating smooths the noise, too: to (1 6 1) / 8 of it in either direction, of
            // which the filter sees 0.35.
            assert!((0.3..0.4).contains(&ratio), "{ratio}");
            let (segments, trace) =
                detect_segments(&gray, Some(&shared), &SegmentParams::default());
            assert_eq!(segments.len(), 1, "at {angle}");
            let found = &segments[0];
            assert!((found.contrast - 0.2).abs() < 0.02, "{}", found.contrast);
            assert!(found.segment.length() > 110.0, "of 128 pixels");
            let miss = distance_to_edge(&gray, angle, &found.segment.midpoint());
            assert!(miss.abs() < 0.2, "{miss} px at {angle}");
            assert!(turn(found, angle).to_degrees().abs() < 0.3);
            assert!(trace.edgels > 0);
        }
    }

    #[test]
    fn tiny_photographs_whose_colour_was_interpolated_have_no_segments() {
        for (width, height) in [(9, 1), (1, 9), (9, 2), (9, 3), (4, 4)] {
            let ramp = |x: usize, y: usize| 0.1 * (x + y) as f32;
            let difference = RedBlueDifference::new(Gray::from_fn(width, height, ramp));
            assert_eq!(difference.subsampling, 2, "{width} x {height}");
            let gray = Gray::from_fn(width, height, |_, _| 0.5);
            let (segments, _) =
                detect_segments(&gray, Some(&difference), &SegmentParams::default());
            assert!(segments.is_empty());
        }
    }

    /// Noise of single pixels looks like lines once it has been interpolated.
    #[test]
    fn noise_between_pixels_that_share_their_colour_is_no_edge() {
        let gray = Gray::from_fn(400, 400, |_, _| 0.5);
        let mut difference = step_edge(400, 400, 0.3, 0.3);
        add_noise(&mut difference, 8.0 / 255.0, 3);
        let shared = RedBlueDifference::new(subsampled(&difference));
        let found = |red_blue: &RedBlueDifference| {
            let (segments, _) = detect_segments(&gray, Some(red_blue), &strict());
            segments.len()
        };
        assert_eq!(found(&shared), 1);
        let not_reduced = RedBlueDifference {
            subsampling: 1,
            ..shared
        };
        assert!(found(&not_reduced) > 1, "or nothing was planted");
    }

    /// The segment on the planted edge; there must be exactly one.
    fn planted(gray: &Gray, angle: f64, params: &SegmentParams) -> ImageSegment {
        let (segments, _) = detect_in_grey(gray, params);
        let on_edge = |s: &&ImageSegment| {
            let end = |p| distance_to_edge(gray, angle, p).abs() < 1.5;
            end(&s.segment.p0) && end(&s.segment.p1)
        };
        let found: Vec<_> = segments.iter().filter(on_edge).collect();
        assert_eq!(found.len(), 1, "at {angle}");
        found[0].clone()
    }

    /// Angle of the segment's normal against that of the planted edge, rad.
    fn turn(found: &ImageSegment, angle: f64) -> f64 {
        let n = found.segment.normal();
        let (s, c) = crate::base::math::sin_cos(angle);
        crate::base::math::atan2(n.y * c - n.x * s, n.x * c + n.y * s)
    }

    #[test]
    fn a_planted_edge_is_found_within_a_tenth_of_a_pixel_and_of_a_degree() {
        let (mut offsets, mut turns, mut count) = (0.0, 0.0, 0.0);
        for step in 0..72 {
            let angle = f64::from(step) * 5f64.to_radians() + 0.02;
            let mut gray = lit_edge(64, 64, angle, 0.3);
            add_noise(&mut gray, 2.0 / 255.0, step as u64);
            let found = planted(&gray, angle, &SegmentParams::default());
            assert!(found.segment.length() > 50.0);
            assert!((found.contrast - 0.3).abs() < 0.02, "{}", found.contrast);
            let offset = distance_to_edge(&gray, angle, &found.segment.midpoint());
            // Within pi/2 only when the brighter side is on the side of the normal.
            let turn = turn(&found, angle);
            assert!(turn.to_degrees().abs() < 0.3, "turn {turn} at {angle}");
            offsets += offset * offset;
            turns += turn * turn;
            count += 1.0;
        }
        let (offset, turn) = ((offsets / count).sqrt(), (turns / count).sqrt());
        assert!(offset <= 0.05, "offset {offset} px rms");
        assert!(
            turn.to_degrees() <= 0.1,
            "turn {} degrees rms",
            turn.to_degrees()
        );
    }

    #[test]
    fn the_covariance_is_that_of_the_errors() {
        let params = SegmentParams {
            edge_floor_px: 0.0,
            ..SegmentParams::default()
        };
        let (mut offsets, mut turns, mut count) = (0.0, 0.0, 0.0);
        for seed in 0..200u32 {
            let angle = f64::from(seed) * 0.1;
            let mut gray = lit_edge(48, 48, angle, 0.15);
            add_noise(&mut gray, 6.0 / 255.0, u64::from(seed));
            let found = planted(&gray, angle, &params);
            let offset = distance_to_edge(&gray, angle, &found.segment.midpoint());
            let turn = turn(&found, angle);
            offsets += offset * offset / found.covariance[(0, 0)];
            turns += turn * turn / found.covariance[(1, 1)];
            count += 1.0;
        }
        for normalised in [(offsets / count).sqrt(), (turns / count).sqrt()] {
            assert!((0.7..1.4).contains(&normalised), "{normalised} sigma rms");
        }
    }

    /// The share of a planted edge that segments of its direction lie on, with the shipped
    /// parameters, in the mean of some images: `contrast` in standard deviations of a pixel's
    /// noise.
    fn share_found(contrast: f64) -> f64 {
        const SIZE: usize = 160;
        let share = |seed: u32| {
            let angle = 0.4 + 0.5 * f64::from(seed);
            let mut gray = step_edge(SIZE, SIZE, angle, 0.02 * contrast);
            add_noise(&mut gray, 0.02, u64::from(seed));
            let (segments, _) = detect_in_grey(&gray, &SegmentParams::default());
            let on_edge = |s: &&ImageSegment| {
                distance_to_edge(&gray, angle, &s.segment.midpoint()).abs() < 1.0
                    && turn(s, angle).abs() < 0.1
            };
            let found: Vec<&ImageSegment> = segments.iter().filter(on_edge).collect();
            let (s, c) = crate::base::math::sin_cos(angle);
            let along = |p: &Point2<f64>| c * p.y - s * p.x;
            let middle = along(&Point2::new(SIZE as f64 / 2.0, SIZE as f64 / 2.0));
            let covered = |t: &i32| {
                let t = middle + f64::from(*t);
                let holds = |s: &&&ImageSegment| {
                    let [a, b] = [&s.segment.p0, &s.segment.p1].map(along);
                    t >= a.min(b) && t <= a.max(b)
                };
                found.iter().any(|s| holds(&s))
            };
            (-70..=70).filter(covered).count() as f64 / 141.0
        };
        (1..=12).map(share).sum::<f64>() / 12.0
    }

    #[test]
    fn an_edge_weaker_than_it_takes_to_see_a_pixel_of_it_is_found() {
        let shares = [0.5, 1.5, 2.0, 3.0].map(share_found);
        let [nothing, weak, twice, clear] = shares;
        assert!(
            nothing < 0.1,
            "{shares:?}: found where there is next to nothing"
        );
        assert!(weak > 0.4 && twice > 0.7 && clear > 0.9, "{shares:?}");
    }

    #[test]
    fn noise_has_few_segments_and_none_that_are_long() {
        let mut gray = Gray::from_fn(400, 400, |_, _| 0.5);
        add_noise(&mut gray, 0.05, 11);
        let (segments, trace) = detect_in_grey(&gray, &SegmentParams::default());
        assert!(trace.edgels > 5000);
        assert!(segments.len() <= 150, "{}", segments.len());
        assert!(segments.iter().all(|s| s.segment.length() < 100.0));
    }

    #[test]
    fn a_disc_is_not_cut_into_chords() {
        for radius in [20.0, 40.0, 60.0, 90.0, 120.0, 200.0] {
            for seed in 0..4 {
                let mut gray = Gray::from_fn(420, 420, |x, y| {
                    let d = crate::base::math::hypot(x as f64 - 210.0, y as f64 - 210.0) - radius;
                    (0.4 + 0.3 * (0.5 - 0.5 * libm::erf(d))) as f32
                });
                if seed > 0 {
                    add_noise(&mut gray, 2.0 / 255.0, seed);
                }
                let (segments, trace) = detect_in_grey(&gray, &SegmentParams::default());
                assert!(trace.chains > 0);
                let on_circle = |s: &&ImageSegment| {
                    let m = s.segment.midpoint();
                    (crate::base::math::hypot(m.x - 210.5, m.y - 210.5) - radius).abs() < 3.0
                };
                let chords = segments.iter().filter(on_circle).count();
                assert_eq!(chords, 0, "of radius {radius} in noise {seed}");
            }
        }
    }

    #[test]
    fn a_line_that_texture_interrupts_is_one_segment() {
        // Bright crumbs on the edge, every 16 px, end the chains.
        let mut gray = step_edge(120, 120, std::f64::consts::FRAC_PI_2, 0.2);
        for x in (10..120).step_by(16) {
            for y in 58..62 {
                for x in x..x + 2 {
                    gray.data[y * 120 + x] = 0.9;
                }
            }
        }
        let params = SegmentParams {
            grow_gap_px: 12,
            ..SegmentParams::default()
        };
        let longest = |params: &SegmentParams| {
            let (segments, _) = detect_in_grey(&gray, params);
            let lengths = segments.iter().map(|s| s.segment.length());
            lengths.fold(0.0, f64::max)
        };
        assert!(longest(&params) > 90.0, "{}", longest(&params));
        let without = SegmentParams {
            grow_gap_px: 0,
            ..params
        };
        assert!(longest(&without) < 30.0, "{}", longest(&without));
    }

    #[test]
    fn a_square_has_four_sides_that_run_around_it() {
        let gray = Gray::from_fn(80, 80, |x, y| {
            let inside = |v: usize| (20..60).contains(&v);
            if inside(x) && inside(y) { 0.7 } else { 0.3 }
        });
        let (segments, trace) = detect_in_grey(&gray, &SegmentParams::default());
        assert_eq!(segments.len(), 4);
        for s in &segments {
            let inwards = Point2::new(40.0, 40.0) - s.segment.midpoint();
            assert!(s.segment.normal().dot(&inwards) > 19.0, "{s:?}");
            assert!((s.segment.length() - 40.0).abs() < 5.0);
        }
        assert!(trace.worm_breaks.len() >= 3);
    }

    #[test]
    fn empty_and_broken_rasters_have_no_segments() {
        let params = SegmentParams::default();
        for (w, h) in [(0, 0), (1, 70), (70, 1), (4, 4)] {
            assert!(detect_in_grey(&Gray::new(w, h), &params).0.is_empty());
        }
        let nan = Gray::from_fn(50, 50, |_, _| f32::NAN);
        assert!(detect_in_grey(&nan, &params).0.is_empty());
    }
}
