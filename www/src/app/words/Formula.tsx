/** Formulas as they are shown: MathML, each symbol in its colour. */
import type { VNode } from "preact";
import type { MathNode } from "./formula";

/** A bracket keeps its size: MathML would stretch it to the height of its row. */
const LOW = { stretchy: "false" } as unknown as { stretchy: boolean };

export function MathMl({ of, block = false }: { of: MathNode; block?: boolean }) {
  return (
    <math display={block ? "block" : "inline"} class={block ? "formula" : ""}>
      <Node of={of} />
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
    case "mtable":
      return <mtable {...(of.isHigh === true && { displaystyle: true })}>{inside}</mtable>;
    default: {
      const Tag = of.tag;
      return <Tag>{inside}</Tag>;
    }
  }
}
