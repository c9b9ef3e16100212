#!/usr/bin/env python3
"""Reconstruct every scene of a folder, score it against its truth, and write docs/results.md.

    python3 tests/evaluation/score_table.py --binary target/release/ridgeline --scenes FOLDER [--only NAME,...]
    python3 tests/evaluation/score_table.py --self-test

FOLDER holds one folder per scene; beside it lies `score/` with score.py, score2d.py (scenes with truth/)
and check_real.py (scenes with check/), which need numpy and shapely. The tables stand in target/score/results.json, and the
page is written when all scenes were run. Without FOLDER there is nothing to score, and the program says so and ends well.
"""
import csv
import json
import statistics
import subprocess
import sys
import time
import zlib

import numpy as np

from shared import against_truth, results_page
from shared.on_scenes import ROOT, is_random, is_rendered, parser_of

# Scenes that are reconstructed without one view, and the places of these views.
LEFT_OUT = {'detached': (0, 3), 'suburb': (0, 3)}

# A tie point is beside a line from which it is no farther in plan, and at its height if no farther from that, metres.
BESIDE_M, AT_HEIGHT_M = 0.5, 0.3

OUT = ROOT / 'target' / 'score'

# B99, figures 5 to 7 with their text: scene, views, segments in all, of these matched, lines, wrong, supports a line, merged,
# grown, length [m].
OF_THE_PAPER = [
    ['B99, figure 5', '3', '696', '40 %', '88', '1.1 %', '3.0', '15 %', '> 70 %', '473'],
    ['B99, figure 6', '6', '-', '-', '86', '0.0 %', '>= 4', '-', '-', '546'],
    ['B99, figure 7', '3', '3896', '-', '229', '-', '3.0', '-', '-', '-'],
    ['B99, figure 7', '6', '-', '-', '332', '0.0 %', '>= 4', '-', '-', '-'],
]


def main():
    if sys.argv[1:] == ['--self-test']:
        return self_test()
    args = parser_of(__doc__, only='names of scenes, separated by commas; docs/results.md is left alone').parse_args()
    scorer = args.scenes.parent / 'score'
    if not args.scenes.is_dir() or not scorer.is_dir():
        print(f'score: skipped, there is no {args.scenes} with a {scorer} beside it')
        return 0
    names = sorted(p.name for p in args.scenes.iterdir() if (p / 'images').is_dir())
    if args.only:
        names = [name for name in names if name in args.only.split(',')]
    runs = [run(args.binary.resolve(), args.scenes / name) for name in names]
    # Of random scenes the page has one row each.
    named = [r for r in runs if not is_random(r['scene'])]
    rendered = [r for r in named if is_rendered(r['scene'])]
    others = [[run(args.binary.resolve(), r['scene'], method) for r in rendered] for method in ('rectangles', 'combined')]
    left_out = [(place, [run(args.binary.resolve(), r['scene'], method, all_but(r, place)) for method in ('lines', 'combined')])
                for r in rendered for place in LEFT_OUT.get(r['scene'].name, ()) if not r['failed']]
    results = {'program': results_page.program_here(), 'tables': {
        'lines': line_table([(r, lines(scorer, r)) for r in named]),
        'rendered': rendered_table([(r, score(scorer, r)) for r in runs if is_rendered(r['scene'])]),
        'combined': combined_table(scorer, [('', [r, *by_others]) for r, *by_others in zip(rendered, *others)] + left_out),
        'halfplanes': half_plane_table([(r, against_truth.angles(scorer, r['scene'], r['out'])) for r in rendered
                                        if not r['failed']]),
        'real': real_table([(r, check(scorer, r)) for r in runs if (r['scene'] / 'check').is_dir()]),
    }}
    for rows in results['tables'].values():
        print(results_page.markdown(rows), end='\n\n')
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / 'results.json').write_text(json.dumps(results, indent=1))
    if not args.only:
        results_page.RESULTS.write_text(results_page.page(results, results_page.RESULTS.read_text()))
        print(f'{results_page.RESULTS.relative_to(ROOT)} written')
    more = [r for _, pair in left_out for r in pair]
    return 1 if any(r['failed'] for r in sum(others, runs + more)) else 0


