//! Exposure: by how much brighter one photograph shows the model than the others.
//!
//! Faces beside each other often have their colours from different photographs. What two of them
//! show of the same texels shows how their exposures differ; every photograph gets the factors that
//! bring all of them together with as little change as possible. What a face looks like from
//! different sides varies too, so each pair of views is compared by the median over all faces.

use glam::{DVec3, Vec3};

use super::occlusion::FaceImages;
use super::paint::{FaceView, MAX_GAIN, colours_in, views_of};
use super::patch::{FacePlane, TexturePatch};
use crate::base::ids::ViewId;
use crate::base::math::{exp, ln, median};
use crate::orienting::scene::Scene;

/// Texels of a face that are compared, about. Assumption: the mean of a hundred is good to a
/// percent.
const SAMPLES: f64 = 100.0;
/// Grey value from which on a texel is taken as saturated.
const SATURATED_GREY: f32 = 250.0;
/// Fewest texels that two views must both show.
const LEAST_COMMON: usize = 10;
/// Fewest faces by which two views are compared. Assumption: half of them may look different from
/// both.
const LEAST_FACES: usize = 5;
/// How much an unchanged exposure weighs against the comparison of two views. Assumption: little.
const UNCHANGED_WEIGHT: f64 = 0.01;
/// Sweeps over all views: each takes a hundredth off what the factors have in common.
const SWEEPS: usize = 1000;

/// The factors for red, green and blue of every view that balance dark colours, 1 in the geometric
/// mean.
pub(super) fn exposures(
    scene: &Scene,
    faces: &[FacePlane],
    face_images: &[FaceImages],
    overhang_m: f64,
) -> Vec<Vec3> {
    let views = scene.views.len();
    let compared = crate::base::execution::map_part(faces, 0.2..0.3, |i, face| {
        let [low, high] = face.bounds();
        let area = ((high.x - low.x) * (high.y - low.y)).max(1e-6);
        let patch = TexturePatch::new(face, (area / SAMPLES).sqrt());
        let seen = views_of(scene, faces, i, &patch, face_images, overhang_m);
        let colours = |s: &FaceView| (s.0.view, colours_in(scene, face, &patch, s));
        log_ratios(&seen.iter().map(colours).collect::<Vec<_>>())
    });
    let mut of_pair = vec![Vec::new(); views * views];
    for (pair, ratio) in compared.into_iter().flatten() {
        of_pair[pair[0] * views + pair[1]].push(ratio);
    }
    let factors = [0, 1, 2].map(|channel| {
        let ratio = |of_faces: &Vec<[f64; 3]>| {
            let mut ratios: Vec<f64> = of_faces.iter().map(|r| r[channel]).collect();
            (ratios.len() >= LEAST_FACES).then(|| median(&mut ratios))?
        };
        balanced(&of_pair.iter().map(ratio).collect::<Vec<_>>(), views)
    });
    (0..views)
        .map(|v| Vec3::from_array([0, 1, 2].map(|c| exp(factors[c][v]) as f32)))
        .map(|gain| gain.clamp(Vec3::splat(1.0 / MAX_GAIN), Vec3::splat(MAX_GAIN)))
        .collect()
}

/// The colours of a face in a view, where it shows them.
type Colours = Vec<Option<Vec3>>;

/// By how much the first of two views is brighter, for every two that show enough of a face.
fn log_ratios(seen: &[(ViewId, Colours)]) -> Vec<([usize; 2], [f64; 3])> {
    let mut ratios = Vec::new();
    for (i, (a, of_a)) in seen.iter().enumerate() {
        for (b, of_b) in &seen[..i] {
            let ratio = log_ratio(of_a, of_b);
            ratios.extend(ratio.map(|ratio| ([a.index(), b.index()], ratio)));
        }
    }
    ratios
}

