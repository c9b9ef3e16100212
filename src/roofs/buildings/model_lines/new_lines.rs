//! New lines (B99 4.2, 4.3): the edges of the roof model that no matched line explains.
//!
//! "New lines are created when two neighbouring planes intersect in a consistent way": no image
//! shows a ridge between two equally lit sides, but the two planes determine it. Borders of facets
//! are new lines too if most of the images that can see them show an edge there when measured
//! again, three of them with the same polarity. Matching misses edges whose background changes from
//! view to view, or which two strips see from either side. An eave along the flight line, which the
//! views of one strip show but do not determine, is determined by the plane of its roof.
//!
//! Deviation: the paper makes new lines before delineation and takes what they bound; here
//! labelling proposes the borders itself, and new lines follow from its result.

use nalgebra::{Matrix3, Point3};

use super::model_edges::{ModelEdge, model_edges};
use crate::base::geometry::{Segment2, Segment3};
use crate::base::ids::{FacetId, LineId, ViewId};
use crate::base::line_linker::LineLinker;
use crate::base::math::larger;
use crate::base::params::{Lines3dParams, MatchParams};
use crate::lines::lines2d::{GuidedEdge, SegmentKind, measure_edge};
use crate::lines::lines3d::{
    Line3d, LineFit, LineOrigin, LineSupport, Observation, PlaneConstraint, ProjectedLine,
    SupportKind, fit_line_on,
};
use crate::orienting::scene::Scene;
use crate::roofs::model::{Facet, Occluders, RoofModel};

/// Least number of views that must show a border, and their least share of those that can see it.
/// Measured on suburb, detached and campus-drone: with five or six views 4 of 18 that three showed
/// were no edges, of those that more showed 2 of 212.
const MIN_VIEWS: usize = 3;
const MIN_VIEW_SHARE: [usize; 2] = [2, 3];

/// The edges of the model, or the parts of them, that no line explains: measured again in all
/// views, and intersections of planes also without.
pub(super) fn new_lines(
    scene: &Scene,
    lines: &[Line3d],
    model: &RoofModel,
    matching: &MatchParams,
    fitting: &Lines3dParams,
) -> Vec<Line3d> {
    let search = NewLineSearch {
        scene,
        lines,
        model,
        matching,
        fitting,
        occluders: Occluders::new(&model.facets),
    };
    let edges = model_edges(&model.facets);
    let found = crate::base::execution::map(&edges, |_, edge| search.new_lines_of(edge));
    found.into_iter().flatten().collect()
}

/// The polarities of an edge in a view: the channel, and whether the contrast is reversed.
const EDGE_POLARITIES: [(SegmentKind, bool); 4] = [
    (SegmentKind::Edge, false),
    (SegmentKind::Edge, true),
    (SegmentKind::Color, false),
    (SegmentKind::Color, true),
];

/// An edge that a view shows.
struct EdgeInView {
    /// Which of [`EDGE_POLARITIES`] the view shows.
    polarities: [bool; EDGE_POLARITIES.len()],
    /// The edge in the polarity that shows most of it.
    edge: GuidedEdge,
}

/// Do enough views show an edge with the same polarity? Two strips may see the two sides of an
/// eave, each strip one; chance alignments of texture have any polarity in any view.
fn agree_in_polarity(edges_in_views: &[EdgeInView]) -> bool {
    let alike = |polarity: usize| {
        edges_in_views
            .iter()
            .filter(|s| s.polarities[polarity])
            .count()
    };
    (0..EDGE_POLARITIES.len()).any(|polarity| alike(polarity) >= MIN_VIEWS)
}

struct NewLineSearch<'a> {
    scene: &'a Scene,
    lines: &'a [Line3d],
    model: &'a RoofModel,
    matching: &'a MatchParams,
    fitting: &'a Lines3dParams,
    occluders: Occluders<'a>,
}

