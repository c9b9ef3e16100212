//! From facets to buildings (B99 4.2, 4.3, figure 24; section 2 for refinement).
//!
//! ```text
//! rectangles   chosen planes of W96 -> closed buildings
//! refinement   the stage: closed buildings -> refined ones
//! refine       adjusts the wireframe of each building to the image edges of all views
//! parapets     roofs below the parapets that bound them
//! other_ground buildings below which the images contradict a terrain model
//! uncovered    where a roof may be and the model has none
//! model_lines  lines that the finished model contradicts, duplicates and new lines
//! ```
//!
//! Invariant: every facet of the result belongs to one building whose solid is closed.

mod model_lines;
mod other_ground;
mod parapets;
mod rectangles;
mod refine;
mod refinement;
mod uncovered;

pub use model_lines::VerifiedLines;
pub use other_ground::{OtherGround, other_ground};
pub use parapets::Parapet;
pub use rectangles::roofs_of_rectangles;
#[cfg(test)]
pub(crate) use refine::gable;
pub use refine::{
    BuildingRefinement, RefineRejection, RelationKind, RoofGap, SideKind, Statement,
    TestedRelation, adjust_to_statements, cut_back_at_gaps, refine_roofs,
};
pub(crate) use refinement::refine_buildings;
pub use refinement::{RefinementTrace, UnrefinedFacets};
pub(crate) use uncovered::ASKED_PROBABILITY;
pub use uncovered::{UncoveredRoof, WhyUncovered, uncovered_roofs};
