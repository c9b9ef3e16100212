// Runs scenes, the first two by every method and the first one with corrections by hand, through the wasm Session in Node and through the native command line, and compares
// every file byte for byte (report.json without its part `seconds`). One scene has a point cloud (LAZ) besides. So is the orientation of drawn photographs with
// ground control points, by two orienters that divide the pairs. What model.glb is wrong in, the validator of glTF's makers says.
//
//   node tests/wasm/identical.mjs BINARY [SCENE]     by default the demo's, and the synthetic scenes of the tests, which the
//                                               example `synthetic` beside the binary writes
//
// Ends with exit code 1 and the names of the files that differ or are wrong.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { addFiles, openOrienter, openSession, root } from "./session.mjs";

const [binary, given] = process.argv.slice(2);
if (!binary) {
    console.error("usage: node tests/wasm/identical.mjs BINARY [SCENE]");
    process.exit(2);
}

const validator = createRequire(join(root, "www/package.json"))("gltf-validator");
const bad = [];
const synthetic = mkdtempSync(join(tmpdir(), "ridgeline-"));
try {
    const scenes = given ? [given] : [join(root, "www/public/demo"), ...(await writeSynthetic())];
    for (const [place, scene] of scenes.entries()) {
        // Method "combined" has the stages of the others; by themselves "coplanar" and "adjacency" do more in their own.
        const methods = place < 2 ? ["lines", "rectangles", "combined", "coplanar", "adjacency"] : ["combined"];
        for (const method of methods) {
            const { bad: wrong, native } = await compare(scene, method, []);
            bad.push(...wrong);
            if (place === 0 && method === "lines") bad.push(...(await compareCorrected(scene, native)));
        }
    }
    if (!given) bad.push(...(await compareOrientation(join(root, "www/test/fixtures/drone"))));
} finally {
    rmSync(synthetic, { recursive: true });
}
process.exit(bad.length === 0 ? 0 : 1);

// The folders of the synthetic scenes.
async function writeSynthetic() {
    await run(join(dirname(binary), "examples/synthetic"), [synthetic]);
    const scenes = readdirSync(synthetic).sort();
    if (scenes.length === 0) throw new Error("no synthetic scene was written");
    return scenes.map((name) => join(synthetic, name));
}

async function run(program, args) {
    const [status] = await once(spawn(program, args, { stdio: ["ignore", "ignore", "inherit"] }), "close");
    if (status !== 0) throw new Error(`${program} ended with exit code ${status}`);
}

// The same with corrections of what was found in the scene itself.
async function compareCorrected(scene, found) {
    const city = JSON.parse(found.get("model.city.json").toString());
    const corrections = correctionsOf(city, await sceneOf(scene));
    const { bad, report } = await compare(scene, "lines", corrections);
    const { counts } = report.stages.find(({ stage }) => stage === "corrections");
    console.log(`${basename(scene)}: ${counts.corrections} of ${corrections.length} corrections applied`);
    return counts.corrections === corrections.length ? bad : [...bad, "corrections"];
}

// The views of a scene, and its origin.
async function sceneOf(scene) {
    const { session } = await openSession();
    addFiles(session, scene);
    session.load({});
    return session.scene();
}

// The end of the ridge of two roof faces that fall in opposite directions: the longest edge that they share.
function ridgeOf(roofs) {
    const key = (p) => p.map((x) => x.toFixed(3)).join();
    const edges = roofs.flatMap((face) =>
        face.corners.map((p, i) => ({ face, ends: [p, face.corners[(i + 1) % face.corners.length]] })),
    );
    const length = ({ ends: [p, q] }) => Math.hypot(...p.map((x, i) => x - q[i]));
    const faces = (a) => edges.find((b) => key(a.ends[0]) === key(b.ends[1]) && key(a.ends[1]) === key(b.ends[0]))?.face;
    const shared = edges.map((edge) => ({ ...edge, other: faces(edge) })).filter(({ other }) => other !== undefined);
    return shared.sort((a, b) => length(b) - length(a))[0];
}

