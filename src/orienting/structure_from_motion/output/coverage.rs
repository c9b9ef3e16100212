//! Whether a flight sees enough: how many photographs show each place of its area, from how
//! different directions, how exact a height follows, and from where another photograph would tell
//! most.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Point2, Point3};
use serde::Serialize;

use super::sparse_model::{OrientedPhoto, SparseModel};
use crate::base::math::{atan2, ln, median};
use crate::orienting::orientation::Anchor;
use crate::orienting::structure_from_motion::block::Pose;
use crate::orienting::structure_from_motion::intrinsics::Intrinsics;
use crate::orienting::structure_from_motion::resection::linearised;
use crate::orienting::structure_from_motion::triangulation::angle;
use crate::photographs::camera::FEWEST_VIEWS;

/// Cells along the longer side of the area, of which each has a mark on a plan.
const CELLS: f64 = 32.0;

/// So many of a hundred points on each side of the area in east and in north lie outside of it: far
/// ones that flat rays show.
const OUTSIDE_PERCENT: usize = 1;

/// From so many on more do not find more facets; of those above 10 m2 three and four photographs
/// find 86 of 100, five and more 94 (docs/results/fresh-seeds.md).
const ENOUGH_VIEWS: usize = 5;

/// Most places from which another photograph is proposed.
const MOST_PROPOSED: usize = 3;

/// Rays (x, y, 1) that differ by more are not the same: the search for a ray leaves far less, and a
/// lens folds what lies far outside of its image over it.
const SAME_RAY: f64 = 1e-3;

/// The area of a flight, cell by cell.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlanCoverage {
    /// South-western corner of the first cell, in the frame.
    pub corner: [f64; 2],
    /// Side of a cell, in the unit of the frame.
    pub side: f64,
    /// Cells of a row; the first row is the southern one.
    pub columns: usize,
    /// Row by row; nothing where no points of the block lie on both sides of a cell.
    pub cells: Vec<Option<CoveredCell>>,
    /// Shares of these cells that five photographs or more show, three or four, and fewer.
    pub shares: [f64; 3],
    /// From where another photograph would tell most of the cells between the cameras that fewer
    /// than five show, the most telling first.
    pub proposed: Vec<ProposedPhoto>,
}

/// A cell of the plan at the height of the block's points there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CoveredCell {
    /// Photographs whose image holds its middle. What stands before it is not known.
    pub views: usize,
    /// The largest angle between two of their rays, degrees.
    pub angle_deg: f64,
    /// Standard deviation of its height where each of them shows it to a pixel, in the unit of the
    /// frame; none of a single one.
    pub height_sigma: Option<f64>,
}

/// Where another photograph is to be taken.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ProposedPhoto {
    /// Position in the frame.
    pub position: [f64; 3],
    /// The photograph whose direction it has.
    pub like: String,
    /// Longitude and latitude, degrees, where the place of the frame on the Earth is known.
    pub lon_lat_deg: Option<[f64; 2]>,
}

/// What photographs say of the middle of a cell.
#[derive(Clone)]
struct Seen {
    place: Point3<f64>,
    centers: Vec<Point3<f64>>,
    /// Normal matrix of its coordinates for a standard deviation of one pixel.
    normal: Matrix3<f64>,
}

impl PlanCoverage {
    /// The coverage of a block; `None` of one whose points lie on a line.
    pub(in super::super) fn of(model: &SparseModel, anchor: Option<&Anchor>) -> Option<Self> {
        let grid = Grid::of(model)?;
        let mut seen: Vec<Option<Seen>> = (grid.heights.iter().enumerate())
            .map(|(cell, height)| Some(Seen::new(grid.middle(cell, (*height)?))))
            .collect();
        for place in seen.iter_mut().flatten() {
            for photo in &model.photos {
                place.add(&model.cameras[photo.camera], &photo.pose);
            }
        }
        let cells: Vec<Option<CoveredCell>> = (seen.iter())
            .map(|seen| seen.as_ref().map(Seen::cell))
            .collect();
        let shares = shares(cells.iter().flatten());
        let proposed = proposed(model, &grid, seen.into_iter().flatten().collect(), anchor);
        Some(Self {
            corner: grid.corner.into(),
            side: grid.side,
            columns: grid.columns,
            cells,
            shares,
            proposed,
        })
    }

