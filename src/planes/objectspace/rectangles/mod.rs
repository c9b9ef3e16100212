//! Planes between parallel 3D lines (W96 3.6).
//!
//! Each pair of parallel lines defines a plane; the image lines that cross it show where it ends
//! ([`ends`]); and radiometry separates true planes from false ones. W96 sums geometric and
//! radiometric criteria up in one measure without writing it down. Here it is
//!
//! ```text
//! M = sum over the area of  what the windows say of the plane, and the odds of a plane
//!   - sum over the sides of  length (what a border costs, less where image lines support it)
//! ```
//!
//! in nats: by how much the energy of the labelling ([`crate::roofs::facets`]) is lower with the
//! plane than without it. A gap between two roofs speaks against a plane over both. Whether a
//! polygon is likelier true than false is asked of the model of evidence ([`PlaneFeatures`]):
//!
//! * radiometry, the paper's criterion that "the area ... inside the 3D plane should be
//!   radiometrically homogeneous over all images": what the correlation windows say of the plane,
//!   and by how much more than of planes a little above and below, for smooth surfaces correlate on
//!   any plane near them;
//! * geometry, and the contrast of its lines, since only lines with contrast are region boundaries:
//!   the share of the outline that image lines cover, mean over all views; and the slope.
//!
//! Of the polygons between two lines those with the largest M and the likeliest ones are kept. A
//! pair of lines may hold several, with gaps between them: U-shapes. A line with an end of a
//! perpendicular, higher one makes a triangle: the end of a hip below its ridge.
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

pub use candidate::{PlaneCandidate, PlaneFeatures, PlaneRejection, PlaneTrace};
pub use ends::{Crossing, PlaneEnd};
pub(crate) use occluding_solids::OccludingSolid;
pub(crate) use selection::best_set;

use nalgebra::Point3;

use self::ends::{crossings, ends, slanted_ends};
use self::occluding_solids::partly_hidden;
use self::plane_evidence::{PlaneAgreement, PlaneConsistency, plan_area};
use self::shapes::{LEAST_WIDTH_M, StripLine, StripPolygon, quadrilaterals, triangle};
use self::strip::PlaneStrip;
use super::clusters::{ClusterAxes, ClusterLine, overlap};
use super::image_lines::ImageLine;
use crate::base::evidence::ON_LINE;
use crate::base::evidence::WindowEvidenceTable;
use crate::base::execution::{SILENT, Sharded, sharded_map};
use crate::base::params::PlaneParams;
use crate::orienting::scene::Scene;
use crate::planes::terrain::Ground;

/// Most candidates kept of a pair of lines. Assumption.
const MOST_CANDIDATES: usize = 4;
/// A plane is compared with those above and below it at a distance that moves the images
/// against each other by this, px. Assumption: more than the error of a true plane, less than
/// the windows.
const DISPLACEMENT_PX: f64 = 3.0;

/// What the search for planes works on: one window, one pair of main directions.
pub(crate) struct PlaneSearch<'a> {
    pub scene: &'a Scene,
    pub image_lines: &'a [ImageLine<'a>],
    pub lines: &'a [ClusterLine],
    pub ground: &'a Ground,
    /// Buildings below planes found before, which may hide other planes.
    pub solids: &'a [OccludingSolid],
    pub params: &'a PlaneParams,
    /// What a border costs that nothing supports, nats a metre.
    pub border_nats_per_m: f64,
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
        let crossings = crossings(&strip, self.image_lines);
        let views = self.scene.views.len();
        let starts = base.range.map(|u| [u, top]);
        let ends = slanted_ends(&strip, &crossings, &starts, views);
        let shape = triangle(&strip, base, top, &ends, views)?;
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
        trace.crossings = crossings(&strip, self.image_lines);
        let line_ends: Vec<f64> = pair.iter().flat_map(|a| a.range).collect();
        trace.ends = ends(&strip, &trace.crossings, &line_ends, self.scene.views.len());
        let shapes = quadrilaterals(&strip, pair, &trace.ends, self.scene.views.len());
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
        let steepest = crate::base::math::cos(p.max_slope_deg.to_radians());
        let shaped = strip.plane.normal.z >= steepest
            && (LEAST_WIDTH_M..=p.max_width_m).contains(&strip.width)
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

    /// The best shapes of a strip by the measure, those that are likelier true than false.
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
        let promising: Vec<PlaneCandidate> = shapes
            .into_iter()
            .zip(rings)
            .filter_map(|(shape, ring)| {
                let on = consistency.agreement(&ring);
                let features = PlaneFeatures {
                    plane_nats_per_m2: on.nats_per_m2,
                    // The best that the comparison with displaced planes can say.
                    displaced_plane_margin_nats_per_m2: f64::INFINITY,
                    outline_on_lines: shape.support,
                    cos_slope: plane.normal.z,
                };
                let area_m2 = plan_area(&ring);
                let may_live = area_m2 / plane.normal.z >= self.params.min_area_m2
                    && features.evidence().accepts(self.params.least_nats);
                may_live.then(|| PlaneCandidate {
                    plane: *plane,
                    ring,
                    lines: Vec::new(),
                    correlation: on.correlation,
                    features,
                    measure_nats: self.measure_nats(area_m2, &on, &shape),
                })
            })
            .collect();
        if promising.is_empty() {
            return Vec::new();
        }
        let displaced = consistency.displaced(DISPLACEMENT_PX);
        let compared = promising.into_iter().map(|mut candidate| {
            let beside = consistency.best_displaced_nats(&displaced, &candidate.ring);
            let features = &mut candidate.features;
            features.displaced_plane_margin_nats_per_m2 = features.plane_nats_per_m2 - beside;
            (candidate.features.evidence().nats(), candidate)
        });
        let lives = |(nats, _): &(f64, PlaneCandidate)| *nats >= self.params.least_nats;
        self.best(compared.filter(lives).collect())
    }

    /// Those with the largest measure and the likeliest ones: one that reaches a little too far may
    /// have a larger measure than the right one beside it.
    fn best(&self, mut found: Vec<(f64, PlaneCandidate)>) -> Vec<PlaneCandidate> {
        let most = MOST_CANDIDATES.min(found.len());
        found.sort_by(|(_, a), (_, b)| b.measure_nats.total_cmp(&a.measure_nats));
        let mut others = found.split_off(most);
        others.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        others.truncate(most);
        found.append(&mut others);
        found.into_iter().map(|(_, candidate)| candidate).collect()
    }

    /// The measure M, nats, of a polygon of an area in plan.
    fn measure_nats(&self, area_m2: f64, on: &PlaneAgreement, shape: &StripPolygon) -> f64 {
        let inside = on.nats_per_m2 + on.weight * WindowEvidenceTable::fitted().prior;
        let unsupported = 1.0 - (1.0 - ON_LINE) * shape.support;
        area_m2 * inside - self.border_nats_per_m * shape.length_m * unsupported
    }
}
