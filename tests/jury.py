#!/usr/bin/env python3
"""Score every rendered scene many times over, with noise, exposure, turned images and views left out.

    python3 tests/jury.py --binary target/release/ridgeline --scenes FOLDER [--only NAME,...]
                          [--out FILE.json] [--against FILE.json]

One run of a scene is one throw of the dice: a change of a few centimetres at the end of a line may flip a facet.
The mean over runs that differ in what no method should depend on tells an improvement from luck. FOLDER is laid out as
for score_table.py. `--against` compares with an earlier `--out`, run by run: the mean difference and its
standard error. The table of docs/results.md is rewritten when all scenes were run without `--against`. Needs numpy,
Pillow and shapely.
"""
import concurrent.futures
import functools
import itertools
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys

import numpy as np
from PIL import Image

import score_table
from on_scenes import names_of, parser_of

# What is done to the images: standard deviation of the noise (of 255), largest change of exposure and gamma,
# are they turned by quarters, quality of the JPEG, is its colour halved in size (4:2:0).
CHANGES = {
    'noise': {'noise': 1.5},
    'exposure': {'noise': 1.0, 'exposure': 0.12},
    'turned': {'turned': True},
    'strong-noise': {'noise': 3.0, 'quality': 90},
}
# The same with one colour kept for four pixels, as most photographs are stored; a group of their own, for they hold less.
STORED = {
    'stored': {'quality': 90, 'halved': True},
    'stored-noise': {'noise': 1.5, 'quality': 85, 'halved': True},
    'stored-exposure': {'noise': 1.0, 'exposure': 0.12, 'quality': 90, 'halved': True},
}
# With this many views or fewer a run says more about the scene than about the method.
FEWEST = 5
MEASURES = {
    'complete': lambda s: s['faces']['gt_10m2']['completeness'],
    'correct': lambda s: s['faces']['gt_10m2']['correctness'],
    'area within 0.2 m': lambda s: s['area']['covered_within_0_2m_fraction'],
    'roof edges': lambda s: s['lines']['edge_length_covered'],
    'wrong lines': lambda s: s['lines']['wrong'],
    'outline [m]': lambda s: s['faces']['geometry']['rms_outline_m'],
}


def main():
    parser = parser_of(__doc__)
    parser.add_argument('--out', type=pathlib.Path, default=score_table.ROOT / 'target' / 'jury.json')
    parser.add_argument('--against', type=pathlib.Path)
    args = parser.parse_args()
    scorer = args.scenes.parent / 'score'
    if not args.scenes.is_dir() or not scorer.is_dir():
        print(f'jury: skipped, there is no {args.scenes} with a {scorer} beside it')
        return 0
    scenes = [args.scenes / name for name in names_of(args) if (args.scenes / name / 'truth').is_dir()]
    jobs = [job for scene in scenes for job in jobs_of(scene)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        scores = list(pool.map(functools.partial(judge, args.binary.resolve(), scorer), jobs))
    runs = {job['name']: {'group': job['group'], **score} for job, score in zip(jobs, scores) if score}
    args.out.write_text(json.dumps(runs, indent=1))
    before = json.loads(args.against.read_text()) if args.against else None
    print(table(runs, before))
    if not args.only and not before:
        score_table.rewrite({'jury': table(runs, None)})
    return 0 if len(runs) == len(jobs) else 1


def jobs_of(scene):
    """All runs of a scene: as it is, changed, and without some of its views."""
    views = [view['file'] for view in json.loads((scene / 'cameras.json').read_text())['views']]
    named = functools.partial(dict, truth=scene)
    yield named(name=scene.name, group=(scene.name, len(views)), scene=scene, views=())
    for change, how in CHANGES.items():
        changed = changed_scene(scene, change, **how)
        yield named(name=changed.name, group=(scene.name, len(views)), scene=changed, views=())
    for change, how in STORED.items():
        changed = changed_scene(scene, change, **how)
        yield named(name=changed.name, group=(f'{scene.name} in 4:2:0', len(views)), scene=changed, views=())
    if len(views) < FEWEST or len(pieces(scene)) < 2:
        return
    every = 1 if len(views) <= 6 else 2
    for place in range(0, len(views), every):
        left = views[:place] + views[place + 1:]
        yield named(name=f'{scene.name} without {views[place]}', group=(scene.name, len(left)), scene=scene, views=left)
    if len(views) == 6:
        for three in ((0, 2, 4), (1, 3, 5), (0, 2, 5), (2, 3, 5)):
            names = [views[i] for i in three]
            yield named(name=f'{scene.name} {"+".join(names)}', group=(scene.name, 3), scene=scene, views=names)


def pieces(scene):
    """The buildings of the truth: a scene of one is decided by too few facets to leave views out."""
    return json.loads((scene / 'truth' / 'roofs.json').read_text())['buildings']


def changed_scene(scene, change, noise=0.0, exposure=0.0, turned=False, quality=95, halved=False):
    """A copy of the scene with other images; the same each time."""
    copy = score_table.ROOT / 'target' / 'jury' / f'{scene.name}-{change}'
    shutil.rmtree(copy, ignore_errors=True)
    (copy / 'images').mkdir(parents=True)
    cameras = json.loads((scene / 'cameras.json').read_text())
    random = np.random.default_rng([len(scene.name), *change.encode()])
    for k, view in enumerate(cameras['views']):
        image = np.asarray(Image.open(scene / 'images' / view['file']).convert('RGB')) / 255
        gain, gamma = random.uniform(1 - exposure, 1 + exposure, 2)
        image = 255 * np.clip(gain * image, 0, 1) ** gamma
        image = image + random.normal(0, 1, image.shape) * noise
        for _ in range((k + 1) % 4 if turned else 0):
            image = turn(image, view)
        image = Image.fromarray(np.clip(image + 0.5, 0, 255).astype(np.uint8))
        image.save(copy / 'images' / view['file'], quality=quality, subsampling=2 if halved else 0)
    (copy / 'cameras.json').write_text(json.dumps(cameras))
    return copy


def turn(image, view):
    """Turns an image and its camera by a quarter: the pixel (x, y) comes to (y, width - x)."""
    (fx, _, cx), (_, fy, cy), _ = view['K']
    view['K'] = [[fy, 0, cy], [0, fx, view['width'] - cx], [0, 0, 1]]
    view['R'] = (np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]) @ np.array(view['R'])).tolist()
    view['width'], view['height'] = view['height'], view['width']
    return np.rot90(image)