    /// In words, a sentence for the area and one for each proposed photograph; `offset` is what
    /// files add to the coordinates of the frame.
    pub fn words(&self, offset: [f64; 3]) -> Vec<String> {
        let [enough, some, _] = self.shares.map(|share| (100.0 * share).round());
        let area = format!(
            "of the area {enough} % are shown by {ENOUGH_VIEWS} photographs or more, {some} % by \
             {FEWEST_VIEWS} or {}, {} % by fewer",
            ENOUGH_VIEWS - 1,
            100.0 - enough - some
        );
        let place = |photo: &ProposedPhoto| {
            let [x, y, z] = [0, 1, 2].map(|i| photo.position[i] + offset[i]);
            let on_earth = photo.lon_lat_deg.map_or_else(String::new, |[lon, lat]| {
                format!(" (longitude {lon:.6}, latitude {lat:.6})")
            });
            format!(
                "another photograph would tell most from x {x:.1}, y {y:.1}, z {z:.1}{on_earth}, \
                 taken in the direction of {}",
                photo.like
            )
        };
        [area]
            .into_iter()
            .chain(self.proposed.iter().map(place))
            .collect()
    }
}

/// Shares of cells with enough, some and few photographs.
fn shares<'a>(cells: impl Iterator<Item = &'a CoveredCell>) -> [f64; 3] {
    let mut counts = [0usize; 3];
    for cell in cells {
        counts[usize::from(cell.views < ENOUGH_VIEWS) + usize::from(cell.views < FEWEST_VIEWS)] +=
            1;
    }
    let all = counts.iter().sum::<usize>().max(1);
    counts.map(|count| count as f64 / all as f64)
}

/// The cells of a plan with the height of the block's points in each.
struct Grid {
    corner: Point2<f64>,
    side: f64,
    columns: usize,
    /// Row by row; in cells without points that of the nearest one in their row.
    heights: Vec<Option<f64>>,
}

impl Grid {
    fn of(model: &SparseModel) -> Option<Self> {
        let range = |axis: usize| {
            let mut values: Vec<f64> = model.points.iter().map(|p| p.position[axis]).collect();
            values.sort_by(f64::total_cmp);
            let outside = values.len() * OUTSIDE_PERCENT / 100;
            Some([*values.get(outside)?, *values.iter().rev().nth(outside)?])
        };
        let ([x0, x1], [y0, y1]) = (range(0)?, range(1)?);
        let side = (x1 - x0).max(y1 - y0) / CELLS;
        let columns = ((x1 - x0) / side).ceil();
        let rows = ((y1 - y0) / side).ceil();
        // False of no extent, too.
        if !(columns >= 1.0 && rows >= 1.0) {
            return None;
        }
        let (columns, rows) = (columns as usize, rows as usize);
        let mut heights: Vec<Vec<f64>> = vec![Vec::new(); columns * rows];
        for point in &model.points {
            let p = &point.position;
            let [column, row] = [(p.x - x0) / side, (p.y - y0) / side].map(f64::floor);
            let is_inside = column >= 0.0 && row >= 0.0;
            if is_inside && (column as usize) < columns && (row as usize) < rows {
                heights[row as usize * columns + column as usize].push(p.z);
            }
        }
        let heights: Vec<Option<f64>> = heights.iter_mut().map(|z| median(z)).collect();
        Some(Self {
            corner: Point2::new(x0, y0),
            side,
            columns,
            heights: between(&heights, columns),
        })
    }

    fn middle(&self, cell: usize, height: f64) -> Point3<f64> {
        let [column, row] = [cell % self.columns, cell / self.columns].map(|i| i as f64 + 0.5);
        Point3::new(
            self.corner.x + column * self.side,
            self.corner.y + row * self.side,
            height,
        )
    }
}

