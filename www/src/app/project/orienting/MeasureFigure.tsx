/**
 * A length between two places: each end is marked in two photographs or more. Where an end is marked in one of them, the
 * other shows the image of its ray, on which the mark belongs.
 */
import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { LengthMark, MeasuredLength, OrientationReport } from "../../../shared/orientation";
import { PALETTE } from "../../../shared/palette";
import { ARROWS } from "../../parts/useDrawn";
import { baseName } from "../inputFiles";
import { type End, type Ends, isMeasurable, marked, markIn, NO_MARKS, nextEnd } from "./lengthMarks";
import { block, epipolarCurve, measureLength, pairs } from "./orientation";
import { PhotographCanvas } from "./PhotographCanvas";
import { cutOf, drawCurve, strokeCased } from "./photographPicture";

const ENDS = ["First end", "Second end"] as const;

/** Side of what the magnifier shows, pixels of the photograph, and by how much it is enlarged. */
const CUT_PX = 41;
const ENLARGED = 5;

interface Props {
  report: OrientationReport;
  onMeasured: (length: MeasuredLength | null) => void;
}

export function MeasureFigure({ report, onMeasured }: Props) {
  const files = report.photos.map(({ file }) => file);
  const shown = useSignal<readonly [string, string]>(firstPair(files));
  const end = useSignal<End>(0);
  const ends = useSignal<Ends>(NO_MARKS);
  const result = useSignal<MeasuredLength | string | null>(null);
  useSignalEffect(() => {
    // Another scale is another length.
    void block.value;
    const [first, second] = ends.value;
    const take = (found: MeasuredLength | string | null) => {
      result.value = found;
      onMeasured(typeof found === "string" ? null : found);
    };
    if (isMeasurable(ends.value)) {
      void measureLength([[...first], [...second]]).then(take);
    } else {
      take(null);
    }
  });
  const mark = (file: string) => (x: number, y: number, isDone: boolean) => {
    ends.value = marked(ends.value, end.value, { file, x, y });
    if (isDone) {
      end.value = nextEnd(ends.value, end.value, shown.value);
    }
  };
  const show = (side: End) => (file: string) => {
    shown.value = side === 0 ? [file, shown.value[1]] : [shown.value[0], file];
  };
  return (
    <div class="measure-figure" data-testid="measure-figure">
      <div class="row">
        {ENDS.map((name, i) => (
          <button
            key={name}
            type="button"
            aria-pressed={end.value === i}
            onClick={() => (end.value = i as End)}
          >
            {name}: {ends.value[i as End].length} marks
          </button>
        ))}
        <button type="button" class="quiet" onClick={() => (ends.value = NO_MARKS)}>
          Clear
        </button>
      </div>
      <p class="muted">
        Click the place in both photographs, then the other end. The magnifier and the arrow keys place a mark
        exactly; the line is where the mark in the other photograph says that the place is.
      </p>
      <div class="pair">
        {([0, 1] as const).map((side) => (
          <Markable
            key={side}
            files={files}
            file={shown.value[side]}
            other={shown.value[side === 0 ? 1 : 0]}
            ends={ends.value}
            end={end.value}
            onShow={show(side)}
            onMark={mark(shown.value[side])}
          />
        ))}
      </div>
      <p role="status" class="numbers">
        {resultText(result.value, report.is_metric)}
      </p>
    </div>
  );
}

/** Two photographs that show much of the same from different places. */
function firstPair(files: readonly string[]): [string, string] {
  const known = pairs.value.find(
    ({ first, second, kind }) => kind !== "rotation" && files.includes(first) && files.includes(second),
  );
  return [known?.first ?? files[0] ?? "", known?.second ?? files[1] ?? ""];
}

function resultText(result: MeasuredLength | string | null, isMetric: boolean): string {
  if (result === null) {
    return "";
  }
  if (typeof result === "string") {
    return `${result.charAt(0).toUpperCase()}${result.slice(1)}.`;
  }
  const unit = isMetric ? "m" : "units";
  const { length, sigma, rms_px: rms } = result;
  return `${length.toFixed(3)} ± ${sigma.toFixed(3)} ${unit}; the marks are ${rms.toFixed(1)} px (rms) from the rays.`;
}

interface MarkableProps {
  files: readonly string[];
  file: string;
  other: string;
  ends: Ends;
  end: End;
  onShow: (file: string) => void;
  onMark: (x: number, y: number, isDone: boolean) => void;
}

