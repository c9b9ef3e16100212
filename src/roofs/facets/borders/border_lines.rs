//! Border lines in plan: real lines, intersections of planes, closing lines (B99 4.2, 4.3, figures
//! 19 to 22).
//!
//! Four kinds of lines may bound a facet:
//! * reconstructed 3D lines, whether they lie in the plane with another plane attached or not
//!   (figure 21), extended at both ends, since detected ends are unreliable (figure 22);
//! * lines found in a plane from segments of several views
//!   ([`crate::planes::hypotheses::plane_lines`]);
//! * new lines in which two neighbouring planes meet (figure 19);
//! * closing lines across the ends of a supporting line, and where the views cease to agree on a
//!   plane ([`super::extent`]), and the level sides of the paper's convex hull, where nothing was
//!   detected.
//!
//! A real line that runs along an intersection is moved onto it, so that ridge, hip and valley are
//! where their planes meet.

use nalgebra::{Point2, Vector2};

use super::border::{Border, BorderKind};
use super::extent::extent_lines;
use crate::base::geometry::Segment3;
use crate::base::line_linker::LineLinker;
use crate::base::params::RoofParams;
use crate::base::plan_index::PlanIndex;
use crate::lines::lines3d::ThetaFrame;
use crate::planes::grouping::{GroupingInput, MARGIN, Member};
use crate::planes::hypotheses::PlaneHypothesis;
use crate::planes::photoconsistency::ShiftableWindows;
use crate::roofs::facets::point_cloud::CloudEvidence;

/// When two borders are one, and a real line is an intersection.
const SAME: LineLinker = LineLinker::border();

/// All border lines of the scene, intersections first, none lying on another.
pub(crate) fn border_lines(
    input: &GroupingInput,
    hypotheses: &[PlaneHypothesis],
    bounding: &[Segment3],
    windows: &ShiftableWindows,
    cloud: Option<&CloudEvidence>,
    params: &RoofParams,
) -> Vec<Border> {
    let mut borders = DistinctBorders::default();
    for border in intersections(input, hypotheses) {
        borders.add(border);
    }
    let in_plane: Vec<Segment3> = hypotheses
        .iter()
        .flat_map(|h| &h.lines)
        .map(|l| l.segment)
        .collect();
    for (kind, lines) in [
        (BorderKind::Real, bounding),
        (BorderKind::InPlane, &in_plane),
    ] {
        let mut real: Vec<Border> = lines
            .iter()
            .filter_map(|l| extended(kind, l, params))
            .collect();
        real.sort_by(|a, b| b.length().total_cmp(&a.length()));
        for border in real {
            borders.add(border);
        }
    }
    for border in outermost_lines(input, hypotheses, params) {
        borders.add(border);
    }
    for border in extent_lines(input, hypotheses, windows, cloud) {
        borders.add(border);
    }
    for border in closing_lines(input, hypotheses, params) {
        borders.add(border);
    }
    for border in hull_sides(hypotheses, params) {
        borders.add(border);
    }
    for border in proposed_sides(input, hypotheses) {
        borders.add(border);
    }
    borders.borders
}

/// The level sides of the planes' convex hulls (B99 4.3) that are long enough to be an edge of a
/// facet, the longest first.
fn hull_sides(hypotheses: &[PlaneHypothesis], params: &RoofParams) -> Vec<Border> {
    let sides = (hypotheses.iter()).flat_map(|h| h.region.level_sides(&h.group.plane));
    let borders = sides.map(|[a, b]| Border {
        kind: BorderKind::Closing,
        a,
        b,
    });
    let mut long: Vec<Border> = borders
        .filter(|b| b.length() >= params.min_facet_depth_m)
        .collect();
    long.sort_by(|a, b| b.length().total_cmp(&a.length()));
    long
}

