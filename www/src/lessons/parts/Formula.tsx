/** Formulas and paragraphs of the lessons as they are shown. */
import { MathMl } from "../../app/words/Formula";
import { lessonFormula, piecesOf } from "./formula";

export function Formula({ text, block = false }: { text: string; block?: boolean }) {
  return <MathMl of={lessonFormula(text)} block={block} />;
}

export function Paragraph({ text }: { text: string }) {
  return (
    <p>
      <Pieces text={text} />
    </p>
  );
}

export function Pieces({ text }: { text: string }) {
  return (
    <>
      {piecesOf(text).map(({ kind, text: inner, after }, i) => {
        const key = `${i} ${kind}`;
        return kind === "formula" ? (
          <span key={key} class="nowrap">
            <Formula text={inner} />
            {after}
          </span>
        ) : kind === "emphasis" ? (
          <em key={key}>{inner}</em>
        ) : (
          inner
        );
      })}
    </>
  );
}
