/** Photographs without orientation: what is missing, which programs write it, and what the photographs say themselves. */
import { counted } from "../../parts/counted";
import { baseName } from "../inputFiles";
import "./photographsOnly.css";
import { signal } from "@preact/signals";
import { type ComponentChildren, type ComponentType, Fragment } from "preact";
import { isBusy } from "../../state/activity";
import { notify } from "../../state/notices";
import { files, inspection } from "../../state/project";
import { type Photograph, planOf, scaleBarM } from "./photographPlan";

/** What computes and shows the orientation, once it was fetched: most projects come with theirs. */
const panel = signal<ComponentType | null>(null);

async function compute(): Promise<void> {
  try {
    const [{ OrientationPanel }, { computeOrientation }] = await Promise.all([
      import("../orienting/OrientationPanel"),
      import("../orienting/orientation"),
    ]);
    panel.value = OrientationPanel;
    await computeOrientation();
  } catch {
    notify({
      severity: "warning",
      title: "This part of the page could not be fetched",
      text: "The orientation is computed by a part of the page that is fetched when it is first needed.",
      advice: "Connect to the network once, and try again.",
    });
  }
}

/** Begins anew with other photographs. */
const begun = signal<readonly unknown[] | null>(null);

export function PhotographsOnly() {
  const photographs = inspection.value?.images ?? [];
  const count = photographs.length;
  const Panel = panel.value;
  return (
    <section
      class="photographs-only"
      data-testid="photographs-only"
      aria-label="Photographs without orientation"
      // biome-ignore lint/a11y/noNoninteractiveTabindex: it scrolls by key.
      tabIndex={0}
    >
      {Panel !== null && begun.value === files.value ? (
        <Panel />
      ) : (
        <>
          <h2>{counted(count, "photographs")}, and no orientation yet</h2>
          <p>
            A model needs to know, for each photograph, where the camera stood, where it looked, and its focal
            length. That follows from what overlapping photographs show in common.
          </p>
          <p class="row">
            <button
              type="button"
              class="primary"
              disabled={isBusy.value || count < FEWEST}
              onClick={() => {
                begun.value = files.value;
                void compute();
              }}
            >
              Compute the orientation
            </button>
            <span class="muted">
              {count < FEWEST
                ? "Three photographs that overlap are needed."
                : "In this browser: seconds for a few photographs, minutes for many."}
            </span>
          </p>
          <p>Or add the file that a program for photogrammetry has written:</p>
          <Recipes />
        </>
      )}
      <WhatIsKnown all={photographs} />
    </section>
  );
}

/** Fewest photographs of a block. */
const FEWEST = 3;

function Recipes() {
  return (
    <div class="recipes">
      <Recipe title="OpenDroneMap (free)" writes="shots.geojson and cameras.json, or reconstruction.json">
        <li>In WebODM, make a task of the photographs and start it.</li>
        <li>
          <b>Download assets › Camera shots</b> and <b>Camera parameters</b>. On the command line: the folder{" "}
          <code>odm_report</code> has <code>shots.geojson</code>, beside it lies <code>cameras.json</code>.
        </li>
        <li>Drop both files here.</li>
      </Recipe>
      <Recipe title="COLMAP (free)" writes="cameras.bin and images.bin">
        <li>
          <Command of="colmap automatic_reconstructor --workspace_path w --image_path photographs" />
        </li>
        <li>
          In metres, with Z up: <Command of={ALIGNER} />
        </li>
        <li>
          Drop <code>cameras.bin</code> and <code>images.bin</code> of <code>w/sparse/0</code>, or the same as
          text.
        </li>
      </Recipe>
      <Recipe title="Agisoft Metashape" writes="cameras.xml">
        <li>
          <b>Workflow › Align Photos</b>.
        </li>
        <li>
          <b>File › Export › Export Cameras…</b>, type <i>Agisoft XML</i>.
        </li>
        <li>Drop the file here.</li>
      </Recipe>
    </div>
  );
}

const ALIGNER = [
  "colmap model_aligner --input_path w/sparse/0 --output_path w/sparse/0",
  "--database_path w/database.db --ref_is_gps 1 --alignment_type enu --alignment_max_error 3",
].join(" ");

