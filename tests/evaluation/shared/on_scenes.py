"""What the scripts share that run the program on scenes: their arguments, which scenes they take, the frame of the truth, and the
measures by which a model is judged."""

import argparse
import importlib.util
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[3]
# Of what score.py writes of a model and its lines.
MEASURES = {
    'complete': lambda s: s['faces']['gt_10m2']['completeness'],
    'correct': lambda s: s['faces']['gt_10m2']['correctness'],
    'area within 0.2 m': lambda s: s['area']['covered_within_0_2m_fraction'],
    'outline [m]': lambda s: s['faces']['geometry']['rms_outline_m'],
    'edges covered': lambda s: s['lines']['edge_length_covered'],
    'wrong lines': lambda s: s['lines']['wrong'],
}


def parser_of(doc, only='names of scenes, separated by commas'):
    """The arguments of all of them; `doc` is the script's own, whose first line is the description."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0])
    parser.add_argument('--binary', required=True, type=pathlib.Path)
    parser.add_argument('--scenes', required=True, type=pathlib.Path)
    if only:
        parser.add_argument('--only', help=only)
    return parser


def is_wanted(args, name):
    return not args.only or name in args.only.split(',')


def names_of(args):
    """Names of the wanted scenes, in order."""
    names = sorted(p.name for p in args.scenes.iterdir() if (p / 'cameras.json').exists())
    return [name for name in names if is_wanted(args, name)]


def is_rendered(scene):
    """Is there an exact truth? That of real scenes is digitised."""
    return (scene / 'truth').is_dir() and not (scene / 'check').is_dir()


def is_random(scene):
    """Is it named by a seed?"""
    return scene.name[0] == 'r' and scene.name[1:].isdigit()


def loaded(scorer):
    """score.py, by its path, as a module."""
    spec = importlib.util.spec_from_file_location('score', scorer)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def move_to_truth(seen, middle, origin):
    """How far to move what was seen at a place into the frame of the truth, metres: it stands there already, or with the map's
    origin added."""
    def apart(move):
        return sum((seen[k] + move[k] - middle[k]) ** 2 for k in (0, 1))

    return min([0.0, 0.0, 0.0], [-float(x) for x in origin], key=apart)
