/** The npm package, installed from its tarball into an empty project. */
import { execFileSync, spawnSync } from "node:child_process";
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer, type Server } from "node:http";
import type { AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { expect, test } from "@playwright/test";
import { demoImages, demoOrientation } from "./helpers";

const WWW = fileURLToPath(new URL("../..", import.meta.url));
const DEMO = join(WWW, "public/demo");
const TYPES: Readonly<Record<string, string>> = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".wasm": "application/wasm",
};

let project = "";
let server: Server;

test.beforeAll(() => {
  const printed = execFileSync("node", ["scripts/package.mjs"], { cwd: WWW, encoding: "utf8" });
  const tarball = printed.trim().split("\n").at(-1) as string;
  project = mkdtempSync(join(tmpdir(), "ridgeline-package-"));
  writeFileSync(join(project, "package.json"), JSON.stringify({ type: "module", private: true }));
  execFileSync("npm", ["install", "--offline", "--no-audit", "--no-fund", tarball], { cwd: project });
  const page = "browser.html";
  copyFileSync(join(project, "node_modules/ridgeline/examples", page), join(project, page));
  server = createServer((request, response) => {
    const path = normalize(new URL(request.url ?? "/", "http://localhost").pathname);
    try {
      const body = readFileSync(join(project, path));
      response
        .writeHead(200, { "content-type": TYPES[extname(path)] ?? "application/octet-stream" })
        .end(body);
    } catch {
      response.writeHead(404).end();
    }
  }).listen(0, "127.0.0.1");
});

test.afterAll(() => {
  server.close();
  rmSync(project, { recursive: true, force: true });
});

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
  const { port } = server.address() as AddressInfo;
  await page.goto(`http://127.0.0.1:${port}/browser.html`);
  await page.setInputFiles("input", [...demoImages(6), ...demoOrientation()]);
  await expect(page.locator("output")).toContainText(/\d{2,} facets, \d+ files/, { timeout: 140_000 });
});

test("has types that a strict project takes", () => {
  writeFileSync(
    join(project, "use.ts"),
    `import { createWorker, type Reconstruction } from "ridgeline";
     const result: Reconstruction = await createWorker().reconstruct([]);
     export const bytes: Uint8Array | undefined = result.files.get("model.glb");
     export const slope: number | undefined = result.facets[0]?.plane.normal[2];`,
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
