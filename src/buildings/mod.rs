//! The roof model in which all methods end: planar facets, buildings, solids down to the ground.

mod model_lines;
mod reconstruct;
mod refine;

pub use model_lines::judge_lines;
pub use reconstruct::{RoofTrace, Unrefined, reconstruct_roofs};
#[cfg(test)]
pub(crate) use refine::gable;
pub use refine::{
    BuildingRefinement, Parting, RefineRefusal, RefineTrace, RelationKind, SideKind,
    TestedRelation, part_roofs, refine_roofs,
};
