//! Stated positions beside those of the block, and the similarity between them: in space where
//! heights are stated, else in plan about a vertical that something else gives.

use nalgebra::{Point3, Rotation3, Vector3};

use super::stated::{StatedPose, spread};
use crate::base::least_squares::Loss;
use crate::base::math;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::similarity::{FEWEST_POINTS, Similarity};

/// Standard deviation of a position where none is stated, metres: a consumer receiver.
pub(in super::super) const RECEIVER_SIGMA_M: f64 = 2.0;

/// The block's places of photographs, and the stated ones.
pub(super) struct Places {
    /// Numbers of the photographs.
    photos: Vec<usize>,
    pub from: Vec<Point3<f64>>,
    pub to: Vec<Point3<f64>>,
    /// Those whose heights are stated.
    pub known: Vec<usize>,
    /// Standard deviations as multiples of [`Self::sigma_m`].
    factors: Vec<f64>,
    /// The middle standard deviation, metres.
    pub sigma_m: f64,
    /// The turn that makes z of the block vertical, where only a turn about it is left.
    upright: Option<Rotation3<f64>>,
}

/// A similarity to positions.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// Photographs whose positions agree.
    pub agreeing: usize,
    /// Those whose positions the others contradict.
    pub contradicted: Vec<usize>,
    /// Photographs with a stated position, and with a height that counts.
    pub stated: [usize; 2],
    /// Root mean square distance of the agreeing ones, in plan and in height, metres.
    pub rms_m: [f64; 2],
    /// Is the vertical or the turn about the line of flight from angles or the plane of the points?
    pub is_levelled: bool,
    /// How far they spread along their main axis, metres.
    pub spread_m: f64,
}

/// Positions that differ by no more than their noise, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TooNear {
    pub stated: usize,
    pub noise_m: f64,
}

