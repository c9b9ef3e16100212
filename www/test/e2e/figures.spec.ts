/** Each figure of B99 shows what the core found, and follows what is pointed at. One run of the demo scene for all. */
import { readFileSync } from "node:fs";
import { expect, type Page, test } from "@playwright/test";
import {
  lookOf,
  onePage,
  openDemo,
  openParameters,
  openTab,
  pickUntil,
  reopen,
  runButton,
  showFace,
  stage,
  steadyLook,
  switchLayer,
  tabOf,
  waitForStage,
} from "./helpers";

let page: Page;

onePage(async (opened) => {
  page = opened;
  await openDemo(page);
  await showFace(page, "Method");
  await waitForStage(page, "model");
});

const inspector = () => page.getByTestId("inspector");
const allViews = () => page.getByRole("group", { name: "View" }).getByRole("button", { name: "All" });

/** Nothing selected, whatever was. */
async function clear(): Promise<void> {
  const button = page.getByRole("button", { name: "Clear" });
  if (await button.isVisible()) {
    await button.click();
  }
}

/** Picks a matched segment of the first view. */
async function pickMatchedSegment(): Promise<void> {
  await openTab(page, "Matches");
  await page.getByRole("group", { name: "View" }).getByRole("button", { name: /_01/ }).first().click();
  const rows = page.locator(".candidates tbody tr");
  await pickUntil(
    page.locator(".image-view canvas").first(),
    async () =>
      (await rows.count()) >= 2 &&
      (await inspector()
        .getByText(/^matched, in match/)
        .isVisible()),
  );
}

test("figures 1 to 4: beams, candidates and their scores, pointwise correspondence", async () => {
  await pickMatchedSegment();
  const scores = await page.locator(".candidates tbody td:nth-child(2)").allTextContents();
  const numbers = scores.map(Number);
  expect(numbers.every((score) => score > 0 && score <= 1)).toBe(true);
  expect(numbers).toEqual([...numbers].sort((a, b) => b - a));

  await allViews().click();
  const other = page.locator(".image-view canvas").nth(1);
  const marked = await lookOf(page, other);
  const correlation = page.getByTestId("correlation");
  await expect(correlation).toHaveText(/^-?[01]\.\d\d$/);
  const first = await correlation.textContent();
  await page.getByTestId("along").fill("0.05");
  await expect(correlation).not.toHaveText(first ?? "");
  await page.getByRole("button", { name: "Clear" }).click();
  await expect(page.getByTestId("point-lab")).toHaveCount(0);
  const plain = await lookOf(page, other);
  expect(marked).not.toEqual(plain);
});

test("a segment leads to its 3D line, and that to its segments, half-planes and facets", async () => {
  await pickMatchedSegment();
  const title = inspector().locator(".picked");
  const segment = await title.textContent();
  await inspector()
    .locator("div", { hasText: /^3D line/ })
    .getByRole("button")
    .first()
    .click();
  await expect(title).toHaveText(/^3D line \d+$/);
  const name = /^Segment (\d+) of (.*)$/.exec(segment ?? "");
  const own = inspector()
    .locator("div", { hasText: new RegExp(`^${name?.[2]}`) })
    .getByRole("button", { name: name?.[1] ?? "", exact: true });
  await expect(own).toBeVisible();
  await inspector().getByRole("button", { name: "σ", exact: true }).click();
  await expect(inspector().getByText("the square root of the variance")).toBeVisible();
  await page.keyboard.press("Escape");
  await own.click();
  await expect(title).toHaveText(segment ?? "");
});

