//! Where buildings are: a window for each, with its main directions.
//!
//! W96 3.1 assumes that "one building at a time is analysed" and that its "approximate localisation
//! ... is known". It may be given; otherwise the method itself finds it. Overlapping tiles,
//! somewhat larger than a house, are analysed as if each held one building: main directions,
//! clusters. 3D lines that stand above the ground are linked where they come near each other and
//! run parallel or perpendicular. The lines of a connected group that follow one pair of directions
//! are a building, their box its window: neighbours are seldom exactly parallel.

use std::collections::BTreeMap;

use nalgebra::{Point2, Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::clusters::{ClusterLine, SIGMA_PX, cluster_lines};
use super::directions::{
    DirectionTrace, MainDirections, MeasuredAzimuth, directions_by_length, main_directions,
    share_of,
};
use super::image_lines::ImageLine;
use crate::base::execution::{Sharded, sharded_map};
use crate::base::geometry::{Segment3, bounds};
use crate::base::math::atan2;
use crate::base::params::ObjectSpaceParams;
use crate::orienting::scene::Scene;
use crate::planes::terrain::Ground;

/// Side of the tiles in which buildings are sought, metres. Assumption: a house with its
/// surroundings.
const TILE_M: f64 = 24.0;
/// Lines of a building are linked over this distance in plan, metres. Assumption: the depth of
/// a facet; closer than most houses stand.
const LINK_M: f64 = 6.0;
/// The window reaches beyond the lines by this, metres. Assumption: lines that were not found.
const MARGIN_M: f64 = 4.0;

/// A part of the ground plan that is analysed on its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Window {
    /// Least x and y, metres, local frame.
    pub min: Point2<f64>,
    /// Largest x and y, metres.
    pub max: Point2<f64>,
    /// Heights between which lines are sought, metres.
    pub z_range_m: [f64; 2],
    /// Main directions of what stands in it.
    pub directions: Vec<MainDirections>,
}

impl Window {
    /// Could the image line show something in the window?
    pub fn shows(&self, image_line: &ImageLine) -> bool {
        let ends = self.z_range_m.map(|z| image_line.ends_at(z));
        let corners = || ends.iter().flatten();
        let bound = |start: f64, f: fn(f64, f64) -> f64| {
            (
                corners().map(|p| p.x).fold(start, f),
                corners().map(|p| p.y).fold(start, f),
            )
        };
        let ((x0, y0), (x1, y1)) = (
            bound(f64::INFINITY, f64::min),
            bound(f64::NEG_INFINITY, f64::max),
        );
        x0 <= self.max.x && x1 >= self.min.x && y0 <= self.max.y && y1 >= self.min.y
    }
}

/// How the windows and their directions were found.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct WindowTrace {
    /// The histogram of each window.
    pub histograms: Vec<DirectionTrace>,
    /// The 3D lines above the ground that the windows were drawn around, and the window of each;
    /// `None` for a line on its own.
    pub lines: Vec<(Segment3, Option<usize>)>,
}

/// Lines shorter than this, or alone, are no building, metres together. Assumption: less than the
/// outline of a garage.
const LEAST_LINES_M: f64 = 6.0;
/// Lines within this angle, radians, may be of one building. Assumption: the error of a short one.
const PARALLEL_ANGLE: f64 = 0.05;

/// Windows at the given places (x0, y0, x1, y1, local frame), or around the buildings that the
/// lines show.
pub(crate) fn find_windows(
    scene: &Scene,
    image_lines: &[ImageLine],
    z_range_m: [f64; 2],
    given: &[[f64; 4]],
    params: &ObjectSpaceParams,
) -> Sharded<(Vec<Window>, WindowTrace)> {
    let mut trace = WindowTrace::default();
    let mut windows: Vec<Window> = given
        .iter()
        .map(|&[x0, y0, x1, y1]| window([Point2::new(x0, y0), Point2::new(x1, y1)], z_range_m))
        .collect();
    if given.is_empty() {
        let raised = raised_lines(scene, image_lines, z_range_m, params)?;
        let group = groups(&raised, LINK_M);
        windows = windows_of(&raised, &group, z_range_m, MARGIN_M);
        let segments = raised.iter().map(|l| l.segment);
        trace.lines = segments.zip(group).collect();
    }
    for w in &mut windows {
        let inside: Vec<ImageLine> = image_lines.iter().filter(|s| w.shows(s)).cloned().collect();
        let (found, histogram) = main_directions(&inside, &params.directions);
        if given.is_empty() {
            for pair in &mut w.directions {
                pair.share = share_of(&inside, pair.azimuth);
            }
        } else {
            w.directions = found;
        }
        trace.histograms.push(histogram);
    }
    Ok((windows, trace))
}

fn window([min, max]: [Point2<f64>; 2], z_range_m: [f64; 2]) -> Window {
    Window {
        min,
        max,
        z_range_m,
        directions: Vec::new(),
    }
}

