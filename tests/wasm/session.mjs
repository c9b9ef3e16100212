// What the scripts share that run the page's core in Node: a session of its own wasm instance, and a scene's files.

import { readdirSync, readFileSync } from "node:fs";
import { dirname, join, relative, sep } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

export const root = join(dirname(fileURLToPath(import.meta.url)), "../..");

let instances = 0;

// A session and the memory of its instance; each call makes another instance, as each worker of the page has one.
export async function openSession(folder = join(root, "www/src/pkg")) {
    instances += 1;
    const glue = `${pathToFileURL(join(folder, "ridgeline.js")).href}?${instances}`;
    const { initSync, Session } = await import(glue);
    const { memory } = initSync({ module: readFileSync(join(folder, "ridgeline_bg.wasm")) });
    return { session: new Session(), memory };
}

// An orienter of the page's second module, by its options.
export async function openOrienter(options, folder = join(root, "www/src/pkg-orient")) {
    instances += 1;
    const glue = `${pathToFileURL(join(folder, "orientation.js")).href}?${instances}`;
    const { initSync, Orienter } = await import(glue);
    const { memory } = initSync({ module: readFileSync(join(folder, "orientation_bg.wasm")) });
    return { orienter: new Orienter(options), memory };
}

// Adds the files that the command line would read: it leaves out other kinds (src/cli/walk.rs).
export function addFiles(session, scene) {
    const wanted = /\.(jpe?g|png|tiff?|txt|p|json|xml|out|nvm|csv|ori|prj|geojson|camera|bin|xyz|zip)$/i;
    for (const entry of readdirSync(scene, { recursive: true, withFileTypes: true })) {
        const path = join(entry.parentPath ?? entry.path, entry.name);
        if (wanted.test(entry.name) && !entry.isDirectory()) {
            session.addFile(relative(scene, path).split(sep).join("/"), readFileSync(path));
        }
    }
}