/** A photograph in which ends are marked. */
function Markable({ files, file, other, ends, end, onShow, onMark }: MarkableProps) {
  const curve = useSignal<Float32Array | null>(null);
  const own = markIn(ends, end, file);
  const partner = markIn(ends, end, other);
  useEffect(() => {
    let isCurrent = true;
    curve.value = null;
    if (partner !== undefined && other !== file) {
      void epipolarCurve(other, file, partner.x, partner.y).then((found) => {
        if (isCurrent) {
          curve.value = found;
        }
      });
    }
    return () => {
      isCurrent = false;
    };
  }, [file, other, partner]);
  return (
    <PhotographCanvas
      file={file}
      label={`${baseName(file)}: click to mark the ${ENDS[end].toLowerCase()}; arrow keys move the mark`}
      draw={(context, scale) => draw(context, scale, ends, end, file, curve.value)}
      of={[curve.value, ends, end, file]}
      onPlace={(x, y) => onMark(x, y, true)}
      onKey={(event, [width, height]) => {
        const step = ARROWS[event.key];
        if (step !== undefined) {
          event.preventDefault();
          const { x, y } = own ?? { x: width / 2, y: height / 2 };
          const by = event.shiftKey ? STEP_PX.far : STEP_PX.near;
          onMark(x + by * step[0], y + by * step[1], false);
        }
      }}
      head={
        <label>
          <span class="visually-hidden">Photograph</span>
          <select value={file} onChange={(event) => onShow(event.currentTarget.value)}>
            {files.map((one) => (
              <option key={one} value={one}>
                {baseName(one)}
              </option>
            ))}
          </select>
        </label>
      }
    >
      {own !== undefined && <Magnifier mark={own} onMark={(x, y) => onMark(x, y, false)} />}
    </PhotographCanvas>
  );
}

/** What an arrow key moves a mark by, pixels; with the shift key so many times as far. */
const STEP_PX = { near: 0.5, far: 10 };

/** The surroundings of a mark as the photograph has them; a click places it there. */
function Magnifier({ mark, onMark }: { mark: LengthMark; onMark: (x: number, y: number) => void }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { file, x, y } = mark;
  const [left, top] = [x, y].map((at) => Math.round(at - CUT_PX / 2)) as [number, number];
  useEffect(() => {
    let isCurrent = true;
    void cutOf(file, left, top, CUT_PX).then((cut) => {
      const context = canvas.current?.getContext("2d");
      if (!isCurrent || context === null || context === undefined) {
        return;
      }
      context.imageSmoothingEnabled = false;
      const side = CUT_PX * ENLARGED;
      context.clearRect(0, 0, side, side);
      if (cut !== null) {
        context.drawImage(cut, 0, 0, side, side);
      }
      cross(context, (x - left) * ENLARGED, (y - top) * ENLARGED, PALETTE.selected);
    });
    return () => {
      isCurrent = false;
    };
  }, [file, x, y, left, top]);
  return (
    <canvas
      ref={canvas}
      class="magnifier"
      width={CUT_PX * ENLARGED}
      height={CUT_PX * ENLARGED}
      role="img"
      aria-label={`The mark in ${baseName(file)}, enlarged: column ${x.toFixed(1)}, row ${y.toFixed(1)}`}
      onClick={(event) => {
        const corner = event.currentTarget.getBoundingClientRect();
        const scale = CUT_PX / corner.width;
        onMark(left + (event.clientX - corner.left) * scale, top + (event.clientY - corner.top) * scale);
      }}
    />
  );
}

function draw(
  context: CanvasRenderingContext2D,
  scale: number,
  ends: Ends,
  end: End,
  file: string,
  curve: Float32Array | null,
): void {
  if (curve !== null) {
    drawCurve(context, curve, scale, [PALETTE.casing, PALETTE.beam]);
  }
  const [first, second] = ([0, 1] as const).map((which) => markIn(ends, which, file));
  if (first !== undefined && second !== undefined) {
    const between = new Float32Array([first.x, first.y, second.x, second.y]);
    drawCurve(context, between, scale, [PALETTE.casing, PALETTE.matched]);
  }
  [first, second].forEach((mark, which) => {
    if (mark !== undefined) {
      cross(context, mark.x * scale, mark.y * scale, which === end ? PALETTE.selected : PALETTE.matched);
    }
  });
}

/** A cross that leaves its middle open. */
function cross(context: CanvasRenderingContext2D, x: number, y: number, colour: string): void {
  const [inner, outer] = [4, 13];
  const path = new Path2D();
  for (const [dx, dy] of [
    [1, 0],
    [-1, 0],
    [0, 1],
    [0, -1],
  ] as const) {
    path.moveTo(x + inner * dx, y + inner * dy);
    path.lineTo(x + outer * dx, y + outer * dy);
  }
  strokeCased(context, path, PALETTE.casing, colour);
}
