//! Slanted patches by PatchMatch (Barnes et al. 2009; with slanted windows Bleyer, Rhemann and
//! Rother 2011), in object space: patches stand on a grid in plan, and all views are compared on
//! the plane of each.
//!
//! A patch starts at the height at which the views agree best on a level plane. Then, in turns of
//! the two colours of a checkerboard, each tries the planes of its eight neighbours and its own
//! plane moved and tilted by steps that are halved from turn to turn, and keeps the best. The
//! steps point in directions that follow from the place of the patch and the turn, so that every
//! run finds the same.

use std::f64::consts::TAU;

use nalgebra::{Point2, Point3, Vector2};

use super::patch::{Patch, plane_through};
use crate::base::execution::{Sharded, sharded_map};
use crate::base::geometry::Plane;
use crate::base::ids::ViewId;
use crate::base::math::{cos, sin};
use crate::planes::photoconsistency::{Agreement, PlanGrid, WindowMatcher};

/// Rows of patches that are matched at once, ...
const BAND: usize = 24;
/// ... with so many more on both sides, whose planes they may take over.
const MARGIN: usize = 4;
/// Turns of both colours.
const TURNS: usize = 3;
/// Own planes that a patch tries in each of its turns.
const TRIALS: usize = 4;
/// First change of the height, in heights that move the images by one pixel against each other.
const FIRST_LIFT: f64 = 1.0;
/// First change of the gradient.
const FIRST_TILT: f64 = 0.5;
/// Roofs are less steep than this rise per metre (65 degrees).
pub(super) const STEEPEST: f64 = 2.1;

/// Patches on a grid; `None` where fewer than two views see the place.
pub(super) struct PatchGrid {
    pub grid: PlanGrid,
    pub patches: Vec<Option<Patch>>,
    /// The views in which each is compared.
    pub views: Vec<Vec<ViewId>>,
}

impl PatchGrid {
    /// The patches around that of a cell that are there, with their cells.
    pub(super) fn around(&self, cell: usize) -> impl Iterator<Item = (usize, &Patch)> {
        let cells = around(self.grid.width, self.grid.height, cell);
        cells.filter_map(|k| self.patches[k].as_ref().map(|patch| (k, patch)))
    }
}

/// Matches patches from heights on a grid; `None` where no height is known.
pub(super) fn match_patches(
    matcher: &WindowMatcher,
    grid: PlanGrid,
    heights: &[Option<f64>],
    z_per_pixel: f64,
) -> Sharded<PatchGrid> {
    let rows: Vec<usize> = (0..grid.height).collect();
    let bands: Vec<&[usize]> = rows.chunks(BAND).collect();
    let of_bands = sharded_map("patches", &bands, 0.4..0.9, |_, band| {
        let first = band[0].saturating_sub(MARGIN);
        let end = (band[0] + band.len() + MARGIN).min(grid.height);
        let wide = Band {
            matcher,
            grid: &grid,
            first: first * grid.width,
            z_per_pixel,
        };
        let matched = wide.matched(&heights[first * grid.width..end * grid.width]);
        let from = (band[0] - first) * grid.width;
        matched[from..from + band.len() * grid.width].to_vec()
    })?;
    let patches = of_bands.concat();
    let views = patches.iter().map(|patch| {
        let views = |p: &Patch| matcher.views_of(&Point3::new(p.middle.x, p.middle.y, p.z));
        patch.as_ref().map_or_else(Vec::new, views)
    });
    Ok(PatchGrid {
        grid,
        views: views.collect(),
        patches,
    })
}

/// Some rows of the grid, from a cell on.
struct Band<'a> {
    matcher: &'a WindowMatcher<'a>,
    grid: &'a PlanGrid,
    first: usize,
    z_per_pixel: f64,
}

