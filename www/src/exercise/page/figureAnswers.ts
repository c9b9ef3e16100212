/** The answers of the exercises in figures, as the demo scene has them: the core is asked, but nothing is drawn. */
import { FIRST_STATE, type FigureState } from "../../element/figureState";
import { FigureStore } from "../../element/figureStore";
import { type Kind, kindOf } from "../../element/kinds";
import { fetchScene, sceneUrl } from "../../element/sceneFiles";
import { sceneOf } from "../../element/sharedScene";
import type { FigureExercise } from "../figures/judgeFigure";
import { sitePlace } from "./siteFigure";

const LONGEST_MS = 20_000;

/** In words. */
export async function answerOnDemo(exercise: FigureExercise): Promise<string> {
  const { method, stage, begin } = kindOf(exercise.figure) as Kind;
  const place = await sitePlace();
  const url = sceneUrl("demo", place.demoUrl, document.baseURI);
  const scene = sceneOf(place, url, method, async () => ({ files: await fetchScene(url) }));
  scene.join();
  const store = new FigureStore(scene, begin, FIRST_STATE);
  try {
    await scene.need(stage);
    const { failure } = scene.state.peek();
    if (failure !== null) {
      throw new Error(failure);
    }
    store.begin();
    const of = {
      get shown() {
        return store.figure.peek();
      },
      ask: scene.ask.bind(scene),
    };
    const state = await exercise.begin(of);
    store.goTo(state);
    await until(() => isThere(store.state.peek(), state));
    return (await exercise.answer(of)).words;
  } finally {
    store.end();
    scene.leave();
  }
}

/** Whether a figure has come to a state, the core's answers about it included. */
function isThere(now: FigureState, wanted: Partial<FigureState>): boolean {
  const isSet = (name: "theta" | "point") => (wanted[name] ?? null) === null || now[name] !== null;
  return (wanted.select === undefined || now.select === wanted.select) && isSet("theta") && isSet("point");
}

async function until(isTrue: () => boolean): Promise<void> {
  const end = performance.now() + LONGEST_MS;
  while (!isTrue()) {
    if (performance.now() > end) {
      throw new Error("The core does not answer.");
    }
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}
