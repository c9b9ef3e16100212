//! planes

mod grouping;
mod half_plane;
mod hypothesis;
mod line_sides;
pub(crate) mod plane_lines;
#[cfg(test)]
pub(crate) mod rendered_planes;
pub(crate) mod single_view;
mod sweep;

pub(crate) use grouping::{
    GroupingInput, MARGIN, Region, add_rectangles, group_planes, group_repeated, line_neighbours,
    with_repeated,
};
pub use grouping::{Member, PlaneGroup, ProposedPlane};
pub use half_plane::HalfPlane;
pub(crate) use half_plane::is_wall;
pub(crate) use hypothesis::{Hypothesis, hypotheses};
pub(crate) use line_sides::{ON_SURFACE, TEXTURED, crosses_surface};
pub use plane_lines::PlaneLine;
pub use sweep::{
    PointsOfInterest, Posterior, SideTrace, SimilarityCurve, SweepRejection, SweepTrace, ViewCurve,
    similarity_curve, sweep_half_planes, sweep_side,
};
