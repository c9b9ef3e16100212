/** The plan of a flight before anything long starts: photographs, overlap, tiles, and what the run will take. */
import "./flight.css";
import { useSignal } from "@preact/signals";
import type { FlightPlan } from "../../../shared/records";
import { Choice } from "../../parts/Choice";
import { counted } from "../../parts/counted";
import { minutesText, signed } from "../../parts/numberText";
import { parseNumber, TextField } from "../../parts/TextField";
import { onPage } from "../../session/failureNotice";
import { isOfMemory, plannedRegion } from "../../session/flightPlanning";
import { runAll } from "../../session/stageRuns";
import { parseTile } from "../../settings/loadOptions";
import { isBusy, phase } from "../../state/activity";
import { runOptions } from "../../state/project";
import { mainResults } from "../../state/results";
import { showTab } from "../../state/viewState";
import { setRunOptions } from "../projectActions";
import {
  cellsOf,
  doneTiles,
  flightPlan,
  megapixelsLeft,
  plannedReduction,
  type Region,
  usedTiles,
  viewsOf,
  workPlan,
} from "../tiles/flight";
import { secondsPerMegapixel } from "../tiles/pace";
import { PlanDrawing } from "./PlanDrawing";
import { COVERS } from "./planGeometry";

export function FlightPlanView() {
  const plan = flightPlan.value;
  const pictures = useSignal<"overlap" | "pictures">("overlap");
  const drawsByTouch = useSignal(false);
  if (plan === null) {
    return null;
  }
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: it scrolls by key.
    <section class="flight" aria-label="Plan of the flight" data-testid="flight-plan" tabIndex={0}>
      <div class="flight-head">
        <h2>{headingOf(plan)}</h2>
        <p class="muted">{advice()}</p>
      </div>
      <div class="flight-plan-side">
        <div class="toolbar">
          <Choice
            legend="What the plan shows"
            choices={[
              ["overlap", "Overlap"],
              ["pictures", "Photographs"],
            ]}
            chosen={pictures.value}
            choose={(next) => {
              pictures.value = next;
            }}
          />
          <button
            type="button"
            class="touch-only"
            aria-pressed={drawsByTouch.value}
            onClick={() => {
              drawsByTouch.value = !drawsByTouch.value;
            }}
          >
            Draw a region
          </button>
          {pictures.value === "overlap" && <CoverLegend />}
        </div>
        <PlanDrawing
          plan={plan}
          region={plannedRegion()}
          withPictures={pictures.value === "pictures"}
          drawsByTouch={drawsByTouch.value}
          isFixed={phase.value === "run"}
          onRegion={(roi) => {
            drawsByTouch.value = false;
            void setRunOptions({ roi });
          }}
        />
      </div>
      <div class="flight-facts">
        <RunRow plan={plan} />
        <Facts plan={plan} />
        <RegionFields />
        <SizeFields />
      </div>
    </section>
  );
}

function headingOf({ overview }: FlightPlan): string {
  return `A flight of ${counted(overview.footprints.length, "photographs")}`;
}

function advice(): string {
  if (phase.value === "run") {
    return "Tile after tile is read, reconstructed and kept; tab Model shows what is there.";
  }
  return doneTiles.value.size === 0
    ? "Nothing has been computed yet. Drag a rectangle on the plan to choose what is reconstructed, or take all of it."
    : "Another region, or another size of its tiles, begins anew.";
}

/** What the shades mean. */
function CoverLegend() {
  return (
    <ul class="cover-legend">
      <li>Photographs that show a place:</li>
      {COVERS.map(({ words, alpha }) => (
        <li key={words}>
          <span class="swatch" style={{ "--alpha": String(alpha) }} aria-hidden="true" />
          {words}
        </li>
      ))}
    </ul>
  );
}

function RunRow({ plan }: { plan: FlightPlan }) {
  const used = usedTiles.value;
  const left = used.filter((tile) => !doneTiles.value.has(tile));
  const isGoingOn = left.length < used.length;
  const isThere = left.length === 0 && mainResults.value.glb !== null;
  const name = isThere
    ? "Show the model"
    : isGoingOn
      ? `Go on: ${left.length} of ${counted(used.length, "tiles")}`
      : `Reconstruct ${counted(used.length, "tiles")}`;
  return (
    <>
      {plan.problem !== null && <p class="plan-problem">{onPage(plan.problem)}</p>}
      {phase.value !== "run" && (
        <p class="row">
          <button
            type="button"
            class="primary"
            disabled={isBusy.value || used.length === 0}
            onClick={() => (isThere ? showTab("model") : void runAll())}
          >
            {name}
          </button>
        </p>
      )}
      {isGoingOn && phase.value !== "run" && <p class="muted">{keptText(used.length - left.length)}</p>}
    </>
  );
}

function keptText(count: number): string {
  return `${counted(count, "tiles")} of this plan ${count === 1 ? "is" : "are"} kept in this browser.`;
}

/** What only a first look tells. */
const NOT_YET = "known after a first look, with which the run begins";

