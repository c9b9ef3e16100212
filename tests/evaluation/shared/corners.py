"""Fits src/base/evidence/corners.json, how often and by what angle outlines of roofs turn, to scenes with truth.

Counts the corners of true facets in plan. The standard deviation of a turn and the weight stay as they are: truth has
no error of measurement, and the weight is what models of the scenes became best with.
"""
import json

import numpy as np

LEAST_AREA_M2 = 4.0
# Angles that are counted by themselves, and how far from them a corner still turns by them, degrees.
FREQUENT, WITHIN = (45, 90, 135), 10


def turns_of(ring):
    """Turns at the corners of a ring in plan, degrees, and its length; vertices on a straight side are no corners."""
    plan = np.array(ring, float)[:, :2]
    if np.allclose(plan[0], plan[-1]):
        plan = plan[:-1]
    into, out = plan - np.roll(plan, 1, 0), np.roll(plan, -1, 0) - plan
    turns = np.abs(np.degrees(np.arctan2(into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0], (into * out).sum(1))))
    return turns[turns > 1.0], np.hypot(*out.T).sum()


def fitted(rings):
    found = [turns_of(ring) for ring in rings]
    turns, length = np.concatenate([t for t, _ in found]), sum(m for _, m in found)
    near = {a: np.mean(np.abs(turns - a) <= WITHIN) for a in FREQUENT}
    shares = [{'degrees': float(a), 'share': round(float(share), 3)} for a, share in near.items()]
    return len(turns), {'per_m': round(len(turns) / length, 3), 'turns': shares, 'others': round(1.0 - sum(s['share'] for s in shares), 3)}


def rings_of(scene):
    for building in json.loads((scene / 'truth' / 'roofs.json').read_text())['buildings']:
        for face in building['faces']:
            if face['area_m2'] >= LEAST_AREA_M2:
                yield from [face['polygon'], *face['holes']]


def table(scenes, before):
    """How many corners there are, in words, and the table; `before` is the present one."""
    count, counted = fitted([ring for scene in scenes for ring in rings_of(scene)])
    return f'{count} corners of true facets', {**counted, 'sigma_deg': before['sigma_deg'], 'weight': before['weight']}


def self_test():
    """An octagon, a square with a vertex within a side, and a triangle with two right angles and a half."""
    eighth = np.radians(np.arange(0, 360, 45))
    octagon = np.c_[np.cos(eighth), np.sin(eighth)] / (2 * np.sin(np.pi / 8))
    square = [[0, 0], [1, 0], [2, 0], [2, 2], [0, 2]]
    triangle = [[0, 0], [1, 0], [0, 1]]
    count, found = fitted([octagon, square, triangle])
    share = {t['degrees']: t['share'] for t in found['turns']}
    assert count == 15 and share == {45.0: 0.533, 90.0: 0.333, 135.0: 0.133} and abs(found['others']) < 0.002, found
    assert found['per_m'] == round(15 / (8 + 8 + 2 + 2**0.5), 3)
    print('planted corners are counted')
