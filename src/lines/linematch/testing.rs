//! The planted flat roof with the inputs of its matching, for the tests.

use super::nview::MatchContext;
use super::segment_geometry::PreparedSegments;
use crate::base::params::{Lines3dParams, MatchParams};
use crate::lines::lines2d::ImageSegment;
use crate::lines::lines3d::planted;
use crate::orienting::scene::Scene;

/// The flat roof with the inputs of its matching; the first segments of each view are numbered as
/// its edges.
pub(super) struct PlantedRoof {
    /// Its views.
    pub scene: Scene,
    /// [`planted::segments`].
    pub segments: Vec<Vec<ImageSegment>>,
    /// The same, prepared.
    pub prepared: PreparedSegments,
    /// Defaults.
    pub params: MatchParams,
    /// Defaults.
    pub fitting: Lines3dParams,
}

impl PlantedRoof {
    /// That of [`planted::scene`].
    pub(super) fn new() -> Self {
        let scene = planted::scene();
        let segments = planted::segments(&scene);
        Self {
            prepared: PreparedSegments::new(&scene, &segments),
            scene,
            segments,
            params: MatchParams::default(),
            fitting: Lines3dParams::default(),
        }
    }

    /// The context of a first pass.
    pub(super) fn context(&self) -> MatchContext<'_> {
        let params = (&self.params, &self.fitting);
        MatchContext::of_planted(&self.scene, &self.segments, &self.prepared, params)
    }
}
