/**
 * Patches of dense matching (B99 2) as squares that lie in their planes, in the colour of what the plane is; patches in no
 * plane are small and grey, where matching put them.
 */
import { type BufferGeometry, Group, type Mesh, type MeshBasicMaterial } from "three";
import { rectangle } from "../../shared/linear";
import { CLASS_COLOURS, PALETTE } from "../../shared/palette";
import type { DensePlane, DensePlanes, Patch } from "../../shared/records";
import { gradientOf, heightAt, likeliestClass, planesOfPatches } from "../../shared/surfaceClass";
import { opacityOf } from "../../viewer/scene/certainty";
import { colouredMesh, type Layer, quads, rgb } from "../../viewer/scene/layer";
import { partsLayer } from "../../viewer/scene/partsLayer";
import { strokes } from "../../viewer/scene/strokes";

/** Side of a square over the distance of neighbours: narrow gaps let single patches be seen. */
const SIDE = { inPlane: 0.94, free: 0.36 };
/** Alone, and while something is selected. */
const OPACITY = { inPlane: [0.95, 0.25], free: [0.9, 0.25] } as const;
const STEM_PX = 1.25;

interface Square {
  /** The middle, and the rise per metre along x and y. */
  at: readonly [x: number, y: number, z: number];
  gradient: readonly [number, number];
  colour: readonly [red: number, green: number, blue: number, alpha: number];
}

export function buildDense(dense: DensePlanes): Layer {
  const { patches, spacing_m } = dense.trace;
  const owners = planesOfPatches(dense);
  const looks = dense.planes.map(lookOf);
  const inPlane = patches.map((_, i) => i).filter((i) => (owners[i] as number) >= 0);
  const free = patches.filter((_, i) => (owners[i] as number) < 0);
  const squareOf = (i: number) => looks[owners[i] as number]?.(patches[i] as Patch) as Square;
  const others = squares(free.map(freeSquare), SIDE.free * spacing_m);
  others.raycast = () => undefined;
  return partsLayer({
    kind: "dense",
    parts: [
      {
        drawn: squares(inPlane.map(squareOf), SIDE.inPlane * spacing_m),
        opacity: OPACITY.inPlane,
        things: inPlane.map((i) => owners[i] as number),
        facesEach: 2,
      },
      { drawn: others, opacity: OPACITY.free },
    ],
    chosen: (index) => {
      const plane = dense.planes[index];
      return plane === undefined ? null : chosenPlane(plane, plane.patches.map(squareOf), dense);
    },
  });
}

/** A plane's patches, and from each a stem to the height that it had by itself. */
function chosenPlane(plane: DensePlane, own: readonly Square[], { trace }: DensePlanes): Group {
  const bright = squares(own, SIDE.inPlane * trace.spacing_m);
  const ends = plane.patches.flatMap((i) => {
    const { middle, z } = trace.patches[i] as Patch;
    return [...middle, heightAt(plane, ...middle), ...middle, z];
  });
  const stems = strokes(ends, PALETTE.selected, STEM_PX);
  return new Group().add(bright, stems);
}

/** The squares of a plane: coloured by its most probable class, as opaque as that is certain. */
function lookOf(plane: DensePlane): (patch: Patch) => Square {
  const { name, probability } = likeliestClass(plane.class);
  const colour = [...rgb(CLASS_COLOURS[name]), opacityOf(probability)] as const;
  const gradient = gradientOf(plane);
  return ({ middle }) => ({ at: [...middle, heightAt(plane, ...middle)], gradient, colour });
}

/** It stands out from a light background and from a dark one. */
const GREY = [...rgb("#8d949e"), 1] as const;

function freeSquare({ middle, z, gradient }: Patch): Square {
  return { at: [...middle, z], gradient, colour: GREY };
}

/** All in one geometry: two triangles each, in their order. */
export function squares(all: readonly Square[], side: number): Mesh<BufferGeometry, MeshBasicMaterial> {
  const offsets = rectangle([-side / 2, -side / 2], [side / 2, side / 2]);
  const positions = new Float32Array(12 * all.length);
  const colours = new Float32Array(16 * all.length);
  all.forEach(({ at: [x, y, z], gradient: [gx, gy], colour }, i) => {
    offsets.forEach(([dx, dy], k) => {
      positions.set([x + dx, y + dy, z + gx * dx + gy * dy], 12 * i + 3 * k);
      colours.set(colour, 16 * i + 4 * k);
    });
  });
  return colouredMesh(positions, colours, quads(all.length));
}
