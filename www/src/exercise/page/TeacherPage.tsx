/** For teachers: all exercises with their answers and the mistakes that they know, and a sheet of those that are chosen. */
import { spelledOut } from "../../app/words/papers";
import "./page.css";
import { useState } from "preact/hooks";
import { counted } from "../../app/parts/counted";
import { saveFile } from "../../app/parts/saveFile";
import { TeachingHead } from "../../app/words/TeachingHead";
import { Linked } from "../../app/words/Term";
import { type AnyExercise, EXERCISES, KIND_WORDS, mistakesOf, taskText } from "../exercises";
import type { FigureExercise } from "../figures/judgeFigure";
import { LESSONS } from "../judging/about";
import { drawOf } from "../judging/judgeNumber";
import { quantityText } from "../judging/quantity";
import { answerOnDemo } from "./figureAnswers";
import { sheetOf } from "./sheet";

const FIRST_SEED = 1;

export function TeacherPage() {
  const [chosen, setChosen] = useState<ReadonlySet<string>>(new Set());
  const [seed, setSeed] = useState(FIRST_SEED);
  const [answers, setAnswers] = useState<ReadonlyMap<string, string>>(new Map());
  const [says, setSays] = useState<string | null>(null);
  const exercises = EXERCISES.filter(({ name }) => chosen.has(name));
  const choose = (names: readonly string[], isChosen: boolean) =>
    setChosen(new Set([...chosen].filter((name) => !names.includes(name)).concat(isChosen ? names : [])));

  /** Of figures, which the core must be asked for. */
  const answer = async (figures: readonly FigureExercise[]): Promise<ReadonlyMap<string, string>> => {
    const all = new Map(answers);
    for (const one of figures.filter(({ name }) => !all.has(name))) {
      setSays(`Asking the demo scene: ${one.title}`);
      all.set(one.name, await answerOnDemo(one));
      setAnswers(new Map(all));
    }
    setSays(null);
    return all;
  };
  const save = async (isWithAnswers: boolean) => {
    try {
      const found = isWithAnswers ? await answer(exercises.filter((one) => one.kind === "figure")) : null;
      const page = new URL("./exercises.html", document.baseURI).href;
      const text = sheetOf({ exercises, seed, page, answers: found });
      const name = `exercises-${seed}${isWithAnswers ? "-answers" : ""}.html`;
      saveFile(name, new Blob([text], { type: "text/html" }));
    } catch (error) {
      setSays(error instanceof Error ? error.message : String(error));
    }
  };
  return (
    <div class="exercises">
      <TeachingHead now="For teachers" />
      <h1 class="visually-hidden">Exercises, for teachers</h1>
      <form class="sheet row" aria-label="Sheet" onSubmit={(event) => event.preventDefault()}>
        <label class="row">
          <span>Values no.</span>
          <input
            type="number"
            min={0}
            max={999999}
            value={seed}
            onInput={(event) => setSeed(Math.max(0, Math.floor(Number(event.currentTarget.value)) || 0))}
          />
        </label>
        <button
          type="button"
          onClick={() =>
            choose(
              EXERCISES.map(({ name }) => name),
              chosen.size === 0,
            )
          }
        >
          {chosen.size === 0 ? "Choose all" : "Choose none"}
        </button>
        <button type="button" class="primary" disabled={chosen.size === 0} onClick={() => void save(false)}>
          Save the sheet
        </button>
        <button type="button" disabled={chosen.size === 0 || says !== null} onClick={() => void save(true)}>
          Save it with answers
        </button>
        <span role="status">{says ?? `${counted(chosen.size, "exercises")} chosen`}</span>
      </form>
      <main>
        {EXERCISES.map((exercise) => (
          <Known
            key={exercise.name}
            exercise={exercise}
            seed={seed}
            answer={answers.get(exercise.name) ?? null}
            onAsk={(figure) => void answer([figure]).catch((error: Error) => setSays(error.message))}
            isChosen={chosen.has(exercise.name)}
            onChoose={(isChosen) => choose([exercise.name], isChosen)}
          />
        ))}
      </main>
    </div>
  );
}

interface KnownProps {
  exercise: AnyExercise;
  seed: number;
  /** Of a figure, once the core was asked. */
  answer: string | null;
  onAsk: (exercise: FigureExercise) => void;
  isChosen: boolean;
  onChoose: (isChosen: boolean) => void;
}

function Known({ exercise, seed, answer, onAsk, isChosen, onChoose }: KnownProps) {
  const { title, name, lesson, source, kind } = exercise;
  return (
    <section class="known" aria-label={title}>
      <div class="row">
        <label class="row">
          <input
            type="checkbox"
            checked={isChosen}
            onChange={(event) => onChoose(event.currentTarget.checked)}
          />
          <strong>{title}</strong>
        </label>
        <span class="muted">
          {LESSONS[lesson]} · {spelledOut(source)} · {KIND_WORDS[kind]} ·{" "}
          <a href={`./exercises.html#${name}`}>{name}</a>
        </span>
      </div>
      <details>
        <summary>Task, answer, mistakes</summary>
        <p>
          <Linked text={taskText(exercise, seed)} />
        </p>
        {kind === "function" && <pre>{exercise.solution}</pre>}
        {kind === "number" && <NumberAnswer {...drawOf(exercise, seed)} exercise={exercise} />}
        {kind === "figure" && (
          <>
            <p>{exercise.solution}</p>
            {answer === null ? (
              <button type="button" onClick={() => onAsk(exercise)}>
                Answer on the demo scene
              </button>
            ) : (
              <p class="answer-words">{answer}</p>
            )}
          </>
        )}
        <dl>
          {mistakesOf(exercise).map((one) => (
            <div key={one.name}>
              <dt>{one.name}</dt>
              <dd>{one.says}</dd>
            </div>
          ))}
        </dl>
      </details>
    </section>
  );
}

interface NumberAnswerProps {
  exercise: Extract<AnyExercise, { kind: "number" }>;
  value: number;
  solution: string;
}

function NumberAnswer({ exercise: { unit, tolerance }, value, solution }: NumberAnswerProps) {
  const within = quantityText({ value: Math.abs(value) * tolerance, unit }, 2);
  return (
    <p class="answer-words">
      <strong>{quantityText({ value, unit })}</strong>, within {within}. {solution}
    </p>
  );
}
