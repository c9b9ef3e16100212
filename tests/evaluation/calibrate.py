#!/usr/bin/env python3
"""Fit the tables of src/base/evidence to scenes of which the truth is known.

    python3 tests/evaluation/calibrate.py --binary target/release/ridgeline [--scenes NAME,...]
                               [--fit FOLDER] [--more FOLDER] [--dry] [--keep]
    python3 tests/evaluation/calibrate.py --self-test

Every scene runs five times: with all line candidates accepted, with all facet candidates
accepted, with all planes between parallel lines as candidates, looked at as a large area is, and as it is, which gives the facets that are found once others were rejected, and the
lines in the finished model. The folder of --fit (../shared/fit) has random scenes, named `r` and
their seed, that of --more (../shared/scenes) those of FITTED; beside them lies `score/` with
score.py, by whose definitions a candidate is true. Printed are area under the ROC curve and expected calibration error of the
present tables, which may know these scenes, and of the new ones, cross-validated by scene. Written
are src/base/evidence/*.json and docs/calibration-*.svg (--dry: nothing; --keep takes runs that are there
already). Other lines make other facets: build and run again until the tables stay. What
stands on roofs, what hides them and how their outlines turn is fitted without a run (shared/clutter.py, shared/hiding.py,
shared/corners.py). Needs numpy, scipy,
Pillow and shapely.
"""
import argparse
import json
import math
import re
import pathlib
import subprocess
import sys

import numpy as np

import roof_sigmas
from shared import clutter, corners, hiding, logistic
from shared.on_scenes import ROOT, loaded, move_to_truth
from shared.plots import HEIGHT, LEFT, TOP, WIDTH, document

