//! The roof model in which all methods end: planar facets, buildings, solids down to the ground.
//!
//! ```text
//! roof_model  facets, buildings and their closed solids
//! invariants  what every model must fulfil
//! triangulate triangles of a planar face
//! uncertainty standard deviations of facets, corners and sides
//! walls       where walls stand below the roof
//! visibility  occlusion of points by roofs
//! ```
//!
//! Invariant: [`check_invariants`] finds nothing in a model of any method.

mod invariants;
mod roof_model;
mod triangulate;
mod uncertainty;
mod visibility;
mod walls;

pub(crate) use invariants::is_simple;
pub use invariants::{PLANAR_M, Violation, check_invariants};
pub use roof_model::{Building, Facet, Obstruction, RoofModel, Solid, SolidFace, Surface, WELD_M};
pub use triangulate::triangulate;
pub use uncertainty::{CornerUncertainty, FacetUncertainty, SideSupport, SideUncertainty};
pub use visibility::Occluders;
pub use walls::{BuildingWalls, Wall};
