//! ORIS, Object Related Image Segmentation (W96 3.3): an image becomes regions with straight,
//! shared boundaries.
//!
//! An image is described by regions of constant grey level with Gaussian noise, and by vectors
//! between them. The description length in bits is
//!
//! ```text
//! L = sum over regions   n/2 sum over channels w log2(max(s^2, s0^2)) + log2 n
//!   + sum over vectors   c
//!
//! n    number of independent grey values: pixels / pixels_per_sample
//! s^2  variance of the grey values, s0 = least_sigma
//! w    1 for grey, color_weight for the two colour differences
//! ```
//!
//! The first term codes the grey values given mean and noise (without the part n/2 log2(2 pi e),
//! which is the same for every partition), `log2 n` the two parameters of a region, each to its own
//! precision 1/sqrt(n). A vector costs `c = vector_bits`: its end relative to its start. Boundaries
//! are shared, so each vector counts once.
//!
//! W96 has panchromatic images. Colour is used where there is any, because a red roof in the shade
//! and the lawn beside it are often of the same grey; photographs without colour have differences
//! without variance, which say nothing.
//!
//! From a fine partition (`watershed`) two moves are made, the one with the largest gain in L
//! first, until none gains (`minimise`):
//!
//! * **drop a break point** of a boundary: the triangle that it spans changes sides. Only where no
//!   other node lies in the triangle, so that boundaries never cross;
//! * **merge two regions**: all vectors between them go. Junctions that are left with two vectors
//!   become break points.
//!
//! Between rounds a third move, which is not W96's, lets every node go to the lattice point nearby
//! where L is least (`settle`). Without it blunt corners stay up to 2.5 px beside the true ones,
//! which the straightening of a staircase took.
//!
//! Gains stand in a priority queue and are computed again when their turn comes; what a move
//! changes nearby is offered anew. Sums over regions and triangles come from running sums along
//! rows (`integrals`), so that a move costs as much as its boundary is long, and the whole grows
//! nearly linearly with the image.
//!
//! Lines for measuring are then taken from the vectors and moved to the crest of the gradient
//! (`region_lines`): break points stand on corners of pixels, which is as good as the regions need
//! and not as good as the image is.
//!
//! ```text
//! color         the channels: grey and two colour differences
//! watershed     initial fine partition
//! integrals     sums over polygons from running sums along rows
//! partition     the planar graph of boundaries and its changes (`occupied`, `edge_grid`)
//! cracks        the partition of a label image
//! code_length   the description length
//! minimise      the two moves by a priority queue
//! settle        the third move
//! segmentation  the result: regions and vectors (`rings`)
//! region_lines  image lines on the vectors, to a fraction of a pixel
//! ```
//!
//! Invariant: every pixel belongs to one region, and boundaries do not cross.

mod code_length;
mod color;
mod cracks;
mod edge_grid;
mod integrals;
mod minimise;
mod occupied;
mod partition;
mod region_lines;
mod rings;
mod segmentation;
mod settle;
mod watershed;

pub use color::ColorImage;
pub use integrals::Lattice;
pub use minimise::Moves;
pub use region_lines::{RegionLine, region_lines};
pub use segmentation::{ImageRegion, Segmentation, Vector};

use self::integrals::RowSums;
use self::partition::{ImagePartition, OUTSIDE_REGION};
use crate::base::params::OrisParams;

/// Segments an image. Empty for an image without pixels.
pub fn segment_regions(image: &ColorImage, params: &OrisParams) -> Segmentation {
    let (width, height) = (image.sharp[0].width, image.sharp[0].height);
    if width == 0 || height == 0 {
        return Segmentation::default();
    }
    let (labels, count) = watershed::watershed(&image.smooth);
    let sums = RowSums::new(&image.sharp);
    let mut partition = ImagePartition::from_labels(&labels, count, width, height, sums);
    let moves = minimise::minimise(&mut partition, params);
    Segmentation {
        initial_regions: count,
        moves,
        ..describe(&partition)
    }
}

