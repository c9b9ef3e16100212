//! Facets, buildings, corners and edges by their place.

use nalgebra::{Point2, Point3};

use super::draft::{At, Draft};
use super::outcome::NotApplied;
use crate::base::geometry::Segment3;
use crate::base::line_linker::LineLinker;
use crate::base::params::FacetPlace;
use crate::roofs::model::Facet;

/// A facet whose plane passes a place within this distance in height is the one that was meant,
/// metres. Assumption: less than a storey, more than runs differ by.
const SAME_HEIGHT_M: f64 = 1.0;
/// ... if its normal differs by no more than this, degrees. Assumption.
const SAME_NORMAL_DEG: f64 = 15.0;
/// The corner nearest to a place is meant within this distance, metres. Assumption.
const SAME_CORNER_M: f64 = 0.5;

/// A corner of a facet; it counts through the rings of the facet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Corner {
    pub of: At,
    pub corner: usize,
}

impl Draft {
    /// The facet at a place.
    pub(super) fn facet(&self, place: &FacetPlace) -> Result<At, NotApplied> {
        let at = self
            .facet_below(&place.at.xy())
            .ok_or(NotApplied::NoFacet)?;
        let plane = &self.get(at).facet.plane;
        let rise = plane.z_at(place.at.x, place.at.y) - place.at.z;
        // What is no number is refused.
        let is_same_height = rise.abs() <= SAME_HEIGHT_M;
        if !is_same_height {
            return Err(NotApplied::OtherHeight);
        }
        let angle = crate::base::math::atan2(
            plane.normal.cross(&place.normal).norm(),
            plane.normal.dot(&place.normal),
        );
        if !(angle.to_degrees() <= SAME_NORMAL_DEG && place.normal.norm() > 0.0) {
            return Err(NotApplied::OtherSlope);
        }
        Ok(at)
    }

    /// The facet that covers a plan position.
    pub(super) fn facet_below(&self, p: &Point2<f64>) -> Option<At> {
        let mut covering = self.facets().filter(|(_, f)| f.facet.covers(p));
        covering.next().map(|(at, _)| at)
    }

    /// The building at a place.
    pub(super) fn house(&self, place: &Point3<f64>) -> Result<usize, NotApplied> {
        let found = self.facet_below(&place.xy());
        found.map(|at| at.house).ok_or(NotApplied::NoBuilding)
    }

    /// The corner at a place.
    pub(super) fn corner(&self, place: &Point3<f64>) -> Result<Corner, NotApplied> {
        let mut nearest: Option<(f64, Corner)> = None;
        for (of, f) in self.facets() {
            for (corner, p) in corners(&f.facet).enumerate() {
                let distance = (p - place).norm();
                if distance <= SAME_CORNER_M && nearest.is_none_or(|(least, _)| distance < least) {
                    nearest = Some((distance, Corner { of, corner }));
                }
            }
        }
        nearest.map(|(_, c)| c).ok_or(NotApplied::NoCorner)
    }

    /// The sides of facets of one building that lie on an edge: pairs of corners.
    pub(super) fn edge(&self, ends: &[Point3<f64>; 2]) -> Result<Vec<[Corner; 2]>, NotApplied> {
        let edge = Segment3::new(ends[0], ends[1]);
        let linker = LineLinker::named_edge();
        let lies_on = |p: &Point3<f64>| linker.passes(ends, p);
        let mut found: Vec<[Corner; 2]> = Vec::new();
        for (of, f) in self.facets() {
            let mut first = 0;
            for ring in f.facet.rings() {
                for (i, p) in ring.iter().enumerate() {
                    let next = (i + 1) % ring.len();
                    // A side whose ends are one place of the edge does not lie along it.
                    let is_along = (ring[next] - p).dot(&edge.direction()).abs() > linker.beyond;
                    if is_along && lies_on(p) && lies_on(&ring[next]) {
                        found.push([first + i, first + next].map(|corner| Corner { of, corner }));
                    }
                }
                first += ring.len();
            }
        }
        let house = found.first().map(|side| side[0].of.house);
        found.retain(|side| Some(side[0].of.house) == house);
        match found.is_empty() {
            true => Err(NotApplied::NoEdge),
            false => Ok(found),
        }
    }

    /// Where a corner is.
    pub(super) fn position(&self, corner: Corner) -> Point3<f64> {
        let mut all = corners(&self.get(corner.of).facet);
        *all.nth(corner.corner).expect("a corner of the facet")
    }
}

/// The corners of a facet through its rings.
pub(super) fn corners(facet: &Facet) -> impl Iterator<Item = &Point3<f64>> {
    facet.rings().flatten()
}