/** Words stay whole where the line breaks: "--" alone would be no option. */
function Command({ of }: { of: string }) {
  return (
    <code>
      {of.split(" ").map((word, i) => (
        <Fragment key={i}>
          <span>{word}</span>{" "}
        </Fragment>
      ))}
    </code>
  );
}

function Recipe(props: { title: string; writes: string; children: ComponentChildren }) {
  return (
    <section>
      <h3>{props.title}</h3>
      <p class="muted">writes {props.writes}</p>
      <ol>{props.children}</ol>
    </section>
  );
}

function WhatIsKnown({ all }: { all: readonly Photograph[] }) {
  const placed = all.filter(({ stated }) => stated.position !== null).length;
  if (all.length === 0) {
    return null;
  }
  return (
    <section class="known">
      <h3>What the photographs say themselves (EXIF)</h3>
      <p class="muted">
        {placed === 0
          ? "None of them says where it was taken: such programs then need points on the ground, or a scale."
          : `${placed} of ${all.length} say where they were taken, to a few metres: enough to begin with, too coarse for a model.`}
      </p>
      <div class="known-parts">
        {placed > 0 && <Plan all={all} />}
        <div class="facts-table">
          <table>
            <thead>
              <tr>
                <th scope="col">Photograph</th>
                <th scope="col">Camera</th>
                <th scope="col">Focal length</th>
                <th scope="col">Taken</th>
                <th scope="col">Position</th>
              </tr>
            </thead>
            <tbody>
              {all.map(({ path, stated: { camera, focal_mm, taken, position, height_m } }) => (
                <tr key={path}>
                  <th scope="row">{baseName(path)}</th>
                  <td>{camera === "" ? "–" : camera}</td>
                  <td>{focal_mm === null ? "–" : `${Number(focal_mm.toFixed(2))} mm`}</td>
                  <td>{taken?.slice(0, "YYYY-MM-DD HH:MM".length) ?? "–"}</td>
                  <td>{positionText(position, height_m)}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      </div>
    </section>
  );
}

function positionText(position: Photograph["stated"]["position"], heightM: number | null): string {
  if (position === null) {
    return "–";
  }
  const [longitude, latitude] = position;
  const place = `${latitude.toFixed(5)}°, ${longitude.toFixed(5)}°`;
  return heightM === null ? place : `${place}, ${heightM.toFixed(0)} m`;
}

/** Side of the plan, and its margin, in units of the drawing. */
const SIDE = 260;
const MARGIN = 30;

/** Where the photographs were taken, seen from above, north up; joined in the order of their times. */
function Plan({ all }: { all: readonly Photograph[] }) {
  const points = planOf(all);
  const range = (values: readonly number[]) => [Math.min(...values), Math.max(...values)] as const;
  const [west, east] = range(points.map((point) => point.east));
  const [south, north] = range(points.map((point) => point.north));
  const extent = Math.max(east - west, north - south, 1);
  const scale = (SIDE - 2 * MARGIN) / extent;
  const x = (metres: number) => SIDE / 2 + (metres - (west + east) / 2) * scale;
  const y = (metres: number) => SIDE / 2 - (metres - (south + north) / 2) * scale;
  const bar = scaleBarM(extent);
  const way = points.map((point) => `${x(point.east).toFixed(1)},${y(point.north).toFixed(1)}`).join(" ");
  return (
    <svg
      class="flight-plan"
      viewBox={`0 0 ${SIDE} ${SIDE}`}
      role="img"
      aria-label={`Plan of ${points.length} positions, north up, ${extent.toFixed(0)} m across`}
    >
      <polyline class="way" points={way} />
      {points.map((point) => (
        <circle key={point.path} cx={x(point.east)} cy={y(point.north)} r={4}>
          <title>{point.path}</title>
        </circle>
      ))}
      <path class="bar" d={`M10 ${SIDE - 10}h${(bar * scale).toFixed(1)}`} />
      <text x={10} y={SIDE - 15}>
        {bar} m
      </text>
      <path class="bar" d={`M${SIDE - 14} 28v-20m-4 6l4-6l4 6`} />
      <text x={SIDE - 34} y={22}>
        N
      </text>
    </svg>
  );
}
