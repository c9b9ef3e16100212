import { describe, expect, it } from "vitest";
import type { CallName } from "../../../src/shared/calls";
import { type Answer, answer } from "../../../src/worker/answering";
import { workerCalls } from "../../../src/worker/calls";
import { Session } from "../../fake/ridgeline";

/** A worker's answers, and the progress that it reports. */
function worker() {
  const session = new Session();
  const fractions: number[] = [];
  const own = workerCalls(session, Session.defaultParams, (_, fraction) => fractions.push(fraction));
  const call = (name: CallName, ...args: unknown[]): Promise<Answer> => answer(own, session, { name, args });
  return { call, fractions };
}

const three = ["a.jpg", "b.jpg", "c.jpg"].map((path) => ({ path, blob: new Blob(["x"]) }));

describe("the worker's calls", () => {
  it("replace the files, not add to them", async () => {
    const { call } = worker();
    await call("setFiles", three);
    await call("setFiles", three);
    const { result } = await call("inspect", {});
    expect(result).toMatchObject({ views: 3, errors: [] });
  });

  it("name a file that can no longer be read", async () => {
    const gone = {
      size: 1,
      arrayBuffer: () => Promise.reject(new Error("NotReadableError")),
    } as unknown as Blob;
    await expect(worker().call("setFiles", [{ path: "gone.jpg", blob: gone }])).rejects.toThrow(/gone\.jpg/);
  });

  it("move arrays and pictures instead of copying them", async () => {
    const { call } = worker();
    const lines = await call("lines");
    expect(lines.transfer).toEqual([(lines.result as Float64Array).buffer]);
    const warped = await call("warped", 0, true, 0);
    expect(warped.transfer).toEqual([(warped.result as { rgba: Uint8ClampedArray }).rgba.buffer]);
    expect((await call("facets")).transfer).toEqual([]);
  });

  it("report progress up to the end", async () => {
    const { call, fractions } = worker();
    await call("runStage", "segments");
    expect(fractions.at(-1)).toBe(1);
    expect(fractions).toEqual([...fractions].sort((a, b) => a - b));
  });

  it("pass a rejection on with its name, and know no other names", async () => {
    const { call } = worker();
    await expect(call("load", {})).rejects.toMatchObject({ name: "InputError" });
    await expect(call("novel" as CallName)).rejects.toThrow(/novel/);
  });
});
