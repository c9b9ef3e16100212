/** The pages of the exercises: by keyboard, in light and dark; the teacher's list and its sheets. */
import { readFileSync } from "node:fs";
import { type Download, expect, type Page, test } from "@playwright/test";
import { axeFindings } from "./helpers";

async function open(page: Page, address: string): Promise<string[]> {
  const problems: string[] = [];
  page.on("pageerror", ({ message }) => problems.push(message));
  page.on("console", (message) => {
    if (message.type() === "error") {
      problems.push(message.text());
    }
  });
  await page.goto(address);
  return problems;
}

const themes = ["light", "dark"] as const;

test("an exercise is chosen and done by the keyboard alone, and a term says what it means", async ({
  page,
}) => {
  const problems = await open(page, "/exercises.html?seed=17#project");
  const exercise = page.locator("ridgeline-exercise");
  await page
    .getByRole("navigation", { name: "Exercises" })
    .getByRole("link", { name: "A pixel on the ground" })
    .focus();
  await page.keyboard.press("Enter");
  await expect(exercise).toHaveAttribute("name", "groundPixel");

  const term = exercise.getByRole("button", { name: "principal distance" });
  await term.focus();
  await page.keyboard.press("Enter");
  await expect(exercise.getByRole("note")).toContainText("The distance of the projection centre");
  await page.keyboard.press("Escape");
  await expect(exercise.getByRole("note")).toBeHidden();

  const field = exercise.getByRole("textbox", { name: "Number and unit" });
  const status = exercise.getByRole("status");
  await field.focus();
  await page.keyboard.type("12");
  await page.keyboard.press("Enter");
  await expect(status).toContainText("The unit is missing");
  // The answer that a solution ends with.
  await exercise.getByText("A solution").click();
  const solution = (await exercise.locator("details p").textContent()) ?? "";
  const right = /= ([\d.]+) cm\.$/.exec(solution)?.[1] ?? "";
  await field.fill(`${right} m`);
  await field.press("Enter");
  await expect(status).toContainText("wrong unit");
  await field.fill(`${Number(right) * 10} mm`);
  await field.press("Enter");
  await expect(status).toHaveText("Right, number and unit.");
  await expect(page.getByRole("navigation", { name: "Exercises" })).toContainText("1 of ");
  for (const colorScheme of themes) {
    await page.emulateMedia({ colorScheme });
    expect(await axeFindings(page), colorScheme).toEqual([]);
  }
  expect(problems).toEqual([]);
});

test("a function runs on the site's own page, where it may, and a loop without end is stopped", async ({
  page,
}) => {
  const problems = await open(page, "/exercises.html#signedOverlap");
  const exercise = page.locator("ridgeline-exercise");
  const editor = exercise.getByRole("textbox", { name: /function signedOverlap/ });
  const status = exercise.getByRole("status");
  await editor.fill(
    "function signedOverlap(a, b) {\n  return Math.min(a[1], b[1]) - Math.max(a[0], b[0]);\n}",
  );
  await editor.press("Control+Enter");
  await expect(status).toContainText("order taken for granted");
  await editor.fill("function signedOverlap() {\n  while (true);\n}");
  await editor.press("Control+Enter");
  await expect(status).toContainText("No answer after 2 s");
  // Neither the page nor the network is in its reach.
  await editor.fill(
    "function signedOverlap() {\n  return [typeof fetch, typeof document, typeof importScripts];\n}",
  );
  await editor.press("Control+Enter");
  await expect(status).toContainText('["undefined","undefined","undefined"]');
  await page.goto("/exercises.html#glossary");
  await expect(page.getByRole("list", { name: "Glossary" }).getByRole("listitem")).not.toHaveCount(0);
  for (const colorScheme of themes) {
    await page.emulateMedia({ colorScheme });
    expect(await axeFindings(page), colorScheme).toEqual([]);
  }
  await page.setViewportSize({ width: 320, height: 700 });
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(320);
  expect(problems).toEqual([]);
});

test("an exercise is done in a figure: a pick, a wrong pick, the answer", async ({ page }) => {
  const problems = await open(page, "/exercises.html#trueCandidate");
  const exercise = page.locator("ridgeline-exercise");
  const candidates = exercise.locator(".candidates tbody button");
  await expect(candidates.first()).toBeVisible({ timeout: 60_000 });
  const status = exercise.getByRole("status").last();
  const check = exercise.getByRole("button", { name: "Check" });
  await expect(check).toBeEnabled();
  const heard = new Set<string>();
  for (let i = 0; i < (await candidates.count()); i += 1) {
    await candidates.nth(i).press("Enter");
    await check.press("Enter");
    await expect(status).not.toBeEmpty();
    heard.add(((await status.textContent()) ?? "").split(" ").slice(0, 2).join(" "));
  }
  expect([...heard].sort()).toEqual(["Right.", "another edge", "beside the"]);
  for (const colorScheme of themes) {
    await page.emulateMedia({ colorScheme });
    expect(await axeFindings(page), colorScheme).toEqual([]);
  }
  expect(problems).toEqual([]);
});

test("teachers see answers and mistakes, and save a sheet without answers and one with them", async ({
  page,
}) => {
  const problems = await open(page, "/exercises.html?teacher");
  const known = (name: string) => page.getByRole("region", { name });
  for (const name of [
    "The fundamental matrix of two views",
    "From half-planes to a ridge",
    "The angle of a roof",
  ]) {
    await known(name).getByRole("checkbox").check();
  }
  await known("The angle of a roof").getByText("Task, answer, mistakes").click();
  await expect(known("The angle of a roof")).toContainText("wrong sign");
  await page.getByRole("spinbutton", { name: "Values no." }).fill("17");
  const text = async (button: string) => {
    const [download]: [Download, unknown] = await Promise.all([
      page.waitForEvent("download", { timeout: 60_000 }),
      page.getByRole("button", { name: button }).click(),
    ]);
    return readFileSync(await download.path(), "utf8");
  };
  const without = await text("Save the sheet");
  expect(without.match(/<section>/g)).toHaveLength(3);
  expect(without).not.toMatch(/det\(|θ = |Mistakes/);
  const withAnswers = await text("Save it with answers");
  expect(withAnswers).toMatch(/θ = -?\d+\.\d°/);
  expect(withAnswers).toContain("wrong epipole");
  await expect(known("The angle of a roof").locator(".answer-words")).toContainText("θ = ");
  for (const colorScheme of themes) {
    await page.emulateMedia({ colorScheme });
    expect(await axeFindings(page), colorScheme).toEqual([]);
  }
  expect(problems).toEqual([]);
  await page.goto("about:blank");
  await page.setContent(without);
  await page.emulateMedia({ media: "print", colorScheme: "light" });
  await expect(page.getByRole("heading", { level: 2 })).toHaveCount(3);
  await page.screenshot({ path: test.info().outputPath("sheet.png"), fullPage: true });
});
