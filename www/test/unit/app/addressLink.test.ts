import { describe, expect, it } from "vitest";
import { formatLink, type Link, parseLink } from "../../../src/app/settings/addressLink";

const LINK: Link = {
  scene: "demo",
  face: "method",
  tab: "halfplanes",
  view: 2,
  selection: { kind: "side", line: 12, side: "left" },
  params: { method: "rectangles", "sweep.min_similarity": 0.45 },
  tourStep: 4,
  thetaDeg: -12.5,
  point: [2, 0.375],
  camera: [1, 2, 30.25, -4, 5, 0],
};

describe("links", () => {
  it("say what they said", () => {
    expect(parseLink(`#${formatLink(LINK)}`)).toEqual(LINK);
  });

  it.each(["rectangles", "combined"])("name the method: %s", (method) => {
    expect(parseLink(formatLink({ ...LINK, params: { method } })).params).toEqual({ method });
  });

  it("lead to the method where only that shows the tab", () => {
    expect(parseLink("tab=lines").face).toBe("method");
    expect(parseLink("tab=model").face).toBeNull();
    expect(parseLink("tab=lines&face=result").face).toBe("result");
  });

  it.each([
    "tab=<script>",
    "select=line:-1",
    "select=line:1e9",
    "select=side:3",
    "select=segment:1.left",
    "view=1.5",
    "params={",
    "params=[1]",
    "scene=http://elsewhere",
    "face=other",
    "method=constructor",
    "theta=up",
    "theta=",
    "point=3",
    "camera=1,2,3,4,5,NaN",
  ])("take nothing from %j", (hash) => {
    expect(parseLink(hash)).toEqual({
      scene: null,
      face: null,
      tab: null,
      view: null,
      selection: null,
      params: {},
      tourStep: null,
      thetaDeg: null,
      point: null,
      camera: null,
    });
  });
});
