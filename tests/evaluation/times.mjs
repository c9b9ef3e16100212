// The time of every stage in wasm, and how many windows the sweep correlates a second, on one core:
//
//   taskset -c 0 node tests/evaluation/times.mjs SCENE [--method lines|rectangles|combined|coplanar|adjacency] [--package FOLDER]
//
// Prints Markdown. The sweep's own time is what the half-planes stage takes less when nothing is high enough to be swept: finding the
// points of interest remains.

import { basename, resolve } from "node:path";
import { parseArgs } from "node:util";
import { addFiles, openSession } from "../wasm/session.mjs";

const wish = { type: "string" };
const { values, positionals } = parseArgs({ allowPositionals: true, options: { method: wish, package: wish } });
const scene = resolve(positionals[0]);
const { session } = await openSession(values.package);
const params = { method: values.method ?? "lines" };
addFiles(session, scene);
session.setParams(params);
session.inspect({});

const rows = [["load", secondsOf(() => session.load({}))]];
let sweep = null;
for (const stage of session.chosenStages()) {
    let counts = {};
    const run = () => {
        counts = session.runStage(stage, () => {}).counts;
    };
    const idle = stage === "halfplanes" ? secondsUnswept(run) : 0;
    const seconds = secondsOf(run);
    rows.push([stage, seconds]);
    if (counts.correlations) sweep = { windows: counts.correlations, seconds: seconds - idle };
}
rows.push(["export", secondsOf(() => session.exportNames().forEach((name) => session.exportFile(name)))]);

const total = rows.reduce((sum, [, seconds]) => sum + seconds, 0);
const cells = [...rows, ["total", total]].map(([name, seconds]) => `${name} ${seconds.toFixed(2)} s`);
console.log(`| ${[basename(scene), ...cells].join(" | ")} |`);
if (sweep) {
    const millions = (count) => (count / 1e6).toFixed(1);
    console.log(
        `\nSweep: ${millions(sweep.windows)} million correlations in ${sweep.seconds.toFixed(2)} s, ` +
            `${millions(sweep.windows / sweep.seconds)} million a second.`,
    );
}

function secondsUnswept(run) {
    session.setParams({ ...params, sweep: { min_height_m: 1e9 } });
    const seconds = secondsOf(run);
    session.setParams(params);
    return seconds;
}

function secondsOf(work) {
    const start = performance.now();
    work();
    return (performance.now() - start) / 1000;
}
