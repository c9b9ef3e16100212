"""Height differences between the ends of lines that are level (B99 figure 9), for accuracy.py. Needs Python alone.

What is level must not be judged by the line itself, or its error would choose it. Where there is truth, a line is level if the
true edge that it lies at is: of all edges parallel to it in plan, the nearest one. On photographs a line is level that lies in a roof
plane of check/planes.json (fitted to tie points that know nothing of the lines) and runs along its contours in plan: an
eave, a ridge, a joint of the roofing. Steeper than STEEP_DEG it is something else (the edge of a dormer's side, of a chimney), whatever its
direction in plan; errors of lines are well below that.

The frame of photographs that were oriented by themselves is level to a degree only, and a degree is 17 cm over 10 m. The two
inclinations that suit the lines of all views best (sum of the absolute differences) are taken off on photographs.
"""
import math

# At an edge: parallel in plan, the middle beside it and above or below it, in ground pixels. The latter two as in accuracy.py.
PARALLEL_DEG, BESIDE_PX, ABOVE_PX = 3, 5, 10
# An edge is level that rises by less than this share of its length.
LEVEL = 0.002
# In a plane: near it, not beyond its roof, above the ground; along its contours. Directions of planes fitted to few points are
# uncertain by some degrees; what is next to level on a roof, a hip, is 30 degrees off.
IN_PLANE_M, ROOF_M, ABOVE_GROUND_M, CONTOUR_DEG, STEEP_DEG = 0.5, 20, 2, 8, 20


def of_truth(lines, edges, pixel):
    """(index of the true edge, vector from end to end) of all lines at level edges; edges as pairs of points."""
    found = []
    for line in lines:
        k = edge_of(line['p0'], line['p1'], edges, pixel)
        if k is not None and abs(edges[k][1][2] - edges[k][0][2]) < LEVEL * math.dist(*edges[k]):
            found.append((k, sub(line['p1'], line['p0'])))
    return found


def of_planes(lines, check, ground, pixel, all_views):
    """The same on photographs; the edges are the level lines of the run with all views. `check`: planes.json."""
    def level(some):
        return [line for line in some if is_level(line['p0'], line['p1'], check['planes'], ground)]

    edges = [(line['p0'], line['p1']) for line in level(all_views)]
    return [(edge_of(line['p0'], line['p1'], edges, pixel), sub(line['p1'], line['p0'])) for line in level(lines)]


def edge_of(p, q, edges, pixel):
    """Index of the edge parallel in plan that is nearest to the middle of p q; None when there is none."""
    middle = [(a + b) / 2 for a, b in zip(p, q)]
    best = None
    for k, (a, b) in enumerate(edges):
        along = sub(b, a)
        if between(sub(q, p), along) > PARALLEL_DEG:
            continue
        t = sum(x * y for x, y in zip(sub(middle, a)[:2], along[:2])) / max(sum(x * x for x in along[:2]), 1e-12)
        if not -0.05 <= t <= 1.05:
            continue
        foot = [x + t * d for x, d in zip(a, along)]
        beside, above = math.dist(middle[:2], foot[:2]), abs(middle[2] - foot[2])
        if beside < BESIDE_PX * pixel and above < ABOVE_PX * pixel and (best is None or beside + above < best[0]):
            best = (beside + above, k)
    return best and best[1]


def is_level(p, q, planes, ground):
    """Whether a line runs along the contours of a roof plane that it lies in."""
    middle = [(a + b) / 2 for a, b in zip(p, q)]
    steep = abs(q[2] - p[2]) > math.tan(math.radians(STEEP_DEG)) * math.dist(p[:2], q[:2])
    if steep or middle[2] < ground + ABOVE_GROUND_M:
        return False
    for plane in planes:
        normal, point = plane['normal'], plane['point']
        off = sum(a * b for a, b in zip(normal, sub(middle, point)))
        contour = (-normal[1], normal[0])
        if abs(off) < IN_PLANE_M and math.dist(middle[:2], point[:2]) < ROOF_M and between(sub(q, p), contour) < CONTOUR_DEG:
            return True
    return False


def inclination(vectors):
    """(rise a metre in x, in y) of the plane from which level vectors depart least: sum of the absolute height differences."""
    a = b = 0.0
    for _ in range(100):
        weights = [1 / max(abs(z - a * x - b * y), 1e-3) for x, y, z in vectors]
        sums = {
            key: sum(w * u * v for w, u, v in zip(weights, [v[i] for v in vectors], [v[j] for v in vectors]))
            for key, i, j in [('xx', 0, 0), ('xy', 0, 1), ('yy', 1, 1), ('xz', 0, 2), ('yz', 1, 2)]
        }
        det = sums['xx'] * sums['yy'] - sums['xy'] ** 2
        a = (sums['xz'] * sums['yy'] - sums['yz'] * sums['xy']) / det
        b = (sums['yz'] * sums['xx'] - sums['xz'] * sums['xy']) / det
    return a, b


def differences(found, slope=(0.0, 0.0)):
    """(edge, absolute height difference, length in plan) of vectors in a frame that is inclined."""
    return [(k, abs(z - slope[0] * x - slope[1] * y), math.hypot(x, y)) for k, (x, y, z) in found]


def on_the_same(runs):
    """Per run, the differences at the edges that have a line in every run: of the longest line at each."""
    common = set.intersection(*({k for k, _, _ in run if k is not None} for run in runs))
    return [[max((length, d) for k, d, length in run if k == edge)[1] for edge in sorted(common)] for run in runs]


def between(u, v):
    """Angle in plan between two directions without sense, degrees."""
    cosine = abs(u[0] * v[0] + u[1] * v[1]) / max(math.hypot(*u[:2]) * math.hypot(*v[:2]), 1e-12)
    return math.degrees(math.acos(min(1.0, cosine)))


def sub(a, b):
    return [x - y for x, y in zip(a, b)]
