/** The guided tour: every question can be answered in the view that it is about, and not by anything else. */
import { expect, type Locator, type Page, test } from "@playwright/test";
import { onePage, pickUntil, tabOf, waitForStage } from "./helpers";

let page: Page;

onePage(
  async (opened) => {
    page = opened;
    await page.getByRole("button", { name: "Tour", exact: true }).click();
    await expect(panel()).toContainText("Step 1 of 12");
    await waitForStage(page, "model");
  },
  async () => {
    await panel().getByRole("button", { name: "End tour" }).click();
    await expect(panel()).toHaveCount(0);
  },
);

const panel = () => page.getByTestId("tour-step");
const answer = () => panel().getByText("✓");
const isAnswered = () => answer().isVisible();
const picked = () => page.getByTestId("inspector").locator(".picked");
const inspector = () => page.getByTestId("inspector");
const viewer = () => page.getByTestId("viewer");
/** The control that the style sheet marks. */
const marked = (control: Locator) => expect(control).toHaveCSS("outline-style", "solid");

/** At the step of this number, whose question is still open. */
async function isAsked(step: number, tab: string): Promise<void> {
  if (step > 1) {
    await panel().getByRole("button", { name: "Next" }).click();
  }
  await expect(panel()).toContainText(`Step ${step} of 12`);
  await expect(tabOf(page, tab)).toHaveAttribute("aria-selected", "true", {
    timeout: 120_000,
  });
  await expect(panel()).toContainText("Not found yet.");
}

/** A number of the inspector, by its label. */
async function numberOf(label: RegExp): Promise<number> {
  const row = page.getByTestId("inspector").locator("div", { hasText: label }).last();
  return Number(/[\d.]+/.exec((await row.locator("dd").textContent()) ?? "")?.[0]);
}

async function pickIn(element: Locator): Promise<void> {
  await pickUntil(element, isAnswered);
}

