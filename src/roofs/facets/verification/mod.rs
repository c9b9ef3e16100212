//! Verification (B99 4.3): is a facet likelier true than false?
//!
//! Where a facet must lie to be a roof at all is geometry: high enough above the ground, and not
//! too small. Everything else that speaks for it or against it is measured and weighed once, by one
//! model ([`crate::base::evidence`]).
//!
//! ```text
//! rejection         why facets are rejected
//! features          what is measured of a facet
//! interior          photo-consistency inside a facet, away from its edges
//! displaced_plane   the facet against its own plane moved up and down
//! ```

mod displaced_plane;
mod features;
mod interior;
mod rejection;

pub(crate) use displaced_plane::{PartVisibility, largest_slope};
pub(crate) use features::Measured;
pub(crate) use interior::windows_inside;
pub use rejection::{FacetRejection, RejectedFacet};

use std::collections::BTreeSet;

use super::borders::Arrangement;
use super::competing_planes::CompetingPlanes;
use super::delineation::Outline;
use super::point_cloud::CloudEvidence;
use super::register::RegisterEvidence;
use crate::base::evidence::{Evidence, EvidenceModel, WindowCounts};
use crate::base::geometry::{Plane, mean_point};
use crate::base::params::RoofParams;
use crate::orienting::scene::Scene;
use crate::planes::terrain::Ground;
use crate::roofs::model::{Facet, Occluders};

/// Share of a facet that may lie on the ground for the rest to be a roof still: a corner drawn too
/// far. Assumption: of a bank that rises to the height of an eave more lies lower.
const MOST_ON_GROUND: f64 = 0.15;

/// Is a facet large enough, and as high above the ground as roofs are?
fn is_placed_like_a_roof(
    facet: &Facet,
    ground: &Ground,
    params: &RoofParams,
) -> Result<(), FacetRejection> {
    let area_m2 = facet.sloped_area();
    if area_m2 < params.min_area_m2 {
        return Err(FacetRejection::TooSmall { area_m2 });
    }
    let heights = facet.outer.iter().map(|p| p.z - ground.z_at(&p.xy()));
    let lowest_m = heights.fold(f64::INFINITY, f64::min);
    if lowest_m < params.min_height_m {
        let height_m = height_above(facet, ground);
        return Err(match height_m < params.min_height_m {
            true => FacetRejection::NearGround { height_m },
            false => FacetRejection::ReachesGround { lowest_m },
        });
    }
    Ok(())
}

/// Height of a facet's middle above the ground, metres.
fn height_above(facet: &Facet, ground: &Ground) -> f64 {
    let middle = mean_point(&facet.outer);
    middle.z - ground.z_at(&middle.xy())
}

/// The cells of a facet that come down to the ground, where these are few: without them it may be a
/// roof.
pub(crate) fn tail_on_ground(
    plane: &Plane,
    cells: &[usize],
    arrangement: &Arrangement,
    ground: &Ground,
    lowest_eave_m: f64,
) -> Option<Vec<usize>> {
    let of_facet: BTreeSet<usize> = cells.iter().copied().collect();
    let on_ground = |corners: &[usize; 3]| {
        let mut corners = corners.iter().map(|&v| arrangement.vertices[v]);
        corners.any(|p| plane.z_at(p.x, p.y) - ground.z_at(&p) < lowest_eave_m)
    };
    let low: BTreeSet<usize> = (arrangement.triangles.iter())
        .filter(|(corners, cell)| of_facet.contains(cell) && on_ground(corners))
        .map(|(_, cell)| *cell)
        .collect();
    let area =
        |cells: &BTreeSet<usize>| -> f64 { cells.iter().map(|&c| arrangement.areas[c]).sum() };
    let few = area(&low) < MOST_ON_GROUND * area(&of_facet);
    (few && !low.is_empty()).then(|| low.into_iter().collect())
}

/// A facet that lies like a roof, with what speaks for it.
pub(crate) struct VerifiedFacet {
    /// What speaks for it and against it.
    pub evidence: Evidence,
    /// What was measured of it.
    pub measured: Measured,
}

