"""Additive logistic models (Hastie and Tibshirani 1986) whose curves are piecewise linear, for calibrate.py.

    ln odds = prior + f_1(x_1) + f_2(x_2) + ...

A curve may be bound to rise or to fall: its increments from knot to knot have one sign. Needs numpy and scipy.
"""
import numpy as np
from scipy.optimize import minimize

# Knots of a curve: at quantiles of its feature, from the first to the last of these.
KNOTS, FIRST, LAST, DIGITS = 6, 0.02, 0.98, 3
# Penalties on the square of a curve, of its differences from knot to knot, and of the differences of these. They are small
# against a few hundred candidates, and draw a curve that nothing speaks for to a level one.
RIDGE, STEPS, BENDS = 0.1, 0.4, 3.0
FOLDS, BINS = 8, 10


def knots_of(x):
    """A feature of few values has fewer knots."""
    knots = np.unique(np.round(np.quantile(x, np.linspace(FIRST, LAST, KNOTS)), DIGITS))
    return knots if len(knots) > 1 else np.array([knots[0], knots[0] + 1])


def hats(x, knots):
    """Of each value the shares of the two knots between which it lies; beyond the ends those of the last one."""
    x = np.clip(x, knots[0], knots[-1])
    below = np.clip(np.searchsorted(knots, x, side='right') - 1, 0, len(knots) - 2)
    t = (x - knots[below]) / (knots[below + 1] - knots[below])
    shares = np.zeros((len(x), len(knots)))
    shares[np.arange(len(x)), below] = 1 - t
    shares[np.arange(len(x)), below + 1] += t
    return shares


def fit(features, true, weights, signs):
    """The prior and, for each feature, its knots and their nats; `signs` names the features and says which way they may go."""
    curves = {name: knots_of(features[name]) for name in signs}
    columns, penalties, bounds = [np.ones((len(true), 1))], [np.zeros((1, 1))], [(None, None)]
    sums = {}
    for name, sign in signs.items():
        count = len(curves[name])
        # From the first value and the increments to the values.
        sums[name] = np.tril(np.ones((count, count)))
        differences = [np.eye(count), *(np.diff(np.eye(count), n, axis=0) for n in (1, 2) if n < count)]
        penalty = sum(p * d.T @ d for p, d in zip((RIDGE, STEPS, BENDS), differences))
        columns.append(hats(features[name], curves[name]) @ sums[name])
        penalties.append(sums[name].T @ penalty @ sums[name])
        increments = {1: (0, None), -1: (None, 0), 0: (None, None)}[sign]
        bounds += [(None, None)] + (count - 1) * [increments]
    design = np.hstack(columns)
    penalty = np.zeros((design.shape[1],) * 2)
    at = 0
    for block in penalties:
        penalty[at:at + len(block), at:at + len(block)] = block
        at += len(block)

    def loss(b):
        odds = design @ b
        residual = weights * (1 / (1 + np.exp(-np.clip(odds, -500, 500))) - true)
        value = weights @ (np.logaddexp(0, odds) - true * odds) + b @ penalty @ b / 2
        return value, design.T @ residual + penalty @ b

    b = minimize(loss, np.zeros(design.shape[1]), jac=True, method='L-BFGS-B', bounds=bounds,
                 options={'maxiter': 5000, 'maxfun': 20000, 'ftol': 1e-11, 'gtol': 1e-6}).x
    prior, at, model = b[0], 1, {}
    for name, knots in curves.items():
        nats = sums[name] @ b[at:at + len(knots)]
        mean = (hats(features[name], knots) @ nats).mean()
        model[name], prior, at = (knots, nats - mean), prior + mean, at + len(knots)
    return prior, model


def odds_of(model, features):
    """Logarithms of the odds."""
    prior, curves = model
    return prior + sum(hats(features[name], knots) @ nats for name, (knots, nats) in curves.items())