def run(binary, scene, method='lines', views=()):
    """Runs one scene; the outputs stand in target/score/<scene>, or beside it with the method or the views."""
    chosen = f'-{len(views)}-views-{zlib.crc32(",".join(views).encode()):08x}' if views else ''
    out = OUT / (scene.name + (f'-{method}' if method != 'lines' else '') + chosen)
    print(f'{out.name} ...', file=sys.stderr, flush=True)
    start = time.monotonic()
    done = subprocess.run([binary, 'reconstruct', scene, '--out', out, '--method', method]
                          + (['--views', ','.join(views)] if views else []), capture_output=True, text=True)
    if done.returncode:
        print(f'{scene.name}: exit code {done.returncode}: {done.stderr.strip()}', file=sys.stderr)
    return {'scene': scene, 'out': out, 'seconds': time.monotonic() - start, 'failed': done.returncode != 0}


def tool(scorer, name, run, *args):
    """The JSON that one of the scoring programs writes; None when it failed."""
    result = run['out'] / (name + '.json')
    done = subprocess.run([sys.executable, scorer / (name + '.py'), run['scene'], *args, '--json', result],
                          capture_output=True, text=True)
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ['no message'])[-1]
        print(f'{name}.py on {run["scene"].name}: {last}', file=sys.stderr)
        return None
    return json.loads(result.read_text())


def score(scorer, run):
    if run['failed']:
        return None
    out = run['out']
    scores = tool(scorer, 'score', run, out / 'model.city.json', '--lines', out / 'lines.json')
    segments = tool(scorer, 'score2d', run, out / 'segments.json')
    return scores and segments and {**scores, 'segments': segments}


def report(run):
    return json.loads((run['out'] / 'report.json').read_text())


def all_but(run, place):
    """The names of all views but the one at a place."""
    names = [view['view'] for view in report(run)['views']]
    return names[:place] + names[place + 1:]


def lines(scorer, run):
    """What became of the segments (B99 3.3 and 3.4), with the scores of the lines, matched and all, where there is truth."""
    if run['failed']:
        return None
    of_report, out = report(run), run['out']
    counts = {name: count for stage in of_report['stages']
              if stage['stage'] in ('segments', 'matches', 'lines') for name, count in stage['counts'].items()}
    truth = is_rendered(run['scene'])
    found = json.loads((out / 'lines.json').read_text())['lines']
    matched = [line for line in found if line['origin'] == 'matched']
    (out / 'matched.json').write_text(json.dumps({'lines': matched}))

    def scored(name):
        scores = truth and tool(scorer, 'score', run, out / 'model.city.json', '--lines', out / name)
        return scores['lines'] if scores else None

    def with_support(kind):
        return sum(any(view['kind'] == kind for view in line['views']) for line in matched) / max(1, len(matched))

    length = sum(sum((a - b) ** 2 for a, b in zip(line['p0'], line['p1'])) ** 0.5 for line in matched)
    return {**counts, 'length': length, 'merged': with_support('merged'), 'grown': with_support('grown'),
            'new': len(found) - len(matched), 'scores': scored('matched.json'), 'all': scored('lines.json'),
            'sigmas': truth and against_truth.errors_in_sigmas(scorer, run['scene'], matched)}


def check(scorer, run):
    checked = None if run['failed'] else tool(scorer, 'check_real', run, run['out'] / 'model.city.json')
    return checked and {**checked, 'lines_at_points': lines_at_points(run)}


def lines_at_points(run):
    """Of the lines with independent tie points beside them in plan, the share that have one at their height."""
    with open(run['scene'] / 'check' / 'points.csv') as file:
        rows = csv.DictReader(row for row in file if not row.startswith('#'))
        points = np.array([[float(row[k]) for k in 'xyz'] for row in rows])
    lines = json.loads((run['out'] / 'lines.json').read_text())['lines']
    at_height = []
    for line in lines:
        start, end = np.array(line['p0']), np.array(line['p1'])
        along = end - start
        t = ((points - start)[:, :2] @ along[:2]) / max(along[:2] @ along[:2], 1e-9)
        apart = points - (start + np.clip(t, 0, 1)[:, None] * along)
        beside = np.hypot(apart[:, 0], apart[:, 1]) < BESIDE_M
        if beside.any():
            at_height.append(np.abs(apart[beside, 2]).min() < AT_HEIGHT_M)
    return float(np.mean(at_height)) if at_height else None


