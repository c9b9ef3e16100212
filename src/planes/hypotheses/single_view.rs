//! Evidence for a plane from a single view, where no other sees it.
//!
//! At the margin of a block, or of a cropped photograph, a roof continues where only one view is
//! left. There is nothing to correlate, but the plane is known, and so is the appearance of its
//! surface in this view, from where several views are consistent with the plane. Where the
//! appearance is the same the surface continues, where it differs the surface has ended, and an
//! edge between the two bounds the plane (monoplotting: one image and a known surface). An
//! appearance that the surroundings share is no evidence.

use nalgebra::{Matrix2, Vector2};
use serde::{Deserialize, Serialize};

use super::line_sides::{CLEAR_NATS, places_beside};
use crate::base::geometry::{Plane, Segment3};
use crate::base::math::{SIGMA_OVER_MEDIAN, median};
use crate::lines::lines3d::Side;
use crate::orienting::scene::{Scene, View};
use crate::photographs::raster::Channel;
use crate::planes::grouping::PlanRegion;
use crate::planes::photoconsistency::{
    BoxSum, CELL_SAMPLES, ConsistencyMap, HALF_WINDOW, PlanGrid, RowSum, WINDOW_CELLS, orthophoto,
};

/// Positions along each side of the window at which single-view coverage is sampled.
const SAMPLES: usize = 24;
/// Least area seen consistently by several views from which the appearance is estimated, square
/// metres. Assumption: some windows.
const LEAST_REFERENCE_M2: f64 = 2.0;
/// Squared Mahalanobis distance at which an appearance is neutral: three standard deviations.
const GATE: f64 = 9.0;
/// Least standard deviation of an appearance, in grey values of range 1: the light differs along a
/// roof.
const LEAST_DEVIATION: f64 = 0.015;
/// Rounds of trimming the outliers, such as skylights and chimneys.
const TRIMS: usize = 3;
/// Least evidence for the surface on one side of an edge, and against it on the other, of one.
const CLEAR_CHANGE: f64 = 0.4;

/// Single-view evidence that the surface continues, for every position of a plane's window.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct SingleViewEvidence {
    /// In steps of 1 / 127, row by row; 0 where not exactly one view sees the position, empty if
    /// nowhere.
    values: Vec<i8>,
}

impl SingleViewEvidence {
    /// The same everywhere.
    #[cfg(test)]
    pub(crate) fn everywhere(cells: usize, value: i8) -> Self {
        Self {
            values: vec![value; cells],
        }
    }

    /// The evidence at a position of the window (row by row), from -1, another surface, to 1; 0
    /// where not exactly one view sees it.
    pub(crate) fn at(&self, k: usize) -> f64 {
        self.values.get(k).map_or(0.0, |s| f64::from(*s) / 127.0)
    }

    /// Does the surface end at an edge: is it on one side, where several views may see it, and not
    /// on the other?
    pub(crate) fn ends_at(&self, map: &ConsistencyMap, edge: &Segment3) -> bool {
        let [left, right] = [Side::Left, Side::Right].map(|side| {
            let places = places_beside(&map.grid, edge, side, HALF_WINDOW as f64 + 1.5);
            let count = places.clone().count().max(1) as f64;
            places.map(|k| self.surface_at(map, k)).sum::<f64>() / count
        });
        left.max(right) >= CLEAR_CHANGE && left.min(right) <= -CLEAR_CHANGE
    }

    /// The evidence for the surface at a position, from -1, another surface, to 1, by one view or
    /// by several.
    fn surface_at(&self, map: &ConsistencyMap, k: usize) -> f64 {
        match map.nats(k) {
            on if on >= CLEAR_NATS => 1.0,
            off if off <= -CLEAR_NATS => -1.0,
            _ => self.at(k),
        }
    }
}

