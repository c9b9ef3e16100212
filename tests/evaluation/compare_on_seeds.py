#!/usr/bin/env python3
"""Judge the program on random scenes that chose nothing, or two programs in pairs.

    python3 tests/evaluation/compare_on_seeds.py --binary target/release/ridgeline --seeds 518 to 530 [--before OTHER_BINARY]
                           [--generator ../shared/generate] [--drawn FOLDER] [--page]

Draws the scenes of these seeds (500 to 999; those in docs/results/fresh-seeds.md have judged already) unless they stand in FOLDER
(~/.cache/ridgeline/scenes), reconstructs and scores them by the score.py beside the generator's folder, and prints: the
means with the standard errors of the differences; the share of facets above 10 m2 that are found, by number of views,
noise, kind of building and texture; and the calibration error of the probabilities of facets and of lines. The python
that runs this runs the generator too: it needs bpy beside numpy, scipy and shapely where scenes are missing.
"""
import argparse
import collections
import json
import math
import pathlib
import re
import statistics
import subprocess
import sys
import time

import numpy as np

import calibrate
from shared import logistic, on_scenes, results_page
from shared.on_scenes import ROOT

MEASURES = {**on_scenes.MEASURES, 'time [s]': lambda s: s['seconds']}
# Rays for a scene's pixels: as those in ../shared/scenes.
SAMPLES = 6
# Facets of this area and above count, square metres.
LEAST_AREA_M2 = 10
RUNS = ROOT / 'target' / 'judge'


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--binary', required=True, type=pathlib.Path)
    parser.add_argument('--before', type=pathlib.Path, help='a program to compare with, scene by scene')
    parser.add_argument('--seeds', required=True, nargs='+', help='numbers, and "A to B" for all between')
    parser.add_argument('--generator', type=pathlib.Path, default=ROOT.parent / 'shared' / 'generate')
    parser.add_argument('--drawn', type=pathlib.Path, default=pathlib.Path.home() / '.cache' / 'ridgeline' / 'scenes')
    parser.add_argument('--page', action='store_true', help='rewrite the section of docs/results.md')
    args = parser.parse_args()
    seeds = seeds_of(' '.join(args.seeds))
    used = [seed for seed in seeds if not 500 <= seed <= 999]
    if used:
        parser.error(f'seeds that judge are 500 to 999, not {used}')
    scorer = args.generator.parent / 'score' / 'score.py'
    if not (args.generator / 'generate.py').is_file() or not scorer.is_file():
        print(f'judge: skipped, {args.generator} has no generate.py or {scorer} is missing')
        return 0
    scenes = [scene for scene in (drawn(args, seed) for seed in seeds) if scene]
    programs = [args.before, args.binary] if args.before else [args.binary]
    scores = [{scene.name: score for scene in scenes if (score := run(program, scorer, scene, place))}
              for place, program in enumerate(programs)]
    both = [name for name in scores[0] if all(name in of for of in scores)]
    scores = [{name: of[name] for name in both} for of in scores]
    print_means(scores)
    if args.page:
        results_page.put_section(results_page.RESULTS, 'seeds', section(' '.join(args.seeds), scores[-1]))
    faces = [list(faces_of(scene, scores[-1][scene.name])) for scene in scenes if scene.name in both]
    print_kinds([face for of_scene in faces for face in of_scene])
    truth = on_scenes.loaded(scorer)
    print_calibration(truth, [scene for scene in scenes if scene.name in both], len(programs) - 1)
    return 0


def seeds_of(words):
    """`518 to 520, 530` -> [518, 519, 520, 530]"""
    found = []
    for first, last in re.findall(r'(\d+)(?:\s*to\s*(\d+))?', words):
        found += range(int(first), int(last or first) + 1)
    return found


