/**
 * The npm package, installed from its tarball into an empty project: in Node and in Chromium, and its elements in a plain page, on
 * slides, in a frame and as a notebook's widget.
 */
import { execFileSync, spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { expect, type Locator, type Page, test } from "@playwright/test";
import type { RidgelineExercise as Exercise } from "../../package/types/exercise";
import type { RidgelineFigure as Figure } from "../../package/types/figure";
import { houseFiles } from "./helpers";
import { type PackedProject, packedProject, WWW } from "./packed";

let packed: PackedProject;
let scene = "";

test.beforeAll(async () => {
  packed = await packedProject(
    ["browser.html", "figures.html", "slides.html", "exercises.html"],
    ["reveal.js"],
  );
  scene = join(packed.folder, "house");
  mkdirSync(scene);
  for (const { name, buffer } of houseFiles()) {
    writeFileSync(join(scene, name), buffer);
  }
  copyFileSync(join(WWW, "test/fixtures/widget.html"), join(packed.folder, "widget.html"));
});

test.afterAll(() => packed.close());

/** Opens a page; its figures say in `data-ready` that they are drawn, and `told` keeps what they tell. */
async function open(page: Page, path: string): Promise<string[]> {
  const problems: string[] = [];
  page.on("pageerror", ({ message }) => problems.push(message));
  packed.asked.length = 0;
  await page.addInitScript(() => {
    document.addEventListener("ridgeline-ready", ({ target }) => {
      (target as HTMLElement).dataset["ready"] = "";
    });
    const told: unknown[] = [];
    Object.assign(window, { told });
    document.addEventListener("ridgeline-state", (event) => told.push((event as CustomEvent).detail));
  });
  await page.goto(packed.address + path);
  return problems;
}

async function ready(figure: Locator): Promise<void> {
  await figure.scrollIntoViewIfNeeded();
  await expect(figure).toHaveAttribute("data-ready", "", { timeout: 100_000 });
}

const askedFor = (ending: string) => packed.asked.filter((path) => path.endsWith(ending)).length;
const stateOf = (figure: Locator) => figure.evaluate((element: Figure) => element.state);

test("reconstructs a scene in Node", () => {
  const example = join(packed.folder, "node_modules/ridgeline/examples/node.mjs");
  const printed = execFileSync("node", [example, scene, "out"], { cwd: packed.folder, encoding: "utf8" });
  const facets = Number(/(\d+) facets/.exec(printed)?.[1]);
  expect(facets).toBeGreaterThan(2);
  const model = JSON.parse(readFileSync(join(packed.folder, "out/model.city.json"), "utf8"));
  expect(model.type).toBe("CityJSON");
});

test("rejects what is no scene, and can be cancelled, in Node", () => {
  const script = `
    import { createWorker, InputError, readScene } from "ridgeline";
    const worker = createWorker();
    const none = worker.reconstruct([{ path: "a.txt", bytes: new Uint8Array([1, 2, 3]) }]);
    console.log(await none.catch((e) => [e instanceof InputError, e.message.length > 20].join()));
    const cancel = new AbortController();
    const onProgress = () => cancel.abort(new Error("stop"));
    const run = worker.reconstruct(await readScene(${JSON.stringify(scene)}), { signal: cancel.signal, onProgress });
    console.log(await run.catch((e) => e.message));
  `;
  const { stdout, stderr } = spawnSync("node", ["--input-type=module", "-e", script], {
    cwd: packed.folder,
    encoding: "utf8",
  });
  expect(stdout.trim().split("\n"), stderr).toEqual(["true,true", "stop"]);
});

test("reconstructs a scene in Chromium", async ({ page }) => {
  await page.goto(`${packed.address}browser.html`);
  await page.setInputFiles("input", houseFiles());
  await expect(page.locator("output")).toContainText(/[3-9] facets, \d+ files/, { timeout: 100_000 });
});

test("has types that a strict project takes", () => {
  writeFileSync(
    join(packed.folder, "use.ts"),
    `import { createWorker, type Reconstruction } from "ridgeline";
     const result: Reconstruction = await createWorker().reconstruct([]);
     export const bytes: Uint8Array | undefined = result.files.get("model.glb");
     export const slope: number | undefined = result.facets[0]?.plane.normal[2];
     import "ridgeline/figure";
     import widget from "ridgeline/anywidget";
     const figure = document.createElement("ridgeline-figure");
     figure.state = { theta: 12 };
     figure.addEventListener("ridgeline-state", ({ detail }) => console.log(detail.theta?.toFixed(1)));
     export const draw: Function = widget.render;`,
  );
  const options = [
    "--noEmit",
    "--strict",
    "--module",
    "nodenext",
    "--target",
    "es2022",
    "--types",
    "",
    "use.ts",
  ];
  const { stdout, status } = spawnSync(join(WWW, "node_modules/.bin/tsc"), options, {
    cwd: packed.folder,
    encoding: "utf8",
  });
  expect(stdout).toBe("");
  expect(status).toBe(0);
});

test.describe("three figures in a page", () => {
  test.describe.configure({ mode: "serial" });
  let page: Page;
  let problems: string[];

  test.beforeAll(async ({ browser }) => {
    page = await browser.newPage({ viewport: { width: 1000, height: 90 } });
    problems = await open(page, "figures.html");
  });

  test.afterAll(async () => {
    expect(problems).toEqual([]);
    await page.close();
  });

  test("share a worker and a scene, and nothing is fetched before one is seen", async () => {
    // The first figure begins below the window's edge.
    await page.evaluate(() => window.scrollTo(0, 0));
    await page.waitForTimeout(600);
    expect(askedFor(".js")).toBe(1);
    expect(askedFor(".wasm") + askedFor(".jpg") + askedFor("manifest.json")).toBe(0);

    await page.setViewportSize({ width: 1000, height: 800 });
    const figures = page.locator("ridgeline-figure");
    await expect(figures).toHaveCount(3);
    for (const figure of await figures.all()) {
      await ready(figure);
    }
    expect([askedFor(".wasm"), askedFor("worker.js"), askedFor("manifest.json")]).toEqual([1, 1, 1]);
    expect(askedFor(".jpg")).toBe(6);
    expect(page.workers()).toHaveLength(1);
  });

  test("attributes and properties turn a figure, and it tells what a reader does, by key as well", async () => {
    const sweep = page.locator("#sweep");
    const output = sweep.getByTestId("theta");
    const first = await output.textContent();
    await page.getByRole("button", { name: "one angle" }).click();
    await expect(output).toHaveText("0.0°");
    expect(first).not.toBe("0.0°");
    await sweep.evaluate((element) => element.setAttribute("theta", "31.5"));
    await expect(output).toHaveText("31.5°");

    const slider = sweep.getByRole("slider", { name: /Angle/ });
    await slider.focus();
    await slider.press("ArrowRight");
    await expect(output).toHaveText("32.0°");
    await expect.poll(async () => (await stateOf(sweep)).theta).toBe(32);
    const told = await page.evaluate(() => (window as unknown as { told: { theta: number }[] }).told);
    expect(told.map(({ theta }) => theta)).toContain(32);

    // Another line, at an angle that came with it.
    await sweep.evaluate((element: Figure) => {
      element.state = { select: "side:12.right", theta: -10 };
    });
    await expect(sweep.getByText(/^Line 13, right side/)).toBeVisible();
    await expect(output).toHaveText("-10.0°");

    const beam = page.locator("ridgeline-figure").first();
    // The wheel moves the text, until a photograph has the focus.
    const photograph = beam.locator(".image-view").first();
    const scale = photograph.locator("figcaption");
    await photograph.hover();
    const scaled = await scale.textContent();
    await page.evaluate(() => window.scrollTo(0, 0));
    await page.mouse.wheel(0, 60);
    await expect.poll(() => page.evaluate(() => window.scrollY)).toBeGreaterThan(20);
    await expect(scale).toHaveText(scaled ?? "");
    await photograph.locator("canvas").focus();
    await photograph.hover();
    await page.mouse.wheel(0, -200);
    await expect(scale).not.toHaveText(scaled ?? "");
    await beam.getByRole("slider").press("Home");
    await expect.poll(async () => (await stateOf(beam)).point).toEqual([0, 0]);
    // By Tab alone, from the slider to what can be taken along.
    for (let i = 0; i < 4; i += 1) {
      await page.keyboard.press("Tab");
      const inside = await beam.evaluate((element) => element.shadowRoot?.activeElement?.tagName ?? "");
      if (inside === "SUMMARY") {
        break;
      }
    }
    await page.keyboard.press("Enter");
    await expect(beam.getByRole("button", { name: "SVG" })).toBeVisible();
  });

  // What is no state is left out of a link: test/unit/app/takeAlong.test.ts.
  test("a link opens a figure in the same state", async ({ browser }) => {
    const sweep = page.locator("#sweep");
    await sweep.getByText("Take along").click();
    await sweep.getByRole("button", { name: "Link" }).click();
    const link = await sweep.getByRole("textbox", { name: "Link" }).inputValue();
    expect(link).toContain("#sweep=");

    const fresh = await browser.newPage();
    await open(fresh, link.slice(packed.address.length));
    const opened = fresh.locator("#sweep");
    await ready(opened);
    await expect(opened.getByText(/^Line 13, right side/)).toBeVisible();
    await expect(opened.getByTestId("theta")).toHaveText("-10.0°");
    await fresh.close();
  });

  test("what is taken along is what it says: SVG with lines over photographs, PNG in print size, CSV, JSON, BibTeX", async () => {
    const beam = page.locator("ridgeline-figure").first();
    // In the middle of the segment both windows are there.
    await beam.evaluate((element: Figure) => {
      element.state = { point: [0, 0.5] };
    });
    const saved = async (name: string) => {
      const download = page.waitForEvent("download");
      await beam.getByRole("button", { name, exact: true }).click();
      const file = await download;
      expect(file.suggestedFilename()).toBe(`epipolar-beam.${name.toLowerCase()}`);
      return readFileSync(await file.path());
    };

    const svg = (await saved("SVG")).toString("utf8");
    const found = await page.evaluate((text) => {
      const parsed = new DOMParser().parseFromString(text, "image/svg+xml");
      const count = (selector: string) => parsed.querySelectorAll(selector).length;
      return {
        errors: count("parsererror"),
        photographs: count('image[href^="data:image/jpeg"]'),
        windows: count('image[href^="data:image/png"]'),
        // The casing and the beam itself, filled.
        beams: count('path[fill="#f4f6f8"]'),
        texts: [...parsed.querySelectorAll("text")].map((one) => one.textContent),
      };
    }, svg);
    expect(found).toMatchObject({ errors: 0, photographs: 2, windows: 2 });
    expect(found.beams).toBeGreaterThan(0);
    expect(found.texts).toEqual(expect.arrayContaining(["x", "x′", "F x", "Candidate", "Score"]));
    expect(svg).not.toMatch(/var\(|NaN|undefined/);

    const png = await saved("PNG");
    expect(png.subarray(1, 4).toString()).toBe("PNG");
    // Width, and 300 dots per inch.
    expect(png.readUInt32BE(16)).toBeGreaterThanOrEqual(1890);
    const density = png.indexOf("pHYs");
    expect(Math.round(png.readUInt32BE(density + 4) * 0.0254)).toBe(300);
    const size = await page.evaluate(
      async (address) => {
        const bitmap = await createImageBitmap(await (await fetch(address)).blob());
        return [bitmap.width, bitmap.height];
      },
      `data:image/png;base64,${png.toString("base64")}`,
    );
    expect(size[0]).toBe(png.readUInt32BE(16));

    const { rows, link, figure } = JSON.parse((await saved("JSON")).toString("utf8"));
    expect(figure).toBe("epipolar-beam");
    expect(decodeURIComponent(decodeURIComponent(link))).toMatch(/#figure1=select=segment:0\.\d+/);
    const lines = (await saved("CSV")).toString("utf8").trimEnd().split("\r\n");
    expect(lines).toHaveLength(rows.length + 1);
    expect(lines[0]?.split(",").slice(0, 4)).toEqual(["candidate", "view", "segment", "score"]);
    expect(Number(lines[1]?.split(",")[3])).toBe(rows[0].score);

    await beam.getByRole("button", { name: "Cite" }).click();
    const cited = await beam.getByRole("textbox", { name: "BibTeX" }).inputValue();
    expect(cited).toMatch(/@inproceedings\{Baillard1999,[\s\S]*year += \{1999\},[\s\S]*Section 3\.1 to 3\.4/);
  });

  test("axe finds nothing in light and dark, and nothing is wider than a phone or too small for a projector", async () => {
    const figures = page.locator("ridgeline-figure");
    await page.addScriptTag({ path: join(WWW, "node_modules/axe-core/axe.min.js") });
    const papers: string[] = [];
    for (const colorScheme of ["light", "dark"] as const) {
      await page.emulateMedia({ colorScheme });
      papers.push(await paperOf(figures.first()));
      for (const [width, layout] of [
        [320, "phone"],
        [1000, "wide"],
        [1920, "wide"],
      ] as const) {
        await page.setViewportSize({ width, height: 900 });
        await expect(figures.last().locator(".frame")).toHaveAttribute("data-layout", layout);
        await expect(figures.first().locator(".frame")).toHaveAttribute("data-layout", layout);
        await expect
          .poll(() => page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth), {
            message: `${width} px`,
          })
          .toBeLessThanOrEqual(0);
        expect(await axeFindings(page), `${colorScheme}, ${width} px`).toEqual([]);
      }
    }
    expect(papers[0]).not.toBe(papers[1]);
    // What the author says goes before what the system prefers, and so do colours of the page.
    await figures.first().evaluate((element) => element.setAttribute("theme", "light"));
    expect(await paperOf(figures.first())).toBe(papers[0]);
    await page.addStyleTag({ content: "ridgeline-figure { --paper: rgb(1, 2, 3) }" });
    expect(await paperOf(figures.first())).toBe("rgb(1, 2, 3)");
  });
});

/** What axe finds in the elements of the package, shadow trees and all. */
function axeFindings(page: Page): Promise<string[]> {
  return page.evaluate(async () => {
    const axe = (window as unknown as { axe: { run(of: Element[]): Promise<AxeResult> } }).axe;
    const own = [...document.querySelectorAll("ridgeline-figure, ridgeline-exercise")];
    const { violations } = await axe.run(own);
    return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" | ")}`);
  });
}

interface AxeResult {
  violations: { id: string; nodes: { html: string }[] }[];
}

const paperOf = (figure: Locator) =>
  figure.locator(".frame").evaluate((element) => getComputedStyle(element).backgroundColor);

test("on slides: begins with its slide, and its keys are its own", async ({ page }) => {
  const problems = await open(page, "slides.html");
  await expect(page.getByRole("heading", { name: "Half-planes" })).toBeVisible();
  await page.waitForTimeout(500);
  expect(askedFor(".wasm")).toBe(0);
  await page.keyboard.press("ArrowRight");
  const first = page.locator("ridgeline-figure").first();
  await expect(first).toHaveAttribute("data-ready", "", { timeout: 100_000 });
  const slider = first.getByRole("slider", { name: /Angle/ });
  const before = await first.getByTestId("theta").textContent();
  await slider.press("ArrowRight");
  await expect(first.getByTestId("theta")).not.toHaveText(before ?? "");
  await expect(first).toBeInViewport();
  expect(new URL(page.url()).hash).not.toContain("/2");

  // The next slide: the deck turns its figure.
  await slider.evaluate((element: HTMLElement) => element.blur());
  await page.keyboard.press("ArrowRight");
  const turned = page.locator("#turned");
  await expect(turned).toHaveAttribute("data-ready", "", { timeout: 100_000 });
  await page.keyboard.press("ArrowRight");
  await expect(turned.getByTestId("theta")).toHaveText("-60.0°");
  expect(askedFor(".wasm")).toBe(1);
  expect(problems).toEqual([]);
});

test("as a widget of a notebook: one module without an address, files as traits, state both ways", async ({
  page,
}) => {
  const problems = await open(page, "widget.html");
  const figure = page.locator("ridgeline-figure");
  await ready(figure);
  await expect(figure.getByTestId("theta")).toHaveText("25.0°");
  expect(askedFor("worker.js")).toBe(0);
  await figure.getByRole("slider", { name: /Angle/ }).press("ArrowLeft");
  await expect.poll(() => page.evaluate("model.get('theta')")).toBe(24.5);
  await page.evaluate("model.change('theta', 40)");
  await expect(figure.getByTestId("theta")).toHaveText("40.0°");
  await page.evaluate("end()");
  await expect(figure).toHaveCount(0);
  expect(problems).toEqual([]);
});

test("in a frame of another origin, and with a scene by its address", async ({ page }) => {
  // The same files, by another name of this machine.
  const other = packed.address.replace("127.0.0.1", "localhost");
  writeFileSync(
    join(packed.folder, "foreign.html"),
    `<!doctype html><script type="module" src="${other}node_modules/ridgeline/dist/element/figure.js"></script>
     <ridgeline-figure kind="segments" scene="${other}node_modules/ridgeline/dist/demo/manifest.json"></ridgeline-figure>`,
  );
  writeFileSync(
    join(packed.folder, "frame.html"),
    `<!doctype html><iframe src="${packed.address}foreign.html" width="900" height="700"></iframe>`,
  );
  await page.goto(`${other}frame.html`);
  const figure = page.frameLocator("iframe").locator("ridgeline-figure");
  await expect(figure.locator(".image-view canvas")).toBeVisible({ timeout: 100_000 });
  expect((await figure.evaluate((element: Figure) => element.rows())).length).toBeGreaterThan(500);
});

test("says what is wrong: an unknown kind, a scene that is not there, a file that is none", async ({
  page,
}) => {
  copyFileSync(join(packed.folder, "package.json"), join(packed.folder, "other.json"));
  writeFileSync(join(packed.folder, "broken.zip"), "PK\u0003\u0004, and no archive");
  const figure = (of: string) => `<ridgeline-figure ${of}></ridgeline-figure>`;
  writeFileSync(
    join(packed.folder, "wrong.html"),
    `<!doctype html><script type="module" src="./node_modules/ridgeline/dist/element/figure.js"></script>
     ${figure('kind="perpetuum-mobile"')}${figure('kind="segments" scene="none.zip"')}
     ${figure('kind="segments" scene="other.json"')}${figure('kind="segments" scene="broken.zip"')}`,
  );
  await open(page, "wrong.html");
  const alerts = page.locator("ridgeline-figure [role=alert]");
  await expect(alerts).toHaveText([
    /no figure of kind "perpetuum-mobile".*epipolar-beam, /,
    /none\.zip: the server answered 404/,
    /a manifest names the files/,
    /broken\.zip/,
  ]);
  // Another kind is another beginning.
  const first = page.locator("ridgeline-figure").first();
  await first.evaluate((element) => {
    element.setAttribute("kind", "segments");
  });
  await ready(first);
  await expect(first.locator(".image-view canvas")).toBeVisible();
});

test("exercises: right, a named mistake, a wrong form, an error with its line, a loop without end", async ({
  page,
}) => {
  const problems = await open(page, "exercises.html");
  const exercise = page.locator("ridgeline-exercise[name=triangulate]");
  const editor = exercise.getByRole("textbox", { name: /function triangulate/ });
  const status = exercise.getByRole("status");
  const check = exercise.getByRole("button", { name: "Check" });
  await page.evaluate(() => {
    const checked: unknown[] = [];
    Object.assign(window, { checked });
    document.addEventListener("ridgeline-checked", (event) => checked.push((event as CustomEvent).detail));
  });

  await check.click();
  await expect(status).toContainText("Return 3 numbers; this is [].");

  await exercise.getByText("A solution").click();
  await exercise.getByRole("button", { name: "Take it" }).click();
  // As a person writes: the keyboard alone.
  await editor.press("Control+Enter");
  await expect(status).toContainText("Right, in all of 24 planted configurations.");

  const solution = await exercise.evaluate((element: Exercise) => element.code);
  const write = (code: string) =>
    exercise.evaluate((element: Exercise, text) => {
      element.code = text;
    }, code);
  await write(solution.replace("at[k] * v - M", "(at[k] + 0.5) * v - M"));
  await check.click();
  await expect(status).toContainText("half a pixel");

  await write(`function triangulate(P) {\n  console.log("rows", P.length);\n  return missing;\n}`);
  await check.click();
  await expect(status).toContainText("Line 3: ReferenceError: missing is not defined");
  await expect(status).toContainText("rows 3");

  await write("function triangulate(P {\n  return 1;\n}");
  await check.click();
  await expect(status).toContainText(/Line 1: .*SyntaxError/);

  await write("function triangulate() {\n  for (;;);\n}");
  await check.click();
  await expect(status).toContainText("No answer after 2 s");

  // Nothing of the page or the network is in its reach.
  await write("function triangulate() {\n  return [typeof fetch, typeof document, typeof importScripts];\n}");
  await check.click();
  await expect(status).toContainText('["undefined","undefined","undefined"]');

  const checked = await page.evaluate(() => (window as unknown as { checked: unknown[] }).checked);
  expect(checked.slice(0, 3)).toEqual([
    { name: "triangulate", right: false, mistake: null, seed: null },
    { name: "triangulate", right: true, mistake: null, seed: null },
    { name: "triangulate", right: false, mistake: "half a pixel", seed: null },
  ]);
  await page.addScriptTag({ path: join(WWW, "node_modules/axe-core/axe.min.js") });
  for (const colorScheme of ["light", "dark"] as const) {
    await page.emulateMedia({ colorScheme });
    expect(await axeFindings(page), colorScheme).toEqual([]);
  }
  await page.setViewportSize({ width: 320, height: 800 });
  await page.screenshot({ path: test.info().outputPath("exercises.png"), fullPage: true });
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(320);
  expect(problems).toEqual([]);
});

test("exercises: an exercise in a figure fetches the figures' module itself, and a number has values of its own", async ({
  page,
}) => {
  const problems = await open(page, "exercises.html");
  const turn = page.locator("ridgeline-exercise[name=turnToRoof]");
  const figure = turn.locator("ridgeline-figure");
  // From outside, what its figure tells comes from the exercise.
  await ready(turn);
  await expect.poll(async () => (await stateOf(figure)).theta).toBe(0);
  await turn.getByRole("button", { name: "Check" }).click();
  await expect(turn.locator(".said")).toContainText("level");
  await turn.getByText("A solution").click();
  await turn.getByRole("button", { name: "Show it" }).click();
  await turn.getByRole("button", { name: "Check" }).click();
  await expect(turn.locator(".said")).toHaveText("Right.");

  const ridge = page.locator("ridgeline-exercise[name=heightOfRidge]");
  await expect(ridge).toContainText("Values no. 17");
  await ridge.getByRole("textbox", { name: "Number and unit" }).fill("3.1");
  await ridge.getByRole("button", { name: "Check" }).click();
  await expect(ridge.getByRole("status")).toContainText("The unit is missing");
  expect(problems).toEqual([]);
});
