//! A facet's surface as each view shows it, and where something hides it.
//!
//! Drawn onto the plane of a facet, all views have one colour at a place of its surface. What
//! stands on the roof is drawn beside its place, each time elsewhere, so that a view which shows it
//! there differs from the others. How often differences of a size are seen on surfaces and on what
//! hides them is a fitted table ([`HidingTable`]).

use glam::Vec3;
use nalgebra::{Point2, Point3};

use crate::base::evidence::HidingTable;
use crate::base::geometry::{Plane, sides, span};
use crate::base::ids::ViewId;
use crate::base::math::{SIGMA_OVER_MEDIAN, larger, median};
use crate::orienting::scene::Scene;
use crate::photographs::camera::FEWEST_VIEWS;
use crate::photographs::raster::{Gray, colour_at, gaussian_blur, mark_inside};
use crate::planes::photoconsistency::{MAX_VIEWS, PlanGrid};
use crate::roofs::model::Facet;

/// Rounds in which the common colours and the exposures of the views follow from each other.
const EXPOSURE_ROUNDS: usize = 2;
/// Least standard deviation of a colour, of 255: that of rounding and compression.
const LEAST_NOISE: f64 = 2.0;
/// Blur before the gradient of the common colours is taken, cells.
const GRADIENT_BLUR: f64 = 0.7;

/// What speaks for something before a facet, in the views that show it.
pub(super) struct SeenSurface {
    /// The plan of the facet.
    pub grid: PlanGrid,
    plane: Plane,
    pub views: Vec<SeenFrom>,
}

/// The same in one view.
pub(super) struct SeenFrom {
    center: Point3<f64>,
    /// By cell that something hides it, nats; 0 where the view does not say.
    nats: Vec<f32>,
    /// Sums of nats and numbers of cells that say something, from the first column and row to
    /// each corner between cells.
    sums: Vec<[f64; 2]>,
}

impl SeenSurface {
    /// Draws the views onto a facet, at cells of so many metres. `hidden` tells which views do not
    /// see a place of it. `None` where too few do.
    pub(super) fn new(
        scene: &Scene,
        facet: &Facet,
        step: f64,
        hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
    ) -> Option<Self> {
        let [min, max] = facet.plan_bounds();
        let grid = PlanGrid::covering(min, max, step);
        let inside = cells_inside(facet, &grid);
        let mut seen: Vec<(ViewId, Vec<Vec3>)> = (scene.view_ids())
            .map(|v| (v, drawn(scene, v, facet, &grid, &inside, hidden)))
            .filter(|(_, colours)| colours.iter().any(|c| !c.is_nan()))
            .collect();
        if seen.len() < FEWEST_VIEWS {
            return None;
        }
        // Those that show most of it; of equal ones the first.
        seen.sort_by_key(|(_, colours)| colours.iter().filter(|c| c.is_nan()).count());
        seen.truncate(MAX_VIEWS);
        let (ids, mut colours): (Vec<ViewId>, Vec<Vec<Vec3>>) = seen.into_iter().unzip();
        let common = common_colours(&mut colours);
        let views = ids.iter().zip(hiding(&colours, &common, &grid));
        Some(Self {
            views: views
                .map(|(&v, nats)| SeenFrom::new(scene.camera(v).center, nats, &grid))
                .collect(),
            plane: facet.plane,
            grid,
        })
    }

    /// So many metres in cells, at least one.
    pub(super) fn cells_of(&self, metres: f64) -> usize {
        (metres / self.grid.step).round().max(1.0) as usize
    }

    /// Where a view sees a point on the plane of the facet.
    pub(super) fn seen_at(&self, view: &SeenFrom, point: &Point3<f64>) -> Point2<f64> {
        let (camera, above) = (
            self.plane.signed_distance(&view.center),
            self.plane.signed_distance(point),
        );
        let ray = point - view.center;
        (view.center + ray * (camera / (camera - above))).xy()
    }

    /// What a view says of the cells inside a convex ring: nats, and of how many cells.
    pub(super) fn within(&self, view: &SeenFrom, ring: &[Point2<f64>]) -> [f64; 2] {
        let mut total = [0.0; 2];
        self.each_row(ring, |row, from, to| {
            let [a, b] = [row, row + 1].map(|row| row * (self.grid.width + 1));
            for (k, total) in total.iter_mut().enumerate() {
                let sum = |i: usize| view.sums[i][k];
                *total += sum(b + to) - sum(b + from) - sum(a + to) + sum(a + from);
            }
        });
        total
    }

