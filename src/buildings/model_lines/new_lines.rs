//! New lines (B99 4.2, 4.3): the edges of the roof model that no matched line explains.
//!
//! "New lines are created when two neighbouring planes intersect in a consistent way": a ridge
//! between two sides that the sun lights alike is seen in no image, yet the planes know where it
//! is. Borders of facets are new lines too where most images that can see them, looked at again,
//! show an edge there, three of them in the same way: matching lost those whose background changes
//! from view to view, or that two strips see from either side. An eave along the flight line, which
//! the views of one strip show but do not determine, is determined by the plane of its roof.
//!
//! Deviation: the paper makes new lines before delineation and takes what they bound; here
//! labelling proposes borders itself, so new lines are what came of it.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point3};

use crate::geometry::{Segment2, Segment3};
use crate::ids::FacetId;
use crate::ids::ViewId;
use crate::lines2d::SegmentKind;
use crate::lines2d::{GuidedEdge, measure_edge};
use crate::lines3d::{
    Line3d, LineFit, LineOrigin, Observation, PlaneConstraint, ProjectedLine, fit_line_on,
};
use crate::lines3d::{LineSupport, SupportKind};
use crate::model::{Facet, Occluders, RoofModel};
use crate::params::Lines3dParams;
use crate::params::MatchParams;
use crate::scene::Scene;

/// Least number of views that must show a border, and their least share of those that can see it.
/// Measured on suburb, detached and campus-drone: with five or six views 4 of 18 that three showed
/// were no edges, of those that more showed 2 of 212.
const MIN_VIEWS: usize = 3;
const LEAST_SHARE: [usize; 2] = [2, 3];
/// A matched line explains an edge from which it is no farther, ground pixels.
const EXPLAINED_PX: f64 = 2.5;
/// ... to which it is parallel: cosine of 3 degrees.
const PARALLEL: f64 = 0.998_629_534_754_573_9;
/// A measured line farther from the edge of the model is another one, ground pixels.
const SAME_EDGE_PX: f64 = 2.5;
/// Facets whose heights differ by less at a common corner meet there, metres.
const MEET_M: f64 = 0.02;

/// The edges of the model, or the parts of them, that no line explains: measured again in all
/// views, and intersections of planes also without.
pub fn new_lines(
    scene: &Scene,
    lines: &[Line3d],
    model: &RoofModel,
    matching: &MatchParams,
    fitting: &Lines3dParams,
) -> Vec<Line3d> {
    let context = Context {
        scene,
        lines,
        model,
        matching,
        fitting,
        occluders: Occluders::new(&model.facets),
    };
    let edges = model_edges(&model.facets);
    let found = crate::execution::map(&edges, |_, edge| context.new_lines_of(edge));
    found.into_iter().flatten().collect()
}

/// A straight edge of the model.
struct ModelEdge {
    segment: Segment3,
    /// The facet on its left, and the one that it meets on the right.
    facets: Vec<FacetId>,
}

impl ModelEdge {
    fn origin(&self) -> LineOrigin {
        match self.facets.len() {
            2 => LineOrigin::Intersection,
            _ => LineOrigin::Border,
        }
    }
}

/// How a view may show an edge: the kind of step, and whether it is bright on the other side.
const WAYS: [(SegmentKind, bool); 4] = [
    (SegmentKind::Edge, false),
    (SegmentKind::Edge, true),
    (SegmentKind::Color, false),
    (SegmentKind::Color, true),
];

/// An edge that a view shows.
struct Shown {
    /// In which of [`WAYS`].
    ways: [bool; WAYS.len()],
    /// In that which has most of it.
    edge: GuidedEdge,
}

/// Do enough views show an edge in the same way? Two strips may see two sides of an eave, but each
/// of them sees one; where rows of texture line up by chance, any view shows any side.
fn is_alike(shown: &[Shown]) -> bool {
    let alike = |way: usize| shown.iter().filter(|s| s.ways[way]).count();
    (0..WAYS.len()).any(|way| alike(way) >= MIN_VIEWS)
}

struct Context<'a> {
    scene: &'a Scene,
    lines: &'a [Line3d],
    model: &'a RoofModel,
    matching: &'a MatchParams,
    fitting: &'a Lines3dParams,
    occluders: Occluders<'a>,
}

