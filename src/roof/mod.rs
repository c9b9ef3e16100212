//! The roof model in which all methods end: planar facets, buildings, solids down to the ground.

mod ground;
mod invariants;
mod model;
mod new_lines;
mod occluders;
mod reconstruct;
mod refine;
mod refuted;
mod repeated;
mod roof_evidence;
mod solid;
mod surfaces;

pub use ground::Ground;
pub use invariants::{PLANAR_M, Violation, check_invariants};
pub use model::{Building, Facet, RoofModel, Solid, SolidFace, Surface};
pub use occluders::Occluders;
pub use reconstruct::{RoofTrace, Unrefined, reconstruct_roofs};
pub use refine::{
    BuildingRefinement, Parting, RefineRefusal, RefineTrace, RelationKind, SideKind,
    TestedRelation, part_roofs, refine_roofs,
};
pub use refuted::judge_lines;
pub use roof_evidence::RoofEvidence;
pub use solid::{SolidRejection, SolidTrace, WELD_M, close_buildings};
