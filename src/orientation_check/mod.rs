//! The orientation doctor: do the images themselves agree with their orientation, and if not, why not?
//!
//! ```text
//! interest points (points) -> best place on shifted epipolar lines in other views (epipolar)
//!   -> agreement, against what chance gives
//!   -> the same under every usual mistake (suspects), when the orientation as stated does not agree
//! ```
//!
//! Where they agree, `fine` looks for half a pixel, and `shifts` measures how far each view is off.
//!
//! Nothing is matched from outside and nothing is corrected here: the doctor measures, and names what fits. Only
//! images count: a mistake that moves the whole world (a wrong datum) leaves the views in agreement.

mod epipolar;
mod fine;
mod network;
mod points;
mod report;
mod shifts;
mod suspects;

pub use suspects::{AngleOrder, Sequence, Suspect};

use nalgebra::{Matrix3, Point2, Vector2, Vector3};

use self::epipolar::{MARGIN, Reduced, SHIFTS, best_place};
use self::points::interest_points;
use crate::agreement::{Agreement, Trial};
use crate::camera::Camera;
use crate::execution::parallel;
use crate::orientation::Crop;
use crate::raster::Gray;
use crate::scene::ViewShift;
use crate::sorting::sort_by;

/// A view as the doctor sees it: its image, and what the files say about it.
#[derive(Clone, Debug)]
pub struct Patient<'a> {
    /// Name of the view.
    pub name: &'a str,
    /// Camera of the image, local frame.
    pub camera: Camera,
    /// Grey values.
    pub gray: &'a Gray,
    /// Scene origin, which the local frame lacks.
    pub origin: Vector3<f64>,
    /// The rotation angles as the file states them.
    pub angles: Option<[f64; 3]>,
    /// The part of the frame that the image is, where the file states it.
    pub crop: Option<Crop>,
}

/// What the doctor found.
#[derive(Clone, Debug, PartialEq)]
pub enum Diagnosis {
    /// Images and orientation agree.
    Sound(Agreement),
    /// The images show too little that can be found again: nothing can be said.
    Unknown(Agreement),
    /// They do not agree; without this mistake they would.
    Explained {
        /// As stated.
        before: Agreement,
        /// Without the mistake.
        after: Agreement,
        /// The mistake.
        suspect: Suspect,
        /// The mistake in words.
        words: String,
    },
    /// They agree, but for an offset of a pixel's half.
    Offset {
        /// The mistake.
        suspect: Suspect,
        /// As stated.
        agreement: Agreement,
        /// Mean offset across the epipolar lines, pixels: as stated and without the mistake.
        offsets_px: [f64; 2],
        /// The mistake in words.
        words: String,
    },
    /// These views agree with no other one, the others agree.
    Odd(Agreement, Vec<usize>),
    /// They do not agree, and none of the usual mistakes explains it.
    Unexplained(Agreement),
}

/// A diagnosis, and measurements that only sound views allow.
#[derive(Clone, Debug, PartialEq)]
pub struct Examination {
    /// What the doctor found.
    pub diagnosis: Diagnosis,
    /// Shifts of the views against each other, pixels; empty where too little is found again.
    pub shifts: Vec<ViewShift>,
    /// Assumptions that were tried where the views do not agree, the best first.
    pub trials: Vec<Trial>,
}

impl From<Diagnosis> for Examination {
    fn from(diagnosis: Diagnosis) -> Self {
        Self {
            diagnosis,
            shifts: Vec::new(),
            trials: Vec::new(),
        }
    }
}

/// Longer side of the reduced images, pixels: enough to tell places apart, few enough to search fast.
const REDUCED_PX: u32 = 300;

/// In smaller images a line is too short to tell the right place from a wrong one, pixels.
const SMALLEST_PX: u32 = 128;

/// Fewer points than this decide nothing.
const FEWEST_POINTS: usize = 40;

/// Agreement from which on an orientation is sound. Measured: 0.36 to 0.73 for sound scenes, rendered and
/// real; at most 0.2 for wrong ones (two strips exchanged).
const SOUND: f64 = 0.25;

/// Agreement of one view with the others below which it is odd, where the others agree.
const ODD: f64 = 0.03;

