import { expect, test } from "@playwright/test";
import {
  axeFindings,
  demoImages,
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
