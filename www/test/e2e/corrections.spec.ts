/** Mistakes planted in a model, and corrected with a few clicks. */
import { readFileSync } from "node:fs";
import { expect, type Page, test } from "@playwright/test";
import { give, houseFiles, onePage, runButton, save, upload, waitForStage } from "./helpers";

interface RoofFace {
  slopeDeg: number;
  azimuthDeg: number;
  area: number;
  corners: Place[];
}

/** The roof faces of the model, as its CityJSON has them. */
async function roofOf(page: Page): Promise<RoofFace[]> {
  const city = JSON.parse((await save(page, "model.city.json")).toString());
  const { scale, translate } = city.transform;
  const place = (v: number) =>
    city.vertices[v].map((x: number, i: number) => x * scale[i] + translate[i]) as Place;
  type Building = { geometry?: { lod: string; boundaries: number[][][][]; semantics: Semantics }[] };
  type Semantics = { values: number[][]; surfaces: (RoofFace & { type: string })[] };
  const objects = Object.values(city.CityObjects) as Building[];
  // Where walls are seen below eaves the same roofs stand there a second time.
  const simple = objects.flatMap(({ geometry = [] }) => geometry.filter(({ lod }) => lod === "2.2"));
  return simple.flatMap(({ boundaries: [shell = []], semantics: { values, surfaces } }) =>
    shell.flatMap((face, i) => {
      const surface = surfaces[values[0]?.[i] ?? -1];
      return surface?.type === "RoofSurface" ? [{ ...surface, corners: (face[0] ?? []).map(place) }] : [];
    }),
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

function normalOf({ slopeDeg, azimuthDeg }: RoofFace): Place {
  const [slope, azimuth] = [(slopeDeg * Math.PI) / 180, (azimuthDeg * Math.PI) / 180];
  return [Math.sin(slope) * Math.sin(azimuth), Math.sin(slope) * Math.cos(azimuth), Math.cos(slope)];
}

/** A place on a roof face near its middle, and its normal. */
function placeOf(face: RoofFace): { at: Place; normal: Place } {
  const normal = normalOf(face);
  const mean = [0, 1, 2].map(
    (i) => face.corners.reduce((sum, p) => sum + (p[i] ?? 0), 0) / face.corners.length,
  );
  const [c = [0, 0, 0]] = face.corners;
  const [x = 0, y = 0] = mean;
  const z = (c[2] ?? 0) - (normal[0] * (x - (c[0] ?? 0)) + normal[1] * (y - (c[1] ?? 0))) / normal[2];
  return { at: [x, y, z], normal };
}

/** Corrections that put a facet of another slope in the place of one, turned about its ridge. */
function wrongSlope(face: RoofFace, slopeDeg: number): object[] {
  const ridge = Math.max(...face.corners.map(([, , z]) => z));
  const tan = (degrees: number) => Math.tan((degrees * Math.PI) / 180);
  const times = tan(slopeDeg) / tan(face.slopeDeg);
  const outline = face.corners.map(([x, y, z]) => [x, y, ridge - (ridge - z) * times]);
  return [
    { correction: "delete_facet", facet: placeOf(face), filled: false },
    { correction: "add_facet", outline },
  ];
}

type Place = [number, number, number];
const along = (p: Place, by: Place, times: number) => p.map((x, i) => x + times * (by[i] ?? 0)) as Place;
const minus = (p: Place, q: Place) => along(p, q, -1);
const dot = (p: Place, q: Place) => p.reduce((sum, x, i) => sum + x * (q[i] ?? 0), 0);
const cross = ([a, b, c]: Place, [d, e, f]: Place): Place => [b * f - c * e, c * d - a * f, a * e - b * d];
const unit = (p: Place) => along([0, 0, 0], p, 1 / Math.sqrt(dot(p, p)));

/** Vertical field of view of the 3D view. */
const FIELD_OF_VIEW_DEG = 35;
const DISTANCE_M = 30;

/** The 3D view, from where it shows a place in its middle; where it shows others, pixels of the page. */
async function look(page: Page, origin: Place, at: Place, from: Place) {
  const target = minus(at, origin);
  const eye = along(target, unit(from), DISTANCE_M);
  await page.evaluate((camera) => {
    const fields = new URLSearchParams(location.hash.slice(1));
    fields.set("camera", camera);
    location.hash = fields.toString();
  }, [...eye, ...target].join());
  const canvas = page.getByTestId("viewer");
  const box = await canvas.boundingBox();
  if (box === null) {
    throw new Error("the 3D view is not shown");
  }
  const ahead = unit(minus(target, eye));
  const right = unit(cross(ahead, [0, 0, 1]));
  const up = cross(right, ahead);
  const scale = box.height / 2 / Math.tan((FIELD_OF_VIEW_DEG * Math.PI) / 360);
  return (p: Place) => {
    const by = minus(minus(p, origin), eye);
    const depth = dot(by, ahead);
    return {
      x: box.x + box.width / 2 + (scale * dot(by, right)) / depth,
      y: box.y + box.height / 2 - (scale * dot(by, up)) / depth,
    };
  };
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
  const index = smallest === undefined ? -1 : faces.indexOf(smallest);
  expect(index).toBeGreaterThanOrEqual(0);
  await page.evaluate((select) => {
    const fields = new URLSearchParams(location.hash.slice(1));
    fields.set("select", select);
    location.hash = fields.toString();
  }, `facet:${index}`);
  await expect(page.getByTestId("corrections").getByText(`Facet ${index + 1},`)).toBeVisible();
}

let page: Page;
/** The roofs before anything is corrected, and the slopes at the ridge of the side wing. */
let truth: RoofFace[];
let west: RoofFace;
let east: RoofFace;

onePage(async (opened) => {
  page = opened;
  await give(page, houseFiles());
  await runButton(page).click();
  await waitForStage(page, "model");
  truth = await roofOf(page);
  // By the largest pair that falls in opposite directions.
  west = truth.find(fallsWest) as RoofFace;
  east = truth.find(({ azimuthDeg }) => Math.abs(azimuthDeg - 66) < 5) as RoofFace;
  await page.getByRole("button", { name: "Correct", exact: true }).click();
});

test.beforeEach(() => plant(page, []));

const fallsWest = ({ azimuthDeg, slopeDeg }: RoofFace) => Math.abs(azimuthDeg - 246) < 5 && slopeDeg > 30;
const panel = () => page.getByTestId("corrections");
const press = (name: string) => panel().getByRole("button", { name, exact: true }).click();
const done = () => panel().getByRole("list", { name: "Corrections so far" }).getByRole("listitem");

test("a false facet, a wrong slope and a missing facet are corrected with a few clicks", async () => {
  test.slow();
  const [slope, counterpart] = [placeOf(west), placeOf(east)];

  await test.step("the next doubtful facet comes by one key, and is confirmed", async () => {
    // Keys are heard once the panel has opened.
    await expect(async () => {
      await page.keyboard.press("n");
      await expect(panel().getByText(/^Facet \d+, probability 0\.\d/)).toBeVisible({ timeout: 1000 });
    }).toPass();
    await press("Confirm");
    await settled(page);
    await expect(panel().getByText("No facet is doubtful")).toBeVisible();
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
    await plant(page, wrongSlope(west, 22));
    const wrong = await roofOf(page);
    expect(wrong).toHaveLength(truth.length);
    expect(offBy(wrong, truth)).toBeGreaterThan(0.8);
    await pick(page, slope.at[0] ?? 0, slope.at[1] ?? 0);
    await panel().getByLabel("Slope").fill(west.slopeDeg.toFixed(2));
    await panel().getByLabel("Slope").press("Enter");
    await settled(page);
    const found = await roofOf(page);
    expect(found).toHaveLength(truth.length);
    expect(offBy(found, truth)).toBeLessThan(0.25);
  });

  await test.step("a missing slope is the counterpart of the other one", async () => {
    await plant(page, [{ correction: "delete_facet", facet: slope, filled: false }]);
    expect(await roofOf(page)).toHaveLength(truth.length - 1);
    await pick(page, counterpart.at[0] ?? 0, counterpart.at[1] ?? 0);
    await press("Add counterpart");
    await settled(page);
    const found = await roofOf(page);
    expect(found).toHaveLength(truth.length);
    const added = found.find(fallsWest);
    expect(Math.abs((added?.area ?? 0) - west.area) / west.area).toBeLessThan(0.15);
  });

  await test.step("what no longer applies says why, and what is no list is rejected", async () => {
    const gone = { at: [slope.at[0], slope.at[1], (slope.at[2] ?? 0) + 5], normal: slope.normal };
    const file = (text: string) => upload("planted.json", Buffer.from(text));
    await page
      .getByTestId("corrections-file")
      .setInputFiles(file(JSON.stringify([{ correction: "confirm", facet: gone }])));
    await expect(panel().getByText("the facet there has another height now")).toBeVisible();
    await page.getByTestId("corrections-file").setInputFiles(file("{}"));
    await expect(page.getByText("These are no corrections")).toBeVisible();
    await page.getByRole("button", { name: "Dismiss: These are no corrections" }).click();
  });
});

test("facets are deleted and made symmetric, and corners dragged, in the 3D view", async () => {
  test.slow();
  const origin: Place = JSON.parse((await save(page, "report.json")).toString()).origin;
  const [slope, counterpart] = [placeOf(west), placeOf(east)];

  /** Clicks a place of a roof in the 3D view, seen from above it, until that is heard: a new model takes a moment to be shown. */
  const click = async ({ at, normal }: { at: Place; normal: Place }, isHeard: () => Promise<void>) => {
    await expect(async () => {
      const { x, y } = (await look(page, origin, at, normal))(at);
      await page.mouse.click(x, y);
      await isHeard();
    }).toPass({ timeout: 40_000 });
  };
  const select = (place: { at: Place; normal: Place }) =>
    click(place, () => expect(panel().getByText(/^Facet \d+, probability/)).toBeVisible({ timeout: 6000 }));
  /** The second facet of a correction about two. */
  const clickOther = (place: { at: Place; normal: Place }, count: number) =>
    click(place, () => expect(done()).toHaveCount(count, { timeout: 6000 }));
  const undo = async () => {
    await press("Undo");
    await settled(page);
    expect(offBy(await roofOf(page), truth)).toBeLessThan(0.002);
  };

  type Pixel = { x: number; y: number };
  /** Drags a dot, which is the first correction. */
  const drag = async (from: Pixel, to: Pixel) => {
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2);
    await page.mouse.move(to.x, to.y);
    await page.mouse.up();
    await expect(done()).toHaveCount(1);
    await settled(page);
  };
  const distanceTo = async (place: Place) => {
    const corners = (await roofOf(page)).flatMap((face) => face.corners);
    return Math.min(...corners.map((p) => Math.sqrt(dot(minus(p, place), minus(p, place)))));
  };

  await test.step("a facet is clicked and deleted", async () => {
    await select(slope);
    await press("Delete facet");
    await expect(done()).toHaveCount(1);
    await settled(page);
    const left = await roofOf(page);
    expect(left).toHaveLength(truth.length - 1);
    expect(left.some(fallsWest)).toBe(false);
    await undo();
  });

  await test.step("two edges are made parallel, which they nearly are", async () => {
    await select(slope);
    await press("Make parallel");
    await expect(done()).toHaveCount(1);
    await settled(page);
    await expect(done().first()).toHaveText(/Edge made parallel/);
    await undo();
  });

  await test.step("what stands on a facet is drawn, with its height", async () => {
    await select(slope);
    const [nx, ny, nz] = slope.normal;
    const level = unit([-ny, nx, 0]);
    const uphill = unit(cross(slope.normal, level));
    const corners = (
      [
        [-1, -1],
        [1, -1],
        [1, 1],
        [-1, 1],
      ] as const
    ).map(([u, v]) => along(along(slope.at, level, 0.5 * u), uphill, 0.5 * v));
    const seen = await look(page, origin, slope.at, [nx, ny, nz]);
    await page.getByRole("button", { name: "Draw", exact: true }).click();
    for (const corner of corners) {
      const { x, y } = seen(corner);
      await page.mouse.click(x, y);
    }
    await panel().getByLabel("Something stands here, height above the facet").fill("0.8");
    await page.keyboard.press("Enter");
    await expect(done().first()).toHaveText(/Obstruction added: 0.80 m/);
    await settled(page);
    await expect(panel().getByRole("button", { name: /^Delete obstruction 1/ })).toBeVisible();
    await page.getByRole("button", { name: "Draw", exact: true }).click();
    await undo();
  });

  await test.step("the dot of a corner is dragged", async () => {
    await select(slope);
    const eave = [...west.corners].sort((p, q) => p[2] - q[2])[0] ?? slope.at;
    const [nx, ny] = slope.normal;
    const to = along(eave, unit([nx, ny, 0]), 1);
    const seen = await look(page, origin, eave, [nx, ny, 1.5]);
    await drag(seen(eave), seen(to));
    expect(await distanceTo(to)).toBeLessThan(0.15);
    await undo();
  });

  await test.step("the dot of an edge is dragged upright", async () => {
    await select(slope);
    const edges = west.corners.map((p, i) => [p, west.corners[(i + 1) % west.corners.length] ?? p] as const);
    const [lowest = [slope.at, slope.at]] = edges.sort(([p, q], [r, s]) => p[2] + q[2] - r[2] - s[2]);
    const middle = along(along([0, 0, 0], lowest[0], 0.5), lowest[1], 0.5);
    const raised = (p: Place) => along(p, [0, 0, 1], 0.5);
    const seen = await look(page, origin, middle, [slope.normal[0], slope.normal[1], 0.5]);
    await page.keyboard.down("Shift");
    await drag(seen(middle), seen(raised(middle)));
    await page.keyboard.up("Shift");
    // Where the edge ends at a valley, its end slides along it.
    const direction = unit(minus(lowest[1], lowest[0]));
    const off = (p: Place) => {
      const aside = cross(minus(p, raised(middle)), direction);
      return Math.sqrt(dot(aside, aside));
    };
    const faces = await roofOf(page);
    const ends = faces.flatMap(({ corners }) =>
      corners.map((p, i) => Math.max(off(p), off(corners[(i + 1) % corners.length] ?? p))),
    );
    expect(Math.min(...ends)).toBeLessThan(0.1);
    await undo();
  });

  await test.step("saved corrections are opened again; two clicks make slopes symmetric", async () => {
    // Another slope than before: what was found already is shown at once, and again after it was computed.
    await plant(page, wrongSlope(west, 24));
    await select({ at: along(slope.at, [0, 0, 1], 0.5), normal: slope.normal });
    await press("Symmetric with …");
    await clickOther(counterpart, 3);
    await settled(page);
    const found = await roofOf(page);
    const slopes = [246, 66].map((azimuth) =>
      Math.max(...found.flatMap((f) => (Math.abs(f.azimuthDeg - azimuth) < 5 ? [f.slopeDeg] : []))),
    );
    expect(Math.abs((slopes[0] ?? 0) - (slopes[1] ?? 90))).toBeLessThan(0.1);
    const [saved] = await Promise.all([page.waitForEvent("download"), press("Save corrections")]);
    const list = readFileSync(await saved.path());
    for (let left = 3; left > 0; left -= 1) {
      await panel()
        .getByRole("button", { name: `Remove correction ${left}` })
        .click();
      await expect(done()).toHaveCount(left - 1);
      await settled(page);
    }
    expect(await roofOf(page)).toEqual(truth);
    await page.getByTestId("corrections-file").setInputFiles(upload("saved.json", list));
    await expect(done()).toHaveCount(3);
    await settled(page);
    expect(await roofOf(page)).toEqual(found);
  });
});

/** Width and height of its photographs. */
const SIZE_PX = [256, 256] as const;

/** The image of a place of the world, by a view's 3 x 4 matrix, in which the centre of the first pixel is (0, 0). */
function pixelOf(view: string, place: Place): { x: number; y: number } {
  const file = houseFiles().find(({ name }) => name.endsWith(`${view}.P`));
  const m = (file?.buffer.toString() ?? "").trim().split(/\s+/).map(Number);
  const [u = 0, v = 0, w = 1] = [0, 4, 8].map((row) =>
    [...place, 1].reduce((sum, x, i) => sum + x * (m[row + i] ?? 0), 0),
  );
  return { x: u / w + 0.5, y: v / w + 0.5 };
}

test("a missing ridge is drawn by two clicks in one photograph", async () => {
  test.slow();
  await plant(page, [{ correction: "merge", facet: placeOf(west), with: placeOf(east) }]);
  const wrong = await roofOf(page);
  expect(wrong).toHaveLength(truth.length - 1);

  const [photograph = ""] = houseFiles().flatMap(({ name }) => (name.endsWith(".jpg") ? [name] : []));
  const view = photograph.replace(".jpg", "");
  const [gable = west.corners[0], inner = west.corners[1]] = [...west.corners].sort((p, q) => q[2] - p[2]);
  const draw = panel().getByRole("button", { name: "Draw an edge in a photograph" });
  const canvas = page.getByRole("img", { name: new RegExp(`^${photograph}`) });
  /** Clicks a pixel of the photograph, which is shown whole. */
  const click = async ({ x, y }: { x: number; y: number }) => {
    const box = await canvas.boundingBox();
    const size = await page.evaluate(
      () => document.querySelector("figure.image-view canvas")?.clientHeight ?? 0,
    );
    if (box === null || size === 0) {
      throw new Error("the photograph is not shown");
    }
    const scale = Math.min((box.width - 16) / SIZE_PX[0], (box.height - 16) / SIZE_PX[1]);
    const [left, top] = [box.width - SIZE_PX[0] * scale, box.height - SIZE_PX[1] * scale];
    await page.mouse.click(box.x + left / 2 + x * scale, box.y + top / 2 + y * scale);
  };

  await test.step("two clicks, two pixels off, bring both slopes back", async () => {
    const started = Date.now();
    await draw.click();
    await page.getByRole("button", { name: photograph, exact: true }).click();
    const [from, to] = [pixelOf(view, gable as Place), pixelOf(view, inner as Place)];
    await click({ x: from.x + 1.4, y: from.y - 1.4 });
    await expect(panel().getByText("Click the other end in the same photograph.")).toBeVisible();
    await click({ x: to.x - 1.4, y: to.y + 1.4 });
    await expect(done()).toHaveCount(2);
    await settled(page);
    expect(Date.now() - started).toBeLessThan(30_000);
    await expect(done().last()).toContainText(`Edge drawn in ${photograph}`);
    const found = await roofOf(page);
    expect(found).toHaveLength(truth.length);
    expect(offBy(found, truth)).toBeLessThan(0.25);
    for (const face of [west, east]) {
      const slopes = found.filter(({ azimuthDeg }) => Math.abs(azimuthDeg - face.azimuthDeg) < 5);
      expect(Math.min(...slopes.map((f) => Math.abs(f.slopeDeg - face.slopeDeg)))).toBeLessThan(2);
    }
  });

  await test.step("it is undone and done again; an edge over the lawn says why it is none", async () => {
    await panel().getByRole("button", { name: "Undo" }).click();
    await settled(page);
    expect(await roofOf(page)).toEqual(wrong);
    await panel().getByRole("button", { name: "Redo" }).click();
    await settled(page);
    expect(await roofOf(page)).toHaveLength(truth.length);
    await draw.click();
    await canvas.focus();
    await page.keyboard.press("Escape");
    await expect(draw).toHaveAttribute("aria-pressed", "false");
    await draw.click();
    await click({ x: 3, y: 3 });
    await click({ x: 40, y: 3 });
    await expect(
      panel().getByText(/Not applied: (no building stands there|too few other photographs)/),
    ).toBeVisible();
  });
});
