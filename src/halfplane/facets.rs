//! From half-planes to facets: the stage that orders B99 4.2 and 4.3.
//!
//! lines and half-planes -> groups -> regions, border lines -> plan cells -> consistency of every plane
//! over its region -> labelling -> outlines -> verification. A facet that fails verification is
//! withdrawn and its neighbours are decided again without it, as the paper updates the
//! neighbours of a plane that is removed.

use nalgebra::{Point2, Point3};
use serde::Serialize;

use super::arrangement::Arrangement;
use super::border_cost::{BorderCosts, LINE_HEIGHT};
use super::borders::{Border, border_lines};
use super::consistency::{ConsistencyMap, consistency_map, consistency_map_behind};
use super::delineation::{Delineation, Outline, delineate, signed_area};
use super::evidence::Evidence;
use super::grouping::{GroupingInput, PlaneGroup, group_planes};
use super::hypothesis::{ON_SURFACE, TEXTURED, bounding_lines, hypotheses};
use super::interior::{Inside, SIDE};
use super::is_wall;
use super::islands::without_islands;
use super::labelling::Labelling;
use super::line_index::LineIndex;
use super::neighbourhood::line_neighbours;
use super::plan::PlanGrid;
use super::plane_lines::PlaneLine;
use super::proposed::add_rectangles;
use super::region::Region;
use super::shiftable::ShiftableWindows;
use crate::geometry::Plane;
use crate::ids::{BuildingId, ViewId};
use crate::lines3d::Line3d;
use crate::params::RoofParams;
use crate::roof::{Facet, Ground, Occluders, RoofEvidence};
use crate::scene::Scene;

/// Why a facet was withdrawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FacetRejection {
    /// Smaller than the least area.
    TooSmall {
        /// Sloped area, square metres.
        area_m2: f64,
    },
    /// Windows fit into little of it, so that nothing but its edges speaks for it.
    TooNarrow {
        /// Side of the window, metres.
        window_m: f64,
    },
    /// On the ground, or too little above it.
    NearGround {
        /// Height of its middle above the ground, metres.
        height_m: f64,
    },
    /// Its low side lies on the ground: a bank, or the shadow of an eave, but no roof.
    ReachesGround {
        /// Height of its lowest corner above the ground, metres.
        lowest_m: f64,
    },
    /// The views do not agree inside the outline.
    Dissimilar {
        /// Mean correlation inside the outline.
        similarity: f64,
    },
    /// The views that nothing hides it from do not agree inside the outline.
    Contradicted {
        /// Mean correlation of all their pairs inside the outline.
        similarity: f64,
    },
    /// Inside the outline the views agree better on the plane of another group.
    Outdone {
        /// Index of that group.
        by: u32,
        /// How much better, in standard deviations.
        sigmas: f64,
    },
    /// Too little of its outline lies on reconstructed lines, and the images do not clearly show it.
    Unsupported {
        /// tau_real, 0 to 1.
        real_ratio: f64,
    },
}

/// A withdrawn facet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RejectedFacet {
    /// Index of the group whose plane it has.
    pub group: u32,
    /// Its outline, metres, local frame.
    pub outline: Vec<Point3<f64>>,
    /// Why.
    pub reason: FacetRejection,
}

/// What grouping, delineation and verification did.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FacetTrace {
    /// Groups of coplanar lines and half-planes.
    pub groups: Vec<PlaneGroup>,
    /// Lines found in the groups' planes.
    pub plane_lines: Vec<PlaneLine>,
    /// Border lines in plan.
    pub borders: Vec<Border>,
    /// Number of cells that the border lines cut the plan into.
    pub cells: usize,
    /// Withdrawn facets.
    pub rejected: Vec<RejectedFacet>,
}