test("figures 5 to 9: lines before and after growing, accuracy against views", async () => {
  await openTab(page, "3D lines");
  const viewer = page.getByTestId("viewer");
  const after = await lookOf(page, viewer);
  await page.getByRole("button", { name: "Before growing" }).click();
  await expect(async () => {
    const before = await lookOf(page, viewer);
    expect(before.drawn).toBeLessThan(after.drawn);
    expect(before.drawn).toBeGreaterThan(0.2 * after.drawn);
  }).toPass({ timeout: 20_000 });
  await page.getByRole("button", { name: "After", exact: true }).click();

  const lines = Number(
    /([\d,]+) lines/.exec((await stage(page, "lines").textContent()) ?? "")?.[1]?.replace(",", ""),
  );
  await expect(page.getByTestId("accuracy").locator(".dot-line")).toHaveAttribute(
    "data-count",
    String(lines),
  );
  await page.getByTestId("accuracy").click({ position: { x: 200, y: 110 } });
  await expect(inspector().locator(".picked")).toHaveText(/^3D line \d+$/);
  // The picked line lights up in every view that shows it.
  expect(await page.getByTestId("filmstrip").locator("canvas").count()).toBeGreaterThanOrEqual(3);
});

test("figures 10 to 14: theta is dragged, the windows and Sim follow", async () => {
  await page.goto("/#scene=demo&tab=halfplanes&select=halfplane:0");
  const lab = page.getByTestId("sim-lab");
  await expect(lab.locator(".windows li")).toHaveCount(6);
  const theta = page.getByTestId("theta");
  // The posterior of a side with a half-plane: a plane is there, and most of the area is near one angle.
  await expect(page.getByTestId("plane-probability")).toHaveText(/P\(plane\) (0\.[5-9]\d|1\.00)/);
  const area = await page.getByTestId("posterior").boundingBox();
  expect(area?.height).toBeGreaterThan(40);
  const sims = lab.locator(".windows .numbers");
  const best = await sims.allTextContents();
  const start = await theta.textContent();
  const look = await lookOf(page, lab.locator(".windows canvas").nth(1));

  const chart = page.getByTestId("sim-chart");
  const box = await chart.boundingBox();
  await page.mouse.move((box?.x ?? 0) + 0.5 * (box?.width ?? 0), (box?.y ?? 0) + 60);
  await page.mouse.down();
  await page.mouse.move((box?.x ?? 0) + 0.93 * (box?.width ?? 0), (box?.y ?? 0) + 60, { steps: 5 });
  await page.mouse.up();
  await expect(theta).toHaveText(/^[56]\d\.\d°$/);
  await expect(sims.nth(1)).not.toHaveText(best[1] ?? "");
  const number = (texts: string[]) =>
    texts.slice(1).reduce((sum, text) => sum + Number(text.replace("Sim ", "")), 0);
  expect(number(await sims.allTextContents())).toBeLessThan(number(best));
  expect(await lookOf(page, lab.locator(".windows canvas").nth(1))).not.toEqual(look);

  await page.getByRole("button", { name: "Best" }).click();
  await expect(theta).toHaveText(start ?? "");
  await expect(sims.nth(1)).toHaveText(best[1] ?? "");
  // By key as well.
  await page.getByLabel(/Angle of the half-plane/).press("ArrowRight");
  await expect(theta).not.toHaveText(start ?? "");
});

test("figures 16 to 23: groups, border lines and facets", async () => {
  await openTab(page, "Groups");
  await page.getByTestId("groups").getByRole("button").first().click();
  await expect(inspector().locator(".picked")).toHaveText(/^Group \d+$/);
  expect(await page.getByTestId("filmstrip").locator("canvas").count()).toBeGreaterThanOrEqual(3);

  await openTab(page, "Facets");
  const facets = Number(/(\d+) facets/.exec((await stage(page, "refinement").textContent()) ?? "")?.[1]);
  await expect(page.getByTestId("plan").locator(".plan-facet")).toHaveCount(facets);
  const borders = page.getByTestId("plan").locator(".border-real[data-count]");
  expect(Number(await borders.getAttribute("data-count"))).toBeGreaterThan(facets);
  await page.getByTestId("plan").locator(".plan-facet").first().press("Enter");
  await expect(inspector().locator(".picked")).toHaveText("Facet 1");
  await inspector()
    .locator("div", { hasText: /^3D lines/ })
    .getByRole("button")
    .first()
    .click();
  await expect(inspector().locator(".picked")).toHaveText(/^3D line \d+$/);
});

