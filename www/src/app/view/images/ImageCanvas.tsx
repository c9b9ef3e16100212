/** One view, to zoom (wheel, two fingers, + and -), pan (drag, arrows), fit (0) and pick (click, tap, long press). */
import { useEffect, useRef, useState } from "preact/hooks";
import type { Mark } from "../../../kinds/parts/marks";
import { REJECTED_STRIDE, SEGMENT_STRIDE, SUPPORT_STRIDE } from "../../../shared/flatArrays";
import { isInside } from "../../../shared/linear";
import type { Vec2 } from "../../../shared/records";
import type { Selection } from "../../../shared/selection";
import { type Place, PressWatch } from "../../../viewer/tools/press";
import { ARROWS, useSize } from "../../parts/useDrawn";
import { textScale } from "../../state/textScale";
import { drawView, type Overlay } from "./drawing";
import { cornerAt } from "./graphOverlay";
import { paint } from "./pen";
import {
  fitImage,
  fitPoints,
  nearestSegment,
  type Point,
  pan,
  pinch,
  type Size,
  toImage,
  type Viewport,
  zoomAt,
} from "./viewport";

interface Props {
  view: number;
  name: string;
  image: ImageBitmap;
  overlay: Overlay;
  selection: Selection | null;
  marks: readonly Mark[];
  /** Zooms to the marks until the reader moves the image. */
  follows: boolean;
  /** See `Figure`. */
  inText: boolean;
  onPick: (selection: Selection | null) => void;
  /** Takes places instead, pixels of the image, each so many pixels of the display; null ends that. */
  onPlace?: ((at: Vec2 | null, scale: number) => void) | undefined;
}

const ZOOM_STEP = 1.25;
const PAN_STEP_PX = 40;
const PICK_REACH_PX = 8;
/** A finger hides what it points at. */
const TOUCH_REACH_PX = 18;

export function ImageCanvas({
  view,
  name,
  image,
  overlay,
  selection,
  marks,
  follows,
  inText,
  onPick,
  onPlace,
}: Props) {
  const [canvas, box] = useSize<HTMLCanvasElement>();
  void textScale.value;
  const [moved, setMoved] = useState<Viewport | null>(null);
  const held = useRef(new Map<number, Point>());
  const pick = useRef<(at: Place) => void>(() => undefined);
  const press = useRef(new PressWatch((at) => pick.current(at)));
  const fitted = fitImage(image, box);
  const viewport = moved ?? (follows ? around(marks, image, box) : null) ?? fitted;

  // Another image starts whole.
  useEffect(() => setMoved(null), [image]);
  // So does another selection, where the image follows it.
  useEffect(() => {
    if (follows) {
      setMoved(null);
    }
  }, [selection, follows]);
  useEffect(() => {
    if (canvas.current !== null && box.width > 0) {
      const ratio = window.devicePixelRatio;
      resizeBacking(canvas.current, box, ratio);
      paint(canvas.current, { viewport, box }, ratio, (pen, of) =>
        drawView(pen, of, image, overlay, selection, marks),
      );
    }
  });

  const zoom = (at: Point, factor: number) => setMoved(zoomAt(viewport, at, factor, fitted.scale * 0.5));
  const onWheel = (event: WheelEvent) => {
    if (inText && !event.ctrlKey && !event.metaKey && !canvas.current?.matches(":focus")) {
      return;
    }
    event.preventDefault();
    zoom({ x: event.offsetX, y: event.offsetY }, 1.0015 ** -event.deltaY);
  };
  // The watch outlives this drawing: a finger that rests is told of later.
  pick.current = ({ x, y, isTouch }) => {
    const at = toImage(viewport, { x, y });
    if (onPlace !== undefined) {
      onPlace([at.x, at.y], viewport.scale);
      return;
    }
    const reach = (isTouch ? TOUCH_REACH_PX : PICK_REACH_PX) / viewport.scale;
    onPick(pickAt(overlay, view, at, reach));
  };
  const onPointerDown = (event: PointerEvent) => {
    canvas.current?.setPointerCapture(event.pointerId);
    held.current.set(event.pointerId, placeOf(event));
    press.current.down(event);
  };
  const onPointerMove = (event: PointerEvent) => {
    const before = held.current.get(event.pointerId);
    if (before === undefined) {
      return;
    }
    const next = placeOf(event);
    const [other] = [...held.current].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    held.current.set(event.pointerId, next);
    press.current.move(event);
    setMoved((last) =>
      other === undefined
        ? pan(last ?? viewport, next.x - before.x, next.y - before.y)
        : pinch(last ?? viewport, [before, other], [next, other], fitted.scale * 0.5),
    );
  };
  const onPointerUp = (event: PointerEvent) => {
    held.current.delete(event.pointerId);
    press.current.up(event);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const next = viewportAfterKey(event.key, viewport, box, fitted.scale);
    if (next !== undefined) {
      event.preventDefault();
      setMoved(next);
    } else if (event.key === "Enter" && onPlace !== undefined) {
      const { x, y } = toImage(viewport, { x: box.width / 2, y: box.height / 2 });
      onPlace([x, y], viewport.scale);
    } else if (event.key === "Escape") {
      if (onPlace === undefined) {
        onPick(null);
      } else {
        onPlace(null, viewport.scale);
      }
    }
  };

  return (
    <figure class="image-view">
      <canvas
        ref={canvas}
        tabIndex={0}
        role="img"
        aria-label={
          onPlace === undefined
            ? `${name}: drag to move, scroll to zoom, click a line to pick it`
            : `${name}: drag to move, scroll to zoom, click an end of the edge; Enter takes the place in the middle`
        }
        onWheel={onWheel}
        onPointerDown={onPointerDown}
        onPointerMove={onPointerMove}
        onPointerUp={onPointerUp}
        onPointerCancel={(event) => {
          held.current.delete(event.pointerId);
          press.current.cancel(event);
        }}
        onContextMenu={(event) => event.preventDefault()}
        onDblClick={() => setMoved(null)}
        onKeyDown={onKeyDown}
      />
      {onPlace !== undefined && <span class="aim" aria-hidden="true" />}
      <figcaption class="numbers">
        {name} · {Math.round(100 * viewport.scale)} %
      </figcaption>
    </figure>
  );
}

