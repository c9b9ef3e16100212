/** A number with its unit: values of one's own, a field, and what is said of the answer. */
import { useMemo, useState } from "preact/hooks";
import { Linked } from "../../app/words/Term";
import type { Verdict } from "../judging/about";
import { drawOf, judgeNumber, type NumberExercise } from "../judging/judgeNumber";
import { AnswerField } from "./AnswerField";
import { ExerciseFrame, Said } from "./ExerciseFrame";
import type { ViewProps } from "./view";

/** Seeds that a person can tell another one. */
const MOST_SEEDS = 10_000;

export function anySeed(): number {
  return (crypto.getRandomValues(new Uint32Array(1))[0] ?? 1) % MOST_SEEDS;
}

export function NumberView(props: ViewProps<NumberExercise>) {
  const { exercise, seed, onSeed, onWritten, onVerdict } = props;
  const written = props.written ?? "";
  const [verdict, setVerdict] = useState<Verdict | null>(null);
  const draw = useMemo(() => drawOf(exercise, seed), [exercise, seed]);
  const check = () => {
    const found = judgeNumber(exercise, draw, written);
    setVerdict(found);
    onVerdict(found);
  };
  return (
    <ExerciseFrame
      about={exercise}
      said={verdict !== null && <Said verdict={verdict} right="Right, number and unit." />}
    >
      <p>
        <Linked text={draw.text} />
      </p>
      <AnswerField label="Number and unit" written={written} onWritten={onWritten} onCheck={check} />
      <div class="row">
        <button
          type="button"
          onClick={() => {
            onSeed(anySeed());
            onWritten("");
            setVerdict(null);
          }}
        >
          Other values
        </button>
        <span class="muted numbers">Values no. {seed}</span>
        <details class="solution">
          <summary>A solution</summary>
          <p>{draw.solution}</p>
        </details>
      </div>
    </ExerciseFrame>
  );
}
