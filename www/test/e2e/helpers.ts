/** What the page's tests share: its parts, files to give it, and the pixels that it shows. */
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { expect, type Locator, type Page, test } from "@playwright/test";
import axe from "axe-core";

export interface Upload {
  name: string;
  mimeType: string;
  buffer: Buffer;
}

/** The command line, to be compared with the page. */
const built = (profile: string) =>
  fileURLToPath(new URL(`../../../target/${profile}/ridgeline`, import.meta.url));
export const BINARY =
  process.env["RIDGELINE"] ?? ["debug", "release"].map(built).find(existsSync) ?? built("release");
/** `make test` names the program: then it must be there. */
export const MAY_SKIP = process.env["RIDGELINE"] === undefined && !existsSync(BINARY);

const DEMO = new URL("../../public/demo/", import.meta.url);
const HOUSE = new URL("../fixtures/house/", import.meta.url);
const DRONE = new URL("../fixtures/drone/", import.meta.url);
const FIXTURES = new URL("../../../tests/fixtures/", import.meta.url);

export function upload(name: string, buffer: Buffer): Upload {
  return { name, mimeType: "application/octet-stream", buffer };
}

export function demoImages(count: number): Upload[] {
  const folder = new URL("images/", DEMO);
  const names = readdirSync(folder).sort().slice(0, count);
  return names.map((name) => upload(name, readFileSync(new URL(name, folder))));
}

/** The demo's orientation; `change` edits its list of exterior orientations, `changeCamera` the camera file. */
export function demoOrientation(
  change = (text: string) => text,
  changeCamera = (text: string) => text,
): Upload[] {
  const folder = new URL("orientation/photogrammetric/", DEMO);
  const text = (name: string) => readFileSync(new URL(name, folder), "utf8");
  return [
    upload("camera.txt", Buffer.from(changeCamera(text("camera.txt")))),
    upload("exterior.txt", Buffer.from(change(text("exterior.txt")))),
  ];
}

/** The formats in which the house's orientation is at hand (docs/formats.md), by the names of their folders. */
export const HOUSE_FORMATS = readdirSync(new URL("orientation/", HOUSE)).sort();

/** A small scene of its own, with its orientation as 3 x 4 matrices or in another format. */
export function houseFiles(format = "projection"): Upload[] {
  return [...filesIn(HOUSE, /\.jpg$/), ...filesIn(new URL(`orientation/${format}/`, HOUSE), /./)];
}

/** Photographs of drawn houses as a drone takes them, without orientation. */
export function dronePhotographs(): Upload[] {
  return filesIn(DRONE, /\.jpg$/);
}

/** Points with known coordinates in those photographs, as OpenDroneMap's list; one is two metres off. */
export function droneControl(): Upload {
  return upload("gcp_list.txt", readFileSync(new URL("gcp_list.txt", DRONE)));
}

/** The 48 pixels wide scene of the readers' tests, with its orientation as VisualSFM writes it. */
export function visualSfmFiles(): Upload[] {
  return [...filesIn(new URL("images/", FIXTURES), /./), ...filesIn(new URL("nvm/", FIXTURES), /./)];
}

function filesIn(folder: URL, wanted: RegExp): Upload[] {
  const names = readdirSync(folder).filter((name) => wanted.test(name));
  return names.sort().map((name) => upload(name, readFileSync(new URL(name, folder))));
}

/** The same matrices in one file, as Pix4D writes them. */
export function housePmatrix(): Upload {
  const lines = houseFiles()
    .filter(({ name }) => name.endsWith(".P"))
    .map(
      ({ name, buffer }) =>
        `${name.replace(".P", ".jpg")} ${buffer.toString().trim().split(/\s+/).join(" ")}`,
    );
  return upload("house_pmatrix.txt", Buffer.from(`${lines.join("\n")}\n`));
}

