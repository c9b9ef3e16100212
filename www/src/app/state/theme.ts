/** Dark or light: what the system prefers, until the person chooses. */
import { computed, effect, signal } from "@preact/signals";

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
