/** What came of it: how exact, what the frame rests on, which photographs are missing and why; and how to go on. */
import type { OrientationReport } from "../../../shared/orientation";
import { grouped } from "../../parts/numberText";
import { askedBy, onPage } from "../../session/failureNotice";
import { isBusy } from "../../state/activity";
import { baseName } from "../inputFiles";
import { KnownLength } from "./KnownLength";
import { block, computeOrientation, saveOrientation, saveOrientationFiles } from "./orientation";
import { ControlPoints } from "./plans/ControlPoints";
import { CoveragePlan } from "./plans/CoveragePlan";
import { OverlapPlan } from "./plans/OverlapPlan";
import { ResidualPlan } from "./plans/ResidualPlan";

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
  const centres = block.value?.views.map(({ center }) => center) ?? [];
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
        <b>Frame:</b> {onPage(report.frame)}.
      </p>
      {report.worth.map((words) => (
        <p key={words}>{sentence(words)}</p>
      ))}
      {report.warnings.map((warning) => (
        <p key={warning} class="doubt">
          {sentence(warning)}
        </p>
      ))}
      {[report.frame, ...report.warnings].some((words) => askedBy(words).options.includes("apply-fix")) && (
        <button type="button" disabled={isBusy.value} onClick={() => void computeOrientation(true)}>
          Apply the fix
        </button>
      )}
      {report.left_out.length > 0 && (
        <>
          <h3>Not oriented</h3>
          <ul class="left-out">
            {report.left_out.map(({ file, problem }) => (
              <li key={file}>
                <b>{baseName(file)}</b>: {onPage(problem)}
              </li>
            ))}
          </ul>
        </>
      )}
      <ControlPoints control={report.control} />
      <ResidualPlan report={report} centres={centres} />
      <KnownLength report={report} />
      {report.coverage_words.map((words) => (
        <p key={words}>{sentence(words)}</p>
      ))}
      <CoveragePlan report={report} centres={centres} />
      <OverlapPlan report={report} centres={centres} />
      <Photographs report={report} />
      <h3>Files of the orientation (COLMAP)</h3>
      <p>
        <button type="button" onClick={() => void saveOrientationFiles()}>
          Save all in one .zip
        </button>
      </p>
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

/** What the core says, as a sentence of the page. */
function sentence(words: string): string {
  return `${onPage(words.charAt(0).toUpperCase() + words.slice(1)).replaceAll("+-", "±")}.`;
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

function Photographs({ report }: { report: OrientationReport }) {
  const unit = report.is_metric ? "m" : "units";
  const isStated = report.photos.some(({ residual_m }) => residual_m !== null);
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
              {isStated && <th scope="col">From the stated position [{unit}]</th>}
            </tr>
          </thead>
          <tbody class="numbers">
            {report.photos.map((one) => (
              <tr key={one.file}>
                <th scope="row">{baseName(one.file)}</th>
                <td>{one.rays}</td>
                <td>{one.partners}</td>
                <td>{one.rms_px.toFixed(2)}</td>
                <td>{one.sigma_m?.map((sigma) => sigma.toFixed(3)).join(", ") ?? "–"}</td>
                <td>{one.sigma_deg?.toFixed(3) ?? "–"}</td>
                {isStated && <td>{one.residual_m?.map((off) => off.toFixed(2)).join(", ") ?? "–"}</td>}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </details>
  );
}
