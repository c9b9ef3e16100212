//! The cost of all observations of a block, used or not, which compares blocks that differ in their
//! outliers.

use super::normal_equations::LOSS;
use crate::base::math::SURE_RESIDUAL_SIGMAS;
use crate::orienting::structure_from_motion::block::Block;

/// Robust sum of squares of all observations in registered photographs, standard deviations a
/// `factor` less than those of the block; one that is no ray of a point costs as much as an
/// outlier.
pub(in super::super) fn truncated_cost(block: &Block, factor: f64) -> f64 {
    let mut sum = 0.0;
    for track in &block.tracks {
        for o in &track.observations {
            if block.photos[o.photo].pose.is_some() {
                let residual = (track.point).map_or(f64::INFINITY, |p| block.residual(o, &p));
                let residual = (factor * residual).min(SURE_RESIDUAL_SIGMAS);
                sum += LOSS.cost(residual * residual);
            }
        }
    }
    sum
}
