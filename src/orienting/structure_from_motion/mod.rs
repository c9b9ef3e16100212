//! Structure from motion: photographs alone in, their orientation out.
//!
//! ```text
//! metadata       focal length, position, angles from EXIF and XMP
//! features       keypoints and descriptors (SIFT)
//! matching       pairs of photographs, and which keypoints of them correspond
//!    -> verification   two_view: essential matrix, homography or rotation of each pair
//!    -> tracks         matches joined over all photographs
//!    -> incremental    a first pair; resection, triangulation, bundle, outliers, photo by photo
//!    -> frame          metres and Z up; by ground_control where points are known
//!    -> output         COLMAP's text model, the report
//!
//! block          photographs, cameras, tracks: what the steps above change
//! intrinsics     f, cx, cy, k1, k2
//! robust         estimation by likelihood; linear, random, similarity, similarity_fit
//! ```
//!
//! Invariant: the same photographs give the same bytes, natively and in wasm, on any number of
//! threads. Invariant: a photograph without orientation is named with the reason.

mod block;
mod bundle;
mod features;
mod frame;
mod ground_control;
mod incremental;
mod intrinsics;
mod linear;
mod matching;
mod metadata;
mod orient;
mod output;
mod random;
mod resection;
mod robust;
mod similarity;
mod similarity_fit;
#[cfg(test)]
mod tests;
mod tracks;
mod triangulation;
mod two_view;
mod verification;

pub use block::Pose;
pub use features::FeatureOptions;
pub use frame::{FrameBasis, Lag};
pub use ground_control::{ControlPoint, ControlResidual, GeoList, GroundControl, Role};
pub use intrinsics::Intrinsics;
pub use metadata::PhotoMetadata;
pub use orient::{
    OnBlock, OrientChain, OrientOptions, Oriented, PairSummary, ReadPhoto, Snapshot, SnapshotPhoto,
    orient,
};
pub use output::{
    CameraReport, ControlSheet, CoveredCell, LeftOut, MeasuredLength, NotJoined, NotMeasured,
    OrientReport, OrientedPhoto, PhotoReport, PlanCoverage, ProposedPhoto, SparseModel,
    SparsePoint,
};
pub use similarity_fit::KnownOf;
pub use two_view::PairKind;
