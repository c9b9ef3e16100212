//! Which hypothesis about an error in the orientation makes the images agree best.
//!
//! Every hypothesis is tested on a few pairs of views; the best of them on all pairs. Exchanged
//! outlier views are tested first, then all usual errors, then focal lengths in other units than
//! pixels.

use super::epipolar_check::{EpipolarCheck, MIN_AGREEMENT, total_agreement};
use super::error_hypothesis::ErrorHypothesis;
use super::view::CheckedView;
use crate::base::agreement::{Agreement, TestedHypothesis};
use crate::photographs::camera::Camera;

/// What came of testing hypotheses.
pub(crate) struct HypothesisSearch {
    /// The best one, and the agreement under it.
    pub best: (Agreement, Option<ErrorHypothesis>),
    /// All that were tested, the best first; those tested on all pairs before the others.
    pub tested: Vec<TestedHypothesis>,
}

impl HypothesisSearch {
    /// Searches the hypothesis under which the views agree best. `outliers` are views that agree
    /// with no other one, `stated` is the agreement under the cameras as stated.
    pub(super) fn run(
        check: &EpipolarCheck,
        views: &[CheckedView],
        outliers: &[usize],
        stated: Agreement,
    ) -> Self {
        let exchanged = match *outliers {
            [a, b] => vec![ErrorHypothesis::SwappedViews(a, b)],
            _ => Vec::new(),
        };
        let found = Self::among(check, views, exchanged);
        if found.best.0.score >= MIN_AGREEMENT || stated.score >= MIN_AGREEMENT {
            return found;
        }
        let found = Self::among(check, views, ErrorHypothesis::all_of(views)).after(found);
        if found.best.0.score >= MIN_AGREEMENT {
            return found;
        }
        Self::among(check, views, focal_lengths(check, views)).after(found)
    }

    /// The best of many: a few pairs of views select those that are tested on all pairs.
    fn among(
        check: &EpipolarCheck,
        views: &[CheckedView],
        hypotheses: Vec<ErrorHypothesis>,
    ) -> Self {
        // Hypotheses that are tested on all pairs. Assumption: the best one of all is among the
        // four best of a few pairs.
        const FINALISTS: usize = 4;
        let few = few_pairs(check);
        let mut ranked: Vec<(Agreement, ErrorHypothesis, Vec<Camera>)> = (hypotheses.into_iter())
            .filter_map(|hypothesis| {
                let cameras = hypothesis.corrected_cameras(views)?;
                let agreement = total_agreement(&check.counts(&cameras, &few));
                Some((agreement, hypothesis, cameras))
            })
            .collect();
        ranked.sort_by(|a, b| b.0.score.total_cmp(&a.0.score));
        let record = |agreement, hypothesis: ErrorHypothesis, all_pairs| TestedHypothesis {
            hypothesis: hypothesis.describe(views),
            agreement,
            all_pairs,
        };
        let mut best = (Agreement::default(), None);
        let mut tested = Vec::new();
        for (_, hypothesis, cameras) in ranked.iter().take(FINALISTS) {
            let agreement = check.agreement(cameras);
            tested.push(record(agreement, *hypothesis, true));
            if agreement.score > best.0.score {
                best = (agreement, Some(*hypothesis));
            }
        }
        tested.sort_by(|a, b| b.agreement.score.total_cmp(&a.agreement.score));
        let others = ranked.iter().skip(FINALISTS);
        tested.extend(
            others.map(|(agreement, hypothesis, _)| record(*agreement, *hypothesis, false)),
        );
        Self { best, tested }
    }

    /// This search's best, and the tested hypotheses of both.
    fn after(mut self, earlier: Self) -> Self {
        self.tested.extend(earlier.tested);
        self.tested.sort_by(|a, b| {
            let by_score = b.agreement.score.total_cmp(&a.agreement.score);
            b.all_pairs.cmp(&a.all_pairs).then(by_score)
        });
        self
    }
}

/// Enough pairs of views for a first ranking.
fn few_pairs(check: &EpipolarCheck) -> Vec<(usize, usize)> {
    // Pairs at least, where there are as many. Assumption: one may show nothing, four show
    // something.
    const RANKING_PAIRS: usize = 4;
    let step = (check.pairs.len() / RANKING_PAIRS).max(1);
    check.pairs.iter().copied().step_by(step).collect()
}

/// Focal lengths in question: the unit under which a few pairs agree best, and neighbours of that
/// length.
fn focal_lengths(check: &EpipolarCheck, views: &[CheckedView]) -> Vec<ErrorHypothesis> {
    let few = few_pairs(check);
    let camera = &views[0].camera;
    let longer = f64::from(camera.width.max(camera.height));
    // Millimetres, or the width of the image, or that of small-format film as a unit; and the
    // reverse.
    let units = PIXEL_SIZES_UM.map(|size| 1000.0 / size);
    let units = units.into_iter().chain([longer, longer / 36.0]);
    let mut best = (0.0, 1.0);
    let is_possible = |factor: &f64| {
        let focal_px = factor * camera.k[(0, 0)];
        focal_px > SHORTEST_FOCAL * longer && focal_px < LONGEST_FOCAL_PX
    };
    for factor in (units.flat_map(|unit| [unit, 1.0 / unit])).filter(is_possible) {
        if let Some(cameras) = ErrorHypothesis::FocalLengthUnit(factor).corrected_cameras(views) {
            let score = total_agreement(&check.counts(&cameras, &few)).score;
            if score > best.0 {
                best = (score, factor);
            }
        }
    }
    let near = [0.97, 0.98, 0.99, 1.0, 1.01, 1.02, 1.03];
    near.map(|f| ErrorHypothesis::FocalLengthUnit(best.1 * f))
        .to_vec()
}

/// Shortest focal length that a unit may stand for, in longer sides of the image. Assumption: no
/// aerial camera has a field of view of more than 120 degrees.
const SHORTEST_FOCAL: f64 = 0.3;

/// Longest one, pixels: a lens of 300 mm over pixels of 1.5 micrometres. Beyond, views are nearly
/// parallel projections, and crops of one place agree under any of them.
const LONGEST_FOCAL_PX: f64 = 200_000.0;

/// Sizes of a pixel that occur, micrometres: small and large sensors, scanners.
const PIXEL_SIZES_UM: [f64; 30] = [
    1.5, 1.55, 2.0, 2.4, 3.2, 3.3, 3.76, 3.9, 4.0, 4.4, 4.6, 4.8, 5.2, 5.6, 6.0, 6.4, 6.8, 7.0,
    7.2, 7.5, 8.0, 9.0, 10.0, 12.0, 12.5, 14.0, 15.0, 20.0, 25.0, 30.0,
];
