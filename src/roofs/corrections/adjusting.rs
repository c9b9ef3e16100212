//! Corners, edges and slopes that somebody states: observations, to which the building is adjusted.

use nalgebra::{Point3, Vector2};

use super::draft::{At, Draft, DraftFacet};
use super::outcome::NotApplied;
use super::place::Corner;
use crate::base::geometry::Segment3;
use crate::base::math;
use crate::base::params::{Correction, FacetPlace, RefineParams};
use crate::orienting::scene::Scene;
use crate::roofs::buildings::{Statement, adjust_to_statements};
use crate::roofs::model::{Facet, is_simple};

/// Standard deviation of slopes and directions that are stated, metres over a few metres.
const STATED_SIGMA_M: f64 = 2e-3;
/// Steepest slope that can be stated, degrees.
const STEEPEST_SLOPE_DEG: f64 = 80.0;
/// Corners and edges are moved no further, metres.
const LONGEST_MOVE_M: f64 = 50.0;
/// Facets that fall within this angle of opposite directions are symmetric about a ridge, degrees.
const OPPOSITE_DEG: f64 = 30.0;
/// Slopes below this have no direction, metres of height per metre.
const LEVEL_SLOPE: f64 = 1e-3;

/// A statement that has been adjusted to, by the places where its corners are since.
#[derive(Clone, Debug)]
pub(super) struct Held(Correction);

impl Held {
    /// An edge, where it was measured with this standard deviation, metres.
    pub(super) fn edge(ends: &[Point3<f64>; 2], sigma_m: f64) -> Self {
        Self(Correction::MoveEdge {
            from: *ends,
            to: *ends,
            sigma_m,
        })
    }
}

/// The statements of a correction about one building.
struct About {
    house: usize,
    statements: Vec<(Statement, f64)>,
}

impl About {
    /// All are known to the same standard deviation, metres.
    fn new(of: At, statements: impl IntoIterator<Item = Statement>, sigma_m: f64) -> Self {
        Self {
            house: of.house,
            statements: statements.into_iter().map(|s| (s, sigma_m)).collect(),
        }
    }
}

/// Adjusts a building to what a correction states of it.
pub(super) fn adjust(
    scene: &Scene,
    draft: &mut Draft,
    correction: &Correction,
    held: &[Held],
    params: &RefineParams,
) -> Result<(), NotApplied> {
    let strict = |place: &FacetPlace| draft.facet(place);
    let stated = statements(draft, correction, &strict)?;
    // Adjusting has turned the planes since: the place in plan says which facet it is.
    let loose = |place: &FacetPlace| draft.facet_below(&place.at.xy()).ok_or(NotApplied::NoFacet);
    let earlier = held.iter().flat_map(|Held(c)| statements(draft, c, &loose));
    let earlier: Vec<(Statement, f64)> = earlier
        .filter(|about| about.house == stated.house)
        .flat_map(|about| about.statements)
        .collect();
    let old = &draft.houses[stated.house].facets;
    let facets: Vec<&Facet> = old.iter().map(|f| &f.facet).collect();
    let new = adjust_to_statements(scene, &facets, &stated.statements, &earlier, params)
        .ok_or(NotApplied::NotAdjusted)?;
    if new.iter().any(is_folded) {
        return Err(NotApplied::WouldNotClose);
    }
    let new = new.into_iter().zip(old);
    let new = new.map(|(facet, of)| DraftFacet {
        facet,
        source: of.source,
    });
    let new = new.collect();
    draft.rebuild(stated.house, new)
}

/// Does an outline cross itself, or run the wrong way round?
fn is_folded(facet: &Facet) -> bool {
    let plan = facet.plan();
    plan.signed_area() <= 0.0 || plan.rings.iter().any(|ring| !is_simple(ring))
}

/// Remembers what an applied correction states.
pub(super) fn hold(correction: &Correction, held: &mut Vec<Held>) {
    match correction {
        Correction::MoveCorner { to, sigma_m, .. } => held.push(Held(Correction::MoveCorner {
            from: *to,
            to: *to,
            sigma_m: *sigma_m,
        })),
        Correction::MoveEdge { to, sigma_m, .. } => held.push(Held(Correction::MoveEdge {
            from: *to,
            to: *to,
            sigma_m: *sigma_m,
        })),
        Correction::SetLevel { .. }
        | Correction::SetSlope { .. }
        | Correction::SetSymmetric { .. } => held.push(Held(correction.clone())),
        // Parallel sides stay parallel by themselves.
        _ => {}
    }
}

