//! What a side of an outline costs, by the planes on its two sides.
//!
//! Every place of it costs what a border there costs ([`super::border_cost`]); the cost is summed
//! exactly along the side, so that a vertex on a straight side changes nothing.

use nalgebra::{Point2, Vector2};

use super::border_cost::{CREASE, LINE_HEIGHT, MEETING_HEIGHT_M, are_one_plane, open_top};
use super::line_index::{BESIDE_LINE, LineIndex};
use crate::base::evidence::ON_LINE;
use crate::base::geometry::{Plane, Segment3};
use crate::base::math::{larger, smaller};

/// Length of a side, metres, with each part of it counted by the share of the full cost that a
/// border there has, between the planes to its left and right or none.
pub(crate) fn charged_length(
    index: &LineIndex,
    [a, b]: [&Point2<f64>; 2],
    left: Option<&Plane>,
    right: Option<&Plane>,
) -> f64 {
    let length = (b - a).norm();
    let side = Side {
        from: *a,
        along: (b - a) / larger(length, f64::MIN_POSITIVE),
    };
    let left_of = Vector2::new(-side.along.y, side.along.x);
    let planes = [(left, right, -left_of), (right, left, left_of)];
    let planes = planes.map(|(plane, beyond, outwards)| {
        plane.map(|plane| BoundedPlane::new(&side, plane, beyond, &outwards))
    });
    let crease = match (left, right) {
        (Some(left), Some(right)) if !are_one_plane(left, right) => {
            let apart = side.height(left).minus(side.height(right));
            apart.within(-MEETING_HEIGHT_M, MEETING_HEIGHT_M)
        }
        _ => NOWHERE,
    };
    let parts = (length / PART_M).ceil().max(1.0);
    let at = |k: usize| length * (k as f64 / parts);
    let part = |k: usize| {
        let part = [at(k), at(k + 1)];
        let lines: Vec<&Segment3> = index.along(&side.along, part.map(|s| side.at(s))).collect();
        let on_line = planes.each_ref().map(|plane| {
            let Some(plane) = plane else {
                return Vec::new();
            };
            let along = lines.iter().flat_map(|l| side.along_line(l, plane.height));
            along.filter(|s| meet(*s, part)).collect()
        });
        charged(part, crease, &planes, &on_line)
    };
    (0..parts as usize).map(part).sum()
}

/// Lines are looked up for a part of so many metres at a time: the box around a long side would
/// hold most lines of a house.
const PART_M: f64 = 2.0;

/// Length of a part of a side that is paid for, metres: every stretch of it is as cheap as what
/// supports it most.
fn charged(
    part: Stretch,
    crease: Stretch,
    planes: &[Option<BoundedPlane>; 2],
    on_line: &[Vec<Stretch>; 2],
) -> f64 {
    let goes_on = planes.iter().flatten().map(|p| p.goes_on);
    let supports = on_line.iter().flatten().copied();
    let changes = supports.chain(goes_on).chain([crease]).flatten();
    let within = changes.filter(|s| holds(part, *s));
    let mut places: Vec<f64> = within.chain(part).collect();
    places.sort_by(f64::total_cmp);
    let stretch = |ends: &[f64]| {
        let middle = 0.5 * (ends[0] + ends[1]);
        let mut share = if holds(crease, middle) { CREASE } else { 1.0 };
        for (plane, on_line) in planes.iter().zip(on_line) {
            if let Some(plane) = plane.as_ref()
                && on_line.iter().any(|s| holds(*s, middle))
            {
                share = smaller(share, plane.share_on_line(middle));
            }
        }
        share * (ends[1] - ends[0])
    };
    places.windows(2).map(stretch).sum()
}

/// A side by its first end and its direction.
struct Side {
    from: Point2<f64>,
    along: Vector2<f64>,
}

impl Side {
    /// The place that is `s` metres along it.
    fn at(&self, s: f64) -> Point2<f64> {
        self.from + self.along * s
    }

