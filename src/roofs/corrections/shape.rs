//! Facets deleted, merged, split and added; ground and eaves.

use nalgebra::{Point2, Point3, Vector3};

use super::closing::{closed_over, shared_outline};
use super::draft::{At, Draft, DraftFacet};
use super::outcome::NotApplied;
use super::place::corners;
use crate::base::geometry::{Plane, Polygon, Segment3};
use crate::base::ids::BuildingId;
use crate::base::params::FacetPlace;
use crate::roofs::model::{Facet, is_simple};

/// Least area of a new facet in plan, m^2. Assumption: a roof window.
pub(super) const LEAST_AREA_M2: f64 = 0.25;
/// A drawn corner this near to one of the model is that one, metres. Assumption: a hand does not
/// distinguish them in a photograph.
const SNAP_DISTANCE_M: f64 = 0.3;
/// A line this far off a facet is off it, metres.
pub(super) const OFF_PLANE_M: f64 = 0.02;
/// What is drawn lies no further from the origin of the scene, metres.
pub(super) const FARTHEST_COORDINATE_M: f64 = 1e5;
/// Height of a building where nothing is known of the ground, metres. Assumption: a storey.
const STOREY_M: f64 = 3.0;
/// Weight of a corner that the model has, among those of a drawn facet.
const HELD_WEIGHT: f64 = 1e6;

pub(super) fn delete_facet(
    draft: &mut Draft,
    facet: &FacetPlace,
    filled: Option<bool>,
) -> Result<(), NotApplied> {
    let At { house, facet } = draft.facet(facet)?;
    let facets = &draft.houses[house].facets;
    let left = if filled.unwrap_or_else(|| shared_outline(facets, facet) >= 0.5) {
        closed_over(facets, facet)
    } else {
        without(facets, &[facet])
    };
    draft.rebuild(house, left)
}

pub(super) fn delete_building(draft: &mut Draft, place: &Point3<f64>) -> Result<(), NotApplied> {
    let house = draft.house(place)?;
    draft.houses.remove(house);
    Ok(())
}

pub(super) fn set_ground(
    draft: &mut Draft,
    place: &Point3<f64>,
    height: f64,
) -> Result<(), NotApplied> {
    let house = draft.house(place)?;
    if height.abs() > FARTHEST_COORDINATE_M {
        return Err(NotApplied::Implausible);
    }
    let mut changed = draft.clone();
    let facets = draft.houses[house].facets.clone();
    changed.replace(Some(house), facets, height)?;
    // Closing puts the ground lower where the roof would meet it.
    if changed.houses[house].building.ground_z != height {
        return Err(NotApplied::Implausible);
    }
    *draft = changed;
    Ok(())
}

pub(super) fn set_eave(
    draft: &mut Draft,
    place: &Point3<f64>,
    height: f64,
) -> Result<(), NotApplied> {
    let house = draft.house(place)?;
    let facets = &draft.houses[house].facets;
    let all = facets.iter().flat_map(|f| corners(&f.facet));
    let rise = height - all.fold(f64::INFINITY, |low, p| low.min(p.z));
    let is_plausible = rise.abs() < FARTHEST_COORDINATE_M;
    if !is_plausible {
        return Err(NotApplied::Implausible);
    }
    let raised = facets.iter().map(|f| {
        let plane = f.facet.plane;
        f.on(Plane {
            d: plane.d - rise * plane.normal.z,
            ..plane
        })
    });
    let raised = raised.collect();
    draft.rebuild(house, raised)
}

pub(super) fn merge(
    draft: &mut Draft,
    facet: &FacetPlace,
    with: &FacetPlace,
) -> Result<(), NotApplied> {
    let (kept, taken) = (draft.facet(facet)?, draft.facet(with)?);
    if kept.house != taken.house || kept == taken {
        return Err(NotApplied::NotNeighbours);
    }
    let [region, other] = [kept, taken].map(|at| draft.get(at).facet.plan());
    let merged = draft.get(kept).over(&region.or(&other));
    if merged.len() != 1 {
        return Err(NotApplied::NotNeighbours);
    }
    let mut facets = without(&draft.houses[kept.house].facets, &[kept.facet, taken.facet]);
    facets.extend(merged);
    draft.rebuild(kept.house, facets)
}

