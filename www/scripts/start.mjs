// How long a first visit takes until the page answers: the built site from localhost, nothing in any cache.
//
//   npm run build && npm run start-time
//
// Printed are the medians of several visits, seconds from the start of the navigation: until something is painted, until the
// entrance's model is drawn, and until the core (WebAssembly) has told the page its parameters.

import { cpus } from "node:os";
import { withSite } from "./site.mjs";

const PORT = Number(process.env.PORT ?? 4181);
const VISITS = 7;

/** In the page: notes in which frame the model is drawn, and when the page marked that the core is ready. */
function note() {
  window.answered = {};
  const look = () => {
    if (document.querySelector(".turntable.drawn") !== null) {
      window.answered.model ??= performance.now();
    }
    window.answered.core ??= performance.getEntriesByName("core ready")[0]?.startTime;
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}

async function visit(browser) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
  const page = await context.newPage();
  await page.addInitScript(note);
  await page.goto(`http://127.0.0.1:${PORT}/`);
  await page.waitForFunction(() => window.answered.model !== undefined && window.answered.core !== undefined);
  const found = await page.evaluate(() => ({
    paint: performance.getEntriesByName("first-contentful-paint")[0]?.startTime ?? Number.NaN,
    ...window.answered,
  }));
  await context.close();
  return found;
}

const median = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];

await withSite(PORT, async (browser) => {
  const visits = [];
  for (let i = 0; i < VISITS; i += 1) {
    visits.push(await visit(browser));
  }
  console.log(`${cpus().length} cores, ${VISITS} visits`);
  const WORDS = { paint: "first paint", model: "the model is drawn", core: "the core is ready" };
  for (const [name, words] of Object.entries(WORDS)) {
    const all = visits.map((one) => one[name] / 1000);
    console.log(`${words.padEnd(18)} ${median(all).toFixed(2)} s (longest ${Math.max(...all).toFixed(2)} s)`);
  }
});
