/** Formulas and paragraphs as they are shown: MathML, each symbol in its colour. */
import type { VNode } from "preact";
import { type MathNode, parseFormula, piecesOf } from "./formula";

/** A bracket keeps its size: MathML would stretch it to the height of its row. */
const LOW = { stretchy: "false" } as unknown as { stretchy: boolean };

export function Formula({ text, block = false }: { text: string; block?: boolean }) {
  return (
    <math display={block ? "block" : "inline"} class={block ? "formula" : ""}>
      <Node of={parseFormula(text)} />
    </math>
  );
}

function Node({ of }: { of: MathNode }): VNode {
  const inside = of.text ?? of.children.map((one, i) => <Node key={i.toString()} of={one} />);
  const { symbol } = of;
  switch (of.tag) {
    case "mi": {
      const { colour = 0, form = "name" } = symbol ?? {};
      return (
        <mi mathvariant="normal" class={`s${colour} ${form}`}>
          {inside}
        </mi>
      );
    }
    case "mo":
      return <mo {...(of.isHigh !== true && LOW)}>{inside}</mo>;
    default: {
      const Tag = of.tag;
      return <Tag>{inside}</Tag>;
    }
  }
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
