//! Parameters from edges to 3D lines (B99 3).

use serde::{Deserialize, Serialize};

/// B99 3.2: segments.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SegmentParams {
    /// The edgels that segments are made of.
    pub edgels: EdgelParams,
    /// Edges between colours, the second source of segments.
    pub colors: ColorParams,
    /// Shortest segment, px. B99 3.2: "above a minimum length (here 15 pixels)".
    pub min_length_px: f64,
    /// Edgels in each of the worm's two arms. Assumption: a third of the shortest segment.
    pub worm_arm_edgels: usize,
    /// Tangent break, degrees. Assumption: several times the noise of an arm's direction (2
    /// degrees).
    pub worm_bend_deg: f64,
    /// Largest distance of an edgel from its line, px. B99 3.2: "a very tight threshold";
    /// Assumption: more than twice the largest rms.
    pub max_residual_px: f64,
    /// Largest root mean square distance of the edgels from their line, px. Assumption: the effect
    /// of noise on the weakest useful edges.
    pub max_rms_px: f64,
    /// Fewest edgels of a straight piece from which a line is grown. Assumption: the fewest that
    /// predict a direction.
    pub seed_edgels: usize,
    /// Largest gap over which a line is grown, px. B99 3.2 jumps "up to a one pixel gap" when
    /// linking; Assumption: along a line already fitted twice that is safe. Longer gaps (6, 12)
    /// tripled the wrong 3D lines: pieces of different edges in one line; what belongs together is
    /// merged over the views (B99 3.3).
    pub grow_gap_px: usize,
    /// Largest turn of an edgel against the line that takes it up, degrees. Assumption: the effect
    /// of texture on the gradient of a weak edge.
    pub grow_turn_deg: f64,
    /// Smallest radius of curvature of a line that bends significantly, px. Assumption: over
    /// 60 px it bends by 1.5 px.
    pub min_radius_px: f64,
    /// Natural logarithm of the expected number of lines by chance in an image, a line above which
    /// is rejected. Assumption: rather too many, because matching over several views rejects
    /// accidental lines, and a lost edge is not recovered.
    pub max_ln_false_alarms: f64,
    /// Distance off the line at which the contrast is measured, px. Assumption: outside the blur.
    pub contrast_distance_px: f64,
    /// Least standard deviation of an edgel, px. Assumption: the error of sampling without noise.
    pub edgel_floor_px: f64,
    /// Least shift of a stretch of a line to the crest of the unsmoothed edge, in standard
    /// deviations of that crest. Assumption: of 0.3, 0.8, 1.3 and 2.5 the second brought lines
    /// nearer to true roof edges without following noise.
    pub refine_sigmas: f64,
    /// Standard deviation of the imaged edge about the roof edge, px, at either end of a segment.
    /// Assumption: fascias, gutters and ridge caps on aerial photographs: two thirds of the
    /// segments lie within one standard deviation of the true edge.
    pub edge_floor_px: f64,
}

impl Default for SegmentParams {
    fn default() -> Self {
        Self {
            edgels: EdgelParams::default(),
            colors: ColorParams::default(),
            min_length_px: 15.0,
            worm_arm_edgels: 5,
            worm_bend_deg: 20.0,
            max_residual_px: 1.2,
            max_rms_px: 0.5,
            seed_edgels: 8,
            grow_gap_px: 2,
            grow_turn_deg: 30.0,
            min_radius_px: 300.0,
            max_ln_false_alarms: 7.0,
            contrast_distance_px: 2.5,
            edgel_floor_px: 0.05,
            refine_sigmas: 0.8,
            edge_floor_px: 0.1,
        }
    }
}

/// B99 3.2: edgels. Thresholds are multiples of the local standard deviation of a gradient
/// component.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct EdgelParams {
    /// Standard deviation of the smoothing Gaussian, px. Assumption: more displaces edges that are
    /// 2 px apart, as an eave and its gutter are. Of 0.7, 0.8, 1.0 and 1.2 the first two covered
    /// most of the true roof edges of rendered scenes.
    pub smoothing_px: f64,
    /// Least gradient of an edgel, in local noise units. Assumption: noise alone often exceeds it;
    /// the significance of the whole line is tested later, and several views decide.
    pub low: f64,
    /// Least gradient of the strongest edgel in a chain, in local noise units. Measured: at 1.8
    /// random scenes have 2.6 % more of their roofs found than at 2.5.
    pub high: f64,
}

impl Default for EdgelParams {
    fn default() -> Self {
        Self {
            smoothing_px: 0.8,
            low: 1.2,
            high: 1.8,
        }
    }
}

/// Edges between colours of about the same grey value. Thresholds are those of [`EdgelParams`], on
/// the difference of red and blue.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ColorParams {
    /// Detect them at all? B99 has grey photographs; where there is colour, an eighth to a fifth
    /// of the roof edges of rendered scenes shows in it alone.
    pub detect: bool,
    /// A colour edge is rejected that has a segment in grey values this near along half of it, px.
    /// Assumption: compression leaves colour at half the resolution.
    pub clear_px: f64,
}

impl Default for ColorParams {
    fn default() -> Self {
        Self {
            detect: true,
            clear_px: 2.0,
        }
    }
}

