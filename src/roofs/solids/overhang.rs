//! The solid of a building whose walls stand back below its eaves (LoD 2.3).
//!
//! The plan of the roof, less a band along each side as deep as its wall stands back, is the
//! footprint. It divides every facet: above the footprint the building reaches down to the ground,
//! beside it the roof is a slab of [`RIM_M`]. Each part is a prism between two planes, and what two
//! neighbours do not have in common are the vertical faces between them:
//!
//! ```text
//!        roof ____----
//!   ____------ ______-      above the footprint  ground ... roof
//!  |____-------|            beside it            roof - RIM_M ... roof
//!   underside  | wall
//!              |_______
//!               ground
//! ```
//!
//! Roof faces are those of the solid with walls under the eaves. Where the prisms do not make a
//! closed solid (the rim of a step in its middle, say) there is none, and walls stay where they
//! are.

use std::collections::BTreeMap;

use nalgebra::Point3;

use super::footprint::footprint;
use super::manifold::close_shell;
use super::partition::PlanPartition;
use super::rings::{PlanRegion, regions_from_edges, ring_edges};
use super::sides::Side;
use super::soundness::is_sound_as_written;
use super::walls::{FaceKind, Shell, ShellFace, upright};
use crate::base::geometry::{OverlayRule, Plane, Polygon, plan_sides};
use crate::base::ids::FacetId;
use crate::roofs::model::{Facet, Solid, SolidFace, Surface, WELD_M};

/// Height of the rim of an overhanging roof, metres. Assumption: rafters, boards and gutter.
pub const RIM_M: f64 = 0.15;

/// The solid of a building with its facets `members`, whose walls stand `depths` inside its
/// `sides`, on the ground; `None` where there is none that is sound.
pub fn close_below_overhangs(
    members: &[(FacetId, &Facet)],
    sides: &[Side],
    depths: &[f64],
    ground: &Plane,
) -> Option<Solid> {
    let roofs: Vec<Polygon> = members.iter().map(|(_, f)| f.plan()).collect();
    let footprint = footprint(&roofs, sides, depths)?;
    let mut parts: Vec<Part> = Vec::new();
    for (member, roof) in roofs.iter().enumerate() {
        for (rule, stands) in [
            (OverlayRule::Intersect, true),
            (OverlayRule::Difference, false),
        ] {
            let shapes = roof.overlay(&footprint, rule);
            let facets = shapes.iter().filter_map(|s| part_of(members[member].1, s));
            parts.extend(facets.map(|facet| Part {
                facet,
                member,
                stands,
            }));
        }
    }
    let facets: Vec<Facet> = parts.iter().map(|p| p.facet.clone()).collect();
    let (partition, _) = PlanPartition::new(&facets);
    let prisms = Prisms::new(&partition, &parts, ground)?;
    let shell = close_shell(&prisms.shell(members.len())?)?;
    let surface = |kind| match kind {
        FaceKind::Roof(member) => Surface::Roof(members[member].0),
        FaceKind::Ceiling => Surface::Ceiling,
        FaceKind::Wall => Surface::Wall,
        FaceKind::Ground => Surface::Ground,
    };
    let face = |face: ShellFace| SolidFace {
        surface: surface(face.kind),
        rings: face.rings,
    };
    let solid = Solid {
        faces: shell.faces.into_iter().map(face).collect(),
        vertices: shell.corners,
    };
    is_sound_as_written(&solid).then_some(solid)
}

/// A part of a facet with the outline of a shape; `None` for a sliver.
fn part_of(facet: &Facet, shape: &Polygon) -> Option<Facet> {
    let part = facet.over(shape);
    let around: f64 = plan_sides(&part.outer).map(|[p, q]| (q - p).norm()).sum();
    // Of a sliver of width w and length l the area is w l and the outline 2 l.
    (part.plan_area().abs() > WELD_M * around).then_some(part)
}

/// A part of a facet.
struct Part {
    facet: Facet,
    /// Which of the members.
    member: usize,
    /// Does the building stand on the ground below it?
    stands: bool,
}

/// Upper and lower corners of a part at a plan vertex.
#[derive(Clone, Copy)]
struct Levels {
    top: u32,
    bottom: u32,
}

/// The parts as prisms.
struct Prisms<'a> {
    partition: &'a PlanPartition,
    parts: &'a [Part],
    corners: Vec<Point3<f64>>,
    plan: Vec<u32>,
    levels: BTreeMap<(usize, u32), Levels>,
}

