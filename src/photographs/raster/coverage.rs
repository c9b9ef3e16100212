//! Images made smaller: each pixel is the mean of the area that it covers.

use std::ops::Range;

use super::gray::Gray;

/// Which pixels of a long row the pixels of a shorter one cover, and their shares of each.
#[derive(Clone, Debug)]
pub(crate) struct Coverage {
    /// Number of pixels of the long row.
    long: usize,
    starts: Vec<usize>,
    shares: Vec<Vec<f32>>,
}

impl Coverage {
    /// These pixels of a row that is shorter by a factor, over those of the long row that are at
    /// hand.
    pub(crate) fn new(short: Range<usize>, factor: f64, long: Range<usize>) -> Self {
        let mut coverage = Self {
            long: long.len(),
            starts: Vec::with_capacity(short.len()),
            shares: Vec::with_capacity(short.len()),
        };
        for i in short {
            let (from, to) = (i as f64 * factor, (i + 1) as f64 * factor);
            let first = (from as usize).max(long.start);
            let last = (to.ceil() as usize).min(long.end);
            let share = |p: usize| {
                let covered = to.min((p + 1) as f64) - from.max(p as f64);
                (covered.max(0.0) / factor) as f32
            };
            coverage.starts.push(first - long.start);
            coverage.shares.push((first..last).map(share).collect());
        }
        coverage
    }

    fn of(&self, i: usize) -> impl Iterator<Item = (usize, f32)> + '_ {
        let shares = self.shares[i].iter().enumerate();
        shares.map(move |(k, share)| (self.starts[i] + k, *share))
    }

    fn len(&self) -> usize {
        self.shares.len()
    }
}

/// Grey values of a smaller image.
pub(crate) fn reduced_gray(image: &Gray, columns: &Coverage, rows: &Coverage) -> Gray {
    Gray {
        width: columns.len(),
        height: rows.len(),
        data: means::<_, 1>(&image.data, columns, rows),
    }
}

/// Colours of a smaller image.
pub(crate) fn reduced_colours(
    image: &image::RgbImage,
    columns: &Coverage,
    rows: &Coverage,
) -> image::RgbImage {
    let means = means::<_, 3>(image.as_raw(), columns, rows);
    let bytes = means.into_iter().map(|mean| (mean + 0.5) as u8).collect();
    let (width, height) = (columns.len() as u32, rows.len() as u32);
    image::RgbImage::from_raw(width, height, bytes).expect("three values a pixel")
}

/// The mean colour of each block of `factor` x `factor` pixels; what is left over is dropped.
pub(crate) fn colours_of_blocks(image: &image::RgbImage, factor: u32) -> image::RgbImage {
    let (width, height) = image.dimensions();
    let [columns, rows] = [width, height].map(|long| {
        Coverage::new(
            0..(long / factor) as usize,
            f64::from(factor),
            0..long as usize,
        )
    });
    reduced_colours(image, &columns, &rows)
}

/// The means of an image with so many values a pixel, row by row.
fn means<T: Copy + Into<f32>, const CHANNELS: usize>(
    data: &[T],
    columns: &Coverage,
    rows: &Coverage,
) -> Vec<f32> {
    let length = CHANNELS * columns.long;
    let mut sums = vec![0.0f32; length];
    let mut means = Vec::with_capacity(CHANNELS * columns.len() * rows.len());
    for y in 0..rows.len() {
        sums.fill(0.0);
        for (row, share) in rows.of(y) {
            for (sum, &value) in sums.iter_mut().zip(&data[row * length..][..length]) {
                *sum += value.into() * share;
            }
        }
        for x in 0..columns.len() {
            for channel in 0..CHANNELS {
                let covered = columns.of(x);
                means.push(
                    covered
                        .map(|(p, share)| sums[CHANNELS * p + channel] * share)
                        .sum(),
                );
            }
        }
    }
    means
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_stays_in_its_place_whatever_the_factor() {
        for (factor, size) in [(2.5, [20, 12]), (1.6, [31, 18]), (2.0, [25, 15])] {
            let [columns, rows] = [(size[0], 50), (size[1], 30)]
                .map(|(n, long)| Coverage::new(0..n, factor, 0..long));
            let reduced = reduced_gray(&Gray::ramp(50, 30), &columns, &rows);
            let expected = Gray::ramp(size[0], size[1]);
            // A part of a pixel counts with the value at its middle: a tenth of a pixel at most.
            for (a, b) in reduced.data.iter().zip(&expected.data) {
                assert!(
                    (a - factor as f32 * b).abs() < 0.1 * 0.03,
                    "{a} {b} by {factor}"
                );
            }
        }
    }

    #[test]
    fn a_part_is_a_part_of_the_whole() {
        let image = Gray::ramp(50, 30);
        let part = Gray::from_fn(20, 30, |x, y| image.get(x + 16, y));
        let rows = Coverage::new(0..10, 3.0, 0..30);
        let whole = reduced_gray(&image, &Coverage::new(0..31, 1.6, 0..50), &rows);
        let part = reduced_gray(&part, &Coverage::new(10..20, 1.6, 16..36), &rows);
        for (x, y) in (0..10).flat_map(|x| (0..10).map(move |y| (x, y))) {
            assert_eq!(part.get(x, y), whole.get(x + 10, y));
        }
    }

    #[test]
    fn whole_factors_give_the_means_of_blocks() {
        let value = |x: u32, y: u32| (10 * x + 40 * y) as u8;
        let rgb = image::RgbImage::from_fn(5, 4, |x, y| image::Rgb([value(x, y), 0, 255]));
        let half = colours_of_blocks(&rgb, 2);
        assert_eq!(half.dimensions(), (2, 2));
        assert_eq!(half.get_pixel(1, 1).0, [25 + 20 + 80, 0, 255]);
    }
}