/// B99 3.1 - 3.4: matching.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct MatchParams {
    /// Side of the correlation window, px. B99 3.2: "15 x 15".
    pub window_px: usize,
    /// Least correlation of an edgel that counts. B99 3.2: "the threshold value is 0.6". Deviation:
    /// plain sides of right lines correlate less, and the line's evidence weighs the score.
    pub edgel_correlation: f64,
    /// Least number of such edgels. B99 3.2: "the minimum is 15 edgels", relaxed to 10 in 4.1 where
    /// planes are built on the lines. Deviation: the line's evidence decides.
    pub min_edgels: usize,
    /// Least score of a pair, see [`crate::lines::linematch::EdgelScore`]. Assumption: the paper
    /// gives no value; pairs below are too many to be worth a third view.
    pub pair_score: f64,
    /// Share of `pair_score` required of a third view with a segment at the predicted position. B99
    /// 3.2: "about 50% of its value".
    pub with_segment: f64,
    /// The same without a segment. B99 3.2: "about 50% more than its value".
    pub without_segment: f64,
    /// Least number of views of a line where six or more see it. B99 3.4: "here 4". Three where
    /// fewer do.
    pub min_views: usize,
    /// Must the bright side be the same in the views that a line is first seen in? Assumption: one
    /// flight, one sun.
    pub same_contrast: bool,
    /// Grey-value noise assumed in correlation windows, 0 to 1. Assumption: an 8-bit camera and a
    /// good JPEG; of 0.006, 0.003, 0.0015 and 0 the second matched most roof edges of rendered
    /// scenes for few wrong lines.
    pub noise: f64,
    /// Angles of the planes tried on either side of the line, degrees, the horizontal one first
    /// (Schmid and Zisserman 1997). Assumption: up to the slopes of roofs, so close that a window's
    /// edge is less than a pixel off at a base-to-height ratio of 0.4.
    pub plane_angles_deg: Vec<f64>,
    /// Least sine of the angle at which a ray meets the other segment's interpretation plane:
    /// baseline over height times the sine of the line's angle to the epipolar lines. Assumption:
    /// below 0.04 an error of one pixel moves the line by 25 ground pixels in depth.
    pub min_intersection_sine: f64,
    /// Steepest line, degrees. Assumption: roof edges; verticals have no plane across them.
    pub max_slope_deg: f64,
    /// Distance at which a segment lies "at the predicted position", px, where the prediction
    /// itself is certain; three standard deviations where it is not. Assumption.
    pub gate_px: f64,
    /// Longest gap bridged by correlation, px. Assumption: B99 3.3 requires correlation support
    /// only; beyond about four windows neighbouring houses' edges in one line become likelier than
    /// one line.
    pub max_gap_px: f64,
    /// Largest number of views that a view is matched with. Assumption: keeps the work linear in
    /// the number of views.
    pub max_partners: usize,
    /// Natural logarithm of the odds from which on a line is true ([`crate::base::evidence`]): even
    /// ones. `make calibrate` sees every candidate by a very low one.
    pub least_nats: f64,
    /// Heights between which lines are sought, metres in the scene's frame; estimated where `None`.
    pub z_range_m: Option<[f64; 2]>,
}

impl Default for MatchParams {
    fn default() -> Self {
        Self {
            window_px: 15,
            edgel_correlation: 0.4,
            min_edgels: 8,
            pair_score: 0.35,
            with_segment: 0.5,
            without_segment: 1.5,
            min_views: 4,
            same_contrast: true,
            noise: 0.003,
            plane_angles_deg: vec![0.0, -20.0, 20.0, -40.0, 40.0, -55.0, 55.0],
            min_intersection_sine: 0.04,
            max_slope_deg: 75.0,
            gate_px: 1.0,
            max_gap_px: 30.0,
            max_partners: 8,
            least_nats: 0.0,
            z_range_m: None,
        }
    }
}

/// B99 3.2, figure 4: 3D lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Lines3dParams {
    /// Error of a segment's ends beyond its own covariance, px: calibration,
    /// compression, edges that are not quite straight. Assumption.
    pub position_floor_px: f64,
    /// The same for the stated precision of a finished line: distance, px, of the imaged edge from
    /// the roof edge, such as a gutter from its eave. Assumption, set so that about 68 % of the
    /// lines of rendered scenes lie within a standard deviation of their true edges.
    pub edge_floor_px: f64,
    /// Scale c of the Cauchy loss, standard deviations. Assumption: the usual 2.4 (95 %
    /// efficiency).
    pub loss_scale: f64,
    /// Residual, in standard deviations, beyond which a segment is not of this line. Assumption:
    /// rather too large, for residuals are a term of the line's evidence.
    pub max_residual: f64,
    /// Largest standard deviation of a line across itself, ground pixels; of a long line up to
    /// twice as much ([`Self::largest_sigma_px`]). Assumption: rather too large, for a line is kept
    /// with its covariance, which its evidence weighs.
    pub max_sigma_px: f64,
    /// Least odds of a line of the result, nats: ln 3, for a wrong line misleads three times as
    /// much as a missing one is missed (B99 3.4: no mismatches).
    pub least_nats: f64,
}

impl Lines3dParams {
    /// Largest standard deviation of a line across itself, ground pixels, for a line that is
    /// `length_px` ground pixels long. The less certain a line, the more wrong segments fit it; but
    /// that long segments agree by chance along all their length is rare, and a ridge along the
    /// flight strip is never certain.
    pub fn largest_sigma_px(&self, length_px: f64) -> f64 {
        self.max_sigma_px * (length_px / LONG_PX).clamp(1.0, 2.0)
    }
}

/// Length from which on a line may be less certain, ground pixels. Assumption: four of the shortest
/// segments.
const LONG_PX: f64 = 60.0;

impl Default for Lines3dParams {
    fn default() -> Self {
        Self {
            position_floor_px: 0.1,
            edge_floor_px: 0.15,
            loss_scale: 2.4,
            max_residual: 8.0,
            max_sigma_px: 3.0,
            least_nats: 1.1,
        }
    }
}
