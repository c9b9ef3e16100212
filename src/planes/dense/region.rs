//! Patches that lie in one plane, joined to regions.
//!
//! A region grows from the patch on which the views agree best, over neighbours whose height and
//! gradient are those of its plane within what matching can tell. The plane is fitted to all its
//! patches again whenever their number has doubled.

use nalgebra::{Matrix3, Point2, Vector2, Vector3};

use super::patch::{Patch, gradient_of};
use super::patch_match::PatchGrid;
use crate::base::evidence::WindowEvidenceTable;
use crate::base::geometry::Plane;

/// How far a patch may lie off its region's plane, in heights that move the images by one pixel
/// against each other: what matching can tell.
const OFF_PIXELS: f64 = 0.5;
/// By how much its gradient may differ from the plane's: the height at the border of the window
/// differs by no more than that then.
const TILTED: f64 = 0.35;
/// Fewest patches of a region.
pub(super) const FEWEST: usize = 4;

/// Patches in one plane.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Region {
    /// Cells of the grid of patches, ascending.
    pub cells: Vec<usize>,
    pub plane: Plane,
    /// Covariance of the height at the middle, metres squared, and of the gradient: 3 x 3.
    pub covariance: Matrix3<f64>,
    /// Root mean square of the patches' heights above and below the plane, metres.
    pub rms_m: f64,
}

/// What the views say of a patch's own plane, nats.
fn nats(patch: &Patch) -> f64 {
    WindowEvidenceTable::fitted().nats_of(patch.weight, patch.correlation)
}

/// The regions of patches that the views agree on, those that agree best first.
pub(super) fn grow_regions(found: &PatchGrid, z_per_pixel: f64) -> Vec<Region> {
    let agreed = |patch: &Patch| nats(patch) > 0.0;
    let mut free: Vec<bool> = (found.patches.iter())
        .map(|patch| patch.as_ref().is_some_and(agreed))
        .collect();
    let mut seeds: Vec<(f64, usize)> = (found.patches.iter().enumerate())
        .filter_map(|(k, patch)| patch.as_ref().map(|p| (nats(p), k)))
        .collect();
    seeds.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut regions = Vec::new();
    for (_, seed) in seeds {
        if !free[seed] {
            continue;
        }
        let region = grown_from(found, seed, &free, z_per_pixel);
        free[seed] = false;
        if region.len() < FEWEST {
            continue;
        }
        region.iter().for_each(|&k| free[k] = false);
        let patches = || region.iter().filter_map(|&k| found.patches[k].as_ref());
        if let Some((plane, covariance, rms_m)) = fitted(patches(), z_per_pixel) {
            regions.push(Region {
                cells: region,
                plane,
                covariance,
                rms_m,
            });
        }
    }
    regions
}

/// The free cells around a seed whose patches lie in one plane with it, ascending.
fn grown_from(found: &PatchGrid, seed: usize, free: &[bool], z_per_pixel: f64) -> Vec<usize> {
    let Some(first) = &found.patches[seed] else {
        return Vec::new();
    };
    let mut plane = first.plane();
    let mut cells = vec![seed];
    loop {
        let size = cells.len();
        cells = connected(found, seed, free, &plane, z_per_pixel);
        let patches = cells.iter().filter_map(|&k| found.patches[k].as_ref());
        let Some((better, ..)) = fitted(patches, z_per_pixel) else {
            return cells;
        };
        plane = better;
        if cells.len() < 2 * size {
            return cells;
        }
    }
}

/// The free cells that are connected with a seed by patches in a plane, ascending.
fn connected(
    found: &PatchGrid,
    seed: usize,
    free: &[bool],
    plane: &Plane,
    z_per_pixel: f64,
) -> Vec<usize> {
    let gradient = gradient_of(plane);
    let lies_in = |patch: &Patch| {
        let off = patch.z - plane.z_at(patch.middle.x, patch.middle.y);
        off.abs() <= OFF_PIXELS * z_per_pixel && (patch.gradient - gradient).norm() <= TILTED
    };
    let mut inside = std::collections::BTreeSet::from([seed]);
    let mut front = vec![seed];
    while let Some(cell) = front.pop() {
        for (k, patch) in found.around(cell) {
            if free[k] && !inside.contains(&k) && lies_in(patch) {
                inside.insert(k);
                front.push(k);
            }
        }
    }
    inside.into_iter().collect()
}