/// Heights also of the empty cells that have others on both sides, in their row and in their
/// column: that of the nearest in the row.
fn between(heights: &[Option<f64>], columns: usize) -> Vec<Option<f64>> {
    let rows = heights.len() / columns;
    let at = |row: usize, column: usize| heights[row * columns + column];
    (0..heights.len())
        .map(|cell| {
            let (row, column) = (cell / columns, cell % columns);
            let west = (0..=column)
                .rev()
                .find_map(|c| Some((column - c, at(row, c)?)));
            let east = (column..columns).find_map(|c| Some((c - column, at(row, c)?)));
            let has_south = (0..=row).any(|r| at(r, column).is_some());
            let has_north = (row..rows).any(|r| at(r, column).is_some());
            let (west, east) = west.zip(east).filter(|_| has_south && has_north)?;
            Some(if west.0 <= east.0 { west.1 } else { east.1 })
        })
        .collect()
}

impl Seen {
    fn new(place: Point3<f64>) -> Self {
        Self {
            place,
            centers: Vec::new(),
            normal: Matrix3::zeros(),
        }
    }

    fn add(&mut self, camera: &Intrinsics, pose: &Pose) {
        if let Some(normal) = normal_of(&self.place, camera, pose) {
            self.centers.push(pose.center);
            self.normal += normal;
        }
    }

    fn cell(&self) -> CoveredCell {
        let rays: Vec<_> = self.centers.iter().map(|c| self.place - c).collect();
        let angles =
            (rays.iter().enumerate()).flat_map(|(i, a)| rays[..i].iter().map(move |b| angle(a, b)));
        CoveredCell {
            views: self.centers.len(),
            angle_deg: angles.fold(0.0, f64::max).to_degrees(),
            height_sigma: (self.normal.try_inverse())
                .filter(|_| self.centers.len() > 1)
                .map(|covariance| covariance[(2, 2)].max(0.0).sqrt()),
        }
    }
}

/// Normal matrix of a place that a photograph shows to a pixel; `None` where it does not show it.
fn normal_of(place: &Point3<f64>, camera: &Intrinsics, pose: &Pose) -> Option<Matrix3<f64>> {
    let (image, .., by_place) = linearised(pose, camera, place, &Point2::origin())?;
    let is_inside = (0..2).all(|i| image[i] >= 0.0 && image[i] <= f64::from(camera.size[i]));
    let p = pose.in_camera(place);
    let folded = || camera.ray(&Point2::from(image)) - p.xy() / p.z;
    (is_inside && folded().norm() < SAME_RAY).then(|| by_place.transpose() * by_place)
}

/// Greedily, those from which the heights of the cells between the cameras gain most that too few
/// photographs show.
fn proposed(
    model: &SparseModel,
    grid: &Grid,
    mut seen: Vec<Seen>,
    anchor: Option<&Anchor>,
) -> Vec<ProposedPhoto> {
    let centers: Vec<Point2<f64>> = model.photos.iter().map(|p| p.pose.center.xy()).collect();
    seen.retain(|s| is_between(&centers, &s.place.xy()));
    let mut heights: Vec<f64> = seen.iter().map(|s| s.place.z).collect();
    let Some(ground) = median(&mut heights) else {
        return Vec::new();
    };
    let candidates = candidates(model, grid, &centers);
    let mut proposed = Vec::new();
    while proposed.len() < MOST_PROPOSED {
        let gain = |(like, pose): &(&OrientedPhoto, Pose)| -> f64 {
            let depth = pose.center.z - ground;
            (seen.iter().filter(|s| s.centers.len() < ENOUGH_VIEWS))
                .filter_map(|s| {
                    let normal = normal_of(&s.place, &model.cameras[like.camera], pose)?;
                    Some(ln_sigma(&s.normal, depth) - ln_sigma(&(s.normal + normal), depth))
                })
                .sum()
        };
        let gains = candidates
            .iter()
            .map(|candidate| (gain(candidate), candidate));
        // The first of equal ones.
        let best = gains.fold(None::<(f64, _)>, |best, one| match best {
            Some(best) if best.0 >= one.0 => Some(best),
            _ => Some(one),
        });
        let Some((_, (like, pose))) = best.filter(|(gain, _)| *gain > 0.0) else {
            break;
        };
        for place in &mut seen {
            place.add(&model.cameras[like.camera], pose);
        }
        proposed.push(ProposedPhoto {
            position: pose.center.into(),
            like: like.path.clone(),
            lon_lat_deg: anchor.map(|anchor| {
                let [lon, lat, _] = anchor.geographic(&pose.center);
                [lon, lat]
            }),
        });
    }
    proposed
}

