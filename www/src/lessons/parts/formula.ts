/** Formulas of the lessons, whose words are symbols with one meaning each, and paragraphs that hold some. */
import { type MathNode, parseFormula } from "../../app/words/formula";
import { type MathSymbol, symbolOf } from "./symbols";

/** Reads a formula; throws where a word has no meaning. */
export function lessonFormula(text: string): MathNode {
  return parseFormula(text, symbolOf);
}

/** The symbols that a formula uses, in its order. */
export function symbolsIn(node: MathNode): MathSymbol[] {
  const own = node.symbol === undefined ? [] : [node.symbol as MathSymbol];
  return [...own, ...node.children.flatMap(symbolsIn)];
}

/** A paragraph in pieces: words, *emphasis* and $formulas$. */
interface Piece {
  kind: "words" | "emphasis" | "formula";
  text: string;
  /** The punctuation that stays with a formula at the end of a line. */
  after: string;
}

export function piecesOf(paragraph: string): Piece[] {
  const parts = paragraph.split(/(\$[^$]+\$[.,:;?!)]*|\*[^*]+\*)/).filter((part) => part !== "");
  return parts.map((part): Piece => {
    const [, formula, after = ""] = /^\$([^$]+)\$([.,:;?!)]*)$/.exec(part) ?? [];
    if (formula !== undefined) {
      return { kind: "formula", text: formula, after };
    }
    const emphasis = /^\*([^*]+)\*$/.exec(part)?.[1];
    return emphasis !== undefined
      ? { kind: "emphasis", text: emphasis, after: "" }
      : { kind: "words", text: part, after: "" };
  });
}

/** The symbols that some paragraphs use, each once. */
export function symbolsOfText(paragraphs: readonly string[]): MathSymbol[] {
  const all = paragraphs
    .flatMap(piecesOf)
    .filter(({ kind }) => kind === "formula")
    .flatMap(({ text }) => symbolsIn(lessonFormula(text)));
  return [...new Set(all)];
}
