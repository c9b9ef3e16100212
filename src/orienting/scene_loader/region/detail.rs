//! How much detail a photograph has beside the others, without decoding it.
//!
//! JPEG spends bits on what is to be seen. Of photographs of one place by one camera and one
//! program, those that are blurred, burnt out or dark have fewer bits a pixel than the others.

use std::collections::BTreeMap;

use image::ImageFormat;

use crate::base::math::smaller;
use crate::orienting::orientation::InputFile;
use crate::orienting::scene_loader::planned_view::PlannedView;
use crate::photographs::raster::image_format;

/// What every view tells of a place compared to one of full detail, 0 to 1. Photographs whose
/// format does not say it, among which are lossless ones, that keep all noise, have 1.
pub(super) fn shares_of_information(files: &[InputFile], views: &[PlannedView]) -> Vec<f64> {
    let bits = |view: &PlannedView| bits_per_pixel(&files[view.file], view.size);
    let all: Vec<(Option<f64>, CameraKind)> =
        views.iter().map(|view| (bits(view), kind(view))).collect();
    let of_kind = |kind| {
        all.iter()
            .filter(move |(_, k)| *k == kind)
            .map(|(bits, _)| *bits)
    };
    let usual: BTreeMap<CameraKind, Option<f64>> = (all.iter())
        .map(|(_, kind)| (*kind, usual(of_kind(*kind))))
        .collect();
    all.iter()
        .map(|(bits, kind)| share(*bits, usual[kind]))
        .collect()
}

/// Photographs of one size and focal length, to a hundredth, are of one camera: what others look at
/// and how they are compressed says nothing of them.
type CameraKind = [u32; 3];

fn kind(view: &PlannedView) -> CameraKind {
    let [width, height] = view.size;
    let focal = view.whole.k[(0, 0)] * view.reduction / f64::from(width.max(1));
    [width, height, (100.0 * focal).round() as u32]
}

/// Bits of a pixel of the compressed photograph.
fn bits_per_pixel(file: &InputFile, [width, height]: [u32; 2]) -> Option<f64> {
    let pixels = f64::from(width) * f64::from(height);
    let is_jpeg = image_format(&file.bytes) == Some(ImageFormat::Jpeg);
    (is_jpeg && pixels > 0.0).then(|| 8.0 * file.length() as f64 / pixels)
}

/// Fewest photographs of a camera that say what is usual: one of two may be the odd one.
const FEWEST_PHOTOGRAPHS: usize = 3;

/// The median of the bits of a pixel of one camera's photographs.
fn usual(bits: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let mut known: Vec<f64> = bits.flatten().collect();
    known.sort_by(f64::total_cmp);
    let median = known.get(known.len() / 2).copied();
    median.filter(|bits| known.len() >= FEWEST_PHOTOGRAPHS && *bits > 0.0)
}

/// The share by bits of a pixel: what is usual has all of the information, and so has what has
/// more.
///
/// Assumption: information falls with the third power of the bits. Three photographs blurred by 1
/// to 3 pixels: the sum of their squared gradients does.
fn share(bits: Option<f64>, usual: Option<f64>) -> f64 {
    let (Some(bits), Some(usual)) = (bits, usual) else {
        return 1.0;
    };
    let share = smaller(bits / usual, 1.0);
    share * share * share
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::codecs::jpeg::JpegEncoder;

    #[test]
    fn fewer_bits_than_the_others_tell_less_and_more_tell_no_more() {
        let bits = [Some(4.0), Some(2.0), Some(4.0), None, Some(5.0)];
        let usual_bits = usual(bits.into_iter());
        assert_eq!(usual_bits, Some(4.0));
        let found = bits.map(|bits| share(bits, usual_bits));
        assert_eq!(found, [1.0, 0.125, 1.0, 1.0, 1.0]);
        let none = [&bits[..2], &[None; 4], &[Some(0.0); 4]];
        for bits in none {
            assert_eq!(usual(bits.iter().copied()), None, "{bits:?}");
        }
        assert_eq!(share(Some(2.0), None), 1.0);
    }

    #[test]
    fn a_blurred_a_burnt_out_and_a_dark_photograph_have_fewer_bits() {
        let mut random = crate::roofs::testing::uniform(3);
        let sharp = image::GrayImage::from_fn(160, 120, |x, y| {
            let tile = f64::from((x / 7 + y / 5) % 2) * 90.0;
            image::Luma([(60.0 + tile + 40.0 * random()) as u8])
        });
        let changed = |change: &dyn Fn(u8) -> u8| {
            image::GrayImage::from_fn(160, 120, |x, y| {
                image::Luma([change(sharp.get_pixel(x, y)[0])])
            })
        };
        let bits = |image: &image::GrayImage| {
            let mut bytes = Vec::new();
            JpegEncoder::new_with_quality(&mut bytes, 90)
                .encode_image(image)
                .expect("memory");
            bits_per_pixel(&InputFile::new("a.jpg", bytes), [160, 120]).expect("JPEG")
        };
        let usual = bits(&sharp);
        for worse in [
            image::imageops::blur(&sharp, 2.0),
            changed(&|v| v.saturating_add(170)),
            changed(&|v| v / 8),
        ] {
            let bits = bits(&worse);
            assert!(bits < 0.7 * usual, "{bits} {usual}");
        }
        let mut png = std::io::Cursor::new(Vec::new());
        sharp.write_to(&mut png, ImageFormat::Png).expect("memory");
        let png = png.into_inner();
        assert_eq!(
            bits_per_pixel(&InputFile::new("a.png", png), [160, 120]),
            None
        );
    }
}
