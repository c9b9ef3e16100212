/** Mistakes planted in a model, and corrected with a few clicks. */
import { readFileSync } from "node:fs";
import { expect, type Page, test } from "@playwright/test";
import { give, houseFiles, upload, waitForStage, watch } from "./helpers";

interface RoofFace {
  slopeDeg: number;
  azimuthDeg: number;
  area: number;
  corners: [number, number, number][];
}

/** The roof faces of the model, as its CityJSON has them. */
async function roofOf(page: Page): Promise<RoofFace[]> {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: "model.city.json" }).click(),
  ]);
  const city = JSON.parse(readFileSync(await download.path(), "utf8"));
  const { scale, translate } = city.transform;
  const place = (v: number) =>
    city.vertices[v].map((x: number, i: number) => x * scale[i] + translate[i]) as [number, number, number];
  type Building = { geometry?: { boundaries: number[][][][]; semantics: Semantics }[] };
  type Semantics = { values: number[][]; surfaces: (RoofFace & { type: string })[] };
  const objects = Object.values(city.CityObjects) as Building[];
  return objects.flatMap(({ geometry = [] }) =>
    geometry.flatMap(({ boundaries: [shell = []], semantics: { values, surfaces } }) =>
      shell.flatMap((face, i) => {
        const surface = surfaces[values[0]?.[i] ?? -1];
        return surface?.type === "RoofSurface" ? [{ ...surface, corners: (face[0] ?? []).map(place) }] : [];
      }),
    ),
  );
}

/** Largest distance of a corner of one roof from the edges of the other, metres: corners inside straight edges come and go. */
function offBy(found: readonly RoofFace[], truth: readonly RoofFace[]): number {
  const edges = found.flatMap(({ corners }) =>
    corners.map((p, i) => [p, corners[(i + 1) % corners.length] ?? p] as const),
  );
  const off = (p: readonly number[]) =>
    Math.min(
      ...edges.map(([a, b]) => {
        const along = b.map((x, i) => x - (a[i] ?? 0));
        const by = p.map((x, i) => x - (a[i] ?? 0));
        const dot = (u: readonly number[], v: readonly number[]) =>
          u.reduce((sum, x, i) => sum + x * (v[i] ?? 0), 0);
        const t = Math.min(1, Math.max(0, dot(by, along) / dot(along, along)));
        return Math.hypot(...by.map((x, i) => x - t * (along[i] ?? 0)));
      }),
    );
  return Math.max(...truth.flatMap(({ corners }) => corners.map(off)));
}

function normalOf({ slopeDeg, azimuthDeg }: RoofFace): [number, number, number] {
  const [slope, azimuth] = [(slopeDeg * Math.PI) / 180, (azimuthDeg * Math.PI) / 180];
  return [Math.sin(slope) * Math.sin(azimuth), Math.sin(slope) * Math.cos(azimuth), Math.cos(slope)];
}

/** A place on a roof face near its middle, and its normal. */
function placeOf(face: RoofFace) {
  const normal = normalOf(face);
  const mean = [0, 1, 2].map(
    (i) => face.corners.reduce((sum, p) => sum + (p[i] ?? 0), 0) / face.corners.length,
  );
  const [c = [0, 0, 0]] = face.corners;
  const [x = 0, y = 0] = mean;
  const z = c[2] - (normal[0] * (x - c[0]) + normal[1] * (y - c[1])) / normal[2];
  return { at: [x, y, z], normal };
}

/** Opens corrections that plant a mistake. */
async function plant(page: Page, corrections: readonly object[]): Promise<void> {
  await page
    .getByTestId("corrections-file")
    .setInputFiles(upload("planted.json", Buffer.from(JSON.stringify(corrections))));
  await expect(page.getByRole("list", { name: "Corrections so far" }).getByRole("listitem")).toHaveCount(
    corrections.length,
  );
  await settled(page);
}

async function settled(page: Page): Promise<void> {
  await waitForStage(page, "corrections");
  await waitForStage(page, "model");
  await expect(page.getByTestId("corrections").getByText("Not applied")).toHaveCount(0);
}

/** Selects the facet that covers a place: what a click on it does. */
async function pick(page: Page, x: number, y: number): Promise<void> {
  const faces = await roofOf(page);
  const inside = ({ corners }: RoofFace) =>
    corners.reduce((odd, p, i) => {
      const q = corners[(i + 1) % corners.length] ?? p;
      return odd !== (p[1] > y !== q[1] > y && x < p[0] + ((q[0] - p[0]) * (y - p[1])) / (q[1] - p[1]));
    }, false);
  // A facet in the hole of another one lies within the outlines of both.
  const [smallest] = faces.filter(inside).sort((a, b) => a.area - b.area);
  const index = faces.findIndex((face) => face === smallest);
  expect(index).toBeGreaterThanOrEqual(0);
  await page.evaluate((select) => {
    const fields = new URLSearchParams(location.hash.slice(1));
    fields.set("select", select);
    location.hash = fields.toString();
  }, `facet:${index}`);
  await expect(page.getByTestId("corrections").getByText(`Facet ${index},`)).toBeVisible();
}