pub(super) fn split(
    draft: &mut Draft,
    facet: &FacetPlace,
    along: &[Point3<f64>; 2],
) -> Result<(), NotApplied> {
    let at = draft.facet(facet)?;
    let whole = draft.get(at);
    let own: Vec<Point3<f64>> = corners(&whole.facet).copied().collect();
    let [p, q] = along.map(|p| snapped(&p, own.iter()).unwrap_or(p));
    let direction = q.xy() - p.xy();
    if !(direction.norm() > SNAP_DISTANCE_M && direction.norm() < FARTHEST_COORDINATE_M) {
        return Err(NotApplied::NotDivided);
    }
    let region = whole.facet.plan();
    let halves = [direction, -direction].map(|d| region.left_of(&p.xy(), &d));
    if halves.iter().any(|half| half.area() < LEAST_AREA_M2) {
        return Err(NotApplied::NotDivided);
    }
    let plane = &whole.facet.plane;
    let is_off = [p, q]
        .iter()
        .any(|e| (plane.z_at(e.x, e.y) - e.z).abs() > OFF_PLANE_M);
    let mut facets = without(&draft.houses[at.house].facets, &[at.facet]);
    for half in &halves {
        for mut part in whole.over(half) {
            if is_off {
                part = part.on(turned(&part.facet, &Segment3::new(p, q)));
                part.facet.uncertainty = None;
            }
            facets.push(part);
        }
    }
    draft.rebuild(at.house, facets)
}

pub(super) fn add_facet(
    draft: &mut Draft,
    outline: &[Point3<f64>],
    ground_z: Option<f64>,
) -> Result<(), NotApplied> {
    expect_outline(outline)?;
    let drawn: Vec<(Point3<f64>, f64)> = (outline.iter())
        .map(|p| {
            let all = draft.facets().flat_map(|(_, f)| corners(&f.facet));
            snapped(p, all).map_or((*p, 1.0), |held| (held, HELD_WEIGHT))
        })
        .collect();
    let plane = Plane::fit(&drawn).ok_or(NotApplied::NoRoom)?;
    let plan: Vec<Point2<f64>> = drawn.iter().map(|(p, _)| p.xy()).collect();
    let is_simple = is_simple(&plan);
    let region = Polygon::from(plan);
    if plane.normal.z < 0.1 || !is_simple || region.area() < LEAST_AREA_M2 {
        return Err(NotApplied::NoRoom);
    }
    let new = new_facet(plane).over(&region);
    let middle =
        crate::base::geometry::mean_point(&drawn.iter().map(|(p, _)| *p).collect::<Vec<_>>());
    let Some(house) = nearest_house(draft, &middle) else {
        let low = drawn.iter().fold(f64::INFINITY, |low, (p, _)| low.min(p.z));
        return draft.replace(None, new, ground_z.unwrap_or(low - STOREY_M));
    };
    let mut changed = draft.clone();
    for h in 0..changed.houses.len() {
        let facets = std::mem::take(&mut changed.houses[h].facets);
        let meets = |f: &DraftFacet| f.facet.plan().and(&region).area() > 0.0;
        let cut = |f: DraftFacet| match meets(&f) {
            true => f.over(&f.facet.plan().without(&region)),
            false => vec![f],
        };
        changed.houses[h].facets = facets.into_iter().flat_map(cut).collect();
    }
    let mut facets = changed.houses[house].facets.clone();
    facets.extend(new);
    let ground_z = changed.houses[house].building.ground_z;
    changed.houses.remove(house);
    changed.houses.retain(|house| !house.facets.is_empty());
    changed.replace(None, facets, ground_z)?;
    *draft = changed;
    Ok(())
}

/// Refuses what is no outline, and one of numbers that a model cannot have.
pub(super) fn expect_outline(outline: &[Point3<f64>]) -> Result<(), NotApplied> {
    let is_near = |p: &Point3<f64>| p.coords.iter().all(|c| c.abs() < FARTHEST_COORDINATE_M);
    let is_plausible = (3..=1000).contains(&outline.len()) && outline.iter().all(is_near);
    is_plausible.then_some(()).ok_or(NotApplied::Implausible)
}