impl<'a> Prisms<'a> {
    /// `None` where the ground is not below all of the roof.
    fn new(partition: &'a PlanPartition, parts: &'a [Part], ground: &Plane) -> Option<Self> {
        let tolerances = partition.height_tolerances();
        let mut prisms = Self {
            partition,
            parts,
            corners: Vec::new(),
            plan: Vec::new(),
            levels: BTreeMap::new(),
        };
        for (v, heights) in partition.heights(0..partition.facets.len()) {
            let p = partition.positions[v as usize];
            let foot = ground.z_at(p.x, p.y);
            let same = |a: &(f64, usize), b: &(f64, usize)| b.0 - a.0 <= tolerances[v as usize];
            // Tops and bottoms of the parts, and all heights upwards.
            let mut spans: Vec<(usize, f64, f64)> = Vec::new();
            for group in heights.chunk_by(same) {
                let top = group.iter().map(|(z, _)| z).sum::<f64>() / group.len() as f64;
                for &(_, facet) in group {
                    let bottom = if prisms.part(facet).stands {
                        foot
                    } else {
                        top - RIM_M
                    };
                    spans.push((facet, bottom, top));
                }
            }
            let mut all: Vec<f64> = spans.iter().flat_map(|s| [s.1, s.2]).collect();
            all.sort_by(f64::total_cmp);
            all.dedup_by(|b, a| *b - *a < tolerances[v as usize]);
            let first = prisms.corners.len();
            let corner = |z: f64| (first + all.partition_point(|l| *l <= z) - 1) as u32;
            for (facet, bottom, top) in spans {
                // The ground reaches the roof.
                if top - bottom < 0.5 * RIM_M {
                    return None;
                }
                let levels = Levels {
                    top: corner(top),
                    bottom: corner(bottom),
                };
                prisms.levels.insert((facet, v), levels);
            }
            for z in all {
                prisms.corners.push(Point3::new(p.x, p.y, z));
                prisms.plan.push(v);
            }
        }
        Some(prisms)
    }

    fn part(&self, facet: usize) -> &'a Part {
        &self.parts[self.partition.facets[facet].source]
    }

    fn edges_of(&self, facet: usize) -> impl Iterator<Item = (u32, u32)> + '_ {
        let region = &self.partition.facets[facet].region;
        region.iter().flat_map(|ring| ring_edges(ring))
    }

    /// All faces; `None` where a facet is in pieces, or prisms cross.
    fn shell(&self, members: usize) -> Option<Shell> {
        let left_of = self.partition.facet_left_of();
        let mut faces = Vec::new();
        let (mut roofs, mut standing) = (vec![Vec::new(); members], Vec::new());
        let mut of_roof: BTreeMap<(usize, u32), u32> = BTreeMap::new();
        let mut foot: BTreeMap<u32, u32> = BTreeMap::new();
        for facet in 0..self.partition.facets.len() {
            let Part { member, stands, .. } = *self.part(facet);
            for (a, b) in self.edges_of(facet) {
                roofs[member].push((a, b));
                let here = self.levels[&(facet, a)];
                of_roof.insert((member, a), here.top);
                if stands {
                    standing.push((a, b));
                    foot.insert(a, here.bottom);
                }
                let other = left_of.get(&(b, a)).copied();
                faces.extend(self.walls((a, b), facet, other)?);
            }
            if !stands {
                let region = &self.partition.facets[facet].region;
                let below = |v: &u32| self.levels[&(facet, *v)].bottom;
                faces.push(face(FaceKind::Ceiling, region, true, below));
            }
        }
        for (member, edges) in roofs.iter().enumerate() {
            let regions = regions_from_edges(edges, &self.partition.positions);
            let [region] = &regions[..] else { return None };
            let above = |v: &u32| of_roof[&(member, *v)];
            faces.push(face(FaceKind::Roof(member), region, false, above));
        }
        for region in regions_from_edges(&standing, &self.partition.positions) {
            faces.push(face(FaceKind::Ground, &region, true, |v| foot[v]));
        }
        Some(Shell {
            corners: self.corners.clone(),
            plan: self.plan.clone(),
            faces,
        })
    }

    /// The vertical faces at an edge of a part: what it does not have in common with the part
    /// beyond. Seen from outside the edge runs from left to right. `None` where one passes the
    /// height of the other between the ends.
    fn walls(
        &self,
        (a, b): (u32, u32),
        facet: usize,
        other: Option<usize>,
    ) -> Option<Vec<ShellFace>> {
        let [own_a, own_b] = [a, b].map(|v| self.levels[&(facet, v)]);
        let whole = || upright([own_a.bottom, own_b.bottom], [own_a.top, own_b.top]);
        let Some(other) = other else {
            return Some(whole().into_iter().collect());
        };
        let [other_a, other_b] = [a, b].map(|v| self.levels[&(other, v)]);
        let heights = |own: Levels, other: Levels| [own.top, own.bottom, other.top, other.bottom];
        let (at_a, at_b) = (heights(own_a, other_a), heights(own_b, other_b));
        let crosses = (0..4).any(|i| {
            (0..i).any(|j| {
                let (a, b) = (at_a[i].cmp(&at_a[j]), at_b[i].cmp(&at_b[j]));
                a.is_ne() && a == b.reverse()
            })
        });
        let below = upright(
            [own_a.bottom, own_b.bottom],
            [own_a.top.min(other_a.bottom), own_b.top.min(other_b.bottom)],
        );
        let above = upright(
            [own_a.bottom.max(other_a.top), own_b.bottom.max(other_b.top)],
            [own_a.top, own_b.top],
        );
        (!crosses).then(|| below.into_iter().chain(above).collect())
    }
}

/// A face over a region, or below one, with the corner of each plan vertex.
fn face(
    kind: FaceKind,
    region: &PlanRegion,
    is_below: bool,
    corner: impl Fn(&u32) -> u32,
) -> ShellFace {
    let ring = |ring: &Vec<u32>| {
        let mut corners: Vec<u32> = ring.iter().map(&corner).collect();
        if is_below {
            corners.reverse();
        }
        corners
    };
    ShellFace {
        kind,
        rings: region.iter().map(ring).collect(),
    }
}

#[cfg(test)]
mod tests;
