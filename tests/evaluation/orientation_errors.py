#!/usr/bin/env python3
"""Put the usual errors into the orientation of every scene, and see what the orientation check calls them.

    python3 tests/evaluation/orientation_errors.py --binary target/release/ridgeline --scenes FOLDER [--only NAME,...]

FOLDER holds one folder per scene with images/ and cameras.json (K, R, C). Prints the table of docs/formats.md:
a row for each mistake, a column for each scene; the first row is the sound scene, which must be left alone. A list of angles
has one camera for all images, and images of several sizes cannot be exchanged: where a scene cannot hold a mistake as it is,
its images are resampled to one focal length and one size before (marked by a star). "-": the mistake changes nothing.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

from shared.on_scenes import names_of, parser_of


class NotExpressible(Exception):
    """A scene cannot hold a mistake as it is."""


class ChangesNothing(Exception):
    """What is called a mistake is right for a scene."""


UP = np.diag([1.0, -1.0, -1.0])


def angles(change):
    """The photogrammetric list (omega, phi, kappa in degrees; the images as crops of one frame) with changed angles."""
    def broken(scene, work):
        found = json.loads((scene / 'cameras.json').read_text())
        frame, pixel_mm, origin = (20000, 20000), 0.012, np.array(found.get('origin', [0, 0, 0]))
        if len({round(view['K'][0][0], 3) for view in found['views']}) > 1:
            raise NotExpressible
        focal_mm = found['views'][0]['K'][0][0] * pixel_mm
        camera = [f'principal_distance_mm {focal_mm!r}', f'pixel_size_mm {pixel_mm}', f'image_size_px {frame[0]} {frame[1]}']
        exterior = ['# angles in degrees']
        for view in found['views']:
            (k, r, c), name = (np.array(view[key], float) for key in 'KRC'), view['file']
            m = r.T @ UP
            stated = np.degrees([np.arctan2(-m[1, 2], m[2, 2]), np.arcsin(m[0, 2]), np.arctan2(-m[0, 1], m[0, 0])])
            column, row = frame[0] / 2 - k[0, 2], frame[1] / 2 - k[1, 2]
            camera.append(f'crop {name} {float(column)!r} {float(row)!r} {view["width"]} {view["height"]}')
            exterior.append(' '.join([name, *(repr(float(x)) for x in (*(c + origin), *change(*stated)))]))
        (work / 'camera.txt').write_text('\n'.join(camera) + '\n')
        (work / 'exterior.txt').write_text('\n'.join(exterior) + '\n')
    return broken


def cameras(change, is_sound=False):
    """K, R and C with a change of each view."""
    def broken(scene, work):
        found = json.loads((scene / 'cameras.json').read_text())
        # An inverted pose has lost the origin, too.
        found.pop('origin', None)
        differs = False
        for view in found['views']:
            stated = [np.array(view[key], float) for key in 'KRC']
            changed = change(*stated, view)
            differs |= not all(np.allclose(a, b) for a, b in zip(stated, changed))
            view['K'], view['R'], view['C'] = (a.tolist() for a in changed)
        if not differs and not is_sound:
            raise ChangesNothing
        (work / 'cameras.json').write_text(json.dumps(found))
    return broken


def order(places):
    """The orientation of other images: `places` makes a new order of the numbers of the views, sorted by name."""
    def broken(scene, work):
        found = json.loads((scene / 'cameras.json').read_text())
        views = sorted(found['views'], key=lambda view: view['file'])
        if len({(view['width'], view['height']) for view in views}) > 1:
            raise NotExpressible
        names = [view['file'] for view in views]
        found['views'] = [{**views[place], 'file': name} for name, place in zip(names, places(len(names)))]
        (work / 'cameras.json').write_text(json.dumps(found))
    return broken


def alike(scene, work):
    """A copy of a scene whose images have one focal length and one size: scaled to the shortest, and the middles cut out."""
    found = json.loads((scene / 'cameras.json').read_text())
    shortest = min(view['K'][0][0] for view in found['views'])
    scales = [shortest / view['K'][0][0] for view in found['views']]
    size = [min(int(view[side] * scale) for view, scale in zip(found['views'], scales)) for side in ('width', 'height')]
    (work / 'images').mkdir(parents=True)
    for view, scale in zip(found['views'], scales):
        of = np.array([view['width'], view['height']])
        start = (of - np.array(size) / scale) / 2
        box = (*start, *(start + np.array(size) / scale))
        image = Image.open(scene / 'images' / view['file']).resize(size, Image.Resampling.LANCZOS, box=box)
        image.save(work / 'images' / view['file'], quality=95)
        k = np.array(view['K'], float)
        k[:2, 2] -= start
        k[:2] *= scale
        view['K'], (view['width'], view['height']) = k.tolist(), size
    (work / 'cameras.json').write_text(json.dumps(found))


def with_k(k, *, cx=None, cy=None, factor=1.0):
    k = k.copy()
    k[0, 0], k[1, 1] = k[0, 0] * factor, k[1, 1] * factor
    k[0, 2] = k[0, 2] if cx is None else cx
    k[1, 2] = k[1, 2] if cy is None else cy
    return k


# What is done, and a word of what it is called.
MISTAKES = {
    'none': (cameras(lambda k, r, c, v: (k, r, c), is_sound=True), None),
    'gon called degrees': (angles(lambda o, p, k: [a / 0.9 for a in (o, p, k)]), 'in gon'),
    'radians called degrees': (angles(lambda o, p, k: [float(np.radians(a)) for a in (o, p, k)]), 'radians'),
    'phi before omega': (angles(lambda o, p, k: (p, o, k)), 'phi, omega, kappa'),
    'kappa before phi and omega': (angles(lambda o, p, k: (k, p, o)), 'kappa, phi, omega'),
    'transposed rotation': (cameras(lambda k, r, c, v: (k, r.T, c)), 'transposed'),
    'inverse pose': (cameras(lambda k, r, c, v: (k, r.T, -r @ c)), 'inverted'),
    'camera y up': (cameras(lambda k, r, c, v: (k, UP @ r, c)), 'y axis runs up'),
    'principal point from the bottom': (cameras(lambda k, r, c, v: (with_k(k, cy=v['height'] - k[1, 2]), r, c)), 'y up'),
    'corner taken for centre': (cameras(lambda k, r, c, v: (with_k(k, cx=k[0, 2] + 0.5, cy=k[1, 2] + 0.5), r, c)), 'half a pixel'),
    'images in reverse order': (order(lambda n: range(n - 1, -1, -1)), 'reverse order'),
    'two images exchanged': (order(lambda n: [0, n - 2, *range(2, n - 2), 1, n - 1]), "have each other"),
    'focal length in mm of 12 µm': (cameras(lambda k, r, c, v: (with_k(k, factor=0.012), r, c)), 'not in pixels'),
}


def main():
    args = parser_of(__doc__).parse_args()
    names = names_of(args)
    print('| mistake | ' + ' | '.join(names) + ' |\n|---|' + '---|' * len(names))
    named, tried = dict.fromkeys(names, 0), dict.fromkeys(names, 0)
    was_harmed = False
    with tempfile.TemporaryDirectory() as folder:
        for what, (broken, word) in MISTAKES.items():
            cells = []
            for name in names:
                try:
                    said, score, star = check_any(args, name, broken, pathlib.Path(folder))
                except ChangesNothing:
                    cells.append('-')
                    continue
                good = word in said if word else said == ''
                tried[name] += word is not None
                named[name] += good and word is not None
                was_harmed |= word is None and not good
                cell = ('named' if word else 'left alone') if good else f'**{said[:60] or "nothing said"}**'
                cells.append(f'{cell}{star} ({score})')
            print(f'| {what} | ' + ' | '.join(cells) + ' |', flush=True)
    print('| named | ' + ' | '.join(f'{named[name]} of {tried[name]}' for name in names) + ' |')
    return 1 if was_harmed or any(named[name] < tried[name] - 1 for name in names) else 0


def check_any(args, name, broken, folder):
    """As `check`, of a scene as it is or else with images that are alike; a star tells the latter."""
    try:
        return *check(args.binary, args.scenes / name, broken), ''
    except NotExpressible:
        copy = folder / name
        if not copy.exists():
            alike(args.scenes / name, copy)
        return *check(args.binary, copy, broken), '*'


def check(binary, scene, broken):
    """What the check says about the orientation, and the agreement as it is stated and without the mistake."""
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        broken(scene, work)
        shutil.copytree(scene / 'images', work / 'images')
        done = subprocess.run([binary, 'check', work, '--json'], capture_output=True, text=True)
        if done.returncode not in (0, 2):
            return f'failed: {done.stderr}', '-'
        found = json.loads(done.stdout)
        report = found['agreement'] or {}
        scores = [report.get('stated'), report.get('cured')]
        score = ' → '.join(f"{s['score']:.2f}" for s in scores if s)
        if report.get('offsets_px'):
            score = ' → '.join(f'{x:.2f} px' for x in report['offsets_px'])
        said = found.get('refusal') or '; '.join(w for w in found['warnings'] if 'ignored' not in w)
        return said, score or '-'


if __name__ == '__main__':
    sys.exit(main())
