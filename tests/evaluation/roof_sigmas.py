#!/usr/bin/env python3
"""How the errors of facets and corners compare with the standard deviations that model.city.json states.

    python3 tests/evaluation/roof_sigmas.py score.py RESULTS SCENE...

RESULTS has a folder with model.city.json for every scene, named as the scene's. A facet is compared
with the true one of which it covers most, if its plane is that one's by the scorer's definitions: its
height in its middle, and its slope along the steepest direction. A corner is compared with the
nearest true corner of that facet, within NEAR_M: another one is another place. Areas and lengths are
compared if either facet covers more than half of the other: the sloped area, and for every kind of
edge that both have its length around the facet. Printed are the shares
of errors within one and two standard deviations (68 and 95 % where they are right), and the median
error and standard deviation. calibrate.py fits src/base/evidence/uncertainty.json by the same comparison.
Needs numpy and shapely.
"""
import argparse
import json
import math
import pathlib
import sys

from shared.on_scenes import loaded, move_to_truth

# A corner farther away is not the same corner inexactly found, metres.
NEAR_M = 0.5
KINDS = ('height', 'slope', 'corner_plan', 'corner_height', 'area', 'length')
# What the place of a side rests on, as files name it and as src/base/evidence/uncertainty.json does.
SUPPORTS = {'edges': 'edges', 'fewEdges': 'few_edges', 'planes': 'planes', 'nothing': 'nothing'}
# Kinds of edges that the truth and the report name alike.
EDGES = ('ridge', 'hip', 'valley', 'eave', 'rake')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('scorer', type=pathlib.Path, help='score.py')
    parser.add_argument('results', type=pathlib.Path)
    parser.add_argument('scenes', type=pathlib.Path, nargs='+')
    args = parser.parse_args()
    score = loaded(args.scorer)
    found = {kind: [] for kind in (*KINDS, 'outline')}
    for scene in args.scenes:
        path = args.results / scene.name / 'model.city.json'
        if path.is_file():
            for kind, errors in compare(score, scene, path).items():
                found[kind] += errors
    for kind in KINDS:
        print(f'{kind:14} {coverage(found[kind])}')
    shares = sorted(abs(error) / true for error, _, true in found['area'])
    if shares:
        print(f'error of an area: median {100 * shares[len(shares) // 2]:.2f} %')
    return 0


