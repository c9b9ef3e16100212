// node node_modules/ridgeline/examples/node.mjs SCENE OUT
import { mkdir, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { createWorker, readScene } from "ridgeline";

const [scene, out] = process.argv.slice(2);
const { facets, files, stages } = await createWorker().reconstruct(await readScene(scene), {
  onProgress: ({ stage, fraction }) => fraction === 1 && console.log(`${stage} done`),
});
await mkdir(out, { recursive: true });
for (const [name, bytes] of files) await writeFile(join(out, name), bytes);
console.log(`${stages.length} stages, ${facets.length} facets, ${files.size} files in ${out}`);
