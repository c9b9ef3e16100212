/** A line of text that is taken on Enter or when it is left; what is typed stays while the page around it is drawn anew. */
import { useState } from "preact/hooks";

interface Props {
  id: string;
  /** What holds now. */
  value: string;
  placeholder?: string;
  inputMode?: "decimal" | "text";
  isInvalid: boolean;
  /** What is proposed while something is typed, each with its name. */
  choices?: readonly (readonly [string, string])[];
  /** Takes what was typed, or rejects it: then it stays to be mended. */
  onTake: (text: string) => boolean;
}

export function TextField({
  id,
  value,
  placeholder = "",
  inputMode = "text",
  isInvalid,
  onTake,
  choices = [],
}: Props) {
  const [typed, setTyped] = useState<string | null>(null);
  const field = (
    <input
      id={id}
      type="text"
      inputMode={inputMode}
      value={typed ?? value}
      placeholder={placeholder}
      aria-invalid={isInvalid}
      aria-describedby={`${id}-note`}
      list={choices.length === 0 ? undefined : `${id}-choices`}
      onInput={(event) => setTyped(event.currentTarget.value)}
      onChange={(event) => {
        if (onTake(event.currentTarget.value)) {
          setTyped(null);
        }
      }}
    />
  );
  return choices.length === 0 ? (
    field
  ) : (
    <>
      {field}
      <datalist id={`${id}-choices`}>
        {choices.map(([one, name]) => (
          <option key={one} value={one} label={name} />
        ))}
      </datalist>
    </>
  );
}
