/**
 * A scene that several figures show: fetched once, loaded once into one worker, each stage run once, on request of whoever
 * needs it first. It ends with the last figure.
 */
import { type ReadonlySignal, signal } from "@preact/signals";
import { type CoreSource, WorkerEngine } from "../core/workerEngine";
import type { Args, CallName, InputFile, Result } from "../shared/calls";
import type { ParamTree } from "../shared/paramTree";
import type { LoadOptions, Params, SceneInfo } from "../shared/records";
import type { Method, StageName } from "../shared/stages";
import { stagesOf, stageWords } from "../stages/catalogue";
import { fetchResults, NO_RESULTS, type Results } from "../stages/list";

export interface SceneState {
  scene: SceneInfo | null;
  images: readonly ImageBitmap[];
  results: Results;
  params: ParamTree;
  /** What is going on; null when all that was asked for is there. */
  progress: { words: string; fraction: number } | null;
  failure: string | null;
}

const NOTHING: SceneState = {
  scene: null,
  images: [],
  results: NO_RESULTS,
  params: {},
  progress: null,
  failure: null,
};

/** What a scene is made of, and how it is wanted where no project file among it says so. */
export interface SceneInput {
  files: readonly InputFile[];
  params?: ParamTree;
  /** What is asked for beyond the files; may ask the core, which holds them by then. */
  options?: (engine: WorkerEngine) => Promise<LoadOptions>;
}

/** Figures that are taken out of a page to be put elsewhere keep their scene. */
const GRACE_MS = 2000;

export class SharedScene {
  readonly #present = signal<SceneState>(NOTHING);
  readonly #engine: WorkerEngine;
  readonly #fetch: () => Promise<SceneInput>;
  readonly #method: Method;
  readonly #onEnd: () => void;
  readonly #ready = new Set<StageName>();
  #queue: Promise<void>;
  #figures = 0;
  #isClosed = false;

  constructor(source: CoreSource, fetchInput: () => Promise<SceneInput>, method: Method, onEnd: () => void) {
    this.#engine = new WorkerEngine(source, (stage, fraction) => this.#reached(stage, fraction));
    this.#fetch = fetchInput;
    this.#method = method;
    this.#onEnd = onEnd;
    this.#queue = this.#attempt(() => this.#load());
  }

  get state(): ReadonlySignal<SceneState> {
    return this.#present;
  }

  join(): void {
    this.#figures += 1;
  }

  leave(): void {
    this.#figures -= 1;
    setTimeout(() => this.closeUnused(), GRACE_MS);
  }

  /** Ends what no figure shows, unless the page wants it kept. */
  closeUnused(): void {
    if (this.#figures === 0 && !this.#isClosed && !areKept) {
      this.#close();
    }
  }

  /** Runs what has not run yet of the stages up to this one. */
  need(stage: StageName): Promise<void> {
    this.#queue = this.#queue.then(() => this.#attempt(() => this.#runTo(stage)));
    return this.#queue;
  }

  /** Asks the core; null where it cannot answer. */
  async ask<K extends CallName>(call: K, ...of: Args<K>): Promise<Result<K> | null> {
    try {
      return await this.#engine.call(call, ...of);
    } catch (error) {
      this.#fail(error);
      return null;
    }
  }

