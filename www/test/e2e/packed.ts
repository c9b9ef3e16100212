/** The npm package, installed from its tarball into an empty project that a server of its own shows. */
import { execFileSync } from "node:child_process";
import {
  copyFileSync,
  mkdtempSync,
  readFileSync,
  rmSync,
  statSync,
  symlinkSync,
  writeFileSync,
} from "node:fs";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

export const WWW = fileURLToPath(new URL("../..", import.meta.url));

const TYPES: Readonly<Record<string, string>> = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".mjs": "text/javascript",
  ".css": "text/css",
  ".json": "application/json",
  ".wasm": "application/wasm",
};

export interface PackedProject {
  folder: string;
  /** Ends with a slash. */
  address: string;
  /** Paths that were asked for, in order. */
  asked: string[];
  close(): void;
}

/** With the package's examples of these names at its root; `beside` are packages of this project that they use. */
export async function packedProject(
  examples: readonly string[],
  beside: readonly string[] = [],
): Promise<PackedProject> {
  const printed = execFileSync("node", ["scripts/package.mjs"], { cwd: WWW, encoding: "utf8" });
  const tarball = printed.trim().split("\n").at(-1) as string;
  const folder = mkdtempSync(join(tmpdir(), "ridgeline-package-"));
  writeFileSync(join(folder, "package.json"), JSON.stringify({ type: "module", private: true }));
  execFileSync("npm", ["install", "--offline", "--no-audit", "--no-fund", tarball], { cwd: folder });
  for (const name of examples) {
    copyFileSync(join(folder, "node_modules/ridgeline/examples", name), join(folder, name));
  }
  for (const name of beside) {
    symlinkSync(join(WWW, "node_modules", name), join(folder, "node_modules", name));
  }
  const asked: string[] = [];
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url ?? "/", "http://localhost").pathname);
    asked.push(path);
    try {
      const file = join(folder, path);
      if (!statSync(file).isFile()) {
        throw new Error("no file");
      }
      const headers = {
        "content-type": TYPES[extname(path)] ?? "application/octet-stream",
        "access-control-allow-origin": "*",
      };
      response.writeHead(200, headers).end(readFileSync(file));
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise<void>((resolve) => {
    server.listen(0, "127.0.0.1", resolve);
  });
  const { port } = server.address() as AddressInfo;
  return {
    folder,
    address: `http://127.0.0.1:${port}/`,
    asked,
    close: () => {
      server.close();
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