TABLES = ROOT / 'src' / 'base' / 'evidence'
RUNS = ROOT / 'target' / 'calibrate'
# Beside the random ones; looked at while the method is improved, so that they judge nothing any more.
FITTED = ['suburb', 'detached', 'campus-drone', 'house', 'house-gable', 'real-barns', 'real-farmhouse']
# Odds that every candidate reaches.
ALL = -1e9
# What differs from the defaults in each run. Lines that are wrong on purpose must not move the views.
RUN = {
    'lines': {'matching': {'least_nats': ALL}, 'adjustment': {'enabled': False}},
    'facets': {'roof': {'least_nats': ALL}},
    'strict': {},
    'rectangles': {'method': 'rectangles', 'objectspace': {'planes': {'least_nats': ALL}}},
}
# What a candidate counts: scenes of the old rendering look less like photographs.
WEIGHTS = {'random': 1.0, 'real': 1.5, 'old': 0.4}
WINDOW_WEIGHTS = {'random': 1.0, 'real': 0.6, 'old': 0.4}
# What nature says of a curve: 1 never falls, -1 never rises, 0 may do both.
SIGNS = {
    'lines': {
        'missing_views': -1, 'correlation': 1, 'ln_sigma_without_a_view_px': -1, 'residual_rms_sigmas': -1, 'slope_deg': -1,
    },
    'facets': {
        'outline_on_lines': 1, 'displaced_plane_margin_sigmas': 1, 'rival_plane_margin_sigmas': 1,
        'excess_green': -1, 'ln_area_m2': 1, 'ln_1_plus_lines': 1, 'ln_1_plus_half_planes': 1, 'cos_slope': 0,
    },
    'rectangles': {
        'plane_nats_per_m2': 1, 'displaced_plane_margin_nats_per_m2': 1, 'outline_on_lines': 1, 'cos_slope': 0,
    },
    'buildings': {'height_m': 1, 'roughness_px': -1, 'excess_green': 0, 'correlation': 0, 'cos_slope': 0, 'ln_area_m2': 0},
    'sites': {'ln_1_plus_surface_m2': 1, 'ln_1_plus_lines_m': 1, 'ln_width_m': 1},
    'obstructions': {'ln_nats': 1, 'nats_a_cell': 0, 'nats_a_cell_around': 0,
                     'height_m': 0, 'ln_area_m2': 0, 'width_m': 0, 'inside_m': 0, 'excess_green': -1},
    'vegetation': {'height_m': 0, 'roughness_px': 1, 'excess_green': 1, 'correlation': 0, 'cos_slope': 0, 'ln_area_m2': 0},
    'model_lines': {'nats_before': 1, 'is_border': 0, 'is_intersection': 0, 'share_on_surfaces': 1, 'hidden_views': -1,
                    'facets_on_it': 1},
}
# A facet is true if so much of it lies on true faces of its plane; of those of which more does the windows are counted.
TRUE_SHARE, WINDOWS_SHARE, FEWEST_WINDOWS = 0.5, 0.9, 20
# Of a site so little: what stands beside a house is connected with it.
SITE_SHARE = 0.15
# Of a rectangle more: of those of one plane the one with the right ends is wanted.
RECTANGLE_SHARE = 0.75
# A block stands on a roof if the surface model rises above that by so much, metres, over such shares of it: curbs, and what is
# higher but hardly hit.
RISES = ((0.05, 0.3), (0.2, 0.15))
# How near the surface model a patch lies on it, and how high what stands on it rises, metres.
SURFACE_M = 0.5
# Smaller facets are not judged, square metres in plan.
LEAST_AREA_M2 = 0.5
# Middles of the classes of texture weights; where there is no texture nothing is said.
WINDOW_TEXTURES = [0.0, 0.4, 0.6, 0.75, 0.85, 0.925, 0.965, 0.985, 0.998]
# The first class that is told, of weights and of correlations: below are too few windows.
FIRST_TEXTURE, FIRST_CORRELATION = 3, 6
# Logarithm of the odds of a plane within reach of its lines before its images are compared.
WINDOW_PRIOR = 1.2
# How often a window on a plane looks like one beside it (an occluder), and the other way round (level texture).
ON_LIKE_BESIDE, BESIDE_LIKE_ON = 0.15, 0.08


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--binary', type=pathlib.Path, default=ROOT / 'target' / 'release' / 'ridgeline')
    parser.add_argument('--fit', type=pathlib.Path, default=ROOT.parent / 'shared' / 'fit')
    parser.add_argument('--more', type=pathlib.Path, default=ROOT.parent / 'shared' / 'scenes')
    parser.add_argument('--scenes', help='names of scenes, separated by commas')
    parser.add_argument('--dry', action='store_true')
    parser.add_argument('--keep', action='store_true')
    parser.add_argument('--self-test', action='store_true')
    args = parser.parse_args()
    if args.self_test:
        windows_self_test()
        uncertainty_self_test()
        clutter.self_test()
        corners.self_test()
        hiding.self_test()
        return logistic.self_test()
    scenes, scorer = scenes_of(args), args.more.parent / 'score' / 'score.py'
    if not scorer.is_file() or len(scenes) < 2:
        print(f'calibrate: skipped, there are {len(scenes)} scenes with truth in {args.fit} and {args.more}, and '
              f'{scorer} {"is there" if scorer.is_file() else "is missing"}; two scenes are needed')
        return 0
    truth = loaded(scorer)
    lines, facets, model_lines, buildings, vegetation, rectangles, sites, obstructions = [], [], [], [], [], [], [], []
    for scene in scenes:
        found = {how: run(args, scene, how) for how in RUN}
        if all(found.values()):
            lines += lines_of(truth, scene, found['lines']['lines'])
            model_lines += lines_of(truth, scene, found['strict']['model_lines'])
            facets += facets_of(truth, scene, [found['facets'], found['strict']])
            of_strips = facets_of(truth, scene, [{'facets': found['rectangles']['rectangles']}])
            rectangles += [{**r, 'true': r['on'] >= RECTANGLE_SHARE} for r in of_strips]
            surfaces = surfaces_of(truth, scene, found['strict']['surfaces'])
            buildings += [{**s, 'values': s['building'], 'true': s['class'] == 'building'} for s in surfaces]
            vegetation += [{**s, 'values': s['vegetation'], 'true': s['class'] == 'vegetation'}
                           for s in surfaces if s['class'] != 'building']
            obstructions += obstructions_of(truth, scene, found['strict']['obstructions'])
            # The truth of the real ones has some buildings of many.
            sites += [] if kind_of(scene.name) == 'real' else sites_of(scene, looked_at(args, scene))
            print(f'{scene.name}: {len(lines)} lines, {len(facets)} facets so far', flush=True)
    for kind, candidates in (('lines', lines), ('facets', facets), ('model_lines', model_lines),
                             ('rectangles', rectangles), ('buildings', buildings), ('vegetation', vegetation),
                             ('sites', sites), ('obstructions', obstructions)):
        calibrate(args, kind, candidates)
    calibrate_windows(args, facets)
    calibrate_uncertainty(args, truth, scenes)
    calibrate_roofs(args, [scene for scene in scenes if kind_of(scene.name) == 'random'])
    return 0


