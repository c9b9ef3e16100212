//! What is known, set against what the images show: by how much it lies beside that, whether it
//! belongs to the place, and what the user should know of it.
//!
//! Coordinate systems and datums are mistaken as wholes, so a shift as a whole is sought first and
//! taken out where it exceeds what the accuracies explain. What then agrees with the images and
//! what does not tells whether the thing is of this place.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::base::math::{exp, hypot, ln};
use crate::orienting::orientation::MOST_DATUM_M;

/// What can be known beforehand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KnownThing {
    /// A terrain model.
    Terrain,
    /// The footprints of a register.
    Footprints,
    /// A point cloud.
    PointCloud,
}

/// A thing that is known, compared with the images.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct KnownComparison {
    /// Its file.
    pub file: String,
    /// Its standard deviation as stated, metres.
    pub accuracy_m: f64,
    /// What was done with it.
    pub verdict: KnownVerdict,
    /// Probability that it belongs to this place, 0 to 1.
    pub belongs: f64,
    /// From it to what the images show, east, north and up, metres; absent where they show too
    /// little, and 0 where the thing says nothing.
    pub shift_m: Option<[f64; 3]>,
    /// Of a terrain model: middles of the squares of 5 m around roofs where the images contradict
    /// it and count instead, metres, local frame.
    pub contradicted_at: Vec<[f64; 2]>,
}

/// What was done with a thing that is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
pub enum KnownVerdict {
    /// The images confirm it, and it counted as it is.
    Used,
    /// It was moved as a whole to what the images show, and counted.
    Moved,
    /// The images show too little to compare it with, and it counted as it is.
    Unchecked,
    /// The images contradict it as a whole, so it counted for little or for nothing.
    Contradicted,
    /// It covers too little of the scene, and was not used.
    #[default]
    Elsewhere,
}

/// How far a thing lies from what the images show.
#[derive(Clone, Copy, Debug)]
pub struct KnownShift {
    /// From it to that, metres.
    pub by: Vector3<f64>,
    /// Largest shifts in plan and in height that the accuracies explain, metres.
    pub explained_m: [f64; 2],
}

impl KnownShift {
    /// Do the accuracies not explain it?
    pub fn is_real(&self) -> bool {
        let [plan, height] = self.explained_m;
        hypot(self.by.x, self.by.y) > plan || self.by.z.abs() > height
    }
}

/// What belongs here with less probability is contradicted.
const DOUBTFUL: f64 = 0.5;

impl KnownComparison {
    /// A thing before it is compared, as if it lay elsewhere.
    pub fn new(file: &str, accuracy_m: f64) -> Self {
        Self {
            file: file.to_owned(),
            accuracy_m,
            ..Self::default()
        }
    }

    /// Of a thing that covers the scene: its shift, where the images show enough to tell, and the
    /// probability that it belongs here.
    pub fn judged(self, shift: Option<KnownShift>, belongs: f64) -> Self {
        let verdict = match shift {
            None => KnownVerdict::Unchecked,
            Some(_) if belongs < DOUBTFUL => KnownVerdict::Contradicted,
            Some(shift) if shift.is_real() => KnownVerdict::Moved,
            Some(_) => KnownVerdict::Used,
        };
        Self {
            verdict,
            belongs,
            shift_m: shift.map(|shift| shift.by.into()),
            ..self
        }
    }

    /// By so much it was moved before it was used, metres.
    pub fn moved_m(&self) -> Vector3<f64> {
        match (self.verdict, self.shift_m) {
            (KnownVerdict::Moved, Some(shift)) => shift.into(),
            _ => Vector3::zeros(),
        }
    }

    /// What the user should know; nothing where the images confirm it.
    pub fn warning(&self, thing: KnownThing) -> Option<String> {
        use KnownThing::{Footprints, PointCloud, Terrain};
        let file = &self.file;
        Some(match self.verdict {
            KnownVerdict::Used => return None,
            KnownVerdict::Unchecked => {
                format!("the images show too little to check {file}, so it was used as it is")
            }
            KnownVerdict::Moved => {
                let datum = match thing {
                    Terrain => ", as with another datum of heights",
                    Footprints | PointCloud => "",
                };
                format!(
                    "{file} was moved by {} to what the images show{datum}",
                    self.shift_words(self.moved_m().into())
                )
            }
            KnownVerdict::Contradicted => match thing {
                Terrain if self.is_far_off() => format!(
                    "the ground that the images show lies {} from {file}, and no datums of heights \
                     are as far apart, so it was not used: check its place and the unit of its \
                     heights",
                    self.shift_words(self.shift_m.unwrap_or_default())
                ),
                Terrain => format!(
                    "{file} follows the roofs, so it is a surface model and was not used: give a \
                     terrain model"
                ),
                Footprints => format!(
                    "the images contradict {file} as a whole, so it counted for little: check that \
                     it is of this place"
                ),
                PointCloud => format!(
                    "the images contradict {file} as a whole, so its points on roofs were left \
                     out: check that it is of this place"
                ),
            },
            KnownVerdict::Elsewhere => format!(
                "hardly anything of {file} lies in the scene, so it was not used: check its \
                 coordinate system"
            ),
        })
    }

