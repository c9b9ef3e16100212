//! Neighbourhood transferred into object space (B99 2: Bonn): two edges of a corner with a region
//! between them propose its plane, all regions of a corner at once.
//!
//! Regions that are one in some image, because an edge joins their corners, are one plane where it
//! is likelier than not that the ends of the edges of both lie in it: corners of a roof confirm
//! each other.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Point3};
use serde::{Deserialize, Serialize};

use super::graph::ImageGraph;
use super::space_corner::{SpaceCorner, SpaceEdge};
use crate::base::geometry::{Plane, convex_hull, mean_point};
use crate::base::ids::ProposalOrigin;
use crate::base::math::atan2;
use crate::planes::coplanar::{ImageEvidence, LineEnd, UncertainPlane, log_odds};
use crate::planes::grouping::ProposedPlane;
use crate::planes::half_planes::is_wall;

/// Share of the regions between two edges of a corner that are a face of a roof, where no other
/// corner confirms them. Measured: 93 of 523 in the sixteen fitting scenes; most others are ground,
/// or between an edge of a roof and its shadow.
const ALONE: f64 = 0.18;
/// The same of regions that are one for several corners. Measured: 90 of 183.
const JOINED: f64 = 0.49;

/// A plane that regions of corners propose.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CornerPlane {
    /// The regions: a corner in space, and the edge that the region follows clockwise.
    pub regions: Vec<[u32; 2]>,
    /// The plane.
    pub plane: Plane,
    /// Covariance of the height in the middle of the polygon, metres, and of its gradient along x
    /// and y: 3 x 3.
    pub covariance: [[f64; 3]; 3],
    /// Convex hull of the corners and the far ends of their edges, on the plane, counter-clockwise
    /// from above, metres, local frame.
    pub polygon: Vec<Point3<f64>>,
    /// Logarithm of the odds that the regions lie in one plane; 0 for one region alone.
    pub coplanar_nats: f64,
    /// Logarithm of the odds that so many regions are a face of a roof, before the views are asked.
    pub prior_nats: f64,
    /// What the views say of the plane inside the polygon, nats.
    pub inside_nats: f64,
}

impl CornerPlane {
    /// Is it likelier with the plane than without it what the views show?
    pub fn is_verified(&self) -> bool {
        self.prior_nats + self.inside_nats > 0.0
    }

    /// As a plane that facets may have; `index` is its place in the list.
    pub fn proposed(&self, index: usize) -> ProposedPlane {
        ProposedPlane {
            origin: ProposalOrigin::CornerPlane(index as u32),
            plane: self.plane,
            ring: self.polygon.clone(),
            sides_on_edges: false,
        }
    }
}

/// A region between two edges of a corner in space.
struct Sector {
    id: [u32; 2],
    /// The corner and the far ends of both edges.
    points: [LineEnd; 3],
    /// View and region of its images.
    images: BTreeSet<[u32; 2]>,
}

/// Regions in one plane.
struct Fused {
    sectors: Vec<usize>,
    plane: UncertainPlane,
    nats: f64,
}

/// What the planes are judged by.
pub(super) struct PlaneSpace<'a> {
    pub graphs: &'a [ImageGraph],
    pub images: &'a ImageEvidence<'a>,
    /// Size of a ground pixel, metres.
    pub pixel_m: f64,
    /// Range of heights, metres: what the height of a point could be.
    pub range_m: f64,
}