  async #load(): Promise<void> {
    this.#change({ progress: { words: "Fetching the scene", fraction: 0 } });
    const [{ files, params: wanted, options }] = await Promise.all([this.#fetch(), this.#engine.open()]);
    this.#change({ progress: { words: "Reading the photographs", fraction: 0 } });
    await this.#engine.call("setFiles", files);
    const project = await this.#engine.call("openedProject");
    const defaults = await this.#engine.call("defaultParams");
    const chosen = (project?.params ?? wanted ?? defaults) as unknown as ParamTree;
    const params = { ...chosen, method: this.#method as unknown as ParamTree[string] };
    await this.#engine.call("setParams", params as unknown as Params & ParamTree);
    const asked = await options?.(this.#engine);
    const scene = await this.#engine.call("load", asked ?? optionsOf(project?.options ?? {}));
    const images: ImageBitmap[] = [];
    for (let view = 0; view < scene.views.length; view += 1) {
      images.push(await this.#engine.call("image", view));
    }
    this.#change({ scene, images, params, progress: null });
  }

  async #runTo(target: StageName): Promise<void> {
    const names = stagesOf(this.#method);
    const end = names.indexOf(target);
    for (let i = 0; i <= end; i += 1) {
      const name = names[i] as StageName;
      if (!this.#ready.has(name)) {
        this.#change({ progress: { words: stageWords(name).title, fraction: 0 } });
        // Where the adjustment moves views, they are matched anew.
        const summary = await (name === "adjustment"
          ? this.#engine.call("adjustOnce")
          : this.#engine.call("runStage", name));
        if (summary === null) {
          i = names.indexOf("matches") - 1;
          this.#ready.delete("matches");
          continue;
        }
        await this.#take(name);
        this.#ready.add(name);
      }
    }
    this.#change({ progress: null });
  }

  async #take(name: StageName): Promise<void> {
    const { params, scene, results } = this.#present.peek();
    const views = scene?.views.length ?? 0;
    const found = await fetchResults(name, {
      call: (...asked) => this.#engine.call(...asked),
      views,
      params,
    });
    const moved = name === "adjustment" ? { scene: await this.#engine.call("scene") } : {};
    this.#change({ ...moved, results: { ...results, ...found } });
  }

  /** What fails is said in every figure; the scene cannot be used any more. */
  async #attempt(work: () => Promise<void>): Promise<void> {
    if (this.#isClosed || this.#present.peek().failure !== null) {
      return;
    }
    try {
      await work();
    } catch (error) {
      this.#fail(error);
    }
  }

  #fail(error: unknown): void {
    if (!this.#isClosed) {
      const failure = error instanceof Error ? error.message : String(error);
      this.#change({ failure, progress: null });
    }
  }

  #reached(stage: string, fraction: number): void {
    const { progress } = this.#present.peek();
    if (progress !== null && fraction > progress.fraction) {
      this.#change({ progress: { words: stageWords(stage as StageName).title, fraction } });
    }
  }

  #change(part: Partial<SceneState>): void {
    this.#present.value = { ...this.#present.peek(), ...part };
  }

  #close(): void {
    this.#isClosed = true;
    this.#engine.close();
    for (const image of this.#present.peek().images) {
      image.close();
    }
    this.#onEnd();
  }
}

/** What a project leaves open is not an option. */
function optionsOf(options: object): LoadOptions {
  return Object.fromEntries(Object.entries(options).filter(([, value]) => value !== null)) as LoadOptions;
}

const open = new Map<string, SharedScene>();
const fetched = new Map<string, Promise<SceneInput>>();
let areKept = false;

/** For a page that shows figures of one scene after the other: scenes stay when their last figure goes, until this is taken back. */
export function keepScenes(isWanted: boolean): void {
  areKept = isWanted;
  for (const scene of [...open.values()]) {
    scene.closeUnused();
  }
}

/** The scene of an address for a method: the one that other figures show, or a new one. */
export function sceneOf(
  source: CoreSource,
  key: string,
  method: Method,
  fetchInput: () => Promise<SceneInput>,
): SharedScene {
  const name = `${method} ${key}`;
  const known = open.get(name);
  if (known !== undefined) {
    return known;
  }
  // Two methods have a worker each, and the files in common.
  const input = fetched.get(key) ?? fetchInput();
  fetched.set(key, input);
  const forget = () => {
    open.delete(name);
    if (![...open.keys()].some((other) => other.endsWith(` ${key}`))) {
      fetched.delete(key);
    }
  };
  input.catch(() => forget());
  const made = new SharedScene(source, () => input, method, forget);
  open.set(name, made);
  return made;
}
