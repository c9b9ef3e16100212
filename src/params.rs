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
    /// three times the rms.
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
    /// is refused. Assumption: 0, one line.
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
    /// Standard deviation of the smoothing Gaussian, px. Assumption: as for any Canny detector.
    pub smoothing_px: f64,
    /// Least gradient of an edgel, in local noise units. Assumption: noise alone is stronger
    /// than 2 at one pixel in seven; the significance of the whole line is tested later.
    pub low: f64,
    /// Least gradient of the strongest edgel in a chain, in local noise units.
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
    /// First step of the subdivision, degrees. Assumption: a point at the far end of the neighbourhood
    /// moves by 2 to 4 px in a step, about the width of a correlation peak; near points move less.
    pub first_step_deg: f64,
    /// The subdivision ends below this step, degrees. B99 4.1: "a termination criterion of
    /// `Delta theta < 1`" degree.
    pub last_step_deg: f64,
    /// Maxima of the first pass that are subdivided. Assumption: the highest few, since the first
    /// pass sees a narrow peak only in part.
    pub max_peaks: usize,
    /// Side of the correlation window, px, odd, at most 15. B99 3.2: "15 x 15".
    pub window_px: usize,
    /// Depth of the neighbourhood away from the line, px. Assumption: the weight 1/distance leaves little to
    /// points beyond.
    pub depth_px: f64,
    /// Depth of the neighbourhood, metres on the ground. Assumption: facets are rarely deeper.
    pub depth_m: f64,
    /// Strip beside the line that is not used, px. Assumption: the line's own blur and position error.
    pub margin_px: f64,
    /// Shortest projected line, px. Assumption: a window is not wider than the line is long.
    pub min_length_px: f64,
    /// Blur before the edge detector, standard deviation in px. Assumption: the least that keeps
    /// single-pixel noise from becoming edges.
    pub poi_blur_px: f64,
    /// Least gradient of an edge that gives points of interest, grey range per px. B99 4.1: "a very low
    /// threshold on gradient". Assumption: one grey level of 256 per pixel, three times the noise
    /// that a good photograph leaves after the blur.
    pub poi_min_gradient: f64,
    /// Every how many edgels there is a point of interest. B99 4.1: "regularly sampled".
    pub poi_spacing_px: usize,
    /// Least number of points of interest. Assumption: as many as the edgels that verify a line
    /// match for planes (B99 4.1: "only 10").
    pub min_points: usize,
    /// A correlation from here on is high. Assumption: the threshold for edgels of a line match (B99 3.2).
    pub high_correlation: f64,
    /// Least share of points of interest with a high correlation in a valid view. B99 4.1: "at
    /// least a threshold number"; Assumption: a share, because the number of points varies widely.
    pub min_high_share: f64,
    /// Least number of valid views besides the reference. Assumption: a single pair has nothing to
    /// confirm it.
    pub min_valid_views: usize,
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
            first_step_deg: 5.0,
            last_step_deg: 1.0,
            max_peaks: 2,
            window_px: 15,
            depth_px: 40.0,
            depth_m: 6.0,
            margin_px: 1.5,
            min_length_px: 15.0,
            poi_blur_px: 1.0,
            poi_min_gradient: 0.004,
            poi_spacing_px: 3,
            min_points: 10,
            high_correlation: 0.6,
            min_high_share: 0.2,
            min_valid_views: 2,
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
