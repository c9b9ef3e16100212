//! From 3D lines to facets (B99 4): half-planes by homography sweep (4.1), grouping (4.2),
//! delineation and verification (4.3).
//!
//! A 3D line leaves one parameter of a plane through it open, the angle theta. Each side of the line is
//! swept apart: the neighbourhood in the most textured view is compared with every other view under the
//! homographies `H(theta)`, and a distinct maximum of `Sim(theta)` makes a half-plane. Half-planes and lines are
//! then grouped into planes, and the planes compete for the cells into which all border lines cut the plan.
//!
//! ```text
//! 4.1  poi            points of interest of a view
//!      strip          the neighbourhood of a line side, and how a view is warped into it
//!      windows        correlations of all windows of two strips by running sums
//!      similarity     Sim(theta) of one line side, view by view
//!      peak           parabola, uncertainty and acceptance of a maximum
//!      posterior      probability density over theta, and of a plane at all (B99 5)
//!      sweep          the search over theta
//!      trace          what the page draws (B99 figures 12 and 14)
//! 4.2  neighbourhood  Delaunay triangulation constrained to the projected lines
//!      grouping       collinear and coplanar grouping (figures 16 to 18)
//!      line_pairs     planes of two lines without a half-plane
//!      repeated       half-planes that repeat a plane next to them, where texture is weak
//!      proposed       planes of the other method beside the groups
//!      region         the part of the plan that a group may cover
//!      plane_lines    new lines in a plane from segments of several views
//!      bounding       which real lines may bound a facet
//!      borders        border lines, new lines by plane intersection (figures 19 to 22)
//!      extent         closing lines where the views cease to agree on a plane
//! 4.3  arrangement    the plan cut into cells by the border lines
//!      box_sum        sums over windows
//!      agreement      correlations of several views of a plane by running sums
//!      consistency    similarity of a plane over the complete image set
//!      hypothesis     planes with their regions, similarity and lines, ready to compete
//!      shiftable      windows that stay on one side of a line
//!      evidence       what images and lines say for each plane over each cell
//!      line_index     which real lines run along a border
//!      border_cost    what a border between two planes costs
//!      labelling      conflicts: which plane covers which cell
//!      cut            one step of it: the best of all moves to one plane
//!      flow           the maximum flow behind it
//!      islands        patches too small to be a facet or a hole
//!      delineation    closed outlines
//!      interior       what the inside of a facet shows, away from its edges
//!      prominence     the facet against its own plane moved up and down
//!      vegetation     how green a facet is
//!      verification   what a facet must show to stay
//!      overreach      what it covers beyond a line that bounds it
//!      facets         the labelling on its way to facets; orders 4.2 and 4.3
//! ```

mod borders;
mod competing_planes;
mod delineation;
mod evidence;
mod input;
mod islands;
mod labelling;
mod reconstruct;
mod verification;

pub use borders::{Border, BorderKind};
pub use input::RoofEvidence;
pub use reconstruct::{FacetTrace, reconstruct_facets};
pub use verification::{FacetRejection, RejectedFacet};
