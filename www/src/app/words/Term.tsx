/** A term where it stands in a text: pressed, it says what it means. */
import "./glossary.css";
import { useId } from "preact/hooks";
import { partsOf } from "./linkedText";
import { type TermId, termNamed } from "./terms";

interface Props {
  id: TermId;
  /** As the sentence has it; otherwise the term itself. */
  words?: string;
}

export function Term({ id, words }: Props) {
  const own = useId();
  const term = termNamed(id);
  if (term === null) {
    return <>{words ?? id}</>;
  }
  return (
    <>
      <button type="button" class="term" popovertarget={own}>
        {words ?? term.word}
      </button>
      <span class="meaning" id={own} popover="auto" role="note">
        <Meaning id={id} />
      </span>
    </>
  );
}

/** What a term means, and where it is from. */
export function Meaning({ id }: { id: TermId }) {
  const term = termNamed(id);
  return (
    term !== null && (
      <>
        <strong>{term.word}</strong> {term.says}{" "}
        {term.source !== "" && <span class="muted">{term.source}</span>}
      </>
    )
  );
}

/** A text with its terms. */
export function Linked({ text }: { text: string }) {
  return (
    <>
      {partsOf(text).map((part) =>
        typeof part === "string" ? part : <Term key={part.id} id={part.id as TermId} words={part.words} />,
      )}
    </>
  );
}
