"""One round of what other programs take for the same, on one core: LSD and EDLines of OpenCV for segments, the line
triangulation of LIMAP for 3D lines. `tests/evaluation/bench.py` runs it by the Python of an environment that has them:

    python tests/evaluation/shared/peers.py --images FOLDER [--segments segments.json --model FOLDER]

Prints JSON. Decoding the images and starting the libraries is not counted. LIMAP gets our segments, the cameras of the
COLMAP text model and all pairs of images, and has its own settings otherwise.
"""
import argparse
import importlib.metadata
import json
import pathlib
import time

# The shortest segment that counts, pixels: ours are no shorter (`segments.min_length_px`).
MIN_LENGTH_PX = 15.0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--images', type=pathlib.Path, required=True)
    parser.add_argument('--segments', type=pathlib.Path)
    parser.add_argument('--model', type=pathlib.Path)
    args = parser.parse_args()
    found = {'segments': attempt(segments, args)}
    if args.segments and args.model:
        found['lines'] = attempt(lines, args)
    print(json.dumps(found))


def attempt(work, args):
    """What it found, or why it could not."""
    try:
        return work(args)
    except Exception as why:  # Whatever fails in another's library is told, and stops nothing.
        return {'failed': f'{type(why).__name__}: {why}'}


def segments(args):
    """Mean seconds an image and number of segments of each detector."""
    import cv2

    cv2.setNumThreads(1)
    images = [cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) for path in sorted(args.images.iterdir())]
    images = [image for image in images if image is not None]
    drawing = cv2.ximgproc.createEdgeDrawing()
    lsd = cv2.createLineSegmentDetector()

    def ed_lines(image):
        drawing.detectEdges(image)
        return drawing.detectLines()

    found = {'version': cv2.__version__, 'images': len(images)}
    for name, detect in (('LSD', lambda image: lsd.detect(image)[0]), ('EDLines', ed_lines)):
        detect(images[0])
        start = time.perf_counter()
        of_images = [detect(image) for image in images]
        seconds = (time.perf_counter() - start) / len(images)
        ends = [segment for of_image in of_images if of_image is not None for segment in of_image.reshape(-1, 4)]
        found[name] = {'seconds': seconds, 'segments': sum(map(long, ends))}
    return found


def long(ends):
    return bool((ends[2] - ends[0]) ** 2 + (ends[3] - ends[1]) ** 2 >= MIN_LENGTH_PX ** 2)


def lines(args):
    """Seconds of LIMAP's triangulation (matching, tracks, merging, filters), those of its adjustment of the lines, and the
    number of 3D lines."""
    import numpy as np
    import pycolmap
    from limap.estimators import bundle_adjustment
    from limap.geometry import get_line2d_vector_from_array
    from limap.scene import HolisticReconstruction, Structure2d, StructureCorrespondenceGraph, Wireframe2d
    from limap.sfm import GlobalLineTriangulationOptions, global_line_triangulation

    pycolmap.logging.minloglevel = pycolmap.logging.ERROR
    points = pycolmap.Reconstruction(args.model)
    of_view = {view['view']: np.array(view['segments'], float).reshape(-1, 4)
               for view in json.loads(args.segments.read_text())}
    scene = HolisticReconstruction(points)
    ids = [key for key, image in points.images.items() if image.name in of_view]
    for key in ids:
        structure = Structure2d(get_line2d_vector_from_array(of_view[points.images[key].name]), [], Wireframe2d())
        scene.structure_recon.add_structure2d(key, structure)
    options = GlobalLineTriangulationOptions()
    options.num_threads = 1
    start = time.perf_counter()
    global_line_triangulation(options, scene, StructureCorrespondenceGraph().line_graph,
                              {key: [other for other in ids if other != key] for key in ids})
    triangulated = time.perf_counter()
    adjust(bundle_adjustment, scene)
    return {'version': importlib.metadata.version('pylimap'), 'images': len(ids), 'seconds': triangulated - start,
            'adjustment_seconds': time.perf_counter() - triangulated, 'lines': scene.structure_recon.num_lines3D()}


def adjust(bundle_adjustment, scene):
    """The lines alone, the cameras stay: as our lines are adjusted."""
    options = bundle_adjustment.PointLineBundleAdjustmentOptions()
    for what in ('focal_length', 'principal_point', 'extra_params', 'points', 'rig_from_world', 'sensor_from_rig'):
        setattr(options, f'refine_{what}', False)
    options.print_summary = False
    options.ceres.solver_options.num_threads = 1
    config = bundle_adjustment.PointLineBundleAdjustmentConfig()
    for line in scene.structure_recon.lines3D:
        config.add_variable_line(line)
    bundle_adjustment.create_point_line_bundle_adjuster(options, config, scene).solve()


if __name__ == '__main__':
    main()
