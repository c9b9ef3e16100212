//! Planes between parallel 3D lines (W96 3.6).
//!
//! Each pair of parallel lines defines a plane; the image lines that cross it show where it ends
//! ([`ends`]); and radiometry separates true planes from false ones. W96 sums geometric and
//! radiometric criteria up in one measure without writing it down. Here
//!
//! ```text
//! M = sum over the area of  weight (rise - least_rise)
//!   + side_weight  sum over the sides of  length (support - least_support)       square metres
//!   - plane_cost - slant_cost (ends that are not at right angles)
//! ```
//!
//! * the first sum is the paper's criterion that "the area ... inside the 3D plane should be
//!   radiometrically homogeneous over all images": the views, warped to the plane, are compared by
//!   correlation (`photoconsistency`), with little weight where there is no texture. They
//!   must agree better than on planes a little above and below, and the rise is the median by how
//!   much they do: smooth surfaces correlate on any plane near them, so that a fixed level of
//!   correlation lets many false planes through (of 910 candidates of the rendered scenes the
//!   difference separates true from false in 88 of 100 pairs, correlation alone in 80). The median,
//!   because what stands on a roof agrees above it;
//! * the second is its geometry, and the contrast of its lines, since only lines with contrast are
//!   region boundaries: support is the share of a side that image lines cover, mean over all views.
//!
//! Of the polygons between two lines those with the largest M are kept as candidates. A pair of
//! lines may hold several, with gaps between them: U-shapes. A line with an end of a perpendicular,
//! higher one makes a triangle: the end of a hip below its ridge.
//!
//! ```text
//! strip             the plane between two parallel lines
//! ends              where crossing image lines end it
//! shapes            quadrilaterals and triangles between ends
//! occluding_solids  buildings below planes found already, which hide others
//! plane_evidence    agreement of the views on the plane and on displaced planes
//! candidate         plane candidates and rejections
//! selection         the best non-overlapping set
//! ```
//!
//! Invariant: the chosen candidates do not overlap in plan but for the errors of their ends.

mod candidate;
mod ends;
mod occluding_solids;
mod plane_evidence;
mod selection;
mod shapes;
mod strip;

pub use candidate::{PlaneCandidate, PlaneRejection, PlaneTrace};
pub use ends::{Crossing, PlaneEnd};
pub(crate) use occluding_solids::OccludingSolid;
pub(crate) use selection::best_set;

use nalgebra::Point3;

use self::ends::{crossings, ends, slanted_ends};
use self::occluding_solids::partly_hidden;
use self::plane_evidence::{CHANCE, PlaneAgreement, PlaneConsistency, area_2d};
use self::shapes::{StripLine, StripPolygon, quadrilaterals, triangle};
use self::strip::PlaneStrip;
use super::clusters::{ClusterAxes, ClusterLine, overlap};
use super::image_lines::ImageLine;
use crate::execution::{SILENT, Sharded, sharded_map};
use crate::geometry::Plane;
use crate::params::PlaneParams;
use crate::scene::Scene;
use crate::terrain::Ground;

/// What the search for planes works on: one window, one pair of main directions.
pub(crate) struct PlaneSearch<'a> {
    pub scene: &'a Scene,
    pub image_lines: &'a [ImageLine<'a>],
    pub lines: &'a [ClusterLine],
    pub ground: &'a Ground,
    /// Buildings below planes found before, which may hide other planes.
    pub solids: &'a [OccludingSolid],
    pub params: &'a PlaneParams,
}

