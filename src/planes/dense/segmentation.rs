//! The planes of regions compete for the patches (PEaRL: Isack and Boykov 2012).
//!
//! Regions that grow from one patch break where a patch is wrong. Here every plane is weighed at
//! every patch near it by what the views say of it there, and one labelling over the grid gives
//! each patch a plane or none, as the least of
//!
//! ```text
//! E(l) = - sum_patches nats(views | plane l) + BORDER x number of neighbours with different planes
//! ```
//!
//! Then each plane is fitted to its patches again, by their heights and by the views themselves.

use nalgebra::{Point2, Vector2};

use super::patch::{gradient_of, plane_through};
use super::patch_match::PatchGrid;
use super::region::{FEWEST, Region, fitted, grow_regions};
use crate::base::evidence::WindowEvidenceTable;
use crate::base::geometry::{Plane, bounds};
use crate::base::labelling::{Energy, Labelling, NO_PLANE, PairwiseCosts};
use crate::planes::photoconsistency::WindowMatcher;

/// What it costs that two neighbours have different planes, nats.
const BORDER: f64 = 1.0;
/// How far beyond its patches a plane is weighed, in patches.
const REACH: usize = 5;
/// Labellings, each on the planes of the one before.
const ROUNDS: usize = 2;
/// Steps of the search for the plane on which the views agree best are halved so often.
const HALVINGS: usize = 4;

/// The regions of the patches.
pub(super) fn segmented(
    found: &PatchGrid,
    matcher: &WindowMatcher,
    z_per_pixel: f64,
) -> Vec<Region> {
    let mut regions = grow_regions(found, z_per_pixel);
    for _ in 0..ROUNDS {
        let labels = labelled(found, matcher, &regions);
        let parts = connected_parts(found, &labels);
        let fit = crate::base::execution::map(&parts, |_, (label, cells)| {
            let start = &regions[*label as usize].plane;
            let plane = agreed(found, matcher, cells, start, z_per_pixel);
            region(found, cells, plane, z_per_pixel)
        });
        regions = fit.into_iter().flatten().collect();
    }
    regions
}

/// Every neighbour of another plane costs the same.
struct Borders;

impl PairwiseCosts for Borders {
    fn cost(&self, _: usize, _: u32, _: u32) -> f64 {
        BORDER
    }

    // All edges cost the same.
    fn reorder(&mut self, _: &[usize]) {}

    fn upper_bound(&self, _: usize) -> f64 {
        BORDER
    }
}

/// What the views say of a plane at a cell, nats.
fn nats_at(found: &PatchGrid, matcher: &WindowMatcher, plane: &Plane, cell: usize) -> f64 {
    let grid = &found.grid;
    let middle = grid.center(cell % grid.width, cell / grid.width);
    let agreement = matcher.agreement(&found.views[cell], plane, &middle);
    agreement.map_or(0.0, |a| {
        WindowEvidenceTable::fitted().nats_of(a.weight, a.correlation)
    })
}

/// The plane of each cell, or [`NO_PLANE`].
fn labelled(found: &PatchGrid, matcher: &WindowMatcher, regions: &[Region]) -> Vec<u32> {
    let (width, height) = (found.grid.width, found.grid.height);
    let weighed = crate::base::execution::map(regions, |_, region| {
        let places = region
            .cells
            .iter()
            .map(|k| Point2::new(k % width, k / width));
        let [low, high] = bounds(places.map(|p| p.cast::<f64>()));
        let span = |low: f64, high: f64, size: usize| {
            (low as usize).saturating_sub(REACH)..(high as usize + REACH + 1).min(size)
        };
        let rows = span(low.y, high.y, height);
        let columns = || span(low.x, high.x, width);
        let cells = rows.flat_map(|row| columns().map(move |column| row * width + column));
        let there = cells.filter(|&k| found.patches[k].is_some());
        let nats = there.map(|k| (k, nats_at(found, matcher, &region.plane, k)));
        nats.collect::<Vec<(usize, f64)>>()
    });
    let mut unary = vec![Vec::new(); width * height];
    for (label, cells) in weighed.into_iter().enumerate() {
        for (cell, nats) in cells {
            unary[cell].push((label as u32, -nats));
        }
    }
    let across = (0..width * height).filter(|k| k % width + 1 < width);
    let down = 0..width * (height - 1);
    let edges = across
        .map(|k| [k, k + 1])
        .chain(down.map(|k| [k, k + width]));
    let energy = Energy {
        unary,
        edges: edges.collect(),
        borders: Borders,
    };
    let mut labelling = Labelling::new(energy, regions.len() as u32);
    labelling.minimise();
    labelling.labels()
}