// Two facets merged and the edge between them drawn again in the first view, another slope, a moved corner, a lifted
// ground and a deleted facet, of the largest building's largest facets.
function correctionsOf({ CityObjects, transform: { scale, translate }, vertices }, { origin, views: [view] }) {
    const place = (v) => vertices[v].map((x, i) => x * scale[i] + translate[i]);
    const roofs = Object.values(CityObjects).flatMap(({ geometry = [] }) =>
        geometry.flatMap(({ boundaries: [shell = []], semantics: { values, surfaces } }) =>
            shell.flatMap((face, i) => {
                const surface = surfaces[values[0]?.[i] ?? -1];
                return surface?.type === "RoofSurface" ? [{ ...surface, corners: face[0].map(place) }] : [];
            }),
        ),
    );
    const largest = roofs.filter(({ slopeDeg }) => slopeDeg > 10).sort((a, b) => b.area - a.area);
    const facetOf = ({ corners, slopeDeg, azimuthDeg }) => {
        const [slope, azimuth] = [slopeDeg, azimuthDeg].map((degrees) => (degrees * Math.PI) / 180);
        const normal = [Math.sin(slope) * Math.sin(azimuth), Math.sin(slope) * Math.cos(azimuth), Math.cos(slope)];
        const at = [0, 1, 2].map((i) => corners.reduce((sum, p) => sum + p[i], 0) / corners.length);
        return { at, normal };
    };
    const [first, second, third] = largest;
    const { face, other, ends } = ridgeOf(largest);
    const pixels = ends.map((world) => {
        const [u, v, w] = [0, 4, 8].map((row) =>
            [...world.map((x, i) => x - origin[i]), 1].reduce((sum, x, i) => sum + view.projection[row + i] * x, 0),
        );
        return [u / w + 1, v / w - 1];
    });
    const [from] = [...second.corners].sort((a, b) => a[2] - b[2]);
    return [
        { correction: "merge", facet: facetOf(face), with: facetOf(other) },
        { correction: "add_edge", photograph: view.name, pixels, sigma_px: 3 },
        { correction: "set_slope", facet: facetOf(first), slope_deg: first.slopeDeg + 2 },
        { correction: "move_corner", from, to: from.map((x, i) => x + [0.2, 0.1, 0.05][i]) },
        { correction: "set_ground", building: facetOf(first).at, height: from[2] - 30 },
        { correction: "delete_facet", facet: facetOf(third), filled: false },
    ];
}

// The names of the files that differ or are wrong, the report, and the files of the command line.
async function compare(scene, method, corrections) {
    const [native, wasm] = await Promise.all([
        runNative(scene, method, corrections),
        runWasm(scene, method, corrections),
    ]);
    const names = [...new Set([...native.keys(), ...wasm.keys()])].sort();
    if (!names.includes("model.glb")) throw new Error("no model was written");
    const differing = names.filter((name) => !same(name, native.get(name), wasm.get(name)));
    for (const name of names) {
        const verdict = differing.includes(name) ? "DIFFERS" : "identical";
        console.log(`${basename(scene)}, ${method}: ${verdict.padEnd(10)} ${name} (${native.get(name)?.length ?? "missing"} bytes)`);
    }
    const bad = [...differing, ...(await wrongIn(native.get("model.glb")))];
    const report = JSON.parse(native.get("report.json").toString());
    if (cloudOf(scene) !== undefined && ["lines", "combined"].includes(method)) {
        // Otherwise nothing of it would have been compared.
        const { compared, planes } = report.known?.point_cloud ?? {};
        console.log(`${basename(scene)}: the point cloud is ${compared?.verdict}, with ${planes?.length ?? 0} planes`);
        if (!(planes?.length > 0)) bad.push("point cloud");
    }
    return { bad, report, native };
}

// The same for photographs alone.
async function compareOrientation(photographs) {
    const out = mkdtempSync(join(tmpdir(), "ridgeline-"));
    try {
        const [, wasm] = await Promise.all([
            run(binary, ["orient", photographs, "--out", out]),
            orientInWasm(photographs),
        ]);
        const native = new Map(readdirSync(out).map((name) => [name, readFileSync(join(out, name))]));
        const names = [...new Set([...native.keys(), ...wasm.keys()])].sort();
        if (!names.includes("images.txt")) throw new Error("no orientation was written");
        const differing = names.filter((name) => !same(name, native.get(name), wasm.get(name)));
        for (const name of names) {
            const verdict = differing.includes(name) ? "DIFFERS" : "identical";
            console.log(`${basename(photographs)}, orient: ${verdict.padEnd(10)} ${name} (${native.get(name)?.length ?? "missing"} bytes)`);
        }
        return differing;
    } finally {
        rmSync(out, { recursive: true });
    }
}