    /// Does the shift of heights exceed that between any two datums?
    fn is_far_off(&self) -> bool {
        self.shift_m.is_some_and(|[.., up]| up.abs() > MOST_DATUM_M)
    }

    /// "1.20 m west, 0.90 m north": what is more than a centimetre.
    fn shift_words(&self, [east, north, up]: [f64; 3]) -> String {
        let parts = [
            (east, ["east", "west"]),
            (north, ["north", "south"]),
            (up, ["up", "down"]),
        ];
        let words = parts.into_iter().filter(|(by, _)| by.abs() >= 0.005);
        let words = words.map(|(by, [ahead, back])| {
            let way = if by > 0.0 { ahead } else { back };
            format!("{:.2} m {way}", by.abs())
        });
        words.collect::<Vec<_>>().join(", ")
    }
}

/// Probability that a thing belongs here, which is `before` until it is compared: of its
/// independent parts so many agree with the images and so many differ. Those of a thing of this
/// place agree with probability `here`, of another place with probability `chance`.
pub(crate) fn belongs_here(before: f64, [agree, differ]: [f64; 2], here: f64, chance: f64) -> f64 {
    let [before, here, chance] = [before, here, chance].map(|p| p.clamp(1e-3, 1.0 - 1e-3));
    let odds = ln(before / (1.0 - before))
        + agree * ln(here / chance)
        + differ * ln((1.0 - here) / (1.0 - chance));
    1.0 / (1.0 + exp(-odds))
}

/// The shift at which a thing explains most of what the images show, and how much, nats; of equally
/// good ones the first.
pub(crate) fn best_shift<S: Copy + Sync>(
    shifts: &[S],
    nats: impl Fn(&S) -> f64 + Sync,
) -> Option<(S, f64)> {
    let explained = crate::base::execution::map(shifts, |_, shift| nats(shift));
    let of_shifts = shifts.iter().copied().zip(explained);
    of_shifts.reduce(|best, next| if next.1 > best.1 { next } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thing_belongs_where_it_agrees_with_the_images() {
        let belongs = |agree, differ| belongs_here(0.95, [agree, differ], 0.95, 0.3);
        assert!((belongs(0.0, 0.0) - 0.95).abs() < 1e-12);
        assert!(belongs(10.0, 0.0) > belongs(0.0, 0.0));
        assert!(belongs(0.0, 10.0) < 0.01);
        // What agrees as often as by chance speaks against it.
        assert!(belongs(3.0, 7.0) < belongs(0.0, 0.0));
    }

    #[test]
    fn a_shift_is_taken_out_where_the_accuracies_do_not_explain_it() {
        let judged = |by: [f64; 3], belongs: f64| {
            let shift = KnownShift {
                by: by.into(),
                explained_m: [0.5, 1.0],
            };
            KnownComparison::new("a", 0.3).judged(Some(shift), belongs)
        };
        assert_eq!(judged([0.3, -0.3, 0.9], 0.9).verdict, KnownVerdict::Used);
        assert_eq!(judged([0.3, -0.3, 0.9], 0.9).moved_m(), Vector3::zeros());
        let moved = judged([-1.2, 0.002, 46.0], 0.9);
        assert_eq!(moved.moved_m(), Vector3::new(-1.2, 0.002, 46.0));
        let said = moved.warning(KnownThing::PointCloud);
        let expected = "a was moved by 1.20 m west, 46.00 m up to what the images show";
        assert_eq!(said.as_deref(), Some(expected));
        assert_eq!(
            judged([9.0, 0.0, 0.0], 0.1).verdict,
            KnownVerdict::Contradicted
        );
        assert_eq!(judged([9.0, 0.0, 0.0], 0.1).moved_m(), Vector3::zeros());
        let unchecked = KnownComparison::new("a", 0.3).judged(None, 0.9);
        assert_eq!(unchecked.verdict, KnownVerdict::Unchecked);
    }

    #[test]
    fn of_equally_good_shifts_the_first_counts() {
        let nats = |by: &i32| -f64::from((by.abs() - 2).abs());
        assert_eq!(best_shift(&[0, 1, 2, -2], nats), Some((2, 0.0)));
        assert_eq!(best_shift(&[], nats), None);
    }
}
