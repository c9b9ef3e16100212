/** The orientation check: how well the images agree, what else was tried, and the remedy. */

import "./project.css";
import type { Agreement, AgreementReport } from "../../shared/records";
import { grouped } from "../parts/numberText";
import { runOptions } from "../state/project";
import { Remedies } from "./Remedies";

/** Trials beyond these explain nothing. */
const MOST_TRIALS = 10;

export function OrientationCheck({ report }: { report: AgreementReport }) {
  const { stated, cured, offsets_px: offsets, mistake, trials } = report;
  return (
    <div class="orientation-check" data-testid="orientation-check" data-finding={report.finding}>
      <dl class="facts">
        <Score name="Agreement as stated" agreement={stated} />
        {cured !== null && <Score name="Without the mistake" agreement={cured} />}
        {offsets?.map((offset, i) => (
          <div key={i === 0 ? "before" : "after"}>
            <dt>{i === 0 ? "Mean offset as stated" : "Without the mistake"}</dt>
            <dd class="numbers">{offset.toFixed(2)} px</dd>
          </div>
        ))}
      </dl>
      <Remedies asked={{ options: remediesOf(report), files: [] }} />
      {trials.length > 0 && (
        <details class="trials" open={mistake === null}>
          <summary>What was tried</summary>
          <table>
            <thead>
              <tr>
                <th scope="col">If</th>
                <th scope="col">Agreement</th>
                <th scope="col">Points</th>
              </tr>
            </thead>
            <tbody>
              {trials.slice(0, MOST_TRIALS).map(({ words, agreement, all_pairs }) => (
                <tr key={words}>
                  <td>{words}</td>
                  <td class="numbers">{agreement.score.toFixed(2)}</td>
                  <td class="numbers">
                    {grouped(agreement.points)}
                    {!all_pairs && " (few views)"}
                  </td>
                </tr>
              ))}
            </tbody>
          </table>
        </details>
      )}
    </div>
  );
}

function remediesOf(report: AgreementReport): string[] {
  const goesOn = isRefused(report) && !runOptions.value.ignoreCheck;
  return [...(report.mistake === null ? [] : ["apply-fix"]), ...(goesOn ? ["ignore-check"] : [])];
}

/** What loading refuses unless it is told to go on. */
function isRefused({ finding, stated }: AgreementReport): boolean {
  return finding === "explained" || (finding === "unexplained" && stated.score === 0);
}

/** 0 is what chance gives, 1 is perfect. */
function Score({ name, agreement: { score } }: { name: string; agreement: Agreement }) {
  return (
    <div>
      <dt>{name}</dt>
      <dd class="numbers">
        <meter min={0} max={1} value={score} aria-label={name} /> {score.toFixed(2)}
      </dd>
    </div>
  );
}