def cross_validated(features, true, weights, signs, groups):
    """The odds that each group is given by a model of other groups."""
    names = sorted(set(groups))
    np.random.RandomState(0).shuffle(names)
    odds = np.zeros(len(true))
    for fold in range(FOLDS):
        out = np.isin(groups, names[fold::FOLDS])
        if out.all():
            raise SystemExit('candidates of two scenes at least are needed')
        if out.any():
            model = fit({n: x[~out] for n, x in features.items()}, true[~out], weights[~out], signs)
            odds[out] = odds_of(model, {n: x[out] for n, x in features.items()})
    return odds


def area_under_curve(true, odds):
    """Probability that a true candidate has better odds than a false one; those of equal odds count half."""
    values, places = np.unique(odds, return_inverse=True)
    positive, negative = (np.bincount(places, of, len(values)) for of in (true, 1 - true))
    below = np.cumsum(negative) - negative
    return float(positive @ (below + negative / 2) / max(positive.sum() * negative.sum(), 1e-9))


def reliability(true, odds):
    """For each bin of the probability that holds any: the number, their mean probability, and the share of true ones."""
    probability = 1 / (1 + np.exp(-np.clip(odds, -500, 500)))
    of_bin = np.minimum((BINS * probability).astype(int), BINS - 1)
    inside = [of_bin == k for k in range(BINS)]
    return [(int(i.sum()), float(probability[i].mean()), float(true[i].mean())) for i in inside if i.any()]


def calibration_error(true, odds):
    """Expected calibration error: the mean distance of stated probabilities from shares of true ones."""
    bins = reliability(true, odds)
    return sum(n * abs(stated - share) for n, stated, share in bins) / len(true)


def self_test():
    """Plants curves, draws candidates, and recovers the curves and the calibration error."""
    random = np.random.RandomState(1)
    count = 8000
    planted = {'rising': lambda x: 3 * np.tanh(2 * x), 'falling': lambda x: -1.5 * x, 'idle': lambda x: 0 * x,
               'bent': lambda x: 1.5 * np.abs(x) - 0.75}
    signs = {'rising': 1, 'falling': -1, 'idle': 1, 'bent': 0}
    features = {name: random.uniform(-1, 1, count) for name in planted}
    odds = 0.7 + sum(curve(features[name]) for name, curve in planted.items())
    true = (random.uniform(size=count) < 1 / (1 + np.exp(-odds))).astype(float)
    groups = random.randint(0, 20, count)
    weights = np.ones(count)
    model = fit(features, true, weights, signs)
    x = np.linspace(-0.9, 0.9, 50)
    for name, curve in planted.items():
        knots, nats = model[1][name]
        centred = curve(x) - curve(features[name]).mean()
        off = np.abs(hats(x, knots) @ nats - centred).max()
        assert off < 0.4, f'{name}: {off:.2f} nats off'
        assert (signs[name] * np.diff(nats) >= 0).all(), f'{name} goes the wrong way: {nats}'
    # Bound to rise, what falls is level.
    wrong = fit(features, true, weights, {**signs, 'falling': 1})
    assert np.abs(wrong[1]['falling'][1]).max() < 0.1, wrong[1]['falling']
    stated = cross_validated(features, true, weights, signs, groups)
    assert area_under_curve(true, stated) > area_under_curve(true, odds) - 0.005
    assert calibration_error(true, stated) < 0.02, calibration_error(true, stated)
    # Stated too surely by half, in probabilities near 0.2 and 0.8 and by as much.
    assert calibration_error(true, 3 * odds) > 0.06, calibration_error(true, 3 * odds)
    assert abs(area_under_curve(np.array([0, 1, 0, 1.0]), np.array([0, 1, 1, 2.0])) - 0.875) < 1e-9
    even = np.array([0.0, 1.0])
    assert abs(calibration_error(even, np.log(np.array([4.0, 4.0]))) - 0.3) < 1e-9, 'four to one stated, even odds drawn'
    print('calibrate: curves, their signs and the calibration error are recovered')
    return 0
