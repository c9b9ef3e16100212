/** One of a few, as buttons beside each other. */
interface Props<T extends string> {
  /** What is chosen, for those who do not see the buttons side by side. */
  legend: string;
  choices: readonly (readonly [T, string])[];
  chosen: T;
  choose: (one: T) => void;
}

export function Choice<T extends string>({ legend, choices, chosen, choose }: Props<T>) {
  return (
    <fieldset class="choice">
      <legend class="visually-hidden">{legend}</legend>
      {choices.map(([one, title]) => (
        <button key={one} type="button" aria-pressed={chosen === one} onClick={() => choose(one)}>
          {title}
        </button>
      ))}
    </fieldset>
  );
}