/// New lines by plane intersection (B99 4.2): where both planes' regions hold it.
fn intersections(input: &GroupingInput, hypotheses: &[PlaneHypothesis]) -> Vec<Border> {
    let mut found = Vec::new();
    for (i, first) in hypotheses.iter().enumerate() {
        let [min, max] = first.region.bounds();
        let p = &first.group;
        for second in &hypotheses[i + 1..] {
            let [qmin, qmax] = second.region.bounds();
            let q = &second.group;
            let low = Point2::new(min.x.max(qmin.x), min.y.max(qmin.y));
            let high = Point2::new(max.x.min(qmax.x), max.y.min(qmax.y));
            if low.x >= high.x || low.y >= high.y || p.plane.angle_to(&q.plane) < MIN_CREASE {
                continue;
            }
            let Some(near) = p.place(input) else { continue };
            let Some((point, direction)) = p.plane.intersection(&q.plane, &near) else {
                continue;
            };
            let inside = |x: &Point2<f64>| first.region.contains(x) && second.region.contains(x);
            found.extend(stretches(&point.xy(), &direction.xy(), low, high, inside));
        }
    }
    found
}

/// Planes at less than this angle (radians, 5 degrees) meet in a line too uncertain to be of use.
const MIN_CREASE: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// The stretches of a line, longer than 0.5 m, on which `inside` holds, by steps of 0.25 m.
fn stretches(
    point: &Point2<f64>,
    direction: &Vector2<f64>,
    low: Point2<f64>,
    high: Point2<f64>,
    inside: impl Fn(&Point2<f64>) -> bool,
) -> Vec<Border> {
    // Assumption: the pieces of a line that matter are several times as long.
    const SAMPLE_SPACING_M: f64 = 0.25;
    let norm = direction.norm();
    if norm < 1e-9 {
        return Vec::new();
    }
    let d = direction / norm;
    // Only the part near the box matters.
    let center = Point2::from((low.coords + high.coords) * 0.5);
    let t0 = (center - point).dot(&d);
    let half = 0.5 * (high - low).norm();
    let steps = (2.0 * half / SAMPLE_SPACING_M).ceil() as usize;
    let mut found = Vec::new();
    let mut start: Option<Point2<f64>> = None;
    let mut last = *point;
    for k in 0..=steps {
        let p = point + d * (t0 - half + k as f64 * SAMPLE_SPACING_M);
        if inside(&p) {
            start = start.or(Some(p));
            last = p;
        } else if let Some(s) = start.take() {
            found.push(Border {
                kind: BorderKind::Intersection,
                a: s,
                b: last,
            });
        }
    }
    if let Some(s) = start {
        found.push(Border {
            kind: BorderKind::Intersection,
            a: s,
            b: last,
        });
    }
    found.retain(|b| b.length() > 0.5);
    found
}

/// A real line in plan, extended at both ends; `None` when it is nearly vertical.
fn extended(kind: BorderKind, line: &Segment3, params: &RoofParams) -> Option<Border> {
    let (a, b) = (line.p0.xy(), line.p1.xy());
    let length = (b - a).norm();
    if length < 0.2 * line.length() || length < 0.1 {
        return None;
    }
    let extra =
        (b - a) / length * (0.5 * length).clamp(params.extension_m, 3.0 * params.extension_m);
    Some(Border {
        kind,
        a: a - extra,
        b: b + extra,
    })
}