    /// Height of a plane along it, metres.
    fn height(&self, plane: &Plane) -> Linear {
        let [near, far] = [0.0, 1.0].map(|s| {
            let p = self.at(s);
            plane.z_at(p.x, p.y)
        });
        Linear {
            at_start: near,
            rate: far - near,
        }
    }

    /// Where it lies beside a line at the height of a plane: beside the line itself, and a little
    /// before and beyond its ends, where the line counts as high as its end.
    fn along_line(&self, line: &Segment3, plane: Linear) -> [Stretch; 3] {
        let along = line.p1.xy() - line.p0.xy();
        let length = along.norm();
        let (u, from) = (along / length, self.from - line.p0.xy());
        let place = Linear {
            at_start: from.dot(&u),
            rate: self.along.dot(&u),
        };
        let across = Linear {
            at_start: u.perp(&from),
            rate: u.perp(&self.along),
        };
        let beside = across.within(-BESIDE_LINE, BESIDE_LINE);
        let [first, last] = [line.p0.z, line.p1.z];
        let slope = (last - first) / length;
        let level = |z: f64| Linear {
            at_start: z,
            rate: 0.0,
        };
        let height = Linear {
            at_start: first + slope * place.at_start,
            rate: slope * place.rate,
        };
        let parts = [
            (-BESIDE_LINE, 0.0, level(first)),
            (0.0, length, height),
            (length, length + BESIDE_LINE, level(last)),
        ];
        parts.map(|(low, high, height)| {
            let above = height.minus(plane);
            let at_height = above.within(-LINE_HEIGHT, LINE_HEIGHT);
            common(common(beside, place.within(low, high)), at_height)
        })
    }
}

/// A plane to one hand of a side.
struct BoundedPlane {
    height: Linear,
    /// Where the plane beyond the side is as high or higher.
    goes_on: Stretch,
    /// How much of an end there is the top of a slope.
    open_top: f64,
}

impl BoundedPlane {
    fn new(side: &Side, plane: &Plane, beyond: Option<&Plane>, outwards: &Vector2<f64>) -> Self {
        let height = side.height(plane);
        let above = |beyond: &Plane| side.height(beyond).minus(height);
        Self {
            height,
            goes_on: beyond.map_or(NOWHERE, |b| {
                above(b).within(-MEETING_HEIGHT_M, f64::INFINITY)
            }),
            open_top: open_top(plane, outwards),
        }
    }

    /// Share of the full cost where a line runs along it.
    fn share_on_line(&self, place: f64) -> f64 {
        match holds(self.goes_on, place) {
            true => ON_LINE,
            false => ON_LINE + (1.0 - ON_LINE) * self.open_top,
        }
    }
}

/// What changes evenly along a side, by metres from its first end.
#[derive(Clone, Copy)]
struct Linear {
    at_start: f64,
    /// By metre.
    rate: f64,
}

impl Linear {
    fn minus(self, other: Self) -> Self {
        Self {
            at_start: self.at_start - other.at_start,
            rate: self.rate - other.rate,
        }
    }

    /// Where it lies between two values.
    fn within(self, low: f64, high: f64) -> Stretch {
        // What changes by less does not over any side.
        const LEAST_RATE: f64 = 1e-12;
        if self.rate.abs() < LEAST_RATE {
            return match low < self.at_start && self.at_start < high {
                true => [f64::NEG_INFINITY, f64::INFINITY],
                false => NOWHERE,
            };
        }
        let [s, t] = [low, high].map(|value| (value - self.at_start) / self.rate);
        [smaller(s, t), larger(s, t)]
    }
}

/// Part of a side, from and to so many metres from its first end.
type Stretch = [f64; 2];

const NOWHERE: Stretch = [f64::INFINITY, f64::NEG_INFINITY];

fn common(a: Stretch, b: Stretch) -> Stretch {
    [larger(a[0], b[0]), smaller(a[1], b[1])]
}

fn meet(a: Stretch, b: Stretch) -> bool {
    let [from, to] = common(a, b);
    from < to
}

