//! The synthetic scenes by the names of their goldens, each of a size that shows its houses whole.

use ridgeline::orienting::scene::Scene;
use ridgeline::orienting::synthetic::{
    askew_scene, gable_scene, hip_scene, l_scene, row_scene, sheared_scene, skewed_scene,
    tower_scene,
};

/// Width and height of the synthetic views, pixels.
pub const SIZE_PX: u32 = 320;

/// Two houses side by side need more.
const WIDE_PX: u32 = 400;

/// Name and scene.
pub fn scenes() -> [(&'static str, Scene); 8] {
    [
        ("gable", gable_scene(SIZE_PX).0),
        ("l", l_scene(SIZE_PX).0),
        ("row", row_scene(SIZE_PX).0),
        ("askew", askew_scene(WIDE_PX).0),
        ("sheared", sheared_scene(SIZE_PX).0),
        ("skewed", skewed_scene(SIZE_PX).0),
        ("tower", tower_scene(WIDE_PX).0),
        ("hip", hip_scene(SIZE_PX).0),
    ]
}
