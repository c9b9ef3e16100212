//! Roofs: which plane covers what, the buildings below, and what a person corrects.
//!
//! ```text
//! model         facets, buildings, invariants
//! solids        closed polyhedra
//! facets        borders, one energy, labelling, delineation, verification    B99 4.2, 4.3
//! obstructions  what stands on a facet
//! buildings     refinement; new, contradicted and duplicate lines            B99 2 to 4
//! corrections   what somebody corrects by hand
//! walls         where walls stand below overhanging eaves
//! ```

pub mod buildings;
pub mod corrections;
pub mod facets;
pub mod model;
pub mod obstructions;
pub mod solids;
#[cfg(test)]
pub(crate) mod testing;
pub mod walls;
