import { readFileSync } from "node:fs";
import { expect, type Locator, test } from "@playwright/test";
import {
  axeFindings,
  demoImages,
  droneControl,
  dronePhotographs,
  give,
  houseFiles,
  lookOf,
  type Upload,
  upload,
  waitForStage,
  watch,
} from "./helpers";

const COMPUTE = "Compute the orientation";

test("photographs alone: cameras in space, a scale, epipolar lines, and on into the reconstruction", async ({
  page,
}) => {
  const { problems } = watch(page);
  const fetched: string[] = [];
  page.on("request", (request) => fetched.push(request.url()));
  const photographs = dronePhotographs();
  await page.goto("/");
  await give(page, photographs);
  await expect(page.getByRole("button", { name: COMPUTE })).toBeEnabled();
  // The visit so far has fetched nothing of it.
  expect(fetched.filter((url) => /orientation/i.test(url))).toEqual([]);

  await page.getByRole("button", { name: COMPUTE }).click();
  const panel = page.getByTestId("orienting");
  await panel.getByRole("button", { name: "Cancel" }).click();
  await expect(panel.getByRole("heading", { name: "The orientation was not computed" })).toBeVisible();
  await panel.getByRole("button", { name: "Compute again" }).click();
  await expect(panel.locator("li.now")).toHaveCount(1);

  const space = page.getByTestId("block-in-space");
  await expect(space).toHaveAttribute("data-cameras", String(photographs.length), { timeout: 60_000 });
  const report = page.getByTestId("orientation-report");
  await expect(report).toContainText(`${photographs.length} of ${photographs.length}`);
  await expect.poll(async () => (await lookOf(page, space.locator("canvas"))).colours).toBeGreaterThan(20);

  // Nothing states metres: the height of flight does.
  await expect(space).toContainText("scale arbitrary");
  const height = report.getByLabel("metres");
  await height.fill("45");
  await height.press("Enter");
  await expect(report).toContainText("scale from the height of the cameras above the points, 45 m");
  await expect(space).toContainText("grid 10 m");
  await expect(report).toContainText(/Of the area \d+ % are shown by 5 photographs or more/);
  const coverage = report.getByTestId("coverage-plan");
  await expect(coverage.locator("circle")).toHaveCount(photographs.length);
  const shown = coverage.locator("rect title");
  await expect(
    shown.filter({ hasText: /^\d+ photographs, from directions up to \d+° apart; a height .* m$/ }),
  ).not.toHaveCount(0);

  const pair = page.getByTestId("pair-figure");
  const second = pair.locator("canvas").nth(1);
  const before = await second.screenshot();
  await pair.getByTestId("match").fill("3");
  await expect.poll(async () => (await second.screenshot()).equals(before)).toBe(false);
  await pair.getByRole("combobox").selectOption("1");
  await expect(pair.getByText(/^Match \d+ of \d+$/)).toBeVisible();
  expect(await axeFindings(page)).toEqual([]);

  await page.getByRole("button", { name: "Reconstruct with it" }).click();
  await waitForStage(page, "segments", 60_000);
  await expect(page.locator(".status.good")).toHaveCount(photographs.length);
  await expect(page.getByRole("alert")).toHaveCount(0);
  expect(problems).toEqual([]);
});

test("ground control points give the map, and a wrong one is named; files come in one archive", async ({
  page,
  browser,
}) => {
  const { problems } = watch(page);
  const photographs = dronePhotographs();
  await page.goto("/");
  await give(page, [...photographs, droneControl()]);
  await page.getByRole("button", { name: COMPUTE }).click();
  const report = page.getByTestId("orientation-report");
  await expect(report).toContainText("5 of 6 ground control points", { timeout: 60_000 });
  await expect(report).toContainText("EPSG:25832, x from 432100 and y from 5412300 m");
  await expect(report).toContainText(/Ground control point middle is -(1\.9|2\.0)/);
  const points = report.getByTestId("control-points");
  await expect(points.getByRole("row", { name: /^middle/ })).toContainText("no, it disagrees");
  await expect(points.getByRole("row", { name: /^north/ })).toContainText("8 of 8");
  await expect(report).toContainText(/A length of 10 m is known to ± 0\.0\d+ m by the scale/);
  await expect(report.getByTestId("residual-plan")).toContainText(/drawn \d+ times as long/);
  // They give the scale: a length is only measured.
  await expect(report.getByLabel("metres")).toHaveCount(0);
  expect(await axeFindings(page)).toEqual([]);

  const saving = page.waitForEvent("download");
  await report.getByRole("button", { name: "Save all in one .zip" }).click();
  const archive = readFileSync(await (await saving).path());
  await page.getByRole("button", { name: "Reconstruct with it" }).click();
  await waitForStage(page, "segments", 60_000);
  expect(problems).toEqual([]);
  // The core's own reader takes the archive with the photographs.
  const fresh = await browser.newPage();
  await fresh.goto(page.url());
  await give(fresh, [...photographs, upload("orientation.zip", archive)]);
  await expect(fresh.locator(".status.good")).toHaveCount(photographs.length);
  await fresh.close();
});

