"""docs/results.md, written from the tables of one run of all scenes; what other scripts write into it stands between markers."""

import subprocess

from shared.on_scenes import ROOT

RESULTS = ROOT / 'docs' / 'results.md'

# `{name}` is a table of score_table.py, `[name]` a section that another script puts between its markers.
PAGE = '''# Results

Written by `make score` from program {program}:
every scene of the folder `SCENES`, with the default parameters, scored by the programs beside that folder. Sections between markers
name the program that they are of. Elsewhere: [time](bench.md), [photographs without
orientation](results/photographs-alone.md), [the page](results/page.md), [damaged files](results/fuzzing.md).

## Rendered scenes, exact truth

{rendered}

* *edges in 2D*: share of the visible true edges that image segments cover, mean of the views; *edges in 3D*: share of the length of
  the true roof edges that has a 3D line.
* *on roof edges*: share of the 3D lines that lie on true roof edges; *true*: on any true surface of ground or buildings.
* *complete*, *correct*: facets above 10 m² after the ISPRS benchmark on urban object reconstruction; *area within 0.2 m*: share of
  the true roof area that the model covers within 0.2 m in height.

### Changed a little, many times

`make jury` runs each scene with noise, other exposures, images turned by quarters and without some of its views; *in 4:2:0* one
colour is kept for four pixels, as in most photographs. Means:

[perturbed]

## Random scenes that chose nothing

`make judge`: noise of 1 to 4 grey levels, JPEG, 3 to 8 views, irregular flights, weak textures, orientation errors in half of them.
What earlier seeds judged: [results/fresh-seeds.md](results/fresh-seeds.md).

[seeds]

## Real photographs

{real}

* *planes found*: of the planes that were fitted to independent tie points; these are seen in three views at least, chimneys and
  trees among them. *lines at tie points*: of the lines with such points within 0.5 m in plan, those with one within 0.3 m in height.

![The model of real-farmhouse from four sides](figures/real-farmhouse.jpg)
![The model of real-barns from four sides](figures/real-barns.jpg)

Both by the page (`npm run pictures` in www/). Photographs: Ohio Department of Transportation / OpenDroneMap, CC0 1.0; (c) Andrew
Zaborowski / OpenStreetMap-PL, CC BY 3.0; undistorted, rescaled and cropped.

## Lines

The first rows are what B99 reports of its two sets of photographs. How they are counted, and how accuracy and time grow with the
number of views: [results/lines.md](results/lines.md).

{lines}

* *wrong*: neither near a true roof edge nor on any true surface. *merged*, *grown*: joined from several segments in a view, or
  longer than them there. *within sigma*: errors below the stated `sigma_m`. *new lines*: from the model (B99 4.2, 4.3); all columns
  before are of the matched ones.

## Half-planes

B99 4.4 measures theta to 2 degrees on textured facets and to 5 on weak ones. Angle to the true facet beside the line; *within
sigma*: below the standard deviation that halfplanes.json states.

{halfplanes}

## Other methods

Lines / rectangles (W96, made for rectangular roofs with contrast at their sides) / combined, which takes three to four times as
long as lines.

{combined}
'''
# Another script's.
SECTIONS = ('perturbed', 'seeds')


def page(results, present):
    """The page of results {'program', 'tables': {name: rows, of which the first is the head}}; `present` is the page as it
    stands, whose sections of other scripts stay."""
    text = PAGE.format(program=results['program'], **{name: markdown(rows) for name, rows in results['tables'].items()})
    for name in SECTIONS:
        text = text.replace(f'[{name}]', marked(name, section_of(present, name)))
    return text


def put_section(path, name, section):
    """Puts a section between its markers."""
    text = path.read_text()
    path.write_text(text.replace(marked(name, section_of(text, name)), marked(name, section)))
    print(f'{path.relative_to(ROOT)}, {name}: rewritten')


def section_of(text, name):
    begin, end = f'<!-- {name}: begin -->\n', f'\n<!-- {name}: end -->'
    return text.split(begin)[1].split(end)[0]


def marked(name, section):
    return f'<!-- {name}: begin -->\n{section}\n<!-- {name}: end -->'


def markdown(rows):
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = ['| ' + ' | '.join(cell.ljust(width) for cell, width in zip(row, widths)) + ' |' for row in rows]
    return '\n'.join([lines[0], '|' + '|'.join('-' * (width + 2) for width in widths) + '|', *lines[1:]])


def program_here():
    """The commit of this tree; a + where something is changed."""
    def git(*words):
        return subprocess.run(['git', *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()

    return git('rev-parse', '--short=8', 'HEAD') + ('+' if git('status', '--porcelain', '--untracked-files=no') else '')
