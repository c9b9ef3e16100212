/** The ten lessons: every screen, guessed and revealed, in any size and theme, and real figures on one's own scene. */
import { expect, type Page, test } from "@playwright/test";
import axe from "axe-core";
import { houseFiles, openHouse } from "./helpers";

test.describe.configure({ mode: "serial" });

/** What the console says of mistakes. */
function watched(page: Page): string[] {
  const said: string[] = [];
  page.on("pageerror", ({ message }) => said.push(message));
  page.on("console", (message) => {
    if (message.type() === "error") said.push(message.text());
  });
  return said;
}

const overflow = (page: Page) =>
  page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);

/** Screens whose figure is of a real scene are computed when they are seen: they are opened apart. */
const screensOf = (page: Page) =>
  page.locator(".ways ol a").evaluateAll((all) => all.map((one) => (one as HTMLAnchorElement).hash));

/** Whatever is asked is answered, so that what follows is seen, too. */
async function answer(page: Page): Promise<void> {
  const open = page.locator(".predict .primary, .predict .options button:not(:disabled)").first();
  if (await open.isVisible()) {
    await open.click();
    await expect(page.locator(".predict [role=status]")).toBeVisible();
  }
}

test("are in the contents, and each walks through its screens", async ({ page }) => {
  const said = watched(page);
  // Figures of real scenes have a test of their own.
  await page.route("**/demo/**", (route) => route.abort());
  await page.goto("/lessons.html");
  const links = await page
    .locator(".contents li a")
    .evaluateAll((all) => all.map((one) => (one as HTMLAnchorElement).hash));
  expect(links).toHaveLength(10);
  let screens = 0;
  for (const link of links) {
    await page.goto(`/lessons.html${link}`);
    const own = await screensOf(page);
    for (const [i, hash] of own.entries()) {
      await page.goto(`/lessons.html${hash}`);
      const screen = page.locator(".screen");
      await expect(screen).toHaveAttribute(
        "data-screen",
        new URLSearchParams(hash.slice(1)).get("screen") ?? "",
      );
      await answer(page);
      expect(await page.locator(".show").innerText(), hash).not.toMatch(/NaN|undefined|Infinity/);
      await expect(page.locator(".ways [aria-current]")).toHaveCount(1);
      if (i === own.length - 1) {
        await expect(screen).toHaveClass(/on-scene/);
      }
      screens += 1;
    }
  }
  expect(screens).toBeGreaterThan(55);
  // The demo scene was withheld; nothing else went wrong.
  expect(said.filter((text) => !/ERR_FAILED|Failed to fetch|Failed to load resource/.test(text))).toEqual([]);
});