impl Places {
    pub(super) fn of(
        block: &Block,
        stated: &[StatedPose],
        upright: Option<Rotation3<f64>>,
    ) -> Self {
        let (mut from, mut to, mut known, mut sigmas) = (vec![], vec![], vec![], vec![]);
        let mut photos = Vec::new();
        for (i, (photo, stated)) in block.photos.iter().zip(stated).enumerate() {
            let (Some(pose), Some(position)) = (&photo.pose, stated.position) else {
                continue;
            };
            if !stated.lacks_height {
                known.push(from.len());
            }
            photos.push(i);
            from.push(upright.map_or(pose.center, |turn| turn * pose.center));
            to.push(position);
            sigmas.push(stated.sigma_m.unwrap_or(RECEIVER_SIGMA_M));
        }
        let sigma_m = math::median(&mut sigmas.clone()).unwrap_or(RECEIVER_SIGMA_M);
        Self {
            photos,
            from,
            to,
            known,
            factors: sigmas.iter().map(|s| s / sigma_m).collect(),
            sigma_m,
            upright,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.from.len()
    }

    fn has_height(&self, i: usize) -> bool {
        self.known.binary_search(&i).is_ok()
    }

    /// A placed photograph minus its stated position; without height where none counts.
    fn difference(&self, s: &Similarity, i: usize) -> Vector3<f64> {
        let d = s.point(&self.from[i]) - self.to[i];
        if self.has_height(i) {
            d
        } else {
            Vector3::new(d.x, d.y, 0.0)
        }
    }

    /// Distances in the middle standard deviation, times that in metres.
    fn distances(&self, s: &Similarity) -> Vec<f64> {
        (0..self.count())
            .map(|i| self.difference(s, i).norm() / self.factors[i])
            .collect()
    }

    /// The similarity of some positions with weights; heights that do not count are as `last` has
    /// them.
    fn fitted(
        &self,
        of: &[usize],
        weights: &[f64],
        last: Option<&Similarity>,
    ) -> Option<Similarity> {
        let from: Vec<Point3<f64>> = of.iter().map(|&i| self.from[i]).collect();
        let to: Vec<Point3<f64>> = (of.iter())
            .map(|&i| match last {
                Some(s) if !self.has_height(i) => {
                    Point3::new(self.to[i].x, self.to[i].y, s.point(&self.from[i]).z)
                }
                _ => self.to[i],
            })
            .collect();
        if self.upright.is_none() {
            return Similarity::between(&from, &to, weights);
        }
        let mut found = Similarity::in_plan(&from, &to, weights)?;
        // The height is the middle of those that are stated.
        let off = of.iter().filter(|&&i| self.has_height(i));
        let off = off.map(|&i| self.to[i].z - found.point(&self.from[i]).z);
        found.shift.z += math::median(&mut off.collect::<Vec<f64>>()).unwrap_or(0.0);
        Some(found)
    }

    /// Similarity from random triples by the least median of distances (Rousseeuw 1984), then
    /// weighted anew while it settles; with the last weights.
    fn robust(&self) -> Option<(Similarity, Vec<f64>)> {
        let all: Vec<usize> = (0..self.count()).collect();
        let sampled = if self.upright.is_some() {
            &all
        } else {
            &self.known
        };
        let median = |s: &Similarity| math::median(&mut self.distances(s)).unwrap_or(f64::INFINITY);
        let start = self.fitted(sampled, &vec![1.0; sampled.len()], None)?;
        let of_triple = |triple: [usize; 3]| {
            let sample = triple.map(|i| sampled[i]);
            // Triples near one line say nothing of the turn about it.
            let across = spread(&sample.map(|i| self.to[i])).lengths[1];
            let is_wide = self.upright.is_some() || across >= self.sigma_m;
            is_wide
                .then(|| self.fitted(&sample, &[1.0; 3], None))
                .flatten()
        };
        let mut best = Similarity::of_triples(start, 7, sampled.len(), of_triple, median);
        let mut weights = vec![1.0; self.count()];
        for _ in 0..20 {
            let median = math::median(&mut self.distances(&best))?;
            let scale = 2.0 * median.max(0.1 * self.sigma_m);
            weights = (self.distances(&best).iter().zip(&self.factors))
                .map(|(d, factor)| Loss::Cauchy(scale).weight(d * d) / (factor * factor))
                .collect();
            best = self.fitted(&all, &weights, Some(&best))?;
        }
        let weights = weights.iter().zip(&self.factors);
        Some((
            best,
            weights.map(|(w, factor)| w * factor * factor).collect(),
        ))
    }

    /// The similarity in space, where enough heights are stated across the line of flight too.
    pub(super) fn in_space(&self) -> Option<(Similarity, Found, Vector3<f64>)> {
        let is_wide = self.known.len() >= FEWEST_POINTS
            && spread(&self.with_heights()).lengths[1] >= 2.0 * self.sigma_m;
        let is_whole = self.known.len() == self.count();
        (is_whole || is_wide).then(|| self.found().ok()).flatten()
    }

    pub(super) fn with_heights(&self) -> Vec<Point3<f64>> {
        self.known.iter().map(|&i| self.to[i]).collect()
    }

    /// The similarity from the block, what agrees with it, and along which line; why not.
    pub(super) fn found(&self) -> Result<(Similarity, Found, Vector3<f64>), TooNear> {
        let stated = self.count();
        let (mut similarity, weights) = self.robust().ok_or(TooNear {
            stated,
            noise_m: self.sigma_m,
        })?;
        let agreeing: Vec<usize> = (0..stated).filter(|&i| weights[i] > 0.25).collect();
        let squares = agreeing.iter().map(|&i| {
            let d = self.difference(&similarity, i);
            [d.x * d.x + d.y * d.y, d.z * d.z]
        });
        let [plan, height] = squares.fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        let heights = agreeing.iter().filter(|&&i| self.has_height(i)).count();
        let rms = |sum: f64, count: usize| (sum / count.max(1) as f64).sqrt();
        let rms_m = [rms(plan, agreeing.len()), rms(height, heights)];
        let spread = spread(&agreeing.iter().map(|&i| self.to[i]).collect::<Vec<_>>());
        let noise_m = self.sigma_m.max(match self.upright {
            Some(_) => rms_m[0],
            None => math::hypot(rms_m[0], rms_m[1]),
        });
        if agreeing.len() < FEWEST_POINTS || spread.lengths[0] < 2.0 * noise_m {
            return Err(TooNear { stated, noise_m });
        }
        if let Some(turn) = self.upright {
            similarity.rotation *= turn;
        }
        let found = Found {
            agreeing: agreeing.len(),
            contradicted: (0..stated)
                .filter(|i| !agreeing.contains(i))
                .map(|i| self.photos[i])
                .collect(),
            stated: [stated, self.known.len()],
            rms_m,
            is_levelled: self.upright.is_some() || spread.lengths[1] < 2.0 * noise_m,
            spread_m: spread.lengths[0],
        };
        Ok((similarity, found, spread.axis))
    }
}

/// The similarity in plan of a block whose vertical a rotation gives.
pub(super) fn upright_fit(
    block: &Block,
    stated: &[StatedPose],
    rotation: &Rotation3<f64>,
) -> Option<(Similarity, Found)> {
    let places = Places::of(block, stated, Some(*rotation));
    if places.count() < FEWEST_POINTS {
        return None;
    }
    let (similarity, found, _) = places.found().ok()?;
    Some((similarity, found))
}
