/** The page stays at hand while the pipeline runs: no task of the main thread over 100 ms. */
import { expect, test } from "@playwright/test";
import { openDemo, waitForStage } from "./helpers";

const MOST_MS = 100;

interface LongTask {
  stage: string;
  ms: number;
  /** Of these, waiting for WebGL, which the tests' browser computes in software. */
  glMs: number;
}

declare global {
  interface Window {
    longTasks: LongTask[];
  }
}

/** Notes long tasks while a stage runs, and how long each waited for WebGL. */
function observe(): void {
  const waits: [start: number, ms: number][] = [];
  let depth = 0;
  const timed = <T>(call: () => T): T => {
    const start = performance.now();
    depth += 1;
    try {
      return call();
    } finally {
      depth -= 1;
      if (depth === 0) {
        waits.push([start, performance.now() - start]);
      }
    }
  };
  const gl = WebGL2RenderingContext.prototype as unknown as Record<string, unknown>;
  for (const name of Object.getOwnPropertyNames(gl)) {
    const { value } = Object.getOwnPropertyDescriptor(gl, name) ?? {};
    if (typeof value === "function" && name !== "constructor") {
      gl[name] = function (this: unknown, ...args: unknown[]) {
        return timed(() => value.apply(this, args));
      };
    }
  }
  for (const side of ["width", "height"]) {
    const own = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, side) as PropertyDescriptor;
    Object.defineProperty(HTMLCanvasElement.prototype, side, {
      ...own,
      set(this: HTMLCanvasElement, value: number) {
        timed(() => own.set?.call(this, value));
      },
    });
  }
  window.longTasks = [];
  new PerformanceObserver((list) => {
    const running = document.querySelector<HTMLElement>('[data-status="running"]');
    for (const { startTime, duration } of list.getEntries()) {
      const inside = waits.filter(([start]) => start >= startTime && start < startTime + duration);
      const glMs = inside.reduce((sum, [, ms]) => sum + ms, 0);
      if (running !== null) {
        window.longTasks.push({ stage: running.dataset["stage"] ?? "", ms: duration, glMs });
      }
    }
  }).observe({ entryTypes: ["longtask"] });
}

test("nothing holds the page up while the pipeline runs", { tag: "@alone" }, async ({ page }) => {
  await page.addInitScript(observe);
  // With a core left for the page, as on any machine of more than two.
  await page.addInitScript(() => {
    Object.defineProperty(navigator, "hardwareConcurrency", { value: 1 });
  });
  await page.goto("/");
  await openDemo(page);
  await waitForStage(page, "model");
  const tasks = await page.evaluate(() => window.longTasks);
  test.info().annotations.push({ type: "long tasks", description: JSON.stringify(tasks) });
  expect(tasks.filter(({ ms, glMs }) => ms - glMs > MOST_MS)).toEqual([]);
});
