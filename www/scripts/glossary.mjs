// docs/glossary.md, from the one file of terms. `npm run glossary`
import { writeFileSync } from "node:fs";
import { createServer } from "vite";

const server = await createServer({ configFile: false, logLevel: "error", server: { middlewareMode: true } });
const { glossaryPage } = await server.ssrLoadModule("/scripts/glossaryPage.ts");
writeFileSync(new URL("../../docs/glossary.md", import.meta.url), glossaryPage());
await server.close();