impl Context<'_> {
    fn new_lines_of(&self, edge: &ModelEdge) -> Vec<Line3d> {
        let Some(pixel_m) = self.ground_pixel(&edge.segment.at(0.5)) else {
            return Vec::new();
        };
        let line_of = |part: Segment3| {
            let line =
                (self.measured(edge, &part, pixel_m)).or_else(|| self.intersection(edge, &part))?;
            let origin = edge.origin();
            Some(Line3d { origin, ..line })
        };
        let parts = self.unexplained(&edge.segment, pixel_m);
        parts.into_iter().filter_map(line_of).collect()
    }

    /// Size on the ground of a pixel of the nearest view, metres.
    fn ground_pixel(&self, p: &Point3<f64>) -> Option<f64> {
        let views = self.scene.views.iter().map(|v| &v.camera);
        let seeing = views.filter(|c| c.project(p).is_some_and(|x| c.contains(&x, 0.0)));
        seeing.map(|c| c.ground_pixel(p)).min_by(f64::total_cmp)
    }

    /// The parts of an edge, not shorter than a match must be, along which no line runs that
    /// stands.
    fn unexplained(&self, edge: &Segment3, pixel_m: f64) -> Vec<Segment3> {
        let least = self.matching.min_edgels as f64 * pixel_m;
        let beside: Vec<&Segment3> = Line3d::standing(self.lines)
            .map(|(_, line)| &line.segment)
            .filter(|l| l.direction().dot(&edge.direction()).abs() >= PARALLEL)
            .collect();
        let samples = (edge.length() / pixel_m).ceil().clamp(1.0, 4096.0) as usize;
        let at = |i: usize| i as f64 / samples as f64;
        let free: Vec<bool> = (0..samples)
            .map(|i| edge.at(at(i) + 0.5 * at(1)))
            .map(|p| {
                beside
                    .iter()
                    .all(|l| distance(l, &p) > EXPLAINED_PX * pixel_m)
            })
            .collect();
        let mut parts = Vec::new();
        let mut start = 0;
        for run in free.chunk_by(|a, b| a == b) {
            let end = start + run.len();
            if run[0] && at(run.len()) * edge.length() >= least {
                parts.push(Segment3::new(edge.at(at(start)), edge.at(at(end))));
            }
            start = end;
        }
        parts
    }

    /// How many views must show the edge.
    fn least_views(&self, part: &Segment3) -> usize {
        let middle = part.at(0.5);
        let sees = |view: &ViewId| {
            let camera = self.scene.camera(*view);
            let inside = camera
                .project(&middle)
                .is_some_and(|x| camera.contains(&x, 1.0));
            inside && !self.occluders.hide(&middle, &camera.center)
        };
        let seeing = self.scene.view_ids().filter(sees).count();
        let [share, of] = LEAST_SHARE;
        (share * seeing).div_ceil(of).max(MIN_VIEWS)
    }

    /// The line through what the views show along the edge, by themselves or, where they do not
    /// determine it, in the planes of the facets that it bounds; `None` where too few agree on one.
    fn measured(&self, edge: &ModelEdge, part: &Segment3, pixel_m: f64) -> Option<Line3d> {
        let views = self.scene.view_ids();
        let shown: Vec<Shown> = views.filter_map(|v| self.measure(part, v)).collect();
        (self.few_views() || is_alike(&shown)).then_some(())?;
        let edges: Vec<GuidedEdge> = shown.into_iter().map(|s| s.edge).collect();
        let least = self.least_views(part);
        let fit =
            |carriers: &[PlaneConstraint]| self.fit(edges.clone(), least, carriers, part, pixel_m);
        fit(&[]).or_else(|| fit(&self.carriers(edge)?))
    }

    /// Is every view needed, however it shows an edge?
    fn few_views(&self) -> bool {
        self.scene.views.len() <= self.matching.min_views
    }

    /// The planes that a model edge lies in.
    fn carriers(&self, edge: &ModelEdge) -> Option<Vec<PlaneConstraint>> {
        let carrier = |f: &FacetId| {
            let facet = &self.model.facets[f.index()];
            Some(PlaneConstraint {
                plane: facet.plane,
                sigma_m: self.typical_sigma(facet)?,
            })
        };
        edge.facets.iter().map(carrier).collect()
    }

    /// The line through at least so many of the edges, without those that do not agree with it.
    fn fit(
        &self,
        mut edges: Vec<GuidedEdge>,
        least: usize,
        carriers: &[PlaneConstraint],
        part: &Segment3,
        pixel_m: f64,
    ) -> Option<Line3d> {
        let fit = loop {
            (edges.len() >= least).then_some(())?;
            let fit = fit_line_on(&self.observations(&edges), carriers, part, self.fitting)?;
            let worst = (0..edges.len()).max_by(|&i, &j| {
                let by_residual = fit.residuals[i].total_cmp(&fit.residuals[j]);
                by_residual.then(j.cmp(&i))
            })?;
            if fit.residuals[worst] <= self.fitting.max_residual {
                break fit;
            }
            edges.remove(worst);
        };
        let sigma_m = fit.sigma_at(0.0).max(fit.sigma_at(1.0));
        let moved = distance(&fit.line, &part.p0).max(distance(&fit.line, &part.p1));
        let is_it =
            moved <= SAME_EDGE_PX * pixel_m && sigma_m <= self.fitting.max_sigma_px * pixel_m;
        is_it.then(|| self.line(&fit, part, sigma_m, &edges))
    }

    fn observations(&self, edges: &[GuidedEdge]) -> Vec<Observation<'_>> {
        let observe = |e: &GuidedEdge| Observation::of(e, self.scene.camera(e.view));
        edges.iter().map(observe).collect()
    }

    /// What a view shows along the image of `part`.
    fn measure(&self, part: &Segment3, view: ViewId) -> Option<Shown> {
        let seen = self.scene.view(view);
        let image = ProjectedLine::new(&seen.camera, part)?;
        let expected = Segment2::new(image.at(0.0)?, image.at(part.length())?);
        let core = [0.0, expected.length()];
        let mut ways = [false; WAYS.len()];
        let mut most: Option<GuidedEdge> = None;
        for (way, (kind, against)) in ways.iter_mut().zip(WAYS) {
            let channel = seen.channel(kind.channel());
            let found = measure_edge(view, channel, kind, &expected, core, against);
            *way = found.is_some();
            let pieces = |edge: &Option<GuidedEdge>| edge.as_ref().map_or(0, |e| e.pieces.len());
            if pieces(&found) > pieces(&most) {
                most = found;
            }
        }
        Some(Shown { ways, edge: most? })
    }

    fn line(&self, fit: &LineFit, part: &Segment3, sigma_m: f64, edges: &[GuidedEdge]) -> Line3d {
        let direction = fit.line.direction();
        let foot = |p: &Point3<f64>| fit.line.p0 + direction * (p - fit.line.p0).dot(&direction);
        let support = |e: &GuidedEdge| {
            let pieces: f64 = e.pieces.iter().map(|p| p.length()).sum();
            LineSupport {
                view: e.view,
                segments: Vec::new(),
                stretch: e.segment,
                score: (pieces / e.segment.length().max(1e-9)).min(1.0),
                kind: SupportKind::Grown,
                edge: Some(e.clone()),
            }
        };
        Line3d {
            origin: LineOrigin::Border,
            segment: Segment3::new(foot(&part.p0), foot(&part.p1)),
            sigma_m,
            covariance: [0.0, 1.0].map(|t| fit.covariance_at(t)),
            supports: edges.iter().map(support).collect(),
            refuted: None,
        }
    }

    /// The intersection of the two planes beside an edge, as certain as the lines in them and the
    /// angle between them let it be.
    fn intersection(&self, edge: &ModelEdge, part: &Segment3) -> Option<Line3d> {
        let [first, second] = edge.facets[..] else {
            return None;
        };
        let planes = [first, second].map(|f| &self.model.facets[f.index()]);
        let sine = planes[0].plane.normal.cross(&planes[1].plane.normal).norm();
        let [a, b] = planes.map(|f| self.typical_sigma(f));
        let (a, b) = (a?, b?);
        let sigma_m = (a * a + b * b).sqrt() / sine.max(1e-3);
        let direction = part.direction();
        let across = Matrix3::identity() - direction * direction.transpose();
        let pixel_m = self.ground_pixel(&part.at(0.5))?;
        (sigma_m <= self.fitting.max_sigma_px * pixel_m).then(|| Line3d {
            origin: LineOrigin::Intersection,
            segment: *part,
            sigma_m,
            covariance: [across * (sigma_m * sigma_m); 2],
            supports: Vec::new(),
            refuted: None,
        })
    }

    /// Median standard deviation of the lines in a facet, metres.
    fn typical_sigma(&self, facet: &Facet) -> Option<f64> {
        let of_line = |l: &crate::ids::LineId| self.lines.get(l.index()).map(|l| l.sigma_m);
        let mut sigmas: Vec<f64> = facet.lines.iter().filter_map(of_line).collect();
        crate::math::median(&mut sigmas)
    }
}