def scenes_of(args):
    """The folders of the wanted scenes; says which are missing."""
    random = [p.name for p in args.fit.glob('r*') if p.name[1:].isdigit()] if args.fit.is_dir() else []
    names = args.scenes.split(',') if args.scenes else sorted(random, key=lambda name: int(name[1:])) + FITTED
    found = []
    for name in names:
        folders = [folder / name for folder in (args.fit, args.more) if (folder / name / 'truth' / 'roofs.json').is_file()]
        found += folders[:1]
        if not folders:
            print(f'calibrate: there is no {name} with truth in {args.fit} or {args.more}', file=sys.stderr)
    return found


def kind_of(name):
    return 'real' if name.startswith('real') else 'random' if name[0] == 'r' and name[1:].isdigit() else 'old'


def run(args, scene, how):
    """What a run says of its candidates; None when it failed."""
    out = RUNS / scene.name / how
    if not (args.keep and (out / 'evidence.json').is_file()):
        out.mkdir(parents=True, exist_ok=True)
        params = out / 'params.json'
        params.write_text(json.dumps(RUN[how]))
        done = subprocess.run([args.binary.resolve(), 'reconstruct', scene, '--out', out, '--params', params],
                              capture_output=True, text=True)
        if done.returncode:
            print(f'{scene.name}, {how}: exit code {done.returncode}: {done.stderr.strip()}', file=sys.stderr)
            return None
    return json.loads((out / 'evidence.json').read_text())


def looked_at(args, scene):
    """The sites that a first look shows; none when it failed."""
    out = RUNS / scene.name / 'look'
    if not (args.keep and (out / 'tiles.json').is_file()):
        done = subprocess.run([args.binary.resolve(), 'plan', scene, '--tile', '60', '--out', out],
                              capture_output=True, text=True)
        if done.returncode:
            print(f'{scene.name}, look: exit code {done.returncode}: {done.stderr.strip()}', file=sys.stderr)
            return []
    return json.loads((out / 'tiles.json').read_text()).get('sites', [])


# ---- what is true -------------------------------------------------------------------------------


def to_truth(scene, points):
    """How far to move points of a run into the frame of the truth: it stands there already, or with the map's origin added."""
    roofs = json.loads((scene / 'truth' / 'roofs.json').read_text())
    origin = roofs.get('origin', [0, 0, 0])
    middle = np.mean([p[:3] for b in roofs['buildings'] for f in b['faces'] for p in f['polygon']], axis=0)
    seen = np.median(points, axis=0)
    return np.array(move_to_truth(seen, middle, origin))


def values_of(candidate):
    return {term['feature']: term['value'] for term in candidate['terms']}


def lines_of(truth, scene, found):
    """The lines of a scene with a surface model, without which nothing tells a wrong line."""
    surfaces = [truth.load_dsm(str(scene), name) for name in ('dsm', 'dsm_full')]
    surfaces = [surface for surface in surfaces if surface is not None]
    lines = [(np.array(line['p0']), np.array(line['p1']), values_of(line)) for line in found]
    if not surfaces or not lines:
        return []
    edges = json.loads((scene / 'truth' / 'edges.json').read_text())['edges']
    edges = [np.array([edge[end] for edge in edges]) for end in ('p0', 'p1')]
    move = to_truth(scene, [p for p, _, _ in lines])
    return [{'scene': scene.name, 'values': values, 'true': is_true_line(truth, edges, surfaces, p + move, q + move)}
            for p, q, values in lines]


def is_true_line(truth, edges, surfaces, p, q):
    """Does most of a line lie on true edges that run along it, or on a surface?"""
    a, b = edges
    along = (b - a) / np.maximum(np.linalg.norm(b - a, axis=1, keepdims=True), 1e-9)
    length = max(np.linalg.norm(q - p), 1e-9)
    parallel = np.abs(along @ (q - p)) / length >= math.cos(math.radians(truth.LINE_ANGLE))
    places = p + np.linspace(0, 1, max(5, int(length / 0.2) + 1))[:, None] * (q - p)
    on = (truth.seg_dist(places, a[parallel], b[parallel]) <= truth.LINE_DIST).any(1) if parallel.any() else np.zeros(1)
    near = (truth.near_surface(surface, places, truth.LINE_SURF).mean() for surface in surfaces)
    return on.mean() >= truth.LINE_SHARE or any(share >= truth.LINE_SHARE for share in near)


