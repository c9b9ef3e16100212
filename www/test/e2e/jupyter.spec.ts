/**
 * The example notebook in a real JupyterLab: executed, opened, turned by Python and by a reader. Needs a Python that has jupyterlab and
 * anywidget: the one that JUPYTER_PYTHON names, or python3; without one it is skipped, and says so.
 */
import { type ChildProcess, spawn, spawnSync } from "node:child_process";
import { createServer } from "node:net";
import { expect, test } from "@playwright/test";
import { type PackedProject, packedProject } from "./packed";

const PYTHON = process.env["JUPYTER_PYTHON"] ?? "python3";
const isThere = spawnSync(PYTHON, ["-c", "import jupyterlab, anywidget, ipykernel"]).status === 0;

let packed: PackedProject | null = null;
let server: ChildProcess | null = null;
let address = "";

const LACKING = `${PYTHON} has no jupyterlab with anywidget (pip install jupyterlab anywidget)`;
test.skip(!isThere, LACKING);
if (!isThere) {
  console.info(`jupyter: skipped, ${LACKING}`);
}

test.beforeAll(async () => {
  if (!isThere) {
    return;
  }
  packed = await packedProject(["notebook.ipynb"]);
  const port = await freePort();
  address = `http://127.0.0.1:${port}/`;
  const own = {
    JUPYTER_CONFIG_DIR: packed.folder,
    JUPYTER_DATA_DIR: packed.folder,
    IPYTHONDIR: packed.folder,
  };
  const options = [
    "--no-browser",
    `--port=${port}`,
    "--ip=127.0.0.1",
    "--IdentityProvider.token=",
    "--allow-root",
  ];
  server = spawn(PYTHON, ["-m", "jupyterlab", ...options, "--expose-app-in-browser"], {
    cwd: packed.folder,
    env: { ...process.env, ...own },
    stdio: "ignore",
  });
  await expect.poll(() => answers(`${address}api`), { timeout: 60_000 }).toBe(true);
});

test.afterAll(() => {
  server?.kill();
  packed?.close();
});

test("the notebook shows a figure, which follows Python and which Python follows", async ({ page }) => {
  await page.setViewportSize({ width: 1280, height: 1000 });
  await page.goto(`${address}lab/tree/notebook.ipynb?reset`);
  const cells = page.locator(".jp-Notebook .jp-CodeCell");
  await expect(cells).toHaveCount(4, { timeout: 60_000 });
  await page.getByRole("menuitem", { name: "Run", exact: true }).click();
  await page.getByText("Run All Cells", { exact: true }).click();

  const figure = page.locator("ridgeline-figure");
  const theta = figure.getByTestId("theta");
  await figure.scrollIntoViewIfNeeded({ timeout: 60_000 });
  await expect(theta).toHaveText("20.0°", { timeout: 100_000 });
  const slider = figure.getByRole("slider", { name: /Angle/ });
  await slider.focus();
  await slider.press("ArrowRight");
  await expect(theta).toHaveText("20.5°");

  // Python reads it: the last cell once more.
  const last = cells.last();
  await expect
    .poll(
      async () => {
        await last.locator(".cm-content").click();
        await page.keyboard.press("Control+Enter");
        await page.waitForTimeout(500);
        return last.locator(".jp-OutputArea-output").textContent();
      },
      { timeout: 30_000 },
    )
    .toMatch(/^20\.5 (halfplane|side):/);
  await page.screenshot({ path: test.info().outputPath("jupyter.png") });
});

function answers(url: string): Promise<boolean> {
  return fetch(url).then(
    ({ ok }) => ok,
    () => false,
  );
}

function freePort(): Promise<number> {
  return new Promise((resolve) => {
    const probe = createServer();
    probe.listen(0, "127.0.0.1", () => {
      const { port } = probe.address() as { port: number };
      probe.close(() => resolve(port));
    });
  });
}
