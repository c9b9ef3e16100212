/** The photograph over the model, where the camera sees it, and the choice of the camera. */
import { type ReadonlySignal, signal } from "@preact/signals";
import { fitShares } from "../../../viewer/scene/photoProjection";
import type { Viewer } from "../../../viewer/viewer";
import { useDrawn } from "../../parts/useDrawn";
import { images, scene } from "../../state/scene";

/** The view whose camera is looked through, and how opaque its photograph is. */
const chosen = signal<number | null>(null);
export const throughView: ReadonlySignal<number | null> = chosen;
const opacity = signal(0.5);

/** Through the camera of a view; null for the free one. */
export function lookThrough(viewer: Viewer | null, view: number | null): void {
  chosen.value = view;
  viewer?.lookThrough(view === null ? null : (scene.value?.views[view] ?? null));
}

export function FlyTo({ viewer }: { viewer: Viewer | null }) {
  const views = scene.value?.views ?? [];
  return (
    <div class="fly">
      <select
        aria-label="Look through the camera of a view"
        value={throughView.value ?? ""}
        onChange={(event) => {
          const text = event.currentTarget.value;
          lookThrough(viewer, text === "" ? null : Number(text));
        }}
      >
        <option value="">Free camera</option>
        {views.map(({ name }, view) => (
          <option key={name} value={view}>
            {name}
          </option>
        ))}
      </select>
      {throughView.value !== null && (
        <input
          type="range"
          min={0}
          max={1}
          step={0.01}
          value={opacity.value}
          aria-label="Opacity of the photograph"
          onInput={(event) => {
            opacity.value = Number(event.currentTarget.value);
          }}
        />
      )}
    </div>
  );
}

/** The photograph over the model, where the camera sees it. */
export function Photograph({ view }: { view: number }) {
  const image = images.value[view];
  const draw = (context: CanvasRenderingContext2D) => {
    if (image !== undefined) {
      const { clientWidth, clientHeight } = context.canvas;
      const [sx, sy] = fitShares(image, clientWidth / clientHeight);
      context.canvas.width = Math.round(clientWidth * window.devicePixelRatio);
      context.canvas.height = Math.round(clientHeight * window.devicePixelRatio);
      const { width, height } = context.canvas;
      context.imageSmoothingQuality = "high";
      context.drawImage(image, (width * (1 - sx)) / 2, (height * (1 - sy)) / 2, width * sx, height * sy);
    }
  };
  const canvas = useDrawn(draw, [image, view]);
  return (
    <canvas
      ref={canvas}
      class="photograph"
      style={{ opacity: opacity.value }}
      data-testid="photograph"
      role="img"
      aria-label="The photograph over the model"
    />
  );
}
