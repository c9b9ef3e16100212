/** Both methods for one model (`--method combined`). */
import { expect, test } from "@playwright/test";
import {
  chooseMethod,
  lookOf,
  openHouse,
  openParameters,
  openTab,
  runButton,
  stage,
  switchLayer,
  tabOf,
  waitForStage,
  watch,
} from "./helpers";

test("both methods find one model of a house, and each view tells of its own stages", async ({ page }) => {
  test.slow();
  const { problems } = watch(page);
  await openHouse(page);
  await chooseMethod(page, "Combined");
  await expect(tabOf(page, "Clusters")).toBeVisible();
  await expect(tabOf(page, "Half-planes")).toBeVisible();
  await expect(page).toHaveURL(/method=combined/);
  await runButton(page).click();
  await waitForStage(page, "model");
  const names = await page
    .locator("[data-stage]")
    .evaluateAll((all) => all.map((one) => one.dataset["stage"]));
  expect(names).toEqual([
    ...["segments", "matches", "adjustment"],
    ...["regions", "directions", "clusters"],
    ...[
      "lines",
      "ground",
      "rectangles",
      "halfplanes",
      "dense",
      "groups",
      "facets",
      "refinement",
      "corrections",
      "model",
    ],
  ]);

  await test.step("the model is seen, by the method that made each facet", async () => {
    const viewer = page.getByTestId("viewer");
    await openTab(page, "Model");
    await expect(async () => {
      expect((await lookOf(page, viewer)).drawn).toBeGreaterThan(0.03);
    }).toPass({ timeout: 20_000 });
    await switchLayer(page, "By method");
    await expect(page.getByTestId("method-legend").getByRole("listitem")).toHaveCount(3);
  });

  await test.step("groups say how many rectangles lie in their plane", async () => {
    await openTab(page, "Groups");
    await expect(
      page
        .getByTestId("groups")
        .getByText(/\d+ rectangles/)
        .first(),
    ).toBeVisible();
  });

  await test.step("clusters are of regions, 3D lines of all", async () => {
    const linesOf = async (name: string) =>
      Number(
        (/([\d,]+) lines/.exec((await stage(page, name).textContent()) ?? "")?.[1] ?? "").replace(",", ""),
      );
    const [clusters, lines] = [await linesOf("clusters"), await linesOf("lines")];
    expect(clusters).toBeGreaterThan(0);
    expect(lines).not.toBe(clusters);
    await openTab(page, "Clusters");
    await expect(page.getByTestId("cluster-plane").locator(".cluster").first()).toBeAttached();
    await openTab(page, "Rectangles");
    const options = await page.getByLabel("Pair of lines").getByRole("option").allTextContents();
    expect(options.some((text) => text.endsWith("selected"))).toBe(true);
  });

  await test.step("a parameter of half-planes leaves the rectangles alone", async () => {
    await openTab(page, "Half-planes");
    await openParameters(page, "Half-plane sweep");
    const field = page.locator("#param-sweep-min_similarity");
    await field.fill("0.5");
    await field.press("Enter");
    await expect(stage(page, "rectangles")).toHaveAttribute("data-status", "done");
    await expect(stage(page, "lines")).toHaveAttribute("data-status", "done");
    await expect(stage(page, "halfplanes")).toHaveAttribute("data-status", "outdated");
  });
  expect(problems).toEqual([]);
});
