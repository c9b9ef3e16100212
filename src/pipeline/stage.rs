//! The stages of all methods, and their names.

use serde::{Deserialize, Serialize};

use crate::params::Method;

/// The stages, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// Regions with straight boundaries in every view (W96 3.3).
    Regions,
    /// Windows and their main directions (W96 3.4).
    Directions,
    /// 3D lines by clustering (W96 3.5).
    Clusters,
    /// Planes between parallel lines and the closed buildings below them (W96 3.6).
    Rectangles,
    /// Straight image segments in every view (B99 3.2).
    Segments,
    /// Segments matched over the views (B99 3.1 - 3.4).
    Matches,
    /// 3D lines (B99 3.2).
    Lines,
    /// Half-planes at the 3D lines (B99 4.1).
    HalfPlanes,
    /// Roof facets and the closed buildings below them (B99 4.2, 4.3).
    Facets,
    /// The textured model.
    Model,
}

impl Stage {
    /// All stages of all methods.
    pub const ALL: [Self; 10] = [
        Self::Regions,
        Self::Directions,
        Self::Clusters,
        Self::Rectangles,
        Self::Segments,
        Self::Matches,
        Self::Lines,
        Self::HalfPlanes,
        Self::Facets,
        Self::Model,
    ];

    /// The stages of a method in their order, which is also the order of the enumeration.
    pub fn of(method: Method) -> &'static [Self] {
        match method {
            Method::Lines => &[
                Self::Segments,
                Self::Matches,
                Self::Lines,
                Self::HalfPlanes,
                Self::Facets,
                Self::Model,
            ],
            Method::Rectangles => &[
                Self::Regions,
                Self::Directions,
                Self::Clusters,
                Self::Rectangles,
                Self::Model,
            ],
            Method::Combined => &Self::ALL,
        }
    }

    /// The name in messages, reports and the session: one lower-case word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Segments => "segments",
            Self::Matches => "matches",
            Self::Lines => "lines",
            Self::HalfPlanes => "halfplanes",
            Self::Facets => "facets",
            Self::Regions => "regions",
            Self::Directions => "directions",
            Self::Clusters => "clusters",
            Self::Rectangles => "rectangles",
            Self::Model => "model",
        }
    }

    /// The stage of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|stage| stage.name() == name)
    }
}
