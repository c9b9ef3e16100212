/** Photographs with marks in their own pixels: whole, to point at, or a part of them, enlarged. */
import type { Signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useDrawn } from "../../app/parts/useDrawn";
import type { SceneState } from "../../element/sharedScene";
import type { Vec2 } from "../../shared/records";
import { Drawing, PointHandle } from "../parts/draw";
import { place } from "../parts/say";
import { SceneBar } from "./SceneBar";
import { type LoadedScene, type LoadedView, useScene } from "./useScene";

/** More pixels than a screen shows are not drawn. */
const MOST_SHOWN = 1200;

interface PhotoProps {
  view: LoadedView;
  title?: string;
  /** The part that is shown; without it the whole photograph. */
  part?: { centre: Vec2; size: number };
  /** Where the mark is that the reader moves. */
  at?: Signal<Vec2>;
  children?: ComponentChildren;
}

export function Photo({ view, title, part, at, children }: PhotoProps) {
  const { image, width, height, name } = view;
  const [x0, y0, w, h] =
    part === undefined
      ? [0, 0, width, height]
      : [part.centre[0] - part.size / 2, part.centre[1] - part.size / 2, part.size, part.size];
  const shown = Math.min(1, MOST_SHOWN / w);
  const [columns, rows] = part === undefined ? [Math.round(w * shown), Math.round(h * shown)] : [240, 240];
  const draw = (context: CanvasRenderingContext2D) => {
    context.imageSmoothingEnabled = part === undefined;
    context.clearRect(0, 0, columns, rows);
    context.drawImage(image, x0, y0, w, h, 0, 0, columns, rows);
  };
  const canvas = useDrawn(draw, [image, x0, y0, w, h, columns, rows, part === undefined]);
  return (
    <figure class="photo">
      <div class="stack">
        <canvas ref={canvas} width={columns} height={rows} role="img" aria-label={`Photograph ${name}`} />
        <Drawing width={w} height={h} label={`Marks on ${name}`} isImage>
          <g transform={`translate(${-x0} ${-y0})`}>
            {children}
            {at !== undefined && (
              <PointHandle
                of={at}
                size={view}
                class="s1 on-photo"
                label={`Point in ${name}`}
                says={`${place(at.value, 0)} pixels`}
                step={Math.max(1, w / 200)}
              />
            )}
          </g>
        </Drawing>
      </div>
      <figcaption>{title ?? name}</figcaption>
    </figure>
  );
}

/** The chosen scene, once it is loaded, below the line that chooses it. */
export function OnScene({ children }: { children: (scene: LoadedScene) => ComponentChildren }) {
  const { root, state, loaded } = useScene();
  const now = loaded.value;
  return (
    <div class="real" ref={root}>
      <SceneBar />
      {now === null ? <Waiting state={state.value} /> : children(now)}
    </div>
  );
}

/** What is going on while there is nothing to show yet. */
function Waiting({ state }: { state: SceneState | null }) {
  return state?.failure != null ? (
    <p class="failure" role="alert">
      {state.failure}
    </p>
  ) : (
    <p class="muted waiting" role="status">
      {state?.progress?.words ?? "The photographs are read when they are seen."}
    </p>
  );
}
