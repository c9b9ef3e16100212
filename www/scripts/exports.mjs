/** The figures' own exports, as a reader takes them along: `<ridgeline-figure>` of the npm package on the demo scene, as SVG. */
import { execFileSync } from "node:child_process";
import { createReadStream, existsSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

const WWW = fileURLToPath(new URL("..", import.meta.url));
const TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".json": "application/json",
  ".wasm": "application/wasm",
};
/** Of print: what is 800 px wide on the page. */
const WIDTH_PX = 960;

/** Builds the package, serves it, and does the work with what exports a figure: `(attributes) => SVG`. */
export async function withExports(browser, work) {
  execFileSync("node", ["scripts/package.mjs"], { cwd: WWW, stdio: ["ignore", "ignore", "inherit"] });
  const folder = join(WWW, "package/dist");
  const page = `<!doctype html><meta charset="utf-8"><script type="module" src="/element/figure.js"></script><body>`;
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url, "http://localhost").pathname);
    const file = join(folder, path);
    if (path === "/") {
      response.writeHead(200, { "content-type": "text/html" }).end(page);
    } else if (existsSync(file) && statSync(file).isFile()) {
      response.writeHead(200, { "content-type": TYPES[extname(path)] ?? "application/octet-stream" });
      createReadStream(file).pipe(response);
    } else {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const tab = await browser.newPage({ viewport: { width: WIDTH_PX, height: 900 }, colorScheme: "light" });
  await tab.goto(`http://127.0.0.1:${server.address().port}/`);
  try {
    await work((attributes) => tab.evaluate(exported, attributes));
  } finally {
    await tab.close();
    server.close();
  }
}

/** In the page: the figure in that state, drawn. It takes the place of the one before, and over its scene where that is the same. */
async function exported(attributes) {
  await customElements.whenDefined("ridgeline-figure");
  const figure = document.createElement("ridgeline-figure");
  for (const [name, value] of Object.entries(attributes)) {
    figure.setAttribute(name, value);
  }
  const ready = new Promise((resolve, reject) => {
    figure.addEventListener("ridgeline-ready", resolve);
    figure.addEventListener("ridgeline-failure", ({ detail }) => reject(new Error(detail.message)));
    setTimeout(() => reject(new Error(`${attributes.kind}: not drawn after 3 minutes`)), 180_000);
  });
  document.body.replaceChildren(figure);
  await ready;
  await new Promise((resolve) => setTimeout(resolve, 1500));
  return figure.toSvg();
}
