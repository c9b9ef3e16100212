import { expect, type Locator, type Page, test } from "@playwright/test";
import {
  axeFindings,
  chooseMethod,
  demoImages,
  give,
  houseFiles,
  lookOf,
  openHouse,
  openTab,
  output,
  runButton,
  runUpTo,
  showFace,
  tabOf,
  waitForStage,
} from "./helpers";

/** Phone, tablet, small and usual screen, projector; and 1440 x 900 at 200 % zoom. */
const SIZES = [
  [360, 740],
  [720, 450],
  [768, 1024],
  [1024, 768],
  [1440, 900],
  [1920, 1080],
] as const;

/** By how much the page is wider than its window. */
const overflow = (page: Page) =>
  page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);

test("the entrance: a model on its ground before the core is there, at every size", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  let go = () => {};
  const looked = new Promise<void>((resolve) => {
    go = resolve;
  });
  await page.route(/\.wasm$/, async (route) => {
    await looked;
    await route.continue();
  });
  await page.goto("/");
  const entrance = page.getByTestId("entrance");
  await expect(page.locator(".turntable.drawn")).toBeVisible();
  const model = page.getByTestId("turntable");
  expect((await lookOf(page, model)).colours).toBeGreaterThan(60);
  await expect(entrance.getByRole("img", { name: /^Aerial photograph/ })).toHaveCount(6);
  await expect(page.getByRole("tab")).toHaveCount(0);
  await expect(page.getByText("Parameters", { exact: true })).toBeHidden();
  // For whom motion is too much it stands still.
  const still = await model.screenshot();
  expect(still.equals(await model.screenshot())).toBe(true);
  for (const colorScheme of ["light", "dark"] as const) {
    await page.emulateMedia({ colorScheme });
    expect(await axeFindings(page), colorScheme).toEqual([]);
  }
  for (const [width, height] of SIZES) {
    await page.setViewportSize({ width, height });
    // The layout follows the size a moment later.
    await expect.poll(() => overflow(page), `${width} px`).toBeLessThanOrEqual(0);
    for (const name of [
      /^I have only photographs/,
      /^Photographs with their/,
      /^Show me/,
      /^open a folder/,
    ]) {
      await expect(entrance.getByRole("button", { name }), String(name)).toBeVisible();
    }
  }
  go();
  await give(page, houseFiles());
  await expect(entrance).toHaveCount(0);
  await expect(page.locator(".status.good")).toHaveCount(6);
});

test("photographs without orientation: recipes, and what their headers say", async ({ page }) => {
  await page.goto("/");
  await give(page, demoImages(3));
  const panel = page.getByTestId("photographs-only");
  await expect(panel.getByRole("heading", { name: /OpenDroneMap|COLMAP|Metashape/ })).toHaveCount(3);
  await expect(panel.getByRole("row")).toHaveCount(4);
  expect(await axeFindings(page)).toEqual([]);
});

test("in the hand: model, photographs and stages, with fingers", async ({ browser }) => {
  const context = await browser.newContext({ viewport: { width: 360, height: 740 }, hasTouch: true });
  const page = await context.newPage();
  await page.goto("/");
  await give(page, houseFiles());
  await runButton(page).click();
  await expect(await output(page, "model.glb")).toBeVisible();
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Photographs", exact: true }).click();
  const caption = page.locator(".image-view figcaption").first();
  const zoom = async () => Number(/(\d+) %/.exec((await caption.textContent()) ?? "")?.[1]);
  const before = await zoom();
  await pinch(page, page.locator(".image-view canvas").first());
  expect(await zoom()).toBeGreaterThan(1.5 * before);
  for (const face of ["Result", "Method"] as const) {
    await showFace(page, face);
    expect(await overflow(page)).toBeLessThanOrEqual(0);
    expect(await axeFindings(page)).toEqual([]);
  }
  await openTab(page, "3D lines");
  await expect(page.getByTestId("viewer")).toBeVisible();
  await context.close();
});

/** Two fingers that part to twice their distance. */
async function pinch(page: Page, element: Locator): Promise<void> {
  const box = (await element.boundingBox()) ?? { x: 0, y: 0, width: 0, height: 0 };
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const session = await page.context().newCDPSession(page);
  const at = (apart: number) => [-apart, apart].map((dx, id) => ({ x: x + dx, y, id }));
  await session.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(30) });
  await session.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(45) });
  await session.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(60) });
  await session.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
}

