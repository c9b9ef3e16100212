/** The npm package, installed from its tarball into an empty project. */
import { execFileSync, spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { expect, test } from "@playwright/test";
import { demoImages, demoOrientation } from "./helpers";
import { type PackedProject, packedProject, WWW } from "./packed";

const DEMO = join(WWW, "public/demo");

let packed: PackedProject;
let project = "";

test.beforeAll(async () => {
  packed = await packedProject(["browser.html"]);
  project = packed.folder;
});

test.afterAll(() => packed.close());

test("reconstructs the demo scene in Node", () => {
  const example = join(project, "node_modules/ridgeline/examples/node.mjs");
  const printed = execFileSync("node", [example, DEMO, "out"], { cwd: project, encoding: "utf8" });
  const facets = Number(/(\d+) facets/.exec(printed)?.[1]);
  expect(facets).toBeGreaterThan(10);
  const model = JSON.parse(readFileSync(join(project, "out/model.city.json"), "utf8"));
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
    const run = worker.reconstruct(await readScene(${JSON.stringify(DEMO)}), { signal: cancel.signal, onProgress });
    console.log(await run.catch((e) => e.message));
  `;
  const { stdout, stderr } = spawnSync("node", ["--input-type=module", "-e", script], {
    cwd: project,
    encoding: "utf8",
  });
  expect(stdout.trim().split("\n"), stderr).toEqual(["true,true", "stop"]);
});

test("reconstructs the demo scene in Chromium", async ({ page }) => {
  await page.goto(`${packed.address}browser.html`);
  await page.setInputFiles("input", [...demoImages(6), ...demoOrientation()]);
  await expect(page.locator("output")).toContainText(/\d{2,} facets, \d+ files/, { timeout: 140_000 });
});

test("has types that a strict project takes", () => {
  writeFileSync(
    join(project, "use.ts"),
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
    cwd: project,
    encoding: "utf8",
  });
  expect(stdout).toBe("");
  expect(status).toBe(0);
});