impl Band<'_> {
    fn matched(&self, heights: &[Option<f64>]) -> Vec<Option<Patch>> {
        let searches: Vec<Option<Search>> = (heights.iter().enumerate())
            .map(|(k, z)| {
                let cell = self.first + k;
                let middle = self
                    .grid
                    .center(cell % self.grid.width, cell / self.grid.width);
                z.map(|z| Search {
                    matcher: self.matcher,
                    views: self.matcher.views_of(&Point3::new(middle.x, middle.y, z)),
                    middle,
                    z_per_pixel: self.z_per_pixel,
                })
            })
            .collect();
        let level = |(search, z): (&Option<Search>, &Option<f64>)| {
            search.as_ref()?.patch((*z)?, Vector2::zeros())
        };
        let mut patches: Vec<Option<Patch>> = searches.iter().zip(heights).map(level).collect();
        let known = |patch: &Option<Patch>| patch.iter().map(|p| (p.z, p.gradient)).collect();
        let mut tried: Vec<Vec<TriedPlane>> = patches.iter().map(known).collect();
        for turn in 0..2 * TURNS {
            for k in 0..patches.len() {
                let cell = self.first + k;
                if (cell % self.grid.width + cell / self.grid.width) % 2 != turn % 2 {
                    continue;
                }
                let (Some(search), Some(patch)) = (&searches[k], patches[k]) else {
                    continue;
                };
                let beside = around(self.grid.width, patches.len() / self.grid.width, k);
                let others: Vec<Patch> = beside.filter_map(|k| patches[k]).collect();
                patches[k] = Some(search.improved(patch, &others, &mut tried[k], turn, cell));
            }
        }
        patches
    }
}

/// The cells around another one of a grid.
fn around(width: usize, height: usize, cell: usize) -> impl Iterator<Item = usize> {
    let (w, h) = (width as isize, height as isize);
    let (c, r) = (cell as isize % w, cell as isize / w);
    let offsets = (-1..=1).flat_map(|dr| (-1..=1).map(move |dc| (dc, dr)));
    let beside = offsets.filter(|offset| *offset != (0, 0));
    beside.filter_map(move |(dc, dr)| {
        let (c, r) = (c + dc, r + dr);
        (c >= 0 && r >= 0 && c < w && r < h).then_some((r * w + c) as usize)
    })
}

/// Height and gradient of a plane that was compared at a place.
type TriedPlane = (f64, Vector2<f64>);

/// Heights and gradients that differ by less are those of one plane.
const SAME_PLANE: f64 = 1e-9;

/// The search at one place.
struct Search<'a> {
    matcher: &'a WindowMatcher<'a>,
    views: Vec<ViewId>,
    middle: Point2<f64>,
    z_per_pixel: f64,
}

impl Search<'_> {
    fn agreement(&self, plane: &Plane) -> Option<Agreement> {
        self.matcher.agreement(&self.views, plane, &self.middle)
    }

    /// The patch of a height and a gradient here.
    fn patch(&self, z: f64, gradient: Vector2<f64>) -> Option<Patch> {
        let found = self.agreement(&plane_through(&self.middle, z, &gradient))?;
        Some(Patch {
            middle: self.middle,
            z,
            gradient,
            correlation: found.correlation,
            weight: found.weight,
        })
    }

    /// The best of a patch, the planes of others here, and its own plane moved and tilted; without
    /// those that were `tried` here before.
    fn improved(
        &self,
        patch: Patch,
        others: &[Patch],
        tried: &mut Vec<TriedPlane>,
        turn: usize,
        cell: usize,
    ) -> Patch {
        let mut best = patch;
        let mut keep_better = |z: f64, gradient: Vector2<f64>, best: &mut Patch| {
            let is_known = |&(height, slope): &TriedPlane| {
                (z - height).abs() < SAME_PLANE && (gradient - slope).amax() < SAME_PLANE
            };
            if gradient.norm() > STEEPEST || tried.iter().any(is_known) {
                return;
            }
            tried.push((z, gradient));
            if let Some(tried) = self.patch(z, gradient)
                && tried.correlation > best.correlation
            {
                *best = tried;
            }
        };
        for other in others {
            keep_better(other.z_at(&self.middle), other.gradient, &mut best);
        }
        for trial in 0..TRIALS {
            // Both colours have had a turn before the steps are halved.
            let scale = 1.0 / (1u32 << (turn / 2)) as f64;
            let [lift, angle, tilt] = [0, 1, 2].map(|i| scattered([turn, trial, cell, i]));
            let (s, c) = (sin(TAU * angle), cos(TAU * angle));
            let z = best.z + scale * FIRST_LIFT * self.z_per_pixel * (2.0 * lift - 1.0);
            let gradient = best.gradient + Vector2::new(c, s) * (scale * FIRST_TILT * tilt);
            keep_better(z, gradient, &mut best);
        }
        best
    }
}

/// A number from 0 to 1 that follows from others without a pattern (SplitMix64, Steele et al.
/// 2014).
fn scattered(from: [usize; 4]) -> f64 {
    let mix = |state: u64, next: usize| {
        let z = (state ^ next as u64).wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    };
    (from.into_iter().fold(0, mix) >> 11) as f64 / (1u64 << 53) as f64
}
