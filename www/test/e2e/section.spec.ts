/** The section tool: two clicks cut the model and draw its profile. And the uncertainty of lines. */
import { expect, type Locator, type Page, test } from "@playwright/test";
import { lookOf, openDemo, openTab, steadyLook, switchLayer, waitForStage, watch } from "./helpers";

/** Clicks a place of the viewer, as shares of its width and height. */
async function clickAt(viewer: Locator, x: number, y: number): Promise<void> {
  const box = await viewer.boundingBox();
  await viewer.click({ position: { x: x * (box?.width ?? 0), y: y * (box?.height ?? 0) } });
}

async function openModel(page: Page): Promise<Locator> {
  await page.goto("/");
  await openDemo(page);
  await waitForStage(page, "model");
  // The camera stands where the preliminary model put it.
  await page.getByRole("button", { name: "Fit" }).click();
  return page.getByTestId("viewer");
}

test("a cut through the model shows its profile, and lines their uncertainty", async ({ page }) => {
  const { problems } = watch(page);
  const viewer = await openModel(page);
  await switchLayer(page, "Plain");
  const whole = await steadyLook(page, viewer);

  await test.step("two clicks make a section", async () => {
    await page.getByRole("button", { name: "Section" }).click();
    await expect(page.getByText("Click the two ends of the cut.")).toBeVisible();
    await clickAt(viewer, 0.2, 0.55);
    await clickAt(viewer, 0.75, 0.45);
    const section = page.getByTestId("section");
    await expect(section).toBeVisible();
    await expect.poll(() => section.locator("line.profile").count()).toBeGreaterThan(3);
    const [panel, cut] = [await section.boundingBox(), await viewer.boundingBox()];
    expect(panel?.y).toBeGreaterThanOrEqual((cut?.y ?? 0) + (cut?.height ?? 0) - 1);
    expect(cut?.height).toBeGreaterThan(150);
    await expect(section.locator(".profile-slope").first()).toHaveText(/^-?\d+\.\d°$/);
    const [, length = "", low = "", high = ""] =
      /([\d.]+) m long, heights ([\d.]+) to ([\d.]+) m/.exec(await section.getByText(/m long/).innerText()) ??
      [];
    expect(Number(length)).toBeGreaterThan(10);
    expect(Number(high) - Number(low)).toBeGreaterThan(2);
    expect(Number(high) - Number(low)).toBeLessThan(40);
  });

  await test.step("the model is cut away on one side, on the other, or not at all", async () => {
    await page.getByTestId("section").evaluate((box) => {
      box.style.visibility = "hidden";
    });
    const one = await steadyLook(page, viewer);
    expect(one.drawn).toBeLessThan(whole.drawn);
    await page.getByTestId("section").evaluate((box) => {
      box.style.visibility = "";
    });
    await page.getByRole("button", { name: "Whole model" }).click();
    await page.getByRole("button", { name: "Section" }).click();
    await expect(page.getByTestId("section")).toHaveCount(0);
  });

  await test.step("tubes about the lines, and their scale in the legend", async () => {
    await openTab(page, "3D lines");
    const plain = await steadyLook(page, viewer);
    await switchLayer(page, "Uncertainty");
    await expect(page.getByText(/^1 σ, drawn \d+ × as large$/)).toBeVisible();
    await expect(async () => {
      expect((await lookOf(page, viewer)).vivid).toBeGreaterThan(1.1 * plain.vivid);
    }).toPass({ timeout: 20_000 });
  });
  expect(problems).toEqual([]);
});
