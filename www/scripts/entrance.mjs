// What the entrance shows before anything is computed in the browser: the demo scene's model, and the ground below it as
// one of its photographs shows it. Run with the build, by the same core that the page runs.
//
//   node www/scripts/entrance.mjs        needs www/src/pkg; writes www/public/entrance/

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { addFiles, openSession, root } from "../../tests/wasm/session.mjs";

const OUT = new URL("../public/entrance/", import.meta.url);
const DEMO = `${root}/www/public/demo`;
/** A photograph on level ground is a homography: so many cells a side hide that triangles are drawn affinely. */
const CELLS = 6;

const { session } = await openSession();
addFiles(session, DEMO);
session.setParams({});
const { views } = session.load({});
for (const stage of session.chosenStages()) {
  session.runStage(stage, () => {});
}
const glb = session.exportFile("model.glb");
const groundZ = lowest(glb);
const view = views.reduce((best, one) => (obliqueness(one) < obliqueness(best) ? one : best));
const file = (name) =>
  JSON.parse(readFileSync(`${DEMO}/manifest.json`, "utf8")).files.find((path) => path.includes(name));

mkdirSync(OUT, { recursive: true });
writeFileSync(new URL("model.glb", OUT), glb);
const scene = {
  photographs: views.map(({ name }) => file(name)),
  ground: { photograph: file(view.name), cells: CELLS, corners: groundGrid(view, groundZ) },
};
writeFileSync(new URL("scene.json", OUT), JSON.stringify(scene));
console.log(`entrance: model of ${glb.length} bytes on ${view.name}`);

/** The lowest height of the model: glTF states the least and largest coordinates, Y up. */
function lowest(bytes) {
  const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(12, true);
  const { accessors } = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
  return Math.min(...accessors.filter(({ type, min }) => type === "VEC3" && min).map(({ min }) => min[1]));
}

/** Distance in plan from below the camera to the middle of its image on the ground, over its height. */
function obliqueness(one) {
  const [x, y] = onGround(one, one.width / 2, one.height / 2, 0);
  return Math.hypot(x - one.center[0], y - one.center[1]) / one.center[2];
}

/** Points of the ground, row by row of the photograph from its top left, in the viewer's frame (Y up), metres. */
function groundGrid(one, z) {
  const steps = Array.from({ length: CELLS + 1 }, (_, i) => i / CELLS);
  return steps.flatMap((v) =>
    steps.flatMap((u) => {
      const [x, y] = onGround(one, u * one.width, v * one.height, z);
      return [x, z, -y].map((m) => Number(m.toFixed(3)));
    }),
  );
}

/** Where the ray of an image point meets a height. */
function onGround({ projection: p }, u, v, z) {
  const row = (i) => [p[i], p[i + 1], p[i + 2] * z + p[i + 3]];
  const [a, b, c] = [row(0), row(4), row(8)];
  const first = a.map((value, i) => value - u * c[i]);
  const second = b.map((value, i) => value - v * c[i]);
  const det = first[0] * second[1] - first[1] * second[0];
  return [
    (first[1] * second[2] - first[2] * second[1]) / det,
    (first[2] * second[0] - first[0] * second[2]) / det,
  ];
}