fn statements(
    draft: &Draft,
    correction: &Correction,
    facet: &dyn Fn(&FacetPlace) -> Result<At, NotApplied>,
) -> Result<About, NotApplied> {
    let gradient = |of: At, is: Vector2<f64>| {
        let face = of.facet;
        About::new(of, [Statement::Gradient { face, is }], STATED_SIGMA_M)
    };
    match correction {
        Correction::MoveCorner { from, to, sigma_m } => {
            let (Corner { of, corner }, sigma_m) = (draft.corner(from)?, plausible(*sigma_m)?);
            near(from, to)?;
            let here = Statement::corner(of.facet, corner, to);
            Ok(About::new(of, here, sigma_m))
        }
        Correction::MoveEdge { from, to, sigma_m } => moved_edge(draft, from, to, *sigma_m),
        Correction::SetParallel { edge, to } => parallel_edges(draft, edge, to),
        Correction::SetLevel { facet: place } => Ok(gradient(facet(place)?, Vector2::zeros())),
        Correction::SetSlope {
            facet: place,
            slope_deg,
        } => {
            if !(0.0..STEEPEST_SLOPE_DEG).contains(slope_deg) {
                return Err(NotApplied::Implausible);
            }
            let of = facet(place)?;
            let (sin, cos) = math::sin_cos(slope_deg.to_radians());
            let direction = rise(draft, of).try_normalize(LEVEL_SLOPE);
            let is = direction.ok_or(NotApplied::OtherSlope)? * (sin / cos);
            Ok(gradient(of, is))
        }
        Correction::SetSymmetric { facets: [a, b] } => symmetric(draft, facet(a)?, facet(b)?),
        _ => Err(NotApplied::NotAdjusted),
    }
}

fn moved_edge(
    draft: &Draft,
    from: &[Point3<f64>; 2],
    to: &[Point3<f64>; 2],
    sigma_m: f64,
) -> Result<About, NotApplied> {
    let (sides, sigma_m) = (draft.edge(from)?, plausible(sigma_m)?);
    near(&from[0], &to[0])?;
    near(&from[1], &to[1])?;
    let line = not_vertical(to)?;
    let on = |c: &Corner| Statement::OnLine {
        face: c.of.facet,
        corner: c.corner,
        line,
    };
    let mut all: Vec<Corner> = sides.iter().flatten().copied().collect();
    all.sort_by_key(|c| (c.of, c.corner));
    all.dedup();
    Ok(About::new(all[0].of, all.iter().map(on), sigma_m))
}

fn parallel_edges(
    draft: &Draft,
    edge: &[Point3<f64>; 2],
    to: &[Point3<f64>; 2],
) -> Result<About, NotApplied> {
    let sides = draft.edge(edge)?;
    let [p, q] = draft.edge(to)?[0].map(|c| draft.position(c));
    let direction = not_vertical(&[p, q])?.direction();
    let along = |[a, b]: &[Corner; 2]| Statement::Along {
        face: a.of.facet,
        corners: [a.corner, b.corner],
        direction,
    };
    let of = sides[0][0].of;
    Ok(About::new(of, sides.iter().map(along), STATED_SIGMA_M))
}

/// Two facets are equally steep, and where they nearly fall apart from each other they do so.
fn symmetric(draft: &Draft, a: At, b: At) -> Result<About, NotApplied> {
    if a.house != b.house || a == b {
        return Err(NotApplied::NotNeighbours);
    }
    let faces = [a.facet, b.facet];
    let (f, g) = (rise(draft, a), rise(draft, b));
    let apart = math::atan2(f.perp(&-g).abs(), f.dot(&-g)).to_degrees();
    let statement = match apart <= OPPOSITE_DEG {
        true => Statement::Opposite { faces },
        false => Statement::EquallySteep { faces },
    };
    Ok(About::new(a, [statement], STATED_SIGMA_M))
}

/// Rise of a facet, metres of height per metre of plan.
fn rise(draft: &Draft, at: At) -> Vector2<f64> {
    let normal = draft.get(at).facet.plane.normal;
    -normal.xy() / normal.z
}

fn plausible(sigma_m: f64) -> Result<f64, NotApplied> {
    let is_plausible = (1e-3..=10.0).contains(&sigma_m);
    is_plausible
        .then_some(sigma_m)
        .ok_or(NotApplied::Implausible)
}

fn near(from: &Point3<f64>, to: &Point3<f64>) -> Result<(), NotApplied> {
    let is_near = (to - from).norm() <= LONGEST_MOVE_M;
    is_near.then_some(()).ok_or(NotApplied::Implausible)
}

fn not_vertical([p, q]: &[Point3<f64>; 2]) -> Result<Segment3, NotApplied> {
    let line = Segment3::new(*p, *q);
    let is_sound = line.direction().xy().norm() > 0.1;
    is_sound.then_some(line).ok_or(NotApplied::Implausible)
}