test("dense planes: patches by class, in plan and in space, and what became of a plane", async () => {
  await openTab(page, "Dense planes");
  const planes = Number(/([\d,]+) planes/.exec((await stage(page, "dense").textContent()) ?? "")?.[1]);
  expect(planes).toBeGreaterThan(2);
  const viewer = page.getByTestId("viewer");
  await clear();
  const plain = await steadyLook(page, viewer);
  expect(plain.vivid).toBeGreaterThan(0.05);

  const lab = page.getByTestId("dense-lab");
  const plan = page.getByTestId("dense-plan");
  await expect(plan).toHaveAttribute("aria-label", new RegExp(`^Plan of ${planes} dense planes`));
  const drawn = async () => {
    const counts = await plan
      .locator(".dense-patches")
      .evaluateAll((all) => all.map((one) => Number((one as SVGElement).dataset["count"])));
    return counts.reduce((sum, count) => sum + count, 0);
  };
  const inPlanes = await drawn();
  expect(inPlanes).toBeGreaterThan(100);
  await lab.getByRole("button", { name: "Probability of building" }).click();
  await expect(plan.locator(".class-vegetation")).toHaveCount(0);
  // The same patches in other colours.
  expect(await drawn()).toBe(inPlanes);
  await lab.getByRole("button", { name: "Classes" }).click();

  const title = inspector().locator(".picked");
  const fact = (label: RegExp) => inspector().locator("div", { hasText: label }).last();
  await pickUntil(plan, async () => /^Dense plane/.test((await title.allTextContents())[0] ?? ""));
  const name = (await title.textContent()) ?? "";
  await expect(plan.locator(".chosen-ring")).toHaveCount(1);
  const shares = (await fact(/^It is/).textContent())?.match(/\d+(?= %)/g)?.map(Number) ?? [];
  expect(shares).toHaveLength(3);
  expect(Math.abs(shares.reduce((sum, share) => sum + share, 0) - 100)).toBeLessThanOrEqual(3);
  await expect(fact(/^Slope/)).toContainText(/\d+\.\d° ± \d+\.\d°/);
  await expect(inspector().locator(".evidence").first()).toContainText("height above the ground");
  expect(await page.getByTestId("filmstrip").locator("canvas").count()).toBeGreaterThanOrEqual(3);
  expect(await steadyLook(page, viewer)).not.toEqual(plain);

  // A facet leads to the plane that proposed it.
  const next = page.getByRole("button", { name: "Next item" });
  const facets = fact(/^Facets/).getByRole("button");
  for (let i = 0; i < planes && (await facets.count()) === 0; i += 1) {
    await next.click();
  }
  const proposed = (await title.textContent()) ?? name;
  await facets.first().click();
  await expect(title).toHaveText(/^Facet \d+$/);
  await fact(/^Dense planes/)
    .getByRole("button", { name: /\d+/.exec(proposed)?.[0] ?? "", exact: true })
    .click();
  await expect(title).toHaveText(proposed);
});

test("what was rejected is picked, too: it says why, and shows in every view and in space", async () => {
  const title = inspector().locator(".picked");
  await openTab(page, "Segments");
  await page.getByRole("button", { name: "Rejected lines" }).click();
  await page.getByRole("group", { name: "View" }).getByRole("button", { name: /_01/ }).first().click();
  await pickUntil(page.locator(".image-view canvas").first(), async () =>
    /^Rejected line/.test((await title.allTextContents())[0] ?? ""),
  );
  await expect(inspector().locator("div", { hasText: /^Rejected/ })).toContainText(
    /curve|texture|segment already/,
  );

  await openTab(page, "Facets");
  await clear();
  const rejectedFacets = page.getByTestId("plan").locator(".plan-rejected");
  await expect(page.locator(".plan .legend")).toContainText(`rejected ${await rejectedFacets.count()}`);
  const plain = await steadyLook(page, page.getByTestId("viewer"));
  await rejectedFacets.first().press("Enter");
  await expect(title).toHaveText("Rejected facet 1");
  // In words and with the number that decided, whichever reason comes first; a reason without words has neither.
  await expect(inspector().locator("div", { hasText: /^Rejected/ })).toContainText(/[a-z] [a-z]+ .*\d/);
  expect(await page.getByTestId("filmstrip").locator("canvas").count()).toBeGreaterThanOrEqual(3);
  expect((await steadyLook(page, page.getByTestId("viewer"))).vivid).not.toEqual(plain.vivid);
});