/// The evidence of every view where it is the only one, by the surface's appearance in it where
/// `map` shows that several views are consistent with the plane.
pub(crate) fn single_view_evidence(
    scene: &Scene,
    plane: &Plane,
    region: &PlanRegion,
    map: &ConsistencyMap,
) -> SingleViewEvidence {
    let grid = &map.grid;
    let known = reference_cells(region, map);
    let least = LEAST_REFERENCE_M2 / (grid.step * grid.step);
    if (known.len() as f64) < least || !is_seen_once_somewhere(scene, plane, region, grid) {
        return SingleViewEvidence::default();
    }
    let mean_appearance = |view: &View, channel| {
        let [mut photo, rest @ ..] = orthophoto(view.channel(channel).0, &view.camera, plane, grid);
        for samples in &rest {
            photo.iter_mut().zip(samples).for_each(|(sum, v)| *sum += v);
        }
        let samples = (CELL_SAMPLES * CELL_SAMPLES) as f32;
        photo.iter_mut().for_each(|sum| *sum /= samples);
        window_means(&photo, grid)
    };
    let grey: Vec<Vec<f32>> = (scene.views.iter())
        .map(|view| mean_appearance(view, Channel::Grey))
        .collect();
    let only = |k: usize| {
        let mut seeing = (0..grey.len()).filter(|&v| grey[v][k].is_finite());
        let first = seeing.next()?;
        seeing.next().is_none().then_some(first)
    };
    let by: Vec<Option<usize>> = (0..grid.width * grid.height).map(only).collect();
    let mut values = vec![0; by.len()];
    for (v, (grey, view)) in grey.into_iter().zip(&scene.views).enumerate() {
        let mut cells = (0..by.len()).filter(|&k| by[k] == Some(v)).peekable();
        if cells.peek().is_none() {
            continue;
        }
        let red_blue = mean_appearance(view, Channel::RedBlue);
        let appearances = ViewAppearance { grey, red_blue };
        let Some(surface) = SurfaceAppearance::estimate(&appearances, &known, least, map) else {
            continue;
        };
        for k in cells {
            let likeness = appearances
                .at(k)
                .map_or(0.0, |appearance| surface.likeness(&appearance));
            values[k] = (likeness * 127.0).round() as i8;
        }
    }
    SingleViewEvidence { values }
}

/// Positions of the window where several views are consistent with the plane.
fn reference_cells(region: &PlanRegion, map: &ConsistencyMap) -> Vec<usize> {
    let grid = &map.grid;
    let rows = (0..grid.height).map(|r| (r, region.row(grid.center(0, r).y)));
    rows.flat_map(|(r, of_region)| {
        let on = move |c: &usize| {
            map.nats(r * grid.width + c) >= CLEAR_NATS && of_region.contains(grid.center(*c, r).x)
        };
        (0..grid.width).filter(on).map(move |c| r * grid.width + c)
    })
    .collect()
}

/// Is there a position of the region that exactly one view has in its image? Sampled, for mostly
/// there is none.
fn is_seen_once_somewhere(
    scene: &Scene,
    plane: &Plane,
    region: &PlanRegion,
    grid: &PlanGrid,
) -> bool {
    let part = |i: usize, size: usize| (i * 2 + 1) * size / (2 * SAMPLES);
    let positions = (0..SAMPLES * SAMPLES).map(|k| {
        grid.center(
            part(k % SAMPLES, grid.width),
            part(k / SAMPLES, grid.height),
        )
    });
    let mut inside = positions.filter(|p| region.contains(p));
    inside.any(|p| {
        let point = plane.lift(p.x, p.y);
        let has = |view: &&View| {
            let x = view.camera.project(&point);
            x.is_some_and(|x| view.camera.contains(&x, 0.0))
        };
        scene.views.iter().filter(has).count() == 1
    })
}

/// Appearance of a plane in a view: mean grey value and red-blue difference of the window around
/// every position.
struct ViewAppearance {
    grey: Vec<f32>,
    red_blue: Vec<f32>,
}

impl ViewAppearance {
    /// `None` where the view does not have all of the window.
    fn at(&self, k: usize) -> Option<Vector2<f64>> {
        let [grey, red_blue] = [&self.grey, &self.red_blue].map(|channel| f64::from(channel[k]));
        (grey.is_finite() && red_blue.is_finite()).then(|| Vector2::new(grey, red_blue))
    }
}

