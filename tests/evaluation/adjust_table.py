#!/usr/bin/env python3
"""Turn, move and shift one view of every scene a little, and see whether the adjustment takes it back.

    python3 tests/evaluation/adjust_table.py --binary target/release/ridgeline --scenes FOLDER [--only NAME,...] [--models]

FOLDER holds one folder per scene with images/ and cameras.json (K, R, C). Prints a table for docs/formats.md: how far
the error moves the view's image, what is left of it in the other views' world, and, with --models, the score of the model
as stated, with the error, and adjusted (`score/` beside FOLDER, as in score_table.py).
"""
import json
import math
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

from shared.on_scenes import names_of, parser_of

PLANTED = {'none': {}, 'turned 0.02 degrees': {'turn': 0.02}, 'moved 0.1 m': {'move': 0.1}, 'shifted 1.5 px': {'shift': 1.5}}


def main():
    parser = parser_of(__doc__)
    parser.add_argument('--models', action='store_true', help='reconstruct and score, too')
    args = parser.parse_args()
    names = names_of(args)
    print('| scene | planted | moves its image | adjusted | left in it | left in any view |' + (' model as it is, adjusted |' if args.models else ''))
    print('|---|---|---|---|---|---|' + ('---|' if args.models else ''))
    for name in names:
        scene = args.scenes / name
        sound = json.loads((scene / 'cameras.json').read_text())
        for what, error in PLANTED.items():
            row(args, scene, sound, what, error)


def row(args, scene, sound, what, error):
    view = len(sound['views']) // 2
    broken = json.loads(json.dumps(sound))
    if error:
        plant(broken['views'][view], **error)
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        shutil.copytree(scene / 'images', work / 'images')
        (work / 'cameras.json').write_text(json.dumps(broken))
        done = subprocess.run([args.binary, 'check', work, '--json'], capture_output=True, text=True)
        if done.returncode:
            print(f'| {scene.name} | {what} | | refused: {done.stderr.strip()} |')
            return
        used = json.loads(done.stdout)
        for v in used['views']:
            v['C'] = (np.array(v['C']) + used['origin'] - np.array(sound.get('origin', [0, 0, 0]))).tolist()
        named = {v['file']: v for v in used['views']}
        pairs = [(a, named[a['file']], b) for a, b in zip(sound['views'], broken['views'])]
        before, after, change = ([rms(project(y, ground(sound, i)) - project(x, ground(sound, i)))
                                  for i, (x, y) in enumerate(between)]
                                 for between in ([(a, c) for a, _, c in pairs], [(a, b) for a, b, _ in pairs],
                                                 [(c, b) for _, b, c in pairs]))
        touched = [sound['views'][i]['file'] for i, c in enumerate(change) if c > 1e-6]
        line = (f"| {scene.name} | {what}{', ' + sound['views'][view]['file'] if error else ''} | {before[view]:.2f} px"
                f" | {', '.join(touched) or 'none'} | {after[view]:.2f} px | {max(after):.2f} px |")
        if args.models:
            line += ' ' + ', '.join(model(args, scene, work, adjust) for adjust in (('--no-adjust',), ())) + ' |'
    print(line, flush=True)


def plant(view, turn=0.0, move=0.0, shift=0.0):
    """An error of one view: turned about its own x axis, moved to the east, or its principal point shifted."""
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    view['R'] = (np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ np.array(view['R'])).tolist()
    view['C'][0] += move
    view['K'][0][2] += shift


def ground(sound, view):
    """Points below a grid of the image, at the height at which the rays of the views' middles meet."""
    normal, right = np.zeros((3, 3)), np.zeros(3)
    for v in sound['views']:
        (ray,), c = rays(v, np.array([[v['width'] / 2, v['height'] / 2]])), np.array(v['C'])
        across = np.eye(3) - np.outer(ray, ray)
        normal, right = normal + across, right + across @ c
    height = np.linalg.solve(normal, right)[2]
    v = sound['views'][view]
    grid = np.stack(np.meshgrid(np.linspace(0.1, 0.9, 5) * v['width'], np.linspace(0.1, 0.9, 5) * v['height']), -1).reshape(-1, 2)
    directions, c = rays(v, grid), np.array(v['C'])
    return c + directions * ((height - c[2]) / directions[:, 2:])


def rays(view, pixels):
    k, r = (np.array(view[key], float) for key in 'KR')
    directions = (np.linalg.inv(k) @ np.c_[pixels, np.ones(len(pixels))].T).T @ r
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def project(view, points):
    k, r, c = (np.array(view[key], float) for key in 'KRC')
    x = (points - c) @ r.T @ k.T
    return x[:, :2] / x[:, 2:]


def rms(vectors):
    return float(np.sqrt((vectors ** 2).sum(axis=1).mean()))


def model(args, scene, work, more):
    """Score of the model: rendered scenes by completeness and correctness of the faces and their heights, real ones by
    independent tie points."""
    out = work / 'out'
    subprocess.run([args.binary, 'reconstruct', work, '--out', out, *more], capture_output=True, check=True)
    name = 'score' if (scene / 'truth').is_dir() else 'check_real'
    result = out / 'score.json'
    subprocess.run(['python3', args.scenes.parent / 'score' / f'{name}.py', scene, out / 'model.city.json', '--json', result],
                   capture_output=True, check=True)
    return words(name, json.loads(result.read_text()))


def words(name, s):
    """Rendered: facets above 10 m² found, area right within 0.2 m; real: tie points within 0.25 m, their median error."""
    if name == 'check_real':
        return f"{100 * s['points_within_0_25m']:.0f} %, {s['median_abs_dz_m']:.2f} m"
    large = s['faces']['gt_10m2']
    return f"{large['found']} of {large['reference']}, {100 * s['area']['covered_within_0_2m_fraction']:.0f} %"


if __name__ == '__main__':
    main()
