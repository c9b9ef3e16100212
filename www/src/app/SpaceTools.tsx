/** The tools of the 3D view: fit, look down, look through a view's camera, measure, keep a picture. */
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { Measured } from "../viewer/measure";
import { fitShares } from "../viewer/photo";
import type { Viewer } from "../viewer/viewer";
import { save } from "./files";
import { images, scene, tab } from "./state";

/** The view whose camera is looked through, and how opaque its photograph is. */
export const through = signal<number | null>(null);
const opacity = signal(0.5);
const measured = signal<Measured | null>(null);

export function SpaceTools({ viewer, onFit }: { viewer: Viewer | null; onFit: () => void }) {
  const leave = () => {
    through.value = null;
    viewer?.lookThrough(null);
  };
  const toggleMeasure = () => {
    const isOn = measured.value !== null;
    measured.value = isOn
      ? null
      : { points: 0, distanceM: null, planM: null, heightM: null, slope: null, areaM2: null };
    viewer?.measure(isOn ? null : (found) => (measured.value = found));
  };
  const keepPicture = async () => {
    const blob = await viewer?.screenshot();
    if (blob != null) {
      save(`${tab.value}.png`, blob);
    }
  };
  return (
    <>
      {through.value !== null && <Photograph view={through.value} />}
      <div class="space-tools">
        <button
          type="button"
          onClick={() => {
            leave();
            onFit();
          }}
        >
          Fit
        </button>
        <button
          type="button"
          onClick={() => {
            leave();
            viewer?.lookDown();
          }}
        >
          Top
        </button>
        <button type="button" aria-pressed={measured.value !== null} onClick={toggleMeasure}>
          Measure
        </button>
        <button type="button" onClick={() => void keepPicture()}>
          Picture
        </button>
        <FlyTo viewer={viewer} />
      </div>
      {measured.value !== null && <Reading measured={measured.value} />}
    </>
  );
}

function FlyTo({ viewer }: { viewer: Viewer | null }) {
  const views = scene.value?.views ?? [];
  return (
    <div class="fly">
      <select
        aria-label="Look through the camera of a view"
        value={through.value ?? ""}
        onChange={(event) => {
          const text = event.currentTarget.value;
          through.value = text === "" ? null : Number(text);
          viewer?.lookThrough(text === "" ? null : (views[Number(text)] ?? null));
        }}
      >
        <option value="">Free camera</option>
        {views.map(({ name }, view) => (
          <option key={name} value={view}>
            {name}
          </option>
        ))}
      </select>
      {through.value !== null && (
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
function Photograph({ view }: { view: number }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const image = images.value[view];
  useEffect(() => {
    const context = canvas.current?.getContext("2d");
    if (context != null && image !== undefined) {
      const { clientWidth, clientHeight } = context.canvas;
      const [sx, sy] = fitShares(image, clientWidth / clientHeight);
      context.canvas.width = Math.round(clientWidth * window.devicePixelRatio);
      context.canvas.height = Math.round(clientHeight * window.devicePixelRatio);
      const { width, height } = context.canvas;
      context.imageSmoothingQuality = "high";
      context.drawImage(image, (width * (1 - sx)) / 2, (height * (1 - sy)) / 2, width * sx, height * sy);
    }
  }, [image, view]);
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

function Reading({ measured: found }: { measured: Measured }) {
  if (found.distanceM === null || found.slope === null) {
    return (
      <p class="reading" role="status">
        {found.points === 0 ? "Click two points, or more for an area." : "One more point."}
      </p>
    );
  }
  const rows = [
    ["Distance", `${found.distanceM.toFixed(2)} m`],
    ["In plan", `${(found.planM ?? 0).toFixed(2)} m`],
    ["Height", `${(found.heightM ?? 0).toFixed(2)} m`],
    ["Slope", `${((found.slope * 180) / Math.PI).toFixed(1)}°`],
    ...(found.areaM2 === null ? [] : [["Area", `${found.areaM2.toFixed(2)} m²`]]),
  ] as const;
  return (
    <dl class="reading facts" aria-live="polite" data-testid="reading">
      {rows.map(([name, value]) => (
        <div key={name}>
          <dt>{name}</dt>
          <dd class="numbers">{value}</dd>
        </div>
      ))}
    </dl>
  );
}