test("everything is reached by key, and lights up in tabs that are not about it", async () => {
  await openTab(page, "Half-planes");
  await clear();
  const next = page.getByRole("button", { name: "Next item" });
  const title = inspector().locator(".picked");
  const seen = new Set<string>();
  for (let i = 0; i < 30 && seen.size < 2; i += 1) {
    await next.press("Enter");
    seen.add(/^Half-plane/.test((await title.textContent()) ?? "") ? "accepted" : "rejected");
  }
  // The sides of all lines, those without a half-plane among them.
  expect([...seen].sort()).toEqual(["accepted", "rejected"]);
  await page.getByRole("button", { name: "Previous item" }).press("Enter");
  await openTab(page, "Model");
  const viewer = page.getByTestId("viewer");
  const marked = await steadyLook(page, viewer);
  await clear();
  await page.waitForTimeout(300);
  expect(await steadyLook(page, viewer)).not.toEqual(marked);
});

test("refinement: outlines before, relations by their chi-square, adopted and rejected", async () => {
  await openTab(page, "Refinement");
  const lab = page.getByTestId("refinement-lab");
  await expect(lab.locator("option").first()).toHaveText(/\d\.\d\d → \d\.\d\d px|not refined/);
  const limit = Number(
    await page
      .locator("#param-roof-refine-relation_chi2")
      .evaluate((input) => (input as HTMLInputElement).value),
  );
  const dots = lab.locator(".relation");
  await expect(dots.nth(3)).toBeVisible();
  for (const dot of await dots.all()) {
    const [, chi2, verdict] =
      /χ² ([\d.]+), (adopted|rejected)$/.exec((await dot.getAttribute("aria-label")) ?? "") ?? [];
    expect(Number(chi2) <= limit + 0.05).toBe(verdict === "adopted");
  }
  const viewer = page.getByTestId("viewer");
  await clear();
  const plain = await steadyLook(page, viewer);
  await dots.first().press("Enter");
  await expect(inspector().locator(".picked")).toHaveText(/^Relation \d+$/);
  await expect(inspector().getByText("Deviation of the free solution")).toBeVisible();
  expect(await page.getByTestId("filmstrip").locator("canvas").count()).toBeGreaterThanOrEqual(3);
  expect(await steadyLook(page, viewer)).not.toEqual(plain);
  await inspector()
    .locator("div", { hasText: /^Building/ })
    .getByRole("button")
    .click();
  await inspector()
    .locator("div", { hasText: /^Facets/ })
    .getByRole("button")
    .first()
    .click();
  await expect(inspector().locator(".picked")).toHaveText(/^Facet \d+$/);
  await expect(inspector().locator("div", { hasText: /^Refined/ })).toBeVisible();
});

