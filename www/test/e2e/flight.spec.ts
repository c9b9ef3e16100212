/** Flights: a plan before anything long, tile after tile with the model growing, and going on after a reload. */
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { expect, type Page, test } from "@playwright/test";
import {
  axeFindings,
  BINARY,
  give,
  houseFiles,
  MAY_SKIP,
  save,
  showProject,
  stage,
  type Upload,
  upload,
  waitForStage,
  watch,
} from "./helpers";

/** Of the house's photographs, pixels. */
const HOUSE_SIZE = [256, 256] as const;

/** The house's six photographs three times over: more than are loaded at once. */
function flightFiles(): Upload[] {
  return ["a", "b", "c"].flatMap((pass) =>
    houseFiles().map(({ name, buffer }) => upload(`${pass}_${name}`, buffer)),
  );
}

/** One picture as if taken 100 m above level ground at 0, every 20 m along 300 m to the east and 300 m to the north. */
function lShapedFlight(): Upload[] {
  const picture = houseFiles().find(({ name }) => name.endsWith(".jpg"))?.buffer ?? Buffer.alloc(0);
  const steps = [...Array(16).keys()].map((i) => 20 * i);
  const places = [...steps.map((x) => [x, 0]), ...steps.slice(1).map((y) => [0, y])];
  const names = places.map((_, i) => `p${String(i).padStart(2, "0")}.jpg`);
  const [width, height] = HOUSE_SIZE;
  // Looking down, north up: t = -R C.
  const lines = places.map(([x, y], i) => `${i} 0 1 0 0 ${-(x ?? 0)} ${y} 100 1 ${names[i]}\n\n`);
  return [
    ...names.map((name) => upload(name, picture)),
    upload(
      "cameras.txt",
      Buffer.from(`1 PINHOLE ${width} ${height} ${width} ${width} ${width / 2} ${height / 2}\n`),
    ),
    upload("images.txt", Buffer.from(lines.join(""))),
  ];
}

const plan = (page: Page) => page.getByTestId("flight-plan");
const facts = (page: Page) => page.getByTestId("flight-facts");
const side = (page: Page, name: string) => plan(page).getByLabel(name, { exact: true });

async function state(page: Page, name: string, value: string): Promise<void> {
  await side(page, name).fill(value);
  await side(page, name).press("Enter");
}

/** Opens the fields of region and ground; what was open once is open still. */
async function openPlace(page: Page): Promise<void> {
  await showProject(page);
  await page.getByText("Region, ground, reference system").waitFor();
  if (!(await page.getByLabel(/^Tile size/).isVisible())) {
    await page.getByText("Region, ground, reference system").click();
  }
}

/** Two tiles: nothing may be a roof in the first, the house stands in the second. */
async function askForTiles(page: Page): Promise<void> {
  await openPlace(page);
  for (const [label, value] of [
    [/^Region x0/, "-31, 0, 31, 15"],
    [/^Height of the ground/, "100"],
    [/^Tile size/, "60"],
  ] as const) {
    await page.getByLabel(label).fill(value);
    await page.getByLabel(label).press("Enter");
  }
  await expect(plan(page)).toBeVisible();
  await expect(plan(page).locator(".tile")).toHaveCount(2);
}