function placeOf({ offsetX, offsetY }: PointerEvent): Point {
  return { x: offsetX, y: offsetY };
}

/** Image pixels about marks that are zoomed to. */
const MARGIN_PX = 45;
const MAX_FOLLOW_SCALE = 3;

/** The viewport of the marks; null where they are none of this image's. */
function around(marks: readonly Mark[], image: Size, box: Size): Viewport | null {
  // Dashed lines are endless: what they cross is shown anyway.
  const inside = ([x, y]: Vec2) => x >= 0 && y >= 0 && x <= image.width && y <= image.height;
  const points = marks.filter(({ dashed }) => dashed !== true).flatMap((mark) => mark.points.filter(inside));
  return box.width === 0 ? null : fitPoints(points, box, MARGIN_PX, MAX_FOLLOW_SCALE);
}

/** The nearest corner of a graph; else the nearest line or segment, in the order that the overlay asks for; else what was rejected, or the region below. */
function pickAt(overlay: Overlay, view: number, at: Point, reach: number): Selection | null {
  const { segments, supports, rejected, regions, segmentsFirst } = overlay;
  const corner = overlay.graph == null ? null : cornerAt(overlay.graph, [at.x, at.y], reach);
  if (corner !== null) {
    return { kind: "corner", index: corner };
  }
  const line = (): Selection | null => {
    const support = supports === null ? -1 : nearestSegment(supports, SUPPORT_STRIDE, at, reach);
    return support < 0 ? null : { kind: "line", index: supports?.[support * SUPPORT_STRIDE + 5] as number };
  };
  const segment = (): Selection | null => {
    const index = segments === null ? -1 : nearestSegment(segments, SEGMENT_STRIDE, at, reach);
    return index < 0 ? null : { kind: "segment", view, index };
  };
  const rejectedOne = (): Selection | null => {
    const index = rejected == null ? -1 : nearestSegment(rejected, REJECTED_STRIDE, at, reach);
    return index < 0 ? null : { kind: "rejectedSegment", view, index };
  };
  const region = (): Selection | null => {
    const index =
      regions?.findIndex(
        ({ rings }) => rings.filter((ring) => isInside([at.x, at.y], ring)).length % 2 === 1,
      ) ?? -1;
    return index < 0 ? null : { kind: "region", view, index };
  };
  return (segmentsFirst ? (segment() ?? line()) : (line() ?? segment())) ?? rejectedOne() ?? region();
}

/** Null: the whole image again; undefined: the key means nothing here. */
function viewportAfterKey(
  key: string,
  viewport: Viewport,
  box: Size,
  fitScale: number,
): Viewport | null | undefined {
  const middle = { x: box.width / 2, y: box.height / 2 };
  const arrow = ARROWS[key];
  if (arrow !== undefined) {
    return pan(viewport, -PAN_STEP_PX * arrow[0], -PAN_STEP_PX * arrow[1]);
  }
  switch (key) {
    case "+":
    case "=":
      return zoomAt(viewport, middle, ZOOM_STEP, fitScale * 0.5);
    case "-":
      return zoomAt(viewport, middle, 1 / ZOOM_STEP, fitScale * 0.5);
    case "0":
      return null;
    default:
      return undefined;
  }
}

function resizeBacking(canvas: HTMLCanvasElement, box: Size, ratio: number): void {
  const width = Math.round(box.width * ratio);
  const height = Math.round(box.height * ratio);
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
}
