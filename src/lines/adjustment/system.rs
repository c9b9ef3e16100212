//! The normal equations of the adjustment. Lines are eliminated by the Schur complement: for every
//! set of poses each line is fitted anew ([`fit_line`]), and the step of a pose takes the lines
//! along.
//!
//! Rotating and shifting a camera changes the image of a line as the inverse motion of the line
//! does. The derivatives by the pose are therefore those by the four parameters of the line, times
//! D (4 x 6), the effect of the motion on its two anchors across it.
//!
//! ```text
//! X - C  ->  (X - C) - shift - turn x (X - C)
//! ```

use nalgebra::{Matrix4, Matrix4x6, Matrix6x2, Matrix6x4, Point2, Vector2, Vector3, Vector6};

use super::pose::PoseChange;
use crate::base::execution::parallel;
use crate::base::geometry::Segment3;
use crate::base::least_squares::{EnvelopeEquations, Loss, Pattern, Stop, fit};
use crate::base::params::Lines3dParams;
use crate::lines::lines2d::GuidedEdge;
use crate::lines::lines3d::{
    Line3d, Observation, ProjectedLine, WhitenedObservation, fit_line, line_frame,
};
use crate::photographs::camera::Camera;

/// Prior standard deviation of the effect of a rotation, and of a shift, on the image, pixels:
/// small enough to separate the two, large enough to correct errors of several pixels.
const PRIOR_PX: f64 = 5.0;

/// Each step fits all lines anew, and what it gains is compared with hundredths of the cost.
const STOP: Stop = Stop {
    steps: 6,
    least_gain: 1e-4,
};

/// Fewest edges of a line: two interpretation planes always meet in a line.
const FEWEST_EDGES: usize = 3;

/// A line and its edges.
struct EdgeTrack {
    line: Segment3,
    edges: Vec<GuidedEdge>,
}

/// All lines with their edges.
pub(crate) struct BundleAdjustment<'a> {
    tracks: Vec<EdgeTrack>,
    views: usize,
    params: &'a Lines3dParams,
}

/// Poses and the lines that fit them.
#[derive(Clone)]
pub(crate) struct AdjustmentState {
    /// Views that may move.
    pub free: Vec<usize>,
    /// Changes of the poses of all views.
    pub changes: Vec<PoseChange>,
    /// The lines; `None` where none fits.
    lines: Vec<Option<Segment3>>,
    /// The minimised sum.
    pub cost: f64,
}

impl<'a> BundleAdjustment<'a> {
    pub(super) fn new(lines: &[Line3d], views: usize, params: &'a Lines3dParams) -> Self {
        let track = |line: &Line3d| {
            let edges: Vec<_> = (line.supports.iter())
                .filter_map(|s| s.edge.clone())
                .collect();
            let line = line.segment;
            (edges.len() >= FEWEST_EDGES).then_some(EdgeTrack { line, edges })
        };
        Self {
            tracks: lines.iter().filter_map(track).collect(),
            views,
            params,
        }
    }

    /// Number of edges of a view.
    pub(super) fn edges(&self, view: usize) -> usize {
        self.edges_of(view).count()
    }

    fn edges_of(&self, view: usize) -> impl Iterator<Item = (usize, &GuidedEdge)> {
        let tracks = self.tracks.iter().enumerate();
        let edges = tracks.flat_map(|(i, t)| t.edges.iter().map(move |e| (i, e)));
        edges.filter(move |(_, edge)| edge.view.index() == view)
    }

    /// The lines that fit these cameras, nothing being free.
    pub(super) fn state(&self, cameras: &[Camera]) -> AdjustmentState {
        let changes = vec![PoseChange::default(); self.views];
        self.fitted(cameras, Vec::new(), changes, None)
    }

    /// The same with one more view free.
    pub(super) fn freeing(
        &self,
        view: usize,
        from: &AdjustmentState,
        stated: &[Camera],
    ) -> AdjustmentState {
        let mut start = from.clone();
        start.free.push(view);
        let pattern = Pattern::dense(6 * start.free.len());
        let equations = |state: &AdjustmentState| Some(self.equations(state, stated, &pattern));
        let moved = |state: &AdjustmentState, step: &Vec<f64>| self.stepped(state, step, stated);
        let adjusted = fit(start, equations, moved, STOP);
        adjusted.expect("every state has equations").0
    }