/// Least gain that convicts a suspect.
const LEAST_GAIN: f64 = 0.12;

/// Most neighbours in the list of views that a view is compared with.
const NEIGHBOURS: usize = 5;

/// Examines views, and looks for the mistake where they do not agree.
pub fn examine(patients: &[Patient]) -> Examination {
    let is_small = |p: &Patient| p.camera.width.min(p.camera.height) < SMALLEST_PX;
    if patients.iter().any(is_small) {
        return Diagnosis::Unknown(Agreement::default()).into();
    }
    let clinic = Clinic::new(patients);
    let stated: Vec<Camera> = patients.iter().map(|p| p.camera.clone()).collect();
    let counts = clinic.counts(&stated, &clinic.pairs);
    let before = total(&counts);
    let odd = clinic.odd_views(&counts);
    let coarse = match before.score >= SOUND {
        true => shifts::coarse_shifts(&clinic, &stated),
        false => vec![Vector2::zeros(); stated.len()],
    };
    // A view that is only shifted is no odd one.
    let nearly = shifts::shifted(&stated, &coarse);
    let is_odd = !odd.is_empty() && {
        let counts = clinic.counts(&nearly, &clinic.pairs);
        !clinic.odd_views(&counts).is_empty()
    };
    if before.score >= SOUND && !is_odd {
        let places = fine::places(&clinic, patients, &nearly);
        let shifts = shifts::shifts(&clinic, &places, &stated, &coarse).unwrap_or_default();
        let diagnosis = match fine::half_pixel(&clinic, patients, &stated, &places) {
            Some((suspect, offsets)) => Diagnosis::Offset {
                suspect,
                agreement: before,
                offsets_px: offsets,
                words: suspect.describe(patients),
            },
            None => Diagnosis::Sound(before),
        };
        return Examination {
            shifts,
            ..diagnosis.into()
        };
    }
    let Interview {
        best: (after, suspect),
        trials,
    } = clinic.interview(patients, &odd, before);
    let diagnosis = match suspect {
        Some(suspect) if after.score >= SOUND && after.score >= before.score + LEAST_GAIN => {
            Diagnosis::Explained {
                before,
                after,
                suspect,
                words: suspect.describe(patients),
            }
        }
        _ if before.points < FEWEST_POINTS => Diagnosis::Unknown(before),
        _ if !odd.is_empty() => Diagnosis::Odd(before, odd),
        _ => Diagnosis::Unexplained(before),
    };
    Examination {
        trials,
        ..diagnosis.into()
    }
}

/// The reduced images and their points: what stays the same under every suspicion.
struct Clinic {
    factors: Vec<usize>,
    grays: Vec<Gray>,
    points: Vec<Vec<Point2<f64>>>,
    pairs: Vec<(usize, usize)>,
}

/// What came of trying suspects.
struct Interview {
    best: (Agreement, Option<Suspect>),
    trials: Vec<Trial>,
}

impl Interview {
    /// This one's best, and the trials of both.
    fn or(mut self, earlier: Self) -> Self {
        self.trials.extend(earlier.trials);
        sort_by(&mut self.trials, |a, b| {
            let by_score = b.agreement.score.total_cmp(&a.agreement.score);
            b.all_pairs.cmp(&a.all_pairs).then(by_score)
        });
        self
    }
}

/// Of the points of a view, those found again in another one, and those of them found on the line.
type Count = [usize; 2];

impl Clinic {
    fn new(patients: &[Patient]) -> Self {
        let factor = |p: &Patient| {
            let longest = p.camera.width.max(p.camera.height);
            ((longest + REDUCED_PX / 2) / REDUCED_PX).max(1) as usize
        };
        let factors: Vec<usize> = patients.iter().map(factor).collect();
        let grays = parallel::map(patients, |i, p| p.gray.reduced(factors[i]));
        let points = parallel::map(&grays, |_, gray| interest_points(gray, MARGIN));
        let count = patients.len();
        let pairs = (0..count)
            .flat_map(|i| (i + 1..count.min(i + 1 + NEIGHBOURS)).map(move |j| (i, j)))
            .collect();
        Self {
            factors,
            grays,
            points,
            pairs,
        }
    }

