//! Planes that may be roofs, each with what speaks for it.
//!
//! ```text
//! photoconsistency   how well views agree on a plane
//! terrain            height of the ground
//! half_planes        planes beside lines, by homography sweep      B99 4.1
//! grouping           lines and half-planes that share a plane      B99 4.2
//! hypotheses         planes with regions, photo-consistency and lines, ready to compete
//! dense              planes from dense matching and point clouds   B99 2
//! coplanar           sets of coplanar lines and their polygons     B99 2, 5
//! adjacency          corners with edges and regions                B99 2
//! objectspace        regions, directions, clusters, rectangles     W96
//! ```
//!
//! Invariant: which plane covers which part of the plan is not decided here, but in
//! [`crate::roofs::facets`].

pub mod adjacency;
pub mod coplanar;
pub mod dense;
pub mod grouping;
pub mod half_planes;
pub mod hypotheses;
pub mod objectspace;
pub(crate) mod photoconsistency;
#[cfg(test)]
pub(crate) mod rendered_planes;
pub mod terrain;