/// Distance of a point from the stretch, metres.
fn distance(stretch: &Segment3, p: &Point3<f64>) -> f64 {
    let t = (p - stretch.p0).dot(&stretch.direction());
    let t = t.clamp(0.0, stretch.length());
    (p - (stretch.p0 + stretch.direction() * t)).norm()
}

/// Sides of all facets: collinear ones in a row are one edge, what two facets share is listed once,
/// and the feet of walls (a higher facet has the same side) are left out.
fn model_edges(facets: &[Facet]) -> Vec<ModelEdge> {
    let beyond = Beyond::new(facets);
    let mut edges = Vec::new();
    for (f, facet) in facets.iter().enumerate() {
        let id = FacetId::from_index(f);
        for ring in [&facet.outer].into_iter().chain(&facet.holes) {
            for (side, beyond) in straight_sides(ring, |a, b| beyond.of(id, a, b)) {
                let facets = match beyond {
                    Neighbour::None | Neighbour::Lower => vec![id],
                    Neighbour::Meets(other) if id < other => vec![id, other],
                    Neighbour::Meets(_) | Neighbour::Higher => continue,
                };
                edges.push(ModelEdge {
                    segment: side,
                    facets,
                });
            }
        }
    }
    edges
}

/// What lies on the right of a side.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Neighbour {
    None,
    Lower,
    Higher,
    Meets(FacetId),
}