/// Means over the windows around all cells; NaN where a window is not complete.
fn window_means(photo: &[f32], grid: &PlanGrid) -> Vec<f32> {
    let (mut values, mut seen) = (BoxSum::new(grid), BoxSum::new(grid));
    let mut line = RowSum::new(grid.width);
    let row_of = |y: usize| photo[y * grid.width..].iter().take(grid.width);
    let mut means = Vec::with_capacity(photo.len());
    for _ in 0..grid.height {
        let counts = seen.next_row(&mut line, |y, out| {
            let counts = row_of(y).map(|v| f32::from(u8::from(v.is_finite())));
            out.iter_mut().zip(counts).for_each(|(o, c)| *o = c);
        });
        let counts = counts.to_vec();
        let sums = values.next_row(&mut line, |y, out| {
            let known = row_of(y).map(|v| if v.is_finite() { *v } else { 0.0 });
            out.iter_mut().zip(known).for_each(|(o, v)| *o = v);
        });
        let mean = |(sum, count): (&f32, &f32)| match *count > WINDOW_CELLS - 0.5 {
            true => sum / count,
            false => f32::NAN,
        };
        means.extend(sums.iter().zip(&counts).map(mean));
    }
    means
}

/// Normal distribution of a surface's appearance in a view.
struct SurfaceAppearance {
    mean: Vector2<f64>,
    information: Matrix2<f64>,
    /// How distinctive the appearance is, 0 to 1: 0 where other surfaces share it.
    distinctiveness: f64,
}

impl SurfaceAppearance {
    /// From positions `known` to be on it, of which the view must show `least`; `None` otherwise.
    fn estimate(
        appearances: &ViewAppearance,
        known: &[usize],
        least: f64,
        map: &ConsistencyMap,
    ) -> Option<Self> {
        let known: Vec<Vector2<f64>> = known.iter().filter_map(|&k| appearances.at(k)).collect();
        (known.len() as f64 >= least).then_some(())?;
        let mut surface = Self::robust(&known)?;
        for _ in 0..TRIMS {
            let alike = known
                .iter()
                .filter(|appearance| surface.likeness(appearance) > 0.0);
            surface = Self::from_samples(alike)?;
        }
        let off = (0..map.grid.width * map.grid.height)
            .filter(|&k| map.nats(k) <= -CLEAR_NATS)
            .filter_map(|k| appearances.at(k));
        let (alike, all) = off.fold((0.0, 0.0), |(alike, all), appearance| {
            (alike + surface.likeness(&appearance).max(0.0), all + 1.0)
        });
        surface.distinctiveness = 1.0 - alike / f64::max(all, 1.0);
        Some(surface)
    }

    /// By median and median absolute deviation: up to half of the samples may be outliers.
    fn robust(appearances: &[Vector2<f64>]) -> Option<Self> {
        let middle =
            |values: &mut dyn Iterator<Item = f64>| median(&mut values.collect::<Vec<_>>());
        let mut mean = Vector2::zeros();
        let mut information = Matrix2::zeros();
        for i in 0..2 {
            mean[i] = middle(&mut appearances.iter().map(|appearance| appearance[i]))?;
            let off = middle(
                &mut appearances
                    .iter()
                    .map(|appearance| (appearance[i] - mean[i]).abs()),
            )?;
            let deviation = SIGMA_OVER_MEDIAN * off;
            information[(i, i)] = 1.0 / (deviation * deviation + LEAST_DEVIATION * LEAST_DEVIATION);
        }
        Some(Self {
            mean,
            information,
            distinctiveness: 1.0,
        })
    }