// As the page does it with two workers.
async function orientInWasm(photographs) {
    const start = performance.now();
    const orienters = [];
    for (let i = 0; i < 2; i += 1) orienters.push((await openOrienter({})).orienter);
    const [first] = orienters;
    const names = readdirSync(photographs).sort();
    for (const list of names.filter((name) => name === "gcp_list.txt")) {
        first.setControl(list, readFileSync(join(photographs, list)));
    }
    for (const [i, name] of names.filter((name) => name !== "gcp_list.txt").reverse().entries()) {
        const read = orienters[i % 2].readPhoto(name, readFileSync(join(photographs, name)));
        for (const orienter of orienters) orienter.takePhoto(read);
    }
    for (const map of first.shardMaps()) {
        const shards = orienters.map((orienter, i) => orienter.runShard(map, i, orienters.length, () => {}));
        for (const orienter of orienters) orienter.mergeShards(map, shards);
    }
    first.connect(() => {});
    let cameras = 0;
    first.orient(() => {}, (views) => { cameras = Math.max(cameras, views.length); });
    console.log(`wasm orient ${((performance.now() - start) / 1000).toFixed(2).padStart(11)} s  ${cameras} cameras`);
    return new Map(first.exportNames().map((name) => [name, Buffer.from(first.exportFile(name))]));
}

// Errors and warnings of the validator, one line each.
async function wrongIn(glb) {
    const { issues } = await validator.validateBytes(new Uint8Array(glb));
    const worst = issues.messages.filter(({ severity }) => severity <= 1);
    for (const { code, message, pointer } of worst) console.log(`model.glb: ${code} ${message} ${pointer ?? ""}`);
    console.log(`model.glb: ${issues.numErrors} errors, ${issues.numWarnings} warnings of the glTF validator`);
    return worst.map(({ code }) => code);
}

// The name of the point cloud in a scene's folder.
function cloudOf(scene) {
    return readdirSync(scene).find((name) => /\.la[sz]$/i.test(name));
}

// As a process of its own, while wasm computes.
async function runNative(scene, method, corrections = []) {
    const [out, beside] = [0, 1].map(() => mkdtempSync(join(tmpdir(), "ridgeline-")));
    try {
        const list = join(beside, "corrections.json");
        writeFileSync(list, JSON.stringify(corrections));
        const cloud = cloudOf(scene);
        const known = cloud === undefined ? [] : ["--point-cloud", join(scene, cloud)];
        await run(binary, ["reconstruct", scene, "--out", out, "--method", method, "--corrections", list, ...known]);
        return new Map(readdirSync(out).map((name) => [name, readFileSync(join(out, name))]));
    } finally {
        for (const folder of [out, beside]) rmSync(folder, { recursive: true });
    }
}

async function runWasm(scene, method, corrections = []) {
    const { session } = await openSession();
    addFiles(session, scene);
    session.setParams({ method, corrections });
    // Where the command line puts it.
    const cloud = cloudOf(scene);
    const known = cloud === undefined ? {} : { pointCloud: `known/${cloud}` };
    if (cloud !== undefined) session.addFile(known.pointCloud, readFileSync(join(scene, cloud)));
    session.load(known);
    for (const stage of session.chosenStages()) {
        const start = performance.now();
        const { counts } = session.runStage(stage, () => {});
        const seconds = ((performance.now() - start) / 1000).toFixed(2);
        console.log(`wasm ${stage.padEnd(10)} ${seconds.padStart(7)} s  ${JSON.stringify(counts)}`);
    }
    return new Map(session.exportNames().map((name) => [name, Buffer.from(session.exportFile(name))]));
}

function same(name, a, b) {
    if (a === undefined || b === undefined) return false;
    if (name !== "report.json") return a.equals(b);
    const content = (bytes) => ({ ...JSON.parse(bytes.toString()), seconds: undefined });
    return JSON.stringify(content(a)) === JSON.stringify(content(b));
}
