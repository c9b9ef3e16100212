//! Parameters of the object-space method (W96 3).

use serde::{Deserialize, Serialize};

/// W96: the object-space method.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ObjectSpaceParams {
    /// Regions and their lines.
    pub oris: OrisParams,
    /// Windows around buildings.
    pub windows: WindowParams,
    /// Main directions.
    pub directions: DirectionParams,
    /// Clusters of lines.
    pub clusters: ClusterParams,
    /// Planes.
    pub planes: PlaneParams,
}

/// W96 3.6: planes between parallel lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlaneParams {
    /// By how much the window of a plane is enlarged, metres. W96 3.6: "appr. 0.5 m".
    pub margin_m: f64,
    /// Steepest plane, degrees. Assumption: roofs, not walls.
    pub max_slope_deg: f64,
    /// Least distance of the two lines, metres. Assumption.
    pub min_width_m: f64,
    /// Largest distance of the two lines, metres. Assumption.
    pub max_width_m: f64,
    /// Planes whose middle is lower than this above the ground are no roofs, metres. Assumption.
    pub min_height_m: f64,
    /// Shortest stretch across the plane that a crossing image line covers, metres. Assumption.
    pub min_crossing_m: f64,
    /// A crossing within this of a right angle is one, degrees. Assumption.
    pub angle_deg: f64,
    /// Crossings within this along the lines are one end, metres. Assumption.
    pub position_m: f64,
    /// Most ends of a pair of lines that are tested. W96: two. Assumption.
    pub max_ends: usize,
    /// Most candidates kept of a pair of lines. Assumption.
    pub max_candidates: usize,
    /// Least share of an outline that image lines cover, mean over the views, for it to be looked
    /// at. Assumption.
    pub min_support: f64,
    /// A plane is compared with those above and below it at a distance that moves the images
    /// against each other by this, px. Assumption: more than the error of a true plane, less than
    /// the windows.
    pub beside_px: f64,
    /// Natural logarithm of the odds from which on a plane is a candidate ([`crate::base::evidence`]):
    /// even ones, where W96 accepts any best plane and proposes "thresholding the measure". `make
    /// calibrate` sees every candidate by a very low one.
    pub least_nats: f64,
    /// Smallest plane, square metres. Assumption.
    pub min_area_m2: f64,
}

impl Default for PlaneParams {
    fn default() -> Self {
        Self {
            margin_m: 0.5,
            max_slope_deg: 65.0,
            min_width_m: 1.2,
            max_width_m: 25.0,
            min_height_m: 2.0,
            min_crossing_m: 0.8,
            angle_deg: 3.0,
            position_m: 0.3,
            max_ends: 8,
            max_candidates: 4,
            min_support: 0.25,
            beside_px: 3.0,
            least_nats: 0.0,
            min_area_m2: 3.0,
        }
    }
}

/// W96 3.1: where buildings are. The paper assumes it known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct WindowParams {
    /// Buildings' boxes x0, y0, x1, y1, metres in the frame of the orientation; found where there
    /// are none.
    pub given_m: Vec<[f64; 4]>,
    /// Heights between which lines are sought, metres in the frame of the orientation; estimated
    /// where `None`.
    pub z_range_m: Option<[f64; 2]>,
    /// Side of the tiles in which buildings are sought, metres. Assumption: a house with its
    /// surroundings.
    pub tile_m: f64,
    /// Lines of a building are linked over this distance in plan, metres. Assumption: the depth of
    /// a facet; closer than most houses stand.
    pub link_m: f64,
    /// The window reaches beyond the lines by this, metres. Assumption: lines that were not found.
    pub margin_m: f64,
}

impl Default for WindowParams {
    fn default() -> Self {
        Self {
            given_m: Vec::new(),
            z_range_m: None,
            tile_m: 24.0,
            link_m: 6.0,
            margin_m: 4.0,
        }
    }
}

