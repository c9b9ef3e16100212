//! What comes out: the sparse model, and the report on it.

mod assemble;
mod coverage;
mod measure;
mod report;
mod scale;
mod sheet;
mod sparse_model;

use assemble::ARBITRARY_SCALE;
pub(super) use assemble::{Names, report, sparse_model};
pub use coverage::{CoveredCell, PlanCoverage, ProposedPhoto};
pub use measure::{MeasuredLength, NotMeasured};
pub use report::{CameraReport, LeftOut, NotJoined, OrientReport, PhotoReport};
pub use sheet::ControlSheet;
pub use sparse_model::{OrientedPhoto, SparseModel, SparsePoint};
