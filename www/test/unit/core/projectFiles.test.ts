import { describe, expect, it } from "vitest";
import type { CoreSession } from "../../../src/worker/coreSession";
import { ProjectFiles } from "../../../src/worker/projectFiles";

/** A session that writes down which bytes it is given. */
function recorder(wanted: [number, number][], isPhotograph = true) {
  const calls: [string, string, number][] = [];
  let ranges: [number, number][] = [];
  const session = {
    clearFiles: () => calls.push(["clear", "", 0]),
    addFile: (path: string, bytes: Uint8Array) => calls.push(["file", path, bytes.length]),
    addHead: (path: string, whole: number, bytes?: Uint8Array) => {
      calls.push(["head", path, bytes?.length ?? 0]);
      ranges = bytes === undefined ? [...wanted] : ranges;
      return ranges.shift() ?? (isPhotograph && whole > 100);
    },
    fillFile: (path: string, bytes: Uint8Array) => calls.push(["fill", path, bytes.length]),
    fillRanges: (path: string, places: Float64Array, bytes: Uint8Array) =>
      calls.push(["ranges", `${path} ${places.join(" ")}`, bytes.length]),
    emptyFiles: () => calls.push(["empty", "", 0]),
  };
  return { calls, files: new ProjectFiles(session as unknown as CoreSession) };
}

const KB = 1024;

function jpeg(kilobytes: number): Blob {
  const bytes = new Uint8Array(kilobytes * KB);
  bytes.set([0xff, 0xd8, 0xff]);
  return new Blob([bytes]);
}

describe("the files of a project in the worker", () => {
  it("are read by the ranges that the core asks for", async () => {
    const { calls, files } = recorder([
      [0, 64 * KB],
      [4990 * KB, 5000 * KB],
    ]);
    await files.replace([
      { path: "large.tif", blob: jpeg(5000) },
      { path: "list.txt", blob: new Blob([new Uint8Array(50)]) },
    ]);
    expect(calls).toEqual([
      ["clear", "", 0],
      ["head", "large.tif", 0],
      ["head", "large.tif", 64 * KB],
      ["head", "large.tif", 10 * KB],
      ["head", "list.txt", 0],
      ["head", "list.txt", 50],
      ["head", "list.txt", 0],
      ["file", "list.txt", 50],
    ]);
  });

  it("are read whole where their header says too little anywhere", async () => {
    const { calls, files } = recorder([[0, 64 * KB]], false);
    await files.replace([{ path: "odd.jpg", blob: jpeg(3000) }]);
    expect(calls.at(-1)).toEqual(["file", "odd.jpg", 3000 * KB]);
  });

  it("are whole during the call that needs them, also where it fails", async () => {
    const { calls, files } = recorder([[0, 64 * KB]]);
    await files.replace([{ path: "a.jpg", blob: jpeg(100) }]);
    calls.length = 0;
    const failing = files.withFilled([() => [{ path: "a.jpg", places: null }], () => []], () => {
      calls.push(["call", "", 0]);
      throw new Error("rejected");
    });
    await expect(failing).rejects.toThrow("rejected");
    expect(calls).toEqual([
      ["fill", "a.jpg", 100 * KB],
      ["call", "", 0],
      ["empty", "", 0],
    ]);
  });

  it("are read in the ranges that are needed of them", async () => {
    const { calls, files } = recorder([[0, 64 * KB]]);
    await files.replace([{ path: "a.tif", blob: jpeg(100) }]);
    calls.length = 0;
    const places = [0, 10, 90 * KB, 100 * KB];
    await files.withFilled([() => [{ path: "a.tif", places }]], () => undefined);
    expect(calls).toEqual([
      ["ranges", `a.tif ${places.join(" ")}`, 10 + 10 * KB],
      ["empty", "", 0],
    ]);
  });
});
