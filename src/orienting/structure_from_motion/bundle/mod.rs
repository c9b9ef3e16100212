//! Bundle adjustment with self-calibration: poses, points, and the parameters that the photographs
//! of a camera share (Triggs et al. 2000, "Bundle adjustment - a modern synthesis").
//!
//! ```text
//! options               what is free, how long, and priors
//! normal_equations      linearised observations; points eliminated by the Schur complement
//! steps                 where a step of all unknowns leads
//! truncated             the cost of all observations, to compare blocks
//! covariance            of the unknowns, in the datum of the projection centres
//! ```
//!
//! Cauchy's loss. Points are divided into a fixed number of shards, whose sums
//! are added in their order, so that threads never change a result.

mod covariance;
mod normal_equations;
mod options;
mod steps;
mod truncated;

pub(super) use covariance::{Covariance, covariance};
pub(super) use options::BundleOptions;
pub(super) use steps::adjust;
pub(super) use truncated::truncated_cost;

#[cfg(test)]
pub(super) mod tests;
