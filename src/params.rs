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
    /// The edgels that segments are made of.
    pub edgels: EdgelParams,
    /// Shortest segment, px. B99 3.2: "above a minimum length (here 15 pixels)".
    pub min_length_px: f64,
    /// Edgels in each of the worm's two arms. Assumption: a third of the shortest segment.
    pub worm_arm_edgels: usize,
    /// Tangent break, degrees. Assumption: several times the noise of an arm's direction (2 degrees).
    pub worm_bend_deg: f64,
    /// Largest distance of an edgel from its line, px. B99 3.2: "a very tight threshold"; Assumption:
    /// more than twice the largest rms.
    pub max_residual_px: f64,
    /// Largest root mean square distance of the edgels from their line, px. Assumption: what noise
    /// does to the weakest edges that are worth having.
    pub max_rms_px: f64,
    /// Fewest edgels of a straight piece from which a line is grown. Assumption: what still
    /// predicts a direction.
    pub seed_edgels: usize,
    /// Largest gap over which a line is grown, px. B99 3.2 jumps "up to a one pixel gap" when linking;
    /// Assumption: along a line already fitted more is safe.
    pub grow_gap_px: usize,
    /// Largest turn of an edgel against the line that takes it up, degrees. Assumption: what texture
    /// does to the gradient of a weak edge.
    pub grow_turn_deg: f64,
    /// Smallest radius of curvature of a line that bends significantly, px. Assumption: over
    /// 60 px it bends by 1.5 px.
    pub min_radius_px: f64,
    /// Natural logarithm of the expected number of lines by chance in an image, a line above which
    /// is refused. Assumption: a few too many, because matching over several views refuses
    /// what is accidental, and nothing brings back a lost edge.
    pub max_ln_false_alarms: f64,
    /// Distance off the line at which the contrast is measured, px. Assumption: outside the blur.
    pub contrast_distance_px: f64,
    /// Least standard deviation of an edgel, px. Assumption: what sampling leaves without noise.
    pub edgel_floor_px: f64,
}

impl Default for SegmentParams {
    fn default() -> Self {
        Self {
            edgels: EdgelParams::default(),
            min_length_px: 15.0,
            worm_arm_edgels: 5,
            worm_bend_deg: 20.0,
            max_residual_px: 1.2,
            max_rms_px: 0.5,
            seed_edgels: 8,
            grow_gap_px: 6,
            grow_turn_deg: 30.0,
            min_radius_px: 300.0,
            max_ln_false_alarms: 5.0,
            contrast_distance_px: 2.5,
            edgel_floor_px: 0.05,
        }
    }
}

/// B99 3.2: edgels. Thresholds are multiples of the local standard deviation of a gradient component.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EdgelParams {
    /// Standard deviation of the smoothing Gaussian, px. Assumption: more displaces edges that are
    /// 2 px apart, as an eave and its gutter are. Of 0.7, 0.8, 1.0 and 1.2 the first two covered most of the
    /// true roof edges of rendered scenes.
    pub smoothing_px: f64,
    /// Least gradient of an edgel, in local noise units. Assumption: noise alone
    /// exceeds 1.8 at one pixel in five; the significance of the whole line is tested later.
    pub low: f64,
    /// Least gradient of the strongest edgel in a chain, in local noise units. Assumption: noise
    /// alone exceeds 2.5 at one pixel in twenty.
    pub high: f64,
}

impl Default for EdgelParams {
    fn default() -> Self {
        Self {
            smoothing_px: 0.8,
            low: 1.8,
            high: 2.5,
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
}

impl Default for TextureParams {
    fn default() -> Self {
        Self { max_atlas_px: 4096 }
    }
}