def facets_of(truth, scene, runs):
    """The facets of all runs of a scene, each once."""
    from shapely.geometry import Polygon
    from shapely.strtree import STRtree
    faces, _ = truth.read_truth(str(scene))
    tree, ignored = STRtree([face.poly for face in faces]), truth.not_judged(str(scene), faces)
    facets = {}
    for facet in (facet for found in runs for facet in found['facets']):
        move = to_truth(scene, facet['outline'])
        ring, *holes = [[(np.array(p) + move)[:2] for p in ring] for ring in [facet['outline'], *facet['holes']]]
        place = truth.fix(Polygon(ring, holes))
        if place.area < LEAST_AREA_M2 or place.intersection(ignored).area > 0.5 * place.area:
            continue
        normal, offset = np.array(facet['plane'][:3]), facet['plane'][3]
        offset -= normal @ move
        on = sum(overlap_of(truth, faces[k], place, normal, offset) for k in tree.query(place)) / place.area
        middle = place.centroid
        key = (*(round(v, 1) for v in (middle.x, middle.y, place.area, offset)), round(normal[0], 3))
        facets[key] = {'scene': scene.name, 'values': values_of(facet), 'true': on >= TRUE_SHARE, 'on': on,
                       'area': place.area, 'windows': facet['windows']}
    return list(facets.values())


def overlap_of(truth, face, place, normal, offset):
    """How much of a place lies over a true face of about this plane, square metres."""
    from shapely.ops import unary_union
    # Where they touch, lines are left over.
    shared = unary_union(truth.polys(place.intersection(face.poly)))
    if shared.area < 0.02:
        return 0.0
    plane = (-normal[0] / normal[2], -normal[1] / normal[2], -offset / normal[2])
    squares, area = truth.int_linear2(shared, *(a - b for a, b in zip(plane, face.abc)))
    angle = math.degrees(math.acos(np.clip(face.n @ normal, -1, 1)))
    is_on = angle < truth.MAX_ANGLE and math.sqrt(squares / max(area, 1e-9)) < truth.MAX_RMS_Z
    return shared.area if is_on else 0.0


def obstructions_of(truth, scene, found):
    """The blocks on true roofs of a scene with a surface model; true ones rise above the roof there."""
    from shapely.geometry import Point, Polygon
    surface = truth.load_dsm(str(scene), 'dsm')
    if surface is None or not found:
        return []
    faces, _ = truth.read_truth(str(scene))
    blocks = []
    for block in found:
        outline = np.array(block['outline'])
        place = Polygon((outline + to_truth(scene, outline))[:, :2]).buffer(0.1, join_style=2)
        low_x, low_y, high_x, high_y = place.bounds
        at = np.stack(np.meshgrid(np.arange(low_x, high_x, 0.1), np.arange(low_y, high_y, 0.1)), -1).reshape(-1, 2)
        roof = np.array([max((np.dot(face.abc, (x, y, 1)) for face in faces if face.poly.intersects(Point(x, y))), default=np.nan)
                         for x, y in at])
        heights = heights_of(surface, np.column_stack([at, roof])) - roof
        heights = heights[np.isfinite(heights)]
        if len(heights) > 0.5 * len(at):
            blocks.append({'scene': scene.name, 'values': values_of(block),
                           'true': any((heights > by).mean() > share for by, share in RISES)})
    return blocks


def sites_of(scene, found):
    """The sites of a scene; true ones have a roof."""
    from shapely.geometry import Polygon
    from shapely.ops import unary_union
    roofs = json.loads((scene / 'truth' / 'roofs.json').read_text())
    roofs = unary_union([Polygon([p[:2] for p in f['polygon']]).buffer(0) for b in roofs['buildings'] for f in b['faces']])
    sites = []
    for site in found:
        outline = [[*corner, 0.0] for corner in site['outline']]
        ground = Polygon((np.array(outline) + to_truth(scene, outline))[:, :2])
        if not site['is_given']:
            values = {'ln_1_plus_surface_m2': math.log1p(site['surface_m2']), 'ln_1_plus_lines_m': math.log1p(site['lines_m']),
                      'ln_width_m': math.log(site['width_m'])}
            sites.append({'scene': scene.name, 'values': values,
                          'true': ground.intersection(roofs).area > SITE_SHARE * ground.area})
    return sites


