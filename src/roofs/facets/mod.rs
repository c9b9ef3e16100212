//! From planes to facets: delineation and verification (B99 4.3).
//!
//! Planes compete for the cells into which all border lines cut the plan. Each step of the paper is
//! kept, but conflicts are solved by one labelling instead of pair by pair.
//!
//! ```text
//! input             the results of the stages before
//! dominated         planes that a stronger one explains are left out
//! refitting         planes fitted to the points of a cloud that speak for them
//! borders           border lines, the cells between them, and what a border costs
//! evidence          the data term: photo-consistency and lines for each plane over each cell
//! islands           patches too small to be a facet or a hole
//! delineation       closed outlines
//! outlines          outlines with the corners that roofs have
//! competing_planes  the planes with their maps and lines, by which facets are measured
//! verification      the tests that a facet must pass
//! point_cloud       points of a cloud, in nats
//! register          footprints of a register, in nats; each compared with the model
//! compete           what is measured on the planes of groups
//! reconstruct       the stage of facets: orders B99 4.3
//! ```
//!
//! Invariant: facets are delineated as unions of cells of one subdivision of the plan, so that they
//! share exact edges and never overlap; simpler outlines keep both.
//!
//! Invariant: a plane that fails verification over some cells never covers them again.

mod borders;
mod compete;
mod competing_planes;
mod delineation;
mod dominated;
mod evidence;
mod input;
mod islands;
mod outlines;
mod point_cloud;
mod reconstruct;
mod refitting;
mod register;
mod verification;

pub use borders::{Border, BorderKind};
pub(crate) use compete::FINEST_CELL_M;
pub use compete::{GroupingTrace, competing_planes};
pub use competing_planes::CompetingPlanes;
pub use input::{FacetInput, PlacedCloud};
pub(crate) use point_cloud::CloudEvidence;
pub use reconstruct::{FacetTrace, RoofTrace, reconstruct_roofs};
pub use register::{FootprintFinding, FootprintVerdict, RegisterTrace};
pub use verification::{FacetRejection, RejectedFacet};
pub(crate) use verification::{PartVisibility, largest_slope, windows_inside};