test("a length that is marked in two photographs sets the scale", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  await give(page, dronePhotographs());
  await page.getByRole("button", { name: COMPUTE }).click();
  const report = page.getByTestId("orientation-report");
  await expect(report).toContainText("9 of 9", { timeout: 60_000 });
  await report.getByRole("combobox", { name: "What is known" }).selectOption("marked");
  const figure = report.getByTestId("measure-figure");
  const shown = ["d1.jpg", "d7.jpg"];
  for (const [side, file] of shown.entries()) {
    await figure.getByRole("combobox").nth(side).selectOption({ label: file });
  }
  const places = marksOf(droneControl());
  for (const name of ["north", "south"]) {
    for (const file of shown) {
      await clickAt(figure.getByRole("img", { name: new RegExp(`^${file}`) }), places.get(`${name} ${file}`));
    }
  }
  const status = figure.getByRole("status");
  await expect(status).toContainText(/± .* units; the marks are \d\.\d px/);
  await expect(figure.getByRole("img", { name: /enlarged/ })).toHaveCount(2);
  // From (-8, 7) to (9, -7).
  await report.getByLabel("metres").fill("22.02");
  await report.getByLabel("metres").press("Enter");
  await expect(report).toContainText("scale from a length between two places in the photographs, 22.02 m");
  await expect(status).toContainText(/^22\.0\d+ ± 0\.\d+ m/);
  expect(await axeFindings(page)).toEqual([]);
  const before = await status.textContent();
  // An arrow key moves the mark of the chosen end.
  const picture = figure.getByRole("img", { name: /^d1.jpg/ });
  await picture.press("Shift+ArrowRight");
  await expect(status).not.toHaveText(before ?? "");
  await picture.press("Shift+ArrowLeft");
  await expect(status).toHaveText(before ?? "");
  // The first two cameras were planted 8.39 m apart.
  await report.getByRole("combobox", { name: "What is known" }).selectOption("0 1");
  const apart = Number(await report.getByLabel("metres").inputValue());
  // As well as the page says that it knows the length.
  const sigma = Number(/ ± (\S+) m/.exec(before ?? "")?.[1]) / 22.02;
  expect(Math.abs(apart / 8.39 - 1)).toBeLessThan(2 * sigma);
  expect(problems).toEqual([]);
});

/** Where photographs show points, pixels, by name of the point and of the photograph. */
function marksOf(list: Upload): Map<string, readonly [number, number]> {
  const lines = list.buffer.toString("utf8").trim().split("\n").slice(1);
  return new Map(
    lines.map((line) => {
      const [, , , x, y, file, name] = line.split(" ");
      return [`${name} ${file}`, [Number(x), Number(y)] as const];
    }),
  );
}

/** Clicks on a pixel of a photograph of 300 pixels. */
async function clickAt(picture: Locator, place: readonly [number, number] | undefined): Promise<void> {
  await picture.scrollIntoViewIfNeeded();
  const box = await picture.boundingBox();
  if (place === undefined || box === null) {
    throw new Error("no such place");
  }
  const [x, y] = place.map((at) => (at * box.width) / 300) as [number, number];
  await picture.click({ position: { x, y } });
}

test("photographs that show nothing in common are named, with what to do", async ({ page }) => {
  const { problems } = watch(page);
  const [drone] = dronePhotographs() as [Upload];
  const [demo] = demoImages(1) as [Upload];
  const [house] = houseFiles() as [Upload];
  await page.goto("/");
  await give(page, [drone, demo, upload("house.jpg", house.buffer)]);
  await page.getByRole("button", { name: COMPUTE }).click();
  const alert = page.getByRole("alert");
  await expect(alert).toContainText("no two photographs show enough of the same");
  await expect(alert).toContainText("overlap by two thirds");
  await expect(page.getByRole("button", { name: "Compute again" })).toBeEnabled();
  expect(problems).toEqual([]);
});
