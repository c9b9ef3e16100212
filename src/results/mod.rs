//! What is handed on: textures, files, the roof report, figures.
//!
//! ```text
//! texture       best view of each face, one atlas
//! roof_report   areas, slopes, edges, volumes, with standard deviations
//! export        files
//! figures       what live figures show and no trace holds
//! ```

pub mod export;
pub mod figures;
pub mod roof_report;
pub mod texture;
