/** Matches of a pair of photographs, and the epipolar line of one of them: what the second camera sees of a ray of the first. */
import { useSignal, useSignalEffect } from "@preact/signals";
import { PALETTE } from "../../../shared/palette";
import { counted } from "../../parts/counted";
import { baseName } from "../inputFiles";
import { epipolarCurve, pairs, report, type ShownPair, shownPair, showPair } from "./orientation";
import { PhotographCanvas } from "./PhotographCanvas";
import { nearestMatch } from "./pairGeometry";
import { drawCurve } from "./photographPicture";

const DOT_PX = 2;

const KINDS = {
  general: "An essential matrix explains the matches",
  planar: "A plane explains the matches as well as an essential matrix",
  rotation: "The camera only turned, which shows no depth",
};

export function PairFigure() {
  const chosen = useSignal(middleOf(shownPair.value));
  const curve = useSignal<Float32Array | null>(null);
  const pair = pairs.value[shownPair.value?.place ?? 0];
  const matches = shownPair.value?.matches ?? new Float32Array();
  const count = matches.length / 4;
  useSignalEffect(() => {
    const shown = shownPair.value;
    const named = pairs.value[shown?.place ?? 0];
    const at = 4 * chosen.value;
    curve.value = null;
    if (report.value === null || shown === null || named === undefined || at >= shown.matches.length) {
      return;
    }
    const [x = 0, y = 0] = shown.matches.subarray(at, at + 2);
    void epipolarCurve(named.first, named.second, x, y).then((found) => {
      curve.value = found;
    });
  });
  if (pair === undefined) {
    return null;
  }
  const choose = (side: 0 | 1) => (x: number, y: number) => {
    chosen.value = nearestMatch(matches, side, x, y);
  };
  return (
    <section class="pair-figure" data-testid="pair-figure" aria-label="Matches of a pair">
      <div class="row">
        <h3>Matches of a pair</h3>
        <label>
          <span class="visually-hidden">Pair of photographs</span>
          <select
            value={String(shownPair.value?.place ?? 0)}
            disabled={report.value === null}
            onChange={(event) => {
              void showPair(Number(event.currentTarget.value)).then(() => {
                chosen.value = middleOf(shownPair.value);
              });
            }}
          >
            {pairs.value.map((one, place) => (
              <option key={`${one.first} ${one.second}`} value={String(place)}>
                {baseName(one.first)} – {baseName(one.second)}: {counted(one.matches, "matches")}
              </option>
            ))}
          </select>
        </label>
      </div>
      <p class="muted">
        {KINDS[pair.kind]}; rays meet at {pair.angle_deg.toFixed(1)}° (median). Pick a match x on the left:{" "}
        {report.value === null
          ? "its epipolar line appears on the right once the cameras are known."
          : "its partner x′ lies on the epipolar line l′ on the right, the image of the ray through x."}
      </p>
      <div class="pair">
        <Picture
          path={pair.first}
          matches={matches}
          side={0}
          chosen={chosen.value}
          curve={null}
          onPick={choose(0)}
        />
        <Picture
          path={pair.second}
          matches={matches}
          side={1}
          chosen={chosen.value}
          curve={curve.value}
          onPick={choose(1)}
        />
      </div>
      <label class="match-choice">
        <span>
          Match {chosen.value + 1} of {count}
        </span>
        <input
          type="range"
          min={0}
          max={Math.max(count - 1, 0)}
          value={chosen.value}
          data-testid="match"
          onInput={(event) => (chosen.value = Number(event.currentTarget.value))}
        />
      </label>
    </section>
  );
}

/** Keypoints are in the order of their strength: any of the others may stand at the edge as well. */
function middleOf(shown: ShownPair | null): number {
  return Math.floor((shown?.matches.length ?? 0) / 8);
}

interface PictureProps {
  path: string;
  matches: Float32Array;
  side: 0 | 1;
  chosen: number;
  curve: Float32Array | null;
  onPick: (x: number, y: number) => void;
}

function Picture({ path, matches, side, chosen, curve, onPick }: PictureProps) {
  return (
    <PhotographCanvas
      file={path}
      label={`${baseName(path)} with its matches`}
      draw={(context, scale) => draw(context, scale, matches, side, chosen, curve)}
      of={[matches, chosen, curve]}
      onPlace={onPick}
    >
      <figcaption class="muted">
        {side === 0 ? "x in " : "x′ and l′ in "}
        {baseName(path)}
      </figcaption>
    </PhotographCanvas>
  );
}

function draw(
  context: CanvasRenderingContext2D,
  scale: number,
  matches: Float32Array,
  side: 0 | 1,
  chosen: number,
  curve: Float32Array | null,
): void {
  const dot = (match: number, radius: number, colour: string) => {
    const [x = 0, y = 0] = matches.subarray(4 * match + 2 * side, 4 * match + 2 * side + 2);
    context.beginPath();
    context.arc(x * scale, y * scale, radius, 0, 2 * Math.PI);
    context.fillStyle = colour;
    context.fill();
  };
  for (let match = 0; match < matches.length / 4; match += 1) {
    dot(match, DOT_PX + 1, PALETTE.casing);
    dot(match, DOT_PX, PALETTE.matched);
  }
  if (curve !== null) {
    drawCurve(context, curve, scale, [PALETTE.casing, PALETTE.beam]);
  }
  if (4 * chosen < matches.length) {
    dot(chosen, 8, PALETTE.casing);
    dot(chosen, 6, PALETTE.selected);
  }
}