/// The outermost lines of every group, as long as the whole group: an eave of which half was found
/// goes on as far as the ridge does.
fn outermost_lines(
    input: &GroupingInput,
    hypotheses: &[PlaneHypothesis],
    params: &RoofParams,
) -> Vec<Border> {
    let mut found = Vec::new();
    for h in hypotheses {
        let members = (h.group.members.iter()).map(|m| input.lines[m.line.index()].segment);
        let lines: Vec<Segment3> = members.chain(h.lines.iter().map(|l| l.segment)).collect();
        let ends: Vec<Point2<f64>> = (lines.iter())
            .flat_map(|l| [l.p0.xy(), l.p1.xy()])
            .collect();
        for line in lines.iter().filter(|l| l.length() >= params.extension_m) {
            let Some(border) = extended(BorderKind::Closing, line, params) else {
                continue;
            };
            let (a, d) = (border.a, border.direction());
            let beside = |p: &Point2<f64>| d.x * (p.y - a.y) - d.y * (p.x - a.x);
            let outermost = ends.iter().all(|p| beside(p) < SAME.apart)
                || ends.iter().all(|p| beside(p) > -SAME.apart);
            if !outermost {
                continue;
            }
            let along = ends.iter().map(|p| (p - a).dot(&d));
            let (first, last) = along.fold((0.0f64, border.length()), |(low, high), t| {
                (
                    low.min(t - params.extension_m),
                    high.max(t + params.extension_m),
                )
            });
            found.push(Border {
                a: a + d * first,
                b: a + d * last,
                ..border
            });
        }
    }
    found.sort_by(|a, b| b.length().total_cmp(&a.length()));
    found
}

/// Lines across both ends of a group's longest lines, on the side that the plane covers.
fn closing_lines(
    input: &GroupingInput,
    hypotheses: &[PlaneHypothesis],
    params: &RoofParams,
) -> Vec<Border> {
    let mut found = Vec::new();
    for group in hypotheses.iter().map(|h| &h.group) {
        let mut members: Vec<(f64, &Member)> = group
            .members
            .iter()
            .map(|m| (input.lines[m.line.index()].segment.length(), m))
            .collect();
        members.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.line.cmp(&b.1.line)));
        for (length, member) in members.into_iter().take(CLOSED_LINES) {
            let Some(side) = member.side else { continue };
            let line = &input.lines[member.line.index()].segment;
            let Some(frame) = ThetaFrame::new(line, side) else {
                continue;
            };
            let depth = length.clamp(params.min_facet_depth_m, params.max_facet_depth_m);
            let away = frame.outward.xy();
            for end in [line.p0.xy(), line.p1.xy()] {
                found.push(Border {
                    kind: BorderKind::Closing,
                    a: end - away * MARGIN,
                    b: end + away * depth,
                });
            }
        }
    }
    found
}

/// The sides of proposed planes that are edges of the images, and of those others in whose plane no
/// line lies.
fn proposed_sides(input: &GroupingInput, hypotheses: &[PlaneHypothesis]) -> Vec<Border> {
    let proposed = hypotheses.iter().flat_map(|h| {
        let has_lines = !h.group.members.is_empty();
        let proposed = h.group.proposed(input);
        proposed.filter(move |p| p.sides_on_edges || !has_lines)
    });
    let sides = proposed.flat_map(|r| {
        r.sides().map(|[a, b]| Border {
            kind: BorderKind::Rectangle,
            a,
            b,
        })
    });
    sides.collect()
}

/// A facet has a few long sides; shorter lines in its plane are parts of them or of its texture.
const CLOSED_LINES: usize = 3;

/// Borders none of which lies on another.
#[derive(Default)]
struct DistinctBorders {
    borders: Vec<Border>,
    index: PlanIndex,
}

impl DistinctBorders {
    /// Adds a border unless it lies on one that is there; one that runs along another is moved onto
    /// its line.
    fn add(&mut self, mut border: Border) {
        let lies_on = LineLinker {
            beyond: SAME.apart,
            ..SAME
        };
        let mut near: Vec<u32> = (self.index.touching(border.ends(), SAME.apart)).collect();
        near.sort();
        for other in near.into_iter().map(|i| &self.borders[i as usize]) {
            let line = other.ends();
            if !SAME.connects(&line, &border.ends()) {
                continue;
            }
            if border.ends().iter().all(|p| lies_on.passes(&line, p)) {
                return;
            }
            border.a = other.foot(&border.a);
            border.b = other.foot(&border.b);
        }
        let number = self.borders.len() as u32;
        self.index.insert(border.ends(), number);
        self.borders.push(border);
    }
}
