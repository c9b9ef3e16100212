//! The sources of planes, and the methods: names for sets of them.

use serde::{Deserialize, Serialize};

/// What proposes planes for roofs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Half-planes at the 3D lines, by homography sweep (B99 4.1).
    HalfPlanes,
    /// Two neighbouring lines in a plane that no half-plane explains (B99 5).
    LinePairs,
    /// Regions, and planes between parallel lines in object space (W96).
    Rectangles,
    /// Sets of coplanar lines and their polygons (B99 2: Leuven).
    Coplanar,
    /// Corners with their edges and regions, matched as wholes (B99 2: Bonn).
    Adjacency,
    /// Dense matching (B99 2).
    Dense,
    /// A point cloud, where one is known beforehand.
    PointCloud,
}

impl Source {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::HalfPlanes,
        Self::LinePairs,
        Self::Rectangles,
        Self::Coplanar,
        Self::Adjacency,
        Self::Dense,
        Self::PointCloud,
    ];

    /// Does it start from lines that are matched over the views?
    pub fn is_of_lines(self) -> bool {
        self != Self::Rectangles
    }

    /// Does it take as little time as a first look may?
    pub fn is_quick(self) -> bool {
        !matches!(self, Self::Rectangles | Self::Dense | Self::PointCloud)
    }
}

/// A name for a set of sources.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Lines matched over the views, half-planes at them, and dense matching (B99).
    #[default]
    Lines,
    /// Regions, and planes between parallel lines in object space (W96).
    Rectangles,
    /// Lines and planes of both compete for one model.
    Combined,
    /// Sets of coplanar lines alone.
    Coplanar,
    /// Corners alone.
    Adjacency,
}

/// Name, what the command line says of it, and sources of each method, in their order.
const METHODS: [(&str, &str, &[Source]); 5] = [
    (
        "lines",
        "Lines matched over the views, and half-planes at them (Baillard et al. 1999)",
        &[
            Source::HalfPlanes,
            Source::LinePairs,
            Source::Dense,
            Source::PointCloud,
        ],
    ),
    (
        "rectangles",
        "Regions, and planes between parallel lines in object space (Wiman and Axelsson 1996)",
        &[Source::Rectangles],
    ),
    (
        "combined",
        "Both: their lines and planes compete for one model. Regions take most of its time",
        &[
            Source::HalfPlanes,
            Source::LinePairs,
            Source::Rectangles,
            Source::Dense,
            Source::PointCloud,
        ],
    ),
    (
        "coplanar",
        "Sets of coplanar lines and their polygons (Baillard et al. 1999, section 2)",
        &[Source::Coplanar],
    ),
    (
        "adjacency",
        "Corners with their edges and regions, matched as wholes (Baillard et al. 1999, section 2)",
        &[Source::Adjacency],
    ),
];

impl Method {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Lines,
        Self::Rectangles,
        Self::Combined,
        Self::Coplanar,
        Self::Adjacency,
    ];

    /// The name in files, on the command line and on the page.
    pub fn name(self) -> &'static str {
        METHODS[self as usize].0
    }

    /// What it is, in a sentence.
    pub fn summary(self) -> &'static str {
        METHODS[self as usize].1
    }

    /// The sources of planes that it stands for.
    pub fn sources(self) -> &'static [Source] {
        METHODS[self as usize].2
    }
}
