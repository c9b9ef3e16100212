// What is true of the demo scene, for the exercises in its figures: roof faces and edges, as its renderer wrote them.
//
//   node scripts/demoTruth.mjs SCENE      SCENE/truth has roofs.json and edges.json
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const [scene] = process.argv.slice(2);
if (scene === undefined) {
  console.error("usage: node scripts/demoTruth.mjs SCENE");
  process.exit(2);
}
const read = (name) => JSON.parse(readFileSync(join(scene, "truth", name), "utf8"));
const roofs = read("roofs.json");
const faces = roofs.buildings.flatMap(({ id: building, faces }) =>
  faces.map(({ id, plane, polygon, slope_deg }) => ({ id, building, plane, polygon, slope_deg })),
);
const edges = read("edges.json").edges.map(({ kind, p0, p1, faces }) => ({ kind, p0, p1, faces }));
const rounded = (_, value) => (typeof value === "number" ? Number(value.toFixed(6)) : value);
const lines = (all) => all.map((one) => `    ${JSON.stringify(one, rounded)}`).join(",\n");
const text = `{
  "licence": "CC0 1.0",
  "origin": ${JSON.stringify(roofs.origin)},
  "faces": [\n${lines(faces)}\n  ],
  "edges": [\n${lines(edges)}\n  ]
}
`;
writeFileSync(new URL("../src/exercise/figures/demoTruth.json", import.meta.url), text);