fn holds([from, to]: Stretch, place: f64) -> bool {
    from < place && place < to
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};

    /// A side among lines along it and in all directions, beside it and beyond its ends, between
    /// two planes.
    struct Drawn {
        ends: [Point2<f64>; 2],
        index: LineIndex,
        planes: [Plane; 2],
    }

    fn drawn(seed: u32) -> Drawn {
        let mut next =
            crate::roofs::testing::uniform(seed.wrapping_mul(2_654_435_761).wrapping_add(5));
        let mut draw = |low: f64, high: f64| low + (high - low) * next();
        let (sin, cos) = crate::base::math::sin_cos(draw(-3.0, 3.0));
        let along = Vector2::new(cos, sin);
        let a = Point2::new(draw(-5.0, 5.0), draw(-5.0, 5.0));
        let b = a + along * draw(0.1, 30.0);
        let lines = (0..40).map(|_| {
            let from = a + along * draw(-3.0, 33.0);
            let from = from + Vector2::new(draw(-0.4, 0.4), draw(-0.4, 0.4));
            let to = from + along * draw(0.1, 6.0);
            let to = to + Vector2::new(draw(-0.3, 0.3), draw(-0.3, 0.3));
            let heights = [draw(3.0, 7.0), draw(3.0, 7.0)];
            let ends = [
                Point3::new(from.x, from.y, heights[0]),
                Point3::new(to.x, to.y, heights[1]),
            ];
            crate::roofs::testing::line(ends[0], ends[1]).segment
        });
        let index = LineIndex::new(lines.collect());
        let planes = [[-1.0, 0.3, 2.0], [1.0, 0.0, 2.0]].map(|normal| {
            let middle = Point3::new(0.0, 0.0, 5.0);
            Plane::from_point_normal(&middle, &Vector3::from(normal)).expect("it is a direction")
        });
        Drawn {
            ends: [a, b],
            index,
            planes,
        }
    }

    fn cost(drawn: &Drawn, a: &Point2<f64>, b: &Point2<f64>) -> f64 {
        let [left, right] = &drawn.planes;
        charged_length(&drawn.index, [a, b], Some(left), Some(right))
    }

    #[test]
    fn a_side_costs_what_borders_along_it_cost() {
        let mut supported = 0;
        for seed in 1..60 {
            let drawn = drawn(seed);
            let [a, b] = drawn.ends;
            let length = (b - a).norm();
            let pieces = (length / 0.005).ceil();
            let at = |k: usize| a + (b - a) * (k as f64 / pieces);
            let [left, right] = drawn.planes.each_ref().map(Some);
            let share = |k| {
                let ends = [at(k), at(k + 1)];
                super::super::border_cost::share(&drawn.index, ends, left, right)
            };
            let shares = (0..pieces as usize).map(share).sum::<f64>();
            let (expected, found) = (shares * length / pieces, cost(&drawn, &a, &b));
            assert!(
                (found - expected).abs() < 0.002 * length + 0.01,
                "{seed}: {found} {expected}"
            );
            supported += u32::from(expected < 0.9 * length);
        }
        assert!(supported > 20, "{supported}");
    }

    #[test]
    fn a_vertex_on_a_straight_side_changes_nothing() {
        for seed in 1..200 {
            let drawn = drawn(seed);
            let [a, b] = drawn.ends;
            let whole = cost(&drawn, &a, &b);
            for share in [0.1, 0.37, 0.9] {
                let v = a + (b - a) * share;
                let parts = cost(&drawn, &a, &v) + cost(&drawn, &v, &b);
                assert!((whole - parts).abs() < 1e-9, "{seed}: {whole} {parts}");
            }
        }
    }

    #[test]
    fn a_side_costs_the_same_from_both_ends() {
        for seed in 1..200 {
            let drawn = drawn(seed);
            let ([a, b], [left, right]) = (&drawn.ends, &drawn.planes);
            let there = charged_length(&drawn.index, [a, b], Some(left), Some(right));
            let back = charged_length(&drawn.index, [b, a], Some(right), Some(left));
            assert!((there - back).abs() < 1e-9, "{seed}: {there} {back}");
        }
    }
}
