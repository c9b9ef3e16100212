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
    /// Steepest plane, degrees. Assumption: roofs, not walls.
    pub max_slope_deg: f64,
    /// Largest distance of the two lines, metres. Assumption.
    pub max_width_m: f64,
    /// Planes whose middle is lower than this above the ground are no roofs, metres. Assumption.
    pub min_height_m: f64,
    /// Natural logarithm of the odds from which on a plane is a candidate
    /// ([`crate::base::evidence`]): even ones, where W96 accepts any best plane and proposes
    /// "thresholding the measure". `make calibrate` sees every candidate by a very low one.
    pub least_nats: f64,
    /// Smallest plane, square metres. Assumption.
    pub min_area_m2: f64,
}

impl Default for PlaneParams {
    fn default() -> Self {
        Self {
            max_slope_deg: 65.0,
            max_width_m: 25.0,
            min_height_m: 2.0,
            least_nats: 0.0,
            min_area_m2: 3.0,
        }
    }
}

/// W96 3.1: where buildings are. The paper assumes it known.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct WindowParams {
    /// Buildings' boxes x0, y0, x1, y1, metres in the frame of the orientation; found where there
    /// are none.
    pub given_m: Vec<[f64; 4]>,
    /// Heights between which lines are sought, metres in the frame of the orientation; estimated
    /// where `None`.
    pub z_range_m: Option<[f64; 2]>,
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
}

impl Default for DirectionParams {
    fn default() -> Self {
        Self {
            max_pairs: 3,
            min_share: 0.12,
        }
    }
}

/// W96 3.5: clusters of lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ClusterParams {
    /// Image lines within this distance support a 3D line, px. Assumption: three standard
    /// deviations.
    pub gate_px: f64,
    /// Least number of views. W96 3.5: all views, "too restrictive, due to possible occlusion".
    /// Assumption: three.
    pub min_views: usize,
    /// What a 3D line costs, bits. Assumption: one of 16 x 16 places beside those that others
    /// leave.
    pub line_bits: f64,
    /// Gaps up to this length are bridged, metres. Assumption: a chimney or a tree top.
    pub max_gap_m: f64,
    /// Shortest line, metres. Assumption.
    pub min_length_m: f64,
}

impl Default for ClusterParams {
    fn default() -> Self {
        Self {
            gate_px: 1.2,
            min_views: 3,
            line_bits: 8.0,
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
    /// What a vector costs, bits. Assumption: its end is one of 64 x 64 positions relative to its
    /// start.
    pub vector_bits: f64,
    /// Least standard deviation of the grey values of a region, grey levels of 255. Assumption:
    /// sensor and JPEG.
    pub least_sigma: f64,
    /// Shortest vector that is measured as a line, px. Assumption: half of B99's shortest segment.
    pub min_line_px: f64,
}

impl Default for OrisParams {
    fn default() -> Self {
        Self {
            vector_bits: 12.0,
            least_sigma: 1.5,
            min_line_px: 8.0,
        }
    }
}