/** Serious and critical findings of axe, as text. */
export async function axeFindings(page: Page): Promise<string[]> {
  if (!(await page.evaluate(() => "axe" in window))) {
    await page.evaluate(axe.source);
  }
  return page.evaluate(async () => {
    const { axe: runner } = window as unknown as { axe: typeof import("axe-core") };
    const { violations } = await runner.run();
    return violations
      .filter(({ impact }) => impact === "serious" || impact === "critical")
      .map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" | ")}`);
  });
}

export async function give(page: Page, files: Upload[]): Promise<void> {
  await page.getByTestId("file-input").setInputFiles(files);
}

/** The house is open, all of its views oriented. */
export async function openHouse(page: Page): Promise<void> {
  await page.goto("/");
  await give(page, houseFiles());
  await expect(page.locator(".status.good")).toHaveCount(6);
}

/** The house has its model. */
export async function reconstructHouse(page: Page): Promise<void> {
  await openHouse(page);
  await runButton(page).click();
  await waitForStage(page, "model");
}

/** Turns to a face of the page, unless it is there. */
export async function showFace(page: Page, name: "Result" | "Method"): Promise<void> {
  const button = page.getByRole("group", { name: "Result or method" }).getByRole("button", { name });
  if ((await button.getAttribute("aria-pressed")) !== "true") {
    await button.click();
  }
}

/** Opens the panel of the project, or the one that it took the place of. */
export async function showProject(page: Page, shows = true): Promise<void> {
  const button = page.getByRole("button", { name: /^Project:/ });
  if ((await button.getAttribute("aria-expanded")) !== String(shows)) {
    await button.click();
  }
}

/** The example, at the entrance or over an open project. */
export async function openDemo(page: Page): Promise<void> {
  const door = page.getByRole("button", { name: "Show me on the example" });
  const again = page.getByRole("button", { name: "Demo scene" });
  await expect(door.or(again)).toBeVisible();
  await door.or(again).click();
}

/** What runs all stages, in either face. */
export function runButton(page: Page): Locator {
  return page.getByRole("button", { name: /^(Run all|Reconstruct|Reconstruct again)$/ });
}

export async function runUpTo(page: Page, title: string): Promise<void> {
  await showFace(page, "Method");
  await page.getByRole("button", { name: `Run up to ${title}`, exact: true }).click();
}

export async function chooseMethod(page: Page, title: string): Promise<void> {
  await showFace(page, "Method");
  await page.getByRole("button", { name: /^Method:/ }).click();
  await page.getByRole("button", { name: title, exact: true }).click();
  await page.keyboard.press("Escape");
}

/** Switches a layer of the 3D view, or how the model looks. */
export async function switchLayer(page: Page, name: string): Promise<void> {
  const menu = page.getByRole("button", { name: "Layers", exact: true });
  await menu.click();
  await page.locator(".menu-body").getByRole("button", { name, exact: true }).click();
  await page.keyboard.press("Escape");
  // Neither focus nor pointer is left in the picture.
  await menu.blur();
  await page.mouse.move(0, 0);
}

/** The entry of an output file, in the opened menu. */
export async function output(page: Page, name: string): Promise<Locator> {
  await showFace(page, "Result");
  const menu = page.getByRole("button", { name: "Download", exact: true });
  await expect(menu).toBeEnabled({ timeout: 120_000 });
  if ((await menu.getAttribute("aria-expanded")) !== "true") {
    await menu.click();
  }
  const entry = page.getByRole("button", { name, exact: true });
  await expect(entry).toBeVisible();
  return entry;
}

/** Saves an output file; its bytes. */
export async function save(page: Page, name: string): Promise<Buffer> {
  const entry = await output(page, name);
  const [download] = await Promise.all([page.waitForEvent("download"), entry.click()]);
  expect(download.suggestedFilename()).toBe(name === "Save project" ? "ridgeline-project.zip" : name);
  await page.keyboard.press("Escape");
  return readFileSync(await download.path());
}

/** Opens the parameters, which are closed at first, and a section of them. */
export async function openParameters(page: Page, section?: string): Promise<void> {
  await showFace(page, "Method");
  await showProject(page, false);
  const all = page.locator("details.parameters");
  if ((await all.getAttribute("open")) === null) {
    await all.getByRole("heading", { name: "Parameters" }).click();
  }
  if (section !== undefined) {
    await all.getByText(section, { exact: true }).click();
  }
}

export function stage(page: Page, name: string): Locator {
  return page.locator(`[data-stage="${name}"]`);
}

export async function waitForStage(page: Page, name: string, timeout = 200_000): Promise<void> {
  await expect(stage(page, name)).toHaveAttribute("data-status", "done", { timeout });
}

/** The tab of a stage; what the stage found is part of its name. */
export function tabOf(page: Page, title: string): Locator {
  return page.getByRole("tab").filter({ has: page.locator("b").getByText(title, { exact: true }) });
}

export async function openTab(page: Page, name: string): Promise<void> {
  await showFace(page, "Method");
  await tabOf(page, name).click();
}

/** Clicks over an element until something is as wanted. */
export async function pickUntil(element: Locator, isFound: () => Promise<boolean>): Promise<void> {
  const box = await element.boundingBox();
  for (let i = 0; i < 90 && !(await isFound()); i += 1) {
    const x = (box?.width ?? 0) * (0.25 + 0.055 * (i % 10));
    const y = (box?.height ?? 0) * (0.2 + 0.07 * Math.floor(i / 10));
    await element.click({ position: { x, y } });
    await element.page().waitForTimeout(60);
  }
  expect(await isFound()).toBe(true);
}

export interface Look {
  /** Share of pixels that differ from the most frequent colour. */
  drawn: number;
  /** Number of different colours, in steps of 16. */
  colours: number;
  /** Share of pixels that are far from grey. */
  vivid: number;
}

/** What an element shows on the screen, from a screenshot that the browser decodes. */
export async function lookOf(page: Page, element: Locator): Promise<Look> {
  return lookOfPicture(page, await element.screenshot());
}

/** The left and the right half of what an element shows. */
export async function looksOfHalves(page: Page, element: Locator): Promise<[Look, Look]> {
  const picture = await element.screenshot();
  return [await lookOfPicture(page, picture, 0, 0.5), await lookOfPicture(page, picture, 0.5, 1)];
}

/** A picture between two shares of its width. */
async function lookOfPicture(page: Page, picture: Buffer, from = 0, to = 1): Promise<Look> {
  const part = { base64: picture.toString("base64"), from, to };
  return page.evaluate(async ({ base64, from, to }) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    if (context === null) {
      throw new Error("no 2D context");
    }
    context.drawImage(bitmap, 0, 0);
    const [left, right] = [Math.round(from * bitmap.width), Math.round(to * bitmap.width)];
    const { data } = context.getImageData(left, 0, right - left, bitmap.height);
    const coarse = (at: number) =>
      ((data[at] ?? 0) >> 4) * 256 + ((data[at + 1] ?? 0) >> 4) * 16 + ((data[at + 2] ?? 0) >> 4);
    const counts = new Map<number, number>();
    let vivid = 0;
    for (let at = 0; at < data.length; at += 4) {
      const colour = coarse(at);
      counts.set(colour, (counts.get(colour) ?? 0) + 1);
      const rgb = [data[at] ?? 0, data[at + 1] ?? 0, data[at + 2] ?? 0];
      vivid += Math.max(...rgb) - Math.min(...rgb) > 50 ? 1 : 0;
    }
    const pixels = data.length / 4;
    return { drawn: 1 - Math.max(...counts.values()) / pixels, colours: counts.size, vivid: vivid / pixels };
  }, part);
}

/** The same once it no longer changes: textures and fonts arrive late. */
export async function steadyLook(page: Page, element: Locator): Promise<Look> {
  let last = await lookOf(page, element);
  for (let i = 0; i < 20; i += 1) {
    await page.waitForTimeout(250);
    const next = await lookOf(page, element);
    if (next.drawn === last.drawn && next.colours === last.colours) {
      return next;
    }
    last = next;
  }
  return last;
}

/** Fails the test on a script error, an invalid drawing, and a request to anywhere but the page's own origin. */
export function watch(page: Page): { problems: string[] } {
  const problems: string[] = [];
  page.on("pageerror", (error) => problems.push(`script error: ${error.message}`));
  page.on("dialog", (dialog) => {
    problems.push(`dialog: ${dialog.message()}`);
    void dialog.dismiss();
  });
  page.on("request", (request) => {
    const { protocol, origin } = new URL(request.url());
    if (
      protocol.startsWith("http") &&
      origin !== new URL(page.url()).origin &&
      page.url() !== "about:blank"
    ) {
      problems.push(`request to ${request.url()}`);
    }
  });
  page.on("console", (message) => {
    // Of drawings, the browser says "Error: <path> attribute d: Expected moveto path command".
    // three complains of what it is given by an error that begins with its name.
    const text = message.text();
    if (
      /Content Security Policy|<\w+> attribute/.test(text) ||
      (message.type() === "error" && text.startsWith("THREE."))
    ) {
      problems.push(text);
    }
  });
  return { problems };
}

/** Opens a link to a tab in an open page, and that page again: what it shows is kept. */
export async function reopen(page: Page, tab: string, fields: string): Promise<void> {
  await page.goto(`/#${fields}`);
  // Before the tab is there the address may still be that of the state before.
  await expect(tabOf(page, tab)).toHaveAttribute("aria-selected", "true");
  // What a run has found is written half a second after its end, and takes a moment.
  await page.waitForTimeout(1200);
  await page.reload();
}

/**
 * One page for all tests of a file, in their order: prepared before them, left after them. It fails the last one where `watch`
 * has found a problem.
 */
export function onePage(prepare: (page: Page) => Promise<void>, leave = async () => {}): void {
  test.describe.configure({ mode: "serial" });
  let page: Page;
  let problems: string[];
  test.beforeAll(async ({ browser }) => {
    page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
    ({ problems } = watch(page));
    await page.goto("/");
    await prepare(page);
  });
  test.afterAll(async () => {
    await leave();
    expect(problems).toEqual([]);
    await page.close();
  });
}

/** What the browser keeps of the page; runs in the page. */
export function storedKeys(): Promise<IDBValidKey[]> {
  return new Promise((resolve, reject) => {
    const opening = indexedDB.open("ridgeline");
    opening.onerror = () => reject(opening.error);
    opening.onsuccess = () => {
      const keys = opening.result.transaction("project").objectStore("project").getAllKeys();
      keys.onsuccess = () => {
        opening.result.close();
        resolve(keys.result);
      };
    };
  });
}
