"""How well the half-planes of one result agree with the truth (B99 4.4), for score_table.py. Needs numpy and shapely."""
import json
import pathlib
import sys

# A half-plane is compared with the facet under it this far from its line, metres in the plane.
BESIDE_M = 1.2
# ... if the line lies within this height of the facet's plane.
ON_PLANE_M = 0.5


def angles(scorer, scene, out):
    """Angles in degrees between half-planes on roofs and the true facets under them, with their sigma, and the number of
    all half-planes."""
    sys.path.insert(0, str(scorer))
    import numpy as np
    import score
    from shapely.geometry import Point

    facets, origin = score.read_truth(str(scene))
    scene, out = pathlib.Path(scene), pathlib.Path(out)
    half_planes = json.loads((out / 'halfplanes.json').read_text())['half_planes']
    lines = {line['id']: line for line in json.loads((out / 'lines.json').read_text())['lines']}
    shift = local_shift(np, facets, origin, lines)
    found = []
    for half_plane in half_planes:
        line = lines[half_plane['line']]
        p, q = (np.array(line[end]) - shift for end in ('p0', 'p1'))
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


def local_shift(np, facets, origin, lines):
    """The origin, where the result is in map coordinates and the truth is not."""
    middle = np.mean([(f.poly.centroid.x, f.poly.centroid.y) for f in facets], axis=0)
    median = np.median([line['p0'] for line in lines.values()], axis=0)[:2]
    far = np.linalg.norm(median - middle) > np.linalg.norm(median - origin[:2] - middle)
    return np.array(origin, float) if far else np.zeros(3)