def surfaces_of(truth, scene, found):
    """The surfaces of a scene with a surface model, each with its class: that of most of its patches."""
    bare, full = (truth.load_dsm(str(scene), name) for name in ('dsm', 'dsm_full'))
    if bare is None or full is None or not found:
        return []
    from shapely.geometry import MultiPoint
    from shapely.ops import unary_union
    faces, _ = truth.read_truth(str(scene))
    roofs = unary_union([face.poly for face in faces])
    move = to_truth(scene, [p for surface in found for p in surface['patches']])
    surfaces = []
    for surface in found:
        patches = np.array(surface['patches']) + move
        on_roof = np.array([roofs.contains(p) for p in MultiPoint(patches[:, :2]).geoms])
        near = truth.near_surface(bare, patches, SURFACE_M)
        stands = heights_of(full, patches) - heights_of(bare, patches) > SURFACE_M
        is_roof = (on_roof & near).mean() >= TRUE_SHARE
        is_plant = not is_roof and (stands & ~on_roof).mean() >= TRUE_SHARE
        surfaces.append({'scene': scene.name, 'class': 'building' if is_roof else 'vegetation' if is_plant else 'ground',
                         **{of: {t['feature']: t['value'] for t in surface[of]} for of in ('building', 'vegetation')}})
    return surfaces


def heights_of(surface, places):
    """Heights of a surface model below some places."""
    z = surface['z']
    columns, rows = (np.floor((places[:, i] - surface[start]) / surface['cell']).astype(int)
                     for i, start in ((0, 'x0'), (1, 'y0')))
    return z[np.clip(rows, 0, z.shape[0] - 1), np.clip(columns, 0, z.shape[1] - 1)]


# ---- lines and facets ---------------------------------------------------------------------------


def calibrate(args, kind, candidates):
    """Fits the table of lines or facets, prints how well it tells them apart beside the present one, and writes it."""
    signs = SIGNS[kind]
    features = {name: np.array([c['values'][name] for c in candidates]) for name in signs}
    true = np.array([c['true'] for c in candidates], float)
    names = np.array([c['scene'] for c in candidates])
    kinds = np.array([kind_of(name) for name in names])
    weights = np.array([WEIGHTS[k] for k in kinds])
    present = logistic.odds_of(read_table(TABLES / f'{kind}.json'), features)
    odds = logistic.cross_validated(features, true, weights, signs, names)
    for which in [*WEIGHTS, 'all']:
        of = (kinds == which) | (which == 'all')
        if of.any():
            told = [f'AUC {logistic.area_under_curve(true[of], e[of]):.3f} calibration error '
                    f'{logistic.calibration_error(true[of], e[of]):.3f}' for e in (present, odds)]
            print(f'{kind}, {which}: {of.sum()}, {100 * true[of].mean():.1f} % true; present {told[0]}; new {told[1]}')
    prior, curves = logistic.fit(features, true, weights, signs)
    table = {
        'source': f'{len(true)} {kind} of {told_scenes(names)}',
        'prior': rounded([prior])[0],
        'features': [{'name': name, 'knots': rounded(knots), 'nats': rounded(nats)}
                     for name, (knots, nats) in curves.items()],
    }
    for feature in table['features']:
        print(f'  {feature["name"]:30}', ' '.join(f'{k:g}:{v:+.2f}' for k, v in zip(feature['knots'], feature['nats'])))
    if not args.dry:
        (TABLES / f'{kind}.json').write_text(written(table))
        (ROOT / 'docs' / f'calibration-{kind}.svg').write_text(diagram(kind, true, odds))


def read_table(path):
    table = json.loads(path.read_text())
    return table['prior'], {f['name']: (np.array(f['knots']), np.array(f['nats'])) for f in table['features']}


def rounded(values, digits=3):
    # Not -0.0.
    return [round(float(v), digits) + 0.0 for v in values]


