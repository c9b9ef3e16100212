/** The tools of the 3D view: fit, look down, look through a view's camera, measure, cut, keep a picture. */
import { signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { clamp } from "../../../shared/linear";
import { yUp, zUp } from "../../../viewer/scene/frame";
import type { Corner, Measured, Taken } from "../../../viewer/tools/measure";
import type { Section } from "../../../viewer/tools/section";
import type { Viewer } from "../../../viewer/viewer";
import { Menu } from "../../parts/Menu";
import { degreesOf } from "../../parts/numberText";
import { saveFile } from "../../parts/saveFile";
import { ARROWS } from "../../parts/useDrawn";
import { isCorrecting, takePoint } from "../../results/corrections/drawn";
import { mainResults } from "../../state/results";
import { scene } from "../../state/scene";
import { tab } from "../../state/viewState";
import { isPhone } from "../screen/layout";
import { FlyTo, lookThrough, Photograph, throughView } from "./Photograph";
import { SectionChart } from "./SectionChart";

/** What clicks in the space view do besides picking. */
type Tool = "measure" | "section" | "draw";

const tool = signal<Tool | null>(null);
const measured = signal<{ found: Measured; last: Taken } | null>(null);
const section = signal<Section | null>(null);

interface Props {
  viewer: Viewer | null;
  onFit: () => void;
  /** What stands before the tools: which layers are seen, and how. */
  children: ComponentChildren;
}

export function SpaceTools({ viewer, onFit, children }: Props) {
  const leave = () => lookThrough(viewer, null);
  const choose = (next: Tool) => {
    const isOn = tool.value === next;
    aim.value = null;
    measured.value = null;
    section.value = null;
    tool.value = isOn ? null : next;
    const isMeasuring = !isOn && next === "measure";
    viewer?.measure(isMeasuring ? (found, last) => (measured.value = { found, last }) : null, corners());
    viewer?.section(isOn || next !== "section" ? null : (found) => (section.value = found));
    if (!isOn && next === "draw") {
      viewer?.draw3d(takePoint);
    }
  };
  useEffect(() => {
    const end = ({ key }: KeyboardEvent) => {
      if (key === "Escape" && tool.value !== null) {
        choose(tool.value);
      }
    };
    window.addEventListener("keydown", end);
    return () => window.removeEventListener("keydown", end);
  });
  const keepPicture = async () => {
    const blob = await viewer?.screenshot();
    if (blob != null) {
      saveFile(`${tab.value}.png`, blob);
    }
  };
  const tools = (
    <>
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
      <button type="button" aria-pressed={tool.value === "measure"} onClick={() => choose("measure")}>
        Measure
      </button>
      <button type="button" aria-pressed={tool.value === "section"} onClick={() => choose("section")}>
        Section
      </button>
      {isCorrecting.value && (
        <button type="button" aria-pressed={tool.value === "draw"} onClick={() => choose("draw")}>
          Draw
        </button>
      )}
      <button type="button" onClick={() => void keepPicture()}>
        Picture
      </button>
      <FlyTo viewer={viewer} />
    </>
  );
  return (
    <>
      {throughView.value !== null && <Photograph view={throughView.value} />}
      <div class="space-tools">
        {children}
        {isPhone.value ? <Menu title="Tools">{tools}</Menu> : tools}
      </div>
      {tool.value !== null && <Crosshair viewer={viewer} />}
      {tool.value === "measure" && <Reading />}
      {tool.value === "draw" && (
        <p class="reading" role="status">
          Click points of the model; dots can be dragged.
        </p>
      )}
      {tool.value === "section" && <Profile viewer={viewer} />}
    </>
  );
}

/** Where the crosshair is, CSS pixels of the canvas; null: in its middle. */
const aim = signal<{ x: number; y: number } | null>(null);

const STEP_PX = 12;

/** Points for the tools without a pointer: arrows move the crosshair (Shift: finely), Enter takes the point below it. */
function Crosshair({ viewer }: { viewer: Viewer | null }) {
  const button = useRef<HTMLButtonElement>(null);
  const { clientWidth = 0, clientHeight = 0 } = button.current?.parentElement ?? {};
  const place = aim.value ?? { x: clientWidth / 2, y: clientHeight / 2 };
  const onKeyDown = (event: KeyboardEvent) => {
    const step = ARROWS[event.key];
    if (step !== undefined) {
      event.preventDefault();
      const size = event.shiftKey ? 1 : STEP_PX;
      aim.value = {
        x: clamp(place.x + size * step[0], 0, clientWidth - 1),
        y: clamp(place.y + size * step[1], 0, clientHeight - 1),
      };
    }
  };
  // Its place is known once it is laid out.
  useEffect(() => {
    aim.value ??= { x: (button.current?.parentElement?.clientWidth ?? 0) / 2, y: middleOf(button.current) };
  }, []);
  return (
    <button
      ref={button}
      type="button"
      class="crosshair"
      aria-label="Crosshair: arrow keys move it, Shift finely, Enter takes the point below it, Escape ends the tool"
      style={{ left: `${place.x}px`, top: `${place.y}px` }}
      onKeyDown={onKeyDown}
      onClick={() => viewer?.press(place)}
    />
  );
}

function middleOf(element: HTMLElement | null): number {
  return (element?.parentElement?.clientHeight ?? 0) / 2;
}

/** The profile once there are two points, and which side of the cut is taken away. */
function Profile({ viewer }: { viewer: Viewer | null }) {
  if (section.value === null) {
    return (
      <p class="reading" role="status">
        Click the two ends of the cut. By keyboard: Tab to the crosshair.
      </p>
    );
  }
  return (
    <div class="reading section" data-testid="section">
      <SectionChart section={section.value} />
      <div class="row">
        <button type="button" onClick={() => viewer?.clip("other")}>
          Other side
        </button>
        <button type="button" onClick={() => viewer?.clip("none")}>
          Whole model
        </button>
      </div>
    </div>
  );
}

/** The rings of all facets, and how well their corners are known: the outer one first, as in the uncertainty. */
function corners(): Corner[][] {
  return (mainResults.peek().facets ?? []).flatMap(({ outer, holes, uncertainty }) => {
    let next = 0;
    return [outer, ...holes].map((ring) =>
      ring.map((at) => {
        const known = uncertainty?.corners[next];
        next += 1;
        return { at: yUp(at), sigma: known === undefined ? null : yUp(known.sigma_m) };
      }),
    );
  });
}

const PLACE_WORDS: Readonly<Record<Taken["on"], string>> = {
  corner: "corner",
  edge: "edge",
  face: "surface",
  ground: "lowest level of the model",
};

function Reading() {
  if (measured.value === null) {
    return (
      <p class="reading" role="status">
        Click a point for its coordinates, two for their distance, more for an area; corners and edges draw
        the point to them. By keyboard: Tab to the crosshair. Escape ends it.
      </p>
    );
  }
  const { found, last } = measured.value;
  const origin = scene.value?.origin ?? [0, 0, 0];
  const sigma = last.sigma === null ? null : zUp(last.sigma).map(Math.abs);
  const place = zUp(last.at).map((x, axis) => {
    const known = sigma === null ? "" : ` ± ${(sigma[axis] ?? 0).toFixed(2)}`;
    return `${(x + (origin[axis] ?? 0)).toFixed(2)}${known} m`;
  });
  const rows = [
    ["Taken at", PLACE_WORDS[last.on]],
    ...["East", "North", "Height"].map((name, axis) => [name, place[axis] ?? ""] as const),
    ...(found.distanceM === null
      ? []
      : ([
          ["Distance", `${found.distanceM.toFixed(2)} m`],
          ["In plan", `${(found.planM ?? 0).toFixed(2)} m`],
          ["Difference in height", `${(found.heightM ?? 0).toFixed(2)} m`],
          ["Slope", `${degreesOf(found.slope ?? 0).toFixed(1)}°`],
        ] as const)),
    ...(found.areaM2 === null ? [] : [["Area", `${found.areaM2.toFixed(2)} m²`] as const]),
  ];
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
