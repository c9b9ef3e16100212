/** The stages of the method in their order: which is shown, how far each is, what it found; and running them. */

import "./stages.css";
import { useRef } from "preact/hooks";
import { METHODS } from "../../../shared/stages";
import { METHOD_WORDS, stageWords, tabsOf, tabTitle } from "../../../stages/catalogue";
import { STAGE_FACTS, type Tab } from "../../../stages/list";
import { counted } from "../../parts/counted";
import { Menu } from "../../parts/Menu";
import { KeepResult } from "../../results/comparison/Comparison";
import { onPage } from "../../session/failureNotice";
import { cancel } from "../../session/session";
import { canRun, runAll, runTo, setMethod } from "../../session/stageRuns";
import { phase } from "../../state/activity";
import { method } from "../../state/parameters";
import { type StageState, type StageStatus, stages } from "../../state/stages";
import { openTab, tab } from "../../state/viewState";
import { chooseWorkers, chosenWorkers, usefulWorkers } from "../../state/workers";

const STATUS_WORDS: Record<StageStatus, string> = {
  waiting: "not run",
  running: "running",
  done: "done",
  outdated: "outdated",
  failed: "failed",
};

export function StageRail({ hidden }: { hidden: boolean }) {
  return (
    <section class="rail" aria-label="Stages" hidden={hidden}>
      <MethodMenu />
      <div class="rail-run">
        <RunButton />
        <span class="muted numbers">{totalTime(stages.value)}</span>
      </div>
      <Stages />
      <div class="rail-foot">
        <WorkerChoice />
        <KeepResult />
      </div>
    </section>
  );
}

function RunButton() {
  // The second click of a double click on "Run all" is meant for that.
  return phase.value === "run" ? (
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
  );
}

function MethodMenu() {
  const { title } = METHOD_WORDS[method.value];
  return (
    <Menu title={title} label={`Method: ${title}`} class="methods">
      {METHODS.map((name) => (
        <button
          key={name}
          type="button"
          aria-label={METHOD_WORDS[name].title}
          aria-pressed={method.value === name}
          onClick={() => void setMethod(name)}
        >
          <b>{METHOD_WORDS[name].title}</b>
          <span class="muted">{METHOD_WORDS[name].what}</span>
        </button>
      ))}
    </Menu>
  );
}

/** A row a stage, and before them the photographs; a stage without a view of its own is told of between the others. */
function Stages() {
  const list = useRef<HTMLDivElement>(null);
  const names = tabsOf(method.value);
  const rows: { tab: Tab | null; stage: StageState | null }[] = [
    { tab: "images", stage: null },
    ...stages.value.map((stage) => ({ tab: names.find((name) => name === stage.name) ?? null, stage })),
  ];
  const onKeyDown = (event: KeyboardEvent) => {
    const step = STEPS[event.key];
    if (step !== undefined) {
      event.preventDefault();
      const next = names[(names.indexOf(tab.value) + step + names.length) % names.length] ?? tab.value;
      openTab(next);
      list.current?.querySelector<HTMLElement>(`#tab-${next}`)?.focus();
    }
  };
  return (
    <div class="rail-stages">
      <div
        class="tabs"
        role="tablist"
        aria-label="Stage views"
        aria-orientation="vertical"
        tabIndex={-1}
        ref={list}
        onKeyDown={onKeyDown}
      >
        {rows.map((row, i) => (
          <StageRow key={row.stage?.name ?? "images"} {...row} line={i + 1} />
        ))}
      </div>
      <fieldset class="run-to">
        <legend class="visually-hidden">Run up to a stage</legend>
        {stages.value.map(({ name }, i) => (
          <RunTo key={name} position={i} />
        ))}
      </fieldset>
    </div>
  );
}

const STEPS: Readonly<Record<string, number>> = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };

function StageRow(of: { tab: Tab | null; stage: StageState | null; line: number }) {
  const { stage } = of;
  const place = { gridRow: of.line };
  const inside = (
    <>
      <b>{of.tab === null ? stage && stageWords(stage.name).title : tabTitle(of.tab)}</b>
      {stage !== null && <Found stage={stage} />}
    </>
  );
  const shared = {
    style: place,
    title:
      stage === null
        ? undefined
        : [countsText(stage), ...stage.warnings.map(onPage)].filter(Boolean).join("\n"),
    "data-stage": stage?.name,
    "data-status": stage?.status,
  };
  if (of.tab === null) {
    return (
      <div class="stage" {...shared}>
        {inside}
      </div>
    );
  }
  const name = of.tab;
  return (
    <button
      {...shared}
      class="stage"
      id={`tab-${name}`}
      type="button"
      role="tab"
      aria-selected={tab.value === name}
      aria-controls="stage-view"
      tabIndex={tab.value === name ? 0 : -1}
      onClick={() => openTab(name)}
    >
      {inside}
    </button>
  );
}

/** How far a stage is, or what it found and how long that took. */
function Found({ stage }: { stage: StageState }) {
  const { status, fraction, seconds, warnings } = stage;
  if (status === "running") {
    const percent = Math.round(100 * fraction);
    return (
      <span class="muted numbers">
        <span class="time">{percent} %</span>
        <progress max={1} value={fraction} aria-label={`${stageWords(stage.name).title}: ${percent} %`} />
      </span>
    );
  }
  return (
    <span class="muted numbers">
      <span class="time">{status === "done" && seconds !== null ? secondsText(seconds) : ""}</span>
      <span class="counts">
        {foundText(stage)}
        {warnings.length > 0 && <span class="stage-warning"> · {counted(warnings.length, "warnings")}</span>}
      </span>
    </span>
  );
}

/** What it found, unless it has not: or that this no longer holds. */
function foundText(stage: StageState): string {
  const found = mainCount(stage);
  const state = stage.status === "done" && found !== "" ? "" : STATUS_WORDS[stage.status];
  return [found, state].filter((text) => text !== "").join(" · ");
}

function RunTo({ position }: { position: number }) {
  const stage = stages.value[position];
  const name = stage && `Run up to ${stageWords(stage.name).title}`;
  return (
    <button
      type="button"
      class="quiet"
      style={{ gridRow: position + 2 }}
      aria-label={name}
      title={name}
      disabled={!canRun(position + 1)}
      onClick={() => stage && void runTo(stage.name)}
    >
      ▸
    </button>
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
        onChange={(event) => chooseWorkers(Number(event.currentTarget.value))}
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

/** What takes no time that anybody waits for is not "0.0 s". */
function secondsText(seconds: number): string {
  return seconds < 0.05 ? "< 0.1 s" : `${seconds.toFixed(1)} s`;
}

function countsText({ counts, seconds }: StageState): string {
  const texts = Object.entries(counts).map(([name, count]) => counted(count, name.replaceAll("_", " ")));
  if (seconds !== null) {
    texts.push(secondsText(seconds));
  }
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