/// Renumbers what is left of the partition.
fn describe(p: &ImagePartition) -> Segmentation {
    let mut ids = vec![None; p.regions.len()];
    let mut next = 0;
    for (k, region) in p.regions.iter().enumerate() {
        if region.alive && k != OUTSIDE_REGION as usize {
            ids[k] = Some(next);
            next += 1;
        }
    }
    let point = |n: u32| {
        let at = p.nodes[n as usize].at;
        [at.x, at.y]
    };
    let vectors: Vec<Vector> = p
        .edges
        .iter()
        .filter(|e| e.alive)
        .map(|e| Vector {
            ends: e.nodes.map(point),
            sides: e.sides.map(|r| ids[r as usize]),
        })
        .collect();
    let mut regions: Vec<ImageRegion> = p
        .regions
        .iter()
        .zip(&ids)
        .filter(|(_, id)| id.is_some())
        .map(|(r, _)| ImageRegion {
            area_px: r.moments.count as u32,
            perimeter_px: 0.0,
            mean: r.moments.mean(0),
            variance: r.moments.variance(0),
            rings: Vec::new(),
        })
        .collect();
    for v in &vectors {
        for side in v.sides.into_iter().flatten() {
            regions[side as usize].perimeter_px += v.length_px();
        }
    }
    for (region, rings) in regions
        .iter_mut()
        .zip(rings::rings(&vectors, next as usize))
    {
        region.rings = rings;
    }
    Segmentation {
        regions,
        vectors,
        ..Segmentation::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::geometry::{contains, sides};
    use crate::photographs::raster::Gray;
    use nalgebra::Point2;

    /// A drawn partition: a house-like pentagon and a rectangle on a background, with noise of 10
    /// grey levels.
    fn drawn(seed: u64) -> (Gray, Vec<Vec<[f64; 2]>>) {
        let shapes: Vec<(Vec<[f64; 2]>, f64)> = vec![
            (
                vec![[20.0, 24.0], [70.0, 14.0], [82.0, 74.0], [32.0, 84.0]],
                150.0,
            ),
            (
                vec![[82.0, 74.0], [70.0, 14.0], [104.0, 30.0], [112.0, 60.0]],
                190.0,
            ),
        ];
        let mut state = seed;
        let mut noise = || {
            // Sum of twelve uniform numbers: nearly Gaussian.
            let sum: f64 = (0..12)
                .map(|_| {
                    state = state
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1);
                    (state >> 33) as f64 / (1u64 << 31) as f64
                })
                .sum();
            sum - 6.0
        };
        // The second ring is drawn in either direction.
        let mut rings: Vec<Vec<[f64; 2]>> = shapes.iter().map(|(r, _)| r.clone()).collect();
        rings[1].reverse();
        let gray = Gray::from_fn(128, 100, |x, y| {
            let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
            let mut level = 90.0;
            for (ring, (_, value)) in rings.iter().zip(&shapes) {
                let sides = sides(ring).map(|side| side.map(Point2::from));
                if contains(sides, &Point2::new(x, y)) {
                    level = *value;
                }
            }
            ((level + 10.0 * noise()) / 255.0) as f32
        });
        (gray, rings)
    }

    #[test]
    fn a_drawn_partition_is_recovered() {
        for seed in [1, 2, 3, 12345] {
            let (gray, rings) = drawn(seed);
            let image = ColorImage::from_gray(&gray);
            let s = segment_regions(&image, &OrisParams::default());
            // Mixed pixels where three regions meet may be a sliver of their own.
            let areas: Vec<u32> = s.regions.iter().map(|r| r.area_px).collect();
            let large = areas.iter().filter(|&&a| a > 40).count();
            assert_eq!(large, 3, "two shapes and the background: {areas:?}");
            let slivers: u32 = areas.iter().filter(|&&a| a <= 40).sum();
            assert!(slivers < 64, "{areas:?}");
            for corner in rings.iter().flatten() {
                let distance = distance_to_vertex(&s, *corner);
                assert!(distance <= 1.0, "corner {corner:?} at {distance} px");
            }
        }
    }

    fn distance_to_vertex(s: &Segmentation, corner: [f64; 2]) -> f64 {
        let ends = s.vectors.iter().flat_map(|v| v.ends);
        let distance = |p: [i32; 2]| {
            crate::base::math::hypot(f64::from(p[0]) - corner[0], f64::from(p[1]) - corner[1])
        };
        ends.map(distance).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_regions_share_out_the_image() {
        let (gray, _) = drawn(12345);
        let s = segment_regions(&ColorImage::from_gray(&gray), &OrisParams::default());
        let area: u32 = s.regions.iter().map(|r| r.area_px).sum();
        assert_eq!(area as usize, gray.data.len());
        for region in 0..s.regions.len() as u32 {
            for n in s.neighbours(region) {
                assert!(s.neighbours(n).contains(&region));
            }
        }
    }

    #[test]
    fn without_contrast_there_is_one_region() {
        let gray = Gray::from_fn(40, 30, |_, _| 0.5);
        let s = segment_regions(&ColorImage::from_gray(&gray), &OrisParams::default());
        assert_eq!((s.regions.len(), s.vectors.len()), (1, 4));
        assert_eq!(s.regions[0].rings[0].len(), 4);
    }
}
