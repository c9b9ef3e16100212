/** Which screens were seen, and what was guessed on them. Seen screens are kept in this browser; guesses last a visit. */
import { type ReadonlySignal, signal } from "@preact/signals";

const KEY = "ridgeline.lessons";
const seenScreens = signal<ReadonlySet<string>>(new Set(stored()));
const guesses = signal<ReadonlyMap<string, Guess>>(new Map());

export const seen: ReadonlySignal<ReadonlySet<string>> = seenScreens;

interface Guess {
  /** The option or the estimate; null where the guess is in the figure. */
  value: number | null;
}

export const keyOf = (lesson: string, screen: string): string => `${lesson}/${screen}`;

export function markSeen(key: string): void {
  if (!seenScreens.peek().has(key)) {
    seenScreens.value = new Set([...seenScreens.peek(), key]);
    try {
      localStorage.setItem(KEY, JSON.stringify([...seenScreens.peek()]));
    } catch {
      // Storage may be forbidden: what was seen is then known until the page is closed.
    }
  }
}

/** What was guessed on a screen, once it is revealed. */
export const guessOf = (key: string): Guess | undefined => guesses.value.get(key);

export function commit(key: string, guess: Guess): void {
  guesses.value = new Map([...guesses.peek(), [key, guess]]);
}

function stored(): string[] {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(KEY) ?? "[]");
    return Array.isArray(kept) ? kept.filter((one) => typeof one === "string") : [];
  } catch {
    return [];
  }
}
