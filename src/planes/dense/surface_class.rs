//! What a surface is: building, ground or vegetation (B99 2: ENST identifies the buildings among
//! the surfaces of dense matching).
//!
//! Two models of evidence, one after the other: is it a building, and where it is none, is it
//! vegetation?

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use super::patch::Patch;
use super::patch_match::PatchGrid;
use super::region::Region;
use crate::base::evidence::{Evidence, EvidenceModel};
use crate::base::math::ln;
use crate::orienting::scene::{Scene, excess_green};
use crate::planes::terrain::Ground;

/// Probabilities of what a surface is; their sum is one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SurfaceClass {
    /// A roof.
    pub building: f64,
    /// Ground: lawn, street, yard.
    pub ground: f64,
    /// A crown, a hedge, or what else stands on the ground.
    pub vegetation: f64,
}

impl SurfaceClass {
    /// Is it likelier a roof than not?
    pub fn is_building(&self) -> bool {
        self.building >= 0.5
    }
}

/// What speaks for a class, and against it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SurfaceEvidence {
    /// For a building rather than ground or vegetation.
    pub building: Evidence,
    /// For vegetation rather than ground.
    pub vegetation: Evidence,
}

impl SurfaceEvidence {
    /// The probabilities.
    pub fn class(&self) -> SurfaceClass {
        let building = self.building.probability();
        let vegetation = (1.0 - building) * self.vegetation.probability();
        SurfaceClass {
            building,
            ground: 1.0 - building - vegetation,
            vegetation,
        }
    }
}

/// Weighs what a region is.
pub(super) fn weigh(
    region: &Region,
    found: &PatchGrid,
    scene: &Scene,
    ground: &Ground,
    z_per_pixel: f64,
) -> SurfaceEvidence {
    let patches: Vec<&Patch> = (region.cells.iter())
        .filter_map(|&k| found.patches[k].as_ref())
        .collect();
    let count = patches.len().max(1) as f64;
    let mean =
        |value: &dyn Fn(&Patch) -> f64| patches.iter().map(|p| value(p)).sum::<f64>() / count;
    let plane = &region.plane;
    let on_plane: Vec<Point3<f64>> = (patches.iter())
        .map(|p| plane.lift(p.middle.x, p.middle.y))
        .collect();
    let above = |p: &Patch| plane.z_at(p.middle.x, p.middle.y) - ground.z_at(&p.middle);
    let area_m2 = count * found.grid.step * found.grid.step;
    let features = [
        ("height_m", mean(&above)),
        ("roughness_px", region.rms_m / z_per_pixel),
        ("excess_green", excess_green(scene, &on_plane)),
        ("correlation", mean(&|p| f64::from(p.correlation))),
        ("cos_slope", plane.normal.z),
        ("ln_area_m2", ln(area_m2)),
    ];
    SurfaceEvidence {
        building: EvidenceModel::of_buildings().weigh(&features),
        vegetation: EvidenceModel::of_vegetation().weigh(&features),
    }
}
