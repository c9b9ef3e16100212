import { createHash } from "node:crypto";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { type Alias, defineConfig, type Plugin } from "vite";

/**
 * Nothing may leave the origin. `blob:` serves the model's embedded atlas and thumbnails;
 * `wasm-unsafe-eval` is what compiling WebAssembly needs.
 */
const policy = (workers: string) =>
  [
    "default-src 'none'",
    "script-src 'self' 'wasm-unsafe-eval'",
    `worker-src ${workers}`,
    "style-src 'self'",
    "img-src 'self' blob: data:",
    "connect-src 'self' blob:",
    "base-uri 'none'",
    "form-action 'none'",
  ].join("; ");

/** What a student writes runs in a worker made of it: on the page of the exercises alone, which holds nobody's photographs. */
const WORKERS: Readonly<Record<string, string>> = { "/exercises.html": "'self' blob:" };

/** The policy goes into the built page only: the development server needs inline styles. */
function contentSecurityPolicy(): Plugin {
  return {
    name: "content-security-policy",
    apply: "build",
    transformIndexHtml: (_, { path }) => [
      {
        tag: "meta",
        attrs: { "http-equiv": "Content-Security-Policy", content: policy(WORKERS[path] ?? "'self'") },
        injectTo: "head-prepend",
      },
    ],
  };
}

/** What computes the orientation of photographs, the lessons and the exercises: fetched by those who need it. */
const ON_DEMAND = /\/(orientation|lessons|exercises)[^/]*$/i;

/**
 * Writes `sw.js`: everything of the site is fetched once and served from the cache afterwards, under a name that changes with
 * the content, so that a new version replaces the old one whole.
 */
function offline(): Plugin {
  let outDir = "dist";
  return {
    name: "offline",
    apply: "build",
    configResolved: (config) => {
      outDir = join(config.root, config.build.outDir);
    },
    closeBundle: () => {
      const paths = readdirSync(outDir, { recursive: true, withFileTypes: true })
        .filter((entry) => entry.isFile() && entry.name !== "sw.js")
        .map((entry) => join(entry.parentPath, entry.name))
        .sort();
      const hash = createHash("sha256");
      for (const path of paths) {
        hash.update(relative(outDir, path)).update(readFileSync(path));
      }
      const all = paths.map((path) => `./${relative(outDir, path).replaceAll("\\", "/")}`);
      const later = all.filter((path) => ON_DEMAND.test(path));
      const files = all.filter((path) => !later.includes(path));
      const template = readFileSync(new URL("offline/sw.js", import.meta.url), "utf8");
      const written = template
        .replace("__VERSION__", hash.digest("hex").slice(0, 16))
        .replace('["__FILES__"]', JSON.stringify(["./", ...files]))
        .replace('["__LATER__"]', JSON.stringify(later));
      writeFileSync(join(outDir, "sw.js"), written);
    },
  };
}

/** `npm run dev:fake`: the page without Rust, on a planted gable. Development only, never in a build. */
function fakeCore(): Alias[] {
  const fake = (name: string) => fileURLToPath(new URL(`test/fake/${name}`, import.meta.url));
  return [
    { find: "../pkg/ridgeline.js", replacement: fake("ridgeline.ts") },
    { find: "../pkg/ridgeline_bg.wasm?url", replacement: fake("wasmUrl.ts") },
  ];
}

export default defineConfig(({ command, mode }) => ({
  base: "./",
  plugins: [contentSecurityPolicy(), offline()],
  resolve: { alias: command === "serve" && mode === "fake" ? fakeCore() : [] },
  oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
  worker: { format: "es" },
  build: {
    target: "es2022",
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 900,
    rolldownOptions: { input: ["index.html", "lessons.html", "exercises.html"] },
  },
  server: { port: 5173 },
  preview: { port: 4173 },
}));
