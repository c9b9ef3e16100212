//! Planes between parallel 3D lines (W96 3.6).
//!
//! Each pair of parallel lines defines a plane; the image lines that cross it tell where it ends ([`super::ends`]); and
//! radiometry tells true planes from false ones. W96 sums geometric and radiometric criteria up in one measure without
//! writing it down. Here
//!
//! ```text
//! M = sum over the area of  weight (correlation - least_correlation)
//!   + side_weight  sum over the sides of  length (support - least_support)       square metres
//!   - plane_cost - slant_cost (ends that are not at right angles)
//! ```
//!
//! * the first sum is the paper's criterion that "the area ... inside the 3D plane should be radiometrically homogeneous
//!   over all images": the views, warped to the plane, are compared by correlation (`halfplane::consistency`),
//!   with little weight where there is no texture;
//! * the second is its geometry, and the contrast of its lines, since only lines with contrast are region boundaries:
//!   support is the share of a side that image lines cover, mean over all views.
//!
//! Of the polygons between two lines those with the largest M are kept as candidates. A pair of lines may hold
//! several, with gaps between them: U-shapes. A line with an end of a perpendicular, higher one makes a triangle: the end of a
//! hip below its ridge.

use nalgebra::{Point2, Point3};
use serde::Serialize;

use super::clusters::{Axes, ClusterLine, overlap};
use super::ends::{Crossing, End, Strip, crossings, ends, side_support, slanted_ends};
use super::sight::Sight;
use crate::geometry::Plane;
use crate::halfplane::{ConsistencyMap, PlanGrid, consistency_map};
use crate::ids::ViewId;
use crate::params::PlaneParams;
use crate::roof::Ground;
use crate::scene::Scene;

/// A polygon in a plane, with the evidence for it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlaneCandidate {
    /// The plane.
    pub plane: Plane,
    /// Corners, metres, counter-clockwise seen from above.
    pub ring: Vec<Point3<f64>>,
    /// The two lines (one for a triangle), as indices into the clusters of the window.
    pub lines: Vec<usize>,
    /// Share of the outline that image lines cover, mean over the views.
    pub support: f64,
    /// Mean correlation of the views inside, weighted by texture.
    pub correlation: f64,
    /// The measure M, square metres.
    pub measure: f64,
}

/// Why a plane hypothesis gave no candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PlaneRejection {
    /// Too steep, too narrow or too wide, or its lines stand beside each other.
    Shape,
    /// Not higher above the ground than a car.
    NearGround,
    /// Crossing lines make no two ends.
    NoEnds,
    /// The measure of its best polygon is not positive.
    Weak,
}

/// A pair of lines and what became of it (figure 11).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlaneTrace {
    /// The two lines.
    pub lines: [usize; 2],
    /// Why there is no candidate; `None` when there is.
    pub rejection: Option<PlaneRejection>,
    /// The image lines that cross the plane.
    pub crossings: Vec<Crossing>,
    /// Their clusters.
    pub ends: Vec<End>,
}

/// What the search for planes works on: one window, one pair of main directions.
pub(super) struct PlaneSearch<'a> {
    pub scene: &'a Scene,
    pub sights: &'a [Sight<'a>],
    pub lines: &'a [ClusterLine],
    pub ground: &'a Ground,
    pub params: &'a PlaneParams,
}

/// A line in the frame of its direction.
struct Along {
    range: [f64; 2],
    place: [f64; 2],
    stretches: Vec<(ViewId, [f64; 2])>,
}

