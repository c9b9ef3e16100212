#!/usr/bin/env python3
"""Runs examples/cluster/Snakefile on a small block while processes are killed (kill -9) at random moments: in turn one that works
on a tile, Snakemake itself, and any. Every tile is killed when it is first tried, besides. Tried again with more memory,
and resumed, it gives the bytes of undisturbed commands.

    python3 tests/evaluation/interrupted_block.py --binary target/debug/ridgeline [--snakemake "python3 -m snakemake"] [--times 3] [--seed 1]

Says that it skips where there is no Snakemake (pip install snakemake), or no /proc that tells processes.
"""
import argparse
import os
import pathlib
import random
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Two tiles of the planted house, and one that nothing shows.
OPTIONS = "--roi=-31,-31,200,31 --ground-z 0"
TILE_M = "120"
# What is killed, in turn.
TURNS = ("tile", "engine", "any")
# Longest that a run without a kill is waited for, seconds.
PATIENCE_S = 900


def files_in(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def by_hand(binary, scene, folder):
    """Parts and model of the commands, one after the other, and the seconds of each tile."""
    plan, out = folder / "plan", folder / "model"
    run = lambda *args: subprocess.run([binary, *args], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    run("plan", scene, "--tile", TILE_M, *shlex.split(OPTIONS), "--out", plan)
    seconds = {}
    for tile in ("1", "2", "3"):
        start = time.monotonic()
        run("tile", plan, tile)
        seconds[tile] = time.monotonic() - start
    run("join", plan, "--out", out)
    return files_in(plan / "parts"), files_in(out), seconds


class Process:
    """A process of the run: those whose working directory is the run's."""

    def __init__(self, pid, words):
        self.pid = pid
        self.words = words

    @property
    def tile(self):
        """The tile that it works on, if it is `ridgeline tile`."""
        named = [pathlib.Path(word).name for word in self.words[:1]] == ["ridgeline"]
        return self.words[3] if named and len(self.words) > 3 and self.words[1] == "tile" else None

    def __str__(self):
        return f"ridgeline tile {self.tile}" if self.tile else " ".join(self.words)[:60]


def processes_in(work):
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            if pathlib.Path(os.readlink(entry / "cwd")) != work or (entry / "stat").read_text().rsplit(")", 1)[1].split()[0] == "Z":
                continue
            words = (entry / "cmdline").read_bytes().decode(errors="replace").split("\0")[:-1]
        except (OSError, IndexError):
            continue
        if words:
            found.append(Process(int(entry.name), words))
    return sorted(found, key=lambda process: process.pid)


class Killer:
    """Kills processes of a run at random moments; a generator with a seed draws moments and processes."""

    def __init__(self, work, kills, seconds, seed):
        self.work, self.left, self.seconds = work, kills, seconds
        self.random = random.Random(seed)
        self.met = []
        # When each process that works on a tile is to be killed.
        self.moments = {}
        # When another process is to be killed.
        self.moment = None

    def look(self, engine):
        """Kills one process if its moment has come; `engine` is the number of Snakemake's own."""
        if self.left == 0:
            return
        now = time.monotonic()
        running = processes_in(self.work)
        due = None
        turn = TURNS[len(self.met) % len(TURNS)]
        if turn == "tile":
            for process in running:
                if process.tile and process.pid not in self.moments:
                    self.moments[process.pid] = now + self.random.uniform(0.0, 0.9 * self.seconds[process.tile])
            due = next((p for p in running if p.tile and now >= self.moments[p.pid]), None)
        elif self.moment is None:
            self.moment = now + self.random.uniform(0.0, max(self.seconds.values()))
        elif now >= self.moment and running:
            own = [process for process in running if process.pid == engine]
            due, self.moment = self.random.choice(own if turn == "engine" and own else running), None
        if due is None:
            return
        try:
            os.kill(due.pid, signal.SIGKILL)
        except ProcessLookupError:
            return
        self.moments.clear()
        self.met.append(due)
        self.left -= 1
        print(f"  killed: {due}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--binary", required=True, type=pathlib.Path)
    parser.add_argument("--snakemake", default=os.environ.get("SNAKEMAKE", f"{sys.executable} -m snakemake"))
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    engine = shlex.split(args.snakemake)
    try:
        found = subprocess.run([*engine, "--version"], capture_output=True, text=True)
    except OSError:
        found = None
    if found is None or found.returncode:
        print(f"skipped: there is no Snakemake ({args.snakemake}); pip install snakemake")
        return
    if not pathlib.Path("/proc/self/cwd").exists():
        print("skipped: there is no /proc that tells processes")
        return
    binary = args.binary.resolve()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder).resolve()
        subprocess.run([binary.parent / "examples" / "synthetic", folder], check=True)
        scene = folder / "l"
        parts, model, seconds = by_hand(binary, scene, folder / "by_hand")
        # Every tile is killed when it is first tried, as for want of memory.
        program = folder / "ridgeline"
        program.write_text(
            f'#!/bin/bash\nif [ "$1" = tile ] && mkdir "{folder}/tried-$3" 2> /dev/null; then kill -9 $$; fi\n'
            f'exec "{binary}" "$@"\n'
        )
        program.chmod(0o755)
        config = [f"scene={scene}", f"tile={TILE_M}", f"options={OPTIONS}", f"ridgeline={program}"]
        command = [*engine, "-s", ROOT / "examples/cluster/Snakefile", "-c2", "--nolock", "--rerun-incomplete", "--config", *config]
        work = folder / "work"
        work.mkdir()
        start = time.monotonic()
        killer = Killer(work, args.times, seconds, args.seed)
        log_path = folder / "log"
        runs = 0
        # A tile that is killed three times ends Snakemake, as does a kill of its own; then it is run again.
        while True:
            runs += 1
            kills_before = len(killer.met)
            begun = time.monotonic()
            with open(log_path, "ab") as log:
                engine_run = subprocess.Popen(command, cwd=work, stdout=log, stderr=log, start_new_session=True)
                while engine_run.poll() is None and time.monotonic() < begun + PATIENCE_S:
                    killer.look(engine_run.pid)
                    time.sleep(0.01)
                ended = engine_run.poll()
            if ended is None:
                os.killpg(engine_run.pid, signal.SIGKILL)
                sys.exit(f"Snakemake does not end:\n{log_path.read_text()}")
            if ended == 0 and killer.left == 0:
                break
            if ended == 0:
                # There was not enough to kill: a tile and the model are made anew.
                killer.random.choice(sorted((work / "plan" / "parts").glob("*.part"))).unlink()
                shutil.rmtree(work / "model")
            elif len(killer.met) == kills_before:
                sys.exit(f"Snakemake failed:\n{log_path.read_text()}")
        # The first try asked for the least, 200 MB, the second one for twice that.
        text = log_path.read_text()
        if "mem_mb=200," not in text or "mem_mb=400," not in text:
            sys.exit(f"no second try with more memory:\n{text}")
        of_tiles = [process for process in killer.met if process.tile]
        if len(of_tiles) < -(-args.times // len(TURNS)):
            sys.exit(f"only {len(of_tiles)} kills met `ridgeline tile`")
        # What a killed Snakemake had started may still be running.
        while processes_in(work):
            time.sleep(0.05)
        whole = files_in(work / "plan" / "parts"), files_in(work / "model")
        if whole[0].keys() != parts.keys() or whole[1].keys() != model.keys():
            sys.exit(f"other files: {list(whole[0])}, {list(whole[1])}")
        differing = [name for of, by in zip(whole, (parts, model)) for name in by if of[name] != by[name]]
        # The two plans name their scene by the same path, so that the parts are the same, too.
        if differing:
            sys.exit(f"other bytes: {differing}")
        print(
            f"Snakemake {found.stdout.strip()}, every tile tried twice, {len(killer.met)} kills at random moments, "
            f"{len(of_tiles)} of them of `ridgeline tile`, {runs} runs: {len(parts)} parts and {len(model)} files as by hand, "
            f"{time.monotonic() - start:.0f} s"
        )


main()
