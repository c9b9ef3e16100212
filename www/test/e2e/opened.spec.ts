/** A model of somebody else: opened without photographs, corrected, compared, and saved with all that was not touched. */
import { readFileSync } from "node:fs";
import { expect, test } from "@playwright/test";
import { axeFindings, give, houseFiles, save, switchLayer, upload, waitForStage, watch } from "./helpers";

const MODEL = readFileSync(new URL("../../../tests/fixtures/known/houses.city.json", import.meta.url));
/** The middle of its flat roof. */
const ROOF = [432100, 5412300, 118];

test("a CityJSON alone is a model to look at, to correct, to compare and to save", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  await give(page, [upload("houses.city.json", MODEL)]);
  await waitForStage(page, "model");
  await expect(page.getByTestId("buildings")).toContainText("1 building 1 roof facet, 100 m²");
  expect(await axeFindings(page)).toEqual([]);
  expect((await save(page, "model.city.json")).equals(MODEL)).toBe(true);

  await switchLayer(page, "Sun");
  await expect(page.getByTestId("sun-legend")).toContainText("Direct sun a day");
  await page
    .getByTestId("buildings")
    .getByRole("button", { name: /Building/ })
    .click();
  await expect(page.getByTestId("sun-legend")).toContainText(
    /Facet 1: 1\d\.\d h; January to December (\d+\.\d, ){11}\d+\.\d h/,
  );

  await page.getByRole("button", { name: "Correct", exact: true }).click();
  const eave = { correction: "set_eave", building: ROOF, height: 120 };
  await page
    .getByTestId("corrections-file")
    .setInputFiles(upload("eave.json", Buffer.from(JSON.stringify([eave]))));
  await expect(page.getByRole("list", { name: "Corrections so far" }).getByRole("listitem")).toHaveCount(1);
  await waitForStage(page, "corrections");
  await waitForStage(page, "model");
  const corrected = JSON.parse((await save(page, "model.city.json")).toString());
  const top = Math.max(...corrected.vertices.map(([, , z]: number[]) => z));
  expect(corrected.transform.translate[2] + top * corrected.transform.scale[2]).toBeCloseTo(120, 6);

  await page.getByTestId("corrections").getByRole("button", { name: "Done" }).click();
  const comparison = page.getByTestId("model-comparison");
  await comparison.locator("input").setInputFiles(upload("houses.city.json", MODEL));
  await expect(comparison).toContainText("1 building in both, 0 only here, 0 only in houses.city.json");
  await expect(comparison.getByRole("row").last()).toContainText("+2.00");
  await page.reload();
  await waitForStage(page, "model");
  await expect(page.getByTestId("buildings")).toContainText("1 building");
  expect(problems).toEqual([]);
});

test("what is no model says so, and photographs take the place of a model", async ({ page }) => {
  await page.goto("/");
  await give(page, [upload("broken.city.json", Buffer.from('{"type":"CityJSON","CityObjects":{}}'))]);
  await expect(page.getByRole("alert")).toContainText("transform");
  await give(page, houseFiles());
  await page.getByRole("button", { name: "New project" }).last().click();
  await expect(page.locator(".status.good")).toHaveCount(6);
});
