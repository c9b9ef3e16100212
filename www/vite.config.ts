import { fileURLToPath } from "node:url";
import { type Alias, defineConfig, type Plugin } from "vite";

/**
 * Nothing may leave the origin. `blob:` serves the model's embedded atlas and thumbnails;
 * `wasm-unsafe-eval` is what compiling WebAssembly needs.
 */
const POLICY = [
  "default-src 'none'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "worker-src 'self'",
  "style-src 'self'",
  "img-src 'self' blob: data:",
  "connect-src 'self' blob:",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");

/** The policy goes into the built page only: the development server needs inline styles. */
function contentSecurityPolicy(): Plugin {
  return {
    name: "content-security-policy",
    apply: "build",
    transformIndexHtml: () => [
      {
        tag: "meta",
        attrs: { "http-equiv": "Content-Security-Policy", content: POLICY },
        injectTo: "head-prepend",
      },
    ],
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
  plugins: [contentSecurityPolicy()],
  resolve: { alias: command === "serve" && mode === "fake" ? fakeCore() : [] },
  oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
  worker: { format: "es" },
  build: { target: "es2022", assetsInlineLimit: 0, chunkSizeWarningLimit: 900 },
  server: { port: 5173 },
  preview: { port: 4173 },
}));
