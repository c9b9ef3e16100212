import { execFileSync } from "node:child_process";
import { existsSync } from "node:fs";
import { defineConfig } from "@playwright/test";

/** A Chromium of the system where there is one, otherwise Playwright's own. */
const chromium = process.env["CHROMIUM"] ?? "/usr/bin/chromium";
/** A free one, so that a demo may still run; all processes of the tests read the same. */
process.env["PORT"] ??= execFileSync(process.execPath, [
  "-e",
  "const server = require('net').createServer().listen(0, () => { console.log(server.address().port); server.close(); })",
])
  .toString()
  .trim();
const PORT = Number(process.env["PORT"]);

export default defineConfig({
  testDir: "test/e2e",
  outputDir: "test-results",
  workers: 2,
  projects: [
    { name: "page", grepInvert: /@alone/ },
    // What measures time has the machine for itself.
    { name: "alone", grep: /@alone/, dependencies: ["page"], workers: 1 },
  ],
  timeout: 150_000,
  // Drawing in software may be late on a busy machine; what fails twice is wrong.
  retries: 1,
  expect: { timeout: 20_000 },
  reporter: [["list"]],
  use: {
    baseURL: `http://127.0.0.1:${PORT}`,
    viewport: { width: 1280, height: 800 },
    screenshot: "only-on-failure",
    // Copies the whole site for each page: where it is what is asked about, it is allowed.
    serviceWorkers: "block",
    // What turns costs a processor that draws in software.
    contextOptions: { reducedMotion: "reduce" },
    launchOptions: {
      ...(existsSync(chromium) ? { executablePath: chromium } : {}),
      args: [
        "--no-sandbox",
        // Software graphics for WebGL alone, as browsers have them without a graphics card: the page is drawn without.
        "--use-gl=angle",
        "--use-angle=swiftshader-webgl",
        "--enable-unsafe-swiftshader",
        // Without a graphics card photographs are drawn by the processor, as browsers do by themselves.
        "--disable-accelerated-2d-canvas",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--no-first-run",
      ],
    },
  },
  webServer: {
    command: `npx vite preview --host 127.0.0.1 --port ${PORT} --strictPort`,
    url: `http://127.0.0.1:${PORT}`,
    reuseExistingServer: false,
  },
});
