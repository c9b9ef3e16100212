//! Reconstructed 3D lines.

use nalgebra::{Matrix3, Point3};
use serde::{Deserialize, Serialize};

use super::track::LineSupport;
use crate::base::geometry::Segment3;
use crate::base::ids::LineId;

/// How a 3D line was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum LineOrigin {
    /// From image segments that belong together (B99 3, W96 3.5).
    #[default]
    Matched,
    /// Adopted from the results of W96 (3.5) where matching found no line.
    Clustered,
    /// Where two planes intersect (B99 4.2, new lines).
    Intersection,
    /// The border of a facet, found again in the images (B99 4.3).
    Border,
}

impl LineOrigin {
    /// Its name in the files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Matched => "matched",
            Self::Clustered => "clustered",
            Self::Intersection => "intersection",
            Self::Border => "border",
        }
    }
}

/// Why the finished model rejects a line ([`crate::roofs::buildings::VerifiedLines`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum LineContradiction {
    /// It is more likely no edge than one ([`crate::base::evidence`]).
    Improbable,
    /// A duplicate of a line that more views support or that is more certain.
    Duplicate,
}

/// A reconstructed 3D line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line3d {
    /// How it was found.
    pub origin: LineOrigin,
    /// End points, metres, local frame. Every support's stretch runs the same way.
    pub segment: Segment3,
    /// Standard deviation of the line's position across itself, metres, the larger of both ends.
    pub sigma_m: f64,
    /// Covariance of the start and of the end point across the line, m^2 (3 x 3 each; zero along
    /// the line).
    pub covariance: [Matrix3<f64>; 2],
    /// Probability that there is an edge in space, 0 to 1 ([`crate::base::evidence`]); 1 where
    /// nothing weighed it.
    pub probability: f64,
    /// The views that support it.
    pub supports: Vec<LineSupport>,
    /// Why the finished model contradicts it; no file contains such a line.
    pub contradiction: Option<LineContradiction>,
}

impl Line3d {
    /// The lines that the model does not contradict, with their ids.
    pub fn standing(lines: &[Self]) -> impl Iterator<Item = (LineId, &Self)> + Clone {
        let numbered = lines.iter().enumerate();
        numbered
            .filter(|(_, line)| line.contradiction.is_none())
            .map(|(i, line)| (LineId::from_index(i), line))
    }

    /// A point of the line, `t` from 0 to 1.
    pub fn at(&self, t: f64) -> Point3<f64> {
        self.segment.at(t)
    }
}