test("a false facet, a wrong slope and a missing facet are corrected with a few clicks", async ({ page }) => {
  test.slow();
  const { problems } = watch(page);
  await page.goto("/");
  await give(page, houseFiles());
  await page.getByRole("button", { name: "Run all" }).click();
  await waitForStage(page, "model");
  const truth = await roofOf(page);
  const panel = page.getByTestId("corrections");
  await panel.getByRole("heading", { name: "Corrections" }).click();
  const press = (name: string) => panel.getByRole("button", { name, exact: true }).click();

  // The slopes at the ridge of the side wing, by the largest pair that falls in opposite directions.
  const west = truth.find(({ azimuthDeg, slopeDeg }) => Math.abs(azimuthDeg - 246) < 5 && slopeDeg > 30);
  const east = truth.find(({ azimuthDeg }) => Math.abs(azimuthDeg - 66) < 5);
  if (west === undefined || east === undefined) {
    throw new Error("the house has a side wing");
  }
  const [slope, counterpart] = [placeOf(west), placeOf(east)];

  await test.step("the next doubtful facet comes by one key, and is confirmed", async () => {
    // Keys are heard once the panel has opened.
    await expect(async () => {
      await page.keyboard.press("n");
      await expect(panel.getByText(/^Facet \d+, probability 0\.[0-8]/)).toBeVisible({ timeout: 1000 });
    }).toPass();
    await press("Confirm");
    await settled(page);
    await expect(panel.getByText("No facet is doubtful")).toBeVisible();
    await press("Undo");
    await settled(page);
  });

  await test.step("a false facet goes, and the slope closes over it", async () => {
    const [x = 0, y = 0, z = 0] = counterpart.at;
    const outline = [
      [x - 1, y - 1],
      [x + 1, y - 1],
      [x + 1, y + 1],
      [x - 1, y + 1],
    ].map(([u, v]) => [u, v, z + 3]);
    await plant(page, [{ correction: "add_facet", outline }]);
    expect(await roofOf(page)).toHaveLength(truth.length + 1);
    const started = Date.now();
    await pick(page, x, y);
    await press("Delete facet");
    await settled(page);
    expect(Date.now() - started).toBeLessThan(30_000);
    const found = await roofOf(page);
    expect(found).toHaveLength(truth.length);
    expect(offBy(found, truth)).toBeLessThan(0.05);
  });

  await test.step("a wrong slope is mended by its number", async () => {
    await plant(page, [{ correction: "set_slope", facet: slope, slope_deg: 22 }]);
    expect(offBy(await roofOf(page), truth)).toBeGreaterThan(0.4);
    await pick(page, slope.at[0] ?? 0, slope.at[1] ?? 0);
    await panel.getByLabel("Slope").fill(west.slopeDeg.toFixed(2));
    await panel.getByLabel("Slope").press("Enter");
    await settled(page);
    const found = await roofOf(page);
    expect(found).toHaveLength(truth.length);
    const mended = found.find(({ azimuthDeg, slopeDeg }) => Math.abs(azimuthDeg - 246) < 5 && slopeDeg > 20);
    expect(Math.abs((mended?.slopeDeg ?? 0) - west.slopeDeg)).toBeLessThan(0.3);
    // A number says nothing of where the roof lies: both adjustments share it between ridge and eave.
    expect(offBy(found, truth)).toBeLessThan(0.7);
  });

  await test.step("a missing slope is the counterpart of the other one", async () => {
    await plant(page, [{ correction: "delete_facet", facet: slope, filled: false }]);
    expect(await roofOf(page)).toHaveLength(truth.length - 1);
    await pick(page, counterpart.at[0] ?? 0, counterpart.at[1] ?? 0);
    await press("Add counterpart");
    await settled(page);
    const found = await roofOf(page);
    expect(found).toHaveLength(truth.length);
    const added = found.find(({ azimuthDeg, slopeDeg }) => Math.abs(azimuthDeg - 246) < 5 && slopeDeg > 30);
    expect(Math.abs((added?.area ?? 0) - west.area) / west.area).toBeLessThan(0.15);
  });

  await test.step("what no longer applies says why, and what is no list is rejected", async () => {
    const gone = { at: [slope.at[0], slope.at[1], (slope.at[2] ?? 0) + 5], normal: slope.normal };
    const file = (text: string) => upload("planted.json", Buffer.from(text));
    await page
      .getByTestId("corrections-file")
      .setInputFiles(file(JSON.stringify([{ correction: "confirm", facet: gone }])));
    await expect(panel.getByText("the facet there has another height now")).toBeVisible();
    await page.getByTestId("corrections-file").setInputFiles(file("{}"));
    await expect(page.getByText("These are no corrections")).toBeVisible();
  });
  expect(problems).toEqual([]);
});
