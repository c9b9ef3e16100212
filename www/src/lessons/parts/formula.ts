/**
 * Formulas as they are written in lessons: words with blanks between them. A word is a symbol (`symbols.ts`), a number, an operator
 * or a name; `^` and `_` take the next word or group; `{ }` groups; `frac {a} {b}`, `sqrt {a}`, `matrix { a b ; c d }`, `hat {a}`.
 * "x2 ^T F x = 0".
 */
import { type MathSymbol, symbolOf } from "./symbols";

export interface MathNode {
  tag:
    | "mi"
    | "mn"
    | "mo"
    | "mrow"
    | "mfrac"
    | "msqrt"
    | "msup"
    | "msub"
    | "munder"
    | "mtable"
    | "mtr"
    | "mtd"
    | "mtext";
  text?: string;
  /** A bracket that is as high as what it holds. */
  isHigh?: boolean;
  symbol?: MathSymbol;
  children: readonly MathNode[];
}

const OPERATORS: Readonly<Record<string, string>> = {
  "=": "=",
  "~": "≃",
  "+": "+",
  "-": "−",
  "*": "·",
  "×": "×",
  "(": "(",
  ")": ")",
  "[": "[",
  "]": "]",
  "|": "|",
  ",": ",",
  "<": "<",
  ">": ">",
  ">=": "≥",
  "≈": "≈",
  "/": "/",
  to: "↦",
  sum: "∑",
  min: "min",
};
/** Names and letters that have no meaning of their own in a lesson. */
const NAMES = new Set([
  "log",
  "ln",
  "exp",
  "sin",
  "cos",
  "tan",
  "det",
  "I3",
  "0v",
  "T",
  "-1",
  "-T",
  "2",
  "+",
  "'",
]);
const SHOWN: Readonly<Record<string, string>> = { I3: "I", "0v": "0", "-1": "−1", "-T": "−T", "'": "′" };

class Words {
  readonly #words: readonly string[];
  #at = 0;

  constructor(text: string) {
    this.#words = text
      .replaceAll(/([{}^;])/g, " $1 ")
      .split(/\s+/)
      .filter((word) => word !== "");
  }

  get next(): string | undefined {
    return this.#words[this.#at];
  }

  take(): string {
    const word = this.next;
    if (word === undefined) {
      throw new Error("the formula ends too early");
    }
    this.#at += 1;
    return word;
  }

  expect(word: string): void {
    const found = this.take();
    if (found !== word) {
      throw new Error(`expected "${word}", found "${found}"`);
    }
  }
}

/** Reads a formula; throws where a word has no meaning. */
export function parseFormula(text: string): MathNode {
  const words = new Words(text);
  const row = rowUntil(words, []);
  if (words.next !== undefined) {
    throw new Error(`"${words.next}" closes nothing in "${text}"`);
  }
  return row;
}

/** The symbols that a formula uses, in its order. */
export function symbolsIn(node: MathNode): MathSymbol[] {
  return [...(node.symbol === undefined ? [] : [node.symbol]), ...node.children.flatMap(symbolsIn)];
}

function rowUntil(words: Words, ends: readonly string[]): MathNode {
  const children: MathNode[] = [];
  while (words.next !== undefined && words.next !== "}" && !ends.includes(words.next)) {
    let node = atom(words);
    while (words.next === "^" || words.next === "_") {
      const isUp = words.take() === "^";
      const script = group(words);
      const isLimit = node.tag === "mo" && (node.text === "∑" || node.text === "min");
      node = { tag: isUp ? "msup" : isLimit ? "munder" : "msub", children: [node, script] };
    }
    children.push(node);
  }
  return children.length === 1 ? (children[0] as MathNode) : { tag: "mrow", children };
}

function group(words: Words): MathNode {
  if (words.next !== "{") {
    return atom(words);
  }
  words.take();
  const row = rowUntil(words, []);
  words.expect("}");
  return row;
}

function atom(words: Words): MathNode {
  if (words.next === "{") {
    return group(words);
  }
  const word = words.take();
  const symbol = symbolOf(word);
  if (symbol !== null) {
    return ofSymbol(symbol);
  }
  if (word === "frac") {
    return { tag: "mfrac", children: [group(words), group(words)] };
  }
  if (word === "sqrt") {
    return { tag: "msqrt", children: [group(words)] };
  }
  if (word === "matrix") {
    return matrix(words);
  }
  const operator = OPERATORS[word];
  if (operator !== undefined) {
    return { tag: "mo", text: operator, children: [] };
  }
  if (/^[−-]?\d[\d.]*( ?[\d.])*$/.test(word)) {
    return { tag: "mn", text: word.replace("-", "−"), children: [] };
  }
  if (NAMES.has(word)) {
    return { tag: "mi", text: SHOWN[word] ?? word, children: [] };
  }
  if (word.startsWith('"')) {
    return { tag: "mtext", text: `\u00a0${word.slice(1, -1).replaceAll("_", "\u00a0")}\u00a0`, children: [] };
  }
  throw new Error(`"${word}" has no meaning: neither symbol, number nor operator`);
}

function matrix(words: Words): MathNode {
  words.expect("{");
  const rows: MathNode[] = [];
  let cells: MathNode[] = [];
  const endRow = () => {
    rows.push({ tag: "mtr", children: cells });
    cells = [];
  };
  while (words.next !== "}") {
    if (words.next === ";") {
      words.take();
      endRow();
    } else {
      cells.push({ tag: "mtd", children: [group(words)] });
    }
  }
  endRow();
  words.take();
  const bracket = (text: string): MathNode => ({ tag: "mo", text, isHigh: true, children: [] });
  return { tag: "mrow", children: [bracket("("), { tag: "mtable", children: rows }, bracket(")")] };
}

function ofSymbol(symbol: MathSymbol): MathNode {
  const own: MathNode = { tag: "mi", text: symbol.glyph, symbol, children: [] };
  return symbol.sub === undefined
    ? own
    : { tag: "msub", children: [own, { tag: "mi", text: symbol.sub, symbol, children: [] }] };
}

/** A paragraph in pieces: words, *emphasis* and $formulas$. */
export interface Piece {
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
    .flatMap(({ text }) => symbolsIn(parseFormula(text)));
  return [...new Set(all)];
}
