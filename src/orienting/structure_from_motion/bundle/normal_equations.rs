//! The normal equations of the observations, points eliminated.
//!
//! With the Jacobians A by the unknowns of photographs and cameras and B by a point, V = B^T B and
//! W = A^T B, each point leaves `A^T A - W V^-1 W^T` in the reduced system (Triggs et al. 2000,
//! 6.1).

use nalgebra::{Matrix2x3, Matrix2x5, Matrix2x6, Matrix3, Point3, SMatrix, Vector2, Vector3};

use super::options::Prior;
use crate::base::execution::map;
use crate::base::least_squares::{Envelope, Loss, Pattern};
use crate::orienting::structure_from_motion::block::{Block, Observation, Track};
use crate::orienting::structure_from_motion::intrinsics::PARAMETERS;
use crate::orienting::structure_from_motion::resection::linearised;

/// An observation counts for less from two standard deviations on.
pub(super) const LOSS: Loss = Loss::Cauchy(2.0);

/// Parts of the points: more than threads, and each has a matrix of its own.
const SHARDS: usize = 8;

/// Cost of an observation behind its camera.
const BEHIND: f64 = 1e6;

type Matrix6x3 = SMatrix<f64, 6, 3>;
type Matrix5x3 = SMatrix<f64, 5, 3>;

/// Which unknown stands where: six of each photograph, then those of each camera.
pub(super) struct Layout {
    /// Registered photographs.
    pub photos: Vec<usize>,
    /// Tracks with a point.
    pub tracks: Vec<usize>,
    slots: Vec<usize>,
    cameras: usize,
}

impl Layout {
    pub(super) fn new(block: &Block) -> Self {
        let photos = block.registered();
        let mut slots = vec![usize::MAX; block.photos.len()];
        for (slot, &photo) in photos.iter().enumerate() {
            slots[photo] = slot;
        }
        let with_point = block.tracks.iter().enumerate();
        let tracks = with_point.filter(|(_, t)| t.point.is_some() && t.used().count() >= 2);
        Self {
            tracks: tracks.map(|(i, _)| i).collect(),
            photos,
            slots,
            cameras: block.cameras.len(),
        }
    }

    /// First unknown of a camera.
    pub(super) fn of_camera(&self, camera: usize) -> usize {
        6 * self.photos.len() + PARAMETERS * camera
    }

    /// Number of unknowns without the points.
    pub(super) fn unknowns(&self) -> usize {
        self.of_camera(self.cameras)
    }

    fn shards(&self) -> Vec<&[usize]> {
        let length = self.tracks.len().div_ceil(SHARDS).max(1);
        self.tracks.chunks(length).collect()
    }
}

/// The reduced system: its matrix, and the right-hand side.
pub(super) struct ReducedSystem<'p> {
    pub matrix: Envelope<'p>,
    pub right: Vec<f64>,
}

/// One linearised observation, divided by its standard deviation and weighted.
struct Row {
    slot: usize,
    camera: usize,
    residual: Vector2<f64>,
    by_pose: Matrix2x6<f64>,
    by_camera: Matrix2x5<f64>,
    by_point: Matrix2x3<f64>,
}

fn rows(block: &Block, layout: &Layout, track: &Track) -> Vec<Row> {
    let Some(point) = &track.point else {
        return Vec::new();
    };
    let row = |o: &Observation| {
        let photo = &block.photos[o.photo];
        let (residual, by_pose, by_camera, by_point) = linearised(
            photo.pose.as_ref()?,
            &block.cameras[photo.camera],
            point,
            &photo.keypoints[o.keypoint],
        )?;
        let inverse = 1.0 / block.sigma_px(o);
        let square = residual.norm_squared() * inverse * inverse;
        let scale = inverse * LOSS.weight(square).sqrt();
        Some(Row {
            slot: layout.slots[o.photo],
            camera: photo.camera,
            residual: residual * scale,
            by_pose: by_pose * scale,
            by_camera: by_camera * scale,
            by_point: by_point * scale,
        })
    };
    track.used().filter_map(row).collect()
}