/// By how much one view is brighter than another on the texels that both show: logarithms for red,
/// green and blue. `None` where these are too few, black or saturated.
fn log_ratio(a: &Colours, b: &Colours) -> Option<[f64; 3]> {
    let both = a.iter().zip(b).filter_map(|(x, y)| Some([(*x)?, (*y)?]));
    let (mut sums, mut count) = ([DVec3::ZERO; 2], 0usize);
    for colours in both.filter(|colours| colours.iter().all(|c| c.max_element() < SATURATED_GREY)) {
        for (sum, colour) in sums.iter_mut().zip(colours) {
            *sum += colour.as_dvec3();
        }
        count += 1;
    }
    let black = sums.iter().any(|sum| sum.min_element() < count as f64);
    (count >= LEAST_COMMON && !black).then(|| (sums[0] / sums[1]).to_array().map(ln))
}

/// The logarithms of the factors that bring views together, given by how much (a logarithm) the
/// row's view is brighter than the column's: least squares by Gauss and Seidel, one view after the
/// other.
fn balanced(brighter: &[Option<f64>], views: usize) -> Vec<f64> {
    let mut factors = vec![0.0; views];
    for _ in 0..SWEEPS {
        for a in 0..views {
            let (mut sum, mut weight) = (0.0, UNCHANGED_WEIGHT);
            for b in 0..views {
                let from_a = brighter[a * views + b].map(|r| -r);
                for ratio in [from_a, brighter[b * views + a]].into_iter().flatten() {
                    sum += factors[b] + ratio;
                    weight += 1.0;
                }
            }
            factors[a] = sum / weight;
        }
    }
    factors
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A face of 40 texels in views of these exposures; the first half of it is hidden from the
    /// last.
    fn face(exposures: &[f32], colour: Vec3) -> Vec<(ViewId, Colours)> {
        let of_view = |(v, exposure): (usize, &f32)| {
            let hidden = |k: usize| v + 1 == exposures.len() && k < 20;
            let texel = |k: usize| {
                let shade = exposure * (0.5 + 0.5 * (k as f32 / 40.0));
                (!hidden(k)).then(|| colour * shade)
            };
            (ViewId::from_index(v), (0..40).map(texel).collect())
        };
        exposures.iter().enumerate().map(of_view).collect()
    }

    #[test]
    fn the_same_texels_tell_how_much_brighter_a_view_is() {
        let ratios = log_ratios(&face(&[1.0, 1.3, 0.8], Vec3::new(120.0, 90.0, 60.0)));
        assert_eq!(ratios.len(), 3);
        for ([a, b], ratio) in ratios {
            let exposures = [1.0f64, 1.3, 0.8];
            let expected = ln(exposures[a] / exposures[b]);
            assert!(ratio.iter().all(|r| (r - expected).abs() < 1e-5), "{a} {b}");
        }
        assert!(
            log_ratios(&face(&[1.0, 1.0], Vec3::splat(0.5))).is_empty(),
            "black"
        );
        assert!(
            log_ratios(&face(&[4.0, 4.0], Vec3::splat(255.0))).is_empty(),
            "white"
        );
    }

    #[test]
    fn views_are_brought_together_over_others_between_them() {
        // 0 and 2 have nothing in common but 1; nothing is known of 3.
        let exposures = [1.0f64, 1.2, 0.9, 1.5];
        let mut brighter = vec![None; 16];
        brighter[4] = Some(ln(exposures[1] / exposures[0]));
        brighter[4 * 2 + 1] = Some(ln(exposures[2] / exposures[1]));
        let factors = balanced(&brighter, 4);
        let seen = [0, 1, 2].map(|v| exp(factors[v]) * exposures[v]);
        for shown in seen {
            assert!((shown / seen[0] - 1.0).abs() < 0.01, "{seen:?}");
        }
        assert!(
            factors.iter().sum::<f64>().abs() < 1e-6,
            "as little change as possible"
        );
        assert_eq!(factors[3], 0.0);
    }
}
