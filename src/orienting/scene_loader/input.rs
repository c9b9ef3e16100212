//! What the caller asks for beyond the files.

use serde::{Deserialize, Serialize};

/// What the user asks for beyond the files.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LoadOptions {
    /// Part of the path of the orientation to take, where there are several, or of the label of a
    /// group in it.
    pub orientation: Option<String>,
    /// Names of the images to use, with or without extension; all when absent.
    pub views: Option<Vec<String>>,
    /// Region of interest x0, y0, x1, y1, metres, world frame of the input.
    pub roi: Option<[f64; 4]>,
    /// Most views of the region of interest, those that say most about it; 12 when absent. More
    /// where views show parts of it, so that half as many see a place.
    pub max_views: Option<usize>,
    /// Height of the ground, metres, world frame of the input.
    pub ground_z: Option<f64>,
    /// Lowest and highest ground of the region of interest, metres, world frame of the input, where
    /// it is known already: it is not measured in photographs then.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground_range: Option<[f64; 2]>,
    /// Path of the terrain model among the files; the only one among them when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub terrain: Option<String>,
    /// Standard deviation of its heights, metres; that of surveys when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub terrain_accuracy_m: Option<f64>,
    /// Path of the footprints among the files; the only GeoJSON of footprints among them when
    /// absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub footprints: Option<String>,
    /// Standard deviation of their borders, metres; that of registers when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub footprint_accuracy_m: Option<f64>,
    /// Path of the point cloud (LAS, LAZ) among the files; the only one among them when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point_cloud: Option<String>,
    /// Standard deviation of its heights, metres; that of surveys when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point_cloud_accuracy_m: Option<f64>,
    /// Paths of terrain models, footprints and point clouds that are among the files and not used.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unused: Vec<String>,
    /// EPSG code of the world's reference system; the files' own when absent.
    pub epsg: Option<u32>,
    /// Photographs are reduced by this factor; as far as roofs allow when absent (see
    /// [`load_scene`](super::load_scene)).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction: Option<f64>,
    /// Memory that may be taken, megabytes; 1200 in the browser and 32768 elsewhere when absent.
    pub memory_mb: Option<u32>,
    /// Correct the error in the orientation that the images reveal, instead of refusing the scene.
    pub apply_fix: bool,
    /// Go on where the images do not agree with their orientation, instead of refusing the scene.
    pub ignore_check: bool,
}
