/** The demo scene as the figures have it: the page's own core, in Node. */
import { readFileSync } from "node:fs";
import { signal } from "@preact/signals";
import type { FigureState } from "../../../src/element/figureState";
import { FigureStore } from "../../../src/element/figureStore";
import { type Kind, kindOf } from "../../../src/element/kinds";
import type { SceneState, SharedScene } from "../../../src/element/sharedScene";
import type { Asked } from "../../../src/exercise/figures/judgeFigure";
import * as core from "../../../src/pkg/ridgeline.js";
import type { Method, StageName } from "../../../src/shared/stages";
import { stagesOf } from "../../../src/stages/catalogue";
import type { Figure } from "../../../src/stages/figure";
import { fetchResults, NO_RESULTS } from "../../../src/stages/list";

const WWW = new URL("../../../", import.meta.url);

/** A method's session on the demo scene, with all stages up to one of them. */
async function sessionOf(
  method: Method,
  last: StageName,
): Promise<{ state: SceneState; session: core.Session }> {
  core.initSync({ module: readFileSync(new URL("src/pkg/ridgeline_bg.wasm", WWW)) });
  const session = new core.Session();
  const folder = new URL("public/demo/", WWW);
  const { files } = JSON.parse(readFileSync(new URL("manifest.json", folder), "utf8"));
  for (const file of files) {
    session.addFile(file, readFileSync(new URL(file, folder)));
  }
  session.setParams({ method });
  const scene = session.load({});
  const results = { ...NO_RESULTS };
  for (const stage of stagesOf(method)) {
    session.runStage(stage, () => {});
    Object.assign(
      results,
      await fetchResults(stage, {
        call: async (name, ...args) =>
          (session as never as Record<string, (...of: unknown[]) => never>)[name]?.(...args) as never,
        views: scene.views.length,
        params: {},
      }),
    );
    if (stage === last) {
      break;
    }
  }
  return { session, state: { scene, images: [], results, params: {}, progress: null, failure: null } };
}

const sessions = new Map<string, ReturnType<typeof sessionOf>>();
/** All figures of a method share a session, up to the last stage that one of them needs. */
const LAST: Partial<Record<Method, StageName>> = { lines: "facets", rectangles: "directions" };

export interface DemoFigure extends Asked {
  goTo(state: Partial<FigureState>): Promise<Figure>;
}

/** A figure of the demo scene, drawn by nobody. */
export async function demoFigure(kind: string): Promise<DemoFigure> {
  const { method, stage, begin } = kindOf(kind) as Kind;
  const last = LAST[method] ?? stage;
  const known = sessions.get(method) ?? sessionOf(method, last);
  sessions.set(method, known);
  const { session, state } = await known;
  const ask: Asked["ask"] = async (call, ...of) =>
    (call as string) === "warped"
      ? null
      : ((session as never as Record<string, (...args: unknown[]) => never>)[call]?.(...of) ?? null);
  const scene = { state: signal(state), ask } as unknown as SharedScene;
  const store = new FigureStore(scene, begin, {
    select: null,
    theta: null,
    point: null,
    view: null,
    plane: null,
  });
  store.begin();
  const settled = async () => {
    for (let i = 0; i < 20; i += 1) {
      await Promise.resolve();
      await new Promise((resolve) => setTimeout(resolve, 0));
    }
    return store.figure.peek();
  };
  await settled();
  return {
    get shown() {
      return store.figure.peek();
    },
    ask,
    goTo: (to) => {
      store.goTo(to);
      return settled();
    },
  };
}
