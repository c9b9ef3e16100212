//! Levenberg's and Marquardt's steps, of every problem.

/// First damping: almost Gauss's and Newton's steps, for starts are good.
const FIRST_DAMPING: f64 = 1e-6;
/// Bounds of the damping: below the first one nothing changes, above the other no step moves
/// anything.
const LEAST_DAMPING: f64 = 1e-10;
const MOST_DAMPING: f64 = 1e6;
/// Factor of the damping after a step that costs more, and divisor after one that does not.
const DAMPING_FACTOR: f64 = 10.0;

/// What is minimised.
pub(crate) trait Problem {
    /// The unknowns, with what is kept of them.
    type State;

    /// What a state costs.
    fn cost(&self, state: &Self::State) -> f64;

    /// The state that a damped step leads to; `None` where the equations are singular or no
    /// residuals are defined there.
    fn stepped(&mut self, from: &Self::State, damping: f64) -> Option<Self::State>;
}

/// When the steps end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    /// Most steps, with those that were not taken.
    pub steps: usize,
    /// A step that changes the cost by less than this share of 1 + cost is the last one.
    pub least_gain: f64,
}

impl Default for Stop {
    /// A millionth of a standard deviation squared changes no digit of use, and a good start needs
    /// fewer than ten steps.
    fn default() -> Self {
        Self {
            steps: 20,
            least_gain: 1e-6,
        }
    }
}

/// How the steps went.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Statistics {
    /// The cost after them.
    pub cost: f64,
    /// Steps that were taken.
    pub steps: usize,
    /// Steps that were not, for the cost would have risen.
    pub invalid_steps: usize,
    /// The damping of the next step.
    pub damping: f64,
}

/// The state of least cost near a start.
pub(crate) fn minimise<P: Problem>(
    problem: &mut P,
    start: P::State,
    stop: Stop,
) -> (P::State, Statistics) {
    let mut state = start;
    let mut done = Statistics {
        cost: problem.cost(&state),
        steps: 0,
        invalid_steps: 0,
        damping: FIRST_DAMPING,
    };
    while done.steps + done.invalid_steps < stop.steps && done.damping <= MOST_DAMPING {
        let next = problem.stepped(&state, done.damping);
        let cost = next
            .as_ref()
            .map_or(f64::INFINITY, |next| problem.cost(next));
        let gain = done.cost - cost;
        match next {
            // NaN fails the comparison.
            Some(next) if gain >= 0.0 => {
                (state, done.cost) = (next, cost);
                done.steps += 1;
                done.damping = (done.damping / DAMPING_FACTOR).max(LEAST_DAMPING);
            }
            _ => {
                done.invalid_steps += 1;
                done.damping *= DAMPING_FACTOR;
            }
        }
        // At the minimum, rounding may let the cost rise.
        if gain.abs() <= stop.least_gain * (1.0 + done.cost) {
            break;
        }
    }
    (state, done)
}

/// Residuals made linear at some unknowns.
pub(crate) trait Equations {
    /// A step of the unknowns.
    type Step;

    /// What the unknowns cost.
    fn cost(&self) -> f64;

    /// The damped step; `None` where the equations are singular.
    fn step(&self, damping: f64) -> Option<Self::Step>;
}

/// The unknowns of least cost near a start, and the equations there, for a problem whose residuals
/// are `linearised` wherever they are asked for; `None` where they are not defined at the start.
pub(crate) fn fit<U, L: Equations>(
    start: U,
    linearised: impl Fn(&U) -> Option<L>,
    moved: impl Fn(&U, &L::Step) -> U,
    stop: Stop,
) -> Option<(U, L)> {
    let at = |unknowns: U| {
        let equations = linearised(&unknowns)?;
        Some((unknowns, equations))
    };
    let stepped = |(from, equations): &(U, L), damping: f64| {
        let step = equations.step(damping)?;
        at(moved(from, &step))
    };
    let mut problem = ByEquations {
        stepped,
        state: std::marker::PhantomData,
    };
    Some(minimise(&mut problem, at(start)?, stop).0)
}

/// A problem whose state is the unknowns and the equations there.
struct ByEquations<F, S> {
    stepped: F,
    state: std::marker::PhantomData<S>,
}

impl<U, L: Equations, F: Fn(&(U, L), f64) -> Option<(U, L)>> Problem for ByEquations<F, (U, L)> {
    type State = (U, L);

    fn cost(&self, (_, equations): &(U, L)) -> f64 {
        equations.cost()
    }

    fn stepped(&mut self, from: &(U, L), damping: f64) -> Option<(U, L)> {
        (self.stepped)(from, damping)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix1x2, Vector1, Vector2};

    use super::super::{Loss, NormalEquations, worst_derivative};
    use super::*;

    /// The two residuals of Rosenbrock's valley, and their derivatives.
    fn valley(at: &Vector2<f64>) -> [(Vector1<f64>, Matrix1x2<f64>); 2] {
        [
            (
                Vector1::new(10.0 * (at.y - at.x * at.x)),
                Matrix1x2::new(-20.0 * at.x, 10.0),
            ),
            (Vector1::new(1.0 - at.x), Matrix1x2::new(-1.0, 0.0)),
        ]
    }

    fn linearised(at: &Vector2<f64>) -> Option<NormalEquations<2>> {
        let mut equations = NormalEquations::default();
        for (r, j) in valley(at) {
            equations.add(&r, &j, Loss::Squares);
        }
        Some(equations)
    }

    /// The valley by `minimise` itself, where only some places have residuals.
    struct Valley;

    impl Problem for Valley {
        type State = Vector2<f64>;

        fn cost(&self, at: &Vector2<f64>) -> f64 {
            linearised(at).map_or(0.0, |equations| equations.cost())
        }

        fn stepped(&mut self, from: &Vector2<f64>, damping: f64) -> Option<Vector2<f64>> {
            let to = from + linearised(from)?.step(damping)?;
            (to.norm() < 3.0).then_some(to)
        }
    }

    #[test]
    fn the_bottom_of_a_bent_valley_is_found() {
        let start = Vector2::new(-1.2, 1.0);
        for (row, (_, jacobian)) in valley(&start).iter().enumerate() {
            let off = worst_derivative(jacobian, |step| valley(&(start + step))[row].0);
            assert!(off < 1e-8, "{off}");
        }
        let stop = Stop {
            steps: 100,
            least_gain: 1e-12,
        };
        let (found, equations) =
            fit(start, linearised, |at, step| at + step, stop).expect("residuals everywhere");
        assert!((found - Vector2::new(1.0, 1.0)).norm() < 1e-6, "{found}");
        assert!(equations.cost() < 1e-12);
        let (found, done) = minimise(&mut Valley, start, stop);
        assert!((found - Vector2::new(1.0, 1.0)).norm() < 1e-6, "{found}");
        assert!(
            done.cost < 1e-12 && done.invalid_steps > 0 && done.steps < 40,
            "{done:?}"
        );
    }

    #[test]
    fn what_is_at_the_bottom_stays() {
        let bottom = Vector2::new(1.0, 1.0);
        let (found, done) = minimise(&mut Valley, bottom, Stop::default());
        assert_eq!((found, done.steps), (bottom, 1));
    }
}
