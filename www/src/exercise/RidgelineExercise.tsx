/** `<ridgeline-exercise name="triangulate">`: do it, and hear whether it is right or which mistake it is. */
import { signal } from "@preact/signals";
import { type ComponentType, render } from "preact";
import glossaryCss from "../app/words/glossary.css?inline";
import { hostSheet } from "../element/hostSheet";
import { type AnyExercise, EXERCISES, exerciseNamed } from "./exercises";
import type { Verdict } from "./judging/about";
import exerciseCss from "./views/exercise.css?inline";
import { FigureView } from "./views/FigureView";
import { FunctionView } from "./views/FunctionView";
import { anySeed, NumberView } from "./views/NumberView";
import type { ViewProps } from "./views/view";

const TAG = "ridgeline-exercise";
const styleSheet = hostSheet(glossaryCss, exerciseCss);

export interface Checked {
  name: string;
  right: boolean;
  /** Which of the usual mistakes it is. */
  mistake: string | null;
  /** Of the values of a number; null for other exercises. */
  seed: number | null;
}

let needFigure: () => Promise<unknown> = () => Promise.resolve();

export class RidgelineExercise extends HTMLElement {
  static readonly observedAttributes = ["name", "seed", "base", "theme"];

  readonly #shadow = this.attachShadow({ mode: "open" });
  readonly #name = signal<string | null>(null);
  readonly #code = signal<string | null>(null);
  readonly #seed = signal<number | null>(null);
  readonly #place = signal<Place>({ base: null, theme: null });

  connectedCallback(): void {
    this.#seed.value ??= anySeed();
    this.#shadow.adoptedStyleSheets = [styleSheet()];
    const of = { name: this.#name, code: this.#code, seed: this.#seed, place: this.#place };
    render(<Root {...of} onVerdict={(verdict) => this.#tell(verdict)} />, this.#shadow);
  }

  disconnectedCallback(): void {
    render(null, this.#shadow);
  }

  attributeChangedCallback(attribute: string, before: string | null, now: string | null): void {
    if (attribute === "base" || attribute === "theme") {
      this.#place.value = { base: this.getAttribute("base"), theme: this.getAttribute("theme") };
      return;
    }
    if (attribute === "seed") {
      this.#seed.value = now !== null && /^\d{1,9}$/.test(now) ? Number(now) : anySeed();
      return;
    }
    this.#name.value = now;
    // What was written before the element had its name belongs to it.
    if (before !== null && before !== now) {
      this.#code.value = null;
    }
  }

  /** What stands in the editor or the field. */
  get code(): string {
    const exercise = exerciseNamed(this.getAttribute("name"));
    return this.#code.peek() ?? (exercise?.kind === "function" ? exercise.starter : "");
  }

  set code(code: string) {
    this.#code.value = code;
  }

  #tell(verdict: Verdict | null): void {
    const exercise = exerciseNamed(this.#name.peek());
    const detail: Checked = {
      name: exercise?.name ?? "",
      right: verdict?.kind === "right",
      mistake: verdict?.kind === "mistake" ? verdict.name : null,
      seed: exercise?.kind === "number" ? this.#seed.peek() : null,
    };
    this.dispatchEvent(new CustomEvent("ridgeline-checked", { detail, bubbles: true, composed: true }));
  }
}

/** Each takes the exercises of its own kind. */
const VIEWS = { function: FunctionView, number: NumberView, figure: FigureView } as unknown as Readonly<
  Record<AnyExercise["kind"], ComponentType<ViewProps<AnyExercise>>>
>;

interface Place {
  base: string | null;
  theme: string | null;
}

interface RootProps {
  name: { value: string | null };
  code: { value: string | null };
  seed: { value: number | null };
  place: { value: Place };
  onVerdict: (verdict: Verdict | null) => void;
}

function Root({ name, code, seed, place, onVerdict }: RootProps) {
  const exercise = exerciseNamed(name.value);
  if (exercise === null) {
    const names = EXERCISES.map((one) => one.name).join(", ");
    return (
      <p class="said wrong" role="alert">
        There is no exercise "{name.value ?? ""}". The exercises are: {names}.
      </p>
    );
  }
  const View = VIEWS[exercise.kind];
  return (
    <View
      key={exercise.name}
      exercise={exercise}
      written={code.value}
      onWritten={(written) => {
        code.value = written;
      }}
      seed={seed.value ?? 0}
      onSeed={(drawn) => {
        seed.value = drawn;
      }}
      {...place.value}
      needFigure={needFigure}
      onVerdict={onVerdict}
    />
  );
}

/**
 * Makes the element known, once a page.
 * @param figure makes `<ridgeline-figure>` known, when an exercise first needs it
 */
export function defineExercise(figure: () => Promise<unknown>): void {
  needFigure = figure;
  if (customElements.get(TAG) === undefined) {
    customElements.define(TAG, RidgelineExercise);
  }
}
