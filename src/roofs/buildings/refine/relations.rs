//! Relations between the sides of a building (B99 section 2: the partner in Leuven regularises
//! roofs by parallel, perpendicular, horizontal and symmetric parts).
//!
//! A relation is a scalar function `c(x)` of the wireframe that is zero when it holds. It is
//! proposed only where the sides nearly fulfil it; [`super::relation_tests`] decides which are
//! adopted.

use serde::Serialize;

use super::wireframe::{SideKind, Wireframe, WireframeSide, WireframeState};
use crate::base::geometry::Segment3;
use crate::base::math;
use crate::base::params::RefineParams;

/// What is supposed of one or two sides; numbers are indices of sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Relation {
    /// The ends of a side are of one height. Metres.
    Horizontal(usize),
    /// Two sides run parallel in plan: offset of the end of the second, metres.
    Parallel(usize, usize),
    /// Two sides run at a right angle in plan: offset of the end of the second, metres.
    Perpendicular(usize, usize),
    /// Two eaves are of one height. Metres.
    EqualHeight(usize, usize),
    /// The facets at a ridge are equally steep. Metres of height over a metre, times [`LEVER_M`].
    Symmetric(usize),
}

/// Over this distance slopes are compared, metres: half the depth of a facet.
pub(super) const LEVER_M: f64 = 4.0;

/// The kinds of relations, for the trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum RelationKind {
    /// A side is horizontal.
    Horizontal,
    /// Two sides are parallel in plan.
    Parallel,
    /// Two sides are perpendicular in plan.
    Perpendicular,
    /// Two eaves have one height.
    EqualHeight,
    /// The two facets at a ridge have one slope.
    Symmetric,
}

impl Relation {
    /// How far the state is from it, metres.
    pub(super) fn value(&self, w: &Wireframe, state: &WireframeState) -> f64 {
        let segment = |i: usize| w.segment(state, &w.sides[i]);
        let plan = |i: usize| segment(i).p1.xy() - segment(i).p0.xy();
        let middle = |i: usize| segment(i).at(0.5).z;
        match *self {
            Self::Horizontal(i) => segment(i).p1.z - segment(i).p0.z,
            Self::Parallel(i, j) => plan(i).normalize().perp(&plan(j)),
            Self::Perpendicular(i, j) => plan(i).normalize().dot(&plan(j)),
            Self::EqualHeight(i, j) => middle(j) - middle(i),
            Self::Symmetric(i) => {
                let side = &w.sides[i];
                let slope = |face: usize| {
                    let at = w.plane_at(face);
                    (state[at] * state[at] + state[at + 1] * state[at + 1]).sqrt()
                };
                let beyond = side.beyond.map_or(0.0, slope);
                LEVER_M * (slope(side.face) - beyond)
            }
        }
    }

    /// The unknowns that it depends on.
    pub(super) fn unknowns(&self, w: &Wireframe) -> Vec<usize> {
        let mut unknowns = match *self {
            Self::Horizontal(i) => w.unknowns(&w.sides[i]),
            Self::Parallel(i, j) | Self::Perpendicular(i, j) | Self::EqualHeight(i, j) => {
                [w.unknowns(&w.sides[i]), w.unknowns(&w.sides[j])].concat()
            }
            Self::Symmetric(i) => {
                let side = &w.sides[i];
                let faces = [Some(side.face), side.beyond];
                let planes = faces.into_iter().flatten().map(|f| w.plane_at(f));
                planes.flat_map(|at| [at, at + 1]).collect()
            }
        };
        // A facet or a vertex may belong to both sides; each unknown counts once.
        unknowns.sort_unstable();
        unknowns.dedup();
        unknowns
    }

    pub(super) fn kind(&self) -> RelationKind {
        match self {
            Self::Horizontal(_) => RelationKind::Horizontal,
            Self::Parallel(..) => RelationKind::Parallel,
            Self::Perpendicular(..) => RelationKind::Perpendicular,
            Self::EqualHeight(..) => RelationKind::EqualHeight,
            Self::Symmetric(_) => RelationKind::Symmetric,
        }
    }

    pub(super) fn sides(&self) -> Vec<usize> {
        match *self {
            Self::Horizontal(i) | Self::Symmetric(i) => vec![i],
            Self::Parallel(i, j) | Self::Perpendicular(i, j) | Self::EqualHeight(i, j) => {
                vec![i, j]
            }
        }
    }
}