/// Facets from 3D lines and half-planes (B99 4.2, 4.3). Their `building` is still unset (0): facets that
/// touch become buildings when walls are added.
pub fn reconstruct_facets(
    scene: &Scene,
    evidence: &RoofEvidence,
    params: &RoofParams,
) -> (Vec<Facet>, FacetTrace) {
    let RoofEvidence {
        segments,
        lines,
        half_planes,
        ground,
        rectangles,
    } = *evidence;
    let neighbours = line_neighbours(lines);
    let input = GroupingInput {
        lines,
        half_planes,
        neighbours: &neighbours,
        rectangles,
    };
    let mut groups: Vec<PlaneGroup> = group_planes(&input, params);
    groups.retain(|g| !is_wall(&g.plane) && !lies_on_ground(&input, g, ground, params));
    add_rectangles(&input, &mut groups, params);
    let regions: Vec<Region> = groups
        .iter()
        .map(|g| Region::new(&input, g, params))
        .collect();
    let Some(grid) = plan_window(scene, lines, &regions) else {
        return (
            Vec::new(),
            FacetTrace {
                groups,
                ..FacetTrace::default()
            },
        );
    };
    let fine = scene
        .views
        .iter()
        .map(|v| v.camera.ground_pixel(&lines[0].at(0.5)))
        .fold(f64::INFINITY, f64::min);
    let reduced = scene.reduced(((grid.step / fine) as usize).max(1));
    let ground_map = ground_map(&reduced, ground, &grid);
    let hypotheses = hypotheses(scene, &reduced, segments, &input, groups, grid.step, params);
    let windows = ShiftableWindows::new(lines.iter().map(|l| l.segment), &grid);
    let bounding = bounding_lines(&input, &hypotheses);
    let borders = border_lines(&input, &hypotheses, &bounding, &windows, params);
    let arrangement = Arrangement::new(&with_frame(&borders, &grid));

    let evidence = Evidence::collect(
        &input,
        &hypotheses,
        &arrangement,
        &grid,
        ground_map.as_ref(),
        &windows,
        params,
    );
    let groups: Vec<PlaneGroup> = hypotheses.iter().map(|h| h.group.clone()).collect();
    let (maps, plane_lines): (Vec<ConsistencyMap>, Vec<Vec<PlaneLine>>) =
        hypotheses.into_iter().map(|h| (h.map, h.lines)).unzip();
    let plane_lines = plane_lines.concat();
    let planes: Vec<Plane> = groups.iter().map(|g| g.plane).collect();
    let real = lines
        .iter()
        .map(|l| l.segment)
        .chain(plane_lines.iter().map(|l| l.segment));
    let index = LineIndex::new(real.collect());
    let energy = evidence.energy(&arrangement, &planes, &index, params);
    let mut solver = Solver {
        labelling: Labelling::new(energy, planes.len() as u32),
        evidence,
        arrangement,
        planes,
        index,
        maps,
        scene: reduced,
    };
    let (facets, rejected) = solver.solve(&groups, ground, params);
    let cells = solver.arrangement.cells;
    (
        facets,
        FacetTrace {
            groups,
            plane_lines,
            borders,
            cells,
            rejected,
        },
    )
}

/// Are all lines of the group lower than any eave?
fn lies_on_ground(
    input: &GroupingInput,
    group: &PlaneGroup,
    ground: &Ground,
    params: &RoofParams,
) -> bool {
    let eave_m = 0.7 * params.min_height_m;
    let mut members = group.members.iter();
    members.all(|m| ground.is_near(&input.lines[m.line.index()].segment, eave_m))
}

/// The plan grid of the whole scene: the ground pixel as cell, the regions of all groups as window.
fn plan_window(scene: &Scene, lines: &[Line3d], regions: &[Region]) -> Option<PlanGrid> {
    let middle = lines.get(lines.len() / 2)?.at(0.5);
    let mut steps: Vec<f64> = scene
        .views
        .iter()
        .map(|v| v.camera.ground_pixel(&middle))
        .collect();
    let step = crate::math::median(&mut steps)?;
    let (mut min, mut max) = regions.first()?.bounds();
    for (low, high) in regions.iter().map(Region::bounds) {
        min = Point2::new(min.x.min(low.x), min.y.min(low.y));
        max = Point2::new(max.x.max(high.x), max.y.max(high.y));
    }
    let size = max - min;
    // Coarser cells for a very large window: at most 36 million.
    let step = step.max(FINEST_CELL).max((size.x * size.y / 36e6).sqrt());
    (size.x > 0.0 && size.y > 0.0 && step.is_finite()).then(|| PlanGrid::covering(min, max, step))
}

/// Similarity of the views on the ground. Its height is only known to a few decimetres: at every position the views may agree
/// at the height that it has there or a step beside it.
fn ground_map(scene: &Scene, ground: &Ground, grid: &PlanGrid) -> Option<ConsistencyMap> {
    const STEP: f64 = 0.3;
    let plane = ground.plane();
    let [lowest, highest] = ground.rises().map(|rise| (rise / STEP).round() as i32);
    let levels: Vec<i32> = (lowest - 1..=highest + 1).collect();
    let maps = crate::shares::map_shared("planes", &levels, 0.1..0.2, |_, level| {
        let raised = Plane {
            d: plane.d - STEP * f64::from(*level) * plane.normal.z,
            ..plane
        };
        consistency_map(scene, &raised, grid)
    });
    ConsistencyMap::best_of(&maps, |column, row| {
        let at = grid.center(column, row);
        let rise = ground.z_at(&at) - plane.z_at(at.x, at.y);
        let below = ((rise / STEP).round() as i32 - lowest).clamp(0, highest - lowest) as usize;
        below..below + 3
    })
}

