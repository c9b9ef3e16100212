//! # ridgeline
//!
//! Three or more calibrated aerial photographs in, textured 3D roof models out.
//!
//! ```
//! use ridgeline::orienting::synthetic::{gable_scene, to_files};
//! use ridgeline::{InputFile, LoadOptions, Params, Run, load_scene};
//!
//! // Photographs of a drawn house with their orientation, as files in memory.
//! let (drawn, truth) = gable_scene(320);
//! let files = to_files(&drawn).into_iter();
//! let files: Vec<InputFile> = files.map(|(path, bytes)| InputFile::new(&path, bytes)).collect();
//!
//! let scene = load_scene(&files, &LoadOptions::default())?;
//! let mut run = Run::new(scene, Params::default());
//! run.run_all();
//!
//! // CityJSON, glTF, lines and more, by name; and the model itself.
//! assert!(run.files(&[]).iter().any(|(name, _)| name == "model.city.json"));
//! let model = run.results().roof_model().expect("all stages have run");
//! assert_eq!(model.facets.len(), truth.facets.len());
//! # Ok::<(), ridgeline::Error>(())
//! ```
//!
//! A stage is run by itself with [`Run::step`]; its result and its trace stand in [`Results`]:
//!
//! ```
//! use ridgeline::orienting::synthetic::gable_scene;
//! use ridgeline::{Params, Run, Stage, silent};
//!
//! let mut run = Run::new(gable_scene(320).0, Params::default());
//! run.step(Stage::Segments, &silent());
//! let segments = run.results().segments.as_ref().expect("the stage has run");
//! println!("{} segments in the first view", segments.value[0].len());
//! ```
//!
//! Implements B99 (Baillard, Schmid, Zisserman, Fitzgibbon 1999, "Automatic line matching and 3D
//! reconstruction of buildings from multiple views") and W96 (Wiman, Axelsson 1996, "Finding
//! 3D-structures in multiple aerial images using lines and regions").
//!
//! ```text
//! base          numbers, geometry, parameters, evidence in nats
//! photographs   pixels and cameras
//! orienting     files into a Scene { views, known }; photographs alone into their orientation
//! lines         lines2d -> linematch -> lines3d -> adjustment              B99 3
//! planes        terrain; half_planes -> grouping -> hypotheses             B99 4.1, 4.2
//!               dense, coplanar, adjacency                                 B99 2
//!               objectspace: regions, directions, clusters, rectangles     W96 3.3 - 3.6
//! roofs         facets -> buildings, solids -> corrections -> walls        B99 4.3, 2
//! results       texture -> export, roof_report, figures
//! pipeline      the order of the stages;  tiles: large areas in pieces
//! ```
//!
//! A group calls the groups above it in this list, never those below.
//!
//! Each stage is one function from typed input to `(value, trace)`; the trace holds what a figure
//! of it shows, and why each hypothesis was rejected. [`pipeline`] alone orders the stages.
//!
//! Invariant: no file system, no terminal and no clock here; files are bytes with names.
//! Invariant: the same input and parameters give the same bytes, natively and in wasm, on one
//! worker or many.

#![warn(unreachable_pub)]
// Of the page's second module most is dead, and left out when it is linked.
#![cfg_attr(not(feature = "reconstruction"), allow(dead_code, unused_imports))]

pub mod base;
pub mod lines;
pub mod orienting;
pub mod photographs;
pub mod pipeline;
pub mod planes;
pub mod results;
pub mod roofs;
pub mod tiles;
#[cfg(target_arch = "wasm32")]
pub mod wasm;

pub use crate::base::error::{Error, Result};
pub use crate::base::execution::progress::{Listener, silent};
pub use crate::base::params::{Method, Params};
pub use crate::orienting::orientation::InputFile;
pub use crate::orienting::scene::{Scene, View};
pub use crate::orienting::scene_loader::{LoadOptions, inspect_files, load_scene};
pub use crate::pipeline::{Results, Run, Stage, StageSummary};
