//! Least squares: unknowns x whose residuals r_i, in standard deviations, cost least.
//!
//! ```text
//! cost(x) = sum rho(|r_i|^2)                             rho: squares, Cauchy's, Huber's
//! N = sum w_i J_i' J_i,   g = sum w_i J_i' r_i           w_i = rho'(|r_i|^2),  J_i = dr_i / dx
//! (N + damping diag N) step = -g                         Levenberg-Marquardt (Marquardt 1963)
//! C = s^2 N^-1                                           s^2: variance of unit weight
//! ```
//!
//! ```text
//! loss         rho and its weight
//! minimise     the steps: damping, and when they end
//! normal       N and g of few unknowns and of many
//! cholesky     N of many unknowns: factor, solution, inverse
//! covariance   whitening, and the variance of unit weight
//! differences  for tests: a Jacobian against central differences
//! ```
//!
//! Weights are those of Triggs et al. 2000 ("Bundle adjustment - a modern synthesis", 3.2) without
//! the second derivative of rho, so that N stays positive definite. A problem is a file beside its
//! subject: what its residuals are, and where a step leads.

mod cholesky;
mod covariance;
#[cfg(test)]
mod differences;
mod loss;
mod minimise;
mod normal;

pub(crate) use cholesky::{Envelope, Pattern};
pub(crate) use covariance::{variance_of_unit_weight, whitening};
#[cfg(test)]
pub(crate) use differences::worst_derivative;
pub(crate) use loss::Loss;
pub(crate) use minimise::{Equations, Problem, Stop, fit, minimise};
pub(crate) use normal::{EnvelopeEquations, NormalEquations};
