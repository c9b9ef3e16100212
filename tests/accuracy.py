#!/usr/bin/env python3
"""Accuracy of matched lines against the number of views (B99 figure 9); writes docs/accuracy.svg.

    python3 tests/accuracy.py --binary target/release/ridgeline --scenes FOLDER [--only NAME,...]

Each scene with truth/ and six views or more is reconstructed with its first 3, 4, 5, ... views. A line that was matched (not
made from planes) and lies at a true roof edge (within 3 degrees, at most 5 ground pixels beside it and 10 above or below) has a
distance in plan and one in height from its middle to the edge; the plots show the medians in ground pixels. The script needs Python
alone.
"""
import json
import math
import pathlib
import statistics
import subprocess
import tempfile

from growth import HEIGHT, LEFT, TOP, WIDTH, document
from on_scenes import is_wanted, parser_of

ROOT = pathlib.Path(__file__).resolve().parent.parent
COLOURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00']


def main():
    args = parser_of(__doc__).parse_args()
    curves = {}
    for scene in sorted(p.parent for p in args.scenes.glob('*/truth')):
        names = sorted(p.name for p in (scene / 'images').iterdir())
        if len(names) >= 6 and is_wanted(args, scene.name):
            curves[scene.name] = [errors(args.binary.resolve(), scene, names[:n]) for n in range(3, len(names) + 1)]
    plots = [plot(0, 'in plan', curves, 'plan'), plot(1, 'in height', curves, 'height')]
    (ROOT / 'docs' / 'accuracy.svg').write_text(svg(plots, list(curves)))


def errors(binary, scene, names):
    """Medians of the distances of matched lines to their true edges, in ground pixels."""
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([binary, 'reconstruct', scene, '--out', out, '--views', ','.join(names)], check=True,
                       capture_output=True)
        lines = json.loads((pathlib.Path(out) / 'lines.json').read_text())['lines']
    edges = json.loads((scene / 'truth' / 'edges.json').read_text())['edges']
    cameras = json.loads((scene / 'cameras.json').read_text())
    edges = [[edge[end] for end in ('p0', 'p1')] for edge in edges]
    # Lines stand in the frame of the orientation that was taken: the truth's, or with the map origin added.
    origin = cameras.get('origin', [0, 0, 0])
    if math.dist(lines[0]['p0'], edges[0][0]) > math.dist(sub(lines[0]['p0'], origin), edges[0][0]):
        lines = [{**line, **{end: sub(line[end], origin) for end in ('p0', 'p1')}} for line in lines]
    view = cameras['views'][0]
    pixel = math.dist(view['C'], edges[0][0]) / view['K'][0][0]
    matched = [line for line in lines if line['origin'] == 'matched']
    distances = [d for line in matched for d in [nearest(line['p0'], line['p1'], edges, pixel)] if d]
    plan, height = (statistics.median(d[k] for d in distances) / pixel for k in (0, 1))
    print(f'{scene.name}, {len(names)} views: {len(distances)} lines, {plan:.2f} pixels in plan, {height:.2f} in height',
          flush=True)
    return {'views': len(names), 'plan': plan, 'height': height}


def nearest(p, q, edges, pixel):
    """Distances in plan and in height of the middle of p q to the nearest parallel edge; None when there is none."""
    best = None
    middle = [(a + b) / 2 for a, b in zip(p, q)]
    for a, b in edges:
        if abs(cosine(sub(q, p), sub(b, a))) < math.cos(math.radians(3)):
            continue
        along = sub(b, a)
        # The place of the edge beside the middle, seen from above.
        t = sum(x * y for x, y in zip(sub(middle, a)[:2], along[:2])) / max(sum(x * x for x in along[:2]), 1e-12)
        if not -0.05 <= t <= 1.05:
            continue
        foot = [x + t * d for x, d in zip(a, along)]
        distance = (math.dist(middle[:2], foot[:2]), abs(middle[2] - foot[2]))
        if distance[0] < 5 * pixel and distance[1] < 10 * pixel and (best is None or sum(distance) < sum(best)):
            best = distance
    return best


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cosine(a, b):
    return sum(x * y for x, y in zip(a, b)) / max(math.hypot(*a) * math.hypot(*b), 1e-12)


def plot(column, caption, curves, key):
    """One polyline a scene over the number of views."""
    x0 = LEFT + column * (WIDTH + 80)
    views = sorted({m['views'] for curve in curves.values() for m in curve})
    # In whole halves of a pixel.
    top = math.ceil(2 * max(m[key] for curve in curves.values() for m in curve)) / 2

    def x(n):
        return x0 + 20 + (WIDTH - 40) * (n - views[0]) / max(views[-1] - views[0], 1)

    def y(v):
        return TOP + HEIGHT * (1 - v / top)

    parts = []
    for curve, colour in zip(curves.values(), COLOURS):
        points = ' '.join(f'{x(m["views"]):.1f},{y(m[key]):.1f}' for m in curve)
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{x(m["views"]):.1f}" cy="{y(m[key]):.1f}" r="3" fill="{colour}"/>' for m in curve]
    parts += [f'<text x="{x(n):.1f}" y="{TOP + HEIGHT + 16}" text-anchor="middle">{n}</text>' for n in views]
    for k in range(int(2 * top) + 1):
        parts.append(f'<text x="{x0 - 6}" y="{y(k / 2):.1f}" text-anchor="end" dominant-baseline="middle">{k / 2:g}</text>')
    parts.append(f'<path d="M{x0} {TOP}V{TOP + HEIGHT}H{x0 + WIDTH}" fill="none" stroke="#777"/>')
    parts.append(f'<text x="{x0 + WIDTH / 2}" y="{TOP + HEIGHT + 36}" text-anchor="middle">'
                 f'median distance {caption}, ground pixels, over views</text>')
    return '\n'.join(parts)


def svg(plots, names):
    legend = ''.join(
        f'<circle cx="{LEFT + WIDTH - 95}" cy="{TOP + 9 + 16 * k}" r="4" fill="{colour}"/>'
        f'<text x="{LEFT + WIDTH - 85}" y="{TOP + 13 + 16 * k}">{name}</text>' for k, (name, colour) in enumerate(zip(names, COLOURS)))
    return document(plots, legend)


if __name__ == '__main__':
    main()
