"""How the errors of one result's matched lines compare with the sigma_m that lines.json states, for score_table.py. Needs numpy
and score.py.

sigma_m is one standard deviation of the line's position at its worse end in the direction across the line in which it is worst.
That direction is the one that points most nearly at the cameras: a line is shifted along the rays by a few times what it is shifted
across them. So the error is taken in that one direction, at each end, to the true edge produced: 68 % should be within sigma_m if both
ends are alike, and a few more as one of them is the better one. (Of the length of an error in two directions alike it would be 39 %.)
"""
import json
import math
import sys

# A line farther from a true edge than this is hardly an inexact one, but another line, such as a row of tiles. score.py
# takes 0.25 m, eight pixels of the finest images.
NEAR_PX = 3


def errors_in_sigmas(scorer, scene, lines):
    """The error at each end of the lines on true roof edges (score.py's, but nearer), in the line's sigma_m."""
    sys.path.insert(0, str(scorer))
    import numpy as np
    import score

    edges = json.loads((scene / 'truth' / 'edges.json').read_text())['edges']
    starts, ends = (np.array([edge[end] for edge in edges]) for end in ('p0', 'p1'))
    along = (ends - starts) / np.linalg.norm(ends - starts, axis=1, keepdims=True)
    cameras = json.loads((scene / 'cameras.json').read_text())
    centres = {view['file']: np.array(view['C']) for view in cameras['views']}
    middle = starts.mean(axis=0)
    pixel = float(np.mean([np.linalg.norm(np.array(v['C']) - middle) / v['K'][0][0] for v in cameras['views']]))
    near = min(NEAR_PX * pixel, score.LINE_DIST)
    shift = local_shift(np, middle, np.array(cameras.get('origin', [0, 0, 0]), float), lines)
    found = []
    for line in lines:
        p, q = (np.array(line[end]) - shift for end in ('p0', 'p1'))
        direction = (q - p) / max(np.linalg.norm(q - p), 1e-9)
        parallel = np.nonzero(np.abs(along @ direction) >= math.cos(math.radians(score.LINE_ANGLE)))[0]
        if not len(parallel):
            continue
        points = p + np.linspace(0, 1, max(5, int(np.linalg.norm(q - p) / 0.2) + 1))[:, None] * (q - p)
        distances = score.seg_dist(points, starts[parallel], ends[parallel])
        if (distances <= score.LINE_DIST).any(1).mean() < score.LINE_SHARE:
            continue
        edge = parallel[np.argmin(np.median(distances, axis=0))]

        def apart(point):
            offset = point - starts[edge]
            return offset - (offset @ along[edge]) * along[edge]

        if np.linalg.norm(apart((p + q) / 2)) > near:
            continue
        sight = np.mean([centres[view['view']] for view in line['views']], axis=0) - (p + q) / 2
        depth = sight - (sight @ direction) * direction
        depth /= np.linalg.norm(depth)
        found += [abs(float(apart(end) @ depth)) / line['sigma_m'] for end in (p, q)]
    return found


def local_shift(np, middle, origin, lines):
    """The origin, where the result is in map coordinates and the truth is not."""
    median = np.median([line['p0'] for line in lines], axis=0)
    far = np.linalg.norm((median - middle)[:2]) > np.linalg.norm((median - origin - middle)[:2])
    return origin if far else np.zeros(3)
