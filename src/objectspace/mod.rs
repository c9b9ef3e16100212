//! The object-space method (W96).

pub mod clusters;
pub mod directions;
pub mod oris;
pub mod sight;
