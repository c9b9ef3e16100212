/** What came of it: how exact, what the frame rests on, which photographs are missing and why; and how to go on. */
import { useSignal } from "@preact/signals";
import type { OrientationReport } from "../../shared/orientation";
import { grouped } from "../parts/numberText";
import { TextField } from "../parts/TextField";
import { OverlapPlan } from "./OverlapPlan";
import { block, saveOrientation, setScale } from "./orientation";

const FILES: readonly (readonly [string, string])[] = [
  ["cameras.txt", "focal length, distortion"],
  ["images.txt", "position and rotation of each photograph"],
  ["points3D.txt", "points and their rays"],
  ["orientation.json", "report for programs"],
  ["orientation.log", "report as text"],
];

export function OrientationResult({ report }: { report: OrientationReport }) {
  const all = report.photos.length + report.left_out.length;
  const [camera] = report.cameras;
  return (
    <section class="result" data-testid="orientation-report" aria-label="Report of the orientation">
      <dl class="orientation-facts numbers">
        <Fact name="Photographs">
          {report.photos.length} of {all}
        </Fact>
        <Fact name="Reprojection error (rms)">{report.rms_px.toFixed(2)} px</Fact>
        <Fact name="Points">{grouped(report.points)}</Fact>
        <Fact name="Rays of a point">{report.rays_a_point.toFixed(1)}</Fact>
        {camera !== undefined && <Fact name="Focal length">{focalText(camera)}</Fact>}
      </dl>
      <p>
        <b>Frame:</b> {report.frame}.
      </p>
      {report.warnings.map((warning) => (
        <p key={warning} class="doubt">
          {warning.charAt(0).toUpperCase() + warning.slice(1)}.
        </p>
      ))}
      {report.left_out.length > 0 && (
        <>
          <h3>Not oriented</h3>
          <ul class="left-out">
            {report.left_out.map(({ file, problem }) => (
              <li key={file}>
                <b>{nameOf(file)}</b>: {problem}
              </li>
            ))}
          </ul>
        </>
      )}
      <Scale report={report} />
      <OverlapPlan report={report} />
      <Photographs report={report} />
      <h3>Files of the orientation (COLMAP)</h3>
      <ul class="downloads">
        {FILES.map(([name, what]) => (
          <li key={name}>
            <button type="button" class="link" onClick={() => void saveOrientation(name)}>
              {name}
            </button>
            <span class="muted">{what}</span>
          </li>
        ))}
      </ul>
    </section>
  );
}

function Fact({ name, children }: { name: string; children: preact.ComponentChildren }) {
  return (
    <div>
      <dt class="muted">{name}</dt>
      <dd>{children}</dd>
    </div>
  );
}

function focalText({ parameters: [focal], sigmas, is_stated }: OrientationReport["cameras"][number]): string {
  const deviation = sigmas === null ? "" : ` ± ${sigmas[0].toFixed(1)}`;
  return `${focal.toFixed(1)}${deviation} px, ${is_stated ? "stated before" : "guessed before"}`;
}

function nameOf(path: string): string {
  return path.slice(path.lastIndexOf("/") + 1);
}

/** What a known length is of: the cameras above the ground, or two cameras apart. */
const HEIGHT = "height";

/** A length that a person knows sets the scale. */
function Scale({ report }: { report: OrientationReport }) {
  const what = useSignal(HEIGHT);
  const isInvalid = useSignal(false);
  const isKnown = report.is_metric && !report.frame.includes("scale from");
  if (isKnown) {
    return null;
  }
  const measured = what.value === HEIGHT ? heightNow() : distanceNow(what.value);
  const take = (text: string) => {
    const metres = Number(text.replace(",", "."));
    isInvalid.value = !(Number.isFinite(metres) && metres > 0);
    if (!isInvalid.value) {
      void setScale(measured, metres, wordsOf(what.value));
    }
    return !isInvalid.value;
  };
  return (
    <fieldset class="known-length">
      <legend>A length that you know sets the scale</legend>
      <label>
        <span class="visually-hidden">What is known</span>
        <select value={what.value} onChange={(event) => (what.value = event.currentTarget.value)}>
          <option value={HEIGHT}>Mean height of the cameras above the points</option>
          {neighbours(report).map(([a, b]) => (
            <option key={`${a} ${b}`} value={`${a} ${b}`}>
              From camera {nameOf(report.photos[a]?.file ?? "")} to camera{" "}
              {nameOf(report.photos[b]?.file ?? "")}
            </option>
          ))}
        </select>
      </label>
      <label for="known-length">metres</label>
      <TextField
        id="known-length"
        value={measured.toFixed(2)}
        inputMode="decimal"
        isInvalid={isInvalid.value}
        onTake={take}
      />
      <span id="known-length-note" class="muted">
        {isInvalid.value ? "A number above 0." : "Enter takes it."}
      </span>
    </fieldset>
  );
}

/** Pairs of photographs one after the other: what lies between two of them is known soonest. */
function neighbours({ photos }: OrientationReport): [number, number][] {
  return photos.slice(1).map((_, i): [number, number] => [i, i + 1]);
}

function wordsOf(what: string): string {
  return what === HEIGHT ? "the height of the cameras above the points" : "the distance of two cameras";
}

function heightNow(): number {
  const { views = [], points = new Float32Array() } = block.value ?? {};
  const mean = (values: readonly number[]) => values.reduce((sum, value) => sum + value, 0) / values.length;
  const heights = Array.from({ length: points.length / 3 }, (_, i) => points[3 * i + 2] as number);
  return mean(views.map(({ center }) => center[2])) - mean(heights);
}

function distanceNow(what: string): number {
  const [a, b] = what.split(" ").map((place) => block.value?.views[Number(place)]?.center);
  return a === undefined || b === undefined ? 0 : Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

function Photographs({ report }: { report: OrientationReport }) {
  const unit = report.is_metric ? "m" : "units";
  return (
    <details>
      <summary>Photographs one by one</summary>
      <div class="facts-table">
        <table>
          <thead>
            <tr>
              <th scope="col">Photograph</th>
              <th scope="col">Rays</th>
              <th scope="col">Overlaps with</th>
              <th scope="col">rms [px]</th>
              <th scope="col">σ of x, y, z [{unit}]</th>
              <th scope="col">σ of the rotation [°]</th>
            </tr>
          </thead>
          <tbody class="numbers">
            {report.photos.map((one) => (
              <tr key={one.file}>
                <th scope="row">{nameOf(one.file)}</th>
                <td>{one.rays}</td>
                <td>{one.partners}</td>
                <td>{one.rms_px.toFixed(2)}</td>
                <td>{one.sigma_m?.map((sigma) => sigma.toFixed(3)).join(", ") ?? "–"}</td>
                <td>{one.sigma_deg?.toFixed(3) ?? "–"}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </details>
  );
}
