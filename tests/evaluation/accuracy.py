#!/usr/bin/env python3
"""Accuracy of matched lines against the number of views (B99 figure 9); writes docs/accuracy.svg and a table of docs/results/lines.md.

    python3 tests/evaluation/accuracy.py --binary target/release/ridgeline --scenes FOLDER [--only NAME,...]

Each scene with more than four views is reconstructed with its first 3, 4, 5, ... views. Only lines that were matched count, not
those made from planes.

Where there is truth: a line that lies at a true roof edge (within 3 degrees, at most 5 ground pixels beside it and 10 above or
below) has a distance in plan and one in height from its middle to the edge; the plots show the medians in ground pixels.

Everywhere, B99's own measure: the mean height difference between the ends of level lines (level_lines.py), of all of them and of
those edges that have a line with every number of views (the longest one); more views show more edges, and those that few views show
are the less exact. The script needs Python alone.
"""
import json
import math
import pathlib
import statistics
import subprocess
import tempfile

from shared import level_lines, results_page
from shared.level_lines import sub
from shared.on_scenes import ROOT, names_of, parser_of
from shared.plots import HEIGHT, LEFT, TOP, WIDTH, document

COLOURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#000000', '#56b4e9']
# From one row of plots to the next.
ROW = HEIGHT + 78
# What is plotted: what it is, its unit, its key, and the steps of the vertical axis.
PLOTS = [
    ('median distance to true edges in plan', 'ground pixels', 'plan', 0.05),
    ('median distance to true edges in height', 'ground pixels', 'height', 0.2),
    ('mean height difference of the ends of level lines', 'ground pixels', 'ends', 1),
    ('mean height difference of the ends of level lines', 'metres', 'ends_m', 0.1),
    ('the same, at edges found with each number of views', 'ground pixels', 'same', 1),
    ('the same, at edges found with each number of views', 'metres', 'same_m', 0.1),
]


def main():
    args = parser_of(__doc__).parse_args()
    curves = {}
    for name in names_of(args):
        scene = args.scenes / name
        images = sorted(p.name for p in (scene / 'images').iterdir())
        if len(images) > 4:
            runs = {n: matched_lines(args.binary.resolve(), scene, images[:n]) for n in range(3, len(images) + 1)}
            curves[name] = with_truth(scene, runs) if (scene / 'truth').is_dir() else with_planes(scene, runs)
            for m in curves[name]:
                print(f'{name}, ' + told(m), flush=True)
    (ROOT / 'docs' / 'accuracy.svg').write_text(svg(curves))
    if not args.only:
        results_page.put_section(ROOT / 'docs' / 'results' / 'lines.md', 'level lines', table(curves))


def matched_lines(binary, scene, names):
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([binary, 'reconstruct', scene, '--out', out, '--views', ','.join(names)], check=True,
                       capture_output=True)
        lines = json.loads((pathlib.Path(out) / 'lines.json').read_text())['lines']
    return [line for line in lines if line['origin'] == 'matched']


def with_truth(scene, runs):
    """Of each number of views what is plotted, on a rendered scene."""
    edges = json.loads((scene / 'truth' / 'edges.json').read_text())['edges']
    cameras = json.loads((scene / 'cameras.json').read_text())
    edges = [[edge[end] for end in ('p0', 'p1')] for edge in edges]
    pixel = ground_pixel(cameras, edges[0][0])
    runs = {n: in_frame_of(edges, cameras, lines) for n, lines in runs.items()}
    level = {n: level_lines.differences(level_lines.of_truth(lines, edges, pixel)) for n, lines in runs.items()}
    result = of_level_lines(level, pixel)
    for m in result:
        distances = [d for line in runs[m['views']] for d in [nearest(line['p0'], line['p1'], edges, pixel)] if d]
        plan, height = (statistics.median(d[k] for d in distances) / pixel for k in (0, 1))
        m.update(lines=len(distances), plan=plan, height=height)
    return result


def with_planes(scene, runs):
    """The same on photographs, with planes fitted to tie points."""
    check = json.loads((scene / 'check' / 'planes.json').read_text())
    cameras = json.loads((scene / 'cameras.json').read_text())
    pixel = ground_pixel(cameras, check['planes'][0]['point'])
    found = {n: level_lines.of_planes(lines, check, cameras['ground_z'], pixel, runs[max(runs)]) for n, lines in runs.items()}
    slope = level_lines.inclination([vector for _, vector in found[max(runs)]])
    print(f'{scene.name}: the frame is inclined by {math.degrees(math.hypot(*slope)):.2f} degrees')
    return of_level_lines({n: level_lines.differences(level, slope) for n, level in found.items()}, pixel)


