/** The question before the answer: the reader commits, then sees. */
import { useSignal } from "@preact/signals";
import { Slider } from "./parts/draw";
import { Pieces } from "./parts/Formula";
import type { Prediction } from "./parts/lesson";
import { digitsOf, num } from "./parts/say";
import { commit, guessOf } from "./progress";

interface Props<P extends Prediction = Prediction> {
  name: string;
  predict: P;
}

export function PredictionView({ name, title, predict }: Props & { title: string }) {
  return (
    <section class="predict" aria-label={`Your guess: ${title}`}>
      <p class="question">
        <Pieces text={predict.question} />
      </p>
      {predict.kind === "choice" && <Choice name={name} predict={predict} />}
      {predict.kind === "estimate" && <Estimate name={name} predict={predict} />}
      {predict.kind === "place" && <Place name={name} predict={predict} />}
    </section>
  );
}

type Of<K extends Prediction["kind"]> = Props<Extract<Prediction, { kind: K }>>;

function Choice({ name, predict: { options, right, why } }: Of<"choice">) {
  const guess = guessOf(name);
  return (
    <>
      <ul class="options">
        {options.map((text, i) => {
          const mark = guess === undefined ? "" : i === right() ? "right" : i === guess.value ? "wrong" : "";
          return (
            <li key={text}>
              <button
                type="button"
                class={mark}
                aria-pressed={guess?.value === i}
                disabled={guess !== undefined}
                onClick={() => commit(name, { value: i })}
              >
                <span>
                  <Pieces text={text} />
                </span>
                {mark === "right" && <span class="mark">✓ right</span>}
                {mark === "wrong" && <span class="mark">✗ your guess</span>}
              </button>
            </li>
          );
        })}
      </ul>
      {guess !== undefined && (
        <p role="status">
          <Pieces text={`${guess.value === right() ? "Yes." : "No."} ${why()}`} />
        </p>
      )}
    </>
  );
}

function Estimate({ name, predict }: Of<"estimate">) {
  const { unit, range, truth, within, why } = predict;
  const [min, max, step] = range;
  const guess = guessOf(name);
  const digits = digitsOf(step);
  const value = useSignal(guess?.value ?? (min + max) / 2);
  const off = value.value - truth();
  return (
    <>
      <Slider
        label="Your guess"
        range={range}
        suffix={` ${unit}`}
        of={value}
        disabled={guess !== undefined}
      />
      {guess === undefined ? (
        <Reveal onClick={() => commit(name, { value: value.value })} />
      ) : (
        <p role="status">
          <Pieces
            text={`${Math.abs(off) <= within ? "Right:" : `Your guess is ${num(Math.abs(off), digits)} ${unit} too ${off > 0 ? "much" : "little"}:`} it is *${num(truth(), digits)} ${unit}*. ${why()}`}
          />
        </p>
      )}
    </>
  );
}

function Place({ name, predict: { how } }: Of<"place">) {
  return guessOf(name) === undefined ? (
    <Reveal onClick={() => commit(name, { value: null })} />
  ) : (
    <p role="status">
      <Pieces text={how()} />
    </p>
  );
}

function Reveal({ onClick }: { onClick: () => void }) {
  return (
    <button type="button" class="primary" onClick={onClick}>
      Show the answer
    </button>
  );
}
