/** A line of text that is taken on Enter or when it is left; what is typed stays while the page around it is drawn anew. */
import { useState } from "preact/hooks";

interface Props {
  id: string;
  /** What holds now. */
  value: string;
  placeholder?: string;
  inputMode?: "decimal" | "text";
  isInvalid: boolean;
  /** Takes what was typed, or rejects it: then it stays to be mended. */
  onTake: (text: string) => boolean;
}

export function TextField({ id, value, placeholder = "", inputMode = "text", isInvalid, onTake }: Props) {
  const [typed, setTyped] = useState<string | null>(null);
  return (
    <input
      id={id}
      type="text"
      inputMode={inputMode}
      value={typed ?? value}
      placeholder={placeholder}
      aria-invalid={isInvalid}
      aria-describedby={`${id}-note`}
      onInput={(event) => setTyped(event.currentTarget.value)}
      onChange={(event) => {
        if (onTake(event.currentTarget.value)) {
          setTyped(null);
        }
      }}
    />
  );
}