    /// The same of the cells of a square of so many cells to each side around a place.
    pub(super) fn around(&self, view: &SeenFrom, place: &Point2<f64>, half: usize) -> f64 {
        let PlanGrid { width, height, .. } = self.grid;
        let at = (place - self.grid.origin) / self.grid.step;
        let bounds = |v: f64, size: usize| {
            let middle = v.floor();
            let low = (middle - half as f64).clamp(0.0, size as f64);
            let high = (middle + half as f64 + 1.0).clamp(0.0, size as f64);
            [low as usize, high as usize]
        };
        let ([c0, c1], [r0, r1]) = (bounds(at.x, width), bounds(at.y, height));
        let sum = |row: usize, column: usize| view.sums[row * (width + 1) + column][0];
        sum(r1, c1) - sum(r1, c0) - sum(r0, c1) + sum(r0, c0)
    }

    /// Leaves the cells that something hides, in each view those of a ring, out of what is to be
    /// explained.
    pub(super) fn explain(&mut self, shade: impl Fn(&Self, &SeenFrom) -> Vec<Point2<f64>>) {
        let mut views = std::mem::take(&mut self.views);
        for view in &mut views {
            let shade = shade(self, view);
            self.each_row(&shade, |row, from, to| {
                view.nats[row * self.grid.width + from..row * self.grid.width + to].fill(0.0);
            });
            view.sums = sums(&view.nats, &self.grid);
        }
        self.views = views;
    }

    /// The rows of a convex ring, and the columns of each whose middles lie in it.
    fn each_row(&self, ring: &[Point2<f64>], mut of: impl FnMut(usize, usize, usize)) {
        let PlanGrid {
            origin,
            step,
            width,
            height,
        } = self.grid;
        let index = |v: f64, size: usize| (v + 0.5).clamp(0.0, size as f64) as usize;
        let low = ring.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let high = ring.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let rows = [low, high].map(|y| index((y - origin.y) / step, height));
        for row in rows[0]..rows[1] {
            let y = origin.y + (row as f64 + 0.5) * step;
            if let Some(ends) = span(sides(ring), y) {
                let [from, to] = ends.map(|x| index((x - origin.x) / step, width));
                if from < to {
                    of(row, from, to);
                }
            }
        }
    }
}

impl SeenFrom {
    fn new(center: Point3<f64>, nats: Vec<f32>, grid: &PlanGrid) -> Self {
        Self {
            center,
            sums: sums(&nats, grid),
            nats,
        }
    }
}

fn sums(nats: &[f32], grid: &PlanGrid) -> Vec<[f64; 2]> {
    let across = grid.width + 1;
    let mut sums = vec![[0.0; 2]; across * (grid.height + 1)];
    for row in 0..grid.height {
        let mut of_row = [0.0; 2];
        for column in 0..grid.width {
            let nats = nats[row * grid.width + column];
            of_row[0] += f64::from(nats);
            of_row[1] += if nats == 0.0 { 0.0 } else { 1.0 };
            let above = sums[row * across + column + 1];
            sums[(row + 1) * across + column + 1] = [above[0] + of_row[0], above[1] + of_row[1]];
        }
    }
    sums
}

fn cells_inside(facet: &Facet, grid: &PlanGrid) -> Vec<bool> {
    let mut inside = vec![false; grid.width * grid.height];
    let plan = (facet.plan()).mapped(|p| Point2::from((p - grid.origin) / grid.step));
    mark_inside(&plan, grid.width, grid.height, &mut inside);
    inside
}

/// The colours of a view on the facet; NaN where it does not show it.
fn drawn(
    scene: &Scene,
    view: ViewId,
    facet: &Facet,
    grid: &PlanGrid,
    inside: &[bool],
    hidden: &dyn Fn(ViewId, &Point3<f64>) -> bool,
) -> Vec<Vec3> {
    let of_cell = |(k, inside): (usize, &bool)| {
        let place = grid.center(k % grid.width, k / grid.width);
        let place = inside.then(|| facet.plane.lift(place.x, place.y))?;
        let image = scene.camera(view).project(&place)?;
        let colour = colour_at(&scene.view(view).rgb, &image)?;
        (!hidden(view, &place)).then_some(colour)
    };
    let colours = inside.iter().enumerate().map(of_cell);
    colours.map(|colour| colour.unwrap_or(Vec3::NAN)).collect()
}

