#!/usr/bin/env python3
"""Orients photographs alone and compares with cameras that are known: the tables of docs/results/photographs-alone.md.

    python3 tests/evaluation/orient_table.py --binary target/release/ridgeline --scenes FOLDER [--only NAME,...] [--lens K1,K2]
    python3 tests/evaluation/orient_table.py --binary target/release/ridgeline --photographs FOLDER --against MODEL

FOLDER of scenes holds one folder per scene with images/ and cameras.json (K, R, C; truth/cameras_true.json where that is
more exact). Their photographs are resampled through a lens with the radial terms K1, K2 (of COLMAP's RADIAL; 0,0 leaves
them as they are), and the focal length is stated as it is then. Scenes whose photographs are parts of larger ones (principal
point outside of them) are left out: they show too small an angle to calibrate a camera. MODEL is a folder with another program's cameras.txt and
images.txt, as text. All differences are those after the similarity of the projection centres with the least squares.
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image
from scipy.ndimage import map_coordinates

HEAD = ('| scene | photographs | oriented | points | rms [px] | focal length (true) [px] | position rms [m] | '
        'in ground pixels | of the path | rotation median, max [deg] |')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--binary', required=True, type=pathlib.Path)
    parser.add_argument('--scenes', type=pathlib.Path)
    parser.add_argument('--only', default='')
    parser.add_argument('--lens', default='-0.08,0.03')
    parser.add_argument('--photographs', type=pathlib.Path)
    parser.add_argument('--against', type=pathlib.Path)
    args = parser.parse_args()
    args.binary = args.binary.resolve()
    print(HEAD + '\n' + '|---' * HEAD.count(' |') + '|')
    if args.photographs:
        row(args.photographs.name, args, args.photographs, colmap_model(args.against), [])
        return
    lens = [float(term) for term in args.lens.split(',')]
    names = args.only.split(',') if args.only else sorted(p.parent.name for p in args.scenes.glob('*/cameras.json'))
    for name in filter(lambda name: is_whole(args.scenes / name), names):
        with tempfile.TemporaryDirectory() as folder:
            known = through_lens(args.scenes / name, pathlib.Path(folder), lens)
            focal = next(iter(known.values()))[0]
            row(name, args, pathlib.Path(folder), known, ['--focal', str(focal)])


def row(name, args, photographs, known, options):
    """One line of the table; `known` gives focal length, R (cam_from_world) and C by stem of the photograph."""
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run([args.binary, 'orient', photographs, '--out', out, *options], capture_output=True, text=True)
        if done.returncode != 0:
            print(f'| {name} | {len(known)} | {done.stderr.strip().splitlines()[-1]} |' + ' |' * 7, flush=True)
            return
        report = json.loads((pathlib.Path(out) / 'orientation.json').read_text())
        found = colmap_model(pathlib.Path(out))
        heights = points_of(pathlib.Path(out) / 'points3D.txt')
    both = sorted(set(found) & set(known))
    ours, theirs = (np.array([of[stem][2] for stem in both]) for of in (found, known))
    scale, turn, shift = similarity(ours, theirs)
    rms = np.sqrt(np.mean(np.sum((scale * ours @ turn.T + shift - theirs) ** 2, axis=1)))
    angles = [angle_deg(found[stem][1] @ turn.T @ known[stem][1].T) for stem in both]
    path = np.sum(np.linalg.norm(np.diff(theirs, axis=0), axis=1))
    depth = scale * np.median([np.median((heights - c) @ r[2]) for _, r, c in (found[stem] for stem in both)])
    focal, sigmas = report['cameras'][0]['parameters'][0], report['cameras'][0]['sigmas']
    deviation = f' +- {sigmas[0]:.1f}' if sigmas else ''
    true_focal = known[both[0]][0]
    print(f'| {name} | {len(known)} | {len(both)} | {report["points"]} | {report["rms_px"]:.2f} | {focal:.1f}{deviation} '
          f'({true_focal:.1f}) | {rms:.3f} | {rms / (depth / true_focal):.2f} | {100 * rms / path:.2f} % | '
          f'{np.median(angles):.3f}, {max(angles):.3f} |', flush=True)


def is_whole(scene):
    """Is the principal point of all photographs in their middle half?"""
    views = json.loads((scene / 'cameras.json').read_text())['views']
    sides = [(view['K'][axis][2] / view[side]) for view in views for axis, side in enumerate(('width', 'height'))]
    return all(0.25 < share < 0.75 for share in sides)


def through_lens(scene, out, lens):
    """Writes the photographs of a scene as a lens with radial terms shows them; returns the cameras by stem."""
    exact = scene / 'truth' / 'cameras_true.json'
    views = json.loads((exact if exact.exists() else scene / 'cameras.json').read_text())['views']
    known = {}
    for view in views:
        k, r, c = (np.array(view[key], float) for key in 'KRC')
        f, source = k[0, 0], scene / 'images' / view['file']
        if not any(lens):
            shutil.copy(source, out / view['file'])
            known[pathlib.Path(view['file']).stem] = f, r, c
            continue
        pixels = np.asarray(Image.open(source).convert('RGB'), float)
        height, width = pixels.shape[:2]
        y, x = np.mgrid[0:height, 0:width] + 0.5
        # A little longer, so that the corners of the new photograph lie in the old one.
        longer = f * max(1.0, largest(lens, np.hypot(width, height) / 2 / f))
        ray = undistorted(np.stack([x - k[0, 2], y - k[1, 2]]) / longer, lens)
        at = [ray[1] * f + k[1, 2] - 0.5, ray[0] * f + k[0, 2] - 0.5]
        shown = np.stack([map_coordinates(pixels[..., i], at, order=3, mode='nearest') for i in range(3)], axis=-1)
        target = out / f'{pathlib.Path(view["file"]).stem}.png'
        Image.fromarray(np.clip(np.round(shown), 0, 255).astype(np.uint8)).save(target)
        known[target.stem] = longer, r, c
    return known


def undistorted(seen, lens):
    """Ideal image coordinates of distorted ones, by Newton's method on the radius."""
    measured = np.linalg.norm(seen, axis=0)
    r = measured.copy()
    for _ in range(20):
        value = r * (1 + lens[0] * r**2 + lens[1] * r**4) - measured
        r -= value / (1 + 3 * lens[0] * r**2 + 5 * lens[1] * r**4)
    return seen * np.divide(r, measured, out=np.ones_like(r), where=measured > 0)