/** All that axe finds, however slight; of some rules only, where the others were asked before. */
async function findings(page: Page, rules?: string[]): Promise<string[]> {
  if (!(await page.evaluate(() => "axe" in window))) {
    await page.evaluate(axe.source);
  }
  return page.evaluate(async (only) => {
    const { axe: runner } = window as unknown as { axe: typeof import("axe-core") };
    const { violations } = await runner.run(only === undefined ? {} : { runOnly: only });
    return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" | ")}`);
  }, rules);
}

/** Every lesson with all of its screens at once. */
async function eachWhole(page: Page, look: (link: string) => Promise<void>): Promise<void> {
  await page.route("**/demo/**", (route) => route.abort());
  await page.goto("/lessons.html");
  const links = await page
    .locator(".contents li a")
    .evaluateAll((all) => all.map((one) => (one as HTMLAnchorElement).hash));
  await expect.poll(() => overflow(page), "contents").toBeLessThanOrEqual(0);
  await look("contents");
  await page.goto(`/lessons.html${links[0]}`);
  await page.getByRole("button", { name: "Hand-out" }).click();
  for (const link of links) {
    await page.goto(`/lessons.html${link}`);
    await expect(page.locator(".screen").nth(4)).toBeAttached();
    await expect.poll(() => overflow(page), link).toBeLessThanOrEqual(0);
    await look(link);
  }
}

test("axe finds nothing in light and dark, and nothing is cut off, also at 320 pixels and at 200 % zoom", async ({
  page,
}) => {
  await eachWhole(page, async (link) => {
    await page.setViewportSize({ width: 320, height: 700 });
    await expect.poll(() => overflow(page), link).toBeLessThanOrEqual(0);
    await page.setViewportSize({ width: 720, height: 450 });
    await expect.poll(() => overflow(page), link).toBeLessThanOrEqual(0);
    expect(await findings(page, DEPEND_ON_SIZE), link).toEqual([]);
    await page.setViewportSize({ width: 1440, height: 900 });
    await page.emulateMedia({ colorScheme: "light" });
    expect(await findings(page), link).toEqual([]);
    await page.emulateMedia({ colorScheme: "dark" });
    expect(await findings(page, ["color-contrast"]), link).toEqual([]);
  });
});

/** The rules of axe that ask where things are. */
const DEPEND_ON_SIZE = ["scrollable-region-focusable", "target-size"];

test("by keyboard: screens turn, what is dragged keeps its own keys", async ({ page }) => {
  await page.goto("/lessons.html#lesson=epipolar");
  await page.locator("h2").click();
  await page.keyboard.press("ArrowRight");
  await expect(page.locator(".screen")).toHaveAttribute("data-screen", "ray");
  const says = page.locator(".says");
  const before = await says.innerText();
  await page.getByRole("slider", { name: "Point X on the ray" }).focus();
  for (let i = 0; i < 4; i += 1) await page.keyboard.press("ArrowDown");
  await expect(says).not.toHaveText(before);
  await expect(page.locator(".screen")).toHaveAttribute("data-screen", "ray");
  await page.locator("h2").click();
  await page.keyboard.press("ArrowLeft");
  await expect(page.locator(".screen")).toHaveAttribute("data-screen", "bird");
});

test("the pointer drags, and the sentence says the number", async ({ page }) => {
  await page.goto("/lessons.html#lesson=triangulation&screen=baseline");
  await answer(page);
  const camera = page.getByRole("slider", { name: "Second camera" });
  const box = (await camera.locator(".knob").boundingBox()) ?? { x: 0, y: 0, width: 0, height: 0 };
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 5, { steps: 5 });
  await page.mouse.up();
  const baseline = Number(/baseline of (\d+) m/.exec(await page.locator(".says").innerText())?.[1]);
  expect(baseline).toBeGreaterThan(25);
});

test.describe("offline", () => {
  test.use({ serviceWorkers: "allow" });

  test("the project of the page is the scene of the lessons, and they open offline once they were seen", async ({
    page,
    context,
  }) => {
    await openHouse(page);
    await page.getByRole("link", { name: "Lessons" }).waitFor();
    // It is written a moment after the last change; then the worker of the site has what it serves.
    await page.waitForTimeout(1500);
    await page.evaluate(() => navigator.serviceWorker.ready);
    await page.getByRole("link", { name: "Lessons" }).click();
    await expect(page.locator(".contents li")).toHaveCount(10);
    await expect(page.locator(".scene-bar")).not.toContainText("the demo scene");
    await page.goto("/lessons.html#lesson=pinhole&screen=own");
    await expect(page.locator(".parts canvas")).toHaveCount(6);
    await page.getByRole("button", { name: "Demo scene" }).waitFor();
    await page.reload();
    await context.setOffline(true);
    await page.reload();
    await expect(page.locator(".parts canvas")).toHaveCount(6);
    await context.setOffline(false);
  });
});

test("one's own files: points and epipolar lines of their cameras, and a figure of the core", async ({
  page,
}) => {
  const said = watched(page);
  await page.goto("/lessons.html#lesson=pinhole&screen=own");
  await page.getByTestId("lesson-files").setInputFiles(houseFiles());
  await expect(page.locator(".scene-bar")).toContainText("files");
  await expect(page.locator(".parts canvas")).toHaveCount(6);
  const slider = page.getByRole("slider", { name: /height of the point/ });
  const before = await slider.inputValue();
  await slider.press("ArrowRight");
  expect(await slider.inputValue()).not.toBe(before);
  await page.goto("/lessons.html#lesson=epipolar&screen=own");
  await expect(page.locator(".parts canvas")).toHaveCount(5);
  await expect(page.locator(".parts line.on-photo").first()).toBeVisible();
  await page.goto("/lessons.html#lesson=lines-in-space&screen=own");
  await expect(page.locator("ridgeline-figure").getByTestId("accuracy")).toBeVisible({ timeout: 60_000 });
  expect(said).toEqual([]);
});

test("on paper: the whole lesson, without controls", async ({ page }) => {
  await page.route("**/demo/**", (route) => route.abort());
  await page.goto("/lessons.html#lesson=roofs");
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  await page.emulateMedia({ media: "print" });
  await expect(page.locator(".screen")).toHaveCount(6);
  await expect(page.locator(".teaching-head")).toBeHidden();
  await expect(page.locator(".handout-button")).toBeHidden();
  await page.emulateMedia({ media: "screen" });
  await page.evaluate(() => window.dispatchEvent(new Event("afterprint")));
  await expect(page.locator(".screen")).toHaveCount(1);
});
