/**
 * Formulas as they are written in lessons and figures: words with blanks between them. A word is a number, an operator, a name or a
 * symbol, of which the writer says what it is; `^` and `_` take the next word or group; `{ }` groups; `frac {a} {b}`, `sqrt {a}`,
 * `matrix { a b ; c d }`, `vec a`. "x2 ^T F x = 0".
 */
export interface Glyph {
  /** As it is written. */
  glyph: string;
  /** Vectors are upright and bold, scalars and matrices slanted, names upright. */
  form: "vector" | "letter" | "name";
  sub?: string;
  colour: 0 | 1 | 2 | 3 | 4 | 5 | 6 | 7;
}

/** What a word stands for; null where it stands for nothing. */
type Symbols = (word: string) => Glyph | null;

/** The letters of a formula beside a text that says what they mean: one is slanted, several are a name. */
export function letterOf(word: string): Glyph | null {
  return /^\p{L}+′?$/u.test(word)
    ? { glyph: word, form: /^\p{L}′?$/u.test(word) ? "letter" : "name", colour: 0 }
    : null;
}

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
  /** A bracket that is as high as what it holds; lines with sums as high as alone. */
  isHigh?: boolean;
  symbol?: Glyph;
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
  "≠": "≠",
  "∈": "∈",
  "∫": "∫",
  ";": ";",
  "/": "/",
  to: "↦",
  sum: "∑",
  min: "min",
  max: "max",
};
/** Operators with what they go over below them. */
const WITH_LIMITS: readonly string[] = ["∑", "min", "max"];
/** Names and letters that have no meaning of their own. */
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
  readonly symbolOf: Symbols;
  readonly #words: readonly string[];
  #at = 0;

  constructor(text: string, symbolOf: Symbols) {
    this.symbolOf = symbolOf;
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
export function parseFormula(text: string, symbolOf: Symbols): MathNode {
  const words = new Words(text, symbolOf);
  const row = rowUntil(words, []);
  if (words.next !== undefined) {
    throw new Error(`"${words.next}" closes nothing in "${text}"`);
  }
  return row;
}

/** Several formulas, one below the other. */
export function linesOf(texts: readonly string[], symbolOf: Symbols): MathNode {
  const lines = texts.map((text) => parseFormula(text, symbolOf));
  const [only] = lines;
  const row = (line: MathNode): MathNode => ({ tag: "mtr", children: [{ tag: "mtd", children: [line] }] });
  return lines.length === 1 && only !== undefined
    ? only
    : { tag: "mtable", isHigh: true, children: lines.map(row) };
}

function rowUntil(words: Words, ends: readonly string[]): MathNode {
  const children: MathNode[] = [];
  while (words.next !== undefined && words.next !== "}" && !ends.includes(words.next)) {
    let node = atom(words);
    while (words.next === "^" || words.next === "_") {
      const isUp = words.take() === "^";
      const script = group(words);
      const isLimit = node.tag === "mo" && WITH_LIMITS.includes(node.text ?? "");
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
  if (word === "frac") {
    return { tag: "mfrac", children: [group(words), group(words)] };
  }
  if (word === "sqrt") {
    return { tag: "msqrt", children: [group(words)] };
  }
  if (word === "matrix") {
    return matrix(words);
  }
  if (word === "vec") {
    const { symbol, ...of } = atom(words);
    return symbol === undefined ? of : { ...of, symbol: { ...symbol, form: "vector" } };
  }
  const operator = OPERATORS[word];
  if (operator !== undefined) {
    return { tag: "mo", text: operator, children: [] };
  }
  if (/^[−-]?\d[\d.]*°?$/.test(word)) {
    return { tag: "mn", text: word.replace("-", "−"), children: [] };
  }
  if (NAMES.has(word)) {
    return { tag: "mi", text: SHOWN[word] ?? word, children: [] };
  }
  if (word.startsWith('"')) {
    return { tag: "mtext", text: `\u00a0${word.slice(1, -1).replaceAll("_", "\u00a0")}\u00a0`, children: [] };
  }
  const symbol = words.symbolOf(word);
  if (symbol !== null) {
    return ofSymbol(symbol);
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

function ofSymbol(symbol: Glyph): MathNode {
  const own: MathNode = { tag: "mi", text: symbol.glyph, symbol, children: [] };
  return symbol.sub === undefined
    ? own
    : { tag: "msub", children: [own, { tag: "mi", text: symbol.sub, symbol, children: [] }] };
}
