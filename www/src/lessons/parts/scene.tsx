/** Drawings of the toy scene: the house in an image, and the house with its cameras from the side. */
import type { ComponentChildren } from "preact";
import { add, clipLine, rectangle, scaled } from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { atHeight, type Camera, imageOf, lookingAt } from "../toy/camera";
import { type FaceName, facesIn } from "../toy/house";
import { Dot, Drawing, Label, Line, Shape } from "./draw";

const FACE_CLASS: Readonly<Record<FaceName, string>> = {
  "south roof": "face roof-south",
  "north roof": "face roof-north",
  east: "face wall-side",
  west: "face wall-side",
  south: "face wall",
  north: "face wall",
};

/** The faces that a camera sees. */
function House({ camera }: { camera: Camera }) {
  return (
    <>
      {facesIn(camera).map(({ face, outline }) => (
        <Shape key={face.name} points={outline} class={FACE_CLASS[face.name]} />
      ))}
    </>
  );
}

const VIEW_NAMES = { 1: "First view", 2: "Second view", 3: "Third view" } as const;

/** An image of the house, with what is drawn over it in its pixels. */
export function ImagePane(props: {
  camera: Camera;
  /** Of which view it is, in whose colour. */
  colour: 1 | 2 | 3;
  /** Below it, and for those who do not see it; otherwise the view's name. */
  title?: string;
  label?: string;
  children?: ComponentChildren;
}) {
  const { camera, colour, title = VIEW_NAMES[colour], label = VIEW_NAMES[colour], children } = props;
  return (
    <figure class={`pane s${colour}`}>
      <Drawing width={camera.width} height={camera.height} label={label} isImage>
        <GroundGrid camera={camera} />
        <House camera={camera} />
        {children}
      </Drawing>
      <figcaption>{title}</figcaption>
    </figure>
  );
}

const GRID_M = 4;
const FAR_M = 24;

/** Lines on the ground, so that one sees how it lies. */
function GroundGrid({ camera }: { camera: Camera }) {
  const at = [-6, -5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 6].map((i) => i * GRID_M);
  return (
    <g class="ground">
      {at.map((t) => (
        <g key={t}>
          <Line from={imageOf(camera, [t, -FAR_M, 0])} to={imageOf(camera, [t, FAR_M, 0])} class="" />
          <Line from={imageOf(camera, [-FAR_M, t, 0])} to={imageOf(camera, [FAR_M, t, 0])} class="" />
        </g>
      ))}
    </g>
  );
}

/** The part of a line (a, b, c) that lies in an image. */
export function ImageLine({ of, camera, class: name }: { of: Vec3; camera: Camera; class: string }) {
  const part = clipLine(of, camera.width, camera.height);
  return part === null ? null : <Line from={part[0]} to={part[1]} class={name} />;
}

/** Where the drawings in space are seen from: from the south-west, above. */
export const OBSERVER: Camera = {
  f: 640,
  cx: 190,
  cy: 200,
  width: 400,
  height: 385,
  C: [-38, -82, 38],
  R: lookingAt([-38, -82, 38], [0, 0, 19], [0, 0, 1]),
};

export const seen = (X: Vec3): Vec2 => imageOf(OBSERVER, X);

/** Where the drawing begins if no cameras are above the house. */
const LOW_TOP = 165;

/** The scene in space, with the cameras C and C′. Children are drawn over it, at `seen(X)`. */
export function Space(props: { label: string; cameras: readonly Camera[]; children?: ComponentChildren }) {
  const { label, cameras, children } = props;
  const top = cameras.length === 0 ? LOW_TOP : 0;
  return (
    <Drawing width={OBSERVER.width} height={OBSERVER.height - top} top={top} label={label} class="space">
      <g class="ground">
        {[-16, -8, 0, 8, 16].map((t) => (
          <g key={t}>
            <Line from={seen([t, -16, 0])} to={seen([t, 16, 0])} class="" />
            <Line from={seen([-16, t, 0])} to={seen([16, t, 0])} class="" />
          </g>
        ))}
      </g>
      <House camera={OBSERVER} />
      {cameras.map((camera, i) => (
        <Frustum key={i.toString()} camera={camera} name={i === 0 ? "C" : "C′"} colour={i === 0 ? 1 : 2} />
      ))}
      {children}
    </Drawing>
  );
}

/** How far before the centre the image is drawn, metres. */
const IMAGE_M = 7;

/** A place in the image of a camera as it stands in space, before its centre. */
export function inFrame(camera: Camera, [x, y]: Vec2): Vec3 {
  const [right, down, forward] = camera.R as unknown as readonly [Vec3, Vec3, Vec3];
  const by = IMAGE_M / camera.f;
  return add(
    camera.C,
    add(
      scaled(forward, IMAGE_M),
      add(scaled(right, (x - camera.cx) * by), scaled(down, (y - camera.cy) * by)),
    ),
  );
}

/** A camera: its centre and its image before it, as a print holds it. */
function Frustum({ camera, name, colour }: { camera: Camera; name: string; colour: 1 | 2 }) {
  const corners = rectangle([0, 0], [camera.width, camera.height]).map((x) => seen(inFrame(camera, x)));
  const centre = seen(camera.C);
  return (
    <g class={`frustum s${colour}`}>
      {corners.map((corner) => (
        <Line key={corner.join()} from={centre} to={corner} class="faint" />
      ))}
      <Shape points={corners} class="film" />
      <Dot at={centre} class="s5" />
      <Label at={centre} dx={8} dy={-4} class="s5 vector" text={name} />
    </g>
  );
}

/** The plane through a projection centre and an image line, as far down as the ground. */
export function PlaneOfLine(props: {
  camera: Camera;
  ends: readonly [Vec2, Vec2];
  class: string;
  down?: number;
}) {
  const { camera, ends, class: name, down = 0 } = props;
  const [p, q] = ends.map((x) => seen(atHeight(camera, x, down))) as [Vec2, Vec2];
  return <Shape points={[seen(camera.C), p, q]} class={name} />;
}
