// Takes the custom sections that say nothing to a browser (names of functions, producers) out of a wasm file.
//
//   node scripts/strip.mjs FILE

import { readFileSync, writeFileSync } from "node:fs";

const NEEDLESS = ["name", "producers"];
const HEADER_BYTES = 8;
const CUSTOM = 0;

const [file] = process.argv.slice(2);
const bytes = readFileSync(file);
const kept = [bytes.subarray(0, HEADER_BYTES)];
for (let at = HEADER_BYTES; at < bytes.length; ) {
  const [size, content] = unsigned(at + 1);
  const end = content + size;
  if (bytes[at] !== CUSTOM || !NEEDLESS.includes(nameAt(content))) {
    kept.push(bytes.subarray(at, end));
  }
  at = end;
}
writeFileSync(file, Buffer.concat(kept));

function nameAt(at) {
  const [length, start] = unsigned(at);
  return bytes.toString("utf8", start, start + length);
}

/** An unsigned LEB128 number, and where it ends. */
function unsigned(at) {
  let value = 0;
  for (let shift = 0; ; shift += 7) {
    const byte = bytes[at];
    at += 1;
    value += (byte & 127) * 2 ** shift;
    if (byte < 128) {
      return [value, at];
    }
  }
}
