//! The segmentation of an image: regions, and the vectors of their boundaries.

use serde::{Deserialize, Serialize};

use super::minimise::Moves;

/// A region of constant grey level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ImageRegion {
    /// Number of pixels.
    pub area_px: u32,
    /// Length of all its boundaries, pixels.
    pub perimeter_px: f64,
    /// Mean grey value, 0 to 255.
    pub mean: f64,
    /// Variance of the grey values.
    pub variance: f64,
    /// Boundaries, clockwise on the screen around the outside, the other way round holes; pixels.
    pub rings: Vec<Vec<[i32; 2]>>,
}

/// A straight piece of a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Vector {
    /// Start and end, pixels.
    pub ends: [[i32; 2]; 2],
    /// The region to the left and to the right of its direction as seen on the screen; `None`
    /// beyond the image.
    pub sides: [Option<u32>; 2],
}

impl Vector {
    /// Length in pixels.
    pub fn length_px(&self) -> f64 {
        let [a, b] = self.ends;
        let (dx, dy) = (f64::from(b[0] - a[0]), f64::from(b[1] - a[1]));
        (dx * dx + dy * dy).sqrt()
    }
}

/// The segmentation of an image.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Segmentation {
    /// The regions.
    pub regions: Vec<ImageRegion>,
    /// The vectors of all boundaries.
    pub vectors: Vec<Vector>,
    /// Regions of the initial fine partition.
    pub initial_regions: usize,
    /// Moves made.
    pub moves: Moves,
}

impl Segmentation {
    /// The regions that share a boundary with a region, ascending.
    pub fn neighbours(&self, region: u32) -> Vec<u32> {
        let mut found: Vec<u32> = self
            .boundary(region)
            .flat_map(|v| self.vectors[v].sides)
            .flatten()
            .filter(|&r| r != region)
            .collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// The vectors around a region, by index.
    pub fn boundary(&self, region: u32) -> impl Iterator<Item = usize> {
        (0..self.vectors.len()).filter(move |&v| self.vectors[v].sides.contains(&Some(region)))
    }

    /// The regions on either side of a vector.
    pub fn beside(&self, vector: usize) -> [Option<&ImageRegion>; 2] {
        self.vectors[vector]
            .sides
            .map(|side| side.map(|r| &self.regions[r as usize]))
    }
}