/// The sides of a ring with what is beyond them, collinear ones with the same neighbour joined.
fn straight_sides(
    ring: &[Point3<f64>],
    beyond: impl Fn(&Point3<f64>, &Point3<f64>) -> Neighbour,
) -> Vec<(Segment3, Neighbour)> {
    let n = ring.len();
    let sides: Vec<(Segment3, Neighbour)> = (0..n)
        .map(|i| (&ring[i], &ring[(i + 1) % n]))
        .filter(|(a, b)| (*b - *a).norm() > 1e-6)
        .map(|(a, b)| (Segment3::new(*a, *b), beyond(a, b)))
        .collect();
    let goes_on = |a: &(Segment3, Neighbour), b: &(Segment3, Neighbour)| {
        a.1 == b.1 && a.0.direction().dot(&b.0.direction()) > 1.0 - 1e-6
    };
    // From a corner on, so that no side is cut where the ring happens to begin.
    let count = sides.len();
    let corner = (0..count).find(|&i| !goes_on(&sides[(i + count - 1) % count.max(1)], &sides[i]));
    let mut joined: Vec<(Segment3, Neighbour)> = Vec::new();
    for k in 0..count {
        let side = sides[(corner.unwrap_or(0) + k) % count];
        match joined.last_mut() {
            Some(last) if goes_on(last, &side) => last.0 = Segment3::new(last.0.p0, side.0.p1),
            _ => joined.push(side),
        }
    }
    joined
}

/// Bits of two plan positions: facets of one building share corners exactly.
type Side = [u64; 4];

/// Which facets have a side, and at which heights.
struct Beyond {
    sides: BTreeMap<Side, Vec<(FacetId, [f64; 2])>>,
}

impl Beyond {
    fn new(facets: &[Facet]) -> Self {
        let mut sides: BTreeMap<Side, Vec<(FacetId, [f64; 2])>> = BTreeMap::new();
        for (f, facet) in facets.iter().enumerate() {
            for ring in [&facet.outer].into_iter().chain(&facet.holes) {
                for (i, a) in ring.iter().enumerate() {
                    let b = &ring[(i + 1) % ring.len()];
                    let owner = (FacetId::from_index(f), [a.z, b.z]);
                    sides.entry(key(a, b)).or_default().push(owner);
                }
            }
        }
        Self { sides }
    }

    /// What is on the other side of a side of `facet`.
    fn of(&self, facet: FacetId, a: &Point3<f64>, b: &Point3<f64>) -> Neighbour {
        let reversed = self.sides.get(&key(b, a)).into_iter().flatten();
        let Some((other, [zb, za])) = reversed.copied().find(|(f, _)| *f != facet) else {
            return Neighbour::None;
        };
        let (da, db) = (za - a.z, zb - b.z);
        if da.abs() < MEET_M && db.abs() < MEET_M {
            Neighbour::Meets(other)
        } else if da + db > 0.0 {
            Neighbour::Higher
        } else {
            Neighbour::Lower
        }
    }
}

