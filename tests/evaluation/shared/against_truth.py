"""How well the half-planes and lines of one result agree with the truth and with the standard deviations that they state, for
score_table.py. Needs numpy and shapely."""
import json
import math
import pathlib

import numpy as np

from shared.on_scenes import loaded, move_to_truth

# A half-plane is compared with the facet under it this far from its line, metres in the plane.
BESIDE_M = 1.2
# ... if the line lies within this height of the facet's plane.
ON_PLANE_M = 0.5
# A line farther from a true edge than this is hardly an inexact one, but another line, such as a row of tiles. score.py
# takes 0.25 m, eight pixels of the finest images.
NEAR_PX = 3


def angles(scorer, scene, out):
    """Angles in degrees between half-planes on roofs and the true facets under them, with their sigma, and the number of
    all half-planes."""
    from shapely.geometry import Point

    score = loaded(scorer / 'score.py')
    facets, origin = score.read_truth(str(scene))
    scene, out = pathlib.Path(scene), pathlib.Path(out)
    half_planes = json.loads((out / 'halfplanes.json').read_text())['half_planes']
    lines = {line['id']: line for line in json.loads((out / 'lines.json').read_text())['lines']}
    middle = np.mean([(f.poly.centroid.x, f.poly.centroid.y) for f in facets], axis=0)
    move = np.array(move_to_truth(median_start(lines.values()), middle, origin))
    found = []
    for half_plane in half_planes:
        line = lines[half_plane['line']]
        p, q = (np.array(line[end]) + move for end in ('p0', 'p1'))
        along = (q - p) / max(np.linalg.norm(q - p), 1e-9)
        normal = np.array(half_plane['plane'][:3])
        left = np.cross([0.0, 0.0, 1.0], along)
        outward = left if half_plane['side'] == 'left' else -left
        away = np.cross(normal, along)
        away *= np.sign(away @ outward)
        middle = 0.5 * (p + q)
        beside = middle + BESIDE_M * away
        for facet in facets:
            on_plane = abs(facet.z(middle[0], middle[1]) - middle[2]) < ON_PLANE_M
            if on_plane and facet.poly.distance(Point(beside[0], beside[1])) < 0.01:
                angle = np.degrees(np.arccos(min(1.0, abs(float(facet.n @ normal)))))
                found.append((float(angle), half_plane['sigma_theta_deg']))
                break
    return found, len(half_planes)


def errors_in_sigmas(scorer, scene, lines):
    """The error at each end of the lines on true roof edges (score.py's, but nearer), in the line's sigma_m.

    sigma_m is one standard deviation of the line's position at its worse end in the direction across the line in which it is
    worst. That direction is the one that points most nearly at the cameras: a line is shifted along the rays by a few times what
    it is shifted across them. So the error is taken in that one direction, at each end, to the true edge produced: 68 % should
    be within sigma_m if both ends are alike, and a few more as one of them is the better one. (Of the length of an error in two
    directions alike it would be 39 %.)
    """
    score = loaded(scorer / 'score.py')
    edges = json.loads((scene / 'truth' / 'edges.json').read_text())['edges']
    starts, ends = (np.array([edge[end] for edge in edges]) for end in ('p0', 'p1'))
    along = (ends - starts) / np.linalg.norm(ends - starts, axis=1, keepdims=True)
    cameras = json.loads((scene / 'cameras.json').read_text())
    centres = {view['file']: np.array(view['C']) for view in cameras['views']}
    middle = starts.mean(axis=0)
    pixel = float(np.mean([np.linalg.norm(np.array(v['C']) - middle) / v['K'][0][0] for v in cameras['views']]))
    near = min(NEAR_PX * pixel, score.LINE_DIST)
    move = np.array(move_to_truth(median_start(lines), middle, cameras.get('origin', [0, 0, 0])))
    found = []
    for line in lines:
        p, q = (np.array(line[end]) + move for end in ('p0', 'p1'))
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


def median_start(lines):
    return np.median([line['p0'] for line in lines], axis=0)
