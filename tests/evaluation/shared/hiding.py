"""Fits src/base/evidence/hiding.json, what a colour that differs from the other views says, to rendered scenes with truth.

The views are drawn onto the plane of every true facet, as src/roofs/obstructions/surface.rs does it. The surface model tells
what stands on the facet, and so which cells it hides in each view; what is near to those is left out. How heights are off stays
as it is: it is fitted to what was found.
"""
import json
import sys
import warnings

import numpy as np
from PIL import Image
from scipy.ndimage import binary_dilation, gaussian_filter, map_coordinates
from shapely import contains_xy
from shapely.geometry import Polygon

LEAST_AREA_M2, LEAST_NOISE, BLUR, INSIDE_M = 9.0, 2.0, 0.7, 0.5
# Classes of differences, standard deviations, and the heights of what stands on a roof, metres.
CLASSES = np.array([0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 7, 10, 15, np.inf])
LEAST_M, HEIGHTS_M = 0.25, np.arange(0, 2.6, 0.15)
# At which heights roofs hide it, metres above it.
ROOFS_M = np.arange(2.75, 9.1, 0.5)
# How far errors of neighbours are compared, cells, and from how many cells on.
REACH, MOST_TOLD = 6, 2000


def differences(colours, inside):
    """By view and cell, how far a colour is from that of most views, standard deviations; NaN where too few show it."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore')
        common = np.nanmedian(colours, axis=0)
        for _ in range(2):
            gains = np.array([[np.nanmedian((view[..., c] / common[..., c])[inside]) for c in range(3)] for view in colours])
            common = np.nanmedian(colours / gains[:, None, None, :], axis=0)
        off = np.sqrt(np.nanmean((colours / gains[:, None, None, :] - common) ** 2, axis=-1))
    shown = np.isfinite(colours[..., 0]).sum(axis=0) >= 3
    told = np.isfinite(off) & shown & inside
    if not told.any():
        return np.full(off.shape, np.nan)
    noise = max(1.4826 * np.median(off[told]), LEAST_NOISE)
    changes = np.gradient(gaussian_filter(np.nan_to_num(common.mean(-1)), BLUR))
    return np.where(told, off / np.sqrt(noise**2 + changes[0] ** 2 + changes[1] ** 2), np.nan)


def facet_of(views, surface, polygon, holes):
    """Differences, cells that something hides, and others, of a true facet; `None` where it is small."""
    ring = np.array(polygon)
    plan = Polygon(ring[:, :2], [np.array(h)[:, :2] for h in holes])
    a, b, c = np.linalg.lstsq(np.c_[ring[:, :2], np.ones(len(ring))], ring[:, 2], rcond=None)[0]
    middle = np.append(plan.centroid.coords[0], 0)
    middle[2] = a * middle[0] + b * middle[1] + c
    step = min(np.linalg.norm(centre - middle) / k[0, 0] for k, _, centre, _ in views)
    low_x, low_y, high_x, high_y = plan.bounds
    x, y = np.meshgrid(np.arange(low_x, high_x, step), np.arange(low_y, high_y, step))
    z, inside = a * x + b * y + c, contains_xy(plan, x, y)
    colours, hides = [], []
    rises = np.where(inside, heights_at(surface, x, y) - z, 0)
    normal = np.array([-a, -b, 1])
    for k, r, centre, rgb in views:
        image = (np.stack([x, y, z], -1) - centre) @ r.T @ k.T
        at = [image[..., 1] / image[..., 2] - 0.5, image[..., 0] / image[..., 2] - 0.5]
        colour = np.stack([map_coordinates(rgb[..., i], at, order=1, cval=np.nan) for i in range(3)], -1)
        for h in ROOFS_M:
            share = h / (centre[2] - z)
            colour[heights_at(surface, x + (centre[0] - x) * share, y + (centre[1] - y) * share) > z + h] = np.nan
        colours.append(colour)
        ray = middle + [0, 0, 1] - centre
        lean = (centre + normal @ (middle - centre) / (normal @ ray) * ray - middle)[:2] / step
        hides.append(np.any([shifted(rises > max(h, LEAST_M), *np.round(lean * h).astype(int)) for h in HEIGHTS_M], axis=0))
    told, hides = differences(np.array(colours), inside), np.array(hides)
    deep = contains_xy(plan.buffer(-INSIDE_M), x, y)
    near = np.array([binary_dilation(view, iterations=3) for view in hides])
    # Below another roof the plane is seen nowhere.
    return None if (rises[deep] < -0.3).any() else (told, hides & deep, ~near & deep)


def heights_at(surface, x, y):
    """Heights of a surface model at places in plan."""
    rows, columns = surface['z'].shape
    column, row = (((v - surface[start]) / surface['cell']).astype(int).clip(0, size - 1)
                   for v, start, size in ((x, 'x0', columns), (y, 'y0', rows)))
    return surface['z'][row, column]


def shifted(mask, right, down):
    """A mask moved by whole cells."""
    out, (rows, columns) = np.zeros_like(mask), mask.shape
    if abs(right) < columns and abs(down) < rows:
        to = np.s_[max(0, down):rows + min(0, down), max(0, right):columns + min(0, right)]
        out[to] = mask[max(0, -down):rows - max(0, down), max(0, -right):columns - max(0, right)]
    return out


def fitted(facets):
    """How many cells there are of both kinds, and the table."""
    counts, sums, alike = np.zeros((2, len(CLASSES) - 1)), np.zeros(len(CLASSES) - 1), []
    for told, hidden, seen in facets:
        for kind, of in enumerate((hidden, seen)):
            values = told[of & np.isfinite(told)]
            counts[kind] += np.histogram(values, CLASSES)[0]
            sums += np.histogram(values, CLASSES, weights=values)[0]
    shares = (counts + 1) / counts.sum(axis=1, keepdims=True)
    knots = sums / counts.sum(axis=0)
    nats = np.maximum.accumulate(np.log(shares[0] / shares[1]))
    for told, _, seen in facets:
        for view, of in zip(told, seen):
            of = of & np.isfinite(view)
            if of.sum() > MOST_TOLD:
                said = np.where(of, np.interp(np.nan_to_num(view), knots, nats), np.nan)
                said -= np.nanmean(said)
                steps = [(i, j) for i in range(-REACH, REACH + 1) for j in range(-REACH, REACH + 1)]
                pairs = (np.nanmean(said * np.roll(said, step, (0, 1))) for step in steps)
                alike.append(np.nanmean(said**2) / sum(pairs))
    table = {'name': 'standard_deviations', 'knots': knots.round(2).tolist(), 'nats': nats.round(2).tolist()}
    return counts.sum(axis=1).astype(int), {'independent': round(float(np.median(alike)), 2), 'difference': table}


def table(scenes, before):
    """How many cells there are, in words, and the table; `before` is the present one."""
    facets = []
    for scene in scenes:
        cameras = json.loads((scene / 'cameras.json').read_text())['views']
        views = [(np.array(v['K']), np.array(v['R']), np.array(v['C']),
                  np.asarray(Image.open(scene / 'images' / v['file']).convert('RGB'), np.float32)) for v in cameras]
        heights = np.load(scene / 'truth' / 'dsm.npz')
        surface = {k: float(heights[k]) for k in ('x0', 'y0', 'cell')}
        surface['z'] = heights['z'].astype(float) + float(heights['z0'])
        for building in json.loads((scene / 'truth' / 'roofs.json').read_text())['buildings']:
            for face in building['faces']:
                if face['area_m2'] >= LEAST_AREA_M2 and not face['minor']:
                    facets.append(facet_of(views, surface, face['polygon'], face['holes']))
        print(scene.name, len(facets), 'facets so far', file=sys.stderr, flush=True)
    (hidden, seen), found = fitted([facet for facet in facets if facet])
    kept = {name: before[name] for name in ('height_floor_m', 'height_scale')}
    return f'{hidden} cells that something hides and {seen} others of true facets', {**found, **kept}


def self_test():
    """What hides a roof differs from it, and the nats say so."""
    random = np.random.default_rng(7)
    seen = np.abs(random.normal(size=(4, 80, 80)))
    hidden = np.zeros_like(seen, bool)
    hidden[:, 30:40, 30:45] = True
    told = np.where(hidden, np.abs(random.normal(0, 6, seen.shape)), seen)
    (count, others), found = fitted([(told, hidden, ~hidden)])
    nats = found['difference']['nats']
    assert (count, others) == (600, 25000) and nats == sorted(nats), found
    assert nats[0] < -0.5 and nats[-3] > 3 and 0.5 < found['independent'] <= 1.5, found
    moved = shifted(hidden[0], 3, -2)
    assert moved[28:38, 33:48].all() and moved.sum() == hidden[0].sum()
