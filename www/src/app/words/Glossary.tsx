/** All terms, by their words. */
import { Meaning } from "./Term";
import { IN_ORDER, TERMS } from "./terms";

export function Glossary() {
  return (
    <ul class="glossary" aria-label="Glossary">
      {IN_ORDER.map((id) => (
        <li key={id} id={`term-${id}`}>
          <Meaning id={id} />
          {TERMS[id].see.length > 0 && (
            <span class="see">
              {" See "}
              {TERMS[id].see.map((other, i) => (
                <>
                  {i > 0 && ", "}
                  <a href={`#term-${other}`}>{TERMS[other as keyof typeof TERMS].word}</a>
                </>
              ))}
              .
            </span>
          )}
        </li>
      ))}
    </ul>
  );
}
