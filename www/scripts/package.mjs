// The npm package: compiles www/src/package, builds the element, puts the wasm core and the demo scene beside them and packs all.
// Prints the tarball's path. The core is the one in www/src/pkg (make build for the smallest).
import { execFileSync } from "node:child_process";
import { cpSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { buildElement } from "./element.mjs";

const www = join(dirname(fileURLToPath(import.meta.url)), "..");
const folder = join(www, "package");
const manifest = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
const version = /^version = "(.+)"/m.exec(readFileSync(join(www, "../Cargo.toml"), "utf8"))[1];
if (manifest.version !== version) {
  throw new Error(`package/package.json is of version ${manifest.version}, Cargo.toml of ${version}`);
}

rmSync(join(folder, "dist"), { recursive: true, force: true });
execFileSync(join(www, "node_modules/.bin/tsc"), ["-p", join(www, "tsconfig.package.json")], {
  stdio: "inherit",
});
await buildElement(join(folder, "dist/element"));
cpSync(join(www, "public/demo"), join(folder, "dist/demo"), { recursive: true });
cpSync(join(www, "src/pkg"), join(folder, "dist/pkg"), { recursive: true });
rmSync(join(folder, "dist/pkg/.gitignore"), { force: true });
// The class of the core can be disposed of: projects for older targets do not know the name.
const types = join(folder, "dist/pkg/ridgeline.d.ts");
writeFileSync(types, `/// <reference lib="esnext.disposable" />\n${readFileSync(types, "utf8")}`);
for (const licence of ["LICENSE-MIT", "LICENSE-APACHE"])
  cpSync(join(www, "..", licence), join(folder, licence));
const packed = execFileSync("npm", ["pack", "--json", "--silent"], { cwd: folder, encoding: "utf8" });
console.log(join(folder, JSON.parse(packed)[0].filename));
