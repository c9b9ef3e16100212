"""Runs of the program whose time is taken, in turns, and the statistics of pairs; `tests/evaluation/bench.py` compares with them."""

import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

# Seconds below which the growth of a stage, or a ratio, cannot be told.
MEASURABLE_S = 0.01
# A stage's row in what `ridgeline reconstruct` and `tests/evaluation/times.mjs` print.
ROW = re.compile(r'^(\w+) +(\d+\.\d+)(?: |$)')


def run(command, threads=1, report=None):
    """One run: seconds of its stages as printed (exact ones where there is a report), of the clock and the processor, and
    peak memory. On one thread it stays on one core where there is taskset."""
    pinned = ['taskset', '-c', str(last_core()), *command] if threads == 1 and shutil.which('taskset') else command
    environment = {**os.environ, 'RAYON_NUM_THREADS': str(threads), 'OMP_NUM_THREADS': str(threads)}
    with tempfile.TemporaryFile('w+') as errors:
        start = time.monotonic()
        process = subprocess.Popen([str(word) for word in pinned], stdout=subprocess.PIPE, stderr=errors, text=True,
                                   env=environment)
        text = process.stdout.read()
        process.stdout.close()
        _, status, usage = os.wait4(process.pid, 0)
        clock = time.monotonic() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            errors.seek(0)
            raise RuntimeError(f'{command[0]}: exit code {process.returncode}\n{errors.read().strip()[-800:]}')
    stages = stages_of(text)
    if report:
        stages = exact(stages, json.loads(report.read_text()).get('seconds', {}))
    return {
        'stages': stages, 'text': text, 'clock': clock, 'user': usage.ru_utime, 'processor': usage.ru_utime + usage.ru_stime,
        # Kilobytes on Linux, bytes on macOS.
        'memory_mb': usage.ru_maxrss / (1e6 if sys.platform == 'darwin' else 1e3),
    }


def reconstruct(program, scene, *options, threads=1):
    """One run of the program on a scene, with the number of views used and of lines, and the segments of each view. Where it
    divides an area into tiles it tells neither views nor stages: 0 and none."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        command = [program, 'reconstruct', scene, '--out', out, *options]
        found = run(command, threads, out / 'report.json')
        report = json.loads((out / 'report.json').read_text())
        counts = {stage['stage']: stage['counts'] for stage in report.get('stages', [])}
        return {**found, 'views': len(report.get('views', [])), 'lines': counts.get('lines', {}).get('lines', 0),
                'segments': json.loads((out / 'segments.json').read_text())['views']}


def last_core():
    """The last of the cores that this process may use: the first one serves interrupts more often."""
    return max(os.sched_getaffinity(0)) if hasattr(os, 'sched_getaffinity') else (os.cpu_count() or 1) - 1


def stages_of(text):
    """Seconds of the stages, in their order, as the program prints them: load and total among them."""
    rows = (ROW.match(line) for line in text.splitlines())
    return {row[1]: float(row[2]) for row in rows if row}


def stages_of_wasm(text):
    """The same of the row of Markdown that tests/evaluation/times.mjs prints."""
    cells = re.findall(r'\| (\w+) (\d+\.\d+) s(?= \|)', text)
    return {name: float(seconds) for name, seconds in cells}


def exact(printed, reported):
    """Printed are two digits: what the report knows better replaces them."""
    return {stage: reported.get(stage, seconds) for stage, seconds in printed.items()}


def in_turns(rounds, variants, tell=lambda text: print(text, flush=True)):
    """What each variant (name -> function) gives in each round; every round runs all of them in turn, so that a drift of the
    machine meets all alike."""
    found = {name: [] for name in variants}
    for place in range(rounds):
        # Every second round the other way round: none always follows the same one.
        for name in list(variants)[::-1 if place % 2 else 1]:
            start = time.monotonic()
            found[name].append(variants[name]())
            tell(f'  round {place + 1} of {rounds}, {name}: {time.monotonic() - start:.1f} s')
    return found


def median_of(runs, measure):
    """Median of what the runs have of it; None where none has it."""
    values = [value for value in map(measure, runs) if value is not None]
    return statistics.median(values) if values else None


def ratio_of(runs, others, measure):
    """Median and quartiles of the ratios of the pairs, runs to others; None where it cannot be told."""
    pairs = [(measure(run), measure(other)) for run, other in zip(runs, others, strict=True)]
    if not pairs or any(value is None for pair in pairs for value in pair):
        return None
    if statistics.median(max(pair) for pair in pairs) < MEASURABLE_S or any(other <= 0 for _, other in pairs):
        return None
    return spread([value / other for value, other in pairs])


def spread(values):
    """Median, lower and upper quartile; the quartiles of one value are itself."""
    if len(values) == 1:
        return values[0], values[0], values[0]
    lower, median, upper = statistics.quantiles(values, n=4, method='inclusive')
    return median, lower, upper


def known(wish, params):
    """What of the wished parameters a program has: an older one refuses names that it does not know."""
    shared = {name: value for name, value in wish.items() if name in params}
    return {name: known(value, params[name]) if isinstance(value, dict) else value for name, value in shared.items()}


def self_test():
    printed = ('6 views, about 208 MB of memory\nstage         seconds\nload             0.30  6 views\n'
               'segments         0.24  6 views, 2641 segments\ntotal            3.61\nwritten to out:\n  model.obj  11 kB\n')
    assert stages_of(printed) == {'load': 0.3, 'segments': 0.24, 'total': 3.61}
    assert exact(stages_of(printed), {'segments': 0.2351, 'idle': 9}) == {'load': 0.3, 'segments': 0.2351, 'total': 3.61}
    assert stages_of_wasm('| suburb | load 0.31 s | half 1.25 s | total 1.56 s |\n\nSweep: 2 in 3.00 s') == \
        {'load': 0.31, 'half': 1.25, 'total': 1.56}
    # A machine that slows down by half changes no ratio, and one disturbed round of five no median.
    others = [{'s': x} for x in (1.0, 1.1, 1.2, 1.3, 1.5)]
    runs = [{'s': 2 * other['s']} for other in others]
    assert all(math.isclose(x, 2) for x in ratio_of(runs, others, lambda run: run['s']))
    runs[2]['s'] *= 10
    assert math.isclose(ratio_of(runs, others, lambda run: run['s'])[0], 2)
    assert ratio_of(runs, others, lambda run: run.get('t')) is None, 'what only one has'
    assert ratio_of([{'s': 1e-4}], [{'s': 2e-4}], lambda run: run['s']) is None, 'what is too short'
    assert median_of(runs, lambda run: run.get('t')) is None
    assert spread([4.0]) == (4, 4, 4) and spread([1, 2, 3, 4, 5]) == (3, 2, 4)
    wish = {'dense': {'enabled': False}, 'new': {'a': 1}, 'roof': {'a': 1, 'b': 2}}
    assert known(wish, {'dense': {'enabled': True}, 'roof': {'b': 0}}) == {'dense': {'enabled': False}, 'roof': {'b': 2}}
    order = []
    in_turns(2, {'a': lambda: order.append('a'), 'b': lambda: order.append('b')}, tell=lambda text: None)
    assert order == ['a', 'b', 'b', 'a']