def coverage(errors):
    """Shares within one and two standard deviations, and medians, of (error, standard deviation, unit)."""
    if not errors:
        return 'none'
    within = [100 * sum(abs(e) <= times * s for e, s, _ in errors) / len(errors) for times in (1, 2)]
    error, sigma, _ = [sorted(abs(v) for v in values)[len(errors) // 2] for values in zip(*errors)]
    return f'{len(errors):5}  within one {within[0]:.0f} %, two {within[1]:.0f} %; median error {error:.3f}, stated {sigma:.3f}'


def compare(score, scene, path):
    """Per kind (error, stated standard deviation, what a ground pixel is in that unit); of areas and
    lengths the last is the true value."""
    import numpy as np

    truth, origin = score.read_truth(str(scene))
    middles = [(f.poly.centroid.x, f.poly.centroid.y) for f in truth]
    centre = np.mean([(x, y, f.z(x, y)) for f, (x, y) in zip(truth, middles)], axis=0)
    pixel = score.scene_gsd(str(scene), centre)
    faces, _ = score.read_cityjson(str(path), centre, origin)
    found = {kind: [] for kind in (*KINDS, 'outline')}
    known = surfaces(path)
    lengths = true_lengths(scene)
    for face in faces:
        surface, ring = known[face.id]
        true = same_facet(score, truth, face)
        if true is None or 'heightSigma' not in surface:
            continue
        middle = face.poly.centroid.x, face.poly.centroid.y
        found['height'].append((face.z(*middle) - true.z(*middle), surface['heightSigma'], pixel))
        slope = math.hypot(*face.abc[:2])
        if slope > 0.05:
            along = (true.abc[0] * face.abc[0] + true.abc[1] * face.abc[1]) / slope
            turn = math.degrees(math.atan(slope) - math.atan(along))
            found['slope'].append((turn, surface['slopeSigmaDeg'], math.degrees(pixel / math.sqrt(face.poly.area))))
        move = np.array(move_to_truth(ring[0], centre, origin))
        corners = np.array([(p[0], p[1], true.z(p[0], p[1])) for p in list(true.poly.exterior.coords)[:-1]])
        for corner, sigma in zip(ring + move, surface['cornerSigma']):
            apart = corners - corner
            nearest = apart[np.argmin(np.hypot(apart[:, 0], apart[:, 1]))]
            if np.hypot(*nearest[:2]) <= NEAR_M:
                found['corner_plan'] += [(nearest[0], sigma[0], pixel), (nearest[1], sigma[1], pixel)]
                found['corner_height'].append((nearest[2], sigma[2], pixel))
        if true.poly.intersection(face.poly).area > 0.5 * true.poly.area and 'areaSigma' in surface:
            slant = math.hypot(1, *true.abc[:2])
            area = true.poly.area * slant
            found['area'].append((surface['area'] - area, surface['areaSigma'], area))
            error = face.poly.area - true.poly.area
            found['outline'].append((error, sides_beside(true.poly.exterior, (ring + move)[:, :2], surface, pixel)))
            for kind, length in lengths.get(true.id, {}).items():
                if f'{kind}Sigma' in surface['lengths']:
                    found['length'].append((surface['lengths'][kind] - length, surface['lengths'][f'{kind}Sigma'], length))
    return found


def sides_beside(outline, ring, surface, pixel):
    """Of every side what it rests on, its length, how far the true outline lies outside of it in the mean, its standard
    deviation and a ground pixel."""
    import numpy as np
    from shapely.geometry import Point

    sides = []
    for p, q, sigma, support in zip(ring, np.roll(ring, -1, axis=0), surface['sideSigma'][0], surface['sideSupport'][0]):
        length = np.hypot(*(q - p))
        if length > 0:
            places = [p + (q - p) * share for share in np.linspace(0.05, 0.95, 10)]
            nearest = [outline.interpolate(outline.project(Point(place))) for place in places]
            outwards = np.array([q[1] - p[1], p[0] - q[0]]) / length
            apart = np.mean([np.dot((at.x, at.y) - place, outwards) for place, at in zip(places, nearest)])
            sides.append((SUPPORTS[support], length, apart, sigma, pixel))
    return sides


def true_lengths(scene):
    """Per facet and kind of edge the length around it."""
    lengths = {}
    for edge in json.loads((scene / 'truth' / 'edges.json').read_text())['edges']:
        # A break of a mansard is level like a ridge; reports call it a transition.
        if edge['kind'] in EDGES and edge.get('sub') != 'break':
            for face in edge['faces']:
                of_face = lengths.setdefault(face, {})
                of_face[edge['kind']] = of_face.get(edge['kind'], 0) + math.dist(edge['p0'], edge['p1'])
    return lengths


def same_facet(score, truth, face):
    """The true facet that it covers most, if it has its plane."""
    area, true = max(((face.poly.intersection(f.poly).area, f) for f in truth), key=lambda over: over[0])
    x, y = face.poly.centroid.x, face.poly.centroid.y
    turn = math.degrees(math.acos(min(1.0, float(face.n @ true.n))))
    is_same = area >= 0.5 * face.poly.area and abs(face.z(x, y) - true.z(x, y)) <= score.MAX_RMS_Z and turn <= score.MAX_ANGLE
    return true if is_same else None


def surfaces(path):
    """Of every face, by score.py's name, its semantic surface and its outer ring."""
    import numpy as np

    city = json.loads(path.read_text())
    scale, move = (np.array(city['transform'][k]) for k in ('scale', 'translate'))
    vertices = np.array(city['vertices']).reshape(-1, 3) * scale + move
    known, of_facet = {}, {}
    for name, thing in city['CityObjects'].items():
        # The first solid says what is known of the roofs; score.py reads the one with most walls, which comes last.
        for geometry in thing.get('geometry', []):
            semantics = geometry['semantics']
            values = [value for shell in semantics['values'] for value in shell]
            faces = [rings for shell in geometry['boundaries'] for rings in shell]
            for k, (rings, value) in enumerate(zip(faces, values)):
                surface = semantics['surfaces'][value]
                known[f'{name}/{k}'] = of_facet.setdefault(surface.get('facet', f'{name}/{k}'), (surface, vertices[rings[0]]))
    return known


if __name__ == '__main__':
    sys.exit(main())
