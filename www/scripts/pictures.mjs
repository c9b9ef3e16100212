/**
 * Pictures of a model from four sides: gives the page a folder with images and orientation, reconstructs it, and turns the camera
 * of the viewer by quarters. `npm run build && npm run pictures -- FOLDER OUT.jpg`
 */
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { withSite } from "./site.mjs";

const PORT = Number(process.env.PORT ?? 4180);
const SITE = `http://127.0.0.1:${PORT}/`;
const QUALITY = 80;
/** So far the wheel is turned: the view as it is fitted leaves room for orbiting. */
const NEARER = -350;
/** A large scene takes minutes where WebGL is drawn in software. */
const LONGEST_MS = 900_000;

const [folder, out] = process.argv.slice(2);
if (folder === undefined || out === undefined) {
  throw new Error("pictures.mjs FOLDER OUT.jpg");
}

/** Images, and one orientation of them: the camera file beside the folders. */
function filesOf(scene) {
  const images = join(scene, "images");
  return [...readdirSync(images).map((name) => join(images, name)), join(scene, "cameras.json")];
}

async function fourSides(page) {
  const canvas = page.locator(".space-view canvas, .stage-view canvas").first();
  const box = await canvas.boundingBox();
  const middle = [box.x + box.width / 2, box.y + box.height * 0.7];
  for (const over of [".space-tools", ".space-foot"]) {
    await page.locator(over).evaluate((part) => {
      part.style.visibility = "hidden";
    });
  }
  await page.mouse.move(...middle);
  await page.mouse.wheel(0, NEARER);
  await page.waitForTimeout(1500);
  const shots = [];
  for (let side = 0; side < 4; side += 1) {
    shots.push(await canvas.screenshot({ type: "jpeg", quality: 90 }));
    // The height of the canvas is one turn.
    await page.mouse.move(...middle);
    await page.mouse.down();
    await page.mouse.move(middle[0] + box.height / 4, middle[1], { steps: 12 });
    await page.mouse.up();
    await page.waitForTimeout(1500);
  }
  return shots;
}

/** Two by two in one picture. */
async function composed(browser, shots) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 100 } });
  const images = shots.map((s) => `<img src="data:image/jpeg;base64,${s.toString("base64")}">`).join("");
  await page.setContent(
    `<style>body{margin:0;display:grid;grid-template-columns:1fr 1fr;gap:2px}img{width:100%;display:block}</style>${images}`,
  );
  const height = await page.evaluate("document.body.scrollHeight");
  await page.setViewportSize({ width: 1280, height });
  await page.screenshot({ path: out, type: "jpeg", quality: QUALITY });
}

await withSite(PORT, async (browser) => {
  const page = await browser.newPage({ viewport: { width: 1440, height: 860 }, colorScheme: "light" });
  await page.goto(SITE);
  await page.locator('input[type="file"]').first().setInputFiles(filesOf(folder));
  await page.getByRole("button", { name: "Reconstruct", exact: true }).click();
  const outcome = () => {
    const rejection = document.querySelector('[role="alert"]')?.textContent;
    const isDone = document.querySelector('[data-stage="model"]')?.dataset.status === "done";
    return rejection ?? (isDone ? "done" : null);
  };
  const handle = await page.waitForFunction(outcome, undefined, { timeout: LONGEST_MS });
  const said = await handle.jsonValue();
  if (said !== "done") {
    throw new Error(said);
  }
  await page.waitForTimeout(3000);
  await composed(browser, await fourSides(page));
});