fn key(a: &Point3<f64>, b: &Point3<f64>) -> Side {
    [a.x, a.y, b.x, b.y].map(f64::to_bits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::BuildingId;
    use crate::ids::LineId;
    use crate::lines3d::Refutation;
    use crate::synthetic::{SyntheticTruth, hip_scene};
    use nalgebra::{Matrix2, Point2};

    fn model(truth: &SyntheticTruth, lines: &[LineId]) -> RoofModel {
        let facet = |(plane, outer): &(crate::geometry::Plane, Vec<Point3<f64>>)| Facet {
            building: BuildingId(0),
            plane: *plane,
            outer: outer.clone(),
            holes: Vec::new(),
            similarity: 1.0,
            real_ratio: 1.0,
            lines: lines.to_vec(),
            half_planes: Vec::new(),
            rectangles: Vec::new(),
        };
        RoofModel {
            facets: truth.facets.iter().map(facet).collect(),
            buildings: Vec::new(),
        }
    }

    fn found(scene: &Scene, lines: &[Line3d], model: &RoofModel) -> Vec<Line3d> {
        let (matching, fitting) = (MatchParams::default(), Lines3dParams::default());
        new_lines(scene, lines, model, &matching, &fitting)
    }

    fn known(segment: Segment3) -> Line3d {
        Line3d {
            origin: LineOrigin::Matched,
            segment,
            sigma_m: 0.03,
            covariance: [Matrix3::zeros(); 2],
            supports: Vec::new(),
            refuted: None,
        }
    }

    #[test]
    fn every_edge_of_a_hip_roof_is_found_once() {
        let (scene, truth) = hip_scene(320);
        let lines = found(&scene, &[], &model(&truth, &[]));
        for edge in &truth.edges {
            let on_edge = |l: &&Line3d| {
                let ends = [l.segment.p0, l.segment.p1];
                ends.iter().all(|p| distance(edge, p) < 0.1)
                    && l.segment.length() > 0.8 * edge.length()
            };
            assert_eq!(lines.iter().filter(on_edge).count(), 1, "{edge:?}");
        }
        assert_eq!(lines.len(), truth.edges.len());
        let intersections = lines
            .iter()
            .filter(|l| l.origin == LineOrigin::Intersection);
        assert_eq!(intersections.count(), 5, "a ridge and four hips");
        assert!(lines.iter().all(|l| l.supports.len() >= MIN_VIEWS));
    }

    #[test]
    fn what_a_line_explains_is_not_found_again() {
        let (scene, truth) = hip_scene(320);
        let known_lines: Vec<Line3d> = truth.edges.iter().map(|e| known(*e)).collect();
        assert!(found(&scene, &known_lines, &model(&truth, &[])).is_empty());
        // Half an edge leaves the other half.
        let mut half = known_lines.clone();
        let edge = truth.edges[0];
        half[0] = known(Segment3::new(edge.p0, edge.at(0.5)));
        let lines = found(&scene, &half, &model(&truth, &[]));
        assert_eq!(lines.len(), 1);
        let length = lines[0].segment.length();
        assert!(
            length < 0.55 * edge.length() && length > 0.35 * edge.length(),
            "{length}"
        );
        // A line that cannot be explains nothing.
        let mut refuted = known_lines;
        refuted[0].refuted = Some(Refutation::Afloat);
        assert_eq!(found(&scene, &refuted, &model(&truth, &[])).len(), 1);
    }

    #[test]
    fn three_views_must_show_a_border_in_the_same_way() {
        let shown = |ways: &[&[usize]]| {
            let view = |(view, ways): (usize, &&[usize])| Shown {
                ways: [0, 1, 2, 3].map(|way| ways.contains(&way)),
                edge: GuidedEdge {
                    view: ViewId(view as u32),
                    kind: SegmentKind::Edge,
                    segment: Segment2::new(Point2::origin(), Point2::new(9.0, 0.0)),
                    covariance: Matrix2::identity(),
                    pieces: Vec::new(),
                },
            };
            is_alike(&ways.iter().enumerate().map(view).collect::<Vec<_>>())
        };
        assert!(shown(&[&[0], &[0], &[0], &[1]]));
        assert!(
            !shown(&[&[0], &[0], &[1], &[1], &[2], &[3]]),
            "any side in any view"
        );
        assert!(shown(&[&[0, 2], &[1, 2], &[2]]), "in colour");
    }

    #[test]
    fn planes_intersect_where_no_image_shows_it_and_borders_need_images() {
        let (mut scene, truth) = hip_scene(320);
        for view in &mut scene.views {
            view.gray.data.fill(0.5);
            view.red_blue = None;
        }
        // A line far away, to which the facets owe their certainty.
        let far = known(Segment3::new(
            Point3::new(90.0, 90.0, 0.0),
            Point3::new(95.0, 90.0, 0.0),
        ));
        let lines = found(&scene, &[far], &model(&truth, &[LineId(0)]));
        assert_eq!(lines.len(), 5);
        for line in &lines {
            assert_eq!(line.origin, LineOrigin::Intersection);
            assert!(line.sigma_m > 0.03 && line.supports.is_empty());
        }
        assert!(found(&scene, &[], &model(&truth, &[])).is_empty());
    }

    #[test]
    fn the_planes_of_roofs_determine_what_one_strip_does_not() {
        let (mut scene, truth) = hip_scene(320);
        scene.views.truncate(3);
        let far = known(Segment3::new(
            Point3::new(90.0, 90.0, 0.0),
            Point3::new(95.0, 90.0, 0.0),
        ));
        // Half a decimetre. The ridge, two eaves and two hips run within 35 degrees of the strip,
        // which leaves a decimetre.
        let fitting = Lines3dParams {
            max_sigma_px: 0.6,
            ..Lines3dParams::default()
        };
        let found = |lines: &[LineId]| {
            let (matching, model) = (MatchParams::default(), model(&truth, lines));
            new_lines(
                &scene,
                std::slice::from_ref(&far),
                &model,
                &matching,
                &fitting,
            )
        };
        let along = (scene.views[2].camera.center - scene.views[0].camera.center).normalize();
        let is_along = |l: &Line3d| l.segment.direction().dot(&along).abs() > 0.8;
        assert!(
            !found(&[]).iter().any(is_along),
            "nothing is known of the planes"
        );
        let lines = found(&[LineId(0)]);
        assert_eq!(lines.iter().filter(|l| is_along(l)).count(), 5);
        assert_eq!(lines.len(), truth.edges.len());
        for line in &lines {
            let ends = [line.segment.p0, line.segment.p1];
            let is_near = |e: &Segment3| ends.iter().all(|p| distance(e, p) < 0.1);
            assert!(truth.edges.iter().any(is_near), "{:?}", line.segment);
            assert!(line.supports.len() >= MIN_VIEWS && line.sigma_m < 0.05);
        }
    }

    #[test]
    fn two_thirds_of_the_views_that_see_a_border_must_show_it() {
        let (scene, truth) = hip_scene(320);
        let borders = |blank: usize| {
            let mut scene = scene.clone();
            for view in &mut scene.views[..blank] {
                view.gray.data.fill(0.5);
                view.red_blue = None;
            }
            found(&scene, &[], &model(&truth, &[])).len()
        };
        assert_eq!([0, 2].map(borders), [truth.edges.len(); 2]);
        assert_eq!(borders(3), 0, "three of six");
    }

    #[test]
    fn of_two_roofs_side_by_side_the_higher_one_has_the_edge() {
        let flat = |x0: f64, x1: f64, z: f64| {
            let corners = [(x0, 0.0), (x1, 0.0), (x1, 6.0), (x0, 6.0)];
            Facet {
                building: BuildingId(0),
                plane: crate::geometry::Plane {
                    normal: nalgebra::Vector3::z(),
                    d: -z,
                },
                outer: corners.map(|(x, y)| Point3::new(x, y, z)).to_vec(),
                holes: Vec::new(),
                similarity: 1.0,
                real_ratio: 1.0,
                lines: Vec::new(),
                half_planes: Vec::new(),
                rectangles: Vec::new(),
            }
        };
        let edges = model_edges(&[flat(0.0, 4.0, 5.0), flat(4.0, 9.0, 8.0)]);
        // Three sides of the lower roof, four of the higher one; where they touch, the higher one's
        // alone.
        assert_eq!(edges.len(), 7);
        let between = |e: &&ModelEdge| e.segment.p0.x == 4.0 && e.segment.p1.x == 4.0;
        let shared: Vec<&ModelEdge> = edges.iter().filter(between).collect();
        assert_eq!(shared.len(), 1);
        assert_eq!(shared[0].facets, [FacetId(1)]);
        // At one height they meet, and the edge is listed once with both.
        let edges = model_edges(&[flat(0.0, 4.0, 5.0), flat(4.0, 9.0, 5.0)]);
        let shared: Vec<&ModelEdge> = edges.iter().filter(between).collect();
        assert_eq!(shared.len(), 1);
        assert_eq!(shared[0].facets, [FacetId(0), FacetId(1)]);
    }
}