def of_level_lines(level, pixel):
    same = level_lines.on_the_same(list(level.values()))
    result = []
    for (n, ends), of_same in zip(level.items(), same):
        ends = [d for _, d, _ in ends]
        result.append({'views': n, 'level': len(ends), 'ends_m': statistics.mean(ends), 'ends': statistics.mean(ends) / pixel,
                       'median': statistics.median(ends) / pixel, 'edges': len(of_same)})
        # Of one or two edges the mean says nothing.
        if len(of_same) > 2:
            result[-1].update(same_m=statistics.mean(of_same), same=statistics.mean(of_same) / pixel)
    return result


def told(m):
    """One number of views in words."""
    text = f'{m["views"]} views: '
    if 'plan' in m:
        text += f'{m["lines"]} lines, {m["plan"]:.2f} pixels in plan, {m["height"]:.2f} in height; '
    text += f'ends of {m["level"]} level lines: mean {m["ends"]:.2f} pixels, {m["ends_m"]:.3f} m, median {m["median"]:.2f} pixels'
    if 'same' in m:
        text += f'; at the same {m["edges"]} edges: mean {m["same"]:.2f} pixels, {m["same_m"]:.3f} m'
    return text


def table(curves):
    """Markdown: B99's measure with the fewest and with all views."""
    rows = ['| scene | views | level lines | mean [px] | median [px] | mean [m] | same edges | mean [px] | mean [m] |',
            '|---|---|---|---|---|---|---|---|---|']
    for name, curve in curves.items():
        pair = (curve[0], curve[-1])

        def cell(key, digits):
            return ' → '.join(f'{m[key]:.{digits}f}' if key in m else '-' for m in pair)

        rows.append(f'| {name} | {cell("views", 0)} | {cell("level", 0)} | {cell("ends", 2)} | {cell("median", 2)} | '
                    f'{cell("ends_m", 3)} | {pair[0]["edges"]} | {cell("same", 2)} | {cell("same_m", 3)} |')
    return '\n'.join(rows)


def ground_pixel(cameras, point):
    view = cameras['views'][0]
    return math.dist(view['C'], point) / view['K'][0][0]


def in_frame_of(edges, cameras, lines):
    """Lines stand in the frame of the orientation that was taken: the truth's, or with the map origin added."""
    origin = cameras.get('origin', [0, 0, 0])
    if math.dist(lines[0]['p0'], edges[0][0]) > math.dist(sub(lines[0]['p0'], origin), edges[0][0]):
        lines = [{**line, **{end: sub(line[end], origin) for end in ('p0', 'p1')}} for line in lines]
    return lines


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


def cosine(a, b):
    return sum(x * y for x, y in zip(a, b)) / max(math.hypot(*a) * math.hypot(*b), 1e-12)


def plot(place, caption, unit, key, step, curves):
    """One polyline a scene over the number of views."""
    x0, y0 = LEFT + place % 2 * (WIDTH + 80), TOP + place // 2 * ROW
    views = sorted({m['views'] for curve in curves.values() for m in curve})
    top = step * math.ceil(max((m[key] for curve in curves.values() for m in curve if key in m), default=step) / step)

    def x(n):
        return x0 + 20 + (WIDTH - 40) * (n - views[0]) / max(views[-1] - views[0], 1)

    def y(v):
        return y0 + HEIGHT * (1 - v / top)

    parts = []
    for curve, colour in zip(curves.values(), COLOURS):
        dots = [(x(m['views']), y(m[key])) for m in curve if key in m]
        points = ' '.join(f'{px:.1f},{py:.1f}' for px, py in dots)
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3" fill="{colour}"/>' for px, py in dots]
    parts += [f'<text x="{x(n):.1f}" y="{y0 + HEIGHT + 16}" text-anchor="middle">{n}</text>' for n in views]
    for k in range(round(top / step) + 1):
        parts.append(f'<text x="{x0 - 6}" y="{y(k * step):.1f}" text-anchor="end" dominant-baseline="middle">{k * step:g}</text>')
    parts.append(f'<path d="M{x0} {y0}V{y0 + HEIGHT}H{x0 + WIDTH}" fill="none" stroke="#777"/>')
    for line, text in enumerate([caption, f'[{unit}], over the number of views']):
        parts.append(f'<text x="{x0 + WIDTH / 2}" y="{y0 + HEIGHT + 35 + 15 * line}" text-anchor="middle">{text}</text>')
    return '\n'.join(parts)


def svg(curves):
    plots = [plot(k, *what, curves) for k, what in enumerate(PLOTS)]
    y = TOP + (len(PLOTS) + 1) // 2 * ROW
    legend, x = '', LEFT + 6
    for name, colour in zip(curves, COLOURS):
        legend += f'<circle cx="{x}" cy="{y}" r="4" fill="{colour}"/><text x="{x + 9}" y="{y + 4}">{name}</text>'
        x += 30 + 7 * len(name)
    return document(plots, legend, below=y + 14 - (TOP + HEIGHT + 48))


if __name__ == '__main__':
    main()
