//! Trace of the sweep: `Sim(theta)` in total and per view (B99 figures 12 and 14), the points of
//! interest (figure 13b) and why a side has no half-plane.

use nalgebra::Point2;
use serde::{Deserialize, Serialize};

use super::posterior::Posterior;
use crate::base::ids::{LineId, ViewId};
use crate::lines::lines3d::Side;

/// Why a line side has no half-plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "snake_case")]
pub enum SweepRejection {
    /// The line lies on the ground.
    OnGround,
    /// A polygon of coplanar lines explains it (B99 5: "removing from consideration").
    Explained,
    /// The line is vertical.
    NoFrame,
    /// No view shows the whole line at a sufficient length.
    TooShort,
    /// Too little texture beside the line.
    NoPointsOfInterest,
    /// Too few views agree with the reference at any angle: occluded, or no plane.
    NoValidView,
    /// Sim grows up to the end of the interval, as beside a wall.
    AtIntervalEnd,
    /// `Sim(theta_max)` is too low.
    LowPeak,
    /// `|Sim''(theta_max)|` is too small.
    FlatCurve,
    /// `Sim(theta_max) - Sim(theta_min)` is too small.
    SmallAmplitude,
    /// The posterior probability of a plane there is too small.
    Improbable,
}

/// `Sim(theta)` of one view alone (B99 figure 14).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ViewCurve {
    /// The view that is compared with the reference.
    pub view: ViewId,
    /// Does it count in the total?
    pub valid: bool,
    /// Weighted mean of `Cor^2` at each theta, 0 to 1; 0 where the view does not see the half-plane
    /// or was not evaluated any more.
    pub similarity: Vec<f64>,
}

/// `Sim(theta)` of a line side (B99 figure 12).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SimilarityCurve {
    /// The first view of the homographies.
    pub reference: Option<ViewId>,
    /// Points of interest in the reference view, pixels.
    pub points: Vec<Point2<f64>>,
    /// Angles, radians, ascending.
    pub thetas: Vec<f64>,
    /// Sim over the valid views at each angle, 0 to 1.
    pub similarity: Vec<f64>,
    /// Each view alone.
    pub views: Vec<ViewCurve>,
    /// The posterior over theta at the samples.
    pub posterior: Posterior,
}

/// One side of one line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SideTrace {
    /// The line.
    pub line: LineId,
    /// Which side of it.
    pub side: Side,
    /// Why there is no half-plane; `None` when there is one.
    pub rejection: Option<SweepRejection>,
    /// The sampled curve.
    pub curve: SimilarityCurve,
}

/// The whole sweep.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SweepTrace {
    /// Two entries a line, left then right, in the order of the lines.
    pub sides: Vec<SideTrace>,
    /// Windows correlated in all (for correlations per second).
    pub correlations: u64,
    /// Strip pixels warped in all.
    pub warped_pixels: u64,
}

impl SweepTrace {
    /// Records a side that is not swept.
    pub(crate) fn reject(&mut self, line: LineId, side: Side, reason: SweepRejection) {
        self.sides.push(SideTrace {
            line,
            side,
            rejection: Some(reason),
            curve: SimilarityCurve::default(),
        });
    }
}
