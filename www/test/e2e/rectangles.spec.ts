/** The other method (W96) and its four stages. */
import { expect, test } from "@playwright/test";
import {
  chooseMethod,
  give,
  houseFiles,
  lookOf,
  looksOfHalves,
  openParameters,
  openTab,
  runButton,
  runUpTo,
  showFace,
  stage,
  steadyLook,
  switchLayer,
  tabOf,
  waitForStage,
  watch,
} from "./helpers";

test("a method that is chosen while the core is still compiled stays chosen", async ({ page }) => {
  const { problems } = watch(page);
  let go = () => {};
  const clicked = new Promise<void>((resolve) => {
    go = resolve;
  });
  await page.route(/\.wasm$/, async (route) => {
    await clicked;
    await route.continue();
  });
  await page.goto("/#scene=demo&tab=images");
  await chooseMethod(page, "Rectangles");
  go();
  await expect(stage(page, "regions")).toBeVisible();
  await expect(stage(page, "segments")).toHaveCount(0);
  await expect(tabOf(page, "Clusters")).toBeVisible();
  expect(problems).toEqual([]);
});

test("regions, directions, clusters and planes of a house", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/#method=rectangles");
  await give(page, houseFiles());
  await showFace(page, "Method");
  await expect(tabOf(page, "Clusters")).toBeVisible();
  await expect(tabOf(page, "Half-planes")).toHaveCount(0);
  await expect(stage(page, "regions")).toBeVisible();
  await expect(stage(page, "segments")).toHaveCount(0);
  await runButton(page).click();
  await waitForStage(page, "model");
  const inspector = page.getByTestId("inspector");
  const image = page.locator(".image-view canvas").first();

  await test.step("figure 3: regions over the image", async () => {
    await openTab(page, "Images");
    const plain = await lookOf(page, image);
    await openTab(page, "Regions");
    expect(await lookOf(page, image)).not.toEqual(plain);
    const box = await image.boundingBox();
    await image.click({ position: { x: (box?.width ?? 0) / 2, y: (box?.height ?? 0) / 2 } });
    await expect(inspector.getByText(/^Region \d+ of /)).toBeVisible();
    await expect(inspector.getByText(/^[\d,]+ px$/).first()).toBeVisible();
  });

  await test.step("figures 4 and 5: two peaks at right angles", async () => {
    await openTab(page, "Directions");
    await expect(page.getByTestId("histogram").locator(".peak-name")).toHaveCount(2);
    const names = await page.getByTestId("histogram").locator(".peak-name").allTextContents();
    const [first, second] = names.map((name) => Number.parseFloat(name)) as [number, number];
    expect(Math.abs(Math.abs(first - second) - 90)).toBeLessThan(0.11);
  });

  await test.step("figures 6 to 9: a cluster's line is shown in every view", async () => {
    await openTab(page, "Clusters");
    await page.getByRole("group", { name: "View" }).getByRole("button", { name: "All" }).click();
    const before = await lookOf(page, image);
    // Also where a rejected cluster lies within the ring.
    for (const ring of await page.getByTestId("cluster-plane").locator(".cluster").all()) {
      await ring.click({ force: true });
      await expect(inspector.locator(".picked")).toHaveText(/^3D line \d+$/);
    }
    await expect(page.locator(".chosen-cluster")).toHaveCount(1);
    await expect(async () => {
      expect(await lookOf(page, image)).not.toEqual(before);
    }).toPass({ timeout: 10_000 });
    // A rejected one, off the rings, says what it would have gained.
    const picked = inspector.locator(".picked");
    const plane = page.getByTestId("cluster-plane");
    await plane
      .locator(".rejected-cluster")
      .nth(await plane.evaluate(loneliest))
      .click({ force: true });
    await expect(picked).toHaveText(/^Rejected cluster \d+ of plane 1$/);
    await expect(inspector.locator("div", { hasText: /^Gain/ })).toContainText(/-?[\d.]+ bit/);
    await page.getByRole("button", { name: "Clear" }).click();
  });

  await test.step("figures 10 to 12: the window of a pair of lines, and why pairs are rejected", async () => {
    await openTab(page, "Rectangles");
    await expect(page.getByTestId("plane-window").locator(".end").first()).toBeAttached();
    // The best pair's window in the views, before anything is picked.
    expect(await page.getByTestId("filmstrip").locator("canvas").count()).toBeGreaterThanOrEqual(3);
    const pairs = page.getByLabel("Pair of lines");
    const options = await pairs.getByRole("option").allTextContents();
    expect(options.some((text) => text.endsWith("selected"))).toBe(true);
    const rejected = options.findIndex((text) => text.includes("near") || text.includes("steep"));
    await pairs.selectOption({ index: rejected });
    await expect(inspector.getByText("Rejected")).toBeVisible();
  });

  await test.step("its parameters stand in the place of the other method's", async () => {
    await openParameters(page, "Planes");
    await expect(page.getByText("Regions (ORIS)", { exact: true })).toBeVisible();
    await expect(page.getByText("Adjacency graphs", { exact: true })).toHaveCount(0);
    const field = page.locator("#param-objectspace-planes-min_area_m2");
    await field.fill("9");
    await field.press("Enter");
    await expect(stage(page, "clusters")).toHaveAttribute("data-status", "done");
    await expect(stage(page, "rectangles")).toHaveAttribute("data-status", "outdated");
  });

  await test.step("the other method begins anew on the same files, and is compared with this one", async () => {
    const facets = /(\d+) facets/.exec((await stage(page, "rectangles").textContent()) ?? "")?.[1] ?? "";
    await page.getByRole("button", { name: "Compare", exact: true }).click();
    await chooseMethod(page, "Lines");
    await expect(stage(page, "segments")).toHaveAttribute("data-status", "waiting");
    await runUpTo(page, "Facets");
    await waitForStage(page, "facets");
    const others = /(\d+) facets/.exec((await stage(page, "facets").textContent()) ?? "")?.[1] ?? "";
    const row = page.getByTestId("comparison").getByRole("row", { name: /^Facets/ });
    await expect(row.getByRole("cell")).toHaveText([facets, others]);
    const viewer = page.getByTestId("viewer");
    const halves = page.getByTestId("halves");
    await expect(halves.getByRole("paragraph")).toHaveText(["Kept: Rectangles", "Now: Lines"]);
    // Without the present facets the right half is empty, and the kept ones stay in the left.
    const turnPresent = () => switchLayer(page, "Facets");
    await steadyLook(page, viewer);
    const [kept, now] = await looksOfHalves(page, viewer);
    expect(kept.vivid).toBeGreaterThan(0.01);
    await turnPresent();
    await expect(async () => {
      const [keptAlone, without] = await looksOfHalves(page, viewer);
      expect(keptAlone.vivid).toBe(kept.vivid);
      expect(without.vivid).toBeLessThan(0.1 * now.vivid);
    }).toPass({ timeout: 20_000 });
    await turnPresent();
    await page.getByRole("button", { name: "Outlines over it" }).click();
    await expect(halves).toHaveCount(0);
    const both = await lookOf(page, viewer);
    await page.getByRole("button", { name: "Discard kept result" }).click();
    await expect(async () => {
      expect((await lookOf(page, viewer)).drawn).toBeLessThan(both.drawn);
    }).toPass({ timeout: 10_000 });
  });
  expect(problems).toEqual([]);
});

/** In the page: the rejected cluster that is farthest from all selected ones. */
function loneliest(chart: Element): number {
  const placesOf = (what: string) =>
    [...chart.querySelectorAll<SVGCircleElement>(what)].map(({ cx, cy }) => [
      cx.baseVal.value,
      cy.baseVal.value,
    ]) as [number, number][];
  const rings = placesOf(".cluster");
  const distances = placesOf(".rejected-cluster").map(([x, y]) =>
    Math.min(...rings.map(([u, v]) => Math.hypot(x - u, y - v))),
  );
  return distances.indexOf(Math.max(...distances));
}
