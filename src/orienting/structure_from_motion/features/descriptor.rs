//! The descriptor (Lowe 2004, section 6): 4 x 4 histograms of 8 gradient directions, turned with
//! the keypoint and as large as its scale; as RootSIFT (Arandjelovic, Zisserman 2012) in bytes.

use super::extrema::Extremum;
use super::gradient::{Decay, gradient};
use super::orientation::nearest_image;
use super::scale_space::{Octave, sigma_at};
use crate::base::math;

/// Histograms along one side.
const SIDE: usize = 4;

/// Directions of one histogram.
const DIRECTIONS: usize = 8;

/// Numbers of a descriptor.
pub(crate) const LENGTH: usize = SIDE * SIDE * DIRECTIONS;

/// Width of a histogram, multiples of the keypoint's blur.
const CELL: f64 = 3.0;

/// Largest share of one number in a descriptor of length one (section 6.1).
const LARGEST_SHARE: f32 = 0.2;

/// What a descriptor of length one has in bytes.
pub(crate) const BYTES_AT_ONE: f32 = 512.0;

/// Square roots of histograms whose sum is one, times 512.
pub(crate) type Descriptor = [u8; LENGTH];

/// Descriptors in serde's forms: their bytes, one after the other.
pub(super) mod in_a_row {
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    use super::Descriptor;

    pub(crate) fn serialize<S: Serializer>(
        descriptors: &[Descriptor],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        descriptors.as_flattened().serialize(serializer)
    }

    pub(crate) fn deserialize<'a, D: Deserializer<'a>>(
        deserializer: D,
    ) -> Result<Vec<Descriptor>, D::Error> {
        let bytes = Vec::<u8>::deserialize(deserializer)?;
        match bytes.as_chunks() {
            (descriptors, []) => Ok(descriptors.to_vec()),
            _ => Err(D::Error::custom("a descriptor is cut off")),
        }
    }
}

thread_local! {
    static DECAY: Decay = Decay::new();
}

/// The descriptor of a keypoint under one of its directions.
pub(super) fn describe(octave: &Octave, extremum: &Extremum, angle: f32) -> Descriptor {
    let [x, y, scale] = extremum.in_octave;
    let image = &octave.images[nearest_image(scale)];
    let cell = (CELL * sigma_at(scale)) as f32;
    let radius = cell * std::f32::consts::SQRT_2 * (SIDE as f32 + 1.0) * 0.5;
    let radius = radius.round() as isize;
    let (sin, cos) = math::sin_cos(f64::from(angle));
    let (sin, cos) = (sin as f32 / cell, cos as f32 / cell);
    let (cx, cy) = (x.round() as isize, y.round() as isize);
    let (fx, fy) = ((x - cx as f64) as f32, (y - cy as f64) as f32);
    let half = SIDE as f32 / 2.0;
    // With a margin of one on every side, so that shares need no tests.
    let mut bins = [[[0.0f32; DIRECTIONS]; SIDE + 2]; SIDE + 2];
    DECAY.with(|decay| {
        for dy in -radius..=radius {
            let row = cy + dy;
            if row < 1 || row + 1 >= image.height as isize {
                continue;
            }
            for dx in -radius..=radius {
                let column = cx + dx;
                let (ox, oy) = (dx as f32 - fx, dy as f32 - fy);
                // In cells, in the keypoint's own axes.
                let (u, v) = (cos * ox + sin * oy, cos * oy - sin * ox);
                let (bu, bv) = (u + half + 0.5, v + half + 0.5);
                let end = (SIDE + 1) as f32;
                if !(bu > 0.0 && bu < end && bv > 0.0 && bv < end)
                    || column < 1
                    || column + 1 >= image.width as isize
                {
                    continue;
                }
                let (length, direction) = gradient(image, column as usize, row as usize);
                let weight = length * decay.at((u * u + v * v) * (0.5 / (half * half)));
                let turn = (direction - angle) / std::f32::consts::TAU + 2.0;
                let bt = turn * DIRECTIONS as f32;
                let (iu, iv, it) = (bu as usize, bv as usize, bt as usize);
                let (su, sv, st) = (bu - iu as f32, bv - iv as f32, bt - it as f32);
                let (first, second) = (it % DIRECTIONS, (it + 1) % DIRECTIONS);
                for (row, share) in [(iv, 1.0 - sv), (iv + 1, sv)] {
                    for (column, part) in [(iu, 1.0 - su), (iu + 1, su)] {
                        let w = weight * share * part;
                        bins[row][column][first] += w * (1.0 - st);
                        bins[row][column][second] += w * st;
                    }
                }
            }
        }
    });
    let mut histogram = [0.0f32; LENGTH];
    for (i, value) in histogram.iter_mut().enumerate() {
        let (cell, direction) = (i / DIRECTIONS, i % DIRECTIONS);
        *value = bins[cell / SIDE + 1][cell % SIDE + 1][direction];
    }
    in_bytes(&mut histogram)
}

fn in_bytes(histogram: &mut [f32; LENGTH]) -> Descriptor {
    let norm = histogram
        .iter()
        .map(|v| v * v)
        .sum::<f32>()
        .sqrt()
        .max(1e-12);
    for value in histogram.iter_mut() {
        let share = *value / norm;
        *value = if share > LARGEST_SHARE {
            LARGEST_SHARE
        } else {
            share
        };
    }
    let sum = histogram.iter().sum::<f32>().max(1e-12);
    histogram.map(|value| ((value / sum).sqrt() * BYTES_AT_ONE + 0.5) as u8)
}
