/** Exercises in figures, on the demo scene as the page's own core finds it: right answers, and mistakes by their names. */
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { beforeAll, describe, expect, it } from "vitest";
import { FIGURE_EXERCISES } from "../../../src/exercise/figures";
import { type Asked, type FigureExercise, judgeFigure } from "../../../src/exercise/figures/judgeFigure";
import { facesUnder, outcomeOfRegion, ridgeIn } from "../../../src/exercise/figures/objectSpace";
import { outcomeOf, pairsOf, sigmaAcross } from "../../../src/exercise/figures/pairs";
import { edgesOfView } from "../../../src/exercise/figures/segments";
import { EDGES, edgeAlong, FACES, faceBeside, imageIn, lineOf } from "../../../src/exercise/figures/truth";
import type { Figure } from "../../../src/stages/figure";
import { type DemoFigure, demoFigure } from "./demoScene";

const LONG_MS = 60_000;
const named = (name: string) => FIGURE_EXERCISES.find((one) => one.name === name) as FigureExercise;

/** A figure as it is when the exercise begins. */
async function begun(name: string): Promise<[FigureExercise, DemoFigure]> {
  const exercise = named(name);
  const figure = await demoFigure(exercise.figure);
  await figure.goTo(await exercise.begin(figure));
  return [exercise, figure];
}

/** What is said of the figure as it is. */
const judged = (exercise: FigureExercise, of: Asked, given = "") => judgeFigure(exercise, of, given);

/** What is said of a figure that differs in what it shows. */
const planted = (exercise: FigureExercise, of: Asked, change: Partial<Figure>) =>
  judgeFigure(exercise, { shown: { ...of.shown, ...change }, ask: of.ask }, "");

beforeAll(async () => {
  await demoFigure("facet-plan");
  await demoFigure("main-directions");
}, LONG_MS);

describe("the truth of the demo scene", () => {
  it("is that of its photographs: edges of roofs lie on segments, and lines in space on edges", async () => {
    const { shown } = await demoFigure("segments");
    const views = shown.scene?.views ?? [];
    const covered = views.flatMap((_, view) => edgesOfView(shown, view).flatMap(({ edge }) => edge ?? []));
    const found = new Set(covered);
    expect(found.size).toBeGreaterThan(0.85 * EDGES.length);
    const lines = shown.results.records.flatMap((_, i) => {
      const line = lineOf(shown, i);
      return line === null ? [] : (edgeAlong(line)?.kind ?? []);
    });
    expect(lines.length).toBeGreaterThan(40);
  });

  it("has faces that contain the ends of their edges, and slopes that are those of their planes", () => {
    for (const { plane, slope_deg, polygon } of FACES) {
      const [a, b, c, d] = plane;
      expect((Math.acos(c) * 180) / Math.PI).toBeCloseTo(slope_deg, 1);
      for (const [x, y, z] of polygon) {
        expect(Math.abs(a * x + b * y + c * z + d)).toBeLessThan(0.001);
      }
    }
  });

  it("is what the renderer wrote, where its files are at hand", () => {
    const folder = join(process.env["SCENES"] ?? "../../shared/scenes", "detached/truth");
    if (!existsSync(folder)) {
      console.info(`skipped: no ${folder}`);
      return;
    }
    const { edges } = JSON.parse(readFileSync(join(folder, "edges.json"), "utf8"));
    expect(EDGES.map(({ kind }) => kind)).toEqual(edges.map(({ kind }: { kind: string }) => kind));
    const far = (a: readonly number[], b: readonly number[]) =>
      Math.hypot(...a.map((value, i) => value - (b[i] ?? 0)));
    EDGES.forEach(({ p0 }, i) => {
      expect(far(p0, edges[i].p0)).toBeLessThan(1e-5);
    });
  });
});

describe.each(FIGURE_EXERCISES.map((exercise) => [exercise.name, exercise] as const))(
  "%s",
  (name, exercise) => {
    it("is not done when it begins, and done where its answer is shown", { timeout: LONG_MS }, async () => {
      const [, figure] = await begun(name);
      expect((await judged(exercise, figure)).kind).not.toBe("right");
      const { words, state, given } = await exercise.answer(figure);
      expect(words.length).toBeGreaterThan(2);
      if (state !== undefined) {
        await figure.goTo(state);
      }
      expect(await judged(exercise, figure, given)).toEqual({ kind: "right" });
    });

    it("explains at least three mistakes", () => {
      const mistakes = Object.values(exercise.mistakes);
      expect(mistakes.length).toBeGreaterThanOrEqual(3);
      for (const says of mistakes) {
        expect(says.length).toBeGreaterThan(40);
      }
    });
  },
);

