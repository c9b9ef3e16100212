//! # ridgeline
//!
//! Three or more calibrated aerial photographs in, textured 3D roof models out.
//!
//! Implements B99 (Baillard, Schmid, Zisserman, Fitzgibbon 1999, "Automatic line matching and 3D
//! reconstruction of buildings from multiple views") and W96 (Wiman, Axelsson 1996, "Finding
//! 3D-structures in multiple aerial images using lines and regions").
//!
//! ```text
//! images + orientation files
//!    -> orientation, camera     Scene { views, ground }
//!    -> lines2d                 edgels, chains, segments (per view)         B99 3.2
//!    -> linematch               pairs, triples, N views                     B99 3.1 - 3.4
//!    -> lines3d                 3D lines with covariance                    B99 3.2, figure 4
//!    -> halfplane               points of interest, Sim(theta), half-planes B99 4.1
//!    -> roof                    grouping, delineation, verification, walls  B99 4.2, 4.3
//!    or, from the images to the roofs in one go
//!    -> objectspace             regions, main directions, clusters, planes  W96 3.3 - 3.6
//!    or both for one model: lines and planes of objectspace compete in lines3d and roof
//!    -> texture                 best view per face, atlas
//!    -> export                  CityJSON, GLB, JSON
//! ```
//!
//! Each stage is one function from typed input to `(value, Trace)`; the Trace holds what a teacher
//! would draw. [`pipeline`] alone orders the stages.

pub mod adjustment;
pub mod agreement;
pub mod buildings;
pub mod camera;
pub mod error;
pub mod execution;
pub mod export;
pub mod facets;
pub mod figures;
pub mod geometry;
pub mod ids;
pub mod linematch;
pub mod lines2d;
pub mod lines3d;
pub mod math;
pub mod model;
pub mod objectspace;
pub mod orientation;
pub mod orientation_check;
pub mod params;
pub mod photoconsistency;
pub mod pipeline;
pub mod plain_json;
pub mod plan_index;
pub mod planes;
pub mod raster;
pub mod scene;
pub mod scene_loader;
pub mod solids;
pub mod sorting;
pub mod synthetic;
pub mod terrain;
#[cfg(test)]
mod testing;
pub mod texture;
pub mod tiles;
#[cfg(target_arch = "wasm32")]
pub mod wasm;

pub use crate::error::{Error, Result};
