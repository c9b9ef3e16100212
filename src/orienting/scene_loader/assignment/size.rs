//! Images of another size than the one for which their orientation is stated.

use nalgebra::{Matrix3, Vector3};

use crate::orienting::orientation::{Crop, Orientation};

/// How the size of an image fits the one that its orientation states; less is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum SizeFit {
    Equal,
    /// The whole image in another resolution.
    Scaled,
    Other,
}

impl SizeFit {
    /// Where no size is stated, the centre of the lens should lie in the image.
    pub(crate) fn new(orientation: &Orientation, [width, height]: [u32; 2]) -> Self {
        let Some((w, h)) = orientation.size else {
            let (x, y) = (orientation.k[(0, 2)], orientation.k[(1, 2)]);
            let is_inside =
                (0.0..=f64::from(width)).contains(&x) && (0.0..=f64::from(height)).contains(&y);
            return match orientation.from_middle || is_inside {
                true => Self::Equal,
                false => Self::Scaled,
            };
        };
        match [w, h] == [width, height] {
            true => Self::Equal,
            false if scale([w, h], [width, height]).is_some() => Self::Scaled,
            false => Self::Other,
        }
    }
}

/// Width and height of an image by those stated, where both were multiplied by one number and
/// rounded.
pub(crate) fn scale(stated: [u32; 2], image: [u32; 2]) -> Option<[f64; 2]> {
    let range = |i: usize| {
        let (stated, image) = (f64::from(stated[i]), f64::from(image[i]));
        [(image - 1.0) / stated, (image + 1.0) / stated]
    };
    let ([low_x, high_x], [low_y, high_y]) = (range(0), range(1));
    let ratios = [0, 1].map(|i| f64::from(image[i]) / f64::from(stated[i]));
    let is_one_number = low_x.max(low_y) < high_x.min(high_y);
    (is_one_number && ratios.iter().all(|r| r.is_finite() && *r > 0.0)).then_some(ratios)
}

/// The orientation of an image that was resampled by these factors: coefficients of the distortion
/// belong to normalised coordinates and stay.
pub(crate) fn resized(orientation: &Orientation, [sx, sy]: [f64; 2]) -> Orientation {
    Orientation {
        k: Matrix3::from_diagonal(&Vector3::new(sx, sy, 1.0)) * orientation.k,
        crop: orientation.crop.map(|crop| Crop {
            column: crop.column * sx,
            row: crop.row * sy,
            frame: [crop.frame[0] * sx, crop.frame[1] * sy],
        }),
        ..orientation.clone()
    }
}

/// A factor in words: "half", "a third of", "0.512 times", "2 times".
pub(crate) fn factor_in_words(factor: f64) -> String {
    let near = |value: f64| (factor / value - 1.0).abs() < 5e-3;
    match () {
        () if near(0.5) => "half".to_owned(),
        () if near(1.0 / 3.0) => "a third of".to_owned(),
        () if near(0.25) => "a quarter of".to_owned(),
        () if near(0.125) => "an eighth of".to_owned(),
        () if factor > 1.0 && near(factor.round()) => format!("{} times", factor.round()),
        () => format!("{factor:.3} times"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scaled_image_keeps_its_shape_to_the_pixel() {
        assert_eq!(scale([4000, 3000], [2000, 1500]), Some([0.5, 0.5]));
        // Rounded down and up.
        for image in [[2012, 1518], [2013, 1519], [2012, 1519]] {
            assert!(scale([4025, 3037], image).is_some(), "{image:?}");
        }
        assert!(scale([4000, 3000], [2048, 1536]).is_some());
        assert!(scale([320, 240], [640, 480]).is_some());
        // Turned, cut, and of another camera.
        for image in [[3000, 4000], [4000, 2250], [3900, 2900], [0, 0]] {
            assert_eq!(scale([4000, 3000], image), None, "{image:?}");
        }
        assert_eq!(scale([0, 0], [4, 3]), None);
    }

    #[test]
    fn a_resampled_image_has_the_camera_and_the_crop_of_its_size() {
        let stated = Orientation {
            crop: Some(Crop {
                column: 100.0,
                row: 200.0,
                frame: [1000.0, 800.0],
            }),
            ..super::super::tests::stated("a")
        };
        let found = resized(&stated, [0.5, 0.25]);
        let k = Matrix3::new(1750.0, 0.0, 1000.0, 0.0, 875.0, 375.0, 0.0, 0.0, 1.0);
        assert_eq!(found.k, k);
        let crop = found.crop.unwrap();
        assert_eq!((crop.column, crop.row), (50.0, 50.0));
        assert_eq!(crop.frame, [500.0, 200.0]);
    }

    #[test]
    fn factors_are_said_in_words() {
        let words = [0.5, 1.0 / 3.0, 0.512, 2.0, 1.5].map(factor_in_words);
        assert_eq!(
            words,
            [
                "half",
                "a third of",
                "0.512 times",
                "2 times",
                "1.500 times"
            ]
        );
    }
}