def rendered_table(rows):
    header = ['scene', 'time [s]', 'edges in 2D', '3D lines', 'on roof edges', 'true', 'edges in 3D', 'facets > 10 m²',
              'complete', 'correct', 'area within 0.2 m', 'outline RMS [m]', 'height RMS [m]']
    return [header] + [[r['scene'].name, f'{r["seconds"]:.1f}'] + (rendered_row(s) if s else ['failed'] + ['-'] * 10)
                       for r, s in rows]


def rendered_row(s):
    lines, large, geometry = s['lines'], s['faces']['gt_10m2'], s['faces']['geometry']
    covered = [view['covered'] for view in s['segments']]
    true = lines['precision_roof_edge_or_surface']
    return [percent(sum(covered) / len(covered)), str(lines['lines']), percent(lines['precision_roof_edge']), percent(true),
            percent(lines['edge_length_covered']), f'{large["found"]} of {large["reference"]}', percent(large['completeness']),
            percent(large['correctness']), percent(s['area']['covered_within_0_2m_fraction']), metres(geometry['rms_outline_m']),
            metres(geometry['rms_height_m'])]


def line_table(rows):
    header = ['scene', 'views', 'segments', 'of these matched', 'lines', 'wrong', 'supports a line', 'merged', 'grown', 'length [m]',
              'roof edges covered', 'within sigma', 'new lines', 'covered with them']
    ours = [[r['scene'].name] + (line_row(c) if c else ['failed'] + ['-'] * 12) for r, c in rows]
    return [header] + [row + ['-'] * (len(header) - len(row)) for row in OF_THE_PAPER + ours]


def line_row(c):
    scores, supports = c['scores'], c['supports']
    return [str(c['views']), str(c['segments']), percent(c['matched segments'] / c['segments']), str(c['lines']), f'{100 * scores["wrong"]:.1f} %' if scores else '-',
            f'{supports / c["lines"]:.1f}', percent(c['merged']), percent(c['grown']),
            f'{c["length"]:.0f}', percent(scores['edge_length_covered']) if scores else '-',
            percent(sum(e <= 1 for e in c['sigmas']) / len(c['sigmas'])) if c['sigmas'] else '-', str(c['new']),
            percent(c['all']['edge_length_covered']) if c['all'] else '-']


def half_plane_table(rows):
    header = ['scene', 'half-planes', 'on roofs', 'median angle [deg]', 'within 2 deg', 'within 5 deg', 'within sigma', 'within 2 sigma']
    return [header] + [[r['scene'].name, *half_plane_row(*found)] for r, found in rows]


def half_plane_row(found, count):
    if not found:
        return [str(count), '0'] + ['-'] * 5

    def share(test):
        return percent(sum(test(angle, sigma) for angle, sigma in found) / len(found))

    return [str(count), str(len(found)), f'{statistics.median(angle for angle, _ in found):.1f}',
            share(lambda angle, _: angle <= 2), share(lambda angle, _: angle <= 5),
            share(lambda angle, sigma: angle <= sigma), share(lambda angle, sigma: angle <= 2 * sigma)]


def combined_table(scorer, rows):
    """Methods beside each other, "lines / rectangles / combined"; rows of (place of the view left out, runs)."""
    table = [COMBINED_HEAD]
    for place, runs in rows:
        scene = runs[0]['scene']
        runs = runs if len(runs) == 3 else [runs[0], None, runs[1]]
        scores = [r and not r['failed'] and tool(scorer, 'score', r, r['out'] / 'model.city.json', '--lines', r['out'] / 'lines.json')
                  for r in runs]
        table.append([scene.name, 'all' if place == '' else f'without the {("first", "second", "third", "fourth")[place]}']
                     + [' / '.join(cell(s) if s else '-' for s in scores) for cell in COMBINED_CELLS])
    return table


COMBINED_HEAD = ['scene', 'views', 'facets > 10 m²', 'complete', 'correct', 'area within 0.2 m', 'roof edges covered', 'wrong lines']
COMBINED_CELLS = (
    lambda s: str(s['faces']['gt_10m2']['found']),
    lambda s: percent(s['faces']['gt_10m2']['completeness']),
    lambda s: percent(s['faces']['gt_10m2']['correctness']),
    lambda s: f'{100 * s["area"]["covered_within_0_2m_fraction"]:.1f} %',
    lambda s: percent(s['lines']['edge_length_covered']),
    lambda s: f'{100 * s["lines"]["wrong"]:.1f} %',
)


