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
use crate::base::math;
use crate::orienting::orientation::FrameSigma;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::similarity::Similarity;
use crate::orienting::structure_from_motion::similarity_fit::{Held, KnownOf, Tie, fitted, worth};
use crate::orienting::structure_from_motion::triangulation::LARGEST_RESIDUAL_SIGMAS;

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
    /// Root mean square distance of the positions as they are stated, in plan and in height, metres:
    /// of those that agree with the lag taken out.
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

/// What is known of stated positions once they have placed a block.
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
        let seen = self.lag();
        if let Some((lag, stated)) = seen.as_ref().filter(|(lag, _)| lag.is_applied)
            && let Ok((similarity, found, _)) = by_positions(self.block, stated, angles)
            && found.agreeing >= self.found.agreeing
        {
            let without = Stated {
                stated,
                similarity: &similarity,
                found: &found,
                ..*self
            };
            let sigma = without.worth(true, angles);
            let as_stated = Stated {
                found: &found,
                ..*self
            };
            let lag = Lag {
                before_m: as_stated.rms_m(),
                after_m: found.rms_m,
                ..lag.clone()
            };
            return (similarity, found, Some(lag), sigma);
        }
        let lag = seen.map(|(lag, _)| Lag {
            is_applied: false,
            moved_m: Vec::new(),
            ..lag
        });
        let sigma = self.worth(false, angles);
        (self.similarity.clone(), self.found.clone(), lag, sigma)
    }

    fn placed(&self, photo: usize) -> Option<Point3<f64>> {
        let pose = self.block.photos[photo].pose.as_ref()?;
        Some(self.similarity.point(&pose.center))
    }

    /// By how much each photograph's place moves in a unit of the lag, and that unit.
    fn velocities(&self) -> (Vec<Vector3<f64>>, &'static str) {
        let photos = 0..self.stated.len();
        let oriented: Vec<(usize, Point3<f64>)> = photos
            .filter_map(|photo| Some((photo, self.placed(photo)?)))
            .collect();
        let has_times = (oriented.iter()).all(|(photo, _)| self.stated[*photo].taken_s.is_some());
        let at = |photo: usize| match self.stated[photo].taken_s {
            Some(seconds) if has_times => seconds,
            _ => photo as f64,
        };
        let mut velocities = vec![Vector3::zeros(); self.stated.len()];
        for &(photo, place) in &oriented {
            let camera = self.block.photos[photo].camera;
            let others =
                || (oriented.iter()).filter(|(i, _)| self.block.photos[*i].camera == camera);
            let later =
                |a: &&(usize, Point3<f64>), b: &&(usize, Point3<f64>)| at(a.0).total_cmp(&at(b.0));
            let before = others().filter(|(i, _)| at(*i) < at(photo)).max_by(later);
            // The first one flies as it goes on.
            let after = || others().filter(|(i, _)| at(*i) > at(photo)).min_by(later);
            if let Some((other, from)) = before.or_else(after) {
                let (path, time) = (place - from, at(photo) - at(*other));
                velocities[photo] = match has_times {
                    true => path / time,
                    false => path.try_normalize(0.0).unwrap_or_default() * time.signum(),
                };
            }
        }
        (velocities, if has_times { "s" } else { "m" })
    }

    /// The stated positions of photographs; without `velocities` no lag shows in them.
    fn ties(&self, velocities: &[Vector3<f64>]) -> Vec<Tie> {
        let tie = |(photo, stated): (usize, &StatedPose)| {
            let pose = self.block.photos[photo].pose.as_ref()?;
            let has_height = self.heights > 0 && !stated.lacks_height;
            Some(Tie {
                from: pose.center,
                to: stated.position?,
                known: if has_height {
                    KnownOf::All
                } else {
                    KnownOf::Plan
                },
                sigma_m: stated.sigma_m.unwrap_or(RECEIVER_SIGMA_M),
                velocity: velocities[photo],
            })
        };
        self.stated.iter().enumerate().filter_map(tie).collect()
    }

    /// Those of the agreeing photographs.
    fn agreeing(&self, velocities: &[Vector3<f64>]) -> Vec<Tie> {
        let mut stated = self.stated.to_vec();
        for &photo in &self.found.contradicted {
            stated[photo].position = None;
        }
        let only = Stated {
            stated: &stated,
            ..*self
        };
        only.ties(velocities)
    }

    /// Root mean square distance of the agreeing photographs, in plan and in height, metres.
    fn rms_m(&self) -> [f64; 2] {
        let ties = self.agreeing(&vec![Vector3::zeros(); self.stated.len()]);
        let off = |tie: &Tie| tie.off(self.similarity, 0.0);
        let sum = ties.iter().map(off).fold([0.0; 2], |[plan, height], d| {
            [plan + d.xy().norm_squared(), height + d.z * d.z]
        });
        let heights = ties.iter().filter(|tie| tie.known == KnownOf::All).count();
        [(sum[0], ties.len()), (sum[1], heights)]
            .map(|(sum, count)| (sum / count.max(1) as f64).sqrt())
    }

    /// The lag, and the positions without it where it is larger than its noise; `None` where the
    /// flight does not tell.
    fn lag(&self) -> Option<(Lag, Vec<StatedPose>)> {
        let (velocities, unit) = self.velocities();
        let ties = self.ties(&velocities);
        let held = self.found.is_levelled.then_some(Held::Up);
        let mut at = (self.similarity.clone(), 0.0);
        let mut agreeing = Vec::new();
        // The second time the lag is no longer among the residuals.
        for _ in 0..2 {
            let square = |tie: &Tie| (tie.off(&at.0, at.1) / tie.sigma_m).norm_squared();
            let mut lengths: Vec<f64> = ties.iter().map(|tie| square(tie).sqrt()).collect();
            let loss = Loss::Cauchy(2.0 * math::median(&mut lengths)?.max(0.1));
            let next = fitted(&at.0, &ties, held, loss)?;
            at = next;
            let square = |tie: &Tie| (tie.off(&at.0, at.1) / tie.sigma_m).norm_squared();
            agreeing = (ties.iter())
                .filter(|tie| loss.weight(square(tie)) > 0.25)
                .cloned()
                .collect();
        }
        let (similarity, lag) = at;
        let sigma = worth(&agreeing, &similarity, lag, held)?.lag;
        let is_applied = lag.abs() > LARGEST_RESIDUAL_SIGMAS * sigma;
        let moved_m: Vec<Vector3<f64>> = match is_applied {
            true => velocities.iter().map(|v| v * lag).collect(),
            false => Vec::new(),
        };
        let without = self.stated.iter().enumerate().map(|(photo, stated)| {
            let moved = moved_m.get(photo).copied().unwrap_or_default();
            StatedPose {
                position: stated.position.map(|p| p + moved),
                lacks_height: stated.lacks_height || self.heights == 0,
                ..stated.clone()
            }
        });
        let without = without.collect();
        let lag = Lag {
            lag,
            sigma,
            unit: unit.to_owned(),
            is_applied,
            before_m: self.found.rms_m,
            after_m: self.found.rms_m,
            moved_m,
        };
        Some((lag, without))
    }

    /// What scale and level by these positions are worth; where they do not give the level, what
    /// the angles make of it.
    fn worth(&self, has_lag: bool, angles: &AnglesFinding) -> Option<FrameSigma> {
        let velocities = match has_lag {
            true => self.velocities().0,
            false => vec![Vector3::zeros(); self.stated.len()],
        };
        let held = match (has_lag, self.found.is_levelled) {
            (true, true) => Some(Held::Up),
            (true, false) => None,
            (false, true) => Some(Held::LagAndUp),
            (false, false) => Some(Held::Lag),
        };
        let own = worth(&self.agreeing(&velocities), self.similarity, 0.0, held)?.frame;
        let by_angles = angles.by_angles.as_ref().map(|angles| angles.sigma());
        Some(match self.found.is_levelled {
            true => FrameSigma::of(Some(own.scale()), by_angles),
            false => own,
        })
    }
}
