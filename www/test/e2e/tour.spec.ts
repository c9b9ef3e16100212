/** The guided tour: every question can be answered in the view that it is about, and not by anything else. */
import { expect, type Locator, type Page, test } from "@playwright/test";
import { onePage, pickUntil, waitForStage } from "./helpers";

let page: Page;

onePage(
  async (opened) => {
    page = opened;
    await page.getByRole("button", { name: "Tour" }).click();
    await expect(lesson()).toContainText("Step 1 of 9");
    await waitForStage(page, "model");
  },
  async () => {
    await lesson().getByRole("button", { name: "End tour" }).click();
    await expect(lesson()).toHaveCount(0);
  },
);

const lesson = () => page.getByTestId("lesson");
const answer = () => lesson().getByText("✓");
const isAnswered = () => answer().isVisible();
const picked = () => page.getByTestId("inspector").locator(".picked");
const viewer = () => page.getByTestId("viewer");

/** At the step of this number, whose question is still open. */
async function isAsked(step: number, tab: string): Promise<void> {
  if (step > 1) {
    await lesson().getByRole("button", { name: "Next" }).click();
  }
  await expect(lesson()).toContainText(`Step ${step} of 9`);
  await expect(page.getByRole("tab", { name: tab, exact: true })).toHaveAttribute("aria-selected", "true", {
    timeout: 120_000,
  });
  await expect(lesson()).toContainText("Not found yet.");
}

/** A number of the inspector, by its label. */
async function numberOf(label: RegExp): Promise<number> {
  const row = page.getByTestId("inspector").locator("div", { hasText: label }).last();
  return Number(/[\d.]+/.exec((await row.locator("dd").textContent()) ?? "")?.[0]);
}

async function pickIn(element: Locator): Promise<void> {
  await pickUntil(element, isAnswered);
}

test("1: a segment of more than 100 pixels", async () => {
  await isAsked(1, "Segments");
  await pickIn(page.locator(".image-view canvas").first());
  await expect(picked()).toHaveText(/^Segment \d+/);
  expect(await numberOf(/^Length/)).toBeGreaterThan(100);
});

test("2: a segment with candidates in three other views", async () => {
  await isAsked(2, "Matches");
  const candidates = page.locator(".candidates");
  await pickUntil(page.locator(".image-view canvas").first(), async () => {
    if ((await picked().count()) > 0) {
      // They come from the worker: the next click would take the segment away.
      await candidates.waitFor();
    }
    return (await candidates.locator("tbody tr").count()) >= 3 && isAnswered();
  });
});

test("3: the point is dragged until the windows correlate", async () => {
  await isAsked(3, "Matches");
  const along = page.getByTestId("along");
  await expect(along).toBeVisible();
  for (let at = 0.05; at < 1 && !(await isAnswered()); at += 0.05) {
    await along.fill(at.toFixed(2));
    await page.waitForTimeout(80);
  }
  await expect(answer()).toBeVisible();
});

test("4: a line, after growing and not before", async () => {
  await isAsked(4, "3D lines");
  await expect(page.getByRole("button", { name: "Before growing" })).toHaveAttribute("aria-pressed", "true");
  await page.getByTestId("accuracy").click({ position: { x: 200, y: 110 } });
  await expect(picked()).toHaveText(/^3D line \d+$/);
  await expect(answer()).toHaveCount(0);
  await page.getByRole("button", { name: "Clear" }).click();
  await page.getByRole("button", { name: "After", exact: true }).click();
  await expect(answer()).toHaveCount(0);
  await pickIn(viewer());
  await expect(picked()).toHaveText(/^3D line \d+$/);
});

test("5: theta is turned until it is right", async () => {
  await isAsked(5, "Half-planes");
  const slider = page.getByLabel(/Angle of the half-plane/);
  await expect(slider).toBeVisible();
  await expect(page.getByTestId("theta")).not.toHaveText(/^0\.0/);
  await expect(lesson()).toContainText("Not found yet.");
  // The page answers with the last angle that the worker has warped: a slow machine needs a slower hand.
  for (const pause of [60, 250, 600]) {
    for (let theta = -60; theta <= 60 && !(await isAnswered()); theta += 2) {
      await slider.fill(String(theta));
      await page.waitForTimeout(pause);
    }
  }
  await expect(answer()).toBeVisible();
});

test("6: a rejected side, with the reason", async () => {
  await isAsked(6, "Half-planes");
  await pickIn(viewer());
  await expect(page.getByTestId("inspector")).toContainText(
    /peak is too low|curve is too flat|amplitude is too small|too little texture|too few views|improbable|probability is too low/,
  );
});

test("7: a group of at least four lines, and none of fewer", async () => {
  await isAsked(7, "Groups");
  const groups = page.getByTestId("groups").getByRole("button");
  const count = await groups.count();
  for (let i = 0; i < count && !(await isAnswered()); i += 1) {
    await groups.nth(i).click();
    await expect(picked()).toHaveText(/^Group \d+$/);
    const lines = await page
      .getByTestId("inspector")
      .locator("div", { hasText: /^3D lines/ })
      .getByRole("button")
      .count();
    await expect(answer()).toHaveCount(lines >= 4 ? 1 : 0);
  }
  await expect(answer()).toBeVisible();
});

test("8: model and photograph over each other", async () => {
  await isAsked(8, "Model");
  await page.getByLabel("Look through the camera of a view").selectOption({ index: 1 });
  await expect(answer()).toBeVisible();
  await page.getByLabel("Opacity of the photograph").fill("0.5");
  await expect(page.getByTestId("photograph")).toHaveCSS("opacity", "0.5");
});

test("9: a line of the other method, in the cluster plane", async () => {
  await isAsked(9, "Clusters");
  await page.locator(".cluster").first().click({ force: true });
  await expect(picked()).toHaveText(/^3D line \d+$/);
  await expect(answer()).toBeVisible();
});
