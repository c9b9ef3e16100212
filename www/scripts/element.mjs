// Builds the elements of the npm package: figure.js with its worker beside it, anywidget.js, one module that holds its worker, and
// exercise.js. The core is not bundled: it stays beside them, in dist/pkg. Fails where the element is larger than it may be.
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "vite";

const www = join(dirname(fileURLToPath(import.meta.url)), "..");
const MOST_GZIP = 150_000;

/** What a page loads beside its modules, a shadow tree takes in as text: `styles.ts` asks for it by "?inline". */
const withoutSheets = {
  name: "without-sheets",
  enforce: "pre",
  resolveId: (source) => (source.endsWith(".css") ? "\0no-sheet" : null),
  load: (id) => (id === "\0no-sheet" ? "" : null),
};

/** The page says where the core is; otherwise the build would take in a second one. */
const withoutCore = {
  name: "without-core",
  enforce: "pre",
  transform: (code, id) =>
    id.endsWith("/pkg/ridgeline.js")
      ? code.replace(/new URL\(['"]ridgeline_bg\.wasm['"], import\.meta\.url\)/, "undefined")
      : null,
};

async function bundle(entry, file, outDir, define = {}) {
  await build({
    root: www,
    configFile: false,
    logLevel: "warn",
    publicDir: false,
    define,
    plugins: [withoutSheets, withoutCore],
    oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
    build: {
      target: "es2022",
      outDir,
      emptyOutDir: false,
      lib: { entry: join(www, entry), formats: ["es"], fileName: () => file },
      minify: true,
    },
  });
  return readFileSync(join(outDir, file), "utf8");
}

export async function buildElement(outDir) {
  const worker = await bundle("src/worker/main.ts", "worker.js", outDir);
  const figure = await bundle("src/element/figure.ts", "figure.js", outDir);
  await bundle("src/element/anywidget.ts", "anywidget.js", outDir, { __WORKER__: JSON.stringify(worker) });
  await bundle("src/exercise/exercise.ts", "exercise.js", outDir);
  const size = gzipSync(figure, { level: 9 }).length;
  console.log(`figure.js: ${(size / 1000).toFixed(1)} kB (gzip)`);
  if (size > MOST_GZIP) {
    throw new Error(`The element is larger than ${MOST_GZIP / 1000} kB (gzip).`);
  }
}