describe("segments", () => {
  it("are known by the edge that they show", async () => {
    const [exercise, figure] = await begun("pickEave");
    const wanted: Record<string, string> = { ridge: "a ridge", hip: "a hip", rake: "a rake" };
    for (const { index, edge } of edgesOfView(figure.shown, 0)) {
      const verdict = await planted(exercise, figure, { selection: { kind: "segment", view: 0, index } });
      const mistake = edge === null ? "no edge of a roof" : wanted[edge.kind];
      expect(verdict).toMatchObject(
        mistake === undefined ? { kind: "right" } : { kind: "mistake", name: mistake },
      );
    }
    expect(await judged(exercise, figure)).toMatchObject({ kind: "form" });
  });

  it.each([
    ["trueCandidate", ["beside the edge", "another edge", "no edge of a roof"]],
    ["falseCandidate", ["the true candidate", "nothing predicted", "verified by chance"]],
  ])("%s: every candidate is right or a mistake with a name", async (name, mistakes) => {
    const [exercise, figure] = await begun(name);
    const { detail, results, scene } = figure.shown;
    const story = detail.story;
    if (story === null || scene === null) {
      throw new Error("no segment is picked");
    }
    const heard = new Set<string>();
    // Those of the scene, and any segment of another view as if it were one; with and without predictions.
    const own = story.candidates.flatMap((one) => [one, { ...one, predictions: [] }]);
    const [first] = story.candidates;
    const others = Array.from({ length: (results.segments[1]?.length ?? 0) / 4 }, (_, segment) => ({
      ...(first as NonNullable<typeof first>),
      view: 1,
      segment,
    }));
    for (const candidate of [...own, ...others]) {
      const verdict = await planted(exercise, figure, {
        detail: { ...detail, candidate: 0, story: { ...story, candidates: [candidate] } },
      });
      heard.add(verdict.kind === "mistake" ? verdict.name : verdict.kind);
    }
    expect([...heard].sort()).toEqual(["right", ...mistakes].sort());
  });

  it("are compared where they have a point in common", async () => {
    const [exercise, figure] = await begun("bestWindows");
    const { detail } = figure.shown;
    const story = detail.story;
    const at = async (place: number) => {
      await figure.goTo({ point: [0, place] });
      return judged(exercise, figure);
    };
    const correlations: number[] = [];
    for (let i = 0; i <= 20; i += 1) {
      await at(i / 20);
      correlations.push(figure.shown.detail.correspondence?.correlation ?? Number.NaN);
    }
    const worst = correlations.indexOf(Math.min(...correlations)) / 20;
    expect(await at(worst)).toMatchObject({ name: "where they agree least" });
    await figure.goTo({ point: [1, 0.5] });
    expect(await judged(exercise, figure)).toMatchObject({ name: "another candidate" });
    const none = { ...detail, story, candidate: 0, correspondence: null };
    expect(await planted(exercise, figure, { detail: none })).toMatchObject({ name: "no common point" });
  });
});

