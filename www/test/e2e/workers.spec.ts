import { expect, type Page, test } from "@playwright/test";
import {
  chooseMethod,
  give,
  houseFiles,
  openDemo,
  runButton,
  runUpTo,
  save,
  showFace,
  showProject,
  stage,
  waitForStage,
  watch,
} from "./helpers";

/** The model and its lines, found from the first stage on with this many workers. */
async function modelWith(page: Page, workers: number, method: string): Promise<[Buffer, Buffer]> {
  await give(page, houseFiles());
  await showFace(page, "Method");
  await page.getByLabel("Workers").selectOption(String(workers));
  await chooseMethod(page, method);
  await runButton(page).click();
  await waitForStage(page, "model");
  expect(page.workers().length).toBe(workers);
  const found = [await save(page, "model.glb"), await save(page, "lines.json")] as const;
  await showProject(page);
  await page.getByRole("button", { name: "New project" }).click();
  return [...found];
}

// Every way of dividing is compared natively (tests/pipeline.rs); this method has the stages of both others.
test("three workers find the bytes of one", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  const alone = await modelWith(page, 1, "Combined");
  const shared = await modelWith(page, 3, "Combined");
  expect(shared[0].equals(alone[0])).toBe(true);
  expect(shared[1].equals(alone[1])).toBe(true);
  expect(alone[1].length).toBeGreaterThan(1000);
  await expect(page.getByRole("alert")).toHaveCount(0);
  expect(problems).toEqual([]);
});

test("cancelling ends all workers, and the next run hires them again", async ({ page }) => {
  await page.addInitScript(() => {
    Object.defineProperty(navigator, "hardwareConcurrency", { value: 4 });
  });
  await page.goto("/");
  await openDemo(page);
  await expect(stage(page, "matches")).toHaveAttribute("data-status", "running", { timeout: 60_000 });
  await expect.poll(() => page.workers().length).toBe(3);
  await page.getByRole("button", { name: "Cancel" }).click();
  await expect.poll(() => page.workers().length).toBe(1);
  await runUpTo(page, "Matches");
  await waitForStage(page, "matches");
  expect(page.workers().length).toBe(3);
});
