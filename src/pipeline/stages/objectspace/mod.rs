//! The stages of W96.

pub(super) mod clusters;
pub(super) mod directions;
pub(super) mod rectangles;
pub(super) mod regions;