    /// The state after a step of the free poses.
    fn stepped(&self, from: &AdjustmentState, step: &[f64], stated: &[Camera]) -> AdjustmentState {
        let mut changes = from.changes.clone();
        for (k, &view) in from.free.iter().enumerate() {
            changes[view].turn += Vector3::from_column_slice(&step[6 * k..6 * k + 3]);
            changes[view].shift_m += Vector3::from_column_slice(&step[6 * k + 3..6 * k + 6]);
        }
        self.fitted(stated, from.free.clone(), changes, Some(&from.lines))
    }

    /// Fits all lines to the changed poses and sums the cost.
    fn fitted(
        &self,
        stated: &[Camera],
        free: Vec<usize>,
        changes: Vec<PoseChange>,
        near: Option<&[Option<Segment3>]>,
    ) -> AdjustmentState {
        let cameras = moved(stated, &changes);
        let fits = parallel::map(&self.tracks, |i, track| {
            let start = near.and_then(|lines| lines[i]).unwrap_or(track.line);
            let fit = fit_line(&track.observations(&cameras), &start, self.params)?;
            let cost = fit
                .residuals
                .iter()
                .map(|r| self.loss().cost(r * r))
                .sum::<f64>();
            Some((fit.line, cost))
        });
        let mut cost = 0.0;
        for (fit, track) in fits.iter().zip(&self.tracks) {
            let none = || track.edges.len() as f64 * self.loss().cost(GROSS * GROSS);
            cost += fit.map_or_else(none, |f| f.1);
        }
        for &view in &free {
            let prior = self.prior(&stated[view]);
            let squares = pose(&changes[view]).component_mul(&pose(&changes[view]));
            cost += squares.dot(&prior);
        }
        AdjustmentState {
            free,
            changes,
            lines: fits.into_iter().map(|f| f.map(|f| f.0)).collect(),
            cost,
        }
    }

    fn loss(&self) -> Loss {
        Loss::Cauchy(self.params.loss_scale)
    }

    /// Weights of (turn, shift) of a view, 1 / rad^2 and 1 / m^2.
    fn prior(&self, camera: &Camera) -> Vector6<f64> {
        let focal_px = camera.k[(0, 0)].abs();
        let turn = focal_px / PRIOR_PX;
        let depths = self.tracks.iter().map(|t| camera.depth(&t.line.at(0.5)));
        let depth = crate::base::math::median(&mut depths.collect::<Vec<_>>()).unwrap_or(1.0);
        let shift = focal_px / (PRIOR_PX * depth.max(1e-6));
        Vector6::new(turn, turn, turn, shift, shift, shift).map(|w| w * w)
    }

