// The memory that the page's core takes for a scene, beside what it states before it starts: the wasm memory of the worker that
// runs the stages, and of each that helps it (wasm memory never shrinks: what it has at the end is its peak).
//
//   node tests/evaluation/memory.mjs SCENE [--roi x0,y0,x1,y1] [--ground-z Z] [--method lines|rectangles] [--workers N] [--tile M]
//                         [--package FOLDER]
//
// Prints a row of the table in docs/results/page.md; exit code 1 where more was taken than stated.

import { basename, resolve } from "node:path";
import { parseArgs } from "node:util";
import { addFiles, openSession } from "../wasm/session.mjs";

const wish = { type: "string" };
const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: { roi: wish, "ground-z": wish, method: wish, workers: wish, tile: wish, package: wish },
});
const scene = resolve(positionals[0]);
const method = values.method ?? "lines";
const options = {
    ...(values.roi && { roi: values.roi.split(",").map(Number) }),
    ...(values["ground-z"] && { groundZ: Number(values["ground-z"]) }),
};

const workers = [];
// What the helpers hold of the run.
const given = { colours: null, stages: new Set() };
while (workers.length < Number(values.workers ?? 1)) workers.push(await openSession(values.package));
const [engine, ...helpers] = workers;
addFiles(engine.session, scene);
for (const { session } of workers) session.setParams({ method });
const stated = engine.session.inspect(options).peak_mb;
if (values.tile) runTiles(engine.session, Number(values.tile));
else runStages();

const [most, ...others] = workers.map(({ memory }) => memory.buffer.byteLength / 2 ** 20);
const helping = others.length > 0 ? `${Math.ceil(Math.max(...others))} MB` : "-";
console.log(`| ${basename(scene)} | ${method} | ${stated} MB | ${Math.ceil(most)} MB | ${helping} |`);
process.exit(most <= stated ? 0 : 1);

// As the page does it (www/src/core/workerPool.ts).
function runStages() {
    const { session } = engine;
    const { views } = session.load(options);
    const stages = session.chosenStages();
    for (const [done, stage] of stages.entries()) {
        const maps = helpers.length > 0 ? session.shardMaps(stage) : [];
        if (maps.length > 0) prepareHelpers(stage, views.length, stages.slice(0, done));
        for (const [step, map] of maps.entries()) {
            const shards = workers.map(({ session }, index) =>
                session.runShard(stage, map, index, workers.length, () => {}),
            );
            const merging = step + 1 < maps.length ? workers : [engine];
            for (const { session } of merging) session.mergeShards(map, shards);
        }
        session.runStage(stage, () => {});
    }
    for (const name of session.exportNames()) session.exportFile(name);
}

function prepareHelpers(stage, views, earlier) {
    const colours = engine.session.shardsReadColours(stage);
    if (given.colours === null || (colours && !given.colours)) {
        for (let view = 0; view < views; view += 1) {
            for (const { session } of helpers) session.takeView(view, views, engine.session.packView(view, colours));
        }
        Object.assign(given, { colours, stages: new Set() });
    }
    // The adjustment may have moved views.
    for (const { session } of helpers) session.takeCameras(engine.session.packCameras());
    for (const before of earlier.filter((name) => !given.stages.has(name))) {
        const found = engine.session.handOver(before);
        for (const { session } of found.length > 0 ? helpers : []) session.takeOver(before, found);
        given.stages.add(before);
    }
}

function runTiles(session, tileM) {
    session.planTiles(options, tileM, null);
    for (let square = 0; square < session.squaresToLookAt(); square += 1) {
        session.takeLook(session.lookAt(square, () => {}));
    }
    for (const [index, { cells }] of session.workPlan().tiles.entries()) {
        for (const cell of cells.keys()) {
            session.loadCell(index, cell);
            session.runCell(index, cell, () => {});
        }
        session.takeTile(session.tileOutcome(index));
    }
    session.joinTiles();
    for (const name of session.exportNames()) session.exportFile(name);
}
