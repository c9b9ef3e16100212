/** What the person is told of, in notices and, for screen readers, in an announcement. */
import { type ReadonlySignal, signal } from "@preact/signals";
import type { AgreementReport } from "../../shared/records";

/** Options of the command line that a message of the core asks for, and the files that it is about. */
export interface Asked {
  options: readonly string[];
  files: readonly string[];
}

export interface Notice {
  id: number;
  severity: "error" | "warning" | "info";
  title: string;
  text: string;
  /** What to do about it. */
  advice?: string;
  /** What the images say of the orientation. */
  orientationCheck?: AgreementReport;
  /** What its words ask for. */
  asked?: Asked;
  /** Something that can be done about it. */
  action?: { name: string; run: () => void };
  /** What it is about: of the browser it stays when the project changes. Of the project, unless it is said. */
  about?: "project" | "browser";
}

const shown = signal<Notice[]>([]);
const said = signal("");

export const notices: ReadonlySignal<Notice[]> = shown;
/** What a screen reader is told of: the last thing that happened. */
export const announcement: ReadonlySignal<string> = said;

let lastNotice = 0;

export function notify(notice: Omit<Notice, "id">): void {
  lastNotice += 1;
  shown.value = withNotice(shown.value, { ...notice, id: lastNotice });
}

export function dismiss(id: number): void {
  shown.value = shown.value.filter((notice) => notice.id !== id);
}

/** Dismisses the notices that offer to do this. */
export function dismissOffers(name: string): void {
  shown.value = shown.value.filter(({ action }) => action?.name !== name);
}

/** Dismisses all notices about this. */
export function dismissAbout(what: "project" | "browser"): void {
  shown.value = shown.value.filter(({ about = "project" }) => about !== what);
}

export function announce(text: string): void {
  said.value = text;
}

/** The notices with another one, which stands for one that says the same. */
export function withNotice(shown: Notice[], added: Notice): Notice[] {
  const same = ({ severity, title, text }: Notice) =>
    severity === added.severity && title === added.title && text === added.text;
  return [...shown.filter((notice) => !same(notice)), added];
}
