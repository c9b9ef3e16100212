import { readFileSync } from "node:fs";
import { expect, type Page, test } from "@playwright/test";
import { give, houseFiles, stage, waitForStage, watch } from "./helpers";

async function bytesOf(page: Page, name: string): Promise<Buffer> {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name, exact: true }).click(),
  ]);
  return readFileSync(await download.path());
}

/** The model and its lines, found from the first stage on with this many workers. */
async function modelWith(page: Page, workers: number, method: string): Promise<[Buffer, Buffer]> {
  await page.getByLabel("Workers").selectOption(String(workers));
  const methods = page.getByRole("group", { name: "Method" });
  await methods.getByRole("button", { name: method === "Lines" ? "Rectangles" : "Lines" }).click();
  await methods.getByRole("button", { name: method }).click();
  await page.getByRole("button", { name: "Run all" }).click();
  await waitForStage(page, "model");
  return [await bytesOf(page, "model.glb"), await bytesOf(page, "lines.json")];
}

for (const method of ["Lines", "Rectangles"]) {
  test(`three workers find the bytes of one: ${method}`, async ({ page }) => {
    const { problems } = watch(page);
    await page.goto("/");
    await give(page, houseFiles());
    await expect(page.getByRole("button", { name: "Run all" })).toBeEnabled();
    const alone = await modelWith(page, 1, method);
    expect(page.workers().length).toBe(1);
    const shared = await modelWith(page, 3, method);
    expect(page.workers().length).toBe(3);
    expect(shared[0].equals(alone[0])).toBe(true);
    expect(shared[1].equals(alone[1])).toBe(true);
    expect(alone[1].length).toBeGreaterThan(1000);
    await expect(page.getByRole("alert")).toHaveCount(0);
    expect(problems).toEqual([]);
  });
}

test("cancelling ends all workers, and the next run hires them again", async ({ page }) => {
  await page.addInitScript(() => {
    Object.defineProperty(navigator, "hardwareConcurrency", { value: 4 });
  });
  await page.goto("/");
  await page.getByRole("button", { name: "Demo scene" }).click();
  await expect(stage(page, "matches")).toHaveAttribute("data-status", "running", { timeout: 60_000 });
  await expect.poll(() => page.workers().length).toBe(3);
  await page.getByRole("button", { name: "Cancel" }).click();
  await expect.poll(() => page.workers().length).toBe(1);
  await page.getByRole("button", { name: "Run up to 3D lines" }).click();
  await waitForStage(page, "lines");
  expect(page.workers().length).toBe(3);
});
