//! Receivers that state positions late: the lag behind the photographs along the flight, and what
//! positions are worth with it.
//!
//! ```text
//! v_i = (p_i - p_j) / (t_i - t_j)    j: what the same camera took before i; after the first one
//! ```
//!
//! A late position is one of the path that was flown already, from the photograph before. Without
//! times in all headers the order is that of the names, v is a direction, and the lag is metres.
//! Strips that are flown to and fro tell it from a shift; a single strip at one speed does not.

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::places::{Found, RECEIVER_SIGMA_M};
use super::positions::by_positions;
use super::stated::StatedPose;
use super::vertical::AnglesFinding;
use crate::base::least_squares::Loss;
use crate::base::math::{self, SURE_RESIDUAL_SIGMAS};
use crate::orienting::orientation::FrameSigma;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::similarity::Similarity;
use crate::orienting::structure_from_motion::similarity_fit::{Free, KnownOf, Tie, fitted, worth};

/// By how much stated positions are behind the photographs along the flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lag {
    /// Seconds where all headers state a time, else metres; negative where positions are ahead.
    pub lag: f64,
    /// Its standard deviation.
    pub sigma: f64,
    /// "s" or "m".
    pub unit: String,
    /// Is it larger than its noise, and taken out of the positions?
    pub is_applied: bool,
    /// Root mean square distance of the positions as they are stated, in plan and in height,
    /// metres: of those that agree with the lag taken out.
    pub before_m: [f64; 2],
    /// The same with the lag taken out; as before where it was not.
    pub after_m: [f64; 2],
    /// By how much each photograph's position was moved, metres; empty where it was not.
    #[serde(skip)]
    pub(in super::super) moved_m: Vec<Vector3<f64>>,
}

impl Lag {
    /// In words.
    pub fn words(&self) -> String {
        let Self { sigma, unit, .. } = self;
        let size = self.lag.abs();
        let side = if self.lag < 0.0 { "ahead of" } else { "behind" };
        let [[before, _], [after, height]] = [self.before_m, self.after_m];
        match self.is_applied {
            true => format!(
                "the stated positions are {size:.2} +- {sigma:.2} {unit} {side} the photographs along \
                 the flight: that was taken out, and rms {before:.2} m in plan became {after:.2} m \
                 ({height:.2} m in height), which differs from photograph to photograph"
            ),
            false => format!(
                "along the flight the stated positions are {size:.2} +- {sigma:.2} {unit} {side} the \
                 photographs, which is too little to be taken out"
            ),
        }
    }
}

/// Stated positions, and what places a block by them.
#[derive(Clone, Copy)]
pub(super) struct Stated<'a> {
    pub block: &'a Block,
    pub stated: &'a [StatedPose],
    pub similarity: &'a Similarity,
    pub found: &'a Found,
    /// Photographs whose heights count.
    pub heights: usize,
}