    /// By mean and covariance of some samples.
    fn from_samples<'a>(
        appearances: impl Iterator<Item = &'a Vector2<f64>> + Clone,
    ) -> Option<Self> {
        let count = appearances.clone().count().max(1) as f64;
        let mean = appearances.clone().sum::<Vector2<f64>>() / count;
        let scatter = appearances.fold(Matrix2::zeros(), |s, appearance| {
            s + (appearance - mean) * (appearance - mean).transpose()
        });
        let covariance =
            scatter / count + Matrix2::identity() * (LEAST_DEVIATION * LEAST_DEVIATION);
        Some(Self {
            mean,
            information: covariance.try_inverse()?,
            distinctiveness: 1.0,
        })
    }

    fn likeness(&self, appearance: &Vector2<f64>) -> f64 {
        let d = appearance - self.mean;
        let likeness = 1.0 - (d.transpose() * self.information * d).x / GATE;
        match likeness > 0.0 {
            true => likeness * self.distinctiveness,
            false => likeness.max(-1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photographs::raster::Gray;
    use crate::planes::photoconsistency::consistency_map;
    use crate::planes::rendered_planes;
    use crate::roofs::testing::line;
    use nalgebra::{Point2, Point3};

    /// Where the roof ends, metres along x.
    const END: f64 = 6.0;

    fn roof() -> Plane {
        Plane::from_point_normal(&Point3::new(0.0, 0.0, 6.0), &Vector2::zeros().push(1.0))
            .expect("upright")
    }

    /// Two views of a level roof from -9 m to [`END`]; `around` is what they show beside it, and
    /// the second does not reach beyond `reach` metres along x.
    fn scene(around: f32, reach: f64) -> Scene {
        let surface = rendered_planes::TexturedPlane {
            plane: roof(),
            exists: |x, _| x > -9.0 && x < END,
            texture: 0.2,
        };
        let mut scene = rendered_planes::scene(&[surface]);
        scene.views.truncate(2);
        for (i, view) in scene.views.iter_mut().enumerate() {
            let (camera, shown) = (view.camera.clone(), view.gray.clone());
            let end = camera
                .project(&Point3::new(reach, 0.0, 6.0))
                .expect("in front");
            let width = if i == 1 { end.x as usize } else { shown.width };
            view.camera.width = width as u32;
            view.gray = Gray::from_fn(width, shown.height, |column, row| {
                let ray = camera.ray(&Point2::new(column as f64 + 0.5, row as f64 + 0.5));
                let t = -roof().signed_distance(&camera.center) / roof().normal.dot(&ray);
                let x = (camera.center + ray * t).x;
                if x > -9.0 && x < END {
                    shown.get(column, row)
                } else {
                    around
                }
            });
        }
        scene
    }

    /// How the views agree on the roof, beside a ridge through its middle, and the single-view
    /// evidence for it.
    fn seen(scene: &Scene) -> (ConsistencyMap, SingleViewEvidence) {
        let ridge = line(Point3::new(-8.0, 0.0, 6.0), Point3::new(5.0, 0.0, 6.0));
        let region = crate::planes::grouping::region_beside(ridge, roof());
        let grid = PlanGrid::covering(Point2::new(-9.0, -5.0), Point2::new(9.0, 5.0), 0.2);
        let map = consistency_map(scene, &roof(), &grid);
        let single_view = single_view_evidence(scene, &roof(), &region, &map);
        (map, single_view)
    }

    fn at((map, single_view): &(ConsistencyMap, SingleViewEvidence), x: f64) -> f64 {
        let (column, row) = map.grid.cell(&Point2::new(x, 1.0)).expect("inside");
        single_view.at(row * map.grid.width + column)
    }

    fn across(x: f64) -> Segment3 {
        Segment3::new(Point3::new(x, -3.0, 6.0), Point3::new(x, 3.0, 6.0))
    }

    #[test]
    fn a_roof_goes_on_in_the_only_view_as_far_as_its_appearance_does() {
        let seen = seen(&scene(0.15, 2.0));
        assert_eq!(at(&seen, -3.0), 0.0, "two views see it");
        assert!(at(&seen, 4.0) > 0.5 && at(&seen, 7.5) < -0.9);
        let (map, single_view) = &seen;
        assert!(single_view.ends_at(map, &across(END)));
        assert!(!single_view.ends_at(map, &across(4.0)), "a row of tiles");
        assert!(!single_view.ends_at(map, &across(7.5)), "beyond the roof");
    }

    #[test]
    fn several_views_may_see_one_side_of_an_edge() {
        // The second view ends a window's width before the roof does.
        let (map, single_view) = seen(&scene(0.15, END));
        let inside = (END - 0.7, 1.0);
        let (column, row) = map
            .grid
            .cell(&Point2::new(inside.0, inside.1))
            .expect("inside");
        assert!(
            map.weight(row * map.grid.width + column) > 0.0,
            "both see it"
        );
        assert!(single_view.ends_at(&map, &across(END)));
        assert!(!single_view.ends_at(&map, &across(3.0)), "a row of tiles");
    }

    #[test]
    fn where_two_views_reach_there_is_no_single_view_evidence() {
        let seen = seen(&scene(0.15, 11.0));
        assert!(seen.1.values.is_empty());
        assert_eq!(at(&seen, 4.0), 0.0);
    }

    #[test]
    fn an_appearance_that_is_not_known_is_no_evidence() {
        // Two views share no more than a metre of the roof.
        let seen = seen(&scene(0.15, -8.0));
        assert_eq!(at(&seen, 4.0), 0.0);
        assert_eq!(at(&seen, 7.5), 0.0);
    }
}
