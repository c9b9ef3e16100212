/** An exercise: what is to be written, an editor, and what is said of it. */
import { useState } from "preact/hooks";
import type { Verdict } from "./judging/judge";
import { judge } from "./judging/judge";
import { randomFrom } from "./judging/random";
import { type Run, run } from "./run";
import type { AnyExercise } from "./tasks/index";

/** Planted configurations, other ones at every check: who answers them by heart has not answered the next. */
const CONFIGURATIONS = 24;

export interface Checked {
  name: string;
  right: boolean;
  /** Which of the usual mistakes it is. */
  mistake: string | null;
}

type Result = { run: Run; verdict: Verdict | null };

interface Props {
  exercise: AnyExercise;
  code: string;
  onCode: (code: string) => void;
  onChecked: (checked: Checked) => void;
}

/** Runs and judges an answer. */
export async function check(exercise: AnyExercise, code: string, seed: number): Promise<Result> {
  const random = randomFrom(seed);
  const planted = Array.from({ length: CONFIGURATIONS }, () => exercise.plant(random));
  const ran = await run(
    code,
    exercise.name,
    planted.map(({ input }) => input),
  );
  return { run: ran, verdict: ran.kind === "answers" ? judge(exercise, planted, ran.answers) : null };
}

export function ExerciseView({ exercise, code, onCode, onChecked }: Props) {
  const [result, setResult] = useState<Result | null>(null);
  const [isRunning, setRunning] = useState(false);
  const { name, title, source, text, starter, solution } = exercise;
  const begin = async () => {
    setRunning(true);
    const seed = crypto.getRandomValues(new Uint32Array(1))[0] ?? 1;
    const found = await check(exercise, code, seed);
    setResult(found);
    setRunning(false);
    const { verdict } = found;
    onChecked({
      name,
      right: verdict?.kind === "right",
      mistake: verdict?.kind === "mistake" ? verdict.name : null,
    });
  };
  const replace = (next: string) => {
    onCode(next);
    setResult(null);
  };
  return (
    <section class="frame" aria-label={title}>
      <p class="title">
        {title} <span class="muted">{source}</span>
      </p>
      <p>{text}</p>
      <textarea
        aria-label={`The function ${name}, in JavaScript`}
        spellcheck={false}
        autocapitalize="off"
        autocomplete="off"
        rows={Math.min(24, Math.max(9, code.split("\n").length + 1))}
        value={code}
        onInput={(event) => onCode(event.currentTarget.value)}
        onKeyDown={(event) => {
          // The keys of slides are letters here.
          event.stopPropagation();
          if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) {
            event.preventDefault();
            void begin();
          }
        }}
      />
      <div class="row">
        <button type="button" class="primary" disabled={isRunning} onClick={() => void begin()}>
          Check
        </button>
        <button type="button" onClick={() => replace(starter)}>
          Start again
        </button>
        <details class="solution">
          <summary>A solution</summary>
          <pre>{solution}</pre>
          <button type="button" onClick={() => replace(solution)}>
            Take it
          </button>
        </details>
      </div>
      <div role="status">{result !== null && <Said result={result} />}</div>
    </section>
  );
}

function Said({ result: { run: ran, verdict } }: { result: Result }) {
  return (
    <>
      {ran.kind === "failed" && (
        <p class="said wrong">
          {ran.line !== null && `Line ${ran.line}: `}
          {ran.says}
        </p>
      )}
      {verdict?.kind === "right" && (
        <p class="said right">Right, in all of {CONFIGURATIONS} planted configurations.</p>
      )}
      {verdict?.kind === "mistake" && (
        <p class="said wrong">
          <strong>{verdict.name}</strong> {verdict.says}
        </p>
      )}
      {(verdict?.kind === "form" || verdict?.kind === "wrong") && <p class="said wrong">{verdict.says}</p>}
      {ran.log.length > 0 && (
        <>
          <p class="muted">console.log</p>
          <pre>{ran.log.join("\n")}</pre>
        </>
      )}
    </>
  );
}