test("1: a long segment at a side of a facet, and not a kerb", async () => {
  await isAsked(1, "Segments");
  // The longest segment of all is a kerb.
  await page.getByRole("button", { name: "Next item" }).click();
  await expect(picked()).toHaveText(/^Segment 1/);
  expect(await numberOf(/^Length/)).toBeGreaterThan(200);
  await expect(panel()).toContainText("no facet of the model has it as a side");
  await pickIn(page.locator(".image-view canvas").first());
  expect(await numberOf(/^Length/)).toBeGreaterThan(60);
  // What the answer says is what the inspector shows.
  const facet = /side of facet (\d+)/.exec((await answer().textContent()) ?? "")?.[1];
  await inspector()
    .locator("div", { hasText: /^3D line/ })
    .getByRole("button")
    .first()
    .click();
  await expect(
    inspector()
      .locator("div", { hasText: /^Facets/ })
      .last(),
  ).toContainText(String(facet));
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

test("3: the point is dragged from where the windows differ to where they correlate", async () => {
  await isAsked(3, "Matches");
  const along = page.getByTestId("along");
  await expect(along).toBeVisible();
  await expect(along).not.toHaveValue("0.5");
  const correlation = page.getByTestId("correlation");
  expect(Number(/[\d.]+/.exec((await correlation.textContent()) ?? "")?.[0])).toBeLessThan(0.65);
  for (let at = 0.05; at < 1 && !(await isAnswered()); at += 0.05) {
    await along.fill(at.toFixed(2));
    await page.waitForTimeout(80);
  }
  await expect(answer()).toBeVisible();
});

test("4: a line that became longer, after growing and not before", async () => {
  await isAsked(4, "3D lines");
  const before = page.getByRole("button", { name: "Before growing" });
  await expect(before).toHaveAttribute("aria-pressed", "true");
  await marked(before.locator(".."));
  await page.getByTestId("accuracy").click({ position: { x: 200, y: 110 } });
  await expect(picked()).toHaveText(/^3D line \d+$/);
  await expect(answer()).toHaveCount(0);
  await page.getByRole("button", { name: "Clear" }).click();
  await page.getByRole("button", { name: "After", exact: true }).click();
  await expect(answer()).toHaveCount(0);
  await pickIn(viewer());
  await expect(picked()).toHaveText(/^3D line \d+$/);
  const [from = 0, to = 0] = numbersIn(await answer().textContent()).slice(1);
  expect(to - from).toBeGreaterThan(0.4);
  expect(await numberOf(/^Length/)).toBeCloseTo(to, 0);
});

test("5: the windows differ where theta begins, and are alike where it is right", async () => {
  await isAsked(5, "Half-planes");
  const slider = page.getByLabel(/Angle of the half-plane/);
  await expect(slider).toBeVisible();
  await marked(slider);
  await expect(page.getByTestId("theta")).not.toHaveText(/^0\.0/);
  await expect(panel()).toContainText("Not found yet.");
  const begun = await meanSim();
  // The page answers with the last angle that the worker has warped: a slow machine needs a slower hand.
  for (const pause of [60, 250, 600]) {
    for (let theta = -60; theta <= 60 && !(await isAnswered()); theta += 2) {
      await slider.fill(String(theta));
      await page.waitForTimeout(pause);
    }
  }
  await expect(answer()).toBeVisible();
  await expect(async () => {
    expect(begun).toBeLessThan(0.25);
    expect(await meanSim()).toBeGreaterThan(begun + 0.3);
  }).toPass();
});

test("6: a side that agrees at no angle, beside one with a clear peak", async () => {
  await isAsked(6, "Half-planes");
  const chart = page.getByTestId("sim-chart");
  await expect(page.getByTestId("sim-lab").locator(".rejection")).toHaveCount(0);
  await expect.poll(() => maximumOf(chart)).toBeGreaterThan(0.4);
  const other = page.getByRole("button", { name: /Show the (left|right) side/ });
  await marked(other);
  await other.click();
  await expect(answer()).toBeVisible();
  expect(await maximumOf(chart)).toBeLessThan(0.3);
  await expect(page.getByTestId("sim-lab").locator(".rejection")).toContainText(/peak is too low/);
  // A line on the ground has no curve: its chart is empty, and no invalid path is logged (`watch`).
  await page.getByRole("button", { name: "Clear" }).click();
  await page.getByRole("button", { name: "Next item" }).click();
  await expect(page.getByTestId("sim-lab").locator(".rejection")).toContainText("lies on the ground");
  await expect(page.getByTestId("posterior")).toHaveAttribute("d", "");
});

/** The maximum that the chart states. */
async function maximumOf(chart: Locator): Promise<number> {
  return numbersIn(await chart.getAttribute("aria-label")).at(-1) ?? 0;
}

/** Of the windows that are compared with the reference. */
async function meanSim(): Promise<number> {
  const all = await page.getByTestId("windows").getByText(/^Sim /).allTextContents();
  return all.reduce((sum, text) => sum + (numbersIn(text)[0] ?? 0) / all.length, 0);
}

function numbersIn(text: string | null): number[] {
  return (text?.match(/\d+(\.\d+)?/g) ?? []).map(Number);
}

test("7: a dense plane that is a building and became a facet, and no other", async () => {
  await isAsked(7, "Dense planes");
  const next = page.getByRole("button", { name: "Next item" });
  const fact = (label: RegExp) => inspector().locator("div", { hasText: label }).last();
  for (let i = 0; i < 60 && !(await isAnswered()); i += 1) {
    await next.click();
    await expect(picked()).toHaveText(`Dense plane ${i + 1}`);
    const [building = 0, ground = 0, vegetation = 0] = numbersIn(await fact(/^It is/).textContent());
    const isBuilding = building > Math.max(ground, vegetation);
    const isFacet =
      (await fact(/^Facets/)
        .getByRole("button")
        .count()) > 0;
    await expect(answer()).toHaveCount(isBuilding && isFacet ? 1 : 0);
  }
  await expect(answer()).toBeVisible();
});

test("8: a group of at least four lines that became a facet, and no other", async () => {
  await isAsked(8, "Groups");
  const groups = page.getByTestId("groups").getByRole("button");
  const count = await groups.count();
  for (let i = 0; i < count && !(await isAnswered()); i += 1) {
    await groups.nth(i).click();
    await expect(picked()).toHaveText(/^Group \d+$/);
    const linked = (label: RegExp) =>
      inspector().locator("div", { hasText: label }).last().getByRole("button").count();
    const isRight = (await linked(/^3D lines/)) >= 4 && (await linked(/^Facets/)) > 0;
    await expect(answer()).toHaveCount(isRight ? 1 : 0);
  }
  await expect(answer()).toBeVisible();
});

test("9: model and photograph over each other", async () => {
  await isAsked(9, "Model");
  const cameras = page.getByLabel("Look through the camera of a view");
  await marked(cameras);
  await expect(panel()).toContainText(await cameras.locator("option").first().innerText());
  await cameras.selectOption({ index: 1 });
  await expect(answer()).toBeVisible();
  await page.getByLabel("Opacity of the photograph").fill("0.5");
  await expect(page.getByTestId("photograph")).toHaveCSS("opacity", "0.5");
});

test("10: a polygon of a facet, with a side that no line made, and no other", async () => {
  await isAsked(10, "Coplanar sets");
  const next = page.getByRole("button", { name: "Next item" });
  const sides = inspector().locator("div", { hasText: /^Sides without a line/ });
  for (let i = 0; i < 60 && !(await isAnswered()); i += 1) {
    await next.click();
    await expect(picked()).toHaveText(`Coplanar set ${i + 1}`);
    const facets = inspector()
      .locator("div", { hasText: /^Facets/ })
      .last()
      .getByRole("button");
    const isRight = (await sides.count()) > 0 && (await facets.count()) > 0;
    await expect(answer()).toHaveCount(isRight ? 1 : 0);
  }
  await expect(answer()).toBeVisible();
  await expect(page.getByTestId("coplanar-plan").locator(".chosen-ring")).toHaveCount(1);
});

test("11: a corner that proposes planes, and no other", async () => {
  await isAsked(11, "Adjacency");
  await expect(page.getByTestId("adjacency-lab").locator("canvas")).toBeVisible();
  const next = page.getByRole("button", { name: "Next item" });
  const planes = inspector()
    .locator("div", { hasText: /^Planes that it proposes/ })
    .last();
  for (let i = 0; i < 60 && !(await isAnswered()); i += 1) {
    await next.click();
    await expect(picked()).toHaveText(`Corner ${i + 1}`);
    const [, verified = 0] = numbersIn(await planes.textContent());
    await expect(answer()).toHaveCount(verified > 1 ? 1 : 0);
  }
  await expect(answer()).toBeVisible();
  await expect(page.getByTestId("filmstrip").locator("canvas").first()).toBeVisible();
});

test("12: a line of the other method, which the inspector does not call matched", async () => {
  await isAsked(12, "Clusters");
  await page.locator(".cluster").first().click({ force: true });
  await expect(picked()).toHaveText(/^3D line \d+$/);
  await expect(answer()).toBeVisible();
  const [views = 0] = numbersIn(await answer().textContent());
  const facts = inspector().locator("dd");
  await expect(facts.getByText(/show \d+ % of it/)).toHaveCount(views);
  await expect(facts.getByText(/matched/)).toHaveCount(0);
});