/// Finest cell, metres. Assumption: what a roof's border lines can be told apart by; sharper images are reduced.
const FINEST_CELL: f64 = 0.06;

/// The borders and a frame around the window, so that every cell that matters is closed.
fn with_frame(borders: &[Border], grid: &PlanGrid) -> Vec<Border> {
    const MARGIN: f64 = 25.0;
    let (x0, y0) = (grid.origin.x - MARGIN, grid.origin.y - MARGIN);
    let x1 = grid.origin.x + grid.width as f64 * grid.step + MARGIN;
    let y1 = grid.origin.y + grid.height as f64 * grid.step + MARGIN;
    let corner = [
        Point2::new(x0, y0),
        Point2::new(x1, y0),
        Point2::new(x1, y1),
        Point2::new(x0, y1),
    ];
    let frame = (0..4).map(|i| Border {
        kind: super::borders::BorderKind::Closing,
        a: corner[i],
        b: corner[(i + 1) % 4],
    });
    borders.iter().copied().chain(frame).collect()
}

/// Height above the ground that no eave is below, metres. Assumption: with a few decimetres for the ground's own error.
const LOWEST_EAVE: f64 = 1.0;
/// Share of a facet that another plane must be able to cover to take its place. Assumption.
const ALMOST_ALL: f64 = 0.9;
/// Standard deviations by which the views must agree better on it. Assumption: as usual.
const CLEARLY: f64 = 3.0;

/// How the views that see a facet agree on its plane, over its own part of the plan; `hidden` says which do not.
fn map_inside(
    scene: &Scene,
    facet: &Facet,
    step: f64,
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
) -> ConsistencyMap {
    let start = [f64::MAX, f64::MIN].map(|bound| Point2::new(bound, bound));
    let corners = facet.outer.iter().map(Point3::xy);
    let [min, max] = corners.fold(start, |[low, high], p| [low.inf(&p), high.sup(&p)]);
    let grid = PlanGrid::covering(min, max, step);
    consistency_map_behind(scene, &facet.plane, &grid, hidden)
}

/// The windows inside a facet, with the map of its plane.
fn inside<'m>(facet: &Facet, map: &'m ConsistencyMap) -> Inside<'m> {
    let in_plan = |ring: &Vec<Point3<f64>>| ring.iter().map(Point3::xy).collect();
    let rings = std::iter::once(&facet.outer).chain(&facet.holes);
    let rings: Vec<Vec<Point2<f64>>> = rings.map(in_plan).collect();
    Inside::new(&rings, map)
}

struct Solver {
    labelling: Labelling<BorderCosts>,
    evidence: Evidence,
    arrangement: Arrangement,
    planes: Vec<Plane>,
    index: LineIndex,
    /// How the views agree on each plane.
    maps: Vec<ConsistencyMap>,
    /// With pixels about as wide as the cells of the maps.
    scene: Scene,
}

impl Solver {
    /// Labels, delineates and verifies until no facet is withdrawn.
    fn solve(
        &mut self,
        groups: &[PlaneGroup],
        ground: &Ground,
        params: &RoofParams,
    ) -> (Vec<Facet>, Vec<RejectedFacet>) {
        const ROUNDS: usize = 4;
        let mut rejected = Vec::new();
        for round in 1..=ROUNDS {
            self.labelling.minimise();
            let labels = self.labelling.labels().to_vec();
            let labels = without_islands(&self.arrangement, labels, params.min_area_m2);
            let delineation = delineate(&self.arrangement, &labels, &self.planes);
            self.labelling.relabel(labels);
            let mut facets = Vec::new();
            let mut withdrawn = Vec::new();
            // No roof, but no other plane may have their place: they stay in the labelling.
            let mut on_ground = Vec::new();
            let found: Vec<Facet> = (delineation.outlines.iter())
                .map(|outline| self.facet(outline, &delineation, groups))
                .collect();
            let occluders = Occluders::new(&found);
            let results: Vec<_> = (delineation.outlines.iter().zip(&found))
                .map(|(outline, facet)| self.verify(facet, outline, &occluders, ground, params))
                .collect();
            for ((outline, facet), result) in delineation.outlines.iter().zip(found).zip(results) {
                let result = match result {
                    // In the last round nothing would take its place.
                    Err(FacetRejection::Outdone { .. }) if round == ROUNDS => Ok(()),
                    result => result,
                };
                let reason = match result {
                    Ok(()) => {
                        facets.push(facet);
                        continue;
                    }
                    Err(reason) => reason,
                };
                let refused = RejectedFacet {
                    group: outline.plane,
                    outline: facet.outer,
                    reason,
                };
                if matches!(reason, FacetRejection::NearGround { .. }) {
                    on_ground.push(refused);
                } else {
                    rejected.push(refused);
                    withdrawn.push(outline);
                }
            }
            if withdrawn.is_empty() || round == ROUNDS {
                rejected.extend(on_ground);
                return (facets, rejected);
            }
            for outline in withdrawn {
                self.labelling.withdraw(outline.plane, &outline.cells);
            }
        }
        unreachable!("the last round returns")
    }

