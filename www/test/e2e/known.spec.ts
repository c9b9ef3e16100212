/** Terrain and footprints that are dropped with the photographs: what they are taken as, and what the images say of them. */
import { expect, test } from "@playwright/test";
import {
  give,
  openHouse,
  openTab,
  runButton,
  save,
  showProject,
  tabOf,
  type Upload,
  upload,
  waitForStage,
  watch,
} from "./helpers";

type Ring = [number, number][];

/** A square of four metres by its south-western corner. */
const square = (x: number, y: number): Ring[] => [
  [
    [x, y],
    [x + 4, y],
    [x + 4, y + 4],
    [x, y + 4],
    [x, y],
  ],
];

/** Polygons by their names, in the frame of the orientation. */
function register(polygons: Record<string, Ring[]>): Upload {
  const features = Object.entries(polygons).map(([name, coordinates]) => ({
    type: "Feature",
    properties: { name },
    geometry: { type: "Polygon", coordinates },
  }));
  const file = { type: "FeatureCollection", crs: null, features };
  return upload("houses.geojson", Buffer.from(JSON.stringify(file)));
}

/** The same height everywhere around the house. */
function levelTerrain(height: number): Upload {
  const header = "ncols 20\nnrows 20\nxllcorner -50\nyllcorner -50\ncellsize 5\n";
  const row = `${Array(20).fill(height).join(" ")}\n`;
  return upload("dtm.asc", Buffer.from(header + row.repeat(20)));
}

test("terrain and footprints are listed, compared with the images, and left out on request", async ({
  page,
}) => {
  test.slow();
  const { problems } = watch(page);
  await openHouse(page);
  await expect(page.getByTestId("known-files")).toHaveCount(0);
  await runButton(page).click();
  await waitForStage(page, "model");
  const [house] = JSON.parse((await save(page, "footprints.geojson")).toString()).features;
  const { coordinates } = house.geometry as { coordinates: Ring[] };

  await give(page, [
    register({ "House 1": coordinates, "On the lawn": square(8, 6) }),
    levelTerrain(house.properties.ground_m),
  ]);
  await showProject(page);
  const files = page.getByTestId("known-files");
  await expect(files.getByRole("listitem")).toHaveCount(2);
  await expect(files.getByRole("listitem").nth(0)).toContainText("taken as the terrain");
  await expect(files.getByRole("listitem").nth(1)).toContainText("taken as the footprints");

  await runButton(page).click();
  await waitForStage(page, "facets");
  await openTab(page, "Half-planes");
  await showProject(page, false);
  await expect(page.getByTestId("known-terrain")).toContainText("The images confirm it");
  await expect(page.getByTestId("known-footprints")).toHaveCount(0);
  await openTab(page, "Facets");
  const found = page.getByTestId("known-footprints");
  await expect(found).toContainText("The images confirm it");
  await expect(found.locator("[data-outcome=agrees]")).toContainText(/^1 agrees.*House 1$/);
  await expect(found.locator("[data-outcome=contradicted]")).toContainText(/^1 contradicted.*On the lawn$/);
  await waitForStage(page, "model");
  await expect(tabOf(page, "Facets")).toHaveAttribute("aria-selected", "true");

  await test.step("a footprint is picked, and shown in the plan", async () => {
    await found.getByRole("button", { name: "On the lawn" }).click();
    const inspector = page.getByTestId("inspector");
    await expect(inspector).toContainText("Footprint On the lawn");
    await expect(inspector).toContainText("4.0 × 4.0 m");
    const outlines = page.getByTestId("plan").locator(".plan-footprint");
    await expect(outlines).toHaveCount(2);
    await expect(outlines.nth(1)).toHaveClass(/contradicted.*chosen/);
    await outlines.nth(0).press("Enter");
    await expect(inspector).toContainText("Footprint House 1");
    await expect(page).toHaveURL(/select=footprint%3A0/);
  });

  await test.step("a file is left out, and taken again", async () => {
    const use = page.getByLabel("Use houses.geojson");
    await showProject(page);
    await use.uncheck();
    await expect(files.getByRole("listitem").nth(1)).toContainText("left out");
    await expect(files.getByRole("listitem").nth(0)).toContainText("taken as the terrain");
    await expect(page.locator(".warnings")).not.toContainText("houses.geojson");
    await use.check();
    await expect(files.getByRole("listitem").nth(1)).toContainText("taken as the footprints");
  });
  expect(problems).toEqual([]);
});