def largest(lens, radius):
    """By how much a lens enlarges the ideal radius of the corner at most."""
    r = np.linspace(0.01, 1, 50) * radius
    return float(np.max(undistorted(np.stack([r, 0 * r]), lens)[0] / r))


def colmap_model(folder):
    """Focal length, R and C by stem of the photograph."""
    lines = [line.split() for line in (folder / 'cameras.txt').read_text().splitlines() if line and line[0] != '#']
    focal = {line[0]: float(line[4]) for line in lines}
    images = [line for line in (folder / 'images.txt').read_text().splitlines() if not line.startswith('#')]
    known = {}
    # Every other line holds image points, and may be empty.
    for line in (text.split() for text in images if len(text.split()) == 10 and not text.split()[9].isdigit()):
        w, x, y, z = (float(q) for q in line[1:5])
        r = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                      [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                      [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        known[pathlib.Path(line[9]).stem] = focal[line[8]], r, -r.T @ np.array(line[5:8], float)
    return known


def points_of(file):
    lines = [line.split() for line in file.read_text().splitlines() if line and line[0] != '#']
    return np.array([line[1:4] for line in lines], float)


def similarity(a, b):
    """Scale, rotation and shift from points to others (Umeyama 1991)."""
    (ma, mb), n = (a.mean(axis=0), b.mean(axis=0)), len(a)
    u, s, vt = np.linalg.svd((b - mb).T @ (a - ma) / n)
    d = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    turn = u @ d @ vt
    scale = np.trace(np.diag(s) @ d) / np.mean(np.sum((a - ma) ** 2, axis=1))
    return scale, turn, mb - scale * turn @ ma


def angle_deg(r):
    return float(np.degrees(np.arccos(np.clip((np.trace(r) - 1) / 2, -1, 1))))


if __name__ == '__main__':
    sys.exit(main())
