/** A parameter that is dragged runs its stage again, and the others once it is let go. */
import { expect, test } from "@playwright/test";
import { give, houseFiles, openParameters, runButton, stage, waitForStage, watch } from "./helpers";

test("a slider runs the stage of its parameter, and the later ones when it is let go", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  await give(page, houseFiles());
  await openParameters(page);
  const slider = page.getByRole("slider", { name: /Minimum length/ });
  const count = stage(page, "segments").locator(".counts");

  await test.step("before a run it sets the value alone", async () => {
    await slider.fill("16");
    await expect(page.locator("#wanted-segments-min_length_px")).toHaveValue("16");
    await expect(stage(page, "segments")).toHaveAttribute("data-status", "waiting");
  });

  await runButton(page).click();
  await waitForStage(page, "model");
  const before = Number.parseInt(await count.innerText(), 10);

  await test.step("dragged, it runs the segments and no later stage", async () => {
    await slider.evaluate((input: HTMLInputElement) => {
      for (const value of ["20", "30", "40"]) {
        input.value = value;
        input.dispatchEvent(new Event("input", { bubbles: true }));
      }
    });
    await waitForStage(page, "segments");
    await expect.poll(async () => Number.parseInt(await count.innerText(), 10)).toBeLessThan(before);
    await expect(stage(page, "matches")).toHaveAttribute("data-status", "outdated");
  });

  await test.step("let go, it runs the others", async () => {
    await slider.evaluate((input) => input.dispatchEvent(new Event("change", { bubbles: true })));
    await waitForStage(page, "model");
    await expect(page.locator('[data-status="outdated"]')).toHaveCount(0);
  });
  expect(problems).toEqual([]);
});
