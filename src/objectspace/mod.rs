//! The object-space method (W96).

pub mod oris;