/// V^-1 with damping, and the gradient of the point.
fn point_block(rows: &[Row], damping: f64) -> Option<(Matrix3<f64>, Vector3<f64>)> {
    let (mut v, mut g) = (Matrix3::zeros(), Vector3::zeros());
    for row in rows {
        v += row.by_point.transpose() * row.by_point;
        g += row.by_point.transpose() * row.residual;
    }
    for i in 0..3 {
        v[(i, i)] += damping * v[(i, i)];
    }
    Some((v.try_inverse()?, g))
}

/// The robust sum of squares, with the priors.
pub(super) fn cost(block: &Block, layout: &Layout, priors: &[Prior]) -> f64 {
    let of_shard = |shard: &[usize]| -> f64 {
        let mut sum = 0.0;
        for &track in shard {
            let track = &block.tracks[track];
            let Some(point) = &track.point else { continue };
            for o in track.used() {
                let r = block.residual(o, point);
                sum += if r.is_finite() {
                    LOSS.cost(r * r)
                } else {
                    BEHIND
                };
            }
        }
        sum
    };
    let sums = map(&layout.shards(), |_, shard| of_shard(shard));
    let mut total: f64 = sums.iter().sum();
    for (intrinsics, prior) in block.cameras.iter().zip(priors) {
        let pairs = intrinsics
            .parameters()
            .into_iter()
            .zip(prior.mean.parameters());
        for ((value, mean), sigma) in pairs.zip(prior.sigma) {
            if sigma > 0.0 {
                total += (value - mean) * (value - mean) / (sigma * sigma);
            }
        }
    }
    total
}

/// The reduced system of a block; held parameters keep a step of zero.
pub(super) fn reduced_system<'p>(
    block: &Block,
    layout: &Layout,
    pattern: &'p Pattern,
    priors: &[Prior],
    damping: f64,
) -> ReducedSystem<'p> {
    let parts = map(&layout.shards(), |_, shard| {
        let mut part = Part::new(pattern);
        for &track in *shard {
            let rows = rows(block, layout, &block.tracks[track]);
            part.add(layout, &rows, damping);
        }
        part
    });
    let mut sum = Part::new(pattern);
    for part in parts {
        sum.add_part(&part);
    }
    for (camera, (intrinsics, prior)) in block.cameras.iter().zip(priors).enumerate() {
        let start = layout.of_camera(camera);
        let pairs = intrinsics
            .parameters()
            .into_iter()
            .zip(prior.mean.parameters());
        for (i, ((value, mean), sigma)) in pairs.zip(prior.sigma).enumerate() {
            if sigma > 0.0 {
                let weight = 1.0 / (sigma * sigma);
                sum.matrix[(start + i, start + i)] += weight;
                sum.diagonal[start + i] += weight;
                sum.right[start + i] -= weight * (value - mean);
            } else {
                sum.hold(start + i);
            }
        }
    }
    for (i, diagonal) in sum.diagonal.iter().enumerate() {
        sum.matrix[(i, i)] += damping * diagonal;
    }
    ReducedSystem {
        matrix: sum.matrix,
        right: sum.right,
    }
}

/// The sum over some points.
struct Part<'p> {
    matrix: Envelope<'p>,
    right: Vec<f64>,
    /// Of A^T A alone, which damping multiplies.
    diagonal: Vec<f64>,
}

impl<'p> Part<'p> {
    fn new(pattern: &'p Pattern) -> Self {
        Self {
            matrix: pattern.zeros(),
            right: vec![0.0; pattern.len()],
            diagonal: vec![0.0; pattern.len()],
        }
    }

    fn add_part(&mut self, other: &Self) {
        self.matrix.add(&other.matrix);
        for (mine, theirs) in [
            (&mut self.right, &other.right),
            (&mut self.diagonal, &other.diagonal),
        ] {
            for (a, b) in mine.iter_mut().zip(theirs) {
                *a += b;
            }
        }
    }

    /// Makes an unknown stay what it is.
    fn hold(&mut self, i: usize) {
        for j in 0..self.right.len() {
            self.matrix[(i, j)] = 0.0;
        }
        self.matrix[(i, i)] = 1.0;
        self.right[i] = 0.0;
        self.diagonal[i] = 0.0;
    }