def drawn(args, seed):
    """The folder of a scene; None where it could not be drawn."""
    folder = args.drawn / f'r{seed}'
    if not (folder / 'truth' / 'edges.json').is_file():
        folder.parent.mkdir(parents=True, exist_ok=True)
        command = [sys.executable, args.generator / 'generate.py', f'random:{seed}', folder, '--spp', str(SAMPLES)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            print(f'judge: seed {seed} was not drawn: {done.stderr.strip()[-300:]}', file=sys.stderr)
            return None
    return folder


def run(program, scorer, scene, place):
    """The score of a program on a scene; a run that finds nothing counts, one that fails is named and left out."""
    out = RUNS / str(place) / scene.name
    out.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()
    done = subprocess.run([program.resolve(), 'reconstruct', scene, '--out', out], capture_output=True, text=True)
    seconds = time.monotonic() - start
    result = out / 'score.json'
    command = [sys.executable, scorer, scene, out / 'model.city.json', '--lines', out / 'lines.json', '--json', result]
    if done.returncode or subprocess.run(command, capture_output=True).returncode:
        print(f'judge: {program} fails on {scene.name}: {done.stderr.strip()[-300:]}', file=sys.stderr)
        return None
    return {**json.loads(result.read_text()), 'seconds': seconds}


def print_means(scores):
    print(f'\n{len(scores[-1])} scenes: {", ".join(scores[-1])}\n')
    print('| |', ' | '.join(MEASURES), '|')
    print('|---' * (1 + len(MEASURES)) + '|')
    names = ['before', 'now'] if len(scores) == 2 else ['now']
    columns = [[[measure(score) for score in of.values()] for measure in MEASURES.values()] for of in scores]
    for name, of in zip(names, columns):
        print('|', name, '|', ' | '.join(f'{statistics.mean(known(values)):.3f}' for values in of), '|')
    if len(scores) == 2:
        print('| difference |', ' | '.join(difference(*pair) for pair in zip(*columns)), '|')


def section(seeds, scores):
    """What docs/results.md says of the program on these seeds."""
    means = [f'{statistics.mean(known([measure(score) for score in scores.values()])):.2f}' for measure in on_scenes.MEASURES.values()]
    return (f'Of program {results_page.program_here()}.\n\n'
            + results_page.markdown([['seeds', 'scenes', *on_scenes.MEASURES], [seeds, str(len(scores)), *means]]))


def known(values):
    return [value for value in values if value is not None] or [math.nan]


def difference(before, now):
    """Mean of the paired differences and its standard error."""
    pairs = [b - a for a, b in zip(before, now) if a is not None and b is not None]
    if len(pairs) < 2:
        return ''
    return f'{statistics.mean(pairs):+.3f} +- {statistics.stdev(pairs) / math.sqrt(len(pairs)):.3f}'


def faces_of(scene, score):
    """What each large true facet of a scene is, and whether it was found."""
    truth = json.loads((scene / 'truth' / 'roofs.json').read_text())
    views = len(json.loads((scene / 'cameras.json').read_text())['views'])
    noise = re.search(r'noise ([\d.]+) / 255', (scene / 'scene.md').read_text())
    missed = {face['id'] if isinstance(face, dict) else face for face in score['faces']['missed_faces']}
    for building in truth['buildings']:
        for face in building['faces']:
            if face['area_m2'] > LEAST_AREA_M2:
                yield {
                    'found': face['id'] not in missed,
                    'views': '5 and more' if views >= 5 else '3 and 4',
                    'noise': 'unknown' if noise is None else 'below 2.5' if float(noise[1]) < 2.5 else 'from 2.5 on',
                    'kind of building': building['type'].removeprefix('row_').removesuffix('_dormer'),
                    'texture': face['texture_class'],
                }


def print_kinds(faces):
    print('\n| facets above 10 m2 | number | found |')
    print('|---|---|---|')
    for by in ('views', 'noise', 'kind of building', 'texture'):
        groups = collections.defaultdict(list)
        for face in faces:
            groups[face[by]].append(face['found'])
        for name, found in sorted(groups.items()):
            print(f'| {by}: {name} | {len(found)} | {100 * statistics.mean(found):.0f} % |')


def print_calibration(truth, scenes, place):
    found = {'facets': [], 'lines': [], 'model_lines': []}
    for scene in scenes:
        judged = json.loads((RUNS / str(place) / scene.name / 'evidence.json').read_text())
        found['facets'] += calibrate.facets_of(truth, scene, [judged])
        for kind in ('lines', 'model_lines'):
            found[kind] += calibrate.lines_of(truth, scene, judged[kind])
    print()
    for kind, candidates in found.items():
        true = np.array([candidate['true'] for candidate in candidates], float)
        table = calibrate.read_table(calibrate.TABLES / f'{kind}.json')
        features = {name: np.array([c['values'][name] for c in candidates]) for name in table[1]}
        odds = logistic.odds_of(table, features)
        print(f'{kind.replace("_", " ")}: {len(true)}, {100 * true.mean():.1f} % true, calibration error '
              f'{logistic.calibration_error(true, odds):.3f}')


if __name__ == '__main__':
    sys.exit(main())
