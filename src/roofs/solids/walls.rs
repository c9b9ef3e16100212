//! The faces that close a building: roofs at their heights, walls between heights, the ground.
//!
//! At every plan vertex the heights of the facets that meet there, and the ground, are its
//! *levels*. A corner of the solid is a level of a plan vertex. Every wall that ends on a plan
//! vertex passes all levels between its foot and its top, so that no corner lies inside an edge (no
//! T-junctions).

use std::collections::BTreeMap;

use nalgebra::Point3;

use super::partition::PlanPartition;
use super::rings::{PlanRegion, regions_from_edges, ring_edges};

/// Which face it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FaceKind {
    /// The roof over this facet of the partition.
    Roof(usize),
    /// Vertical.
    Wall,
    /// The underside of a roof that overhangs a wall.
    Ceiling,
    /// At the foot.
    Ground,
}

/// A face; rings of corners, counter-clockwise seen from outside the solid, holes clockwise.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ShellFace {
    /// Which it is.
    pub kind: FaceKind,
    /// The outer ring, then holes.
    pub rings: Vec<Vec<u32>>,
}

/// The faces around a building before its topology is sorted out.
#[derive(Clone, Debug, Default)]
pub(super) struct Shell {
    /// Corners, metres.
    pub corners: Vec<Point3<f64>>,
    /// The plan vertex below each corner.
    pub plan: Vec<u32>,
    /// Faces.
    pub faces: Vec<ShellFace>,
}

/// All faces of the building that covers `facets` and stands on `ground_z` (below all its heights).
pub(super) fn shell_of(
    partition: &PlanPartition,
    facets: &[usize],
    left_of: &BTreeMap<(u32, u32), usize>,
    tolerances: &[f64],
    ground_z: f64,
) -> Shell {
    let levels = Levels::new(partition, facets, tolerances, ground_z);
    let mut faces = Vec::new();
    let mut outline = Vec::new();
    for &facet in facets {
        let rings: PlanRegion = partition.facets[facet]
            .region
            .iter()
            .map(|ring| ring.iter().map(|&v| levels.top(facet, v)).collect())
            .collect();
        for edge in partition.facets[facet]
            .region
            .iter()
            .flat_map(|ring| ring_edges(ring))
        {
            let other = left_of.get(&(edge.1, edge.0)).copied();
            if other.is_none() {
                outline.push(edge);
            }
            faces.extend(levels.wall(edge, facet, other));
        }
        faces.push(ShellFace {
            kind: FaceKind::Roof(facet),
            rings,
        });
    }
    for region in regions_from_edges(&outline, &partition.positions) {
        let foot = |ring: &Vec<u32>| ring.iter().rev().map(|&v| levels.foot(v)).collect();
        faces.push(ShellFace {
            kind: FaceKind::Ground,
            rings: region.iter().map(foot).collect(),
        });
    }
    Shell {
        corners: levels.corners,
        plan: levels.plan,
        faces,
    }
}

/// The corners of a building: consecutive indices upwards at each plan vertex, the ground first.
struct Levels {
    corners: Vec<Point3<f64>>,
    plan: Vec<u32>,
    first: BTreeMap<u32, u32>,
    of_facet: BTreeMap<(usize, u32), u32>,
}

impl Levels {
    fn new(partition: &PlanPartition, facets: &[usize], tolerances: &[f64], ground_z: f64) -> Self {
        let mut levels = Self {
            corners: Vec::new(),
            plan: Vec::new(),
            first: BTreeMap::new(),
            of_facet: BTreeMap::new(),
        };
        for (v, at_vertex) in partition.heights(facets.iter().copied()) {
            let p = partition.positions[v as usize];
            let foot = levels.push(v, Point3::new(p.x, p.y, ground_z));
            levels.first.insert(v, foot);
            let same = |a: &(f64, usize), b: &(f64, usize)| b.0 - a.0 <= tolerances[v as usize];
            for group in at_vertex.chunk_by(same) {
                let mean = group.iter().map(|(z, _)| z).sum::<f64>() / group.len() as f64;
                let corner = levels.push(v, Point3::new(p.x, p.y, mean));
                levels
                    .of_facet
                    .extend(group.iter().map(|&(_, facet)| ((facet, v), corner)));
            }
        }
        levels
    }

    fn push(&mut self, v: u32, corner: Point3<f64>) -> u32 {
        self.corners.push(corner);
        self.plan.push(v);
        u32::try_from(self.corners.len() - 1).expect("fewer than 2^32 corners")
    }

    /// Corner of a facet at a plan vertex.
    fn top(&self, facet: usize, v: u32) -> u32 {
        self.of_facet[&(facet, v)]
    }

    /// Corner on the ground.
    fn foot(&self, v: u32) -> u32 {
        self.first[&v]
    }

    /// The wall below an edge of `facet`, down to the facet beyond or to the ground; `None` where
    /// that is not lower. Seen from outside the edge runs from left to right.
    fn wall(&self, (a, b): (u32, u32), facet: usize, other: Option<usize>) -> Option<ShellFace> {
        let (top_a, top_b) = (self.top(facet, a), self.top(facet, b));
        let low = |v| other.map_or(self.foot(v), |other| self.top(other, v));
        let (low_a, low_b) = (low(a), low(b));
        // Roofs that cross were split at the crossing.
        upright([low_a, low_b], [top_a, top_b])
    }
}

/// The vertical face between corners at both ends of an edge, if it has an area. Corners of one
/// plan vertex are numbered upwards.
pub(super) fn upright([low_a, low_b]: [u32; 2], [high_a, high_b]: [u32; 2]) -> Option<ShellFace> {
    let has_area = low_a <= high_a && low_b <= high_b && (low_a, low_b) != (high_a, high_b);
    has_area.then(|| {
        let mut ring: Vec<u32> = (low_b..=high_b).collect();
        ring.extend((low_a..=high_a).rev());
        ShellFace {
            kind: FaceKind::Wall,
            rings: vec![ring],
        }
    })
}
