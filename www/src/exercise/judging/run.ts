/** Runs what a student wrote: in a worker of its own, without the network, for a limited time. */

export type Run =
  | { kind: "answers"; answers: unknown[]; log: string[] }
  | { kind: "failed"; says: string; line: number | null; log: string[] };

const LIMIT_MS = 2000;
/** What is written with console.log is shown, so much of it. */
const MOST_LINES = 20;

/** Lines before the student's first. */
const PRELUDE = [
  `"use strict"; const log = []; let answers = []; console.log = (...words) => { if (log.length < ${MOST_LINES}) log.push(words.map((w) => typeof w === "string" ? w : JSON.stringify(w)).join(" ")); };`,
  "for (const name of ['fetch', 'XMLHttpRequest', 'WebSocket', 'EventSource', 'importScripts', 'indexedDB', 'caches']) Object.defineProperty(self, name, { value: undefined });",
];

/** A student's own names must not meet those of the frame, so that one stands inside the other. */
function program(source: string, name: string): string {
  const call = `
;self.onmessage = ({ data }) => {
  try {
    const answers = data.map((input) => ${name}(...input));
    self.postMessage({ answers, log: self.written() });
  } catch (error) {
    self.postMessage({ says: String(error), stack: String(error?.stack), log: self.written() });
  }
};`;
  return `${PRELUDE[0]} self.written = () => log;\n${PRELUDE[1]}\n{\n${source}\n${call}\n}`;
}

/** Of the program before the student's first line: the prelude, and the brace. */
const LINES_BEFORE = PRELUDE.length + 1;

interface Answered {
  answers?: unknown[];
  says?: string;
  stack?: string;
  log: string[];
}

/** Calls the function of this name with each input. */
export function run(
  source: string,
  name: string,
  inputs: readonly unknown[],
  limitMs = LIMIT_MS,
): Promise<Run> {
  const url = URL.createObjectURL(new Blob([program(source, name)], { type: "text/javascript" }));
  const worker = new Worker(url);
  return new Promise<Run>((resolve) => {
    const lines = source.split("\n").length;
    const own = (line: number) =>
      line > LINES_BEFORE && line <= LINES_BEFORE + lines ? line - LINES_BEFORE : null;
    const fail = (says: string, line: number | null, log: string[] = []) =>
      resolve({ kind: "failed", says, line, log });
    const timer = setTimeout(
      () => fail(`No answer after ${limitMs / 1000} s: does a loop never end?`, null),
      limitMs,
    );
    worker.onmessage = ({ data }: MessageEvent<Answered>) => {
      clearTimeout(timer);
      if (data.answers === undefined) {
        const line = Number(/:(\d+):\d+\)?\s*$/m.exec(data.stack ?? "")?.[1] ?? Number.NaN);
        fail(data.says ?? "", own(line), data.log);
      } else {
        resolve({ kind: "answers", answers: data.answers, log: data.log });
      }
    };
    worker.onerror = (event) => {
      event.preventDefault();
      clearTimeout(timer);
      fail(event.message || "It cannot be read.", own(event.lineno));
    };
    worker.postMessage(inputs);
  }).finally(() => {
    worker.terminate();
    URL.revokeObjectURL(url);
  });
}
