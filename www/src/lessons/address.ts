/** Where the reader is, as the address says it: "#lesson=epipolar&screen=2". Empty: the contents. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { LESSONS } from "./catalogue";
import type { Lesson } from "./parts/lesson";

const hash = signal(location.hash);
const fields = computed(() => new URLSearchParams(hash.value.replace(/^#/, "")));

/** The lesson that is open; null: the contents. */
export const lesson: ReadonlySignal<Lesson | null> = computed(
  () => LESSONS.find(({ id }) => id === fields.value.get("lesson")) ?? null,
);

/** Its screen, by place; a name or number that there is not is the first. */
export const screenIndex: ReadonlySignal<number> = computed(() => {
  const said = fields.value.get("screen") ?? "";
  const named = lesson.value?.screens.findIndex(({ id }) => id === said) ?? -1;
  return Math.max(0, named);
});

/** A scene that the address names, beside the lesson; read once. */
export function linkedScene(): string | null {
  return fields.peek().get("scene");
}

export const CONTENTS = "#";

export function linkTo(id: string, screen?: string): string {
  return screen === undefined ? `#lesson=${id}` : `#lesson=${id}&screen=${screen}`;
}

/** Goes to a screen of the open lesson, by place; beyond its ends, nowhere. */
export function goTo(index: number): void {
  const now = lesson.peek();
  const screen = now?.screens[index];
  if (now != null && screen !== undefined) {
    location.hash = linkTo(now.id, screen.id);
  }
}

export function followAddress(): void {
  window.addEventListener("hashchange", () => {
    hash.value = location.hash;
  });
}
