/** Files in one archive. */
import { zipSync } from "fflate";
import type { InputFile } from "../../shared/calls";

/** Where the format's time begins, so that the same files give the same bytes. */
const NO_TIME = new Date(1980, 0, 1);

export async function zipped(files: readonly InputFile[]): Promise<Blob> {
  const read = async ({ path, blob }: InputFile) => [path, new Uint8Array(await blob.arrayBuffer())] as const;
  const entries = Object.fromEntries(await Promise.all(files.map(read)));
  return new Blob([zipSync(entries, { mtime: NO_TIME })], { type: "application/zip" });
}