test("a plan is there before anything long, and the region is drawn on it or stated", async ({ page }) => {
  test.setTimeout(300_000);
  const { problems } = watch(page);
  await page.goto("/");
  await give(page, flightFiles());
  await expect(plan(page).getByRole("heading", { name: "A flight of 18 photographs" })).toBeVisible();
  await expect(page.locator(".activity")).toHaveCount(0);
  // The house stands on ground 100 m high, and four photographs of it show roofs, too.
  await expect(facts(page)).toContainText(/\+(9\d|10\d) to \+1[01]\d m/);
  await expect(facts(page)).toContainText("known after a first look");
  await expect(plan(page).locator(".footprints polygon")).toHaveCount(18);
  await expect(stage(page, "segments")).toHaveAttribute("data-status", "waiting");
  await expect(page.locator("canvas.view-image")).toHaveCount(0);
  expect(await axeFindings(page)).toEqual([]);

  // By the mouse: the middle half of the drawing.
  const drawing = page.getByTestId("flight-drawing");
  const box = (await drawing.boundingBox()) as { x: number; y: number; width: number; height: number };
  const before = Number(await side(page, "West").inputValue());
  await page.mouse.move(box.x + box.width / 4, box.y + box.height / 4);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.move(box.x + (3 * box.width) / 4, box.y + (3 * box.height) / 4);
  await page.mouse.up();
  // The cameras of the house's flight stand far around what they show.
  await expect.poll(async () => Number(await side(page, "West").inputValue())).toBeLessThan(before);
  await expect(plan(page).getByRole("button", { name: "Whole area" })).toBeVisible();
  const west = Number(await side(page, "West").inputValue());
  const east = Number(await side(page, "East").inputValue());
  await expect(facts(page)).toContainText(`${east - west} ×`);

  // By keys: a longer region has more tiles; one that ends before it begins is not taken.
  await state(page, "West", String(east + 5));
  await expect(side(page, "West")).toHaveAttribute("aria-invalid", "true");
  await state(page, "West", String(east - 130));
  await expect(facts(page)).toContainText("130 ×");
  const south = Number(await side(page, "South").inputValue());
  const north = Number(await side(page, "North").inputValue());
  // Tiles stand on a grid of the world.
  const squares = (from: number, to: number) => Math.ceil(to / 60) - Math.floor(from / 60);
  const count = squares(east - 130, east) * squares(south, north);
  await expect(plan(page).locator(".tile")).toHaveCount(count);
  await plan(page).getByLabel("Size of a tile, m").fill("500");
  await plan(page).getByLabel("Size of a tile, m").press("Enter");
  await expect(plan(page).locator(".tile")).toHaveCount(1);

  await plan(page).getByRole("button", { name: "Whole area" }).click();
  await expect.poll(async () => Number(await side(page, "West").inputValue())).toBe(before);

  // All at once, stage by stage: no region takes more than twelve.
  await openPlace(page);
  await page.getByLabel(/^Height of the ground/).fill("100");
  await page.getByLabel(/^Height of the ground/).press("Enter");
  await expect(facts(page)).toContainText("+100.0 m, as stated");
  // With the height that is stated now another area is shown.
  const west100 = Number(await side(page, "West").inputValue());
  await state(page, "West", String(west100 + 1));
  await expect(side(page, "West")).toHaveValue(String(west100 + 1));
  await plan(page).getByRole("button", { name: "Stage by stage" }).click();
  await expect(plan(page)).toHaveCount(0);
  await expect(page.getByText("the 12 that say most about it are used")).toBeVisible();
  await expect(page.getByRole("alert")).toHaveCount(0);
  expect(problems).toEqual([]);
});

test("an L-shaped flight has the tiles of the command line, and what it leaves out says why", async ({
  page,
}) => {
  test.skip(MAY_SKIP, "the command line is not built");
  const { problems } = watch(page);
  const folder = mkdtempSync(join(tmpdir(), "ridgeline-"));
  const files = lShapedFlight();
  for (const { name, buffer } of files) {
    writeFileSync(join(folder, name), buffer);
  }
  const out = join(folder, "plan");
  execFileSync(BINARY, ["plan", folder, "--tile", "60", "--ground-z", "0", "--out", out]);
  const { tiles, left_out } = JSON.parse(readFileSync(join(out, "tiles.json"), "utf8")) as {
    tiles: unknown[];
    left_out: unknown[];
  };
  expect(left_out.length).toBeGreaterThan(15);

  await page.goto("/");
  await give(page, files);
  await openPlace(page);
  await page.getByLabel(/^Height of the ground/).fill("0");
  await page.getByLabel(/^Height of the ground/).press("Enter");
  await expect(facts(page)).toContainText("0.0 m, as stated");
  await expect(plan(page).locator(".tile")).toHaveCount(tiles.length);
  const squares = plan(page).locator(".squares-left-out");
  await expect(squares).toHaveAttribute("data-count", String(left_out.length));
  await expect(squares.locator("title")).toHaveText("Left out: fewer than three photographs show its ground");
  await expect(facts(page)).toContainText(`${left_out.length} squares left out`);
  await expect(plan(page).getByRole("button", { name: `Reconstruct ${tiles.length} tiles` })).toBeEnabled();
  expect(await axeFindings(page)).toEqual([]);
  expect(problems).toEqual([]);
});

