/** docs/glossary.md: all terms as Markdown, for `npm run lists`. */
import { IN_ORDER, TERMS, type Term } from "../src/app/words/terms";

export function glossaryPage(): string {
  const terms: Readonly<Record<string, Term>> = TERMS;
  const rows = IN_ORDER.map((id) => {
    const { word, says, source, see } = terms[id] as Term;
    const others = see.map((other) => `[${terms[other]?.word}](#${other})`).join(", ");
    const more = [source, others === "" ? "" : `See ${others}.`].filter((one) => one !== "").join(". ");
    return `<a id="${id}"></a>**${word}**: ${says}${more === "" ? "" : ` ${more}`}\n`;
  });
  return `# Glossary

The terms of the field that the page and the exercises use. They are linked where they stand there. This page is written by
\`npm run lists\` (in www/) from [terms.ts](../www/src/app/words/terms.ts). B99 and W96 are the papers of the
[README](../README.md).

${rows.join("\n")}`;
}
