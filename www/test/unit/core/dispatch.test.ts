import { describe, expect, it } from "vitest";
import type { Request } from "../../../src/shared/messages";
import { type Core, dispatch } from "../../../src/worker/dispatch";
import { Session } from "../../fake/ridgeline";

type Answerable = Exclude<Request, { type: "open" }>;

function core(): Core {
  return { session: new Session(), stages: Session.stages(), defaults: Session.defaultParams() };
}

const three = ["a.jpg", "b.jpg", "c.jpg"].map((path) => ({ path, blob: new Blob(["x"]) }));
const ask = (request: object) => ({ id: 1, args: {}, ...request }) as Answerable;
const silent = () => undefined;

describe("dispatch", () => {
  it("replaces the files, not adds to them", async () => {
    const one = core();
    await dispatch(one, ask({ type: "setFiles", args: { files: three } }), silent);
    await dispatch(one, ask({ type: "setFiles", args: { files: three } }), silent);
    const { result } = await dispatch(one, ask({ type: "inspect", args: { options: {} } }), silent);
    expect(result).toMatchObject({ views: 3, errors: [] });
  });

  it("names a file that can no longer be read", async () => {
    const gone = { arrayBuffer: () => Promise.reject(new Error("NotReadableError")) } as unknown as Blob;
    const request = ask({ type: "setFiles", args: { files: [{ path: "gone.jpg", blob: gone }] } });
    await expect(dispatch(core(), request, silent)).rejects.toThrow(/gone\.jpg/);
  });

  it("moves arrays instead of copying them", async () => {
    const { result, transfer } = await dispatch(core(), ask({ type: "lines" }), silent);
    expect(transfer).toEqual([(result as Float64Array).buffer]);
  });

  it("reports progress up to the end", async () => {
    const fractions: number[] = [];
    await dispatch(core(), ask({ type: "run", args: { stage: "segments" } }), (_, fraction) =>
      fractions.push(fraction),
    );
    expect(fractions.at(-1)).toBe(1);
    expect(fractions).toEqual([...fractions].sort((a, b) => a - b));
  });

  it("passes a rejection on with its name", async () => {
    const rejected = dispatch(core(), ask({ type: "load", args: { options: {} } }), silent);
    await expect(rejected).rejects.toMatchObject({ name: "InputError" });
  });
});