def told_scenes(names):
    """The scenes in words, seeds that follow each other as a range."""
    names = set(names)
    seeds = sorted(int(name[1:]) for name in names if kind_of(name) == 'random')
    others = sorted(name for name in names if kind_of(name) != 'random')
    starts = [seed for seed in seeds if seed - 1 not in seeds]
    ends = [seed for seed in seeds if seed + 1 not in seeds]
    ranges = [f'{first} to {last}' if last > first else str(first) for first, last in zip(starts, ends)]
    told = [f'seeds {", ".join(ranges)}'] * bool(seeds) + others
    return ', '.join(told)


def written(table):
    """JSON with a list of numbers a line."""
    text = json.dumps(table, indent=1)
    return re.sub(r'\[\s+([-\d.,\s]+?)\s+\]', lambda m: f'[{" ".join(m[1].split())}]', text) + '\n'


def diagram(kind, true, odds):
    """Stated probability against the share of true ones, and how many there are in each bin."""
    bins = logistic.reliability(true, odds)
    error = logistic.calibration_error(true, odds)

    def at(place, x, y):
        return f'{LEFT + place * (WIDTH + 80) + WIDTH * x:.1f}', f'{TOP + HEIGHT * (1 - y):.1f}'

    def text(x, y, words, anchor='middle'):
        return f'<text x="{x}" y="{y}" text-anchor="{anchor}">{words}</text>'

    (x0, y0), (x1, y1) = at(0, 0, 0), at(0, 1, 1)
    words = kind.replace('_', ' ')
    parts = [f'<title>{words}: expected calibration error {error:.3f}, cross-validated by scene</title>',
             f'<path d="M{x0} {y0}L{x1} {y1}" stroke="#777" stroke-dasharray="4 3"/>']
    points = [at(0, stated, share) for _, stated, share in bins]
    parts.append(f'<polyline points="{" ".join(map(",".join, points))}" fill="none" stroke="#0072b2" stroke-width="2"/>')
    parts += [f'<circle cx="{x}" cy="{y}" r="4" fill="#0072b2"/>' for x, y in points]
    most = max(n for n, _, _ in bins)
    for n, stated, share in bins:
        left = min(int(stated * logistic.BINS), logistic.BINS - 1) / logistic.BINS
        for height, colour in ((n, '#d55e00'), (n * share, '#0072b2')):
            x, y = at(1, left, height / most)
            parts.append(f'<rect x="{x}" y="{y}" width="{0.9 * WIDTH / logistic.BINS:.1f}" height="{HEIGHT * height / most:.1f}" '
                         f'fill="{colour}"/>')
    for place, top in ((0, '1'), (1, str(most))):
        (x, y), (right, _) = at(place, 0, 0), at(place, 1, 0)
        parts.append(f'<path d="M{x} {TOP}V{y}H{right}" fill="none" stroke="#777"/>')
        parts += [text(at(place, v, 0)[0], TOP + HEIGHT + 16, f'{v:g}') for v in (0, 0.5, 1)]
        parts += [text(float(x) - 6, float(at(place, 0, v)[1]) + 4, words, 'end') for v, words in ((0, '0'), (1, top))]
    captions = [(f'share of true {words} over stated probability', f'expected calibration error {error:.3f}, by scene'),
                (f'number of {words} over stated probability', 'blue: the true ones')]
    parts += [text(at(place, 0.5, 0)[0], TOP + HEIGHT + 35 + 15 * line, words)
              for place, lines in enumerate(captions) for line, words in enumerate(lines)]
    return document(['\n'.join(parts)], '', below=15)


# ---- windows ------------------------------------------------------------------------------------


