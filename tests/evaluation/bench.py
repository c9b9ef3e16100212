#!/usr/bin/env python3
"""What the program takes: against another commit in pairs, against peers, and how it grows; writes docs/bench.md.

    python3 tests/evaluation/bench.py --binary target/release/ridgeline --scenes FOLDER [--before COMMIT] [--scene FOLDER]
                           [--flight FOLDER] [--rounds 5] [--only pairs,peers,growth] [--page docs/bench.md]
    python3 tests/evaluation/bench.py --self-test

pairs: the scene (SCENES/suburb, else the demo) by this program and, of --before, that of another commit, built once in a
worktree of its own and kept in target/bench/programs (a program's path is taken as it is); as by default, and with lines as
the only source of planes; then the core in wasm on one core, and two threads. peers: LSD and EDLines of OpenCV and the line
triangulation of LIMAP, from PyPI, installed once in target/bench/venv. growth: with views (campus-drone), with area and with
photographs (a flight). All in turns, --rounds times, on one core. The script needs Python, git and cargo; Node for wasm.
"""
import argparse
import json
import os
import pathlib
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import textwrap
import time
from functools import partial

from shared import growth_runs, timed_runs
from shared.growth_runs import over_area, over_photographs, over_views
from shared.on_scenes import ROOT
from shared.timed_runs import in_turns, known, median_of, ratio_of, reconstruct, run, spread, stages_of_wasm

KEPT = ROOT / 'target' / 'bench'
PARTS = ['pairs', 'peers', 'growth']
LINES_ALONE = {'sources': ['half_planes', 'line_pairs']}
IN_GREY = {'segments': {'colors': {'detect': False}}}
# Each as pip knows it. OpenCV last: LIMAP brings an OpenCV that may lack EDLines.
PEERS = ['pylimap', 'opencv-contrib-python-headless']
# Stages that take less have no row, seconds.
SHOWN_S = 0.001
# Shares of the processor below which other work has disturbed a run on one core.
UNDISTURBED = 0.97


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--binary', type=pathlib.Path)
    parser.add_argument('--scenes', type=pathlib.Path, default=ROOT.parent / 'shared' / 'scenes')
    parser.add_argument('--before', help='a commit, or the path of a program')
    parser.add_argument('--scene', type=pathlib.Path, help='SCENES/suburb, or the demo where it is missing')
    parser.add_argument('--flight', type=pathlib.Path, default=ROOT.parent / 'shared' / 'flights' / 'sheffield')
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--only', default=','.join(PARTS), help='parts, separated by commas')
    parser.add_argument('--page', type=pathlib.Path, default=ROOT / 'docs' / 'bench.md')
    parser.add_argument('--self-test', action='store_true')
    args = parser.parse_args()
    if args.self_test:
        return self_test()
    if not args.binary or not args.binary.is_file():
        parser.error('--binary names no program')
    parts = args.only.split(',')
    if set(parts) - set(PARTS) or args.rounds < 1:
        parser.error(f'parts are {", ".join(PARTS)}; at least one round')
    args.binary = args.binary.resolve()
    args.scene = (args.scene or first_folder(args.scenes / 'suburb', ROOT / 'www' / 'public' / 'demo')).resolve()
    if not args.scene.is_dir():
        parser.error(f'--scene: there is no folder {args.scene}')
    try:
        before = program_of(args.before) if args.before else None
        return measure(args, parts, before)
    except (RuntimeError, subprocess.CalledProcessError) as why:
        print(f'bench: {why}', file=sys.stderr)
        return 1


def measure(args, parts, before):
    """Runs the parts and writes the page."""
    start, sections, shares = time.monotonic(), [], []
    works = {'pairs': lambda: pairs(args, before, shares), 'peers': lambda: peers(args), 'growth': lambda: growth(args)}
    for part in PARTS:
        if part in parts:
            print(f'{part}:', flush=True)
            begun = time.monotonic()
            section = works[part]()
            print('\n'.join(['', *section, '']))
            print(f'{part} took {time.monotonic() - begun:.0f} s', flush=True)
            sections += section
    head = heading(args, before, shares)
    args.page.write_text('\n'.join(map(wrapped, [*head, *sections])) + '\n')
    print(f'written to {args.page} after {time.monotonic() - start:.0f} s')
    return 0