describe("half-planes", () => {
  it("have the angle of the roof beside them, by the truth alone", async () => {
    const { shown } = await demoFigure("theta-sweep");
    const off = (shown.results.halfPlanes ?? []).flatMap(({ line, side, theta }) => {
      const ends = lineOf(shown, line);
      const beside = ends === null || edgeAlong(ends) === null ? null : faceBeside(ends, side);
      return beside === null ? [] : [Math.abs((theta * 180) / Math.PI - beside.theta)];
    });
    const median = off.sort((a, b) => a - b)[Math.floor(off.length / 2)];
    expect(off.length).toBeGreaterThan(20);
    expect(median).toBeLessThan(2);
  });

  it("are turned to right and wrong angles", async () => {
    const [exercise, figure] = await begun("turnToRoof");
    const { words } = await exercise.answer(figure);
    const truth = Number(/-?[\d.]+/.exec(words)?.[0]);
    const at = async (theta: number) => {
      await figure.goTo({ theta });
      return judged(exercise, figure);
    };
    expect(await at(truth + 1.8)).toEqual({ kind: "right" });
    expect(await at(truth - 2.4)).toMatchObject({ kind: "wrong" });
    expect(await at(-truth)).toMatchObject({ name: "wrong sign" });
    expect(await at(0)).toMatchObject({ name: "level" });
    expect(await at(Math.sign(truth) * (90 - Math.abs(truth)))).toMatchObject({ name: "from the vertical" });
  });

  it("fall to half of their peak on both sides, of which one is meant", async () => {
    const [exercise, figure] = await begun("halfOfPeak");
    const curve = figure.shown.detail.side?.curve;
    if (curve === undefined) {
      throw new Error("no side is picked");
    }
    const { thetas, similarity } = curve;
    const sim = Math.max(...similarity);
    const peak = similarity.indexOf(sim);
    const at = async (theta: number) => {
      const { detail } = figure.shown;
      return planted(exercise, figure, { detail: { ...detail, theta } });
    };
    expect(await at(thetas[peak] ?? 0)).toMatchObject({ name: "at the peak" });
    const above = thetas.find((_, i) => i > peak && (similarity[i] ?? 1) <= sim / 2) ?? 0;
    expect(await at(above)).toEqual({ kind: "right" });
    expect(await at(thetas[similarity.indexOf(Math.min(...similarity))] ?? 0)).toMatchObject({
      name: "at the bottom",
    });
    const heard = new Set<string>();
    for (const theta of thetas) {
      const verdict = await at(theta);
      heard.add(verdict.kind === "mistake" ? verdict.name : verdict.kind);
    }
    expect([...heard]).toEqual(
      expect.arrayContaining(["right", "wrong", "at the peak", "at the bottom", "below the peak"]),
    );
  });
});

describe("pairs of views", () => {
  it("know a line as well as a covariance of the line says, and more views know it better", async () => {
    const [, figure] = await begun("bestPair");
    const { shown } = figure;
    const line = lineOf(shown, shown.selection?.kind === "line" ? shown.selection.index : -1);
    const views = shown.scene?.views ?? [];
    if (line === null) {
      throw new Error("no line is picked");
    }
    const pairs = pairsOf(shown);
    const all = sigmaAcross(views, line);
    expect(pairs.length).toBe(6);
    for (const { sigma } of pairs) {
      expect(sigma).toBeGreaterThan(all);
    }
    // The best pair alone is no better than what the core states of all views, with its own accuracy in the image.
    expect(all).toBeGreaterThan(0.01);
    expect(all).toBeLessThan(0.5);
  });

  it("are right or a mistake with a name", async () => {
    const [exercise, figure] = await begun("bestPair");
    const pairs = pairsOf(figure.shown);
    const heard = new Map<string, string>();
    for (const { names } of pairs) {
      const verdict = await judged(exercise, figure, names);
      heard.set(names, verdict.kind === "mistake" ? verdict.name : verdict.kind);
    }
    expect(new Set(heard.values())).toEqual(
      new Set(["right", "baseline along the line", "short baseline", "not the best"]),
    );
    const [least] = [...pairs].sort((a, b) => a.sigma - b.sigma);
    expect(heard.get(least?.names ?? "")).toBe("right");
    const base = { names: "", sigma: 1, baseline: 100, angle: 90 };
    expect(outcomeOf({ ...base, sigma: 2, angle: 10 }, [base])).toEqual({
      mistake: "baseline along the line",
    });
    expect(outcomeOf({ ...base, sigma: 2, baseline: 40 }, [base])).toEqual({ mistake: "short baseline" });
    expect(outcomeOf({ ...base, sigma: 2 }, [base])).toEqual({ mistake: "not the best" });
    expect(await judged(exercise, figure, "")).toMatchObject({ kind: "form" });
  });
});