def calibrate_windows(args, facets):
    """Fits the table of windows to those inside true facets, on their planes and beside them."""
    counts = {kind: [0, 0] for kind in WINDOW_WEIGHTS}
    totals = dict.fromkeys(counts, 0.0)
    used = set()
    for facet in facets:
        on, beside = (np.array(facet['windows'][of], float) for of in ('on', 'beside'))
        if facet['on'] < WINDOWS_SHARE or on.sum() < FEWEST_WINDOWS:
            continue
        # Large facets have more windows, which say the same.
        kind, weight = kind_of(facet['scene']), math.sqrt(facet['area'])
        totals[kind] += weight
        counts[kind] = [sums + weight * h / max(h.sum(), 1) for sums, h in zip(counts[kind], (on, beside))]
        used.add(facet['scene'])
    kinds = [kind for kind in counts if totals[kind]]
    if not kinds:
        print('windows: no true facet is large enough')
        return
    on, beside = (sum(WINDOW_WEIGHTS[k] * counts[k][i] / totals[k] for k in kinds) for i in (0, 1))
    nats = window_nats(on, beside)
    first = FIRST_CORRELATION
    correlations = rounded(np.arange(on.shape[1])[first:] / 10 - 0.95)
    table = {
        'source': f'windows inside true facets of {told_scenes(used)}',
        'prior': WINDOW_PRIOR,
        'weights': [0.0, *WINDOW_TEXTURES[FIRST_TEXTURE:]],
        'correlations': correlations,
        'nats': [rounded(row[first:], 2) for row in np.vstack([0 * nats[0], nats[FIRST_TEXTURE:]])],
    }
    before = json.loads((TABLES / 'windows.json').read_text())['nats']
    is_alike = np.shape(before) == np.shape(table['nats'])
    off = np.abs(np.subtract(before, table['nats'])) if is_alike else np.array([math.nan])
    print(f'windows: of {len(used)} scenes; from the present table {off.mean():.2f} nats in the mean, '
          f'{off.max():.2f} at most')
    for weight, row in zip(table['weights'], table['nats']):
        print(f'  {weight:5}', ' '.join(f'{v:+.2f}' for v in row))
    if not args.dry:
        (TABLES / 'windows.json').write_text(written(table))


def window_nats(on, beside):
    """For each class of textures, what each correlation says: never less than a smaller one."""
    nats = []
    for p, q in zip(on, beside):
        if p.sum() < 0.01:
            nats.append(np.zeros(len(p)))
            continue
        p, q = (smoothed(h) / max(h.sum(), 1e-9) for h in (p, q))
        like_on = (1 - ON_LIKE_BESIDE) * p + ON_LIKE_BESIDE * q
        like_beside = (1 - BESIDE_LIKE_ON) * q + BESIDE_LIKE_ON * p
        nats.append(rising(np.log((like_on + 1e-4) / (like_beside + 1e-4)), p + q + 1e-3))
    return np.array(nats)


def smoothed(counts):
    padded = np.pad(counts, 1, mode='edge')
    return 0.25 * padded[:-2] + 0.5 * padded[1:-1] + 0.25 * padded[2:]


def rising(values, weights):
    """The nearest values that never fall (pool adjacent violators)."""
    pools = []
    for value, weight in zip(values, weights):
        pools.append([value * weight, weight, 1])
        while len(pools) > 1 and pools[-2][0] / pools[-2][1] > pools[-1][0] / pools[-1][1]:
            last = pools.pop()
            pools[-1] = [a + b for a, b in zip(pools[-1], last)]
    return np.concatenate([[total / weight] * count for total, weight, count in pools])


def windows_self_test():
    """Windows that correlate more are planted on a plane than beside it."""
    classes = np.arange(21)
    on, beside = (np.tile(1e4 * np.exp(-0.5 * ((classes - middle) / 2) ** 2), (9, 1)) for middle in (16, 12))
    nats = window_nats(on, beside)
    assert (np.diff(nats) >= 0).all()
    assert (nats[:, 12] < -1).all() and (nats[:, 16] > 1).all(), 'what is likelier on the plane speaks for it'
    assert abs(nats[0, 14]) < 0.2, 'half-way between them says nothing'
    assert (window_nats(0 * on, beside) == 0).all(), 'nothing was counted'
    assert rising([1.0, 3.0, 1.0, 4.0], [1.0, 1.0, 1.0, 1.0]).tolist() == [1, 2, 2, 4]


# ---- standard deviations ------------------------------------------------------------------------

# Shares of errors within one and two standard deviations.
NORMAL = (0.6827, 0.9545)
SCALES = np.geomspace(1, 8, 25)
FLOORS_PX = np.linspace(0, 2, 41)


