//! Which plane, if any, covers each cell of the plan (B99 4.3: delineation, verification and
//! conflicts).
//!
//! B99 closes an outline per plane, verifies it over the images and resolves conflicts between
//! overlapping faces one pair at a time by S(P) = area x share of real lines. Here the same
//! evidence competes at once, cell by cell, as the least of
//!
//! ```text
//! E(l) = sum_cells D(cell, l)  +  sum_edges length x V(edge, l, l')
//! ```
//!
//! D is minus what the images say of the plane against "no plane" (0), nats. V is small where a
//! reconstructed line or the intersection of the two planes supports the border, so outlines follow
//! real lines (tau_real) and area counts as in S(P). The minimum is found by alpha-expansion
//! (Boykov, Veksler, Zabih 2001), each expansion a minimum cut. The patches of dense matching get
//! their planes in the same way.
//!
//! ```text
//! energy     data and border terms
//! graph      cells, their neighbours, and the planes that may cover them
//! flow       maximum flow
//! cut        one expansion as a minimum cut
//! expansion  expansions until none improves
//! ```
//!
//! Invariant: nothing here knows geometry; cells, planes and edges are indices.

mod cut;
mod energy;
mod expansion;
mod flow;
mod graph;

pub(crate) use energy::{Energy, NO_PLANE, PairwiseCosts};
pub(crate) use expansion::Labelling;