/// Connected cells of one plane, with the plane: parts with enough cells.
fn connected_parts(found: &PatchGrid, labels: &[u32]) -> Vec<(u32, Vec<usize>)> {
    let mut free: Vec<bool> = labels.iter().map(|label| *label != NO_PLANE).collect();
    let mut parts = Vec::new();
    for start in 0..labels.len() {
        if !free[start] {
            continue;
        }
        free[start] = false;
        let (mut cells, mut front) = (vec![start], vec![start]);
        while let Some(cell) = front.pop() {
            for (k, _) in found.around(cell) {
                if free[k] && labels[k] == labels[start] {
                    free[k] = false;
                    cells.push(k);
                    front.push(k);
                }
            }
        }
        if cells.len() >= FEWEST {
            cells.sort_unstable();
            parts.push((labels[start], cells));
        }
    }
    parts
}

/// The plane near another on which the views agree best over some cells: a search along its height
/// and its gradient, by steps from half of what moves the images by a pixel at the region's border.
fn agreed(
    found: &PatchGrid,
    matcher: &WindowMatcher,
    cells: &[usize],
    start: &Plane,
    z_per_pixel: f64,
) -> Plane {
    // Assumption: so many, spread evenly, say where the plane is.
    const MOST_CELLS: usize = 24;
    let every = cells.len().div_ceil(MOST_CELLS);
    let cells: Vec<usize> = cells.iter().copied().step_by(every).collect();
    let at = |k: usize| {
        found
            .grid
            .center(k % found.grid.width, k / found.grid.width)
    };
    let middle = cells.iter().map(|&k| at(k).coords).sum::<Vector2<f64>>() / cells.len() as f64;
    let middle = Point2::from(middle);
    let radius = cells
        .iter()
        .map(|&k| (at(k) - middle).norm())
        .fold(found.grid.step, f64::max);
    let agreement = |plane: &Plane| -> f64 {
        let windows = cells.iter().filter_map(|&k| {
            let agreement = matcher.agreement(&found.views[k], plane, &at(k))?;
            Some(f64::from(agreement.weight * agreement.correlation))
        });
        windows.sum()
    };
    let mut best = (
        agreement(start),
        start.z_at(middle.x, middle.y),
        gradient_of(start),
    );
    let mut step = 0.5 * z_per_pixel;
    for _ in 0..HALVINGS {
        for (lift, x, y) in [
            (1.0, 0.0, 0.0),
            (-1.0, 0.0, 0.0),
            (0.0, 1.0, 0.0),
            (0.0, -1.0, 0.0),
            (0.0, 0.0, 1.0),
            (0.0, 0.0, -1.0),
        ] {
            let z = best.1 + lift * step;
            let gradient = best.2 + Vector2::new(x, y) * (step / radius);
            let found = agreement(&plane_through(&middle, z, &gradient));
            if found > best.0 {
                best = (found, z, gradient);
            }
        }
        step *= 0.5;
    }
    plane_through(&middle, best.1, &best.2)
}

/// The region of a plane over some cells; `None` where their patches say nothing of a plane.
fn region(found: &PatchGrid, cells: &[usize], plane: Plane, z_per_pixel: f64) -> Option<Region> {
    let patches = cells.iter().filter_map(|&k| found.patches[k].as_ref());
    let (_, covariance, rms_m) = fitted(patches, z_per_pixel)?;
    Some(Region {
        cells: cells.to_vec(),
        plane,
        covariance,
        rms_m,
    })
}