impl Stated<'_> {
    /// What places the block without the lag where one is seen, else as it is; what was found of
    /// that, the lag, and what the frame is worth.
    pub(super) fn without_lag(
        &self,
        angles: &AnglesFinding,
    ) -> (Similarity, Found, Option<Lag>, Option<FrameSigma>) {
        let (velocities, unit) = self.velocities();
        let mut lag = self.lag(&velocities, unit);
        if let Some(lag) = lag.as_mut().filter(|lag| lag.is_applied) {
            let (moved_m, stated) = self.moved(&velocities, lag.lag);
            let again = by_positions(self.block, &stated, angles);
            if let Ok((similarity, found, None)) = again
                && found.agreeing >= self.found.agreeing
            {
                let [as_stated, without] = [(self.stated, self.similarity), (&stated, &similarity)]
                    .map(|(stated, similarity)| Stated {
                        stated,
                        similarity,
                        found: &found,
                        ..*self
                    });
                (lag.before_m, lag.after_m) = (as_stated.rms_m(), found.rms_m);
                lag.moved_m = moved_m;
                let sigma = without.worth(Some(&velocities), angles);
                return (similarity, found, Some(lag.clone()), sigma);
            }
            lag.is_applied = false;
        }
        let sigma = self.worth(None, angles);
        (self.similarity.clone(), self.found.clone(), lag, sigma)
    }

    /// By how much each photograph's place moves in a unit of the lag, and that unit.
    fn velocities(&self) -> (Vec<Vector3<f64>>, &'static str) {
        let photos = self.block.photos.iter().enumerate();
        let mut flown: Vec<(usize, usize, Point3<f64>)> = photos
            .filter_map(|(i, photo)| {
                let place = self.similarity.point(&photo.pose.as_ref()?.center);
                Some((photo.camera, i, place))
            })
            .collect();
        let has_times = (flown.iter()).all(|(_, i, _)| self.stated[*i].taken_s.is_some());
        let at = |i: usize| match self.stated[i].taken_s {
            Some(seconds) if has_times => seconds,
            _ => i as f64,
        };
        flown.sort_by(|a, b| a.0.cmp(&b.0).then(at(a.1).total_cmp(&at(b.1))));
        let mut velocities = vec![Vector3::zeros(); self.stated.len()];
        for of_camera in flown.chunk_by(|a, b| a.0 == b.0) {
            for (k, (_, i, place)) in of_camera.iter().enumerate() {
                let is_other = |(_, other, _): &&(usize, usize, Point3<f64>)| at(*other) != at(*i);
                // The first one flies as it goes on.
                let before = of_camera[..k].iter().rev().find(is_other);
                let after = || of_camera[k..].iter().find(is_other);
                if let Some((_, other, from)) = before.or_else(after) {
                    let (path, time) = (place - from, at(*i) - at(*other));
                    velocities[*i] = match has_times {
                        true => path / time,
                        false => path.try_normalize(0.0).unwrap_or_default() * time.signum(),
                    };
                }
            }
        }
        (velocities, if has_times { "s" } else { "m" })
    }

    /// The positions of photographs; those that the others contradict on request only.
    fn ties(&self, velocities: Option<&[Vector3<f64>]>, has_contradicted: bool) -> Vec<Tie> {
        let tie = |(i, stated): (usize, &StatedPose)| {
            let is_kept = has_contradicted || !self.found.contradicted.contains(&i);
            let has_height = self.heights > 0 && !stated.lacks_height;
            Some(Tie {
                from: self.block.photos[i].pose.as_ref()?.center,
                to: stated.position.filter(|_| is_kept)?,
                known: if has_height {
                    KnownOf::All
                } else {
                    KnownOf::Plan
                },
                sigma_m: stated.sigma_m.unwrap_or(RECEIVER_SIGMA_M),
                velocity: velocities.map_or_else(Vector3::zeros, |v| v[i]),
            })
        };
        self.stated.iter().enumerate().filter_map(tie).collect()
    }

    /// The lag by all positions; `None` where the flight does not tell.
    fn lag(&self, velocities: &[Vector3<f64>], unit: &str) -> Option<Lag> {
        let ties = self.ties(Some(velocities), true);
        let free = Free {
            up: !self.found.is_levelled,
            lag: true,
        };
        let (mut similarity, mut lag) = (self.similarity.clone(), 0.0);
        let mut agreeing = Vec::new();
        // The second time the lag is no longer among the residuals.
        for _ in 0..2 {
            let square = |tie: &Tie, (s, lag): (&Similarity, f64)| {
                (tie.off(s, lag) / tie.sigma_m).norm_squared()
            };
            let lengths = ties
                .iter()
                .map(|tie| square(tie, (&similarity, lag)).sqrt());
            let typical = math::median(&mut lengths.collect::<Vec<f64>>())?;
            let loss = Loss::Cauchy(2.0 * typical.max(0.1));
            (similarity, lag) = fitted(&similarity, &ties, free, loss)?;
            let agrees = |tie: &&Tie| loss.weight(square(tie, (&similarity, lag))) > 0.25;
            agreeing = ties.iter().filter(agrees).cloned().collect();
        }
        let sigma = worth(&agreeing, &similarity, lag, free)?.lag;
        Some(Lag {
            lag,
            sigma,
            unit: unit.to_owned(),
            is_applied: lag.abs() > SURE_RESIDUAL_SIGMAS * sigma,
            before_m: self.found.rms_m,
            after_m: self.found.rms_m,
            moved_m: Vec::new(),
        })
    }

    /// By how much a lag moves the positions, and where they are then.
    fn moved(&self, velocities: &[Vector3<f64>], lag: f64) -> (Vec<Vector3<f64>>, Vec<StatedPose>) {
        let moved_m: Vec<Vector3<f64>> = velocities.iter().map(|v| v * lag).collect();
        let stated = self.stated.iter().zip(&moved_m);
        let stated = stated.map(|(stated, moved)| StatedPose {
            position: stated.position.map(|p| p + moved),
            lacks_height: stated.lacks_height || self.heights == 0,
            ..stated.clone()
        });
        let stated = stated.collect();
        (moved_m, stated)
    }

    /// Root mean square distance of the agreeing photographs, in plan and in height, metres.
    fn rms_m(&self) -> [f64; 2] {
        let ties = self.ties(None, false);
        let rms = |square: &dyn Fn(&Vector3<f64>) -> f64, count: usize| {
            let off = ties
                .iter()
                .map(|tie| square(&tie.off(self.similarity, 0.0)));
            (off.sum::<f64>() / count.max(1) as f64).sqrt()
        };
        let heights = ties.iter().filter(|tie| tie.known == KnownOf::All).count();
        let plan = rms(&|d| d.xy().norm_squared(), ties.len());
        [plan, rms(&|d| d.z * d.z, heights)]
    }

    /// What scale and level by these positions are worth, from which a lag was taken out or not;
    /// what they do not level the angles do.
    fn worth(
        &self,
        velocities: Option<&[Vector3<f64>]>,
        angles: &AnglesFinding,
    ) -> Option<FrameSigma> {
        let free = Free {
            up: !self.found.is_levelled,
            lag: velocities.is_some(),
        };
        let own = worth(&self.ties(velocities, false), self.similarity, 0.0, free)?.frame;
        let by_angles = angles.by_angles.as_ref().map(|angles| angles.sigma());
        Some(match free.up {
            true => own,
            false => FrameSigma::of(Some(own.scale()), by_angles),
        })
    }
}
