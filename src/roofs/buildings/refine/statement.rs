//! What somebody states of a corner, a side or a facet, as an observation of the adjustment.
//!
//! Facets count as in the building; corners count through the rings of their facet, the outer one
//! first.

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::relations::LEVER_M;
use super::wireframe::{Wireframe, WireframeState};
use crate::base::geometry::Segment3;

/// A statement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Statement {
    /// Where a corner lies in plan, metres.
    CornerPlan {
        /// The facet.
        face: usize,
        /// The corner.
        corner: usize,
        /// Its position.
        at: Point2<f64>,
    },
    /// How high a corner lies, wherever that is, metres.
    CornerHeight {
        /// The facet.
        face: usize,
        /// The corner.
        corner: usize,
        /// Its height.
        z: f64,
    },
    /// A corner lies on an infinite line, which is not vertical: offsets in plan and in height.
    OnLine {
        /// The facet.
        face: usize,
        /// The corner.
        corner: usize,
        /// The line.
        line: Segment3,
    },
    /// Two corners of a facet lie in this direction of each other, which is not vertical: offsets
    /// of the second one in plan and in height.
    Along {
        /// The facet.
        face: usize,
        /// The corners.
        corners: [usize; 2],
        /// Unit vector.
        direction: Vector3<f64>,
    },
    /// The rise of a facet, metres of height per metre of plan.
    Gradient {
        /// The facet.
        face: usize,
        /// Rise in x and y.
        is: Vector2<f64>,
    },
    /// Two facets rise alike in opposite directions.
    Opposite {
        /// The facets.
        faces: [usize; 2],
    },
    /// Two facets are equally steep.
    EquallySteep {
        /// The facets.
        faces: [usize; 2],
    },
}

impl Statement {
    /// Where a corner lies in space.
    pub fn corner(face: usize, corner: usize, at: &Point3<f64>) -> [Self; 2] {
        let (z, at) = (at.z, at.xy());
        [
            Self::CornerPlan { face, corner, at },
            Self::CornerHeight { face, corner, z },
        ]
    }

    /// How far the state is from it, metres; slopes over [`LEVER_M`]. The second is 0 where there
    /// is one only.
    pub(super) fn value(&self, w: &Wireframe, state: &WireframeState) -> [f64; 2] {
        let rise = |face: usize| {
            let at = w.plane_at(face);
            Vector2::new(state[at], state[at + 1])
        };
        let place = |face: usize, corner: usize| w.corner(state, face, w.vertex(face, corner));
        match *self {
            Self::CornerPlan { face, corner, at } => {
                let by = place(face, corner).xy() - at;
                [by.x, by.y]
            }
            Self::CornerHeight { face, corner, z } => [place(face, corner).z - z, 0.0],
            Self::OnLine { face, corner, line } => {
                off(&(place(face, corner) - line.p0), &line.direction())
            }
            Self::Along {
                face,
                corners: [p, q],
                direction,
            } => off(&(place(face, q) - place(face, p)), &direction),
            Self::Gradient { face, is } => {
                let by = (rise(face) - is) * LEVER_M;
                [by.x, by.y]
            }
            Self::Opposite { faces: [f, g] } => {
                let by = (rise(f) + rise(g)) * LEVER_M;
                [by.x, by.y]
            }
            Self::EquallySteep { faces: [f, g] } => {
                [(rise(f).norm() - rise(g).norm()) * LEVER_M, 0.0]
            }
        }
    }

    /// The unknowns that it depends on, each once.
    pub(super) fn unknowns(&self, w: &Wireframe) -> Vec<usize> {
        let plane = |face: usize| [0, 1, 2].map(|k| w.plane_at(face) + k);
        let vertex = |face: usize, corner: usize| {
            let v = w.vertex(face, corner);
            [2 * v, 2 * v + 1]
        };
        match *self {
            Self::CornerPlan { face, corner, .. } => vertex(face, corner).to_vec(),
            Self::CornerHeight { face, corner, .. } | Self::OnLine { face, corner, .. } => {
                [&vertex(face, corner)[..], &plane(face)].concat()
            }
            Self::Along {
                face,
                corners: [p, q],
                ..
            } => [&vertex(face, p)[..], &vertex(face, q), &plane(face)].concat(),
            Self::Gradient { face, .. } => plane(face)[..2].to_vec(),
            Self::Opposite { faces } | Self::EquallySteep { faces } => {
                let [f, g] = faces.map(plane);
                [&f[..2], &g[..2]].concat()
            }
        }
    }
}

/// How far a vector leads away from a line in this direction: to its left in plan, and above it.
fn off(by: &Vector3<f64>, direction: &Vector3<f64>) -> [f64; 2] {
    let plan = direction.xy().norm();
    let along = direction.xy() / plan;
    let slope = direction.z / plan;
    [along.perp(&by.xy()), by.z - slope * along.dot(&by.xy())]
}
