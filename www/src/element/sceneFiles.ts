/** The files of a scene, by its address: the demo scene, a manifest, or an archive as the page saves projects. */
import type { InputFile } from "../shared/calls";

/** Paths of a scene's files, from where the manifest itself is. */
interface Manifest {
  files: string[];
}

/**
 * The address of a scene as an author writes it: "demo", or relative to the page.
 * @param demo folder of the demo scene
 */
export function sceneUrl(scene: string, demo: string, page: string): string {
  return scene === "demo" ? new URL("manifest.json", folderOf(demo, page)).href : new URL(scene, page).href;
}

/** Fetches a scene. */
export async function fetchScene(url: string): Promise<InputFile[]> {
  const blob = await (await fetchOk(url)).blob();
  const manifest = await manifestOf(blob, url);
  if (manifest === null) {
    const path = decodeURIComponent(new URL(url).pathname.split("/").at(-1) ?? "") || "scene";
    return [{ path, blob }];
  }
  return Promise.all(
    manifest.files.map(async (path) => ({
      path,
      blob: await (await fetchOk(new URL(path, url).href)).blob(),
    })),
  );
}

/** The manifest that some bytes are; null where they are something else. */
async function manifestOf(blob: Blob, url: string): Promise<Manifest | null> {
  if ((await blob.slice(0, 1).text()) !== "{" || !new URL(url).pathname.endsWith(".json")) {
    return null;
  }
  const found = JSON.parse(await blob.text()) as Partial<Manifest>;
  const { files } = found;
  if (!Array.isArray(files) || files.some((path) => typeof path !== "string")) {
    throw new Error(`${url}: a manifest names the files of the scene: { "files": ["images/1.jpg", ...] }.`);
  }
  return { files };
}

async function fetchOk(url: string): Promise<Response> {
  const response = await fetch(url).catch(() => null);
  if (response === null) {
    throw new Error(`${url} cannot be reached. Does its server allow other pages to read it (CORS)?`);
  }
  if (!response.ok) {
    throw new Error(`${url}: the server answered ${response.status}. Is the address right?`);
  }
  return response;
}

function folderOf(address: string, page: string): URL {
  return new URL(address.endsWith("/") ? address : `${address}/`, page);
}
