//! The planes that compete for the plan, with all that facets on them are measured by.

use nalgebra::Point3;

use super::borders::{Arrangement, BorderCosts, LINE_HEIGHT, LineIndex};
use super::delineation::{Delineation, Outline};
use super::evidence::PlaneEvidence;
use super::outlines::OutlineEnergy;
use super::point_cloud::CloudEvidence;
use super::register::RegisterEvidence;
use crate::base::geometry::{Plane, sides};
use crate::base::ids::{BuildingId, ViewId};
use crate::base::labelling::Energy;
use crate::base::params::RoofParams;
use crate::orienting::scene::Scene;
use crate::planes::grouping::PlaneGroup;
use crate::planes::photoconsistency::{ConsistencyMap, PlanGrid};
use crate::roofs::model::{Facet, Occluders};

/// The planes that compete for the plan, and what facets on them are verified by.
#[derive(Clone, Debug)]
pub struct CompetingPlanes {
    /// What each plane stands on, in their order.
    pub(super) groups: Vec<PlaneGroup>,
    pub(super) evidence: PlaneEvidence,
    pub(super) arrangement: Arrangement,
    pub(super) planes: Vec<Plane>,
    /// The real lines, by which the outlines are rated.
    pub(super) index: LineIndex,
    /// How the views agree on each plane.
    pub(super) maps: Vec<ConsistencyMap>,
    /// With pixels about as wide as the samples of the maps' cells are apart.
    pub(super) scene: Scene,
    /// Of the maps, the ground and the cells.
    pub(super) grid: PlanGrid,
    pub(super) cloud: Option<CloudEvidence>,
}

impl CompetingPlanes {
    /// The point cloud that belongs here, as evidence.
    pub(crate) fn cloud(&self) -> Option<&CloudEvidence> {
        self.cloud.as_ref()
    }

    /// What the labelling of the cells minimises.
    pub(super) fn energy(
        &self,
        register: Option<&RegisterEvidence>,
        params: &RoofParams,
    ) -> Energy<BorderCosts> {
        let (planes, lines) = (&self.planes, &self.index);
        (self.evidence).energy(&self.arrangement, planes, lines, register, params)
    }

    /// The facet over an outline; its `building` is still unset (0).
    pub(super) fn facet(&self, outline: &Outline, delineation: &Delineation) -> Facet {
        let plane = self.planes[outline.plane as usize];
        let group = &self.groups[outline.plane as usize];
        let lift = |ring: &Vec<usize>| -> Vec<Point3<f64>> {
            ring.iter()
                .map(|&v| delineation.vertices[v])
                .map(|p| plane.lift(p.x, p.y))
                .collect()
        };
        let (mut weight, mut correlation) = (0.0, 0.0);
        for e in outline
            .cells
            .iter()
            .filter_map(|&c| self.evidence.get(c, outline.plane))
        {
            weight += e.weight;
            correlation += e.correlation;
        }
        Facet {
            building: BuildingId(0),
            plane,
            outer: lift(&outline.outer),
            holes: outline.holes.iter().map(lift).collect(),
            similarity: if weight > 0.0 {
                correlation / weight
            } else {
                0.0
            },
            real_ratio: self.real_ratio(outline, delineation),
            uncertainty: None,
            probability: 1.0,
            lines: group.lines(),
            half_planes: group.half_planes(),
            proposals: group.proposals.clone(),
            obstructions: Vec::new(),
        }
    }

    /// The outlines, those that are accepted with fewer corners.
    pub(super) fn simplify(
        &self,
        delineation: Delineation,
        accepted: &[bool],
        params: &RoofParams,
    ) -> Delineation {
        let energy = OutlineEnergy {
            arrangement: &self.arrangement,
            planes: &self.planes,
            lines: &self.index,
            border_nats_per_m: params.border_nats_per_m,
            cost: &|cell, plane| self.evidence.cost(cell, plane),
        };
        energy.simplify(delineation, accepted)
    }

    /// tau_real: the share of the outline on reconstructed lines, B99 4.3.
    fn real_ratio(&self, outline: &Outline, delineation: &Delineation) -> f64 {
        let plane = &self.planes[outline.plane as usize];
        let (mut real, mut total) = (0.0, 0.0);
        for side in sides(&outline.outer) {
            let [a, b] = side.map(|v| delineation.vertices[v]);
            let pieces = ((b - a).norm() / 0.25).ceil().max(1.0);
            for k in 0..pieces as usize {
                let (p, q) = (
                    a + (b - a) * (k as f64 / pieces),
                    a + (b - a) * ((k + 1) as f64 / pieces),
                );
                let z = plane.z_at(0.5 * (p.x + q.x), 0.5 * (p.y + q.y));
                total += (q - p).norm();
                if self
                    .index
                    .heights_along(&p, &q)
                    .iter()
                    .any(|h| (h - z).abs() < LINE_HEIGHT)
                {
                    real += (q - p).norm();
                }
            }
        }
        if total > 0.0 { real / total } else { 0.0 }
    }

    /// The views from which other facets hide a point.
    pub(super) fn hidden_by<'s>(
        &'s self,
        occluders: &'s Occluders,
    ) -> impl Fn(ViewId, &Point3<f64>) -> bool + 's {
        |view, point| occluders.hide(point, &self.scene.camera(view).center)
    }
}