def first_folder(*folders):
    return next((folder for folder in folders if folder.is_dir()), folders[-1])


# ---- programs -----------------------------------------------------------------------------------

def program_of(wish):
    """The release program of a commit, built where it is not kept yet."""
    if pathlib.Path(wish).is_file():
        return pathlib.Path(wish).resolve()
    try:
        commit = git('rev-parse', '--short=12', '--verify', f'{wish}^{{commit}}')
    except subprocess.CalledProcessError:
        raise RuntimeError(f'{wish} is neither a commit of this repository nor a program') from None
    program = KEPT / 'programs' / commit
    if not program.is_file():
        print(f'building {commit}', flush=True)
        # Outside this tree, whose cargo settings would hold in it too.
        with tempfile.TemporaryDirectory() as folder:
            tree = pathlib.Path(folder) / 'tree'
            git('worktree', 'add', '--detach', str(tree), commit)
            try:
                subprocess.run(['cargo', 'build', '--release'], cwd=tree, check=True,
                               env={**os.environ, 'CARGO_TARGET_DIR': str(KEPT / 'build')})
            finally:
                git('worktree', 'remove', '--force', str(tree))
        program.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(KEPT / 'build' / 'release' / 'ridgeline', program)
    return program


def git(*words):
    return subprocess.run(['git', *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


def reconstruct_with(program, scene, wish):
    """One run with parameters, of which those are left out that the program does not know."""
    params = json.loads(subprocess.run([program, 'params'], check=True, capture_output=True, text=True).stdout)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / 'params.json'
        path.write_text(json.dumps(known(wish, params)))
        return reconstruct(program, scene, '--params', path)


# ---- pairs --------------------------------------------------------------------------------------

def pairs(args, before, shares):
    """The tables of both set-ups, and those of wasm and two threads."""
    section = ['', f'## {"In pairs, stage by stage" if before else "Stage by stage"}', '',
               f'{args.scene.name}, one core. Ratios are the medians of the pairs, in brackets their quartiles; a stage '
               'that takes less than a millisecond has no row, one below 10 ms no ratio.']
    programs = {'before': before, 'now': args.binary} if before else {'now': args.binary}
    for name, wish in (('As by default', {}), ('Lines as the only source of planes', LINES_ALONE)):
        print(f' {name.lower()}:', flush=True)
        variants = {of: partial(reconstruct_with, program, args.scene, wish) for of, program in programs.items()}
        if not wish:
            variants |= ways(args)
        found = in_turns(args.rounds, variants)
        shares += [one['processor'] / one['clock'] for of in programs for one in found[of]]
        section += ['', f'### {name}', '', *pair_table(found, list(programs))]
        if not wish:
            in_other_ways = ['', '## In wasm, and on two threads', '', *ways_table(found)]
    return section + in_other_ways


def pair_table(found, names):
    """Seconds of every stage of one or two programs, and the ratio."""
    rows = [(stage, lambda one, stage=stage: one['stages'].get(stage), 's') for stage in stages_in_order(found, names)]
    rows += [('processor, user', lambda one: one['user'], 's'), ('memory at the peak', lambda one: one['memory_mb'], 'MB')]
    table = [['', *names, 'now / before' if len(names) == 2 else 'quartiles']]
    for name, measure, unit in rows:
        if all((median_of(found[of], measure) or 0) < SHOWN_S for of in names):
            continue
        cells = [told(median_of(found[of], measure), unit) for of in names]
        if len(names) == 2:
            cells.append(told_ratio(ratio_of(found['now'], found['before'], measure)))
        else:
            cells.append(' to '.join(told(x, unit) for x in spread([measure(one) for one in found['now']])[1:]))
        table.append([name, *cells])
    return markdown(table)


def stages_in_order(found, names):
    """Of all programs, in the order in which the newest one that has them runs them; total last."""
    places = {}
    for name in names:
        places |= {stage: place for place, stage in enumerate(found[name][0]['stages'])}
    return sorted(places, key=lambda stage: (stage == 'total', places[stage]))


def ways(args):
    """The same core in wasm on one core, and the program on two threads."""
    variants = {'two threads': lambda: reconstruct(args.binary, args.scene, threads=2)}
    if shutil.which('node') and (ROOT / 'www' / 'src' / 'pkg' / 'ridgeline_bg.wasm').is_file():
        def wasm():
            found = run(['node', ROOT / 'tests' / 'evaluation' / 'times.mjs', args.scene])
            return {**found, 'stages': stages_of_wasm(found['text'])}
        variants['wasm'] = wasm
    return variants


def ways_table(found):
    """Native on one thread beside wasm and two threads, and what the second thread waits."""
    now, two, wasm = found['now'], found['two threads'], found.get('wasm')
    stages = [stage for stage in now[0]['stages'] if stage != 'total']
    table = [['', 'one core', *(['wasm', 'wasm / one core'] if wasm else []), 'two threads', 'two / one']]
    rows = [(stage, lambda one, stage=stage: one['stages'].get(stage)) for stage in stages]
    rows.append(('together', lambda one: sum(one['stages'].get(stage, 0) for stage in stages)))
    for name, measure in rows:
        if median_of(now, measure) < SHOWN_S:
            continue
        cells = [told(median_of(now, measure), 's')]
        if wasm:
            cells += [told(median_of(wasm, measure), 's'), told_ratio(ratio_of(wasm, now, measure))]
        cells += [told(median_of(two, measure), 's'), told_ratio(ratio_of(two, now, measure))]
        table.append([name, *cells])
    waited = statistics.median(2 * one['clock'] - one['processor'] for one in two)
    clock = statistics.median(one['clock'] for one in two)
    lines = markdown(table)
    lines += ['', f'On two threads both together wait for {waited:.2f} s of 2 x {clock:.2f} s by the clock: twice the clock less '
                  'the processor time, reading and writing included.']
    if not wasm:
        lines += ['', 'Not in wasm: there is no Node or no package in www/src/pkg (`make build`).']
    else:
        profile = next((path.name for path in (ROOT / 'target' / 'stamps').glob('profile-*')), None)
        lines += ['', f'wasm: one instance in Node{f" ({profile})" if profile else ""}, `tests/evaluation/times.mjs`; Node compiles it on the '
                  'same core while it runs, which short stages feel most.']
    return lines


# ---- peers --------------------------------------------------------------------------------------

def peers(args):
    """Tables of segments and lines beside those of other programs."""
    section = ['', '## Beside other programs', '', f'{args.scene.name}, one core each, in turns; ratio: theirs to ours.']
    python, failures = environment()
    images, model = args.scene / 'images', model_of(args.scene)
    if not python or not images.is_dir():
        return section + ['', *failures, *([] if images.is_dir() else [f'{args.scene.name} has no folder images/.'])]
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / 'segments.json'

        def ours(wish):
            found = reconstruct_with(args.binary, args.scene, wish)
            if wish is LINES_ALONE:
                path.write_text(json.dumps(found['segments']))
            return found

        def theirs():
            options = ['--segments', path, '--model', model] if model else []
            try:
                found = run([python, ROOT / 'tests' / 'evaluation' / 'shared' / 'peers.py', '--images', images, *options])
            except RuntimeError as why:
                return {what: {'failed': last_line(str(why))} for what in ('segments', 'lines')}
            return json.loads(found['text'].splitlines()[-1])

        if not ours(LINES_ALONE)['views']:
            return section + ['', f'{args.scene.name} is divided into tiles, of which the stages are not told.']
        found = in_turns(args.rounds, {'ours': lambda: ours(LINES_ALONE), 'theirs': theirs,
                                       'ours in grey values': lambda: ours(LINES_ALONE | IN_GREY)})
    section += ['', *segments_table(found)]
    section += ['', *(lines_table(found) if model else ['LIMAP: left out, the scene has no COLMAP text model.'])]
    return section + [line for failure in failures for line in ('', failure)]


def environment():
    """The Python of an environment with the peers, and what did not install."""
    folder = KEPT / 'venv'
    python = folder / ('Scripts' if os.name == 'nt' else 'bin') / 'python'
    failures = []
    if not python.is_file():
        done = subprocess.run([sys.executable, '-m', 'venv', folder], capture_output=True, text=True)
        if done.returncode:
            return None, [f'No environment for them: {last_line(done.stdout + done.stderr)}']
    for package in PEERS:
        if subprocess.run([python, '-m', 'pip', 'show', '--quiet', package], capture_output=True).returncode:
            print(f'  installing {package}', flush=True)
            done = subprocess.run([python, '-m', 'pip', 'install', '--quiet', package], capture_output=True, text=True)
            if done.returncode:
                failures.append(f'{package} does not install here: {last_line(done.stderr)}')
    return python, failures


def last_line(text):
    errors = [line for line in text.splitlines() if 'ERROR' in line] or text.strip().splitlines() or ['no reason given']
    return errors[-1]


def model_of(scene):
    """The folder of the scene's COLMAP text model."""
    models = (path.parent for path in sorted(scene.rglob('images.txt')))
    return next((model for model in models if (model / 'cameras.txt').is_file()), None)


def segments_table(found):
    failed = failure_of(found['theirs'], 'segments')
    if failed:
        return [f'OpenCV: {failed}']
    ours, grey = found['ours'], found['ours in grey values']
    an_image = lambda one: one['stages']['segments'] / one['views']
    of = lambda name: lambda one: one['segments'][name]['seconds']
    count = lambda runs: sum(len(view['segments']) for view in runs[0]['segments'])
    theirs = found['theirs']
    table = [['segments', 's an image', 'found', 'to ours in grey values']]
    table.append(['ours, colours (default)', told(median_of(ours, an_image), 's'), count(ours),
                  told_ratio(pairs_of(ours, grey, an_image, an_image))])
    table.append(['ours, grey values', told(median_of(grey, an_image), 's'), count(grey), '1'])
    for name in ('LSD', 'EDLines'):
        table.append([name, told(median_of(theirs, of(name)), 's'), theirs[0]['segments'][name]['segments'],
                      told_ratio(pairs_of(theirs, grey, of(name), an_image))])
    return markdown(table) + [
        '', f'OpenCV {theirs[0]["segments"]["version"]} with its own settings, in grey values. Ours is the time of the stage of '
        f'a run of {ours[0]["views"]} images, divided by them; it includes the uncertainties of the segments. Found: in all '
        'images, 15 pixels and longer. Decoding is not counted.']


def lines_table(found):
    failed = failure_of(found['theirs'], 'lines')
    if failed:
        return [f'LIMAP: {failed}']
    ours, theirs = found['ours'], found['theirs']
    mine = lambda one: sum(one['stages'].get(stage, 0) for stage in ('matches', 'lines'))
    limap = lambda one: one['lines']['seconds'] + one['lines']['adjustment_seconds']
    table = [['3D lines from the same segments', 's', 'lines', 'to ours'],
             ['ours, matches and lines', told(median_of(ours, mine), 's'), ours[0]['lines'], '1'],
             ['LIMAP, triangulation and adjustment', told(median_of(theirs, limap), 's'), theirs[0]['lines']['lines'],
              told_ratio(pairs_of(theirs, ours, limap, mine))]]
    return markdown(table) + [
        '', f'pylimap {theirs[0]["lines"]["version"]} with its own settings: segments of 20 pixels and longer; exhaustive matching '
        f'of the {theirs[0]["lines"]["images"]} images, because a matcher of descriptors would need the images; no points and no '
        'vanishing points; cameras fixed. Ours compares grey values along the edges besides. How many of the lines are true is '
        'not compared here.']


def failure_of(theirs, what):
    return next((one[what]['failed'] for one in theirs if 'failed' in one[what]), None)


def pairs_of(runs, others, measure, of_others):
    """Median and quartiles of the ratios of what two kinds of runs measure."""
    return spread([measure(run) / of_others(other) for run, other in zip(runs, others, strict=True)])


# ---- growth -------------------------------------------------------------------------------------

def growth(args):
    section = ['', '## Growth', '', 'Processor seconds of one core as by default, medians; *power*: slope of the straight line through the '
               'logarithms, of stages that take 0.01 s and more throughout.']
    drone = args.scenes / 'campus-drone'
    if drone.is_dir():
        section += ['', *over_views(args.binary, drone, args.rounds)]
    else:
        section += ['', f'With views: left out, there is no {drone.name}.']
    model = model_of(args.flight) if args.flight.is_dir() else None
    if model:
        flight = args.binary, args.flight, model, args.rounds
        section += ['', *over_area(*flight), '', *over_photographs(*flight)]
    else:
        section += ['', f'With area and photographs: left out, {args.flight.name} is no flight with a COLMAP text model.']
    return section


# ---- the page -----------------------------------------------------------------------------------

def wrapped(line):
    """Prose in lines that a person reads; headings and rows of tables as they are."""
    return line if line.startswith(('|', '#')) else textwrap.fill(line, 100, break_long_words=False, break_on_hyphens=False)


def heading(args, before, shares):
    now = git('describe', '--always', '--dirty', '--exclude', '*')
    # A program's path says nothing to a reader.
    pair = '' if not before else ' against another program' if pathlib.Path(args.before).is_file() else f' against {args.before}'
    lines = ['# Time and memory', '', f'Written by `make bench` (`tests/evaluation/bench.py`): {now}{pair}, {args.rounds} '
             f'round{"s" * (args.rounds > 1)} in turns, on {cores()}. Seconds and megabytes are medians.']
    least = min(shares, default=1)
    if least < UNDISTURBED:
        lines += ['', f'**Other work disturbed it**: a run on one core had {100 * least:.0f} % of it at the least. Ratios hold '
                  'better than seconds.']
    if args.rounds < 5:
        lines += ['', 'Fewer than five rounds: a trial, not a measurement.']
    return lines


def cores():
    try:
        model = re.search(r'model name\s*: (.*)', pathlib.Path('/proc/cpuinfo').read_text())
    except OSError:
        model = None
    return f'{os.cpu_count()} cores ({model[1] if model else platform.machine()})'


def told(value, unit):
    if value is None:
        return ''
    return f'{value:.0f} MB' if unit == 'MB' else f'{value:.3f}' if value < 0.1 else f'{value:.2f}'


def told_ratio(ratio):
    return '' if ratio is None else '{:.2f} ({:.2f} to {:.2f})'.format(*ratio)


def markdown(table):
    head, *rows = [[str(cell) for cell in row] for row in table]
    return [row(head), '|---' * len(head) + '|', *map(row, rows)]


def row(cells):
    return '| ' + ' | '.join(cells) + ' |'


def self_test():
    timed_runs.self_test()
    growth_runs.self_test()
    once = lambda stages, user, memory: {'stages': stages, 'user': user, 'memory_mb': memory, 'clock': 4.0, 'processor': 6.0}
    now = [once({'load': 0.2, 'segments': 1.0, 'dense': 2.0, 'total': 3.2}, 3.3, 100.0)] * 3
    before = [once({'load': 0.1, 'segments': 2.0, 'sorting': 0.1, 'borders': 0.1, 'areas': 0.1, 'total': 2.4}, 2.5, 50.0)] * 3
    found = {'before': before, 'now': now, 'two threads': now}
    table = pair_table(found, ['before', 'now'])
    assert table[0] == '|  | before | now | now / before |' and table[2].startswith('| load |'), table
    assert '| segments | 2.00 | 1.00 | 0.50 (0.50 to 0.50) |' in table
    assert '| dense |  | 2.00 |  |' in table, 'what only one has stands alone'
    assert table[-3].startswith('| total |') and table[-1] == '| memory at the peak | 50 MB | 100 MB | 2.00 (2.00 to 2.00) |'
    assert pair_table({'now': now}, ['now'])[-1] == '| memory at the peak | 100 MB | 100 MB to 100 MB |'
    assert any('wait for 2.00 s of 2 x 4.00 s' in line for line in ways_table(found))
    peers_found = [{'lines': {'failed': 'ImportError: no'}}]
    assert lines_table({'theirs': peers_found}) == ['LIMAP: ImportError: no']
    print('bench: all well')
    return 0


if __name__ == '__main__':
    sys.exit(main())
