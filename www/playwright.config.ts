import { existsSync } from "node:fs";
import { defineConfig } from "@playwright/test";

/** A Chromium of the system where there is one, otherwise Playwright's own. */
const chromium = process.env["CHROMIUM"] ?? "/usr/bin/chromium";
const PORT = Number(process.env["PORT"] ?? 4173);

export default defineConfig({
  testDir: "test/e2e",
  outputDir: "test-results",
  // What measures time (@alone) has the machine for itself.
  workers: 2,
  timeout: 150_000,
  // Drawing in software may be late on a busy machine; what fails twice is wrong.
  retries: 1,
  expect: { timeout: 20_000 },
  reporter: [["list"]],
  use: {
    baseURL: `http://127.0.0.1:${PORT}`,
    viewport: { width: 1280, height: 800 },
    screenshot: "only-on-failure",
    // What turns costs a processor that draws in software.
    contextOptions: { reducedMotion: "reduce" },
    launchOptions: {
      ...(existsSync(chromium) ? { executablePath: chromium } : {}),
      args: [
        "--no-sandbox",
        "--use-gl=angle",
        "--use-angle=swiftshader",
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
