//! Readers of orientation files.

mod angles;

pub use angles::{omega_phi_kappa_from_rotation, rotation_from_omega_phi_kappa};