test("the viewer: normals, cameras, measuring, a picture, and a view's own camera", async () => {
  await openTab(page, "Model");
  const viewer = page.getByTestId("viewer");
  await clear();
  await page.getByRole("button", { name: "Fit" }).click();
  const textured = await steadyLook(page, viewer);
  await switchLayer(page, "Normals");
  await expect(async () => {
    expect((await lookOf(page, viewer)).vivid).toBeGreaterThan(textured.vivid + 0.03);
  }).toPass({ timeout: 20_000 });

  const facets = /(\d+) facets/.exec((await stage(page, "refinement").textContent()) ?? "")?.[1];
  const normals = await lookOf(page, viewer);
  await switchLayer(page, "By method");
  await expect(page.getByTestId("method-legend")).toHaveText(
    `Lines (Baillard et al. 1999): ${facets} facetsRectangles (Wiman, Axelsson 1996): 0 facets`,
  );
  await expect(async () => {
    expect(await lookOf(page, viewer)).not.toEqual(normals);
  }).toPass({ timeout: 20_000 });

  await page.getByRole("button", { name: "Measure" }).click();
  const reading = page.getByTestId("reading");
  const box = await viewer.boundingBox();
  for (let i = 0; i < 80 && !(await reading.getByText("Slope").isVisible()); i += 1) {
    const x = (box?.width ?? 0) * (0.3 + 0.045 * (i % 10));
    const y = (box?.height ?? 0) * (0.3 + 0.07 * Math.floor(i / 10));
    await viewer.click({ position: { x, y } });
  }
  await expect(reading).toContainText(/Distance\d+\.\d\d m/);
  await expect(reading).toContainText("Slope");
  await page.getByRole("button", { name: "Measure" }).click();
  await expect(reading).toHaveCount(0);

  const [picture] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: "Picture" }).click(),
  ]);
  expect(picture.suggestedFilename()).toBe("model.png");

  await switchLayer(page, "Textured");
  await page.getByLabel("Look through the camera of a view").selectOption({ index: 1 });
  const slider = page.getByLabel("Opacity of the photograph");
  await slider.fill("0");
  const model = await lookOf(page, page.locator(".space-canvas"));
  await slider.fill("1");
  await expect(page.getByTestId("photograph")).toHaveCSS("opacity", "1");
  const photograph = await lookOf(page, page.locator(".space-canvas"));
  expect(model.drawn).toBeGreaterThan(0.05);
  expect(photograph).not.toEqual(model);
  await page.getByRole("button", { name: "Fit" }).click();
  await expect(page.getByTestId("photograph")).toHaveCount(0);
});

test("a cut through the model shows its profile, and lines their uncertainty", async () => {
  await openTab(page, "Model");
  await clear();
  await page.getByRole("button", { name: "Fit" }).click();
  const viewer = page.getByTestId("viewer");
  await switchLayer(page, "Plain");
  const whole = await steadyLook(page, viewer);
  const clickAt = async (x: number, y: number) => {
    const { width = 0, height = 0 } = (await viewer.boundingBox()) ?? {};
    await viewer.click({ position: { x: x * width, y: y * height } });
  };

  await page.getByRole("button", { name: "Section" }).click();
  await expect(page.getByText("Click the two ends of the cut.")).toBeVisible();
  await clickAt(0.2, 0.55);
  await clickAt(0.75, 0.45);
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

  // The model is cut away on one side.
  await section.evaluate((box) => {
    box.style.visibility = "hidden";
  });
  expect((await steadyLook(page, viewer)).drawn).toBeLessThan(whole.drawn);
  await section.evaluate((box) => {
    box.style.visibility = "";
  });
  await page.getByRole("button", { name: "Whole model" }).click();
  await page.getByRole("button", { name: "Section" }).click();
  await expect(section).toHaveCount(0);
  await switchLayer(page, "Textured");

  // Tubes about the lines, and their scale in the legend.
  await openTab(page, "3D lines");
  const plain = await steadyLook(page, viewer);
  await switchLayer(page, "Uncertainty");
  await expect(page.getByText(/^1 σ, drawn \d+ × as large$/)).toBeVisible();
  await expect(async () => {
    expect((await lookOf(page, viewer)).vivid).toBeGreaterThan(1.1 * plain.vivid);
  }).toPass({ timeout: 20_000 });
});

