//! The command line and the examples as a user meets them.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used)]

mod cases;
#[path = "../common/mod.rs"]
mod common;
mod corrections;
mod examples;
mod flight;
mod options;
mod orient;
mod plan_tile_join;
#[path = "../common/tiff.rs"]
mod planted_tiff;
mod reconstruct;
mod report;

/// What a program has printed that was to succeed.
fn printed(output: &std::process::Output) -> String {
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}