/// A horizontal 3D line of a tile.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct TileLine {
    segment: Segment3,
    azimuth: MeasuredAzimuth,
}

/// The 3D lines of all tiles that stand above the ground, longest first, each place once.
fn raised_lines(
    scene: &Scene,
    image_lines: &[ImageLine],
    z_range_m: [f64; 2],
    params: &ObjectSpaceParams,
) -> Sharded<Vec<TileLine>> {
    let tiles = tiles(image_lines, z_range_m, TILE_M);
    let per_tile = sharded_map("tiles", &tiles, 0.2..1.0, |_, tile| {
        tile_lines(scene, image_lines, tile, params)
    })?;
    let mut lines: Vec<TileLine> = per_tile.into_iter().flatten().collect();
    lines.sort_by(|a, b| {
        let (a, b) = (&a.segment, &b.segment);
        let key = |s: &Segment3| (s.p0.x, s.p0.y);
        b.length()
            .total_cmp(&a.length())
            .then(key(a).0.total_cmp(&key(b).0))
            .then(key(a).1.total_cmp(&key(b).1))
    });
    let mut kept: Vec<TileLine> = Vec::new();
    for line in lines {
        let known = |k: &TileLine| {
            [0.1, 0.5, 0.9]
                .iter()
                .all(|&t| distance(&k.segment, &line.segment.at(t)) < 0.4)
        };
        if !kept.iter().any(known) {
            kept.push(line);
        }
    }
    let segments: Vec<Segment3> = kept.iter().map(|l| l.segment).collect();
    let ground = Ground::of_segments(scene, &segments, Some(z_range_m))?;
    let height = |s: &Segment3| s.p0.z - ground.z_at(&s.at(0.5).xy());
    kept.retain(|l| height(&l.segment) >= 0.7 * params.planes.min_height_m);
    Ok(kept)
}

/// Tiles that overlap by half and show any line.
fn tiles(image_lines: &[ImageLine], z_range_m: [f64; 2], size: f64) -> Vec<Window> {
    let z = 0.5 * (z_range_m[0] + z_range_m[1]);
    let mut corners: Vec<[i64; 2]> = image_lines
        .iter()
        .flat_map(|s| {
            let p = nalgebra::center(&s.ends_at(z)[0], &s.ends_at(z)[1]);
            let [c, r] = [p.x, p.y].map(|v| (v / (0.5 * size)).floor() as i64);
            [[c, r], [c - 1, r], [c, r - 1], [c - 1, r - 1]]
        })
        .collect();
    corners.sort();
    corners.dedup();
    corners
        .into_iter()
        .map(|[c, r]| {
            let min = Point2::new(c as f64, r as f64) * (0.5 * size);
            window([min, min + nalgebra::Vector2::new(size, size)], z_range_m)
        })
        .collect()
}

fn tile_lines(
    scene: &Scene,
    image_lines: &[ImageLine],
    tile: &Window,
    params: &ObjectSpaceParams,
) -> Vec<TileLine> {
    let inside: Vec<ImageLine> = image_lines
        .iter()
        .filter(|s| tile.shows(s))
        .cloned()
        .collect();
    let (directions, _) = main_directions(&inside, &params.directions);
    directions
        .iter()
        .flat_map(MainDirections::axes)
        .flat_map(|axis: Vector3<f64>| {
            cluster_lines(scene, &inside, &axis, tile.z_range_m, &params.clusters).0
        })
        .filter_map(|line: ClusterLine| {
            let supports: Vec<&ImageLine> = line.supports.iter().map(|&k| &inside[k]).collect();
            let segment = line.segment;
            let start = azimuth(&segment);
            let azimuth = MeasuredAzimuth::of_line(start, &supports, SIGMA_PX)?;
            Some(TileLine { segment, azimuth })
        })
        .collect()
}

/// The building of each line: lines that come near each other in plan and follow one pair of
/// directions.
fn groups(lines: &[TileLine], link_m: f64) -> Vec<Option<usize>> {
    let linked = linked(lines, link_m);
    let mut building: Vec<Option<[usize; 2]>> = vec![None; lines.len()];
    for root in (0..lines.len()).filter(|&k| linked[k] == k) {
        let members: Vec<usize> = (0..lines.len()).filter(|&k| linked[k] == root).collect();
        let azimuths: Vec<MeasuredAzimuth> = members.iter().map(|&k| lines[k].azimuth).collect();
        let (_, along) = directions_by_length(&azimuths);
        for (member, direction) in members.into_iter().zip(along) {
            building[member] = direction.map(|direction| [root, direction]);
        }
    }
    let mut length: BTreeMap<[usize; 2], f64> = BTreeMap::new();
    for (line, building) in lines.iter().zip(&building) {
        if let Some(building) = building {
            *length.entry(*building).or_default() += line.segment.length();
        }
    }
    length.retain(|_, length| *length >= LEAST_LINES_M);
    let number = |of: &[usize; 2]| length.keys().position(|building| building == of);
    building
        .iter()
        .map(|b| b.as_ref().and_then(number))
        .collect()
}

