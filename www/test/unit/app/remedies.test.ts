/** What the core's messages ask for on the command line, the page offers as buttons. */
import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, it, vi } from "vitest";
import { REMEDIES } from "../../../src/app/project/Remedies";
import { askedBy, onPage, refusalNotices } from "../../../src/app/session/failureNotice";

vi.mock("../../../src/pkg/ridgeline_bg.wasm?url", () => ({ default: "none" }));

const CORE = new URL("../../../../src/", import.meta.url);

/** The texts of the core that name an option, but for those of the command line itself and of tests. */
function messagesWithOptions(): string[] {
  const files = readdirSync(CORE, { recursive: true, encoding: "utf8" });
  const shown = files.filter((file) => /\.rs$/.test(file) && !/^(?:cli|main)|tests?(?:\.rs|\/)/.test(file));
  return shown.flatMap((file) => {
    const source = readFileSync(new URL(file, CORE), "utf8").replaceAll(/^\s*\/\/.*$/gm, "");
    return [...source.matchAll(/--[a-z]/g)].map(({ index }) => {
      const text = source.slice(source.lastIndexOf('"', index) + 1, source.indexOf('"', index));
      return text.replaceAll(/\\\n\s*/g, "");
    });
  });
}

describe("remedies", () => {
  it("leave no option of the command line in what the page shows, and a button for each", () => {
    const messages = messagesWithOptions();
    expect(messages.length).toBeGreaterThan(8);
    for (const message of messages) {
      expect(onPage(message)).not.toMatch(/--[a-z]/);
      for (const option of askedBy(message).options) {
        expect(Object.keys(REMEDIES), message).toContain(option);
      }
    }
  });

  it("are about the files that a refusal names", () => {
    const cause = "it is of something else; leave it out (--without)";
    const [notice] = refusalNotices([`a/site.prj: ${cause}`, `b.prj: ${cause}`]);
    expect(notice).toMatchObject({ advice: "Leave it out", asked: { options: ["without"] } });
    expect(notice?.asked?.files).toEqual(["a/site.prj", "b.prj"]);
    expect(REMEDIES["without"]?.(["a/site.prj"])?.name).toBe("Leave out a/site.prj");
    expect(REMEDIES["without"]?.([])).toBeNull();
    expect(askedBy("no system is stated (--crs EPSG:N); see --roi, --crs").options).toEqual(["crs", "roi"]);
  });
});
