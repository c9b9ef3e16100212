/** Dark or light: what the system prefers, until the person chooses. */
import { computed, effect, signal } from "@preact/signals";
import { keep, kept } from "./keptChoice";

type Theme = "light" | "dark";

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
  keep(STORAGE_KEY, chosenTheme.value);
}

function storedTheme(): Theme | null {
  const stored = kept(STORAGE_KEY);
  return stored === "dark" || stored === "light" ? stored : null;
}