    /// Agreement of the images under these cameras.
    fn agreement(&self, cameras: &[Camera]) -> Agreement {
        total(&self.counts(cameras, &self.pairs))
    }

    /// What is found in each pair of views.
    fn counts(&self, cameras: &[Camera], pairs: &[(usize, usize)]) -> Vec<Count> {
        let reduced = self.reduced(cameras);
        let axis = mean_axis(cameras);
        parallel::map(pairs, |_, &(i, j)| {
            let found = self.points[i]
                .iter()
                .filter_map(|x| best_place(&reduced[i], &reduced[j], &axis, x));
            found.fold([0, 0], |[all, on], place| {
                [all + 1, on + usize::from(place.shift.abs() <= 1)]
            })
        })
    }

    fn reduced(&self, cameras: &[Camera]) -> Vec<Reduced<'_>> {
        (cameras.iter().zip(&self.grays))
            .zip(&self.factors)
            .map(|((camera, gray), &factor)| Reduced {
                camera: reduced_camera(camera, factor, gray),
                gray,
            })
            .collect()
    }

    /// Views that agree with no other one, although those agree among themselves.
    fn odd_views(&self, counts: &[Count]) -> Vec<usize> {
        let of_pairs = |is_meant: &dyn Fn(usize, usize) -> bool| {
            let pairs = self.pairs.iter().zip(counts);
            let meant = pairs.filter(|((i, j), _)| is_meant(*i, *j));
            agreement_of(meant.fold([0, 0], |sum, (_, c)| [sum[0] + c[0], sum[1] + c[1]]))
        };
        let is_odd = |view: usize| {
            let own = of_pairs(&|i, j| i == view || j == view);
            own.points >= FEWEST_POINTS && own.score < ODD
        };
        let odd: Vec<usize> = (0..self.grays.len()).filter(|&i| is_odd(i)).collect();
        let others = of_pairs(&|i, j| !odd.contains(&i) && !odd.contains(&j));
        match others.points >= FEWEST_POINTS && others.score >= SOUND {
            true => odd,
            false => Vec::new(),
        }
    }

    /// The suspect under whom the views agree best.
    fn interview(&self, patients: &[Patient], odd: &[usize], before: Agreement) -> Interview {
        // Where some views agree, the others are suspects first.
        let exchanged = match *odd {
            [a, b] => vec![Suspect::Swapped(a, b)],
            _ => Vec::new(),
        };
        let best = self.best_of(patients, exchanged);
        if best.best.0.score >= SOUND || before.score >= SOUND {
            return best;
        }
        let best = self.best_of(patients, Suspect::lineup(patients)).or(best);
        if best.best.0.score >= SOUND {
            return best;
        }
        self.best_of(patients, self.focal_lengths(patients))
            .or(best)
    }

    /// The best of many: a few pairs of views single out those worth asking all.
    fn best_of(&self, patients: &[Patient], suspects: Vec<Suspect>) -> Interview {
        const FINALISTS: usize = 4;
        let few = self.few_pairs();
        let mut treated: Vec<(Agreement, Suspect, Vec<Camera>)> = (suspects.into_iter())
            .filter_map(|suspect| {
                let cameras = suspect.treated(patients)?;
                Some((total(&self.counts(&cameras, &few)), suspect, cameras))
            })
            .collect();
        sort_by(&mut treated, |a, b| b.0.score.total_cmp(&a.0.score));
        let trial = |agreement, suspect: Suspect, all_pairs| Trial {
            words: suspect.describe(patients),
            agreement,
            all_pairs,
        };
        let mut best = (Agreement::default(), None);
        let mut trials = Vec::new();
        for (_, suspect, cameras) in treated.iter().take(FINALISTS) {
            let after = self.agreement(cameras);
            trials.push(trial(after, *suspect, true));
            if after.score > best.0.score {
                best = (after, Some(*suspect));
            }
        }
        sort_by(&mut trials, |a, b| {
            b.agreement.score.total_cmp(&a.agreement.score)
        });
        let others = treated.iter().skip(FINALISTS);
        trials.extend(others.map(|(agreement, suspect, _)| trial(*agreement, *suspect, false)));
        Interview { best, trials }
    }

    /// Enough pairs of views for a first impression.
    fn few_pairs(&self) -> Vec<(usize, usize)> {
        const ENOUGH: usize = 4;
        let step = (self.pairs.len() / ENOUGH).max(1);
        self.pairs.iter().copied().step_by(step).collect()
    }

    /// Focal lengths in question: the pixel size under which a few pairs agree best, and its neighbours.
    fn focal_lengths(&self, patients: &[Patient]) -> Vec<Suspect> {
        let few = self.few_pairs();
        let camera = &patients[0].camera;
        let longer = f64::from(camera.width.max(camera.height));
        // Millimetres, or the width of the image, or that of small-format film as a unit; and the reverse.
        let units = PIXEL_SIZES_UM.map(|size| 1000.0 / size);
        let units = units.into_iter().chain([longer, longer / 36.0]);
        let mut best = (0.0, 1.0);
        let is_possible = |factor: &f64| {
            let focal_px = factor * camera.k[(0, 0)];
            focal_px > SHORTEST_FOCAL * longer && focal_px < LONGEST_FOCAL_PX
        };
        for factor in (units.flat_map(|unit| [unit, 1.0 / unit])).filter(is_possible) {
            if let Some(cameras) = Suspect::Focal(factor).treated(patients) {
                let score = total(&self.counts(&cameras, &few)).score;
                if score > best.0 {
                    best = (score, factor);
                }
            }
        }
        let near = [0.97, 0.98, 0.99, 1.0, 1.01, 1.02, 1.03];
        near.map(|f| Suspect::Focal(best.1 * f)).to_vec()
    }
}