test("nothing serious for axe in any tab", async ({ page }) => {
  await openHouse(page);
  await chooseMethod(page, "Combined");
  await runUpTo(page, "Model");
  await waitForStage(page, "model");
  const tabs = await page.locator('[role="tab"] b').allTextContents();
  expect(tabs).toEqual(expect.arrayContaining(["Segments", "Regions", "Clusters", "Half-planes", "Model"]));
  for (const name of tabs) {
    await openTab(page, name);
    expect(await axeFindings(page), name).toEqual([]);
  }
  for (const tool of ["Measure", "Section"]) {
    await page.getByRole("button", { name: tool }).click();
    expect(await axeFindings(page), tool).toEqual([]);
  }
  // Closed at first; the core has each of those that are wanted.
  await expect(page.getByLabel("Grouping and facets: Min area")).toBeHidden();
  await expect(page.locator('[id^="wanted-"]:is(input, select)')).toHaveCount(10);
  await byKeyboard(page);
  await atEverySize(page);
  await onPaper(page);
});

/** The skip link, the tabs, and a distance, without a pointer. */
async function byKeyboard(page: Page): Promise<void> {
  await page.getByRole("button", { name: "Skip to the views" }).focus();
  await page.keyboard.press("Enter");
  await expect(tabOf(page, "Model")).toBeFocused();
  await page.keyboard.press("ArrowLeft");
  await expect(tabOf(page, "Refinement")).toBeFocused();
  await page.keyboard.press("ArrowRight");
  await expect(tabOf(page, "Model")).toHaveAttribute("aria-selected", "true");
  await page.getByRole("button", { name: "Measure" }).press("Enter");
  await page.getByRole("button", { name: /^Crosshair/ }).focus();
  for (const key of ["Enter", "ArrowRight", "ArrowRight", "ArrowDown", "Enter"]) {
    await page.keyboard.press(key);
  }
  await expect(page.getByTestId("reading")).toContainText(/Distance[\d.]+ m/);
  await page.keyboard.press("Escape");
  await expect(page.getByTestId("reading")).toHaveCount(0);
}

/** Nothing is cut off, whatever the screen and the size of type. */
async function atEverySize(page: Page): Promise<void> {
  const larger = page.getByRole("button", { name: /^Text size/ });
  for (const type of [1, 1.5]) {
    for (const [width, height] of SIZES) {
      await page.setViewportSize({ width, height });
      await expect.poll(() => overflow(page), `${width} px, type ${type}`).toBeLessThanOrEqual(0);
      const tabs = page.getByRole("tablist", { name: "Stage views" });
      if (await tabs.isVisible()) {
        expect(await tabs.evaluate((list) => list.scrollWidth - list.clientWidth)).toBeLessThanOrEqual(0);
      }
    }
    for (let i = 0; i < 3; i += 1) {
      await larger.click();
    }
  }
  await page.setViewportSize({ width: 1280, height: 800 });
}

/** Numbers and the present view are printed, controls are not. */
async function onPaper(page: Page): Promise<void> {
  await page.emulateMedia({ media: "print" });
  await expect(page.locator(".print-head")).toContainText("Roofs");
  await expect(page.getByTestId("viewer")).toBeVisible();
  // What WebGL has drawn is copied for the printer, on white.
  await page.pdf();
  const paper = page.locator("canvas.paper");
  await expect(paper).toBeVisible();
  const corner = await paper.evaluate((canvas: HTMLCanvasElement) =>
    Array.from(canvas.getContext("2d")?.getImageData(0, 0, 1, 1).data ?? []),
  );
  expect(corner).toEqual([255, 255, 255, 255]);
  for (const control of [".header", ".rail", ".space-tools", ".dropzone"]) {
    await expect(page.locator(control).first(), control).toBeHidden();
  }
  await page.emulateMedia({ media: "screen" });
}

test("theme and size of type stay as they were chosen", async ({ page }) => {
  const size = () =>
    page.evaluate(() => Number.parseFloat(getComputedStyle(document.documentElement).fontSize));
  await page.emulateMedia({ colorScheme: "light" });
  await page.goto("/");
  const usual = await size();
  await page.getByRole("button", { name: "Dark" }).click();
  await expect(page.locator("html")).toHaveAttribute("data-theme", "dark");
  await page.getByRole("button", { name: /^Text size/ }).click();
  await page.getByRole("button", { name: /^Text size/ }).click();
  expect((await size()) / usual).toBeCloseTo(1.3, 2);
  await page.reload();
  await expect(page.locator("html")).toHaveAttribute("data-theme", "dark");
  expect((await size()) / usual).toBeCloseTo(1.3, 2);
});