    fn facet(&self, outline: &Outline, delineation: &Delineation, groups: &[PlaneGroup]) -> Facet {
        let plane = self.planes[outline.plane as usize];
        let group = &groups[outline.plane as usize];
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
            lines: group.lines(),
            half_planes: group.half_planes(),
            rectangles: group.rectangles.clone(),
        }
    }

    /// tau_real: the share of the outline on reconstructed lines, B99 4.3.
    fn real_ratio(&self, outline: &Outline, delineation: &Delineation) -> f64 {
        let plane = &self.planes[outline.plane as usize];
        let (mut real, mut total) = (0.0, 0.0);
        for (i, &v) in outline.outer.iter().enumerate() {
            let a = delineation.vertices[v];
            let b = delineation.vertices[outline.outer[(i + 1) % outline.outer.len()]];
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

    fn verify(
        &self,
        facet: &Facet,
        outline: &Outline,
        occluders: &Occluders,
        ground: &Ground,
        params: &RoofParams,
    ) -> Result<(), FacetRejection> {
        let plan: Vec<Point2<f64>> = facet.outer.iter().map(Point3::xy).collect();
        let ring: Vec<usize> = (0..plan.len()).collect();
        let area_m2 = signed_area(&ring, &plan) / facet.plane.normal.z;
        if area_m2 < params.min_area_m2 {
            return Err(FacetRejection::TooSmall { area_m2 });
        }
        let middle = facet
            .outer
            .iter()
            .fold(nalgebra::Vector3::zeros(), |s, p| s + p.coords)
            / facet.outer.len() as f64;
        let height_m = middle.z - ground.z_at(&Point2::new(middle.x, middle.y));
        if height_m < params.min_height_m {
            return Err(FacetRejection::NearGround { height_m });
        }
        let heights = facet.outer.iter().map(|p| p.z - ground.z_at(&p.xy()));
        let lowest_m = heights.fold(f64::INFINITY, f64::min);
        if lowest_m < LOWEST_EAVE {
            return Err(FacetRejection::ReachesGround { lowest_m });
        }
        let map = &self.maps[outline.plane as usize];
        let inside = inside(facet, map);
        if inside.is_narrow() {
            return Err(FacetRejection::TooNarrow {
                window_m: SIDE as f64 * map.grid.step,
            });
        }
        let interior = inside.sums(params.min_correlation);
        if interior.speaks_against() {
            return Err(FacetRejection::Dissimilar {
                similarity: interior.correlation / interior.weight,
            });
        }
        // The better half of the pairs excuses the views in which something stands in front of the facet, and with them
        // as many in which nothing does.
        if interior.speaks_against_overall()
            && let Some(similarity) = self.contradicted(facet, map.grid.step, occluders, params)
        {
            return Err(FacetRejection::Contradicted { similarity });
        }
        if let Some((by, sigmas)) = self.outdone(outline, &inside) {
            return Err(FacetRejection::Outdone { by, sigmas });
        }
        // What little texture there is must not speak against the plane.
        let (weight, least) = self.texture(outline);
        if facet.similarity * weight < least && weight > 0.1 * area_m2 {
            return Err(FacetRejection::Dissimilar {
                similarity: facet.similarity,
            });
        }
        // Where the images show the surface itself, its outline need not lie on lines.
        let shown = facet.similarity >= f64::from(ON_SURFACE)
            && weight >= f64::from(TEXTURED) * area_m2 * facet.plane.normal.z;
        if facet.real_ratio < params.min_real_ratio && !shown {
            return Err(FacetRejection::Unsupported {
                real_ratio: facet.real_ratio,
            });
        }
        Ok(())
    }

    /// How all pairs of views correlate inside a facet, where no other hides it from them; `None` unless that contradicts
    /// its plane.
    fn contradicted(
        &self,
        facet: &Facet,
        step: f64,
        occluders: &Occluders,
        params: &RoofParams,
    ) -> Option<f64> {
        let hidden = |view, point: &_| occluders.hide(point, &self.scene.camera(view).center);
        let map = map_inside(&self.scene, facet, step, &hidden);
        let seen = inside(facet, &map).sums(params.min_correlation);
        seen.speaks_against_overall()
            .then(|| seen.overall / seen.weight)
    }

    /// The plane that could lie over a facet and that the views agree on clearly better inside it. A level plane through
    /// the ridges of two roofs has more edges than the roof between them, and little else.
    fn outdone(&self, outline: &Outline, inside: &Inside) -> Option<(u32, f64)> {
        let area = |plane: u32| -> f64 {
            let evidence = (outline.cells.iter()).filter_map(|&c| self.evidence.get(c, plane));
            evidence.map(|e| e.area).sum()
        };
        let most = ALMOST_ALL * area(outline.plane);
        let others = (0..self.planes.len() as u32).filter(|p| *p != outline.plane);
        let rivals = others.filter(|p| area(*p) >= most);
        let best = rivals
            .map(|p| (p, inside.advantage_of(&self.maps[p as usize])))
            .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))?;
        (best.1 > CLEARLY).then_some(best)
    }

    /// Texture weight over an outline, square metres, and its product with the least correlation.
    fn texture(&self, outline: &Outline) -> (f64, f64) {
        let evidence = (outline.cells.iter()).filter_map(|&c| self.evidence.get(c, outline.plane));
        evidence.fold((0.0, 0.0), |(w, l), e| (w + e.weight, l + e.least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::gable_scene;
    use nalgebra::Vector3;

    const MIN_CORRELATION: f64 = 0.45;

    /// A rendered roof and one of its facets.
    fn scene_and_facet() -> (Scene, Facet) {
        let (scene, truth) = gable_scene(320);
        let (plane, outer) = truth.facets[0].clone();
        let facet = Facet {
            building: BuildingId(0),
            plane,
            outer,
            holes: Vec::new(),
            similarity: 0.0,
            real_ratio: 0.0,
            lines: Vec::new(),
            half_planes: Vec::new(),
            rectangles: Vec::new(),
        };
        (scene, facet)
    }

    /// Do the better half of the pairs of views, and all of them, speak against a facet, where `hidden` views are not asked?
    fn against(scene: &Scene, facet: &Facet, hidden: &[usize]) -> [bool; 2] {
        let map = map_inside(scene, facet, 0.1, &|view, _| hidden.contains(&view.index()));
        let sums = inside(facet, &map).sums(MIN_CORRELATION);
        assert!(sums.weight > 100.0, "the texture is strong");
        [sums.speaks_against(), sums.speaks_against_overall()]
    }

    #[test]
    fn the_views_that_see_a_facet_verify_it_whatever_the_others_show() {
        let (mut scene, facet) = scene_and_facet();
        assert_eq!(against(&scene, &facet, &[]), [false, false]);
        for view in &mut scene.views[..3] {
            view.gray.data.reverse();
        }
        assert_eq!(against(&scene, &facet, &[]), [false, true]);
        assert_eq!(against(&scene, &facet, &[0, 1, 2]), [false, false]);
    }

    #[test]
    fn a_plane_that_the_better_half_excuses_is_refused_by_all_views() {
        let (scene, facet) = scene_and_facet();
        let raised = |by: f64| {
            let by = Vector3::z() * by;
            let outer = facet.outer.iter().map(|p| p + by).collect();
            let d = facet.plane.d - facet.plane.normal.dot(&by);
            let plane = Plane { d, ..facet.plane };
            Facet {
                plane,
                outer,
                ..facet.clone()
            }
        };
        let found: Vec<[bool; 2]> = (0..20)
            .map(|step| against(&scene, &raised(0.05 * f64::from(step)), &[]))
            .collect();
        assert_eq!((found[0], found[19]), ([false; 2], [true; 2]));
        assert!(found.contains(&[false, true]) && !found.contains(&[true, false]));
    }
}
