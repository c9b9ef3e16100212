#!/usr/bin/env python3
"""Score every scene many times over, with noise, exposure, turned images and views left out.

    python3 tests/evaluation/perturb.py --binary target/release/ridgeline --scenes FOLDER [--only NAME,...]
                          [--out FILE.json] [--against FILE.json]

One run of a scene is one throw of the dice: a change of a few centimetres at the end of a line may flip a facet.
The mean over runs that differ in what no method should depend on tells an improvement from luck. FOLDER is laid out as
for score_table.py. `--against` compares with an earlier `--out`, run by run: the mean difference and its
standard error. Its tables in docs/results.md are rewritten when all scenes were run without `--against`. Needs numpy,
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
from shared import results_page
from shared.on_scenes import MEASURES, ROOT, is_random, is_rendered, names_of, parser_of

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
# Of real scenes, which have no truth but planes and tie points to check by.
REAL_MEASURES = {
    'planes found': lambda s: s['planes_found'] / len(s['planes']),
    'tie points on roofs': lambda s: s['points_on_roofs'],
    'within 0.25 m': lambda s: s['points_within_0_25m'],
    'median height error [m]': lambda s: s['median_abs_dz_m'],
}


def main():
    parser = parser_of(__doc__)
    parser.add_argument('--out', type=pathlib.Path, default=ROOT / 'target' / 'perturbed.json')
    parser.add_argument('--against', type=pathlib.Path)
    args = parser.parse_args()
    scorer = args.scenes.parent / 'score'
    if not args.scenes.is_dir() or not scorer.is_dir():
        print(f'perturb: skipped, there is no {args.scenes} with a {scorer} beside it')
        return 0
    scenes = [scene for name in names_of(args) if not is_random(scene := args.scenes / name)]
    jobs = [job for scene in scenes if is_rendered(scene) for job in jobs_of(scene)]
    jobs += [job for scene in scenes if (scene / 'check').is_dir() for job in real_jobs_of(scene)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        scores = list(pool.map(functools.partial(scored, args.binary.resolve(), scorer), jobs))
    runs = {job['name']: {'group': job['group'], **score} for job, score in zip(jobs, scores) if score}
    args.out.write_text(json.dumps(runs, indent=1))
    before = json.loads(args.against.read_text()) if args.against else None
    tables = [table(runs, before, measures) for measures in (MEASURES, REAL_MEASURES)]
    print(*tables, sep='\n\n')
    if not args.only and not before:
        section = '\n\n'.join([f'Of program {results_page.program_here()}.', *tables])
        results_page.put_section(results_page.RESULTS, 'perturbed', section)
    return 0 if len(runs) == len(jobs) else 1


def jobs_of(scene):
    """All runs of a scene: as it is, changed, and without some of its views."""
    views = views_of(scene)
    named = functools.partial(dict, truth=scene, measures=MEASURES)
    yield from changed_jobs_of(scene, named)
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


def real_jobs_of(scene):
    """Runs of a scene with all of its views, as it is and changed."""
    return changed_jobs_of(scene, functools.partial(dict, truth=scene, measures=REAL_MEASURES))


def changed_jobs_of(scene, named):
    """A scene as it is, and with other images."""
    group = (scene.name, len(views_of(scene)))
    yield named(name=scene.name, group=group, scene=scene, views=())
    for change, how in CHANGES.items():
        changed = changed_scene(scene, change, **how)
        yield named(name=changed.name, group=group, scene=changed, views=())


def views_of(scene):
    return [view['file'] for view in json.loads((scene / 'cameras.json').read_text())['views']]


def pieces(scene):
    """The buildings of the truth: a scene of one is decided by too few facets to leave views out."""
    return json.loads((scene / 'truth' / 'roofs.json').read_text())['buildings']


def changed_scene(scene, change, noise=0.0, exposure=0.0, turned=False, quality=95, halved=False):
    """A copy of the scene with other images; the same each time."""
    copy = ROOT / 'target' / 'perturbed' / f'{scene.name}-{change}'
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


def scored(binary, scorer, job):
    """The measures of one run; None when it failed."""
    out = ROOT / 'target' / 'perturbed' / 'out' / job['name'].replace(' ', '_')
    views = ['--views', ','.join(job['views'])] if job['views'] else []
    done = subprocess.run([binary, 'reconstruct', job['scene'], '--out', out, *views], capture_output=True, text=True)
    if done.returncode:
        print(f'{job["name"]}: exit code {done.returncode}: {done.stderr.strip()}', file=sys.stderr)
        return None
    run = {'scene': job['truth'], 'out': out}
    program = ['score', '--lines', out / 'lines.json'] if job['measures'] is MEASURES else ['check_real']
    score = score_table.tool(scorer, program[0], run, out / 'model.city.json', *program[1:])
    return score and {name: measure(score) or 0.0 for name, measure in job['measures'].items()}


def table(runs, before, measures):
    """Means over the runs of each scene and number of views; with `before`, differences and their standard errors."""
    rows = [['scene', 'views', 'runs', *measures]]
    runs = {name: run for name, run in runs.items() if measures.keys() <= run.keys()}
    by_group = itertools.groupby(sorted(runs.items(), key=lambda r: (r[1]['group'][0], -r[1]['group'][1])), lambda r: r[1]['group'])
    for (scene, views), group in by_group:
        group = [(now, before[name] if before else None) for name, now in group if not before or name in before]
        cells = [cell([now[m] for now, _ in group], [then[m] for _, then in group] if before else None, m) for m in measures]
        rows.append([scene, str(views), str(len(group)), *cells])
    return results_page.markdown(rows)


def cell(now, then, measure):
    scale, unit, digits = (1, '', 3) if measure.endswith('[m]') else (1, '', 0) if measure.endswith('on roofs') else (100, ' %', 1)
    text = f'{scale * statistics.mean(now):.{digits}f}{unit}'
    if then is None:
        return text
    differences = [scale * (a - b) for a, b in zip(now, then)]
    error = statistics.stdev(differences) / math.sqrt(len(differences)) if len(differences) > 1 else math.nan
    return f'{text} ({statistics.mean(differences):+.{digits}f} ± {error:.{digits}f})'


if __name__ == '__main__':
    sys.exit(main())