/// The colours that most views show, and brings the views to their exposure.
fn common_colours(colours: &mut [Vec<Vec3>]) -> Vec<Vec3> {
    let mut common = medians(colours);
    for _ in 0..EXPOSURE_ROUNDS {
        for view in colours.iter_mut() {
            let gain = Vec3::from_array(std::array::from_fn(|c| {
                let ratios = view.iter().zip(&common).map(|(own, all)| own[c] / all[c]);
                let mut ratios: Vec<f64> =
                    ratios.filter(|r| r.is_finite()).map(f64::from).collect();
                median(&mut ratios).map_or(1.0, |gain| larger(gain, 0.1)) as f32
            }));
            view.iter_mut().for_each(|colour| *colour /= gain);
        }
        common = medians(colours);
    }
    common
}

/// The median of the views at every cell, channel by channel; NaN where too few show it.
fn medians(colours: &[Vec<Vec3>]) -> Vec<Vec3> {
    let of_cell = |k: usize| {
        let shown: Vec<Vec3> = colours
            .iter()
            .map(|view| view[k])
            .filter(|c| !c.is_nan())
            .collect();
        if shown.len() < FEWEST_VIEWS {
            return Vec3::NAN;
        }
        Vec3::from_array(std::array::from_fn(|c| {
            let mut values: Vec<f32> = shown.iter().map(|colour| colour[c]).collect();
            values.sort_by(f32::total_cmp);
            let middle = values.len() / 2;
            match values.len() % 2 {
                0 => 0.5 * (values[middle - 1] + values[middle]),
                _ => values[middle],
            }
        }))
    };
    (0..colours[0].len()).map(of_cell).collect()
}

/// By view and cell, that something hides the surface, nats. A difference counts in standard
/// deviations: of the noise, and of a place that is off by a cell where colours change.
fn hiding(colours: &[Vec<Vec3>], common: &[Vec3], grid: &PlanGrid) -> Vec<Vec<f32>> {
    let table = HidingTable::fitted();
    let difference =
        |view: &[Vec3], k: usize| f64::from((view[k] - common[k]).length()) / 3f64.sqrt();
    let all = colours
        .iter()
        .flat_map(|view| (0..common.len()).map(|k| difference(view, k)));
    let mut all: Vec<f64> = all.filter(|d| d.is_finite()).collect();
    let noise = larger(
        SIGMA_OVER_MEDIAN * median(&mut all).unwrap_or(0.0),
        LEAST_NOISE,
    );
    let changes = changes(common, grid);
    let of_cell = |view: &[Vec3], k: usize| {
        let sigma = (noise * noise + changes[k]).sqrt();
        match difference(view, k) / sigma {
            t if t.is_finite() => table.nats(t) as f32,
            _ => 0.0,
        }
    };
    (colours.iter())
        .map(|view| (0..common.len()).map(|k| of_cell(view, k)).collect())
        .collect()
}

/// Square of the change of the common colours from cell to cell.
fn changes(common: &[Vec3], grid: &PlanGrid) -> Vec<f64> {
    let PlanGrid { width, height, .. } = *grid;
    let grey = Gray::from_fn(width, height, |x, y| {
        let colour = common[y * width + x];
        if colour.is_nan() {
            0.0
        } else {
            colour.element_sum() / 3.0
        }
    });
    let blurred = gaussian_blur(&grey, GRADIENT_BLUR);
    let at = |x: usize, y: usize| f64::from(blurred.get(x.min(width - 1), y.min(height - 1)));
    let change = |k: usize| {
        let (x, y) = (k % width, k / width);
        let across = 0.5 * (at(x + 1, y) - at(x.saturating_sub(1), y));
        let down = 0.5 * (at(x, y + 1) - at(x, y.saturating_sub(1)));
        across * across + down * down
    };
    (0..width * height).map(change).collect()
}
