// How long a slider of the parameters takes to answer: the demo scene in the built site, from localhost.
//
//   npm run build && npm run drag-time
//
// A slider is moved by one step and back; printed are the medians of the seconds until the stage that reads its parameter has
// run and its results are in the page.

import { cpus } from "node:os";
import { withSite } from "./site.mjs";

const PORT = Number(process.env.PORT ?? 4182);
const MOVES = 8;
/** A run of the demo without a graphics card, milliseconds. */
const PATIENCE = 120_000;

/** In the page: moves a slider and waits until the stage that ran because of it is done. */
function move([name, steps]) {
  const slider = document.querySelector(`input[type="range"][aria-label="${name}"]`);
  const started = performance.now();
  return new Promise((resolve) => {
    const running = new Set();
    const observer = new MutationObserver((changes) => {
      for (const { target } of changes) {
        const { stage, status } = target.dataset;
        if (status === "running") {
          running.add(stage);
        } else if (status === "done" && running.has(stage)) {
          observer.disconnect();
          resolve(performance.now() - started);
        }
      }
    });
    for (const stage of document.querySelectorAll("[data-stage]")) {
      observer.observe(stage, { attributeFilter: ["data-status"] });
    }
    slider.value = String(Number(slider.value) + steps * Number(slider.step));
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  });
}

const median = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];

await withSite(PORT, async (browser) => {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await page.goto(`http://127.0.0.1:${PORT}/#scene=demo&face=method&tab=model`);
  await page.waitForSelector('[data-stage="model"][data-status="done"]', { timeout: PATIENCE });
  await page.locator("details.parameters").getByRole("heading", { name: "Parameters" }).click();
  await page.waitForSelector('input[type="range"][aria-label$=", dragged"]');
  const sliders = await page.$$eval('input[type="range"][aria-label$=", dragged"]', (all) =>
    all.map((one) => one.getAttribute("aria-label")),
  );
  console.log(`${cpus().length} cores, ${MOVES} moves`);
  for (const name of sliders) {
    const times = [];
    for (let i = 0; i < MOVES; i += 1) {
      times.push((await page.evaluate(move, [name, i % 2 === 0 ? -1 : 1])) / 1000);
    }
    console.log(`${name.replace(", dragged", "").padEnd(48)} ${median(times).toFixed(2)} s`);
  }
});