def real_table(rows):
    header = ['scene', 'time [s]', 'facets', 'planes found', 'tie points on roofs', 'within 0.25 m', 'median height error [m]',
              'lines at tie points']
    return [header] + [[r['scene'].name, f'{r["seconds"]:.1f}'] + (real_row(c) if c else ['failed'] + ['-'] * 5)
                       for r, c in rows]


def real_row(c):
    return [str(c['facets']), f'{c["planes_found"]} of {len(c["planes"])}', str(c['points_on_roofs']),
            percent(c['points_within_0_25m']), metres(c['median_abs_dz_m']),
            percent(c['lines_at_points'])]


def percent(x):
    return '-' if x is None else f'{100 * x:.0f} %'


def metres(x):
    return '-' if x is None else f'{x:.2f}'


def self_test():
    """Planted scores come out of the page, in their tables, and what other scripts have written stays."""
    scene = {'scene': ROOT / 'planted', 'seconds': 1.25, 'failed': False}
    scores = {
        'lines': {'lines': 4321, 'precision_roof_edge': 0.111, 'precision_roof_edge_or_surface': 0.222, 'edge_length_covered': 0.333,
                  'wrong': 0.0444},
        'faces': {'gt_10m2': {'found': 55, 'reference': 66, 'completeness': 0.555, 'correctness': 0.666},
                  'geometry': {'rms_outline_m': 0.77, 'rms_height_m': 0.88}},
        'area': {'covered_within_0_2m_fraction': 0.999}, 'segments': [{'covered': 0.1}, {'covered': 0.3}],
    }
    supports = {'views': 6, 'segments': 200, 'matched segments': 50, 'lines': 100, 'supports': 450, 'length': 1234.4, 'merged': 0.12,
                'grown': 0.34, 'new': 7, 'scores': scores['lines'], 'all': scores['lines'], 'sigmas': [0.5, 0.5, 2.0, 0.1]}
    check = {'facets': 9, 'planes_found': 5, 'planes': [0] * 6, 'points_on_roofs': 321, 'points_within_0_25m': 0.87,
             'median_abs_dz_m': 0.065, 'lines_at_points': 0.98}
    results = {'program': '0123abcd', 'tables': {
        'rendered': rendered_table([(scene, scores), ({**scene, 'failed': True}, None)]), 'lines': line_table([(scene, supports)]),
        'halfplanes': half_plane_table([(scene, ([(1.0, 2.0), (4.0, 1.0)], 3))]), 'real': real_table([(scene, check)]),
        'combined': [COMBINED_HEAD, ['planted', 'all', *(cell(scores) for cell in COMBINED_CELLS)]],
    }}
    written = results_page.page(json.loads(json.dumps(results)), '\n'.join(
        results_page.marked(name, f'kept of {name}') for name in results_page.SECTIONS))
    rows = [[cell.strip() for cell in line.split('|')[1:-1]] for line in written.splitlines() if line.startswith('| planted')]
    assert rows == [
        ['planted', '1.2', '20 %', '4321', '11 %', '22 %', '33 %', '55 of 66', '56 %', '67 %', '100 %', '0.77', '0.88'],
        ['planted', '1.2', 'failed', *['-'] * 10],
        ['planted', '1.2', '9', '5 of 6', '321', '87 %', '0.07', '98 %'],
        ['planted', '6', '200', '25 %', '100', '4.4 %', '4.5', '12 %', '34 %', '1234', '33 %', '75 %', '7', '33 %'],
        ['planted', '3', '2', '2.5', '50 %', '100 %', '50 %', '50 %'],
        ['planted', 'all', '55', '56 %', '67 %', '99.9 %', '33 %', '4.4 %'],
    ], rows
    assert 'program 0123abcd' in written and all(f'kept of {name}' in written for name in results_page.SECTIONS)
    assert results_page.page(results, written) == written, 'written again it stays'
    print('planted scores come out of the page')
    return 0


if __name__ == '__main__':
    sys.exit(main())
