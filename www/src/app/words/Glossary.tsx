/** All terms, by their words, and those that a search finds. */
import { useState } from "preact/hooks";
import { spelledOut } from "./papers";
import { Meaning } from "./Term";
import { IN_ORDER, TERMS } from "./terms";

export function Glossary() {
  const [sought, seek] = useState("");
  const found = IN_ORDER.filter((id) =>
    `${TERMS[id].word} ${TERMS[id].says}`.toLowerCase().includes(sought.trim().toLowerCase()),
  );
  return (
    <>
      <p>
        <input
          type="search"
          aria-label="Search the glossary"
          placeholder="Search"
          value={sought}
          onInput={(event) => seek(event.currentTarget.value)}
        />{" "}
        <span class="muted">
          {spelledOut("B99")} and {spelledOut("W96")} are the two papers.
        </span>
      </p>
      <ul class="glossary" aria-label="Glossary">
        {found.map((id) => (
          <li key={id} id={`term-${id}`}>
            <Meaning id={id} />
            {TERMS[id].see.length > 0 && (
              <span class="see">
                {" See "}
                {TERMS[id].see.map((other, i) => (
                  <>
                    {i > 0 && ", "}
                    <a href={`#term-${other}`} onClick={() => seek("")}>
                      {TERMS[other as keyof typeof TERMS].word}
                    </a>
                  </>
                ))}
                .
              </span>
            )}
          </li>
        ))}
      </ul>
      {found.length === 0 && <p>No term has these words.</p>}
    </>
  );
}
