/** The tools of the 3D view: fit, look down, look through a view's camera, measure, cut, keep a picture. */
import { signal } from "@preact/signals";
import type { Measured } from "../../viewer/tools/measure";
import type { Section } from "../../viewer/tools/section";
import type { Viewer } from "../../viewer/viewer";
import { saveFile } from "../parts/saveFile";
import { tab } from "../state/viewState";
import { FlyTo, lookThrough, Photograph, throughView } from "./Photograph";
import { SectionChart } from "./SectionChart";

/** What clicks in the space view do besides picking. */
type Tool = "measure" | "section";

const tool = signal<Tool | null>(null);
const measured = signal<Measured | null>(null);
const section = signal<Section | null>(null);

export function SpaceTools({ viewer, onFit }: { viewer: Viewer | null; onFit: () => void }) {
  const leave = () => lookThrough(viewer, null);
  const choose = (next: Tool) => {
    const isOn = tool.value === next;
    measured.value = null;
    section.value = null;
    tool.value = isOn ? null : next;
    viewer?.measure(isOn || next !== "measure" ? null : (found) => (measured.value = found));
    viewer?.section(isOn || next !== "section" ? null : (found) => (section.value = found));
  };
  const keepPicture = async () => {
    const blob = await viewer?.screenshot();
    if (blob != null) {
      saveFile(`${tab.value}.png`, blob);
    }
  };
  return (
    <>
      {throughView.value !== null && <Photograph view={throughView.value} />}
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
        <button type="button" aria-pressed={tool.value === "measure"} onClick={() => choose("measure")}>
          Measure
        </button>
        <button type="button" aria-pressed={tool.value === "section"} onClick={() => choose("section")}>
          Section
        </button>
        <button type="button" onClick={() => void keepPicture()}>
          Picture
        </button>
        <FlyTo viewer={viewer} />
      </div>
      {tool.value === "measure" && <Reading measured={measured.value} />}
      {tool.value === "section" && <Profile viewer={viewer} />}
    </>
  );
}

/** The profile once there are two points, and which side of the cut is taken away. */
function Profile({ viewer }: { viewer: Viewer | null }) {
  if (section.value === null) {
    return (
      <p class="reading" role="status">
        Click the two ends of the cut.
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

function Reading({ measured: found }: { measured: Measured | null }) {
  if (found === null || found.distanceM === null || found.slope === null) {
    return (
      <p class="reading" role="status">
        {found === null || found.points === 0 ? "Click two points, or more for an area." : "One more point."}
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
