/** One of a few, as buttons beside each other. */
interface Props<T extends string | number | boolean> {
  /** What is chosen, for those who do not see the buttons side by side. */
  legend: string;
  choices: readonly (readonly [value: T, title: string, tooltip?: string])[];
  chosen: T;
  choose: (one: T) => void;
  class?: string;
}

export function Choice<T extends string | number | boolean>({ legend, choices, chosen, ...of }: Props<T>) {
  return (
    <fieldset class={`choice ${of.class ?? ""}`}>
      <legend class="visually-hidden">{legend}</legend>
      {choices.map(([one, title, tooltip]) => (
        <button
          key={one}
          type="button"
          title={tooltip}
          aria-pressed={chosen === one}
          onClick={() => of.choose(one)}
        >
          {title}
        </button>
      ))}
    </fieldset>
  );
}
