/** Dark or light: what the system prefers, until the person chooses. */
import { computed, effect, signal } from "@preact/signals";
import { textScale } from "./state";

export type Theme = "light" | "dark";

const STORAGE_KEY = "ridgeline.theme";
const prefersDark = window.matchMedia("(prefers-color-scheme: dark)");

const systemTheme = signal<Theme>(prefersDark.matches ? "dark" : "light");
const chosenTheme = signal<Theme | null>(storedTheme());

export const theme = computed<Theme>(() => chosenTheme.value ?? systemTheme.value);

prefersDark.addEventListener("change", (event) => {
  systemTheme.value = event.matches ? "dark" : "light";
});

effect(() => {
  document.documentElement.dataset["theme"] = theme.value;
});

/** Sizes of text and controls: the second is for projectors. */
const SCALES = [1, 1.15, 1.3, 1.5] as const;
const SCALE_KEY = "ridgeline.text";

textScale.value = storedScale();

effect(() => {
  document.documentElement.style.setProperty("--scale", String(textScale.value));
});

/** The next larger text; after the largest, the usual one. */
export function biggerText(): void {
  const next = SCALES[(SCALES.indexOf(textScale.value as (typeof SCALES)[number]) + 1) % SCALES.length] ?? 1;
  textScale.value = next;
  try {
    localStorage.setItem(SCALE_KEY, String(next));
  } catch {
    // As for the theme.
  }
}

function storedScale(): number {
  try {
    const stored = Number(localStorage.getItem(SCALE_KEY));
    return SCALES.find((scale) => scale === stored) ?? 1;
  } catch {
    return 1;
  }
}

export function toggleTheme(): void {
  chosenTheme.value = theme.value === "dark" ? "light" : "dark";
  try {
    localStorage.setItem(STORAGE_KEY, chosenTheme.value);
  } catch {
    // Storage may be forbidden: the choice then lasts until the page is closed.
  }
}

function storedTheme(): Theme | null {
  try {
    const stored = localStorage.getItem(STORAGE_KEY);
    return stored === "dark" || stored === "light" ? stored : null;
  } catch {
    return null;
  }
}
