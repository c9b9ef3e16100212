/** The built site, served and opened in Chromium, for the scripts that take pictures of it. */
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { chromium } from "@playwright/test";

/** Serves the site at a port, and does the work with its address and a browser. */
export async function withSite(port, work) {
  const server = spawn(
    "npx",
    ["vite", "preview", "--host", "127.0.0.1", "--port", String(port), "--strictPort"],
    { detached: true },
  );
  try {
    await new Promise((resolve) => setTimeout(resolve, 2500));
    const system = process.env.CHROMIUM ?? "/usr/bin/chromium";
    const browser = await chromium.launch({
      ...(existsSync(system) ? { executablePath: system } : {}),
      args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
    });
    await work(browser);
    await browser.close();
  } finally {
    process.kill(-server.pid);
  }
}
