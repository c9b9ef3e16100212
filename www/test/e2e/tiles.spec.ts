/** Large areas in tiles, and projects: the page and the command line give each other the same. */
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { expect, type Page, test } from "@playwright/test";
import {
  BINARY,
  give,
  houseFiles,
  MAY_SKIP,
  openHouse,
  openParameters,
  output,
  runButton,
  save,
  showProject,
  stage,
  upload,
  waitForStage,
  watch,
} from "./helpers";

const REGION = "-31, -31, 31, 31";

/** Runs the command line on files; the folder of its results. */
function reconstruct(files: { name: string; buffer: Buffer }[], scene: string, more: string[]): string {
  const folder = mkdtempSync(join(tmpdir(), "ridgeline-"));
  for (const { name, buffer } of files) {
    writeFileSync(join(folder, name), buffer);
  }
  const out = join(folder, "out");
  execFileSync(BINARY, ["reconstruct", join(folder, scene), "--out", out, ...more]);
  return out;
}

async function askFor(page: Page, label: RegExp, value: string): Promise<void> {
  await page.getByLabel(label).fill(value);
  await page.getByLabel(label).press("Enter");
}

test("tiles run one after the other into the model of the command line", async ({ page }) => {
  test.setTimeout(400_000);
  const { problems } = watch(page);
  await openHouse(page);
  await showProject(page);
  await page.getByText("Region, ground, reference system").click();
  await askFor(page, /Tile size/, "10");
  await expect(page.getByText("60 m or more")).toBeVisible();
  await askFor(page, /Region/, REGION);
  await askFor(page, /Height of the ground/, "100");
  await askFor(page, /Tile size/, "60");

  // Cancelled in the middle, and begun again.
  await runButton(page).click();
  await expect(stage(page, "model")).toHaveAttribute("data-status", "running");
  await expect(stage(page, "model")).toContainText(/[1-9]\d* %/, { timeout: 120_000 });
  await page.getByRole("button", { name: "Cancel" }).click();
  await expect(stage(page, "model")).toHaveAttribute("data-status", "waiting");
  await runButton(page).click();
  await waitForStage(page, "model", 300_000);
  await expect(stage(page, "model")).toContainText("4 tiles");
  const model = await save(page, "model.city.json");
  const atlas = await save(page, "model_atlas.jpg");
  expect(Object.keys(JSON.parse(model.toString()).CityObjects)).toHaveLength(1);
  expect(problems).toEqual([]);

  test.skip(MAY_SKIP, `there is no ${BINARY} to compare with`);
  const region = REGION.replaceAll(" ", "");
  const out = reconstruct(houseFiles(), ".", ["--roi", region, "--ground-z", "100", "--tile", "60"]);
  expect(model.equals(readFileSync(join(out, "model.city.json")))).toBe(true);
  expect(atlas.equals(readFileSync(join(out, "model_atlas.jpg")))).toBe(true);
});

test("a project opens again to the same state, here and on the command line", async ({ page }) => {
  test.setTimeout(300_000);
  const { problems } = watch(page);
  await openHouse(page);
  await page.locator(".view input[type=checkbox]").nth(2).uncheck();
  await expect(page.getByRole("heading", { name: "5 of 6 views" })).toBeVisible();
  await showProject(page);
  await page.getByText("Region, ground, reference system").click();
  await askFor(page, /Height of the ground/, "100");
  await openParameters(page, "Texture");
  await page.locator("#param-texture-padding_px").fill("5");
  await page.locator("#param-texture-padding_px").press("Enter");
  await runButton(page).click();
  await waitForStage(page, "model");
  const model = await save(page, "model.city.json");
  const project = await save(page, "Save project");

  await showProject(page);
  await page.getByRole("button", { name: "New project" }).click();
  await give(page, [upload("house.zip", project)]);
  await expect(page.getByRole("heading", { name: "5 of 6 views" })).toBeVisible();
  await expect(page.getByLabel(/Height of the ground/)).toHaveValue("100");
  await openParameters(page);
  await expect(page.locator("#param-texture-padding_px")).toHaveValue("5");
  // Its results are shown without a run.
  await waitForStage(page, "model", 20_000);
  await expect(page.getByText("Nothing to show yet.")).toHaveCount(0);
  await expect(await output(page, "model.glb")).toBeVisible();
  // A file is computed for them.
  expect((await save(page, "model.city.json")).equals(model)).toBe(true);
  expect(problems).toEqual([]);

  test.skip(MAY_SKIP, `there is no ${BINARY} to compare with`);
  const out = reconstruct([{ name: "house.zip", buffer: project }], "house.zip", []);
  expect(model.equals(readFileSync(join(out, "model.city.json")))).toBe(true);
});
