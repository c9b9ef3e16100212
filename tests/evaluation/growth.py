#!/usr/bin/env python3
"""How the time of a method grows with the number of images and with what they hold; writes docs/growth*.svg.

    python3 tests/evaluation/growth.py --binary target/release/ridgeline --scenes FOLDER [--method lines|rectangles]

rectangles (W96): the stages over the number of images, house-gable with its first 3 to 6 views, and over the megapixels of
three scenes of six views. lines (B99 3): segments, matching and 3D lines over the number of images, detached with its first
3 to 6 views and campus-drone with its first 3 to 8, and over the number of segments of those three scenes. Times are processor
seconds of one thread, so that a busy machine changes little: the share of each stage of the run times the user time of the process,
the median of three runs. Printed are also the powers with which they grow: slopes of straight lines through the logarithms. The
script needs Python alone.
"""
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

from shared.growth_runs import power
from shared.on_scenes import ROOT, parser_of
from shared.plots import HEIGHT, LEFT, TOP, WIDTH, document
from shared.timed_runs import MEASURABLE_S

# Six images each: 256 x 256, 600 x 600 and 1200 x 1200.
SIZES = ['house-gable', 'detached', 'suburb']
# Runs of each.
RUNS = 3
# Stages with colours that remain apart for the colour-blind (Okabe and Ito), what the second plot counts, and the file.
METHODS = {
    'rectangles': {
        'stages': {'regions': '#0072b2', 'directions': '#e69f00', 'clusters': '#009e73', 'rectangles': '#d55e00'},
        'views_of': ['house-gable'], 'size': 'megapixels', 'file': 'growth.svg',
    },
    'lines': {
        'stages': {'segments': '#0072b2', 'matches': '#e69f00', 'lines': '#009e73'},
        'views_of': ['detached', 'campus-drone'], 'size': 'segments', 'file': 'growth-lines.svg',
    },
}


def main():
    parser = parser_of(__doc__, only=None)
    parser.add_argument('--method', choices=METHODS, default='rectangles')
    args = parser.parse_args()
    method = METHODS[args.method]
    stages = method['stages']

    def run(scene, *options):
        return measure(args.binary.resolve(), args.scenes / scene, args.method, stages, *options)

    curves = [over_views(run, args.scenes, scene) for scene in method['views_of']]
    curves.append((f'{method["size"]} of all images ({", ".join(SIZES)})',
                   [(m[method['size']], m['seconds']) for m in map(run, SIZES)]))
    for caption, points in curves:
        totals = [(x, sum(t.values())) for x, t in points]
        of_stages = {s: [(x, t[s]) for x, t in points] for s in stages}
        told = [f'{s} {power(of_stage):.2f}' for s, of_stage in of_stages.items() if min(y for _, y in of_stage) > MEASURABLE_S]
        print(f'power of {caption}: {", ".join(told)}; together {power(totals):.2f}')
    figure = [plot(place, caption, stages, points) for place, (caption, points) in enumerate(curves)]
    (ROOT / 'docs' / method['file']).write_text(svg(figure, stages))


def over_views(run, scenes, scene):
    """Caption and points of a scene with its first views."""
    names = sorted(p.name for p in (scenes / scene / 'images').iterdir())
    runs = [run(scene, '--views', ','.join(names[:n])) for n in range(3, len(names) + 1)]
    return f'number of images ({scene})', [(m['views'], m['seconds']) for m in runs]


def measure(binary, scene, method, stages, *options):
    """Processor seconds of every stage, the medians of some runs."""
    runs = [measure_once(binary, scene, method, stages, *options) for _ in range(RUNS)]
    seconds = {s: statistics.median(m['seconds'][s] for m in runs) for s in stages}
    print(f'{scene.name}, {runs[0]["views"]} images, {runs[0]["megapixels"]:.2f} megapixels, {runs[0]["segments"]} segments:',
          ', '.join(f'{s} {t:.3f} s' for s, t in seconds.items()), flush=True)
    return {**runs[0], 'seconds': seconds}


