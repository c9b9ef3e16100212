/** Where a figure is: what is selected in it and how it is turned. As attributes, in events and in links, by the page's own words. */
import { formatSelection, parseSelection } from "../shared/selection";

/** All null: as the figure shows itself first. */
export interface FigureState {
  /** "line:12", "segment:0.44" (view first), "side:12.left", "facet:3" ... */
  select: string | null;
  /** Angle of the half-plane, degrees. */
  theta: number | null;
  /** The candidate that the segment is compared with, and where on the segment, 0 to 1. */
  point: readonly [candidate: number, at: number] | null;
  view: number | null;
  /** Which building or plane of W96. */
  plane: number | null;
}

export const FIRST_STATE: FigureState = { select: null, theta: null, point: null, view: null, plane: null };

/** The names of the attributes that hold it. */
export const STATE_NAMES = ["select", "theta", "point", "view", "plane"] as const;

/** Reads a state from its words; what is no state is left out. */
export function readState(word: (name: (typeof STATE_NAMES)[number]) => string | null): FigureState {
  const picked = parseSelection(word("select"));
  const point = numbersOf(word("point"));
  return {
    select: picked === null ? null : formatSelection(picked),
    theta: numbersOf(word("theta"))[0] ?? null,
    point: point.length === 2 ? (point as [number, number]) : null,
    view: wholeOf(word("view")),
    plane: wholeOf(word("plane")),
  };
}

/** "select=line%3A12&theta=31.5"; empty for the first state. */
export function formatState(state: FigureState): string {
  const fields = new URLSearchParams();
  for (const name of STATE_NAMES) {
    const value = state[name];
    if (value !== null) {
      fields.set(name, typeof value === "object" ? value.join() : String(value));
    }
  }
  return fields.toString();
}

export function parseState(text: string): FigureState {
  const fields = new URLSearchParams(text);
  return readState((name) => fields.get(name));
}

/** The state of a figure in the address of its page, behind "#"; null where it names none. */
export function stateInAddress(hash: string, figure: string): FigureState | null {
  const text = new URLSearchParams(hash.replace(/^#/, "")).get(figure);
  return text === null ? null : parseState(text);
}

/** The address of a page that opens a figure in a state. */
export function addressOf(page: string, figure: string, state: FigureState): string {
  const url = new URL(page);
  url.hash = new URLSearchParams([[figure, formatState(state)]]).toString();
  return url.href;
}

function numbersOf(text: string | null): number[] {
  const words = text === null ? [] : text.split(",");
  const found = words.map((word) => (word.trim() === "" ? Number.NaN : Number(word)));
  return found.every(Number.isFinite) ? found : [];
}

function wholeOf(text: string | null): number | null {
  return text !== null && /^\d{1,6}$/.test(text) ? Number(text) : null;
}
