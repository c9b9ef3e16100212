/** One of a few, as buttons beside each other. */
import type { Signal } from "@preact/signals";

type Props<T extends string | number | boolean> = {
  /** What is chosen, for those who do not see the buttons side by side. */
  legend: string;
  choices: readonly (readonly [value: T, title: string, tooltip?: string])[];
  class?: string;
} & ({ of: Signal<T> } | { chosen: T; choose: (one: T) => void });

export function Choice<T extends string | number | boolean>({ legend, choices, ...of }: Props<T>) {
  const chosen = "of" in of ? of.of.value : of.chosen;
  const choose = (one: T) => {
    if ("of" in of) {
      of.of.value = one;
    } else {
      of.choose(one);
    }
  };
  return (
    <fieldset class={`choice ${of.class ?? ""}`}>
      <legend class="visually-hidden">{legend}</legend>
      {choices.map(([one, title, tooltip]) => (
        <button
          key={one}
          type="button"
          title={tooltip}
          aria-pressed={chosen === one}
          onClick={() => choose(one)}
        >
          {title}
        </button>
      ))}
    </fieldset>
  );
}

/** One of many, in a list that opens. */
export function ListChoice(props: {
  title: string;
  /** Each with what tells it from the others. */
  names: readonly string[];
  shown: number;
  onShow: (i: number) => void;
}) {
  const { title, names, shown, onShow } = props;
  return (
    <label class="pair-choice">
      {title}
      <select value={shown} onChange={(event) => onShow(Number(event.currentTarget.value))}>
        {names.map((name, i) => (
          <option key={i.toString()} value={i}>
            {name}
          </option>
        ))}
      </select>
    </label>
  );
}
