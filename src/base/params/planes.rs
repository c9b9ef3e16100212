//! Parameters from half-planes to facets (B99 4).

use serde::{Deserialize, Serialize};

use super::{RefineParams, RegisterParams};

/// B99 4.1: half-planes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SweepParams {
    /// Lines lower than this above the ground are not swept, metres. Assumption: lower than any
    /// eave.
    pub min_height_m: f64,
    /// Largest |theta|, degrees. B99 figure 15: "over the interval [-75; +75]".
    pub max_theta_deg: f64,
    /// First step of the subdivision, degrees. Assumption: a point at the far end of the
    /// neighbourhood moves by 2 to 4 px in a step, about the width of a correlation peak; near
    /// points move less.
    pub first_step_deg: f64,
    /// The subdivision ends below this step, degrees. B99 4.1: "a termination criterion of
    /// `Delta theta < 1`" degree.
    pub last_step_deg: f64,
    /// Maxima of the first pass that are subdivided. Assumption: the highest few, since the first
    /// pass sees a narrow peak only in part.
    pub max_peaks: usize,
    /// Side of the correlation window, px, odd, at most 15. B99 3.2: "15 x 15".
    pub window_px: usize,
    /// Depth of the neighbourhood away from the line, px. Assumption: the weight 1/distance leaves
    /// little to points beyond.
    pub depth_px: f64,
    /// Depth of the neighbourhood, metres on the ground. Assumption: facets are rarely deeper.
    pub depth_m: f64,
    /// Strip beside the line that is not used, px. Assumption: the line's own blur and position
    /// error.
    pub margin_px: f64,
    /// Shortest projected line, px. Assumption: a window is not wider than the line is long.
    pub min_length_px: f64,
    /// Blur before the edge detector, standard deviation in px. Assumption: the least that keeps
    /// single-pixel noise from becoming edges.
    pub poi_blur_px: f64,
    /// Least gradient of an edge that gives points of interest, grey range per px. B99 4.1: "a very
    /// low threshold on gradient". Assumption: one grey level of 256 per pixel, three times the
    /// noise that a good photograph leaves after the blur.
    pub poi_min_gradient: f64,
    /// Every how many edgels there is a point of interest. B99 4.1: "regularly sampled".
    pub poi_spacing_px: usize,
    /// Least number of points of interest. Assumption: as many as the edgels that verify a line
    /// match for planes (B99 4.1: "only 10").
    pub min_points: usize,
    /// Least correlation that counts as high. Assumption: the threshold for edgels of a line match
    /// (B99 3.2).
    pub high_correlation: f64,
    /// Least share of points of interest with a high correlation in a valid view. B99 4.1: "at
    /// least a threshold number"; Assumption: a share, because the number of points varies widely.
    pub min_high_share: f64,
    /// Least number of valid views besides the reference. Assumption: a single pair is not
    /// confirmed by any other.
    pub min_valid_views: usize,
    /// Least peak. B99 figure 12: `Sim(theta_max) >= 0.4`.
    pub min_similarity: f64,
    /// Least curvature at the peak, per radian squared. B99 figure 12: `|Sim''| >= 4.0`.
    pub min_curvature: f64,
    /// Least amplitude. B99 figure 12: `Sim(theta_max) - Sim(theta_min) >= 0.2`.
    pub min_amplitude: f64,
    /// The criterion that accepts a maximum.
    pub acceptance: Acceptance,
    /// Least posterior probability of a plane at the maximum, where that decides. Assumption: by
    /// measurement one in twenty is wrong then, which grouping tolerates.
    pub min_probability: f64,
    /// Share of a printed threshold from which on failing it is ambiguous. Assumption: half; Sim is
    /// a squared correlation, and noise as strong as three quarters of the texture halves it.
    pub ambiguous_share: f64,
}

/// The criterion that accepts a maximum of Sim(theta) as a half-plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Acceptance {
    /// The three thresholds of B99 figure 12.
    Printed,
    /// The posterior over theta (B99 5).
    Posterior,
    /// The thresholds and, where one of them is nearly reached, the posterior.
    #[default]
    Both,
}

impl Default for SweepParams {
    fn default() -> Self {
        Self {
            min_height_m: 1.4,
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
            acceptance: Acceptance::default(),
            min_probability: 0.98,
            ambiguous_share: 0.5,
        }
    }
}

/// B99 4.2, 4.3: from half-planes to facets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct RoofParams {
    /// Half-planes within this angle, degrees, may share a plane. B99 4.4: theta is known to 2
    /// degrees on textured faces and to 5 on weak ones; two of them may differ by somewhat more
    /// than either.
    pub coplanar_angle_deg: f64,
    /// Least distance within which a line counts as lying in a plane, metres. Assumption: eaves
    /// have gutters and ridges have caps of about this size.
    pub coplanar_distance_m: f64,
    /// A facet may reach at least this far from its supporting line, metres. Assumption.
    pub min_facet_depth_m: f64,
    /// ... and at most this far, metres. Assumption: larger facets have lines on both sides.
    pub max_facet_depth_m: f64,
    /// Lines are extended by at least this much at both ends to meet others, metres (B99 figure
    /// 22). Assumption.
    pub extension_m: f64,
    /// Cost of a metre of facet border that no line supports, nats; a square metre on which the
    /// views agree has about five. Measured: half and twice as much find as many facets.
    pub border_nats_per_m: f64,
    /// Facets smaller than this are not reported, square metres. Assumption.
    pub min_area_m2: f64,
    /// No eave is lower than this above the ground, metres. Assumption: that of a low garage, less
    /// the error of the ground's height.
    pub min_height_m: f64,
    /// Natural logarithm of the odds from which on a facet is true ([`crate::base::evidence`]):
    /// even ones. `make calibrate` sees every candidate by a very low one.
    pub least_nats: f64,
    /// Regularisation and refinement of the buildings.
    pub refine: RefineParams,
    /// What a register of buildings is worth, where one is given.
    pub register: RegisterParams,
}

impl Default for RoofParams {
    fn default() -> Self {
        Self {
            coplanar_angle_deg: 8.0,
            coplanar_distance_m: 0.15,
            min_facet_depth_m: 5.0,
            max_facet_depth_m: 15.0,
            extension_m: 1.5,
            border_nats_per_m: 1.25,
            min_area_m2: 1.5,
            min_height_m: 1.2,
            least_nats: 0.0,
            refine: RefineParams::default(),
            register: RegisterParams::default(),
        }
    }
}
