//! What is read: orientations, photographs, terrain, footprints and point clouds, as programs and
//! people write them.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
mod file_names;
mod flight_plan;
mod images;
mod known;
mod lenses;
mod lists;
mod orientation_check;
mod orientation_files;
#[path = "../common/tiff.rs"]
mod planted_tiff;
mod point_cloud;
mod readers;
mod tiff;
mod tiff_heads;