function Facts({ plan }: { plan: FlightPlan }) {
  const { overview } = plan;
  const used = usedTiles.value;
  const work = workPlan.value;
  const worked = used.filter((tile) => cellsOf(tile).length > 0);
  const isBegun = used.some((tile) => doneTiles.value.has(tile));
  const known = (text: () => string) => (work === null ? NOT_YET : worked.length > 0 ? text() : "–");
  const memory = () => Math.max(...worked.map((tile) => work?.tiles[tile]?.memory_mb ?? 0));
  const pixelCm = (100 * overview.pixel_m * plannedReduction.value) / overview.reduction;
  const facts: readonly (readonly [string, string])[] = [
    ["Region", regionText(plannedRegion())],
    ["Tiles", tilesText(plan, used.length)],
    ["Photographs a tile", known(() => rangeText(worked.map((tile) => viewsOf(tile).length)))],
    ["Memory at a time", known(() => `about ${memory()} MB at most`)],
    [
      "Time",
      known(() => `${minutesText(secondsPerMegapixel.value * megapixelsLeft())}${isBegun ? " more" : ""}`),
    ],
    ["Pixel on the ground", `${pixelCm.toFixed(pixelCm < 10 ? 1 : 0)} cm`],
    ["Ground", groundText(overview)],
  ];
  return (
    <dl class="facts" data-testid="flight-facts">
      {facts.map(([name, text]) => (
        <div key={name}>
          <dt>{name}</dt>
          <dd class="numbers">{text}</dd>
        </div>
      ))}
    </dl>
  );
}

function regionText(region: Region | null): string {
  if (region === null) {
    return "no place is shown by three photographs";
  }
  const [x0, y0, x1, y1] = region;
  const size = `${Math.round(x1 - x0)} × ${Math.round(y1 - y0)} m`;
  return runOptions.value.roi === null ? `${size}, all that three photographs show` : size;
}

function tilesText({ tiles, squares_left_out, why_left_out }: FlightPlan, used: number): string {
  const leftOut = [...tiles.keys()].filter((tile) => !usedTiles.value.includes(tile));
  const lacking = leftOut.filter((tile) => isOfMemory(cellsOf(tile)[0]?.left_out ?? "")).length;
  const unseen = leftOut.length - lacking;
  const parts = [String(used)];
  if (unseen > 0) {
    parts.push(`${unseen} more shown by too few photographs`);
  }
  if (lacking > 0) {
    parts.push(`${lacking} too large for the memory: choose a smaller share of the photographs' size`);
  }
  if (squares_left_out > 0) {
    parts.push(`${counted(squares_left_out, "squares")} left out: ${why_left_out}`);
  }
  return parts.join("; ");
}

function rangeText(counts: readonly number[]): string {
  const [least, most] = [Math.min(...counts), Math.max(...counts)];
  if (counts.length === 0) {
    return "–";
  }
  return least === most ? String(least) : `${least} to ${most}`;
}

function groundText({ heights: [low, high], ground, ground_z }: FlightPlan["overview"]): string {
  const words: Record<typeof ground, string> = {
    stated: `${signed(ground_z, 1)} m, as stated`,
    measured: `${signed(low, 0)} to ${signed(high, 0)} m with roofs and trees, as four photographs show it`,
    assumed: `${signed(ground_z, 0)} m, assumed from the distances of the photographs`,
  };
  return words[ground];
}

const SIDES = ["West", "South", "East", "North"] as const;

/** The region by its sides: what dragging does, by keys. */
function RegionFields() {
  const region = plannedRegion();
  const parse = (side: number) => (text: string) => {
    const parsed = parseNumber(text);
    const roi: [number, number, number, number] = [...(region ?? [0, 0, 0, 0])];
    roi[side] = "value" in parsed ? parsed.value : Number.NaN;
    const isRight = region !== null && roi[0] < roi[2] && roi[1] < roi[3];
    return isRight ? { value: roi } : { error: "West is less than east, south less than north" };
  };
  return (
    <fieldset class="region-fields">
      <legend>Region, m</legend>
      {SIDES.map((name, side) => (
        <div key={name}>
          <label for={`region-${side}`}>{name}</label>
          <TextField
            id={`region-${side}`}
            inputMode="decimal"
            value={String(region?.[side] ?? "")}
            parse={parse(side)}
            onValue={(roi) => void setRunOptions({ roi })}
          />
        </div>
      ))}
      {runOptions.value.roi !== null && (
        <p class="row">
          <button type="button" onClick={() => void setRunOptions({ roi: null })}>
            Whole area
          </button>
          <button
            type="button"
            title="Loads the photographs of this region, to run and look at every stage. A region takes twelve at most."
            onClick={() => void setRunOptions({ tileM: null, isAtOnce: true })}
          >
            Stage by stage
          </button>
        </p>
      )}
    </fieldset>
  );
}

const REDUCTIONS = [1, 2, 3, 4, 6, 8] as const;

function SizeFields() {
  const { tileM, reduction } = runOptions.value;
  return (
    <div class="size-fields">
      <div>
        <label for="plan-tile">Size of a tile, m</label>
        <TextField
          id="plan-tile"
          inputMode="decimal"
          value={String(tileM ?? "")}
          parse={(text) => (text.trim() === "" ? parseNumber(text) : parseTile(text))}
          onValue={(tileM) => void setRunOptions({ tileM })}
        />
      </div>
      <div>
        <label for="plan-reduction">Photographs used at</label>
        <select
          id="plan-reduction"
          value={String(reduction ?? "auto")}
          onChange={({ currentTarget: { value } }) =>
            void setRunOptions({ reduction: value === "auto" ? null : Number(value) })
          }
        >
          <option value="auto">{`automatic: ${shareText(plannedReduction.value)}`}</option>
          {REDUCTIONS.map((by) => (
            <option key={by} value={String(by)}>
              {shareText(by)}
            </option>
          ))}
        </select>
      </div>
    </div>
  );
}

function shareText(by: number): string {
  return by === 1 ? "full size" : `${Math.round(100 / by)} % of their size`;
}
