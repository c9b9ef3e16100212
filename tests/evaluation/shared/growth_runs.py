"""How a run on one core grows with its views, with the area and with the photographs there are: the tables of
`tests/evaluation/bench.py`."""

import math
import pathlib
import statistics
import tempfile
from functools import partial

from shared.timed_runs import MEASURABLE_S, in_turns, reconstruct

VIEWS = [3, 4, 6, 8]
# Sides of the squares in the middle of the flight, metres: areas as 1 to 4 to 9 to 16.
SIDES_M = [25, 50, 75, 100]
# The photographs nearest to a square in the middle of the flight.
PHOTOGRAPHS, SIDE_M = [10, 20, 40, 80], 60
# So many stages have a column: the longest ones.
COLUMNS = 5


def over_views(program, scene, rounds):
    """The first views of a scene."""
    names = sorted(path.name for path in (scene / 'images').iterdir())
    sizes = {n: ['--views', ','.join(names[:n])] for n in VIEWS if n <= len(names)}
    return ladder(program, scene, rounds, f'first views of {scene.name}', sizes)


def over_area(program, flight, model, rounds):
    """Squares around the middle of the flight, of which the program chooses the photographs."""
    middle = middle_of(centres_of(model))
    sizes = {side ** 2: [square(middle, side)] for side in SIDES_M}
    return ladder(program, flight, rounds, f'm² of {flight.name}', sizes)


def over_photographs(program, flight, model, rounds):
    """The same square of a flight of which there are more and more photographs."""
    centres = centres_of(model)
    middle = middle_of(centres)
    nearest = sorted(centres, key=lambda name: (distance(centres[name], middle), name))
    sizes = {n: [square(middle, SIDE_M), '--views', ','.join(nearest[:n])] for n in PHOTOGRAPHS if n <= len(nearest)}
    return ladder(program, flight, rounds, f'photographs there are, {SIDE_M} x {SIDE_M} m of {flight.name}', sizes)


def ladder(program, scene, rounds, caption, sizes):
    """Runs of all sizes in turns, and their table."""
    print(f' {caption}:', flush=True)
    return table(caption, in_turns(rounds, {size: partial(reconstruct, program, scene, *options) for size, options in sizes.items()}))


def table(caption, found):
    """Seconds of the processor, of the longest stages, and memory, and the powers with which they grow."""
    medians = {size: medians_of(runs) for size, runs in found.items()}
    columns = longest([of['stages'] for of in medians.values()])
    rows = [[caption, 'views used', 'processor [s]', *columns, 'memory [MB]']]
    for size, of in medians.items():
        seconds = [f'{of["stages"][stage]:.2f}' if of['stages'] else 'tiles' for stage in columns]
        rows.append([str(size), str(of['views'] or 'tiles'), f'{of["user"]:.2f}', *seconds, f'{of["memory_mb"]:.0f}'])
    powers = [told_power([(size, of['user']) for size, of in medians.items()]),
              *(told_power([(size, of['stages'].get(stage, 0)) for size, of in medians.items()]) for stage in columns),
              told_power([(size, of['memory_mb']) for size, of in medians.items()])]
    rows.append(['power', '', *powers])
    lines = [f'| {" | ".join(cells)} |' for cells in rows]
    return [lines[0], '|---' * len(rows[0]) + '|', *lines[1:]]


def longest(of_sizes):
    """Reading and the stages that take longest at any size, in their order."""
    most = {}
    for stages in of_sizes:
        most |= {stage: max(seconds, most.get(stage, 0)) for stage, seconds in stages.items() if stage not in ('load', 'total')}
    chosen = sorted(most, key=lambda stage: -most[stage])[:COLUMNS]
    return ['load', *(stage for stage in most if stage in chosen)]


def medians_of(runs):
    """Medians of one size. Seconds of the stages are the processor's: the clock's by the share that the run had of it."""
    shares = [one['processor'] / one['clock'] for one in runs]
    stages = {stage: statistics.median(one['stages'][stage] * share for one, share in zip(runs, shares, strict=True))
              for stage in runs[0]['stages']}
    return {'stages': stages, 'views': runs[0]['views'], 'user': statistics.median(one['user'] for one in runs),
            'memory_mb': statistics.median(one['memory_mb'] for one in runs)}


