/**
 * The page stays at hand while the pipeline runs: no task of the main thread takes over 100 ms of the processor. By the clock
 * a task is longer wherever other programs, or graphics drawn in software, have the cores.
 */
import { expect, test } from "@playwright/test";
import { openDemo, stage, waitForStage } from "./helpers";

const MOST_MS = 100;

/** An event of Chromium's trace format, as far as it is read here; times in microseconds. */
interface TraceEvent {
  name: string;
  pid: number;
  tid: number;
  ts: number;
  dur?: number;
  /** Of these, those that the thread had a processor. */
  tdur?: number;
  args?: { name?: string };
}

interface Task {
  start_ms: number;
  wall_ms: number;
  processor_ms: number;
  /** What took the largest part of it. */
  within: string;
}

/** The tasks of the pages' main threads that took over half of `MOST_MS`, in order. */
function tasksOf(trace: Buffer): Task[] {
  const { traceEvents } = JSON.parse(trace.toString()) as { traceEvents: TraceEvent[] };
  const mains = traceEvents.filter(
    ({ name, args }) => name === "thread_name" && args?.name === "CrRendererMain",
  );
  const ofMain = traceEvents.filter(
    ({ pid, tid, tdur = 0 }) =>
      tdur > MOST_MS * 500 && mains.some((main) => main.pid === pid && main.tid === tid),
  );
  const first = Math.min(...traceEvents.filter(({ ts }) => ts > 0).map(({ ts }) => ts));
  return ofMain
    .filter(({ name }) => name === "ThreadControllerImpl::RunTask")
    .sort((a, b) => a.ts - b.ts)
    .map(({ ts, dur = 0, tdur = 0 }) => ({
      start_ms: (ts - first) / 1000,
      wall_ms: dur / 1000,
      processor_ms: tdur / 1000,
      within: ofMain
        .filter((event) => event.ts >= ts && event.ts < ts + dur)
        .map(({ name }) => name)
        .join(" > "),
    }));
}

test("nothing holds the page up while the pipeline runs", { tag: "@alone" }, async ({ page, browser }) => {
  // With a core left for the page, as on any machine of more than two.
  await page.addInitScript(() => {
    Object.defineProperty(navigator, "hardwareConcurrency", { value: 1 });
  });
  await page.goto("/");
  await openDemo(page);
  await expect(stage(page, "segments")).toHaveAttribute("data-status", /running|done/);
  await browser.startTracing(page, { categories: ["toplevel", "devtools.timeline"] });
  await waitForStage(page, "model");
  const tasks = tasksOf(await browser.stopTracing());
  test.info().annotations.push({ type: "long tasks", description: JSON.stringify(tasks) });
  expect(tasks.filter(({ processor_ms }) => processor_ms > MOST_MS)).toEqual([]);
});

test("a task that holds the page up is seen", { tag: "@alone" }, async ({ page, browser }) => {
  await browser.startTracing(page, { categories: ["toplevel", "devtools.timeline"] });
  await page.evaluate(async (ms) => {
    await new Promise<void>((resolve) => {
      setTimeout(() => {
        for (const end = performance.now() + ms; performance.now() < end; ) {
          // Computes.
        }
        resolve();
      });
    });
  }, 5 * MOST_MS);
  const tasks = tasksOf(await browser.stopTracing());
  expect(tasks.filter(({ processor_ms }) => processor_ms > MOST_MS)).toHaveLength(1);
});
