//! What the energy of outlines is made of.

use crate::base::geometry::Plane;
use crate::roofs::facets::borders::{Arrangement, LineIndex};

/// What the energy of outlines is made of.
pub(in crate::roofs::facets) struct OutlineEnergy<'a> {
    /// The cells that the outlines are made of.
    pub arrangement: &'a Arrangement,
    /// The plane of every label.
    pub planes: &'a [Plane],
    /// The reconstructed lines.
    pub lines: &'a LineIndex,
    /// Cost of a metre of border that no line supports, nats.
    pub border_nats_per_m: f64,
    /// What a plane costs in a cell, nats; `None` where it may not cover it.
    pub cost: &'a (dyn Fn(usize, u32) -> Option<f64> + Sync),
}
