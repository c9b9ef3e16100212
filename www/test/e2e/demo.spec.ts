/** The demo scene by one click: shaders made before, a preliminary model soon, and the run's own. */
import { expect, test } from "@playwright/test";
import {
  lookOf,
  openDemo,
  openParameters,
  openTab,
  runUpTo,
  save,
  stage,
  steadyLook,
  switchLayer,
  waitForStage,
  watch,
} from "./helpers";

declare global {
  interface Window {
    /** How many shaders were asked for so far. */
    shaders: number;
  }
}

function countShaders(): void {
  window.shaders = 0;
  const { linkProgram } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.linkProgram = function (this: WebGL2RenderingContext, program) {
    window.shaders += 1;
    linkProgram.call(this, program);
  };
}

test("one click turns the demo scene into a textured model that can be downloaded", async ({ page }) => {
  const { problems } = watch(page);
  await page.addInitScript(countShaders);
  await page.goto("/");
  const made = () => page.evaluate(() => window.shaders);
  await page.locator(".turntable.drawn").waitFor();
  // Behind the entrance the workbench makes its own, until all are there.
  let before = -1;
  await expect(async () => {
    const now = await made();
    const isSettled = now === before && now > 8;
    before = now;
    expect(isSettled).toBe(true);
  }).toPass({ intervals: [1000], timeout: 60_000 });
  await openDemo(page);

  const canvas = page.getByTestId("viewer");
  const mark = page.getByTestId("preliminary");
  await test.step("a preliminary model is shown before the facets", async () => {
    await expect(mark).toHaveText(/preliminary/, { timeout: 60_000 });
    // Not a result: the stage has none, nothing can be saved or corrected.
    await expect(stage(page, "facets")).not.toHaveAttribute("data-status", "done");
    await expect(page.getByRole("button", { name: "Report" })).toHaveCount(0);
    await expect(page.getByTestId("corrections")).toHaveCount(0);
    let drawn = 0;
    while (drawn < 0.05 && (await mark.count()) > 0) {
      const look = await lookOf(page, canvas);
      // A picture counts if the mark still stands after it was taken.
      drawn = (await mark.count()) > 0 ? look.drawn : drawn;
    }
    expect(drawn).toBeGreaterThan(0.05);
  });

  await test.step("the run's own takes its place", async () => {
    await waitForStage(page, "model");
    await expect(mark).toHaveCount(0);
    await expect(page.getByRole("button", { name: "Model", exact: true })).toHaveAttribute(
      "aria-pressed",
      "true",
    );
    await expect(page.getByRole("alert")).toHaveCount(0);
    await expect(page.locator(".view")).toHaveCount(6);
    await steadyLook(page, canvas);
    // No shader was made since.
    expect(await made()).toBe(before);
  });

  await test.step("the viewer shows a textured model", async () => {
    await expect(async () => {
      const look = await lookOf(page, canvas);
      expect(look.drawn).toBeGreaterThan(0.05);
      expect(look.colours).toBeGreaterThan(40);
    }).toPass({ timeout: 20_000 });
  });

  await test.step("plain and wireframe look different, with fewer colours", async () => {
    const textured = await lookOf(page, canvas);
    await switchLayer(page, "Plain");
    await expect(async () => {
      expect((await lookOf(page, canvas)).colours).toBeLessThan(textured.colours);
    }).toPass({ timeout: 20_000 });
    await switchLayer(page, "Wireframe");
    await expect(async () => {
      expect((await lookOf(page, canvas)).drawn).toBeLessThan(0.8 * textured.drawn);
    }).toPass({ timeout: 20_000 });
    await switchLayer(page, "Textured");
  });

  await test.step("the GLB begins as one", async () => {
    const bytes = await save(page, "model.glb");
    expect(bytes.subarray(0, 4).toString("latin1")).toBe("glTF");
    expect(bytes.readUInt32LE(8)).toBe(bytes.length);
  });

  await test.step("the IFC has a roof and its faces", async () => {
    const text = (await save(page, "model.ifc")).toString();
    expect(text).toContain("FILE_SCHEMA(('IFC4'));");
    expect(text.match(/=IFCROOF\(/g)?.length).toBeGreaterThan(0);
    expect(text.match(/,\.ROOF\.\);/g)?.length).toBeGreaterThan(0);
  });

  await test.step("the CityJSON holds buildings", async () => {
    const city = JSON.parse((await save(page, "model.city.json")).toString()) as {
      type: string;
      CityObjects: Record<string, unknown>;
    };
    expect(city.type).toBe("CityJSON");
    expect(Object.keys(city.CityObjects).length).toBeGreaterThan(0);
  });

  await test.step("every stage view shows what its stage found", async () => {
    const image = page.locator(".image-view canvas").first();
    await openTab(page, "Images");
    await expect(async () => {
      expect((await lookOf(page, image)).colours).toBeGreaterThan(40);
    }).toPass({ timeout: 20_000 });
    for (const name of ["3D lines", "Half-planes", "Facets"]) {
      await openTab(page, name);
      await expect(async () => {
        expect((await lookOf(page, canvas)).colours, name).toBeGreaterThan(4);
      }).toPass({ timeout: 20_000 });
    }
  });

  await test.step("a changed parameter makes its stage and the later ones outdated, not the earlier", async () => {
    await openParameters(page, "Half-plane sweep");
    const field = page.locator("#param-sweep-min_similarity");
    await field.fill("0.45");
    await field.press("Enter");
    await expect(stage(page, "halfplanes")).toHaveAttribute("data-status", "outdated");
    await expect(stage(page, "model")).toHaveAttribute("data-status", "outdated");
    await expect(stage(page, "lines")).toHaveAttribute("data-status", "done");
    await expect(page.locator("#param-sweep-min_similarity-note")).toHaveText("default 0.4");
  });
  expect(problems).toEqual([]);
});

test("a run can be cancelled, and started again", async ({ page }) => {
  await page.goto("/");
  // In the page: the run may be over before a click from here arrives.
  const cancelled = page.evaluate(
    () =>
      new Promise<void>((resolve) => {
        const timer = setInterval(() => {
          const isRunning = document.querySelector('[data-stage="matches"][data-status="running"]') !== null;
          const buttons = [...document.querySelectorAll<HTMLButtonElement>(".rail-run button")];
          const cancel = buttons.find(({ textContent }) => textContent === "Cancel");
          if (isRunning && cancel !== undefined) {
            clearInterval(timer);
            cancel.click();
            resolve();
          }
        }, 10);
      }),
  );
  await openDemo(page);
  await cancelled;
  await expect(page.locator('[data-status="running"]')).toHaveCount(0);
  await expect(stage(page, "model")).toHaveAttribute("data-status", "waiting");
  await expect(page.getByRole("alert")).toHaveCount(0);
  await runUpTo(page, "Segments");
  await waitForStage(page, "segments");
  await openTab(page, "Segments");
  await expect(page.locator(".image-view canvas").first()).toBeVisible();
});