    /// The normal equations of the free poses.
    fn equations<'p>(
        &self,
        state: &AdjustmentState,
        stated: &[Camera],
        pattern: &'p Pattern,
    ) -> EnvelopeEquations<'p> {
        let cameras = moved(stated, &state.changes);
        let mut equations = EnvelopeEquations::new(pattern);
        equations.cost = state.cost;
        for (track, line) in self.tracks.iter().zip(&state.lines) {
            if let Some(line) = line {
                self.add(track, line, &cameras, &state.free, &mut equations);
            }
        }
        for (k, &view) in state.free.iter().enumerate() {
            let weights = self.prior(&stated[view]);
            let pull = weights.component_mul(&pose(&state.changes[view]));
            for i in 0..6 {
                equations.matrix[(6 * k + i, 6 * k + i)] += weights[i];
                equations.gradient[6 * k + i] += pull[i];
            }
        }
        equations
    }

    /// Adds a line's part of the normal equations, the line itself eliminated.
    fn add(
        &self,
        track: &EdgeTrack,
        line: &Segment3,
        cameras: &[Camera],
        free: &[usize],
        equations: &mut EnvelopeEquations,
    ) -> Option<()> {
        let across = line_frame(&line.direction());
        let mut of_line = Matrix4::zeros();
        let mut of_poses: Vec<(usize, Matrix6x4<f64>)> = Vec::new();
        for (edge, seen) in track.edges.iter().zip(track.observations(cameras)) {
            let (r, j) = WhitenedObservation::new(&seen, self.params).residual(line, &across)?;
            let weight = self.loss().weight(r.norm_squared());
            of_line += j * j.transpose() * weight;
            let Some(k) = free.iter().position(|&v| v == edge.view.index()) else {
                continue;
            };
            let a: Matrix6x2<f64> = anchors_by_pose(line, &across, seen.camera).transpose() * j;
            let block = a * a.transpose() * weight;
            equations.matrix.add_block(6 * k, 6 * k, &block);
            for (g, pull) in equations.gradient[6 * k..]
                .iter_mut()
                .zip(&(a * r * weight))
            {
                *g += pull;
            }
            of_poses.push((k, a * j.transpose() * weight));
        }
        let inverse = of_line.try_inverse()?;
        for (k, a) in &of_poses {
            for (l, b) in of_poses.iter().filter(|(l, _)| l <= k) {
                let block = -(a * inverse * b.transpose());
                equations.matrix.add_block(6 * k, 6 * l, &block);
            }
        }
        Some(())
    }

    /// Shifts of the images of the lines in a view by its changed pose, pixels.
    pub(super) fn motions(
        &self,
        view: usize,
        stated: &[Camera],
        state: &AdjustmentState,
    ) -> Vec<Vector2<f64>> {
        let changed = state.changes[view].apply(&stated[view]);
        let motion = |(i, _): (usize, &GuidedEdge)| {
            let line = state.lines[i]?;
            Some(middle_of(&changed, &line)? - middle_of(&stated[view], &line)?)
        };
        self.edges_of(view).filter_map(motion).collect()
    }

    /// Distances of the middles of a view's edges from the images of their lines, pixels.
    pub(super) fn distances(
        &self,
        view: usize,
        cameras: &[Camera],
        state: &AdjustmentState,
    ) -> Vec<f64> {
        let distance = |(i, edge): (usize, &GuidedEdge)| {
            let image = ProjectedLine::new(&cameras[view], &state.lines[i]?)?;
            Some(image.distance(&edge.segment.midpoint()).abs())
        };
        self.edges_of(view).filter_map(distance).collect()
    }
}

/// Residual of an edge whose line cannot be fitted, standard deviations.
const GROSS: f64 = 10.0;

impl EdgeTrack {
    fn observations<'a>(&self, cameras: &'a [Camera]) -> Vec<Observation<'a>> {
        let seen = |edge: &GuidedEdge| Observation::of(edge, &cameras[edge.view.index()]);
        self.edges.iter().map(seen).collect()
    }
}

/// The middle of a segment's image.
fn middle_of(camera: &Camera, line: &Segment3) -> Option<Point2<f64>> {
    camera.project(&line.at(0.5))
}

fn moved(stated: &[Camera], changes: &[PoseChange]) -> Vec<Camera> {
    let pairs = stated.iter().zip(changes);
    pairs.map(|(camera, change)| change.apply(camera)).collect()
}

fn pose(change: &PoseChange) -> Vector6<f64> {
    let (t, s) = (&change.turn, &change.shift_m);
    Vector6::new(t.x, t.y, t.z, s.x, s.y, s.z)
}

/// D: how far the line's anchors move across it, as the camera sees them, for small (turn, shift).
fn anchors_by_pose(line: &Segment3, across: &[Vector3<f64>; 2], camera: &Camera) -> Matrix4x6<f64> {
    let mut d = Matrix4x6::zeros();
    for (i, anchor) in [line.p0, line.p1].iter().enumerate() {
        let ray = anchor - camera.center;
        for (j, u) in across.iter().enumerate() {
            let row = 2 * i + j;
            let turn = -ray.cross(u);
            d.fixed_view_mut::<1, 3>(row, 0)
                .copy_from(&turn.transpose());
            d.fixed_view_mut::<1, 3>(row, 3).copy_from(&-u.transpose());
        }
    }
    d
}