def measure_once(binary, scene, method, stages, *options):
    """One run on one thread."""
    with tempfile.TemporaryDirectory() as out:
        process = subprocess.Popen([binary, 'reconstruct', scene, '--method', method, '--threads', '1', '--out', out,
                                    *options], stdout=subprocess.PIPE, text=True)
        text = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            raise SystemExit(f'{scene.name}: exit code {process.returncode}')
        report = json.loads((pathlib.Path(out) / 'report.json').read_text())
    lines = [line.split() for line in text.splitlines()]
    total = next(float(words[1]) for words in lines if words[:1] == ['total'])
    share = usage.ru_utime / total
    seconds = {s: report['seconds'][s] * share for s in stages}
    megapixels = sum(v['width'] * v['height'] for v in report['views']) / 1e6
    segments = report['stages'][0]['counts'].get('segments', 0)
    return {'views': len(report['views']), 'megapixels': megapixels, 'segments': segments, 'seconds': seconds}


# From one row of plots to the next.
ROW = HEIGHT + 60


def plot(place, caption, stages, points):
    """Stacked areas of the stages over x; two plots in a row."""
    x0, y0 = LEFT + place % 2 * (WIDTH + 80), TOP + place // 2 * ROW
    largest_x = max(x for x, _ in points)
    largest_y = nice(max(sum(s.values()) for _, s in points))
    at = lambda x, y: f'{x0 + WIDTH * x / largest_x:.1f},{y0 + HEIGHT * (1 - y / largest_y):.1f}'
    parts = []
    base = [0.0] * len(points)
    for stage, colour in stages.items():
        top = [b + s[stage] for b, (_, s) in zip(base, points)]
        ring = [at(x, y) for (x, _), y in zip(points, top)] + [at(x, y) for (x, _), y in reversed(list(zip(points, base)))]
        parts.append(f'<polygon points="{" ".join(ring)}" fill="{colour}" fill-opacity="0.75"/>')
        base = top
    for (x, _), y in zip(points, base):
        px, py = at(x, y).split(',')
        parts.append(f'<circle cx="{px}" cy="{py}" r="3"/><text x="{px}" y="{y0 + HEIGHT + 16}" text-anchor="middle">{label(x)}</text>')
    # What growth in proportion to the last point would be.
    parts.append(f'<polyline points="{at(0, 0)} {at(points[-1][0], base[-1])}" fill="none" stroke="#777" stroke-dasharray="4 3"/>')
    for k in range(3):
        y = largest_y * k / 2
        py = at(0, y).split(',')[1]
        parts.append(f'<text x="{x0 - 6}" y="{py}" text-anchor="end" dominant-baseline="middle">{y:.3g} s</text>')
    parts.append(f'<path d="M{x0} {y0}V{y0 + HEIGHT}H{x0 + WIDTH}" fill="none" stroke="#777"/>')
    parts.append(f'<text x="{x0 + WIDTH / 2}" y="{y0 + HEIGHT + 36}" text-anchor="middle">{caption}</text>')
    return '\n'.join(parts)


def label(x):
    """Three digits, or all of a whole number."""
    return f'{x:d}' if isinstance(x, int) else f'{x:.3g}'


def nice(x):
    """The next 1, 2 or 5 times a power of ten."""
    step = 1e-3
    while True:
        for factor in (1, 2, 5):
            if factor * step >= x:
                return factor * step
        step *= 10


def svg(plots, stages):
    legend = ''.join(
        f'<rect x="{LEFT + 10}" y="{TOP + 4 + 16 * k}" width="10" height="10" fill="{colour}" fill-opacity="0.75"/>'
        f'<text x="{LEFT + 26}" y="{TOP + 13 + 16 * k}">{s}</text>' for k, (s, colour) in enumerate(stages.items()))
    return document(plots, legend, below=(len(plots) - 1) // 2 * ROW)


if __name__ == '__main__':
    main()