/// Shortest focal length that a unit may stand for, in longer sides of the image. Assumption: no aerial camera sees more than a
/// hundred and twenty degrees.
const SHORTEST_FOCAL: f64 = 0.3;

/// Longest one, pixels: a lens of 300 mm over pixels of 1.5 micrometres. Beyond, views are all but parallel projections, and
/// crops of one place agree under any of them.
const LONGEST_FOCAL_PX: f64 = 200_000.0;

/// Sizes of a pixel that occur, micrometres: small and large sensors, scanners.
const PIXEL_SIZES_UM: [f64; 30] = [
    1.5, 1.55, 2.0, 2.4, 3.2, 3.3, 3.76, 3.9, 4.0, 4.4, 4.6, 4.8, 5.2, 5.6, 6.0, 6.4, 6.8, 7.0,
    7.2, 7.5, 8.0, 9.0, 10.0, 12.0, 12.5, 14.0, 15.0, 20.0, 25.0, 30.0,
];

/// The mean viewing direction: planes across it serve as ground, wherever up is.
fn mean_axis(cameras: &[Camera]) -> Vector3<f64> {
    cameras.iter().map(|c| c.r.row(2).transpose()).sum()
}

/// Agreement over all pairs.
fn total(counts: &[Count]) -> Agreement {
    agreement_of(
        counts
            .iter()
            .fold([0, 0], |sum, c| [sum[0] + c[0], sum[1] + c[1]]),
    )
}

/// Wilson's lower bound of the share found on the line, freed of what chance gives.
fn agreement_of([points, on_line]: Count) -> Agreement {
    let chance = 3.0 / (2 * SHIFTS + 1) as f64;
    let score = if points == 0 {
        0.0
    } else {
        let (n, share) = (points as f64, on_line as f64 / points as f64);
        const Z: f64 = 2.0;
        let spread = (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
        let low = (share + Z * Z / (2.0 * n) - Z * spread) / (1.0 + Z * Z / n);
        ((low - chance) / (1.0 - chance)).max(0.0)
    };
    Agreement { points, score }
}

fn reduced_camera(camera: &Camera, factor: usize, gray: &Gray) -> Camera {
    let scale = 1.0 / factor as f64;
    Camera {
        k: Matrix3::from_diagonal(&Vector3::new(scale, scale, 1.0)) * camera.k,
        width: gray.width as u32,
        height: gray.height as u32,
        ..camera.clone()
    }
}
