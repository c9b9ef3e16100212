/** A function that is to be written: an editor, and what the planted configurations say of it. */
import { useState } from "preact/hooks";
import { Linked } from "../../app/words/Term";
import type { AnyFunction } from "../functions/index";
import type { Verdict } from "../judging/about";
import { judge } from "../judging/judge";
import { randomFrom } from "../judging/random";
import { type Run, run } from "../judging/run";
import { ExerciseFrame, Said } from "./ExerciseFrame";
import type { ViewProps } from "./view";

/** Planted configurations, other ones at every check: who answers them by heart has not answered the next. */
const CONFIGURATIONS = 24;

type Result = { run: Run; verdict: Verdict | null };

/** Runs and judges an answer. */
async function check(exercise: AnyFunction, code: string, seed: number): Promise<Result> {
  const random = randomFrom(seed);
  const planted = Array.from({ length: CONFIGURATIONS }, () => exercise.plant(random));
  const ran = await run(
    code,
    exercise.name,
    planted.map(({ input }) => input),
  );
  return { run: ran, verdict: ran.kind === "answers" ? judge(exercise, planted, ran.answers) : null };
}

export function FunctionView({ exercise, written, onWritten, onVerdict }: ViewProps<AnyFunction>) {
  const [result, setResult] = useState<Result | null>(null);
  const [isRunning, setRunning] = useState(false);
  const { name, text, starter, solution } = exercise;
  const code = written ?? starter;
  const begin = async () => {
    setRunning(true);
    const seed = crypto.getRandomValues(new Uint32Array(1))[0] ?? 1;
    const found = await check(exercise, code, seed);
    setResult(found);
    setRunning(false);
    onVerdict(found.verdict);
  };
  const replace = (next: string) => {
    onWritten(next);
    setResult(null);
  };
  return (
    <ExerciseFrame about={exercise} said={result !== null && <SaidOfRun result={result} />}>
      <p>
        <Linked text={text} />
      </p>
      <textarea
        aria-label={`The function ${name}, in JavaScript`}
        spellcheck={false}
        autocapitalize="off"
        autocomplete="off"
        rows={Math.min(24, Math.max(9, code.split("\n").length + 1))}
        value={code}
        onInput={(event) => onWritten(event.currentTarget.value)}
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
    </ExerciseFrame>
  );
}

function SaidOfRun({ result: { run: ran, verdict } }: { result: Result }) {
  return (
    <>
      {ran.kind === "failed" && (
        <p class="said wrong">
          {ran.line !== null && `Line ${ran.line}: `}
          {ran.says}
        </p>
      )}
      {verdict !== null && (
        <Said verdict={verdict} right={`Right, in all of ${CONFIGURATIONS} planted configurations.`} />
      )}
      {ran.log.length > 0 && (
        <>
          <p class="muted">console.log</p>
          <pre>{ran.log.join("\n")}</pre>
        </>
      )}
    </>
  );
}
