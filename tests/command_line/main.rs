//! The command line and the examples as a user meets them.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
mod corrections;
mod examples;
mod orient;
mod plan_tile_join;
#[path = "../common/tiff.rs"]
mod planted_tiff;
mod reconstruct;