/// The first of the lines that each line is linked to: they come near each other in plan and are
/// nearly parallel or perpendicular.
fn linked(lines: &[TileLine], link_m: f64) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..lines.len()).collect();
    fn root(parent: &mut [usize], mut k: usize) -> usize {
        while parent[k] != k {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        k
    }
    for i in 0..lines.len() {
        for j in i + 1..lines.len() {
            let [a, b] = [&lines[i], &lines[j]];
            if apart(a.azimuth.radians, b.azimuth.radians) < PARALLEL_ANGLE
                && between(&a.segment, &b.segment) < link_m
            {
                let (a, b) = (root(&mut parent, i), root(&mut parent, j));
                parent[a.max(b)] = a.min(b);
            }
        }
    }
    (0..lines.len()).map(|k| root(&mut parent, k)).collect()
}

fn windows_of(
    lines: &[TileLine],
    group: &[Option<usize>],
    z_range_m: [f64; 2],
    margin_m: f64,
) -> Vec<Window> {
    let count = group.iter().flatten().max().map_or(0, |m| m + 1);
    let window_of = |g: usize| {
        let own = || {
            lines
                .iter()
                .zip(group)
                .filter(move |(_, h)| **h == Some(g))
                .map(|(l, _)| l)
        };
        let ends = own().flat_map(|l| [l.segment.p0.xy(), l.segment.p1.xy()]);
        let [min, max] = bounds(ends);
        let margin = nalgebra::Vector2::new(margin_m, margin_m);
        // The lines are sorted: the first one is the longest.
        let longest = own().next()?.azimuth.radians;
        let azimuth = MeasuredAzimuth::mean(longest, own().map(|l| l.azimuth))?.radians;
        Some(Window {
            directions: vec![MainDirections {
                azimuth,
                // Of image lines, which `find_windows` counts.
                share: 0.0,
            }],
            ..window([min - margin, max + margin], z_range_m)
        })
    };
    (0..count).filter_map(window_of).collect()
}

fn azimuth(line: &Segment3) -> f64 {
    let d = line.direction();
    atan2(d.y, d.x)
}

/// Difference of two azimuths up to right angles, radians, 0 to pi/4.
fn apart(a: f64, b: f64) -> f64 {
    let d = (a - b).rem_euclid(std::f64::consts::FRAC_PI_2);
    d.min(std::f64::consts::FRAC_PI_2 - d)
}

fn distance(line: &Segment3, p: &Point3<f64>) -> f64 {
    let d = line.direction();
    let t = (p - line.p0).dot(&d).clamp(0.0, line.length());
    (p - (line.p0 + d * t)).norm()
}

/// Least distance in plan between two lines, from points along them.
fn between(a: &Segment3, b: &Segment3) -> f64 {
    let flat = |s: &Segment3| {
        let down = |p: Point3<f64>| Point3::new(p.x, p.y, 0.0);
        Segment3::new(down(s.p0), down(s.p1))
    };
    let (a, b) = (flat(a), flat(b));
    let samples = |s: &Segment3, other: &Segment3| {
        let n = (s.length() / 0.5).ceil().max(1.0);
        (0..=n as u32)
            .map(|i| distance(other, &s.at(f64::from(i) / n)))
            .fold(f64::INFINITY, f64::min)
    };
    samples(&a, &b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(x0: f64, y0: f64, x1: f64, y1: f64) -> TileLine {
        let segment = Segment3::new(Point3::new(x0, y0, 5.0), Point3::new(x1, y1, 5.0));
        TileLine {
            segment,
            azimuth: MeasuredAzimuth {
                radians: azimuth(&segment),
                sigma: 0.005,
            },
        }
    }

    #[test]
    fn lines_of_one_house_are_one_group() {
        // A rectangle, another one 8 m away, one turned by 30 degrees that touches the first, and a
        // line alone, which has no direction to share.
        let mut lines = vec![
            line(0.0, 0.0, 9.0, 0.0),
            line(9.0, 0.2, 9.0, 6.0),
            line(0.0, 6.0, 9.0, 6.0),
        ];
        lines.extend([line(18.0, 0.0, 26.0, 0.0), line(18.0, 0.3, 18.0, 6.0)]);
        lines.push(line(9.0, 6.0, 15.93, 10.0));
        lines.push(line(9.0, 6.0, 7.0, 9.464));
        lines.push(line(50.0, 0.0, 53.0, 0.0));
        let found = groups(&lines, 2.0);
        assert_eq!(
            found,
            [
                Some(0),
                Some(0),
                Some(0),
                Some(1),
                Some(1),
                Some(2),
                Some(2),
                None
            ]
        );
        let windows = windows_of(&lines, &found, [0.0, 10.0], 1.0);
        assert_eq!(
            (windows[1].min, windows[1].max),
            (Point2::new(17.0, -1.0), Point2::new(27.0, 7.0))
        );
    }
}