/// The plane of least squares of the heights of patches, the covariance of its height and gradient
/// at their middle, and the root mean square of what is left; `None` where they span none.
pub(super) fn fitted<'p>(
    patches: impl Iterator<Item = &'p Patch> + Clone,
    z_per_pixel: f64,
) -> Option<(Plane, Matrix3<f64>, f64)> {
    let count = patches.clone().count();
    let middle = patches
        .clone()
        .map(|p| p.middle.coords)
        .sum::<Vector2<f64>>()
        / count as f64;
    let row = |p: &Patch| Vector3::new(1.0, p.middle.x - middle.x, p.middle.y - middle.y);
    let normal =
        (patches.clone()).fold(Matrix3::zeros(), |sum, p| sum + row(p) * row(p).transpose());
    let right = patches
        .clone()
        .fold(Vector3::zeros(), |sum, p| sum + row(p) * p.z);
    if count <= 3 {
        return None;
    }
    let inverse = normal.try_inverse()?;
    let solved = inverse * right;
    let off = patches.map(|p| p.z - row(p).dot(&solved));
    let squares: f64 = off.map(|off| off * off).sum();
    let rms = (squares / count as f64).sqrt();
    // Windows of neighbouring patches overlap: no less than matching can tell of one.
    let least = 0.1 * z_per_pixel;
    let variance = (squares / (count - 3) as f64).max(least * least);
    let plane = super::patch::plane_through(
        &Point2::from(middle),
        solved[0],
        &Vector2::new(solved[1], solved[2]),
    );
    Some((plane, inverse * variance, rms))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planes::photoconsistency::PlanGrid;
    use crate::roofs::testing::uniform;

    /// Patches on two slopes that meet at x = 0, with errors of so many metres.
    fn two_slopes(error_m: f64) -> PatchGrid {
        let grid = PlanGrid::covering(Point2::new(-8.0, -5.0), Point2::new(8.0, 5.0), 1.0);
        let mut next = uniform(7);
        let patch = |k: usize| {
            let middle = grid.center(k % grid.width, k / grid.width);
            let off = error_m * (2.0 * next() - 1.0);
            Some(Patch {
                middle,
                z: 9.0 - 0.5 * middle.x.abs() + off,
                gradient: Vector2::new(-0.5 * middle.x.signum(), 0.0),
                correlation: 0.9,
                weight: 0.95,
            })
        };
        PatchGrid {
            grid,
            patches: (0..grid.width * grid.height).map(patch).collect(),
            views: vec![Vec::new(); grid.width * grid.height],
        }
    }

    #[test]
    fn two_slopes_are_two_regions() {
        let regions = grow_regions(&two_slopes(0.05), 0.4);
        assert_eq!(regions.len(), 2);
        for region in &regions {
            assert_eq!(region.cells.len(), 80);
            let gradient = gradient_of(&region.plane);
            assert!((gradient.x.abs() - 0.5).abs() < 0.01 && gradient.y.abs() < 0.01);
            assert!((region.plane.z_at(0.0, 0.0) - 9.0).abs() < 0.05);
            assert!(region.rms_m < 0.05);
        }
    }

    #[test]
    fn the_covariance_follows_the_errors_of_the_patches() {
        let sigma = |error_m: f64| {
            let found = two_slopes(error_m);
            let left = found.patches.iter().flatten().filter(|p| p.middle.x < 0.0);
            let (_, covariance, rms) = fitted(left, 1e-6).unwrap();
            assert!(
                (rms - error_m / 3.0f64.sqrt()).abs() < 0.1 * error_m,
                "uniform errors"
            );
            covariance[(0, 0)].sqrt()
        };
        // The mean of 80 patches.
        assert!((sigma(0.3) - 0.3 / 3.0f64.sqrt() / 80.0f64.sqrt()).abs() < 0.003);
        assert!((sigma(0.6) / sigma(0.3) - 2.0).abs() < 1e-6);
        assert!(fitted([].iter(), 0.4).is_none());
    }
}