test("only the stages behind a changed parameter run again", async () => {
  const time = (name: string) => stage(page, name).locator(".muted.numbers").textContent();
  const before = await time("matches");
  await openParameters(page, "Grouping and facets");
  const field = page.locator("#param-roof-min_area_m2");
  await field.fill("6");
  await field.press("Enter");
  await expect(stage(page, "halfplanes")).toHaveAttribute("data-status", "done");
  await expect(stage(page, "facets")).toHaveAttribute("data-status", "outdated");
  const ran: string[] = [];
  await page.exposeFunction("ranStage", (name: string) => ran.push(name));
  await page.evaluate(() => {
    const watchStage = (window as unknown as { ranStage(name: string): void }).ranStage;
    for (const card of document.querySelectorAll<HTMLElement>("[data-stage]")) {
      new MutationObserver(() => {
        if (card.dataset["status"] === "running") {
          watchStage(card.dataset["stage"] ?? "");
        }
      }).observe(card, { attributes: true, attributeFilter: ["data-status"] });
    }
  });
  await runButton(page).click();
  await waitForStage(page, "model");
  expect([...new Set(ran)]).toEqual(["facets", "refinement", "corrections", "model"]);
  expect(await time("matches")).toBe(before);
  await expect(page).toHaveURL(/params=.*min_area_m2/);
});

test("a link shows the stage, the method's parameters and the selection: a new line of the model, behind the matched ones", async () => {
  const matched = Number(/(\d+) lines/.exec((await stage(page, "lines").textContent()) ?? "")?.[1]);
  // Such a link needs more than its tab: the line comes with the model.
  const params = new URLSearchParams(new URL(page.url()).hash.slice(1)).get("params") ?? "";
  const fields = new URLSearchParams({ scene: "demo", tab: "lines", params, select: `line:${matched}` });
  await reopen(page, "3D lines", fields.toString());
  // What was found before the page was opened again is kept.
  await expect(stage(page, "model")).toHaveAttribute("data-status", "done");
  await waitForStage(page, "refinement");
  await expect(tabOf(page, "3D lines")).toHaveAttribute("aria-selected", "true");
  await expect(inspector().locator(".picked")).toHaveText(`3D line ${matched + 1}`);
  await expect(inspector().locator("div", { hasText: /^Found/ })).toContainText("new: ");
  await expect(page.getByTestId("accuracy").locator(".dot-line")).toHaveAttribute(
    "data-count",
    String(matched),
  );
});

test("what a tab shows is taken along: as an SVG file with its photographs, and its numbers", async () => {
  await pickMatchedSegment();
  const panel = page.getByRole("region", { name: "Take along" });
  await panel.getByText("Take along").click();
  const saved = async (name: string) => {
    const download = page.waitForEvent("download");
    await panel.getByRole("button", { name, exact: true }).click();
    return readFileSync(await (await download).path(), "utf8");
  };
  const found = await page.evaluate(
    (text) => {
      const parsed = new DOMParser().parseFromString(text, "image/svg+xml");
      const count = (selector: string) => parsed.querySelectorAll(selector).length;
      return [count("parsererror"), count('image[href^="data:image/jpeg"]'), count("path")] as const;
    },
    await saved("SVG"),
  );
  expect(found.slice(0, 2)).toEqual([0, 1]);
  expect(found[2]).toBeGreaterThan(5);
  const candidates = await page.locator(".candidates tbody tr").count();
  const rows = (await saved("CSV")).trimEnd().split("\r\n");
  expect(new Set(rows.slice(1).map((row) => row.split(",")[0])).size).toBe(candidates);
  await openTab(page, "Facets");
  // Tints are styles of single elements, which a file has to say itself.
  expect(await saved("SVG")).toMatch(/<path[^>]* fill="#[0-9a-f]{6}"/);
  expect((await saved("CSV")).split("\r\n")[0]).toMatch(/^facet,corner,x,y,z,/);
  await panel.getByRole("button", { name: "Cite" }).click();
  await expect(panel.getByRole("textbox", { name: "BibTeX" })).toHaveValue(/Section 4\.3, figures 21 to 23/);
});