/// Does a place lie in the convex hull of others: are they on no side of it alone?
fn is_between(others: &[Point2<f64>], place: &Point2<f64>) -> bool {
    let direction = |p: &Point2<f64>| atan2(p.y - place.y, p.x - place.x);
    let mut directions: Vec<f64> = others.iter().map(direction).collect();
    directions.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (directions.first(), directions.last()) else {
        return false;
    };
    let around = TAU - (last - first);
    let gaps = directions.windows(2).map(|pair| pair[1] - pair[0]);
    gaps.fold(around, f64::max) < PI
}

/// Poses over every second cell of every second row between the cameras, which is near enough to
/// the best place: as high as the nearest photograph, and in its direction.
fn candidates<'a>(
    model: &'a SparseModel,
    grid: &Grid,
    centers: &[Point2<f64>],
) -> Vec<(&'a OrientedPhoto, Pose)> {
    let rows = grid.heights.len() / grid.columns;
    let cells = (0..rows).step_by(2).flat_map(|row| {
        let columns = (0..grid.columns).step_by(2);
        columns.map(move |column| row * grid.columns + column)
    });
    (cells.map(|cell| grid.middle(cell, 0.0).xy()))
        .filter(|place| is_between(centers, place))
        .filter_map(|place| {
            let distance = |p: &OrientedPhoto| (p.pose.center.xy() - place).norm_squared();
            let nearest = (model.photos.iter()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let like = nearest?;
            let center = Point3::new(place.x, place.y, like.pose.center.z);
            let rotation = like.pose.rotation;
            Some((like, Pose { rotation, center }))
        })
        .collect()
}

/// Logarithm of the standard deviation of a height that is known to within `depth` beforehand.
fn ln_sigma(normal: &Matrix3<f64>, depth: f64) -> f64 {
    let prior = depth * depth;
    let covariance = (normal + Matrix3::identity() / prior).try_inverse();
    0.5 * ln(covariance.map_or(prior, |c| c[(2, 2)]))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::base::geometry::rotation_from_axis_angle;
    use crate::base::math::atan;
    use crate::orienting::structure_from_motion::output::SparsePoint;

    const FOCAL_PX: f64 = 500.0;
    const FLYING_HEIGHT_M: f64 = 50.0;

    /// Level ground of 100 x 100 m, a point every 2 m, and photographs of 40 x 40 m that look down
    /// on it from these places.
    fn flight(places: impl IntoIterator<Item = [f64; 2]>) -> SparseModel {
        let photo = |(i, [x, y]): (usize, [f64; 2])| OrientedPhoto {
            path: format!("{i}.png"),
            camera: 0,
            pose: Pose {
                rotation: rotation_from_axis_angle(&(Vector3::x() * std::f64::consts::PI)),
                center: Point3::new(x, y, FLYING_HEIGHT_M),
            },
            rays: Vec::new(),
        };
        let points = (0..=50).flat_map(|i| (0..=50).map(move |j| [2 * i, 2 * j].map(f64::from)));
        SparseModel {
            cameras: vec![Intrinsics::new(FOCAL_PX, [400, 400])],
            photos: places.into_iter().enumerate().map(photo).collect(),
            points: (points)
                .map(|[x, y]| SparsePoint {
                    position: Point3::new(x, y, 0.0),
                    rgb: [128; 3],
                    rms_px: 0.5,
                    rays: Vec::new(),
                })
                .collect(),
            ..SparseModel::default()
        }
    }

    /// Every 10 m, but for those that a rule leaves out.
    fn grid_flight(is_flown: impl Fn(&[f64; 2]) -> bool) -> SparseModel {
        let all = (0..=10).flat_map(|i| (0..=10).map(move |j| [10 * i, 10 * j].map(f64::from)));
        flight(all.filter(is_flown))
    }

    #[test]
    fn a_cell_counts_the_photographs_that_show_it() {
        let model = grid_flight(|_| true);
        let coverage = PlanCoverage::of(&model, None).unwrap();
        assert_eq!(coverage.cells.len() % coverage.columns, 0);
        for (i, cell) in coverage.cells.iter().enumerate() {
            let at =
                |i: usize, axis: usize| coverage.corner[axis] + (i as f64 + 0.5) * coverage.side;
            let (x, y) = (at(i % coverage.columns, 0), at(i / coverage.columns, 1));
            // A photograph reaches 20 m to each side.
            let shown = |at: f64| {
                (0..=10)
                    .filter(|k| (10.0 * f64::from(*k) - at).abs() <= 20.0)
                    .count()
            };
            assert_eq!(cell.unwrap().views, shown(x) * shown(y), "{x} {y}");
        }
        assert_eq!(coverage.shares, [1.0, 0.0, 0.0]);
        assert!(coverage.proposed.is_empty());
    }

    #[test]
    fn two_photographs_give_a_height_as_the_normal_case_says() {
        let base_m = 20.0;
        let model = flight([[40.0, 50.0], [40.0 + base_m, 50.0]]);
        let coverage = PlanCoverage::of(&model, None).unwrap();
        let seen: Vec<CoveredCell> = (coverage.cells.iter().flatten().copied())
            .filter(|cell| cell.views == 2)
            .collect();
        assert!(!seen.is_empty());
        // The normal case of stereo photogrammetry: (h / b) (h / f) times that of a parallax.
        let expected = FLYING_HEIGHT_M / base_m * (FLYING_HEIGHT_M / FOCAL_PX) * 2f64.sqrt();
        for cell in seen {
            let sigma = cell.height_sigma.unwrap();
            assert!((sigma - expected).abs() < 1e-9, "{sigma} {expected}");
            assert!(cell.angle_deg < 2.0 * atan(10.0 / FLYING_HEIGHT_M).to_degrees() + 1e-9);
        }
        for cell in coverage
            .cells
            .iter()
            .flatten()
            .filter(|cell| cell.views < 2)
        {
            assert_eq!(cell.height_sigma, None);
        }
    }

    #[test]
    fn another_photograph_is_proposed_where_some_are_missing() {
        let hole = Point2::new(60.0, 40.0);
        let model = grid_flight(|[x, y]| (Point2::new(*x, *y) - hole).amax() > 25.0);
        let coverage = PlanCoverage::of(&model, None).unwrap();
        assert!(coverage.shares[1] + coverage.shares[2] > 0.0);
        let [x, y, z] = coverage.proposed[0].position;
        assert!((Point2::new(x, y) - hole).amax() < 15.0, "{x} {y}");
        assert_eq!(z, FLYING_HEIGHT_M);
        let words = coverage.words([1000.0, 0.0, 0.0]).join("\n");
        assert!(words.contains(&format!("x {:.1}", x + 1000.0)), "{words}");
    }

    #[test]
    fn cells_without_points_lie_between_others() {
        let [south, west, east, north] = [1.0, 2.0, 3.0, 4.0].map(Some);
        let some = [None, south, None, west, None, east, None, north, None];
        let mut filled = some;
        filled[4] = west;
        assert_eq!(between(&some, 3), filled);
    }

    #[test]
    fn a_place_is_between_others_on_all_sides() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]].map(Point2::from);
        for (x, y, expected) in [(1.0, 1.0, true), (3.0, 3.0, false), (-0.1, 2.0, false)] {
            assert_eq!(
                is_between(&corners, &Point2::new(x, y)),
                expected,
                "{x} {y}"
            );
        }
        assert!(!is_between(&[], &corners[0]) && !is_between(&corners[..1], &corners[1]));
    }

    #[test]
    fn points_on_a_line_have_no_area() {
        let mut model = grid_flight(|_| true);
        model.points.retain(|p| p.position.y == 0.0);
        assert_eq!(PlanCoverage::of(&model, None), None);
        model.points.clear();
        assert_eq!(PlanCoverage::of(&model, None), None);
    }
}