impl PlaneSpace<'_> {
    /// The planes that some corners propose.
    pub(super) fn planes(&self, corners: &[SpaceCorner]) -> Vec<CornerPlane> {
        let sectors: Vec<Sector> = (corners.iter().enumerate())
            .flat_map(|(i, corner)| self.sectors(corners, i, corner))
            .collect();
        let fused = self.fused(&sectors);
        let planes = crate::base::execution::map(&fused, |_, fused| self.plane(&sectors, fused));
        planes.into_iter().flatten().collect()
    }

    /// The regions of a corner that two edges span: less than half a turn, and no wall.
    fn sectors(&self, all: &[SpaceCorner], index: usize, corner: &SpaceCorner) -> Vec<Sector> {
        let n = corner.edges.len();
        let of_edge = |k: usize| {
            let [edge, next] = [&corner.edges[k], &corner.edges[(k + 1) % n]];
            let angle = |d: &nalgebra::Vector3<f64>| atan2(d.y, d.x);
            let opening = (angle(&edge.direction) - angle(&next.direction)).rem_euclid(TAU);
            (opening < PI).then_some(())?;
            let covariance = Matrix3::from(corner.covariance);
            let far = |e: &SpaceEdge| match e.neighbour {
                Some(other) => LineEnd {
                    at: all[other as usize].at,
                    covariance: Matrix3::from(all[other as usize].covariance),
                },
                None => LineEnd {
                    at: e.far(&corner.at),
                    covariance: covariance
                        + Matrix3::from(e.covariance) * (e.length_m * e.length_m),
                },
            };
            let here = LineEnd {
                at: corner.at,
                covariance,
            };
            let images = corner.images.iter().filter_map(|&[v, c]| {
                let graph = &self.graphs[v as usize];
                let edges = &graph.corners[c as usize].edges;
                let of = |e: &SpaceEdge| Some(e.images.iter().find(|i| i[0] == v)?[1]);
                let (from, to) = (of(edge)? as usize, of(next)? as usize);
                ((from + 1) % edges.len() == to).then(|| [v, edges[from].region])
            });
            let sector = Sector {
                id: [index as u32, k as u32],
                points: [here, far(edge), far(next)],
                images: images.collect(),
            };
            let plane = self.fit([&sector].into_iter())?;
            (!is_wall(&plane.plane())).then_some(sector)
        };
        let edges = if n < 2 { 0..0 } else { 0..n };
        edges.filter_map(of_edge).collect()
    }

    fn fit<'s>(&self, sectors: impl Iterator<Item = &'s Sector>) -> Option<UncertainPlane> {
        let points: Vec<LineEnd> = sectors.flat_map(|s| s.points).collect();
        UncertainPlane::fit(&points, self.pixel_m)
    }

    /// Sectors with those that show the same region in some view and lie in the same plane.
    fn fused(&self, sectors: &[Sector]) -> Vec<Fused> {
        let mut groups: Vec<Option<Fused>> = (0..sectors.len())
            .map(|i| {
                let plane = self.fit([&sectors[i]].into_iter())?;
                Some(Fused {
                    sectors: vec![i],
                    plane,
                    nats: 0.0,
                })
            })
            .collect();
        let mut group_of: Vec<usize> = (0..sectors.len()).collect();
        let mut of_image = std::collections::BTreeMap::<[u32; 2], Vec<usize>>::new();
        for (i, sector) in sectors.iter().enumerate() {
            for image in &sector.images {
                of_image.entry(*image).or_default().push(i);
            }
        }
        let pairs: BTreeSet<[usize; 2]> = (of_image.values())
            .flat_map(|of| {
                let others = move |i: usize| of[i + 1..].iter().map(move |&b| [of[i], b]);
                (0..of.len()).flat_map(others)
            })
            .collect();
        let weighed = pairs.into_iter().filter_map(|[a, b]| {
            let nats = self.nats_of(&groups[a].as_ref()?.plane, &sectors[b]);
            let back = self.nats_of(&groups[b].as_ref()?.plane, &sectors[a]);
            Some((nats.min(back), a, b))
        });
        let mut weighed: Vec<(f64, usize, usize)> = weighed.filter(|w| w.0 > 0.0).collect();
        weighed.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (nats, a, b) in weighed {
            let (a, b) = (group_of[a], group_of[b]);
            if a == b {
                continue;
            }
            let (Some(first), Some(second)) = (&groups[a], &groups[b]) else {
                continue;
            };
            let members: Vec<usize> = (first.sectors.iter().chain(&second.sectors))
                .copied()
                .collect();
            let Some(plane) = self.fit(members.iter().map(|&i| &sectors[i])) else {
                continue;
            };
            // Each must still lie in the plane of all.
            if members
                .iter()
                .any(|&i| self.nats_of(&plane, &sectors[i]) <= 0.0)
            {
                continue;
            }
            let nats = first.nats + second.nats + nats;
            members.iter().for_each(|&i| group_of[i] = a);
            groups[b] = None;
            groups[a] = Some(Fused {
                sectors: members,
                plane,
                nats,
            });
        }
        groups.into_iter().flatten().collect()
    }

    /// Logarithm of the odds that the points of a sector lie in a plane; the worst of them, for
    /// they may share an edge, which lies in both planes in any case.
    fn nats_of(&self, plane: &UncertainPlane, sector: &Sector) -> f64 {
        let of = |end: &LineEnd| plane.nats_of_end(end, self.pixel_m, self.range_m);
        sector.points.iter().map(of).fold(f64::INFINITY, f64::min)
    }

    fn plane(&self, sectors: &[Sector], fused: &Fused) -> Option<CornerPlane> {
        let plane = fused.plane.plane();
        let points = fused.sectors.iter().flat_map(|&i| &sectors[i].points);
        let in_plan = convex_hull(&points.map(|end| end.at.xy()).collect::<Vec<_>>());
        (in_plan.len() >= 3).then_some(())?;
        let polygon: Vec<Point3<f64>> = in_plan.iter().map(|p| plane.lift(p.x, p.y)).collect();
        let mut regions: Vec<[u32; 2]> = fused.sectors.iter().map(|&i| sectors[i].id).collect();
        regions.sort_unstable();
        Some(CornerPlane {
            regions,
            plane,
            covariance: fused.plane.covariance_at(&mean_point(&polygon).xy()),
            prior_nats: log_odds(match fused.sectors.len() {
                1 => ALONE,
                _ => JOINED,
            }),
            inside_nats: self.images.inside(&plane, &in_plan, &[]),
            polygon,
            coplanar_nats: fused.nats,
        })
    }
}
