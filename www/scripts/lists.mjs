// docs/glossary.md and docs/exercises.md, from the terms and the exercises themselves. `npm run lists`
import { writeFileSync } from "node:fs";
import { createServer } from "vite";

const server = await createServer({ configFile: false, logLevel: "error", server: { middlewareMode: true } });
const write = (name, text) => writeFileSync(new URL(`../../docs/${name}`, import.meta.url), text);
const { glossaryPage } = await server.ssrLoadModule("/scripts/glossaryPage.ts");
write("glossary.md", glossaryPage());
const { exercisesPage } = await server.ssrLoadModule("/scripts/exercisesPage.ts");
write("exercises.md", exercisesPage());
await server.close();
