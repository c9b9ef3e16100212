/** Photographs on their way to an orientation: the steps, the block in space as it grows, and what came of it. */
import "./orienting.css";
import { counted } from "../../parts/counted";
import { parsePositive, TextField } from "../../parts/TextField";
import { cancel } from "../../session/session";
import { isBusy } from "../../state/activity";
import { OrientationResult } from "./OrientationResult";
import { OrientationSpace } from "./OrientationSpace";
import {
  block,
  computeOrientation,
  pairs,
  progress,
  readPhotographs,
  reconstructWithIt,
  report,
  STEPS,
  type Step,
  statedFocalPx,
  stateFocal,
} from "./orientation";
import { PairFigure } from "./PairFigure";

/** The steps as a teacher tells them. */
const LESSON: Record<Exclude<Step, "done">, { title: string; text: string }> = {
  keypoints: {
    title: "Keypoints",
    text: "Spots that look the same from another place, larger or turned (SIFT). 128 numbers describe the surroundings of each.",
  },
  matches: {
    title: "Matches",
    text: "Two keypoints match where each is most like the other, and clearly more than the second best.",
  },
  pairs: {
    title: "Geometry of pairs",
    text: "All matches x, x′ of a rigid scene fulfil x′ᵀ E x = 0. The essential matrix E holds how two cameras stand to each other; matches that do not fulfil it are dropped.",
  },
  registration: {
    title: "Registration and bundle adjustment",
    text: "From the best pair on, each photograph finds its place by the points that it sees, and adds new ones. Then cameras, points, focal length and lens distortion change together until the rays miss their points by as little as possible.",
  },
};

export function OrientationPanel() {
  const at = progress.value;
  return (
    <section class="orienting" data-testid="orienting" aria-label="Computing the orientation">
      <div class="row spread head">
        <h2>{titleText()}</h2>
        {at !== null && at.step !== "done" && (
          <button type="button" onClick={({ detail }) => void (detail < 2 && cancel())}>
            Cancel
          </button>
        )}
        {at?.step === "done" && (
          <button
            type="button"
            class="primary"
            disabled={isBusy.value}
            onClick={() => void reconstructWithIt()}
          >
            Reconstruct with it
          </button>
        )}
      </div>
      {at === null && <Again />}
      {at !== null && at.step !== "done" && (
        <progress
          class="whole"
          max={STEPS.length - 1}
          value={STEPS.indexOf(at.step) + at.fraction}
          aria-label={LESSON[at.step].title}
        />
      )}
      {block.value !== null && <OrientationSpace />}
      {report.value !== null && <OrientationResult report={report.value} />}
      {pairs.value.length > 0 && <PairFigure />}
      <ol class="chain" aria-label="How the orientation is computed">
        {STEPS.filter((step) => step !== "done").map((step) => (
          <ChainStep key={step} step={step} />
        ))}
      </ol>
    </section>
  );
}

/** After a cancelled or failed run. */
function Again() {
  return (
    <p class="row">
      <button type="button" class="primary" disabled={isBusy.value} onClick={() => void computeOrientation()}>
        Compute again
      </button>
      <label for="stated-focal">Focal length, if you know it [px]</label>
      <TextField
        id="stated-focal"
        value={statedFocalPx.value === null ? "" : String(statedFocalPx.value)}
        placeholder="from the photographs"
        inputMode="decimal"
        parse={parsePositive}
        onValue={stateFocal}
      />
    </p>
  );
}

function titleText(): string {
  const at = progress.value;
  if (at === null) {
    return "The orientation was not computed";
  }
  const count = counted(at.photographs, "photographs");
  return at.step === "done" ? `Orientation of ${count}` : `Computing the orientation of ${count}`;
}

function ChainStep({ step }: { step: Exclude<Step, "done"> }) {
  const { title, text } = LESSON[step];
  const at = progress.value;
  const now = at === null ? -1 : STEPS.indexOf(at.step);
  const place = STEPS.indexOf(step);
  const status = place < now ? "done" : place === now ? "now" : "waiting";
  return (
    <li class={status} aria-current={status === "now" ? "step" : undefined}>
      <h3>{title}</h3>
      <p class="muted">{text}</p>
      {status === "now" && at !== null ? (
        <progress max={1} value={at.fraction} aria-label={`${title}: ${Math.round(100 * at.fraction)} %`} />
      ) : (
        <span class="rule" />
      )}
      <p class="numbers" data-step={step}>
        {foundText(step, status !== "waiting")}
      </p>
    </li>
  );
}

/** What a step has found so far. */
function foundText(step: Exclude<Step, "done">, isBegun: boolean): string {
  if (!isBegun) {
    return "–";
  }
  const photographs = progress.value?.photographs ?? 0;
  switch (step) {
    case "keypoints": {
      const keypoints = readPhotographs.value.reduce((sum, one) => sum + (one.keypoints ?? 0), 0);
      return `${readPhotographs.value.length} of ${counted(photographs, "photographs")}, ${counted(keypoints, "keypoints")}`;
    }
    case "matches":
      return pairs.value.length === 0 ? "…" : `${counted(pairs.value.length, "pairs")} show the same`;
    case "pairs": {
      const matches = pairs.value.reduce((sum, one) => sum + one.matches, 0);
      return pairs.value.length === 0 ? "…" : `${counted(matches, "matches")} agree`;
    }
    case "registration": {
      const { views = [], points = [] } = block.value ?? {};
      return `${views.length} of ${counted(photographs, "photographs")}, ${counted(points.length / 3, "points")}`;
    }
  }
}
