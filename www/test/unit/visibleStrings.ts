/** Every text of the page that a person may read: what stands between tags, in attributes and in string literals. */
import { readdirSync, readFileSync } from "node:fs";
import { parseSync } from "vite";

export interface VisibleString {
  at: string;
  text: string;
}

interface Node {
  type: string;
  start: number;
  [key: string]: unknown;
}

const SOURCE = new URL("../../src/", import.meta.url);

/** Attributes that name things for the style sheet, the browser or the tests. */
const UNSEEN = new Set([
  "class",
  "className",
  "id",
  "type",
  "role",
  "href",
  "d",
  "testid",
  "data-testid",
  "for",
]);

/** Types of TypeScript that hold an expression; nothing in the others is shown. */
const TRANSPARENT = new Set(["TSAsExpression", "TSSatisfiesExpression", "TSNonNullExpression"]);

export function visibleStrings(): VisibleString[] {
  const files = readdirSync(SOURCE, { recursive: true, encoding: "utf8" });
  return files
    .filter((file) => /\.tsx?$/.test(file) && !file.startsWith("pkg"))
    .flatMap((file) => stringsOf(file, readFileSync(new URL(file, SOURCE), "utf8")));
}

/** The strings of one file; what is computed within one stands as `{}`. */
export function stringsOf(file: string, source: string): VisibleString[] {
  const found: VisibleString[] = [];
  const keep = (node: Node, text: string) => {
    const line = source.slice(0, node.start).split("\n").length;
    found.push({ at: `${file}:${line}`, text: text.replace(/\s+/g, " ").trim() });
  };
  const visit = (value: unknown): void => {
    if (Array.isArray(value)) {
      value.forEach(visit);
    } else if (isNode(value)) {
      visitNode(value);
    }
  };
  const visitNode = (node: Node): void => {
    const isType = node.type.startsWith("TS") && !TRANSPARENT.has(node.type);
    if (isType || node.type === "ImportDeclaration" || isUnseen(node)) {
      return;
    }
    if (node.type === "JSXElement") {
      keep(node, (node["children"] as Node[]).map(textOfChild).join(""));
    } else if (node.type === "TemplateLiteral") {
      const parts = node["quasis"] as { value: { cooked: string } }[];
      keep(node, parts.map(({ value }) => value.cooked).join("{}"));
    } else if (node.type === "Literal" && typeof node["value"] === "string") {
      keep(node, node["value"]);
    }
    Object.values(node).forEach(visit);
  };
  visit(parseSync(file, source).program);
  return found.filter(({ text }) => /[a-z]{2}/i.test(text));
}

function textOfChild(child: Node): string {
  if (child.type === "JSXText") {
    return String(child["value"]);
  }
  const inner = child["expression"] as Node | undefined;
  return inner?.type === "Literal" ? String(inner["value"]) : "{}";
}

function isUnseen(node: Node): boolean {
  const name = node["name"] as { name?: unknown } | undefined;
  return node.type === "JSXAttribute" && UNSEEN.has(String(name?.name));
}

function isNode(value: unknown): value is Node {
  return typeof value === "object" && value !== null && typeof (value as Node).type === "string";
}