def power(points):
    """Slope of the line through the logarithms by least squares."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mean_x, mean_y = (statistics.mean(log[i] for log in logs) for i in (0, 1))
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / sum((x - mean_x) ** 2 for x, _ in logs)


def told_power(points):
    return f'{power(points):.2f}' if len(points) > 1 and min(y for _, y in points) >= MEASURABLE_S else ''


def square(middle, side):
    """The option for a square around a place."""
    x, y = (round(value, 2) for value in middle)
    return f'--roi={x - side / 2:.2f},{y - side / 2:.2f},{x + side / 2:.2f},{y + side / 2:.2f}'


def centres_of(model):
    """Positions of the cameras in plan by the name of their photograph, from a COLMAP text model: C = -R' t."""
    centres = {}
    # Two lines an image: its pose, and the points in it, which may be none.
    lines = [line for line in (model / 'images.txt').read_text().splitlines() if not line.startswith('#')]
    for line in lines[::2]:
        words = line.split(maxsplit=9)
        if len(words) == 10:
            centres[words[9].strip()] = centre_of(*map(float, words[1:8]))
    return centres


def centre_of(w, x, y, z, *t):
    """x and y of -R' t, with the rotation as a unit quaternion."""
    columns = [(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
               (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x))]
    return tuple(-sum(r * of for r, of in zip(column, t)) for column in columns)


def middle_of(centres):
    return tuple(statistics.median(centre[axis] for centre in centres.values()) for axis in (0, 1))


def distance(a, b):
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2


def self_test():
    # A camera at (3, 4, 5) that looks down: R = diag(1, -1, -1), t = -R C; and the same turned by 30 degrees about x.
    with tempfile.TemporaryDirectory() as folder:
        text = '# a comment\n1 0 1 0 0 -3 4 5 1 a b.jpg\n\n2 0.8660254037844387 0.5 0 0 0 0 0 1 c.jpg\n1 2 -1 3 4 -1 5 6 -1 7 8 -1\n'
        (pathlib.Path(folder) / 'images.txt').write_text(text)
        centres = centres_of(pathlib.Path(folder))
    assert centres['a b.jpg'] == (3, 4) and centres['c.jpg'] == (0, 0) and len(centres) == 2, centres
    # 60 degrees about x: the point straight ahead at z = 2 is at y = -2 sin 60 of the world's, its opposite the camera.
    assert abs(centre_of(0.8660254037844387, 0.5, 0, 0, 0, 0, 2)[1] + 2 * 0.8660254037844387) < 1e-12
    # A quarter turn about z: R' t = (2, -1, 3).
    assert all(abs(a - b) < 1e-12 for a, b in zip(centre_of(0.5 ** 0.5, 0, 0, 0.5 ** 0.5, 1, 2, 3), (-2, 1)))
    once = lambda n: {'stages': {'load': 0.12, 'matches': 0.02 * n ** 2, 'lines': 1e-4, 'total': 1.0}, 'user': 0.5 * n,
                      'processor': 3.0, 'clock': 4.0, 'memory_mb': 100.0, 'views': n}
    # Three quarters of the clock's seconds were the processor's.
    lines = table('views', {n: [once(n)] * 3 for n in VIEWS})
    assert lines[2] == '| 3 | 3 | 1.50 | 0.09 | 0.14 | 0.00 | 100 |', lines
    assert lines[-1] == '| power |  | 1.00 | 0.00 | 2.00 |  | 0.00 |', lines
    tiles = {**once(8), 'stages': {}, 'views': 0}
    assert table('area', {3: [once(3)], 8: [tiles]})[3] == '| 8 | tiles | 4.00 | tiles | tiles | tiles | 100 |'
    assert square((1.0, -2.0), 10) == '--roi=-4.00,-7.00,6.00,3.00'
    assert abs(power([(x, 3 * x ** 1.7) for x in (1, 4, 9, 16)]) - 1.7) < 1e-12
