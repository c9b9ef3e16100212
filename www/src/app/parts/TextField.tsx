/**
 * A line of text that is taken on Enter or when it is left, with a note below it: why what was typed is none, or a hint. What is
 * typed stays while the page around it is drawn anew.
 */
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";

/** What a text means, or why it means nothing. */
export type Parsed<T> = { value: T } | { error: string };

interface Props<T> {
  id: string;
  /** What holds now. */
  value: string;
  placeholder?: string;
  inputMode?: "decimal" | "text";
  parse: (text: string) => Parsed<T>;
  onValue: (value: T) => void;
  hint?: string;
  /** What is proposed while something is typed, each with its name. */
  choices?: readonly (readonly [string, string])[];
  /** What stands between the field and its note. */
  children?: ComponentChildren;
}

export function TextField<T>(props: Props<T>) {
  const { id, value, placeholder = "", inputMode = "text", parse, onValue, hint = "", choices = [] } = props;
  const [typed, setTyped] = useState<string | null>(null);
  const [error, setError] = useState("");
  const take = (text: string) => {
    const parsed = parse(text);
    setError("error" in parsed ? parsed.error : "");
    if ("value" in parsed) {
      onValue(parsed.value);
      setTyped(null);
    }
  };
  return (
    <>
      <input
        id={id}
        type="text"
        inputMode={inputMode}
        value={typed ?? value}
        placeholder={placeholder}
        aria-invalid={error !== ""}
        aria-describedby={`${id}-note`}
        list={choices.length === 0 ? undefined : `${id}-choices`}
        onInput={(event) => setTyped(event.currentTarget.value)}
        onChange={(event) => take(event.currentTarget.value)}
      />
      {choices.length > 0 && (
        <datalist id={`${id}-choices`}>
          {choices.map(([one, name]) => (
            <option key={one} value={one} label={name} />
          ))}
        </datalist>
      )}
      {props.children}
      <span id={`${id}-note`} class={error === "" ? "muted note" : "error note"}>
        {error || hint}
      </span>
    </>
  );
}

/** A number, with a point or a comma. */
export function parseNumber(text: string): Parsed<number> {
  const value = Number(text.trim().replace(",", "."));
  return text.trim() === "" || !Number.isFinite(value) ? { error: "A number is expected" } : { value };
}

/** A number above 0; nothing is null. */
export function parsePositive(text: string): Parsed<number | null> {
  const parsed = text.trim() === "" ? { value: null } : parseNumber(text);
  return "value" in parsed && (parsed.value ?? 1) > 0 ? parsed : { error: "A number above 0" };
}