test("tiles that are done stay over a cancelled run and a reload, and give the same bytes", async ({
  page,
  browser,
}) => {
  test.setTimeout(400_000);
  const { problems } = watch(page);
  await page.goto("/");
  await give(page, houseFiles());
  await askForTiles(page);
  await page.getByRole("button", { name: "Reconstruct 2 tiles" }).click();
  const progress = page.getByTestId("flight-progress");
  await expect(progress).toContainText("0 of 2 tiles");
  await expect(progress).toContainText("6 of 6 photographs read");
  await expect(progress).toContainText(/minutes? left/);
  await expect(progress).toContainText("1 of 2 tiles", { timeout: 150_000 });
  await page.getByRole("button", { name: "Cancel" }).click();
  await expect(progress).toHaveCount(0);

  await page.reload();
  await expect(plan(page)).toContainText("1 tile of this plan is kept", { timeout: 60_000 });
  await expect(plan(page).locator(".tile.done")).toHaveCount(1);
  await plan(page).getByRole("button", { name: "Go on: 1 of 2 tiles" }).click();
  await expect(progress).toContainText("1 of 2 tiles");
  await waitForStage(page, "model", 200_000);
  const resumed = (await save(page, "model.city.json")).toString();

  // The same without an interruption, in a browser that keeps nothing.
  const fresh = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await fresh.goto("/");
  await give(fresh, houseFiles());
  await askForTiles(fresh);
  await expect(plan(fresh).locator(".tile.done")).toHaveCount(0);
  await fresh.getByRole("button", { name: "Reconstruct 2 tiles" }).click();
  await waitForStage(fresh, "model", 300_000);
  expect((await save(fresh, "model.city.json")).toString()).toBe(resumed);
  await fresh.close();
  expect(Object.keys(JSON.parse(resumed).CityObjects)).toHaveLength(1);
  expect(problems).toEqual([]);
});

test("a folder is read again after a reload, and not copied", async ({ page }) => {
  const { problems } = watch(page);
  // The browser's own picker cannot be operated by a test; its private folders are the same kind of handle.
  await page.addInitScript(() => {
    Object.assign(window, {
      showDirectoryPicker: async () => (await navigator.storage.getDirectory()).getDirectoryHandle("flight"),
    });
    if (sessionStorage.getItem("asks") !== null) {
      Object.assign(FileSystemDirectoryHandle.prototype, {
        queryPermission: async () => "prompt",
        requestPermission: async () => "granted",
      });
    }
  });
  await page.goto("/");
  await page.evaluate(
    async (files) => {
      const root = await navigator.storage.getDirectory();
      const folder = await root.getDirectoryHandle("flight", { create: true });
      const images = await folder.getDirectoryHandle("images", { create: true });
      for (const { name, base64 } of files) {
        const within = name.endsWith(".jpg") ? images : folder;
        const written = await (await within.getFileHandle(name, { create: true })).createWritable();
        await written.write(Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)));
        await written.close();
      }
    },
    houseFiles().map(({ name, buffer }) => ({ name, base64: buffer.toString("base64") })),
  );
  await page.getByRole("button", { name: "open a folder" }).click();
  await expect(page.locator(".status.good")).toHaveCount(6);
  await expect(page.getByTestId("kept")).toContainText("0.0 MB");
  await page.waitForTimeout(600);
  await page.reload();
  await expect(page.locator(".status.good")).toHaveCount(6);

  // A browser that asks again.
  await page.evaluate(() => sessionStorage.setItem("asks", "yes"));
  await page.reload();
  await page.getByRole("region", { name: "Your last projects" }).getByText("flight").click();
  await expect(page.locator(".status.good")).toHaveCount(6);
  await expect(page.getByRole("alert")).toHaveCount(0);
  expect(problems).toEqual([]);
});