impl VerifiedFacet {
    /// How the views agree inside it.
    pub(super) fn windows(&self) -> &WindowCounts {
        &self.measured.windows
    }
}

/// What facets are verified by besides how the views agree on them.
#[derive(Clone, Copy)]
pub(crate) struct KnownEvidence<'a> {
    /// The photographs as they were taken.
    pub colours: &'a Scene,
    /// A register that counts.
    pub register: Option<&'a RegisterEvidence<'a>>,
    /// A point cloud that counts.
    pub cloud: Option<&'a CloudEvidence>,
}

/// Verifies a facet between the other facets and over the ground. A register and a cloud add terms
/// of their own; `before` is what was measured of the same cells before.
pub(crate) fn verify(
    competing: &CompetingPlanes,
    (facet, outline): (&Facet, &Outline),
    occluders: &Occluders,
    ground: &Ground,
    known: &KnownEvidence,
    before: Option<&Measured>,
    params: &RoofParams,
) -> Result<VerifiedFacet, FacetRejection> {
    is_placed_like_a_roof(facet, ground, params)?;
    let measured = Measured::of(competing, facet, outline, occluders, known.colours, before);
    let mut evidence = EvidenceModel::of_facets().weigh(&measured.features);
    let terms = &mut evidence.terms;
    terms.extend(known.register.map(|r| r.of_facet(facet)));
    terms.extend(known.cloud.map(|c| c.of_facet(facet)));
    Ok(VerifiedFacet { evidence, measured })
}

#[cfg(test)]
mod tests {
    use super::super::borders::{Border, BorderKind};
    use super::*;
    use crate::base::geometry::sides;
    use nalgebra::{Point3, Vector3};

    /// A plan of 30 m by 30 m, cut by lines across at these x.
    fn cut_at(places: &[f64]) -> Arrangement {
        let border = |a: [f64; 2], b: [f64; 2]| Border {
            kind: BorderKind::Real,
            a: a.into(),
            b: b.into(),
        };
        let corners = [[-10.0, -10.0], [20.0, -10.0], [20.0, 20.0], [-10.0, 20.0]];
        let frame = sides(&corners).map(|[a, b]| border(a, b));
        let cuts = places.iter().map(|&x| border([x, -10.0], [x, 20.0]));
        Arrangement::new(&frame.chain(cuts).collect::<Vec<_>>())
    }

    #[test]
    fn a_roof_loses_the_tail_that_comes_down_to_the_ground_and_a_bank_all() {
        // It falls from 9 m at x = 0 to 1 m at x = 8; above the ground at 2 m, its lowest eave is
        // at x = 6.
        let slope =
            Plane::from_point_normal(&Point3::new(0.0, 0.0, 9.0), &Vector3::new(1.0, 0.0, 1.0));
        let slope = slope.expect("a normal");
        let arrangement = cut_at(&[0.0, 5.0, 5.8, 6.2, 8.0]);
        let ground = Ground::level(2.0);
        let mut cells: Vec<usize> = (0..arrangement.cells).collect();
        let middle = |cell: usize| {
            let of = arrangement.triangles.iter().filter(|t| t.1 == cell);
            let xs: Vec<f64> = of
                .flat_map(|t| t.0.map(|v| arrangement.vertices[v].x))
                .collect();
            xs.iter().sum::<f64>() / xs.len() as f64
        };
        cells.sort_by(|a, b| middle(*a).total_cmp(&middle(*b)));
        let tail = |cells: &[usize]| tail_on_ground(&slope, cells, &arrangement, &ground, 1.0);
        assert_eq!(tail(&cells[1..3]), None, "all of it is high");
        assert_eq!(
            tail(&cells[1..4]),
            Some(vec![cells[3]]),
            "0.4 of 6.2 m reach below"
        );
        assert_eq!(tail(&cells[1..5]), None, "2.2 of 8 m are too much");
    }
}
