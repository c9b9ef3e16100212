/** Files that come while a project is open. */
import { beforeEach, describe, expect, it, vi } from "vitest";
import type { InputFile } from "../../../src/shared/calls";
import type { Inspection } from "../../../src/shared/records";

const taken: [string, string[]][] = [];
const note = (what: string) => async (added: InputFile[]) => {
  taken.push([what, added.map(({ path }) => path)]);
};
vi.mock("../../../src/app/project/projectActions", () => ({
  addFiles: note("add"),
  openFiles: note("open"),
}));

const { answerArrival, arrived, askAgain, takeFiles } = await import("../../../src/app/project/arrivals");
const { replaceFiles, setInspection } = await import("../../../src/app/state/project");

const named = (...paths: string[]) => paths.map((path) => ({ path, blob: new Blob() }));
const PHOTOGRAPHS = named("a.JPG", "b.tif", "c.png");

function open(errors: string[] = []): void {
  replaceFiles(named("1.jpg", "2.jpg", "3.jpg"));
  setInspection({ errors } as unknown as Inspection);
}

describe("files that come", () => {
  beforeEach(() => {
    taken.length = 0;
    askAgain();
    open();
  });

  it("ask whether they are a new project", async () => {
    await takeFiles(PHOTOGRAPHS);
    expect(arrived.value).toHaveLength(3);
    expect(taken).toEqual([]);
    await answerArrival("open", false);
    expect(arrived.value).toBeNull();
    expect(taken).toEqual([["open", ["a.JPG", "b.tif", "c.png"]]]);
    await takeFiles(named("project.zip"));
    expect(arrived.value).toHaveLength(1);
    await answerArrival(null, true);
    expect(taken).toHaveLength(1);
  });

  it("do not ask again in the same visit, unless that is wished", async () => {
    await takeFiles(PHOTOGRAPHS);
    await answerArrival("add", true);
    await takeFiles(PHOTOGRAPHS);
    expect(arrived.value).toBeNull();
    expect(taken.map(([what]) => what)).toEqual(["add", "add"]);
    askAgain();
    await takeFiles(PHOTOGRAPHS);
    expect(arrived.value).toHaveLength(3);
    await answerArrival(null, false);
  });

  it("do not ask where they can only be a part, or the project lacks something", async () => {
    await takeFiles(named("orientation.txt"));
    await takeFiles(named("4.jpg", "5.jpg"));
    open(["1.jpg: no orientation; add one"]);
    await takeFiles(PHOTOGRAPHS);
    replaceFiles([]);
    await takeFiles(PHOTOGRAPHS);
    expect(arrived.value).toBeNull();
    expect(taken.map(([what]) => what)).toEqual(["add", "add", "add", "add"]);
  });
});