impl PlaneSearch<'_> {
    /// All candidates between pairs of lines that run along `axes.u`, given by index.
    pub fn candidates(
        &self,
        axes: &Axes,
        members: &[usize],
    ) -> (Vec<PlaneCandidate>, Vec<PlaneTrace>) {
        let along: Vec<Along> = members
            .iter()
            .map(|&k| self.along(axes, &self.lines[k]))
            .collect();
        let pairs: Vec<[usize; 2]> = (0..members.len())
            .flat_map(|i| (i + 1..members.len()).map(move |j| [i, j]))
            .collect();
        let results = crate::parallel::map(&pairs, |_, &[i, j]| {
            let (mut candidates, mut trace) = self.pair(axes, [&along[i], &along[j]]);
            trace.lines = [members[i], members[j]];
            candidates
                .iter_mut()
                .for_each(|c| c.lines = trace.lines.into());
            (candidates, trace)
        });
        let (mut candidates, mut traces) = (Vec::new(), Vec::new());
        for (found, trace) in results {
            candidates.extend(found);
            traces.push(trace);
        }
        (candidates, traces)
    }

    /// Triangles below the ends of higher lines, `apexes`, on the lines that run along `axes.u`.
    pub fn triangles(
        &self,
        axes: &Axes,
        members: &[usize],
        apexes: &[Point3<f64>],
    ) -> Vec<PlaneCandidate> {
        let found = crate::parallel::map(members, |_, &k| {
            let base = self.along(axes, &self.lines[k]);
            let mut found: Vec<PlaneCandidate> = apexes
                .iter()
                .flat_map(|apex| self.triangle(axes, &base, apex))
                .collect();
            found.iter_mut().for_each(|c| c.lines = vec![k]);
            found
        });
        found.into_iter().flatten().collect()
    }

    fn triangle(&self, axes: &Axes, base: &Along, apex: &Point3<f64>) -> Option<PlaneCandidate> {
        let top = axes.u.dot(&apex.coords);
        let inside = base.range[0] < top && top < base.range[1] && apex.z > base.place[1] + 0.3;
        inside.then_some(())?;
        let tip = Along {
            range: base.range,
            place: [axes.v.dot(&apex.coords), apex.z],
            stretches: Vec::new(),
        };
        let strip = self.strip(axes, [base, &tip]).ok()?;
        let crossings = crossings(&strip, self.sights, self.params);
        let views = self.scene.views.len();
        let starts = base.range.map(|u| [u, top]);
        let ends = slanted_ends(&strip, &crossings, &starts, views, self.params);
        let to_tip = |e: &&End| (e.at[1] - top).abs() <= 2.0 * self.params.position_m;
        let best = |side: f64| {
            let on_side = ends
                .iter()
                .filter(to_tip)
                .filter(|e| side * (e.at[0] - top) > 0.5);
            on_side.max_by(|a, b| a.support.total_cmp(&b.support))
        };
        let (left, right) = (best(-1.0)?, best(1.0)?);
        let bottom = [left.at[0], right.at[0]];
        let slant = |e: &End| {
            let d = top - e.at[0];
            (strip.width * strip.width + d * d).sqrt()
        };
        let sides = [
            (
                bottom[1] - bottom[0],
                side_support(&base.stretches, bottom, views),
            ),
            (slant(left), left.support),
            (slant(right), right.support),
        ];
        let length: f64 = sides.iter().map(|s| s.0).sum();
        let support = sides.iter().map(|s| s.0 * s.1).sum::<f64>() / length;
        (support >= self.params.min_support).then_some(())?;
        let corners = vec![[bottom[0], 0.0], [bottom[1], 0.0], [top, strip.width]];
        // Both slants are fixed by the apex: no parameter of their own.
        let shape = Shape {
            corners,
            length,
            support,
            slants: 0,
        };
        self.measured(&strip, vec![shape]).pop()
    }

    fn along(&self, axes: &Axes, line: &ClusterLine) -> Along {
        let [a, b] = [line.segment.p0, line.segment.p1].map(|p| axes.u.dot(&p.coords));
        let z = line.segment.p0.z;
        let stretch = |&k: &usize| {
            let sight = &self.sights[k];
            let [p, q] = sight.ends_at(z).map(|p| axes.u.dot(&p.coords));
            (sight.view, [p.min(q), p.max(q)])
        };
        Along {
            range: [a.min(b), a.max(b)],
            place: [axes.v.dot(&line.segment.p0.coords), z],
            stretches: line.supports.iter().map(stretch).collect(),
        }
    }

    fn pair(&self, axes: &Axes, pair: [&Along; 2]) -> (Vec<PlaneCandidate>, PlaneTrace) {
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
        trace.crossings = crossings(&strip, self.sights, self.params);
        let line_ends: Vec<f64> = pair.iter().flat_map(|a| a.range).collect();
        trace.ends = ends(
            &strip,
            &trace.crossings,
            &line_ends,
            self.scene.views.len(),
            self.params,
        );
        let shapes = self.shapes(&strip, pair, &trace.ends);
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

    fn strip(&self, axes: &Axes, [a, b]: [&Along; 2]) -> Result<Strip, PlaneRejection> {
        let p = self.params;
        let range = [a.range[0].min(b.range[0]), a.range[1].max(b.range[1])];
        let shorter = (a.range[1] - a.range[0]).min(b.range[1] - b.range[0]);
        let strip = Strip::new(axes, a.place, b.place, range).ok_or(PlaneRejection::Shape)?;
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

    /// Quadrilaterals between two ends whose outline is supported well enough: positions along the lines and support.
    fn shapes(&self, strip: &Strip, [a, b]: [&Along; 2], ends: &[End]) -> Vec<Shape> {
        let views = self.scene.views.len();
        let mut shapes = Vec::new();
        for left in ends {
            for right in ends {
                let [p, q] = [0, 1].map(|k| [left.at[k], right.at[k]]);
                let lengths = [p[1] - p[0], q[1] - q[0]];
                if lengths[0] < 0.3
                    || lengths[1] < 0.3
                    || lengths[0].max(lengths[1]) < self.params.min_width_m
                {
                    continue;
                }
                let slant = |e: &End| {
                    let d = e.at[1] - e.at[0];
                    (strip.width * strip.width + d * d).sqrt()
                };
                let sides = [
                    (lengths[0], side_support(&a.stretches, p, views)),
                    (lengths[1], side_support(&b.stretches, q, views)),
                    (slant(left), left.support),
                    (slant(right), right.support),
                ];
                let length: f64 = sides.iter().map(|s| s.0).sum();
                let support = sides.iter().map(|s| s.0 * s.1).sum::<f64>() / length;
                if support >= self.params.min_support {
                    let corners = [
                        [p[0], 0.0],
                        [p[1], 0.0],
                        [q[1], strip.width],
                        [q[0], strip.width],
                    ];
                    let slants = [left, right].iter().filter(|e| e.at[0] != e.at[1]).count();
                    shapes.push(Shape {
                        corners: corners.into(),
                        length,
                        support,
                        slants,
                    });
                }
            }
        }
        shapes
    }

    /// The best shapes of a strip by the measure, those with a positive one.
    fn measured(&self, strip: &Strip, shapes: Vec<Shape>) -> Vec<PlaneCandidate> {
        let rings: Vec<Vec<Point3<f64>>> = shapes.iter().map(|s| s.ring(strip)).collect();
        let Some(judge) = Judge::new(self.scene, &strip.plane, &rings) else {
            return Vec::new();
        };
        let mut found: Vec<PlaneCandidate> = shapes
            .iter()
            .zip(rings)
            .filter_map(|(shape, ring)| self.judged(&judge, &strip.plane, ring, shape))
            .collect();
        found.sort_by(|a, b| b.measure.total_cmp(&a.measure));
        found.truncate(self.params.max_candidates);
        found
    }

    /// A candidate of this outline; `None` where its measure is too small.
    fn judged(
        &self,
        judge: &Judge,
        plane: &Plane,
        ring: Vec<Point3<f64>>,
        shape: &Shape,
    ) -> Option<PlaneCandidate> {
        let p = self.params;
        let (plan_area, weight, correlation) = judge.inside(&ring);
        let area = plan_area / plane.normal.z;
        let measure = area * weight * (correlation - p.least_correlation)
            + p.side_weight_m * shape.length * (shape.support - p.least_support)
            - p.plane_cost_m2
            - p.slant_cost_m2 * shape.slants as f64;
        let accepted = measure > p.min_measure_m2
            && area >= p.min_area_m2
            && correlation >= p.least_correlation;
        accepted.then(|| PlaneCandidate {
            plane: *plane,
            ring,
            lines: Vec::new(),
            support: shape.support,
            correlation,
            measure,
        })
    }
}

/// A quadrilateral in a strip.
struct Shape {
    /// (u, w) of the corners.
    corners: Vec<[f64; 2]>,
    length: f64,
    support: f64,
    /// Ends that are not at right angles.
    slants: usize,
}

impl Shape {
    fn ring(&self, strip: &Strip) -> Vec<Point3<f64>> {
        let mut ring: Vec<_> = self
            .corners
            .iter()
            .map(|c| strip.point(c[0], c[1]))
            .collect();
        if area_2d(&ring) < 0.0 {
            ring.reverse();
        }
        ring
    }
}

/// Signed area in plan, square metres.
pub(super) fn area_2d(ring: &[Point3<f64>]) -> f64 {
    (0..ring.len())
        .map(|i| {
            let (p, q) = (&ring[i], &ring[(i + 1) % ring.len()]);
            0.5 * (p.x * q.y - p.y * q.x)
        })
        .sum()
}

/// What the images say about one plane.
pub(super) struct Judge {
    grid: PlanGrid,
    map: ConsistencyMap,
}

/// Largest number of cells of a plane's grid.
const MOST_CELLS: f64 = 60_000.0;

impl Judge {
    /// Compares the views on a plane where the rings are; `None` without rings.
    pub fn new(scene: &Scene, plane: &Plane, rings: &[Vec<Point3<f64>>]) -> Option<Self> {
        let corners = || rings.iter().flatten();
        let bound = |start: f64, f: fn(f64, f64) -> f64| {
            Point2::new(
                corners().map(|p| p.x).fold(start, f),
                corners().map(|p| p.y).fold(start, f),
            )
        };
        let (min, max) = (
            bound(f64::INFINITY, f64::min),
            bound(f64::NEG_INFINITY, f64::max),
        );
        let first = corners().next()?;
        let size = max - min;
        let finest = scene
            .views
            .iter()
            .map(|v| v.camera.ground_pixel(first))
            .fold(f64::INFINITY, f64::min);
        let step = finest.max((size.x * size.y / MOST_CELLS).sqrt());
        (size.x > 0.0 && size.y > 0.0 && step.is_finite()).then_some(())?;
        let margin = nalgebra::Vector2::new(6.0, 6.0) * step;
        let grid = PlanGrid::covering(min - margin, max + margin, step);
        let map = consistency_map(scene, plane, &grid);
        Some(Self { grid, map })
    }

    /// Area in plan of a convex ring that runs counter-clockwise; mean weight and weighted mean correlation inside.
    pub fn inside(&self, whole: &[Point3<f64>]) -> (f64, f64, f64) {
        // Windows that reach over the border show its edge, which is in the right place for many a false plane.
        let core = shrunk(whole, REACH_CELLS * self.grid.step);
        let ring = core.as_deref().unwrap_or(whole);
        let plan_area = area_2d(whole);
        let (mut cells, mut weights, mut sum) = (0u32, 0.0, 0.0);
        for row in 0..self.grid.height {
            let y = self.grid.center(0, row).y;
            let Some([x0, x1]) = span(ring, y) else {
                continue;
            };
            let column = |x: f64| {
                ((x - self.grid.origin.x) / self.grid.step - 0.5)
                    .ceil()
                    .max(0.0) as usize
            };
            for c in column(x0)..column(x1).min(self.grid.width) {
                let k = row * self.grid.width + c;
                let weight = f64::from(self.map.weight(k));
                cells += 1;
                weights += weight;
                sum += weight * f64::from(self.map.correlation(k));
            }
        }
        let n = f64::from(cells.max(1));
        let correlation = if weights > 0.0 { sum / weights } else { 0.0 };
        (plan_area, weights / n, correlation)
    }
}

/// Half the window of the correlation and the pixel that an edge takes, cells.
const REACH_CELLS: f64 = 6.0;

/// A convex ring with its sides moved inwards; `None` where little is left.
fn shrunk(ring: &[Point3<f64>], by: f64) -> Option<Vec<Point3<f64>>> {
    let n = ring.len();
    // Lines a x + b y = c through the moved sides; the inside is to the left.
    let side = |i: usize| {
        let (p, q) = (&ring[i], &ring[(i + 1) % n]);
        let d = (q - p).xy().normalize();
        (-d.y, d.x, -d.y * p.x + d.x * p.y + by)
    };
    let moved: Vec<Point3<f64>> = (0..n)
        .map(|i| {
            let ((a, b, c), (d, e, f)) = (side((i + n - 1) % n), side(i));
            let det = a * e - b * d;
            Point3::new((c * e - b * f) / det, (a * f - c * d) / det, 0.0)
        })
        .collect();
    let inwards = (0..n).all(|i| {
        let j = (i + 1) % n;
        (moved[j] - moved[i]).xy().dot(&(ring[j] - ring[i]).xy()) > 0.0
    });
    (inwards && area_2d(&moved) > 0.15 * area_2d(ring)).then_some(moved)
}

/// The range of x inside a convex ring at a y.
fn span(ring: &[Point3<f64>], y: f64) -> Option<[f64; 2]> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..ring.len() {
        let (p, q) = (&ring[i], &ring[(i + 1) % ring.len()]);
        if (p.y <= y) != (q.y <= y) {
            let x = p.x + (q.x - p.x) * (y - p.y) / (q.y - p.y);
            low = low.min(x);
            high = high.max(x);
        }
    }
    (low < high).then_some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_shrinks_on_all_sides_and_a_sliver_does_not() {
        let ring = |w: f64| {
            [[0.0, 0.0], [9.0, 0.0], [9.0, w], [0.0, w]]
                .map(|[x, y]| Point3::new(x, y, 1.0))
                .to_vec()
        };
        let core = shrunk(&ring(6.0), 1.0).unwrap();
        assert!((area_2d(&core) - 28.0).abs() < 1e-9);
        assert_eq!(span(&core, 3.0), Some([1.0, 8.0]));
        assert!(shrunk(&ring(1.5), 1.0).is_none());
    }
}