describe("object space", () => {
  it("has a ridge in one of the main directions that the core found", async () => {
    const [exercise, figure] = await begun("ridgeDirection");
    const { plane, results } = figure.shown;
    const truth = ridgeIn(figure.shown, plane) ?? Number.NaN;
    const main = ((results.directions?.windows[plane]?.directions[0]?.azimuth ?? Number.NaN) * 180) / Math.PI;
    expect(Math.min(...[0, 90, 180].map((turn) => Math.abs(main + turn - truth)))).toBeLessThan(2);
    const says = (angle: number) => judged(exercise, figure, `${angle} deg`);
    expect(await says(truth + 1.5)).toEqual({ kind: "right" });
    expect(await says(truth - 180)).toEqual({ kind: "right" });
    expect(await judged(exercise, figure, `${(truth * Math.PI) / 180} rad`)).toEqual({ kind: "right" });
    expect(await says(truth + 90)).toMatchObject({ name: "the perpendicular direction" });
    expect(await says(90 - truth)).toMatchObject({ name: "from north" });
    expect(await says(-truth)).toMatchObject({ name: "wrong sense" });
    expect(await says(truth + 45)).toMatchObject({ kind: "wrong" });
    expect(await judged(exercise, figure, `${truth}`)).toMatchObject({ kind: "form" });
    expect(await judged(exercise, figure, "3 m")).toMatchObject({ kind: "form" });
  });

  it("has regions that are faces, parts of them, several of them, and none", async () => {
    const [exercise, figure] = await begun("wholeFace");
    const { shown } = figure;
    const view = shown.scene?.views[0];
    const segmentation = shown.results.regions[0];
    if (view === undefined || segmentation === undefined) {
      throw new Error("no regions");
    }
    const heard = new Set<string>();
    segmentation.regions.forEach((_, index) => {
      const outcome = outcomeOfRegion(facesUnder(shown, 0, index));
      heard.add(outcome === "right" ? outcome : "mistake" in outcome ? outcome.mistake : "");
    });
    expect([...heard]).toEqual(expect.arrayContaining(["right", "no roof", "a part of a face"]));
    /** As if the partition had this region. */
    const withRing = (ring: readonly (readonly [number, number])[]) => {
      const region = { ...segmentation.regions[0], rings: [ring] };
      const regions = [{ ...segmentation, regions: [region] }, ...shown.results.regions.slice(1)];
      return planted(exercise, figure, {
        results: { ...shown.results, regions } as Figure["results"],
        selection: { kind: "region", view: 0, index: 0 },
      });
    };
    const ringOf = (i: number) => (FACES[i]?.polygon ?? []).map((point) => imageIn(view, point));
    const box = (places: readonly (readonly [number, number])[], by: number) => {
      const [xs, ys] = [places.map(([x]) => x), places.map(([, y]) => y)];
      const [x0, x1, y0, y1] = [
        Math.min(...xs) - by,
        Math.max(...xs) + by,
        Math.min(...ys) - by,
        Math.max(...ys) + by,
      ];
      return [
        [x0, y0],
        [x1, y0],
        [x1, y1],
        [x0, y1],
      ] as const;
    };
    expect(await withRing(ringOf(0))).toEqual({ kind: "right" });
    expect(await withRing(box([...ringOf(0), ...ringOf(1)], 0))).toMatchObject({ name: "several faces" });
    const middle = ringOf(0).reduce(([x, y], [u, v]) => [x + u / 4, y + v / 4] as [number, number], [0, 0]);
    expect(await withRing(box([middle], 4))).toMatchObject({ name: "a part of a face" });
    expect(await withRing(box([[20, 20]], 8))).toMatchObject({ name: "no roof" });
  });

  it("has facets that are hip ends, and others", async () => {
    const [exercise, figure] = await begun("hipEnd");
    const heard = new Set<string>();
    for (const [index] of (figure.shown.results.facets ?? []).entries()) {
      const verdict = await planted(exercise, figure, { selection: { kind: "facet", index } });
      heard.add(verdict.kind === "mistake" ? verdict.name : verdict.kind);
    }
    expect([...heard].sort()).toEqual(["a gable", "beside the hip end", "right"].sort());
    const [facet] = figure.shown.results.facets ?? [];
    const away = { ...facet, outer: (facet?.outer ?? []).map(([x, y, z]) => [x + 500, y, z]) };
    const results = { ...figure.shown.results, facets: [away] } as unknown as Figure["results"];
    expect(
      await planted(exercise, figure, { results, selection: { kind: "facet", index: 0 } }),
    ).toMatchObject({
      name: "no face of a roof",
    });
  });
});
