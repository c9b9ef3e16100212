//! All tunables, one struct a stage, with the papers' values as defaults.
//!
//! Each field quotes its section; where the paper is silent it says "Assumption:" and why.

use serde::{Deserialize, Serialize};

/// The parameters of a whole run. Missing fields of a JSON file take their defaults.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Params {
    /// Image segments.
    pub segments: SegmentParams,
    /// Line matching.
    pub matching: MatchParams,
    /// 3D lines.
    pub lines3d: Lines3dParams,
    /// Half-plane sweep.
    pub sweep: SweepParams,
    /// Grouping, delineation, verification, conflicts.
    pub roof: RoofParams,
    /// Texture atlas.
    pub texture: TextureParams,
}

/// B99 3.2: segments.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SegmentParams {
    /// Shortest segment, px. B99 3.2: "above a minimum length (here 15 pixels)".
    pub min_length_px: f64,
}

impl Default for SegmentParams {
    fn default() -> Self {
        Self {
            min_length_px: 15.0,
        }
    }
}

/// B99 3.1 - 3.4: matching.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MatchParams {
    /// Side of the correlation window, px. B99 3.2: "15 x 15".
    pub window_px: usize,
}

impl Default for MatchParams {
    fn default() -> Self {
        Self { window_px: 15 }
    }
}

/// B99 3.2, figure 4: 3D lines.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Lines3dParams {}

/// B99 4.1: half-planes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SweepParams {
    /// Largest |theta|, degrees. B99 figure 15: "over the interval [-75; +75]".
    pub max_theta_deg: f64,
    /// Least peak. B99 figure 12: `Sim(theta_max) >= 0.4`.
    pub min_similarity: f64,
    /// Least curvature at the peak, per radian squared. B99 figure 12: `|Sim''| >= 4.0`.
    pub min_curvature: f64,
    /// Least amplitude. B99 figure 12: `Sim(theta_max) - Sim(theta_min) >= 0.2`.
    pub min_amplitude: f64,
}

impl Default for SweepParams {
    fn default() -> Self {
        Self {
            max_theta_deg: 75.0,
            min_similarity: 0.4,
            min_curvature: 4.0,
            min_amplitude: 0.2,
        }
    }
}

/// B99 4.2, 4.3: from half-planes to facets.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RoofParams {}

/// Texture atlas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TextureParams {
    /// Largest side of the atlas, px. Assumption: what every WebGL 2 device can hold.
    pub max_atlas_px: u32,
    /// Side of a texel in pixels of the view that shows a face best. Assumption: 1, finer ones hold
    /// no more detail.
    pub texel_px: f64,
    /// Border around each patch, px, against bleeding. Assumption: 4, so that patches stay apart down to the
    /// second mipmap level.
    pub padding_px: u32,
    /// Quality of the atlas as JPEG, 1 to 100. Assumption: 90, where its blocks cannot be seen.
    pub jpeg_quality: u8,
}

impl Default for TextureParams {
    fn default() -> Self {
        Self {
            max_atlas_px: 4096,
            texel_px: 1.0,
            padding_px: 4,
            jpeg_quality: 90,
        }
    }
}