impl PlaneSearch<'_> {
    /// All candidates between pairs of lines that run along `axes.u`, given by index.
    pub(super) fn candidates(
        &self,
        axes: &ClusterAxes,
        members: &[usize],
    ) -> Sharded<(Vec<PlaneCandidate>, Vec<PlaneTrace>)> {
        let along: Vec<StripLine> = members
            .iter()
            .map(|&k| self.along(axes, &self.lines[k]))
            .collect();
        let pairs: Vec<[usize; 2]> = (0..members.len())
            .flat_map(|i| (i + 1..members.len()).map(move |j| [i, j]))
            .collect();
        let results = sharded_map("planes", &pairs, SILENT, |_, &[i, j]| {
            let (mut candidates, mut trace) = self.pair(axes, [&along[i], &along[j]]);
            trace.lines = [members[i], members[j]];
            candidates
                .iter_mut()
                .for_each(|c| c.lines = trace.lines.into());
            (candidates, trace)
        })?;
        let (mut candidates, mut traces) = (Vec::new(), Vec::new());
        for (found, trace) in results {
            candidates.extend(found);
            traces.push(trace);
        }
        Ok((candidates, traces))
    }

    /// Candidates of a pair of lines that the known solids hide in part.
    pub(super) fn candidates_between(
        &self,
        axes: &ClusterAxes,
        lines: [usize; 2],
    ) -> Vec<PlaneCandidate> {
        let [a, b] = lines.map(|k| self.along(axes, &self.lines[k]));
        let (mut candidates, _) = self.pair(axes, [&a, &b]);
        candidates.iter_mut().for_each(|c| c.lines = lines.into());
        candidates
    }

    /// Triangles below the ends of higher lines, `apexes`, on the lines that run along `axes.u`.
    pub(super) fn triangles(
        &self,
        axes: &ClusterAxes,
        members: &[usize],
        apexes: &[Point3<f64>],
    ) -> Sharded<Vec<PlaneCandidate>> {
        let found = sharded_map("planes", members, SILENT, |_, &k| {
            let base = self.along(axes, &self.lines[k]);
            let mut found: Vec<PlaneCandidate> = apexes
                .iter()
                .flat_map(|apex| self.triangle(axes, &base, apex))
                .collect();
            found.iter_mut().for_each(|c| c.lines = vec![k]);
            found
        })?;
        Ok(found.into_iter().flatten().collect())
    }

    fn triangle(
        &self,
        axes: &ClusterAxes,
        base: &StripLine,
        apex: &Point3<f64>,
    ) -> Option<PlaneCandidate> {
        let top = axes.u.dot(&apex.coords);
        let inside = base.range[0] < top && top < base.range[1] && apex.z > base.place[1] + 0.3;
        inside.then_some(())?;
        let tip = StripLine {
            range: base.range,
            place: [axes.v.dot(&apex.coords), apex.z],
            stretches: Vec::new(),
        };
        let strip = self.strip(axes, [base, &tip]).ok()?;
        let crossings = crossings(&strip, self.image_lines, self.params);
        let views = self.scene.views.len();
        let starts = base.range.map(|u| [u, top]);
        let ends = slanted_ends(&strip, &crossings, &starts, views, self.params);
        let shape = triangle(&strip, base, top, &ends, views, self.params)?;
        self.measured(&strip, vec![shape]).pop()
    }

    fn along(&self, axes: &ClusterAxes, line: &ClusterLine) -> StripLine {
        let [a, b] = [line.segment.p0, line.segment.p1].map(|p| axes.u.dot(&p.coords));
        let z = line.segment.p0.z;
        let stretch = |&k: &usize| {
            let image_line = &self.image_lines[k];
            let [p, q] = image_line.ends_at(z).map(|p| axes.u.dot(&p.coords));
            (image_line.view, [p.min(q), p.max(q)])
        };
        StripLine {
            range: [a.min(b), a.max(b)],
            place: [axes.v.dot(&line.segment.p0.coords), z],
            stretches: line.supports.iter().map(stretch).collect(),
        }
    }

    fn pair(&self, axes: &ClusterAxes, pair: [&StripLine; 2]) -> (Vec<PlaneCandidate>, PlaneTrace) {
        let mut trace = PlaneTrace {
            lines: [0; 2],
            rejection: None,
            crossings: Vec::new(),
            ends: Vec::new(),
        };
        let strip = match self.strip(axes, pair) {
            Ok(strip) => strip,
            Err(reason) => {
                trace.rejection = Some(reason);
                return (Vec::new(), trace);
            }
        };
        trace.crossings = crossings(&strip, self.image_lines, self.params);
        let line_ends: Vec<f64> = pair.iter().flat_map(|a| a.range).collect();
        trace.ends = ends(
            &strip,
            &trace.crossings,
            &line_ends,
            self.scene.views.len(),
            self.params,
        );
        let shapes = quadrilaterals(
            &strip,
            pair,
            &trace.ends,
            self.scene.views.len(),
            self.params,
        );
        if shapes.is_empty() {
            trace.rejection = Some(PlaneRejection::NoEnds);
            return (Vec::new(), trace);
        }
        let found = self.measured(&strip, shapes);
        if found.is_empty() {
            trace.rejection = Some(PlaneRejection::Weak);
        }
        (found, trace)
    }

    fn strip(
        &self,
        axes: &ClusterAxes,
        [a, b]: [&StripLine; 2],
    ) -> Result<PlaneStrip, PlaneRejection> {
        let p = self.params;
        let range = [a.range[0].min(b.range[0]), a.range[1].max(b.range[1])];
        let shorter = (a.range[1] - a.range[0]).min(b.range[1] - b.range[0]);
        let strip = PlaneStrip::new(axes, a.place, b.place, range).ok_or(PlaneRejection::Shape)?;
        let steepest = crate::math::cos(p.max_slope_deg.to_radians());
        let shaped = strip.plane.normal.z >= steepest
            && (p.min_width_m..=p.max_width_m).contains(&strip.width)
            && overlap(a.range, b.range) >= 0.3 * shorter;
        if !shaped {
            return Err(PlaneRejection::Shape);
        }
        let middle = strip.point(0.5 * (range[0] + range[1]), 0.5 * strip.width);
        let ground = self.ground.z_at(&middle.xy());
        let low = a.place[1].min(b.place[1]) - ground;
        if middle.z - ground < p.min_height_m || low < 0.7 * p.min_height_m {
            return Err(PlaneRejection::NearGround);
        }
        Ok(strip)
    }

    /// The best shapes of a strip by the measure, those with a positive one.
    fn measured(&self, strip: &PlaneStrip, mut shapes: Vec<StripPolygon>) -> Vec<PlaneCandidate> {
        let plane = &strip.plane;
        let in_front = self.solids.iter().filter(|s| s.stands_above(plane));
        let solids: Vec<OccludingSolid> = in_front.cloned().collect();
        if !self.solids.is_empty() {
            shapes.retain(|s| partly_hidden(self.scene, &solids, &s.ring(strip)));
        }
        let rings: Vec<Vec<Point3<f64>>> = shapes.iter().map(|s| s.ring(strip)).collect();
        let Some(consistency) = PlaneConsistency::new(self.scene, plane, &rings, &solids) else {
            return Vec::new();
        };
        let promising: Vec<(StripPolygon, Vec<Point3<f64>>, PlaneAgreement)> = shapes
            .into_iter()
            .zip(rings)
            .map(|(shape, ring)| (consistency.agreement(&ring), shape, ring))
            .filter(|(on, shape, ring)| {
                self.measure(plane, ring, shape, on, on.median - CHANCE)
                    .is_some()
            })
            .map(|(on, shape, ring)| (shape, ring, on))
            .collect();
        if promising.is_empty() {
            return Vec::new();
        }
        let displaced = consistency.displaced(self.params.beside_px);
        let mut found: Vec<PlaneCandidate> = promising
            .into_iter()
            .filter_map(|(shape, ring, on)| {
                let rise = consistency.rise(&displaced, &ring);
                let measure = self.measure(plane, &ring, &shape, &on, rise)?;
                Some(PlaneCandidate {
                    plane: *plane,
                    ring,
                    lines: Vec::new(),
                    support: shape.support,
                    correlation: on.correlation,
                    rise,
                    measure,
                })
            })
            .collect();
        found.sort_by(|a, b| b.measure.total_cmp(&a.measure));
        found.truncate(self.params.max_candidates);
        found
    }

    /// The measure M; `None` where it is too small.
    fn measure(
        &self,
        plane: &Plane,
        ring: &[Point3<f64>],
        shape: &StripPolygon,
        on: &PlaneAgreement,
        rise: f64,
    ) -> Option<f64> {
        let p = self.params;
        let area = area_2d(ring) / plane.normal.z;
        let measure = area * on.weight * (rise - p.least_rise)
            + p.side_weight_m * shape.length * (shape.support - p.least_support)
            - p.plane_cost_m2
            - p.slant_cost_m2 * shape.slants as f64;
        let accepted = measure > p.min_measure_m2
            && area >= p.min_area_m2
            && on.correlation >= p.least_correlation
            && rise >= p.min_rise;
        accepted.then_some(measure)
    }
}