def calibrate_uncertainty(args, truth, scenes):
    """Fits how far the stated standard deviations of facets and corners are inflated, and writes it."""
    path = TABLES / 'uncertainty.json'
    present = json.loads(path.read_text())
    found, used = {kind: [] for kind in (*roof_sigmas.KINDS, 'outline')}, set()
    for scene in scenes:
        city = RUNS / scene.name / 'strict' / 'model.city.json'
        # The old scenes have an exact orientation, which no photograph has.
        if city.is_file() and kind_of(scene.name) != 'old':
            used.add(scene.name)
            for kind, errors in roof_sigmas.compare(truth, scene, city).items():
                found[kind] += errors
    table = {'source': f'{len(found["height"])} facets of {told_scenes(used)}'}
    for kind, errors in found.items():
        if kind in present:
            error, stated, pixel = np.array(errors).T
            adjusted = before_inflation(stated, pixel, present[kind])
            scale, floor = inflation(error, adjusted, pixel)
            table[kind] = {'scale': round(scale, 2), 'floor_px': round(floor, 2)}
            sigma = np.hypot(scale * adjusted, floor * pixel)
            print(f'{kind}: {roof_sigmas.coverage(errors)}; scale {scale:.2f}, floor {floor:.2f} px: '
                  f'{roof_sigmas.coverage(list(zip(error, sigma, pixel)))}')
    table['sides'] = side_inflations(found['outline'], present['sides'])
    if not args.dry:
        path.write_text(re.sub(r'\{\s+("scale"[^}]+?)\s+\}', lambda m: '{' + ' '.join(m[1].split()) + '}', json.dumps(table, indent=1)) + '\n')


def before_inflation(stated, pixel, table):
    """The standard deviations of the adjustment."""
    return np.sqrt(np.maximum(stated**2 - (table['floor_px'] * pixel) ** 2, 0)) / table['scale']


def side_inflations(outlines, present):
    """Scales and floors of sides by what they rest on, first each by itself, then all by one factor, with which two thirds
    of the areas are within one standard deviation: sides of one outline are wrong together."""
    table, sides = {}, [side for _, of in outlines for side in of]
    for support, inflated in present.items():
        of_support = [side[2:] for side in sides if side[0] == support]
        if not of_support:
            table[support] = inflated['scale'], inflated['floor_px']
            continue
        error, stated, pixel = np.array(of_support).T
        table[support] = inflation(error, before_inflation(stated, pixel, inflated), pixel)
    ratios = []
    for error, of in outlines:
        variance = 0
        for support, length, _, stated, pixel in of:
            scale, floor = table[support]
            variance += length**2 * ((scale * before_inflation(stated, pixel, present[support])) ** 2 + (floor * pixel) ** 2)
        ratios.append(abs(error) / math.sqrt(variance))
    together = float(np.quantile(ratios, NORMAL[0]))
    for support, (scale, floor) in table.items():
        print(f'side on {support}: scale {scale:.2f}, floor {floor:.2f} px, times {together:.2f}')
    print(f'areas within one {np.mean(np.array(ratios) <= together):.2f}, two {np.mean(np.array(ratios) <= 2 * together):.2f}')
    return {support: {'scale': round(scale * together, 2), 'floor_px': round(floor * together, 2)}
            for support, (scale, floor) in table.items()}


def inflation(error, adjusted, pixel):
    """Scale and floor with which most nearly so many errors lie within one and two standard deviations as of normal ones."""
    def miss(scale, floor):
        sigma = np.hypot(scale * adjusted, floor * pixel)
        return sum((np.mean(np.abs(error) <= times * sigma) - share) ** 2 for times, share in zip((1, 2), NORMAL))
    return min(((scale, floor) for scale in SCALES for floor in FLOORS_PX), key=lambda at: miss(*at))


def calibrate_roofs(args, scenes):
    """Fits what stands on roofs, what hides them, and how their outlines turn, to the truth of scenes and their photographs, and writes it."""
    if not scenes:
        return
    for kind, of in (('clutter', clutter), ('corners', corners), ('hiding', hiding)):
        path = TABLES / f'{kind}.json'
        count, table = of.table(scenes, json.loads(path.read_text()))
        table = {'source': f'{count} of {told_scenes(scene.name for scene in scenes)}', **table}
        print(f'{kind}: {table}')
        if not args.dry:
            path.write_text(json.dumps(table, indent=1) + '\n')


def uncertainty_self_test():
    """A planted inflation comes back."""
    draw = np.random.default_rng(7)
    adjusted, pixel = draw.uniform(0.005, 0.2, 20000), np.full(20000, 0.1)
    error = draw.normal(size=20000) * np.hypot(2 * adjusted, 0.4 * pixel)
    scale, floor = inflation(error, adjusted, pixel)
    assert abs(scale - 2) < 0.3 and abs(floor - 0.4) < 0.3, (scale, floor)


if __name__ == '__main__':
    sys.exit(main())
