/** The stages in order: run, cancel, progress, time and counts. */

import "./stages.css";
import { shownTabOf, stageWords } from "../../../stages/catalogue";
import { STAGE_FACTS } from "../../../stages/list";
import { counted } from "../../parts/counted";
import { KeepResult } from "../../results/comparison/Comparison";
import { cancel } from "../../session/session";
import { runAll, runTo } from "../../session/stageRuns";
import { isBusy, phase } from "../../state/activity";
import { method } from "../../state/parameters";
import { files, hasPhotographsOnly } from "../../state/project";
import { freshStages, type StageState, type StageStatus, stages } from "../../state/stages";

import { showTab, tab } from "../../state/viewState";
import { chooseWorkers, chosenWorkers, usefulWorkers } from "../../state/workers";

const STATUS_WORDS: Record<StageStatus, string> = {
  waiting: "not run",
  running: "running",
  done: "done",
  outdated: "outdated",
  failed: "failed",
};

export function StageRail() {
  const isRunning = phase.value === "run";
  return (
    <section class="rail" aria-label="Stages">
      <div class="rail-run">
        {isRunning ? (
          // The second click of a double click on "Run all" is meant for that.
          <button type="button" onClick={({ detail }) => void (detail < 2 && cancel())}>
            Cancel
          </button>
        ) : (
          <button
            type="button"
            class="primary"
            disabled={!canRun(stages.value.length)}
            onClick={() => void runAll()}
          >
            Run all
          </button>
        )}
        <span class="muted numbers">{totalTime(stages.value)}</span>
        <WorkerChoice />
        <KeepResult />
      </div>
      <ol>
        {stages.value.map((stage, position) => (
          <StageCard key={stage.name} stage={stage} position={position} />
        ))}
      </ol>
    </section>
  );
}

/** How many workers share a stage: the result is the same. */
function WorkerChoice() {
  const most = Math.max(navigator.hardwareConcurrency ?? 1, 3);
  return (
    <label class="workers" title="How many workers share a stage. The result does not depend on it.">
      Workers
      <select
        value={String(chosenWorkers.value)}
        onChange={(event) => {
          chooseWorkers(Number(event.currentTarget.value));
        }}
      >
        <option value="0">auto ({usefulWorkers.value})</option>
        {Array.from({ length: most }, (_, i) => (
          <option key={i + 1} value={String(i + 1)}>
            {i + 1}
          </option>
        ))}
      </select>
    </label>
  );
}

/** Whether there is something to run among the first `count` stages, and nothing else going on. */
function canRun(count: number): boolean {
  return files.value.length > 0 && !hasPhotographsOnly.value && !isBusy.value && freshStages.value < count;
}

function StageCard({ stage, position }: { stage: StageState; position: number }) {
  const words = stageWords(stage.name);
  const percent = Math.round(100 * stage.fraction);
  return (
    <li class={`stage ${stage.status}`} data-stage={stage.name} data-status={stage.status}>
      <button
        type="button"
        class="link"
        title={words.section}
        onClick={() => {
          showTab(shownTabOf(stage.name, method.value) ?? tab.value);
        }}
      >
        {words.title}
      </button>
      {stage.status === "running" ? (
        <progress max={1} value={stage.fraction} aria-label={`${words.title}: ${percent} %`} />
      ) : (
        <span class="numbers counts" title={countsText(stage)}>
          {mainCount(stage) || STATUS_WORDS[stage.status]}
        </span>
      )}
      <span class="muted numbers">{statusLine(stage)}</span>
      <button
        type="button"
        class="quiet"
        aria-label={`Run up to ${words.title}`}
        title={`Run up to ${words.title}`}
        disabled={!canRun(position + 1)}
        onClick={() => void runTo(stage.name)}
      >
        ▸
      </button>
      {stage.warnings.length > 0 && (
        <span class="stage-warning" title={stage.warnings.join("\n")}>
          {counted(stage.warnings.length, "warnings")}
        </span>
      )}
    </li>
  );
}

function statusLine(stage: StageState): string {
  if (stage.status === "running") {
    return `${Math.round(100 * stage.fraction)} %`;
  }
  const time = stage.seconds === null ? "" : secondsText(stage.seconds);
  return stage.status === "outdated" || stage.status === "failed" ? STATUS_WORDS[stage.status] : time;
}

/** What takes no time that anybody waits for is not "0.0 s". */
function secondsText(seconds: number): string {
  return seconds < 0.05 ? "< 0.1 s" : `${seconds.toFixed(1)} s`;
}

function countsText({ counts, seconds }: StageState): string {
  const texts = Object.entries(counts).map(([name, count]) => counted(count, name.replaceAll("_", " ")));
  if (counts["correlations"] !== undefined && seconds) {
    texts.push(`${(counts["correlations"] / seconds / 1e6).toFixed(1)} million correlations per second`);
  }
  return texts.join(", ");
}

/** What the stage is for, counted; the rest stands in the tooltip. */
function mainCount({ name, counts }: StageState): string {
  const entries = Object.entries(counts);
  const [what, count] = entries.find(([one]) => one === STAGE_FACTS[name].mainCount) ?? entries[0] ?? [];
  return what === undefined || count === undefined ? "" : counted(count, what.replaceAll("_", " "));
}

function totalTime(all: readonly StageState[]): string {
  const seconds = all.reduce((sum, stage) => sum + (stage.seconds ?? 0), 0);
  return seconds > 0 ? `${seconds.toFixed(1)} s in all` : "";
}