pub(super) fn mirror(
    draft: &mut Draft,
    facet: &FacetPlace,
    over: &[Point3<f64>; 2],
) -> Result<(), NotApplied> {
    let at = draft.facet(facet)?;
    let sides = draft.edge(over)?;
    let side = sides.iter().find(|side| side[0].of == at);
    let [a, b] = side.ok_or(NotApplied::NoEdge)?.map(|c| draft.position(c));
    let across = {
        let along = (b.xy() - a.xy()).normalize();
        Vector3::new(-along.y, along.x, 0.0)
    };
    let image = |p: &Point3<f64>| p - across * (2.0 * across.dot(&(p - a)));
    let original = &draft.get(at).facet;
    let normal = original.plane.normal;
    let normal = normal - across * (2.0 * across.dot(&normal));
    let plane = Plane::from_point_normal(&image(&original.outer[0]), &normal);
    let plane = plane.ok_or(NotApplied::NoRoom)?;
    let ring: Vec<Point2<f64>> = original.outer.iter().map(|p| image(p).xy()).collect();
    let taken = draft.facets().map(|(_, f)| f.facet.plan());
    let free = taken.fold(Polygon::from(ring), |free, taken| free.without(&taken));
    let mut parts = new_facet(plane).over(&free);
    // What lies beyond other facets is not beside the edge.
    parts.sort_by(|a, b| b.facet.plan_area().total_cmp(&a.facet.plan_area()));
    let new = parts.into_iter().next().ok_or(NotApplied::NoRoom)?;
    if new.facet.plan_area() < LEAST_AREA_M2 {
        return Err(NotApplied::NoRoom);
    }
    let mut facets = draft.houses[at.house].facets.clone();
    facets.push(new);
    draft.rebuild(at.house, facets)
}

/// The facets of a building without some.
pub(super) fn without(facets: &[DraftFacet], gone: &[usize]) -> Vec<DraftFacet> {
    let left = facets.iter().enumerate().filter(|(i, _)| !gone.contains(i));
    left.map(|(_, f)| f.clone()).collect()
}

/// A facet that nobody but a person has seen.
fn new_facet(plane: Plane) -> DraftFacet {
    DraftFacet {
        facet: Facet {
            building: BuildingId::from_index(0),
            plane,
            outer: Vec::new(),
            holes: Vec::new(),
            similarity: 0.0,
            real_ratio: 0.0,
            probability: 1.0,
            uncertainty: None,
            lines: Vec::new(),
            half_planes: Vec::new(),
            proposals: Vec::new(),
            obstructions: Vec::new(),
        },
        source: None,
    }
}

/// The corner of the model that a drawn one is.
fn snapped<'a>(p: &Point3<f64>, all: impl Iterator<Item = &'a Point3<f64>>) -> Option<Point3<f64>> {
    let near = all
        .map(|q| ((q - p).norm(), q))
        .filter(|(d, _)| *d <= SNAP_DISTANCE_M);
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, q)| *q)
}

/// The plane through a line that lies nearest to the corners of a facet, in height.
pub(super) fn turned(facet: &Facet, line: &Segment3) -> Plane {
    let plan = line.p1.xy() - line.p0.xy();
    let (along, length) = (plan.normalize(), plan.norm());
    let slope = (line.p1.z - line.p0.z) / length;
    let (mut products, mut squares) = (0.0, 0.0);
    for p in corners(facet) {
        let by = p.xy() - line.p0.xy();
        let aside = along.perp(&by);
        products += aside * (p.z - line.p0.z - slope * along.dot(&by));
        squares += aside * aside;
    }
    let tilt = products / squares.max(f64::MIN_POSITIVE);
    let rise = along * slope + nalgebra::Vector2::new(-along.y, along.x) * tilt;
    let normal = Vector3::new(-rise.x, -rise.y, 1.0);
    Plane::from_point_normal(&line.p0, &normal).expect("z of the normal is 1")
}

/// The building with the corner nearest to a place.
fn nearest_house(draft: &Draft, place: &Point3<f64>) -> Option<usize> {
    let distances = draft.facets().flat_map(|(at, f)| {
        let of_corner = move |p: &Point3<f64>| ((p - place).norm(), at.house);
        corners(&f.facet).map(of_corner)
    });
    distances
        .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
        .map(|(_, house)| house)
}