    fn add(&mut self, layout: &Layout, rows: &[Row], damping: f64) {
        let Some((inverse, gradient)) = point_block(rows, damping) else {
            return;
        };
        // W of each photograph, and of each camera the sum.
        let of_photos: Vec<Matrix6x3> = (rows.iter())
            .map(|row| row.by_pose.transpose() * row.by_point)
            .collect();
        let mut of_cameras: Vec<(usize, Matrix5x3)> = Vec::new();
        for row in rows {
            let w = row.by_camera.transpose() * row.by_point;
            match of_cameras
                .iter_mut()
                .find(|(camera, _)| *camera == row.camera)
            {
                Some((_, sum)) => *sum += w,
                None => of_cameras.push((row.camera, w)),
            }
        }
        of_cameras.sort_by_key(|(camera, _)| *camera);
        for (i, row) in rows.iter().enumerate() {
            let (pose, camera) = (6 * row.slot, layout.of_camera(row.camera));
            let own = row.by_pose.transpose() * row.by_pose;
            for k in 0..6 {
                self.diagonal[pose + k] += own[(k, k)];
            }
            let weighted = of_photos[i] * inverse;
            self.matrix
                .add_block(pose, pose, &(own - weighted * of_photos[i].transpose()));
            // Photographs of a track rise, so earlier ones stand to the left.
            for (earlier, w) in rows[..i].iter().zip(&of_photos) {
                self.matrix
                    .add_block(pose, 6 * earlier.slot, &-(weighted * w.transpose()));
            }
            let crossed = row.by_camera.transpose() * row.by_pose;
            self.matrix.add_block(camera, pose, &crossed);
            let own = row.by_camera.transpose() * row.by_camera;
            for k in 0..PARAMETERS {
                self.diagonal[camera + k] += own[(k, k)];
            }
            self.matrix.add_block(camera, camera, &own);
            let right = weighted * gradient - row.by_pose.transpose() * row.residual;
            for k in 0..6 {
                self.right[pose + k] += right[k];
            }
            let right = row.by_camera.transpose() * row.residual;
            for k in 0..PARAMETERS {
                self.right[camera + k] -= right[k];
            }
        }
        for (c, (camera, w)) in of_cameras.iter().enumerate() {
            let start = layout.of_camera(*camera);
            let weighted = w * inverse;
            for (row, of_photo) in rows.iter().zip(&of_photos) {
                self.matrix
                    .add_block(start, 6 * row.slot, &-(weighted * of_photo.transpose()));
            }
            for (earlier, other) in &of_cameras[..=c] {
                let block = -(weighted * other.transpose());
                self.matrix
                    .add_block(start, layout.of_camera(*earlier), &block);
            }
            let right = weighted * gradient;
            for k in 0..PARAMETERS {
                self.right[start + k] += right[k];
            }
        }
    }
}

/// The points after a step of the other unknowns.
pub(super) fn point_steps(
    block: &Block,
    layout: &Layout,
    step: &[f64],
    damping: f64,
) -> Vec<Point3<f64>> {
    let of_shard = |shard: &[usize]| -> Vec<Point3<f64>> {
        let moved = |&track: &usize| {
            let track = &block.tracks[track];
            let point = track.point.unwrap_or_default();
            let rows = rows(block, layout, track);
            let Some((inverse, mut gradient)) = point_block(&rows, damping) else {
                return point;
            };
            for row in &rows {
                let pose = SMatrix::<f64, 6, 1>::from_column_slice(&step[6 * row.slot..][..6]);
                let start = layout.of_camera(row.camera);
                let camera = SMatrix::<f64, 5, 1>::from_column_slice(&step[start..][..PARAMETERS]);
                let moved = row.by_pose * pose + row.by_camera * camera;
                gradient += row.by_point.transpose() * moved;
            }
            point - inverse * gradient
        };
        shard.iter().map(moved).collect()
    };
    map(&layout.shards(), |_, shard| of_shard(shard)).concat()
}
