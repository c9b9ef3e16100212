// Sizes of what a first visit fetches, compressed as static hosts serve it; fails where there is too much of it. What computes
// the orientation of photographs, the lessons and the exercises are fetched on demand, with limits of their own.
//
//   npm run size        after `npm run build`
//
// Counted is everything of the site but the demo scene, which is fetched on request.

import { readdirSync, readFileSync } from "node:fs";
import { join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";

const MOST_WASM = 1_860_000;
const MOST_IN_ALL = 2_190_000;
// Of the lessons, as static hosts serve them.
const MOST_LESSONS = 80_000;
// Of the second module alone, as the larger of two compressions.
const MOST_SECOND_WASM = 640_000;
const ON_DEMAND = /(^|\/)(orientation|lessons|exercises)[^/]*$/i;

const dist = fileURLToPath(new URL("../dist/", import.meta.url));
const files = readdirSync(dist, { recursive: true, withFileTypes: true })
  .filter((entry) => entry.isFile())
  .map((entry) => relative(dist, join(entry.parentPath, entry.name)).replaceAll("\\", "/"))
  .filter((path) => !path.startsWith("demo/"))
  .sort();

const brotli = (bytes) =>
  brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_LGWIN]: 22 } }).length;
const rows = files.map((path) => {
  const bytes = readFileSync(join(dist, path));
  return { path, raw: bytes.length, gzip: gzipSync(bytes, { level: 9 }).length, brotli: brotli(bytes) };
});
const sumOf = (path, some) => {
  const sum = (kind) => some.reduce((total, row) => total + row[kind], 0);
  return { path, raw: sum("raw"), gzip: sum("gzip"), brotli: sum("brotli") };
};
const isLater = ({ path }) => ON_DEMAND.test(path);
const first = rows.filter((row) => !isLater(row));
const total = sumOf("in all", first);
const later = sumOf("on demand", rows.filter(isLater));
const lessons = sumOf(
  "lessons",
  rows.filter(({ path }) => /(^|\/)lessons/.test(path)),
);
const wasm = first.find(({ path }) => path.endsWith(".wasm"));
const second = rows.find((row) => isLater(row) && row.path.endsWith(".wasm"));

const kB = (bytes) => `${(bytes / 1000).toFixed(1)} kB`.padStart(12);
console.log(`${"".padEnd(40)}${"raw".padStart(12)}${"gzip".padStart(12)}${"brotli".padStart(12)}`);
for (const { path, raw, gzip, brotli: br } of [...first, total, ...rows.filter(isLater), later]) {
  console.log(`${path.padEnd(40)}${kB(raw)}${kB(gzip)}${kB(br)}`);
}

const problems = [
  wasm === undefined && "there is no wasm: run `npm run build` first",
  wasm && wasm.brotli > MOST_WASM && `the wasm is larger than ${MOST_WASM / 1000} kB (brotli)`,
  second === undefined && "nothing computes orientations",
  second &&
    second.gzip > MOST_SECOND_WASM &&
    `the second wasm is larger than ${MOST_SECOND_WASM / 1000} kB (gzip)`,
  lessons.brotli > MOST_LESSONS && `the lessons are larger than ${MOST_LESSONS / 1000} kB (brotli)`,
  total.brotli > MOST_IN_ALL && `the first load is larger than ${MOST_IN_ALL / 1000} kB (brotli)`,
].filter(Boolean);
for (const problem of problems) {
  console.error(problem);
}
process.exit(problems.length === 0 ? 0 : 1);
