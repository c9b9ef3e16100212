/** Texts in which terms are marked: "the [[eave]]", "their [[half-plane|half-planes]]". */
import { termNamed } from "./terms";

export type Part = string | { id: string; words: string };

const MARK = /\[\[([a-z-]+)(?:\|([^\]]+))?\]\]/;

/** The text in parts: plain words, and terms. */
export function partsOf(text: string): Part[] {
  const pieces = text.split(new RegExp(MARK, "g"));
  return pieces
    .flatMap((piece, i): Part[] => {
      if (i % 3 === 0) {
        return [piece ?? ""];
      }
      return i % 3 === 1 ? [{ id: piece, words: pieces[i + 1] ?? termNamed(piece)?.word ?? piece }] : [];
    })
    .filter((part) => part !== "");
}

/** The words alone. */
export function plain(text: string): string {
  return partsOf(text)
    .map((part) => (typeof part === "string" ? part : part.words))
    .join("");
}

/** As HTML and SVG have it. */
export function escaped(text: string): string {
  const names: Record<string, string> = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" };
  return text.replace(/[&<>"]/g, (one) => names[one] as string);
}
