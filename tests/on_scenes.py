"""What the scripts share that run the program on scenes: their arguments, and which scenes they take."""

import argparse
import pathlib


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
