#!/usr/bin/env python3
"""Runs cluster/Snakefile on a small block. Each tile is killed when it is first tried, and once Snakemake with all its
jobs; tried again with more memory, and resumed, it gives the bytes of undisturbed commands.

    python3 tests/cluster.py --binary target/debug/ridgeline [--snakemake "python3 -m snakemake"]

Says that it skips where there is no Snakemake (pip install snakemake).
"""
import argparse
import os
import pathlib
import shlex
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Two tiles of the planted house, and one that nothing shows.
OPTIONS = "--roi=-31,-31,200,31 --ground-z 0"
TILE_M = "120"


def files_in(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def by_hand(binary, scene, folder):
    """Parts and model of the commands, one after the other."""
    plan, out = folder / "plan", folder / "model"
    run = lambda *args: subprocess.run([binary, *args], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    run("plan", scene, "--tile", TILE_M, *shlex.split(OPTIONS), "--out", plan)
    for tile in ("1", "2", "3"):
        run("tile", plan, tile)
    run("join", plan, "--out", out)
    return files_in(plan / "parts"), files_in(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--binary", required=True, type=pathlib.Path)
    parser.add_argument("--snakemake", default=os.environ.get("SNAKEMAKE", f"{sys.executable} -m snakemake"))
    args = parser.parse_args()
    engine = shlex.split(args.snakemake)
    try:
        found = subprocess.run([*engine, "--version"], capture_output=True, text=True)
    except OSError:
        found = None
    if found is None or found.returncode:
        print(f"skipped: there is no Snakemake ({args.snakemake}); pip install snakemake")
        return
    binary = args.binary.resolve()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        subprocess.run([binary.parent / "examples" / "synthetic", folder], check=True)
        scene = folder / "l"
        parts, model = by_hand(binary, scene, folder / "by_hand")
        # Every tile is killed when it is first tried, as for want of memory.
        program = folder / "ridgeline"
        program.write_text(
            f'#!/bin/bash\nif [ "$1" = tile ] && mkdir "{folder}/tried-$3" 2> /dev/null; then kill -9 $$; fi\n'
            f'exec "{binary}" "$@"\n'
        )
        program.chmod(0o755)
        config = [f"scene={scene}", f"tile={TILE_M}", f"options={OPTIONS}", f"ridgeline={program}"]
        command = [*engine, "-s", ROOT / "cluster/Snakefile", "-c2", "--nolock", "--config", *config]
        work = folder / "work"
        work.mkdir()
        start = time.monotonic()
        # Killed with all its jobs as soon as a part is there.
        with open(folder / "log", "wb") as log:
            engine_run = subprocess.Popen(command, cwd=work, stdout=log, stderr=log, start_new_session=True)
            while engine_run.poll() is None and not list((work / "plan").glob("parts/*.part")):
                time.sleep(0.05)
            was_running = engine_run.poll() is None
            if was_running:
                os.killpg(engine_run.pid, signal.SIGKILL)
            engine_run.wait()
        if not was_running:
            sys.exit(f"Snakemake ended too soon:\n{(folder / 'log').read_text()}")
        # The first try asked for the least, 200 MB, the second one for twice that.
        first_log = (folder / "log").read_text()
        if "mem_mb=200," not in first_log or "mem_mb=400," not in first_log:
            sys.exit(f"no second try with more memory:\n{first_log}")
        command.insert(-len(config) - 1, "--rerun-incomplete")
        resumed = subprocess.run(command, cwd=work, capture_output=True, text=True)
        if resumed.returncode:
            sys.exit(f"Snakemake failed:\n{resumed.stdout}{resumed.stderr}")
        whole = files_in(work / "plan" / "parts"), files_in(work / "model")
        if whole[0].keys() != parts.keys() or whole[1].keys() != model.keys():
            sys.exit(f"other files: {list(whole[0])}, {list(whole[1])}")
        differing = [name for of, by in zip(whole, (parts, model)) for name in by if of[name] != by[name]]
        # The two plans name their scene by the same path, so that the parts are the same, too.
        if differing:
            sys.exit(f"other bytes: {differing}")
        print(f"Snakemake {found.stdout.strip()}, killed and resumed, every tile tried twice: {len(parts)} parts and {len(model)} files as by hand, "
              f"{time.monotonic() - start:.0f} s")


main()