def judge(binary, scorer, job):
    """The measures of one run; None when it failed."""
    out = score_table.ROOT / 'target' / 'jury' / 'out' / job['name'].replace(' ', '_')
    views = ['--views', ','.join(job['views'])] if job['views'] else []
    done = subprocess.run([binary, 'reconstruct', job['scene'], '--out', out, *views], capture_output=True, text=True)
    if done.returncode:
        print(f'{job["name"]}: exit code {done.returncode}: {done.stderr.strip()}', file=sys.stderr)
        return None
    run = {'scene': job['truth'], 'out': out}
    score = score_table.tool(scorer, 'score', run, out / 'model.city.json', '--lines', out / 'lines.json')
    return score and {name: measure(score) or 0.0 for name, measure in MEASURES.items()}


def table(runs, before):
    """Means over the runs of each scene and number of views; with `before`, differences and their standard errors."""
    rows = [['scene', 'views', 'runs', *MEASURES]]
    by_group = itertools.groupby(sorted(runs.items(), key=lambda r: (r[1]['group'][0], -r[1]['group'][1])), lambda r: r[1]['group'])
    for (scene, views), group in by_group:
        group = [(now, before[name] if before else None) for name, now in group if not before or name in before]
        cells = [cell([now[m] for now, _ in group], [then[m] for _, then in group] if before else None, m) for m in MEASURES]
        rows.append([scene, str(views), str(len(group)), *cells])
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = ['| ' + ' | '.join(text.ljust(width) for text, width in zip(row, widths)) + ' |' for row in rows]
    return '\n'.join([lines[0], '|' + '|'.join('-' * (width + 2) for width in widths) + '|', *lines[1:]])


def cell(now, then, measure):
    metres = measure.endswith('[m]')
    scale, unit, digits = (1, '', 3) if metres else (100, ' %', 1)
    text = f'{scale * statistics.mean(now):.{digits}f}{unit}'
    if then is None:
        return text
    differences = [scale * (a - b) for a, b in zip(now, then)]
    error = statistics.stdev(differences) / math.sqrt(len(differences)) if len(differences) > 1 else math.nan
    return f'{text} ({statistics.mean(differences):+.{digits}f} ± {error:.{digits}f})'


if __name__ == '__main__':
    sys.exit(main())