/// The relations that a state is near to.
pub(super) fn propose(
    w: &Wireframe,
    state: &WireframeState,
    params: &RefineParams,
) -> Vec<Relation> {
    let longest_first = longest_first(w, state, params);
    let horizontal: Vec<usize> = longest_first
        .iter()
        .copied()
        .filter(|&i| slope_deg(&w.segment(state, &w.sides[i])) < params.near_deg)
        .collect();
    let mut found: Vec<Relation> = horizontal
        .iter()
        .map(|&i| Relation::Horizontal(i))
        .collect();
    let ridges = horizontal
        .iter()
        .filter(|&&i| is_symmetric_ridge(w, state, &w.sides[i], params));
    found.extend(ridges.map(|&i| Relation::Symmetric(i)));
    found.extend(equal_heights(w, state, &horizontal, params));
    found.extend(directions(w, state, &longest_first, params));
    found
}

/// Sides long enough to have a direction, the longest first.
fn longest_first(w: &Wireframe, state: &WireframeState, params: &RefineParams) -> Vec<usize> {
    let length = |i: usize| w.segment(state, &w.sides[i]).length();
    let mut sides: Vec<usize> = (0..w.sides.len())
        .filter(|&i| w.sides[i].kind != SideKind::Foot && length(i) >= params.min_relation_m)
        .collect();
    sides.sort_by(|&i, &j| length(j).total_cmp(&length(i)).then(i.cmp(&j)));
    sides
}

/// Every side against the longest one before it that it is nearly parallel or perpendicular to.
fn directions(
    w: &Wireframe,
    state: &WireframeState,
    sides: &[usize],
    params: &RefineParams,
) -> Vec<Relation> {
    let near = math::sin(params.near_deg.to_radians());
    let direction = |i: usize| {
        let s = w.segment(state, &w.sides[i]);
        (s.p1.xy() - s.p0.xy()).normalize()
    };
    let mut references: Vec<usize> = Vec::new();
    let mut found = Vec::new();
    for &i in sides {
        let d = direction(i);
        let relation = references.iter().find_map(|&r| {
            let e = direction(r);
            if e.perp(&d).abs() < near {
                Some(Relation::Parallel(r, i))
            } else if e.dot(&d).abs() < near {
                Some(Relation::Perpendicular(r, i))
            } else {
                None
            }
        });
        match relation {
            Some(relation) => found.push(relation),
            None => references.push(i),
        }
    }
    found
}

/// Horizontal eaves against the longest one before them of nearly their height.
fn equal_heights(
    w: &Wireframe,
    state: &WireframeState,
    horizontal: &[usize],
    params: &RefineParams,
) -> Vec<Relation> {
    let mut references: Vec<usize> = Vec::new();
    let mut found = Vec::new();
    let height = |i: usize| w.segment(state, &w.sides[i]).at(0.5).z;
    for &i in horizontal
        .iter()
        .filter(|&&i| w.sides[i].kind == SideKind::Free)
    {
        match references
            .iter()
            .find(|&&r| (height(r) - height(i)).abs() < params.near_m)
        {
            Some(&r) => {
                // Sides of one facet that are both horizontal have one height already, or the facet
                // is level.
                found.push(Relation::EqualHeight(r, i));
            }
            None => references.push(i),
        }
    }
    found
}

/// Do the facets beside a ridge fall away from it, equally but for `near_deg`?
fn is_symmetric_ridge(
    w: &Wireframe,
    state: &WireframeState,
    side: &WireframeSide,
    params: &RefineParams,
) -> bool {
    let Some(beyond) = side.beyond else {
        return false;
    };
    let gradient = |face: usize| {
        let at = w.plane_at(face);
        nalgebra::Vector2::new(state[at], state[at + 1])
    };
    let (f, g) = (gradient(side.face), gradient(beyond));
    let angle = |v: &nalgebra::Vector2<f64>| math::atan(v.norm()).to_degrees();
    f.dot(&g) < 0.0 && (angle(&f) - angle(&g)).abs() < params.near_deg
}

fn slope_deg(s: &Segment3) -> f64 {
    let d = s.direction();
    math::atan2(d.z.abs(), d.xy().norm()).to_degrees()
}
