/** Files that come while a project is open: a new project, or more of the present one? */
import { type ReadonlySignal, signal } from "@preact/signals";
import type { InputFile } from "../../shared/calls";
import { notify } from "../state/notices";
import { files, inspection, isDemo } from "../state/project";
import { addFiles, openFiles } from "./projectActions";

/** What becomes of files that come. */
export type Choice = "open" | "add";

const waiting = signal<InputFile[] | null>(null);
const habit = signal<Choice | null>(null);

/** The files about which the person is asked; null while nobody is. */
export const arrived: ReadonlySignal<InputFile[] | null> = waiting;
/** What was chosen for the rest of the visit; null: ask. */
export const chosenForVisit: ReadonlySignal<Choice | null> = habit;

/** Takes files in; asks where it is not plain whether they belong to the present project. */
export async function takeFiles(added: InputFile[]): Promise<void> {
  if (added.length === 0) {
    notify({
      severity: "info",
      title: "There are no files in it",
      text: "Choose a folder with photographs.",
    });
  } else if (!isWhole() || !isProject(added)) {
    await takeAs("add", added);
  } else if (habit.value !== null) {
    await takeAs(habit.value, added);
  } else {
    // Dropped on top of an open question, they are one answer.
    waiting.value = [...(waiting.value ?? []), ...added];
  }
}

/** The answer; null takes nothing. */
export async function answerArrival(choice: Choice | null, forVisit: boolean): Promise<void> {
  const added = waiting.value ?? [];
  waiting.value = null;
  if (choice !== null) {
    habit.value = forVisit ? choice : null;
    await takeAs(choice, added);
  }
}

/** Asks again. */
export function askAgain(): void {
  habit.value = null;
}

function takeAs(choice: Choice, added: InputFile[]): Promise<void> {
  return choice === "open" ? openFiles(added) : addFiles(added);
}

/** Does the present project lack nothing? What comes to one that is refused is what it lacked. */
function isWhole(): boolean {
  const isRefused = (inspection.value?.errors.length ?? 0) > 0;
  return files.value.length > 0 && (isDemo.value || !isRefused);
}

/** Could these be a project of their own? Fewer than three photographs, or an orientation alone, cannot. */
function isProject(added: readonly InputFile[]): boolean {
  const photographs = added.filter(({ path }) => PHOTOGRAPH.test(path));
  return photographs.length >= 3 || added.some(({ path }) => ARCHIVE.test(path));
}

const PHOTOGRAPH = /\.(?:jpe?g|png|tiff?|webp|heic|heif|dng|bmp|jp2)$/i;
const ARCHIVE = /\.(?:zip|7z|rar|tar|t?gz|tgz)$/i;
