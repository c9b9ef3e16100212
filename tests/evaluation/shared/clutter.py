"""Fits src/base/evidence/clutter.json, how the heights at which views agree lie about a roof, to rendered scenes with truth.

The windows inside every true facet are compared in all views at heights from 1.2 m below it to 1.6 m above. Numbers of
the table are those under which the true height is likeliest among all (src/roofs/buildings/parapets.rs has the model); a tenth
of the facets may be beyond it. The share of rims stays as it is: it counts what was found, not what is true.
"""
import itertools
import json
import sys

import numpy as np
from PIL import Image
from scipy.ndimage import map_coordinates, uniform_filter
from shapely import contains_xy
from shapely.geometry import Polygon

# As in src/planes/photoconsistency: cells of a window's side, and their width, metres.
WINDOW, STEP_M = 11, 0.08
HEIGHTS = np.arange(-1.2, 1.61, 0.1)
# Heights that count as the right one.
RIGHT = np.abs(HEIGHTS) < 0.15
LEAST_AREA_M2, MOST_WINDOWS = 15.0, 1500
# Values that are tried.
PIXELS, ABOVE, ELSEWHERE = (3.5, 5.0, 7.0, 10.0, 14.0, 20.0), (0.2, 0.3, 0.4, 0.5, 0.6), (0.01, 0.02, 0.03, 0.05, 0.1)
REACH_M = (0.7, 0.9, 1.1, 1.3)


def correlations(views, polygon, holes):
    """Mean of the better half of the pairwise correlations by height and window, and how many windows there are."""
    ring = np.array(polygon)
    a, b, c = np.linalg.lstsq(np.c_[ring[:, :2], np.ones(len(ring))], ring[:, 2], rcond=None)[0]
    x, y = np.meshgrid(*(np.arange(ring[:, k].min(), ring[:, k].max(), STEP_M) for k in (0, 1)))
    inside = Polygon(ring[:, :2], [np.array(h)[:, :2] for h in holes]).buffer(-0.5 * WINDOW * STEP_M)
    middles = np.flatnonzero(contains_xy(inside, x, y))
    if len(middles) == 0:
        return None
    kept = np.random.default_rng(1).permutation(middles)[:MOST_WINDOWS]
    by_height = []
    for height in HEIGHTS:
        windows = [window_moments(sampled(view, x, y, a * x + b * y + c + height)) for view in views]
        pairs = np.array([correlation(u, v, kept) for u, v in itertools.combinations(windows, 2)])
        better = -np.sort(-np.nan_to_num(pairs, nan=-1.0), axis=0)[: (len(pairs) + 1) // 2]
        by_height.append(better.mean(axis=0))
    return np.array(by_height), len(middles)


def sampled(view, x, y, z):
    """Grey values of a view at points in space; NaN outside of it."""
    k, r, centre, grey = view
    image = (np.stack([x, y, z], -1) - centre) @ r.T @ k.T
    at = [image[..., 1] / image[..., 2] - 0.5, image[..., 0] / image[..., 2] - 0.5]
    return map_coordinates(grey, at, order=1, cval=np.nan)


def window_moments(grey):
    mean = uniform_filter(grey, WINDOW)
    return grey, mean, uniform_filter(grey * grey, WINDOW) - mean * mean


def correlation(u, v, kept):
    covariance = uniform_filter(u[0] * v[0], WINDOW) - u[1] * v[1]
    with np.errstate(invalid='ignore'):
        return (covariance / np.sqrt(u[2] * v[2] + 1e-9)).flat[kept]


def support(facet, pixels, above, elsewhere, reach_m):
    """What the windows of a facet say of every height, nats."""
    by_height, windows, views = facet
    nats = -0.5 * pixels * views * np.log(1 - np.clip(by_height, 0, 0.99) ** 2)
    likelihood = np.exp(nats - nats.max(axis=0))
    likelihood /= likelihood.mean(axis=0)
    reach = round(reach_m / (HEIGHTS[1] - HEIGHTS[0]))
    said = [np.log((1 - above - elsewhere) * likelihood[k] + above * likelihood[k + 1:k + 1 + reach].mean(axis=0) + elsewhere).mean()
            for k in range(len(HEIGHTS) - reach)]
    return np.array(said) * windows / WINDOW**2


def loss(facets, *numbers):
    """Mean of -ln of the probability of the right height."""
    def one(facet):
        said = support(facet, *numbers)
        probability = np.exp(said - said.max())
        probability = 0.9 * probability / probability.sum() + 0.1 / len(said)
        return -np.log(probability[RIGHT[: len(said)]].sum())
    return sum(map(one, facets)) / len(facets)


def fitted(facets):
    return min((loss(facets, *numbers), *numbers) for numbers in itertools.product(PIXELS, ABOVE, ELSEWHERE, REACH_M))


def facets_of(scene):
    cameras = json.loads((scene / 'cameras.json').read_text())['views']
    views = [(np.array(v['K']), np.array(v['R']), np.array(v['C']), np.asarray(Image.open(scene / 'images' / v['file']).convert('L'), float))
             for v in cameras]
    for building in json.loads((scene / 'truth' / 'roofs.json').read_text())['buildings']:
        for face in building['faces']:
            found = correlations(views, face['polygon'], face['holes']) if face['area_m2'] >= LEAST_AREA_M2 else None
            if found:
                yield (*found, len(views))


def table(scenes, before):
    """How many facets there are, in words, and the table; `before` is the present one."""
    facets = []
    for scene in scenes:
        facets.extend(facets_of(scene))
        print(scene.name, len(facets), 'facets so far', file=sys.stderr, flush=True)
    now = loss(facets, *(before[name] for name in ('pixels', 'above', 'elsewhere', 'highest_m')))
    best, pixels, above, elsewhere, highest_m = fitted(facets)
    print(f'loss {now:.3f} -> {best:.3f} nats a facet')
    found = {'pixels': pixels, 'above': above, 'elsewhere': elsewhere, 'highest_m': highest_m, 'rims': before['rims']}
    return f'windows inside {len(facets)} true facets', found


def self_test():
    """Roofs with weak texture and much that stands on them are found, and better than if nothing stood on roofs."""
    random = np.random.default_rng(7)

    def facet():
        stands = random.random(200) < 0.6
        shown = np.where(stands, random.uniform(0.4, 0.7, 200), 0.0)
        agree = np.where(stands, 0.8, 0.5) * np.exp(-0.5 * ((HEIGHTS[:, None] - shown) / 0.25) ** 2)
        return agree + random.normal(0, 0.1, agree.shape), 500, 3
    facets = [facet() for _ in range(40)]
    _, *numbers = fitted(facets)
    assert all(RIGHT[support(f, *numbers).argmax()] for f in facets)
    pixels, _, elsewhere, reach_m = numbers
    assert loss(facets, *numbers) < loss(facets, pixels, 0.0, elsewhere, reach_m), 'what stands on roofs explains nothing'
    print('planted roofs are found below what stands on them')