/// W96 3.4: main directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct DirectionParams {
    /// Most pairs of directions in a window. W96 has one. Assumption: a few, for neighbouring
    /// buildings at other angles.
    pub max_pairs: usize,
    /// Least share of the weight of all lines that follows a pair. Assumption: chance gives 4 of 90
    /// degrees, 5 %.
    pub min_share: f64,
    /// A line within this of a direction follows it, degrees. Assumption.
    pub tolerance_deg: f64,
    /// Pairs are at least so far apart, degrees. Assumption.
    pub apart_deg: f64,
}

impl Default for DirectionParams {
    fn default() -> Self {
        Self {
            max_pairs: 3,
            min_share: 0.12,
            tolerance_deg: 2.0,
            apart_deg: 6.0,
        }
    }
}

/// W96 3.5: clusters of lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ClusterParams {
    /// An image line within this of a main direction belongs to it, degrees. Assumption.
    pub angle_deg: f64,
    /// ... or within what this displacement of an end does to its direction, px. Assumption.
    pub end_px: f64,
    /// Image lines within this distance support a 3D line, px. Assumption: three standard
    /// deviations.
    pub gate_px: f64,
    /// Standard deviation of an image line, px. Assumption: the precision of region boundaries.
    pub sigma_px: f64,
    /// Intersections nearer than this are one, metres. Assumption.
    pub cell_m: f64,
    /// Largest difference of the grey values on one side at least, grey range 1. Assumption; W96 4
    /// proposes to use radiometry here.
    pub max_grey_difference: f64,
    /// Least number of views. W96 3.5: all views, "too restrictive, due to possible occlusion".
    /// Assumption: three.
    pub min_views: usize,
    /// A view that covers less of a line does not count. Assumption.
    pub min_coverage: f64,
    /// What an image line costs on its own, bits. Assumption: one of 64 positions.
    pub position_bits: f64,
    /// What a 3D line costs, bits. Assumption: one of 16 x 16 places beside those that others
    /// leave.
    pub line_bits: f64,
    /// What it costs that a view misses a line, bits. Assumption.
    pub miss_bits: f64,
    /// Gaps up to this length are bridged, metres. Assumption: a chimney or a tree top.
    pub max_gap_m: f64,
    /// Shortest line, metres. Assumption.
    pub min_length_m: f64,
}

impl Default for ClusterParams {
    fn default() -> Self {
        Self {
            angle_deg: 2.5,
            end_px: 1.5,
            gate_px: 1.2,
            sigma_px: 0.4,
            cell_m: 0.15,
            max_grey_difference: 0.08,
            min_views: 3,
            min_coverage: 0.25,
            position_bits: 6.0,
            line_bits: 8.0,
            miss_bits: 1.0,
            max_gap_m: 4.0,
            min_length_m: 1.0,
        }
    }
}

/// W96 3.3: region segmentation. W96 gives no numbers ("Wiman 1995").
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct OrisParams {
    /// Standard deviation of the blur before gradients are taken, px. Assumption: 0.8, as for
    /// edgels.
    pub smoothing_px: f64,
    /// What a vector costs, bits. Assumption: its end is one of 64 x 64 positions relative to its
    /// start.
    pub vector_bits: f64,
    /// Pixels that make one independent grey value. Assumption: resampling and compression
    /// correlate neighbours.
    pub pixels_per_sample: f64,
    /// Weight of each of the two colour differences beside grey. Assumption: they are smoother, and
    /// JPEG stores them at half the resolution.
    pub color_weight: f64,
    /// Least standard deviation of the grey values of a region, grey levels of 255. Assumption:
    /// sensor and JPEG.
    pub least_sigma: f64,
    /// Shortest vector that is measured as a line, px. Assumption: half of B99's shortest segment.
    pub min_line_px: f64,
    /// Least contrast of a line, grey range 1. Assumption: three grey levels of 255.
    pub min_contrast: f64,
    /// Largest root mean square distance of the gradient's crest from the line, px; otherwise the
    /// vector itself is taken. Assumption.
    pub max_rms_px: f64,
}

impl Default for OrisParams {
    fn default() -> Self {
        Self {
            smoothing_px: 0.8,
            vector_bits: 12.0,
            pixels_per_sample: 1.7,
            color_weight: 0.5,
            least_sigma: 1.5,
            min_line_px: 8.0,
            min_contrast: 0.012,
            max_rms_px: 0.8,
        }
    }
}
