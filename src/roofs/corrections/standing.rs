//! What stands on a facet, deleted and added.

use nalgebra::{Point2, Point3};

use super::draft::Draft;
use super::outcome::NotApplied;
use super::shape::{FARTHEST_COORDINATE_M, expect_outline};
use crate::base::geometry::{Polygon, mean_point};
use crate::roofs::model::{Obstruction, WELD_M, is_simple};

/// Least area of what stands on a facet, from above, m^2. Assumption: a pipe.
const LEAST_AREA_M2: f64 = 0.01;

pub(super) fn delete_obstruction(draft: &mut Draft, at: &Point3<f64>) -> Result<(), NotApplied> {
    let stands_there = |o: &Obstruction| Polygon::from(o.outline.clone()).contains(&at.xy());
    let facet = draft.facet_below(&at.xy()).ok_or(NotApplied::NoFacet)?;
    let all = &mut draft.facet_mut(facet).obstructions;
    let found = all.iter().position(stands_there);
    all.remove(found.ok_or(NotApplied::NoObstruction)?);
    Ok(())
}

/// Puts something onto the facet below its middle, as far as it lies over that facet. What was
/// found at its place is this.
pub(super) fn add_obstruction(
    draft: &mut Draft,
    outline: &[Point3<f64>],
    height_m: f64,
) -> Result<(), NotApplied> {
    expect_outline(outline)?;
    // What is no number is refused.
    let is_plausible = (WELD_M..FARTHEST_COORDINATE_M).contains(&height_m);
    if !is_plausible {
        return Err(NotApplied::Implausible);
    }
    let plan: Vec<Point2<f64>> = outline.iter().map(Point3::xy).collect();
    if !is_simple(&plan) {
        return Err(NotApplied::NoRoom);
    }
    let below = draft.facet_below(&mean_point(outline).xy());
    let below = below.ok_or(NotApplied::NoFacet)?;
    let facet = draft.facet_mut(below);
    let on_facet = Polygon::from(plan).and(&facet.plan());
    let parts = on_facet.rings.into_iter().map(|outline| Obstruction {
        outline,
        height_m,
        height_sigma_m: None,
        probability: 1.0,
    });
    let area = |o: &Obstruction| Polygon::from(o.outline.clone()).area();
    let largest = parts.max_by(|a, b| area(a).total_cmp(&area(b)));
    let added = largest.filter(|o| area(o) >= LEAST_AREA_M2);
    let added = added.ok_or(NotApplied::NoRoom)?;
    facet.obstructions.retain(|o| !o.shares_its_place(&added));
    facet.obstructions.push(added);
    Ok(())
}
