/** `<ridgeline-exercise name="triangulate">`: write a function, and hear whether it is right or which mistake it makes. */
import { signal } from "@preact/signals";
import { render } from "preact";
import baseCss from "../app/parts/base.css?inline";
import { hostSheet } from "../element/hostSheet";
import { type Checked, ExerciseView } from "./ExerciseView";
import exerciseCss from "./exercise.css?inline";
import { EXERCISES, exerciseNamed } from "./tasks/index";

const TAG = "ridgeline-exercise";
const styleSheet = hostSheet(baseCss, exerciseCss);

export class RidgelineExercise extends HTMLElement {
  static readonly observedAttributes = ["name"];

  readonly #shadow = this.attachShadow({ mode: "open" });
  readonly #name = signal<string | null>(null);
  readonly #code = signal<string | null>(null);

  connectedCallback(): void {
    this.#shadow.adoptedStyleSheets = [styleSheet()];
    render(<Root name={this.#name} code={this.#code} onChecked={(of) => this.#tell(of)} />, this.#shadow);
  }

  disconnectedCallback(): void {
    render(null, this.#shadow);
  }

  attributeChangedCallback(_: string, before: string | null, now: string | null): void {
    this.#name.value = now;
    // What was written before the element had its name belongs to it.
    if (before !== null && before !== now) {
      this.#code.value = null;
    }
  }

  /** What stands in the editor. */
  get code(): string {
    return this.#code.peek() ?? exerciseNamed(this.getAttribute("name"))?.starter ?? "";
  }

  set code(code: string) {
    this.#code.value = code;
  }

  #tell(detail: Checked): void {
    this.dispatchEvent(new CustomEvent("ridgeline-checked", { detail, bubbles: true, composed: true }));
  }
}

interface RootProps {
  name: { value: string | null };
  code: { value: string | null };
  onChecked: (checked: Checked) => void;
}

function Root({ name, code, onChecked }: RootProps) {
  const exercise = exerciseNamed(name.value);
  if (exercise === null) {
    const names = EXERCISES.map((one) => one.name).join(", ");
    return (
      <p class="said wrong" role="alert">
        There is no exercise "{name.value ?? ""}". The exercises are: {names}.
      </p>
    );
  }
  return (
    <ExerciseView
      key={exercise.name}
      exercise={exercise}
      code={code.value ?? exercise.starter}
      onCode={(written) => {
        code.value = written;
      }}
      onChecked={onChecked}
    />
  );
}

/** Makes the element known, once a page. */
export function defineExercise(): void {
  if (customElements.get(TAG) === undefined) {
    customElements.define(TAG, RidgelineExercise);
  }
}