impl NewLineSearch<'_> {
    fn new_lines_of(&self, edge: &ModelEdge) -> Vec<Line3d> {
        let Some(pixel_m) = self.ground_pixel(&edge.segment.at(0.5)) else {
            return Vec::new();
        };
        let line_of = |part: Segment3| {
            let facets = edge.facets.iter().map(|f| &self.model.facets[f.index()]);
            // A border is there if one of its facets is, an intersection if both are.
            let likelier = facets.map(|f| f.probability).fold(0.0, larger);
            let border = self.measured(edge, &part, pixel_m).map(|line| Line3d {
                probability: likelier,
                ..line
            });
            let line = border.or_else(|| self.intersection(edge, &part))?;
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

    /// The parts of an edge, not shorter than a match must be, along which no standing line runs.
    fn unexplained(&self, edge: &Segment3, pixel_m: f64) -> Vec<Segment3> {
        let least = self.matching.min_edgels as f64 * pixel_m;
        let (linker, direction) = (LineLinker::explained_edge(pixel_m), edge.direction());
        let beside: Vec<[Point3<f64>; 2]> = Line3d::standing(self.lines)
            .map(|(_, line)| line.segment.ends())
            .filter(|[p, q]| linker.angle(&direction, &(q - p)) >= 0.0)
            .collect();
        let samples = (edge.length() / pixel_m).ceil().clamp(1.0, 4096.0) as usize;
        let at = |i: usize| i as f64 / samples as f64;
        let free: Vec<bool> = (0..samples)
            .map(|i| edge.at(at(i) + 0.5 * at(1)))
            .map(|p| !beside.iter().any(|line| linker.passes(line, &p)))
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
    fn required_views(&self, part: &Segment3) -> usize {
        let middle = part.at(0.5);
        let sees = |view: &ViewId| {
            let camera = self.scene.camera(*view);
            let inside = camera
                .project(&middle)
                .is_some_and(|x| camera.contains(&x, 1.0));
            inside && !self.occluders.hide(&middle, &camera.center)
        };
        let seeing = self.scene.view_ids().filter(sees).count();
        let [share, of] = MIN_VIEW_SHARE;
        (share * seeing).div_ceil(of).max(MIN_VIEWS)
    }

    /// The line fitted to the edges in the views or, where these do not determine it, to them and
    /// the planes of the facets that it bounds; `None` where too few views agree on one.
    fn measured(&self, edge: &ModelEdge, part: &Segment3, pixel_m: f64) -> Option<Line3d> {
        let views = self.scene.view_ids();
        let edges_in_views: Vec<EdgeInView> = views.filter_map(|v| self.measure(part, v)).collect();
        (self.needs_every_view() || agree_in_polarity(&edges_in_views)).then_some(())?;
        let edges: Vec<GuidedEdge> = edges_in_views.into_iter().map(|s| s.edge).collect();
        let least = self.required_views(part);
        let fit =
            |carriers: &[PlaneConstraint]| self.fit(edges.clone(), least, carriers, part, pixel_m);
        fit(&[]).or_else(|| fit(&self.carriers(edge)?))
    }

    /// Are there so few views that each is needed, whatever its polarity?
    fn needs_every_view(&self) -> bool {
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
        let (linker, line) = (LineLinker::explained_edge(pixel_m), fit.line.ends());
        let is_same_edge = part.ends().iter().all(|p| linker.passes(&line, p))
            && sigma_m <= self.fitting.max_sigma_px * pixel_m;
        is_same_edge.then(|| self.line(&fit, part, sigma_m, &edges))
    }

    fn observations(&self, edges: &[GuidedEdge]) -> Vec<Observation<'_>> {
        let observe = |e: &GuidedEdge| Observation::of(e, self.scene.camera(e.view));
        edges.iter().map(observe).collect()
    }

    /// The edge of a view along the image of `part`.
    fn measure(&self, part: &Segment3, view: ViewId) -> Option<EdgeInView> {
        let seen = self.scene.view(view);
        let image = ProjectedLine::new(&seen.camera, part)?;
        let expected = Segment2::new(image.at(0.0)?, image.at(part.length())?);
        let core = [0.0, expected.length()];
        let mut polarities = [false; EDGE_POLARITIES.len()];
        let mut most: Option<GuidedEdge> = None;
        for (polarity, (kind, against)) in polarities.iter_mut().zip(EDGE_POLARITIES) {
            let channel = seen.channel(kind.channel());
            let found = measure_edge(view, channel, kind, &expected, core, against);
            *polarity = found.is_some();
            let pieces = |edge: &Option<GuidedEdge>| edge.as_ref().map_or(0, |e| e.pieces.len());
            if pieces(&found) > pieces(&most) {
                most = found;
            }
        }
        Some(EdgeInView {
            polarities,
            edge: most?,
        })
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
            probability: 1.0,
            supports: edges.iter().map(support).collect(),
            contradiction: None,
        }
    }

    /// The intersection of the two planes beside an edge, with a standard deviation propagated from
    /// the lines in them and the angle between them.
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
            probability: planes.map(|f| f.probability).iter().product(),
            supports: Vec::new(),
            contradiction: None,
        })
    }

    /// Median standard deviation of the lines in a facet, metres.
    fn typical_sigma(&self, facet: &Facet) -> Option<f64> {
        let of_line = |l: &LineId| self.lines.get(l.index()).map(|l| l.sigma_m);
        let mut sigmas: Vec<f64> = facet.lines.iter().filter_map(of_line).collect();
        crate::base::math::median(&mut sigmas)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::ids::BuildingId;
    use crate::lines::lines3d::LineContradiction;
    use crate::orienting::synthetic::{SyntheticTruth, hip_scene};
    use nalgebra::{Matrix2, Point2};

    fn model(truth: &SyntheticTruth, lines: &[LineId]) -> RoofModel {
        let facet = |(plane, outer): &(crate::base::geometry::Plane, Vec<Point3<f64>>)| Facet {
            building: BuildingId(0),
            plane: *plane,
            outer: outer.clone(),
            holes: Vec::new(),
            similarity: 1.0,
            real_ratio: 1.0,
            uncertainty: None,
            probability: 1.0,
            lines: lines.to_vec(),
            half_planes: Vec::new(),
            proposals: Vec::new(),
            obstructions: Vec::new(),
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
            probability: 1.0,
            supports: Vec::new(),
            contradiction: None,
        }
    }

    #[test]
    fn every_edge_of_a_hip_roof_is_found_once() {
        let (scene, truth) = hip_scene(320);
        let lines = found(&scene, &[], &model(&truth, &[]));
        for edge in &truth.edges {
            let on_edge = |l: &&Line3d| {
                let ends = [l.segment.p0, l.segment.p1];
                ends.iter().all(|p| edge.line_distance(p) < 0.1)
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
        let mut contradicted = known_lines;
        contradicted[0].contradiction = Some(LineContradiction::Improbable);
        assert_eq!(found(&scene, &contradicted, &model(&truth, &[])).len(), 1);
    }

    #[test]
    fn three_views_must_show_a_border_with_the_same_polarity() {
        let edges_in_views = |polarities: &[&[usize]]| {
            let view = |(view, polarities): (usize, &&[usize])| EdgeInView {
                polarities: [0, 1, 2, 3].map(|polarity| polarities.contains(&polarity)),
                edge: GuidedEdge {
                    view: ViewId(view as u32),
                    kind: SegmentKind::Edge,
                    segment: Segment2::new(Point2::origin(), Point2::new(9.0, 0.0)),
                    covariance: Matrix2::identity(),
                    pieces: Vec::new(),
                },
            };
            agree_in_polarity(&polarities.iter().enumerate().map(view).collect::<Vec<_>>())
        };
        assert!(edges_in_views(&[&[0], &[0], &[0], &[1]]));
        assert!(
            !edges_in_views(&[&[0], &[0], &[1], &[1], &[2], &[3]]),
            "any side in any view"
        );
        assert!(edges_in_views(&[&[0, 2], &[1, 2], &[2]]), "in colour");
    }

    #[test]
    fn planes_intersect_where_no_image_shows_it_and_borders_need_images() {
        let (mut scene, truth) = hip_scene(320);
        for view in &mut scene.views {
            view.gray.data.fill(0.5);
            view.red_blue = None;
        }
        // A line far away, to which the facets owe their image_evidence.
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
            let is_near = |e: &Segment3| ends.iter().all(|p| e.line_distance(p) < 0.1);
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
}
