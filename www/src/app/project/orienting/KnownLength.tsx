/** A length that a person knows sets the scale: of the flight, or between two places that are marked in photographs. */
import { useSignal } from "@preact/signals";
import type { MeasuredLength, OrientationReport } from "../../../shared/orientation";
import { parsePositive, TextField } from "../../parts/TextField";
import { baseName } from "../inputFiles";
import { MeasureFigure } from "./MeasureFigure";
import { block, setScale } from "./orientation";

/** What a known length is of: places in the photographs, the cameras above the ground, or two cameras apart. */
const MARKED = "marked";
const HEIGHT = "height";

export function KnownLength({ report }: { report: OrientationReport }) {
  const what = useSignal(report.is_metric ? MARKED : HEIGHT);
  const marked = useSignal<MeasuredLength | null>(null);
  // Control points give the scale, so that a length can only be compared with it.
  const isFixed = report.control.length > 0;
  const measured = measuredNow(what.value, marked.value);
  const parse = (text: string) => {
    const parsed = parsePositive(text);
    const isLength = "value" in parsed && parsed.value !== null && measured > 0;
    return isLength ? parsed : { error: "A number above 0, of a length that is measured." };
  };
  return (
    <fieldset class="known-length">
      <legend>{isFixed ? "Measure a length" : "A length that you know sets the scale"}</legend>
      <label>
        <span class="visually-hidden">What is known</span>
        <select value={what.value} onChange={(event) => (what.value = event.currentTarget.value)}>
          <option value={MARKED}>Between two places that you mark in the photographs</option>
          <option value={HEIGHT}>Mean height of the cameras above the points</option>
          {neighbours(report).map(([a, b]) => (
            <option key={`${a} ${b}`} value={`${a} ${b}`}>
              From camera {baseName(report.photos[a]?.file ?? "")} to camera{" "}
              {baseName(report.photos[b]?.file ?? "")}
            </option>
          ))}
        </select>
      </label>
      {isFixed ? (
        <output class="numbers">{measured > 0 ? `${measured.toFixed(3)} m` : ""}</output>
      ) : (
        <>
          <label for="known-length">metres</label>
          <TextField
            id="known-length"
            value={measured > 0 ? measured.toFixed(2) : ""}
            placeholder="mark both ends"
            inputMode="decimal"
            parse={parse}
            onValue={(metres) => void setScale(measured, metres ?? 0, wordsOf(what.value))}
            hint="Enter takes it."
          />
        </>
      )}
      {what.value === MARKED && (
        <MeasureFigure report={report} onMeasured={(length) => (marked.value = length)} />
      )}
    </fieldset>
  );
}

/** Pairs of photographs one after the other: what lies between two of them is known soonest. */
function neighbours({ photos }: OrientationReport): [number, number][] {
  return photos.slice(1).map((_, i): [number, number] => [i, i + 1]);
}

function wordsOf(what: string): string {
  switch (what) {
    case MARKED:
      return "a length between two places in the photographs";
    case HEIGHT:
      return "the height of the cameras above the points";
    default:
      return "the distance of two cameras";
  }
}

function measuredNow(what: string, marked: MeasuredLength | null): number {
  switch (what) {
    case MARKED:
      return marked?.length ?? 0;
    case HEIGHT:
      return heightNow();
    default:
      return distanceNow(what);
  }
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
