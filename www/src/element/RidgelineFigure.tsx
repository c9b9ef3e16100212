/**
 * `<ridgeline-figure kind="theta-sweep" scene="demo">`: a live figure in any page. Nothing is fetched or computed before it is
 * seen; figures of one scene share a worker. Attributes set its state, the event `ridgeline-state` tells of it.
 */
import { effect, signal } from "@preact/signals";
import { render } from "preact";
import { citationOf } from "../app/results/takeAlong/citation";
import { pngOf, svgOf } from "../app/results/takeAlong/pictures";
import { csvOf, numbered, type Row } from "../app/results/takeAlong/rows";
import type { CoreSource } from "../core/workerEngine";
import type { Args, InputFile, Result } from "../shared/calls";
import type { Figure } from "../stages/figure";
import { FigureFrame, type Seen } from "./FigureFrame";
import {
  addressOf,
  type FigureState,
  formatState,
  readState,
  STATE_NAMES,
  stateInAddress,
} from "./figureState";
import { FigureStore } from "./figureStore";
import { KIND_NAMES, kindOf } from "./kinds";
import { fetchScene, sceneUrl } from "./sceneFiles";
import { type SceneInput, type SharedScene, sceneOf } from "./sharedScene";
import { styleSheet } from "./styles";

/** Where the files of the package are. */
export interface FigurePlace extends CoreSource {
  /** Folder of the demo scene. */
  demoUrl: string;
}

/** Questions that change nothing. */
export type Question = "segmentStory" | "correspondence" | "side";

const TAG = "ridgeline-figure";
const SCENE_NAMES = ["kind", "scene", "base", "explained"];
let place: FigurePlace | null = null;
const ownKeys = new WeakMap<readonly InputFile[], string>();
let lastOwnFiles = 0;

/** Figures that are given the same files share a scene. */
export function keyOfFiles(files: readonly InputFile[]): string {
  const known = ownKeys.get(files);
  if (known !== undefined) {
    return known;
  }
  lastOwnFiles += 1;
  const key = `files ${lastOwnFiles}`;
  ownKeys.set(files, key);
  return key;
}

/** Makes the element known, once a page. */
export function defineFigure(of: FigurePlace): void {
  place ??= of;
  if (customElements.get(TAG) === undefined) {
    customElements.define(TAG, RidgelineFigure);
  }
}

export class RidgelineFigure extends HTMLElement {
  static readonly observedAttributes = [...SCENE_NAMES, ...STATE_NAMES];

  readonly #shadow = this.attachShadow({ mode: "open" });
  readonly #problem = signal<string | null>(null);
  readonly #seen = signal<Seen | null>(null);
  #observer: IntersectionObserver | null = null;
  #isVisible = false;
  #own: SceneInput | null = null;
  #scene: SharedScene | null = null;
  #stops: (() => void)[] = [];
  #body: HTMLElement | null = null;

  connectedCallback(): void {
    this.#shadow.adoptedStyleSheets = [styleSheet()];
    render(<Root seen={this.#seen} problem={this.#problem} />, this.#shadow);
    this.#shadow.addEventListener("keydown", keepOwnKeys);
    this.#observer = new IntersectionObserver((entries) => {
      if (entries.some(({ isIntersecting }) => isIntersecting) && !this.#isVisible) {
        this.#isVisible = true;
        this.#show();
      }
    });
    this.#observer.observe(this);
    window.addEventListener("hashchange", this.#followAddress);
  }

  disconnectedCallback(): void {
    window.removeEventListener("hashchange", this.#followAddress);
    this.#observer?.disconnect();
    this.#isVisible = false;
    this.#end();
    render(null, this.#shadow);
  }

  attributeChangedCallback(name: string, before: string | null, now: string | null): void {
    if (!this.#isVisible || before === now) {
      return;
    }
    if (SCENE_NAMES.includes(name)) {
      this.#show();
    } else {
      this.state = this.#alone(name);
    }
  }

  /** Where the figure is. Setting a part of it leaves the rest. */
  get state(): FigureState {
    return this.#seen.peek()?.store.state.peek() ?? this.#attributeState();
  }

  set state(state: Partial<FigureState>) {
    this.#seen.peek()?.store.goTo(state);
  }

  /** Files of a scene that has no address, for example those that a person chose. */
  get files(): readonly InputFile[] | null {
    return this.#own?.files ?? null;
  }

  set files(files: readonly InputFile[] | null) {
    this.input = files === null ? null : { files };
  }

  /** The same with parameters and options. */
  set input(input: SceneInput | null) {
    this.#own = input;
    if (this.#isVisible) {
      this.#show();
    }
  }

  /** What it shows: scene, results of the stages, selection, and what the core answered about it. */
  get shown(): Figure {
    return this.#ready().store.figure.peek();
  }

  /** Asks the core about the scene; null where it cannot answer. */
  ask<K extends Question>(call: K, ...of: Args<K>): Promise<Result<K> | null> {
    return this.#ready().scene.ask(call, ...of);
  }

  /** The figure as an SVG file. */
  toSvg(): string {
    const seen = this.#ready();
    return svgOf(this.#body as HTMLElement, seen.kind.of.title);
  }

  /** The figure as a PNG, in the size of print. */
  toPng(): Promise<Blob> {
    return pngOf(this.toSvg());
  }

  /** The numbers behind it, a record a row. */
  rows(): Row[] {
    const { kind, store } = this.#ready();
    return numbered(kind.rows(store.figure.peek()));
  }

  toCsv(): string {
    return csvOf(this.rows());
  }

  /** The paper that it is from, as BibTeX. */
  citation(): string {
    const kind = kindOf(this.getAttribute("kind"));
    return kind === null ? "" : citationOf(kind.of);
  }

  /** The address of this page that opens the figure as it is. */
  link(): string {
    return addressOf(location.href, this.#name(), this.state);
  }

  #ready(): Seen {
    const seen = this.#seen.peek();
    if (seen === null || this.#body === null) {
      throw new Error("The figure is not drawn yet: wait for its event 'ridgeline-ready'.");
    }
    return seen;
  }

  /** Its name in addresses: its id, or its place among the figures of the page. */
  #name(): string {
    const all = [...document.querySelectorAll(TAG)];
    return this.id !== "" ? this.id : `figure${all.indexOf(this) + 1}`;
  }

  #attributeState(): FigureState {
    return readState((name) => this.getAttribute(name));
  }

  /** What one attribute says, where setting it is to change that alone. */
  #alone(name: string): Partial<FigureState> {
    const said = this.#attributeState();
    const isPick = name === "select";
    return {
      select: isPick ? said.select : null,
      theta: isPick || name === "theta" ? said.theta : null,
      point: isPick || name === "point" ? said.point : null,
      view: name === "view" ? said.view : null,
      plane: name === "plane" ? said.plane : null,
    };
  }

  readonly #followAddress = () => {
    const state = stateInAddress(location.hash, this.#name());
    if (state !== null) {
      this.state = state;
    }
  };

  /** Begins with the scene and kind that the attributes name. */
  #show(): void {
    this.#end();
    const name = this.getAttribute("kind");
    const kind = kindOf(name);
    if (kind === null || place === null) {
      this.#problem.value = `There is no figure of kind "${name ?? ""}". The kinds are: ${KIND_NAMES.join(", ")}.`;
      return;
    }
    this.#problem.value = null;
    const base = this.getAttribute("base") ?? place.demoUrl;
    const scene = this.#sceneOf(this.getAttribute("scene") ?? "demo", base, kind.method);
    this.#scene = scene;
    scene.join();
    const first = stateInAddress(location.hash, this.#name()) ?? this.#attributeState();
    const store = new FigureStore(scene, kind.begin, first);
    const seen: Seen = {
      name: name ?? "",
      kind,
      scene,
      store,
      isExplained: this.hasAttribute("explained"),
      link: () => this.link(),
      onBody: (body) => {
        this.#body = body;
      },
    };
    this.#seen.value = seen;
    this.#stops = [() => store.end(), this.#tell(seen)];
    void scene.need(kind.stage).then(() => {
      if (this.#seen.peek() === seen && scene.state.peek().failure === null) {
        store.begin();
        // Once it is drawn.
        requestAnimationFrame(() => requestAnimationFrame(() => this.#say("ridgeline-ready", this.state)));
      }
    });
  }

  #sceneOf(name: string, base: string, method: Parameters<typeof sceneOf>[2]): SharedScene {
    const own = this.#own;
    if (own !== null) {
      return sceneOf(place as FigurePlace, keyOfFiles(own.files), method, async () => own);
    }
    const url = sceneUrl(name, base, document.baseURI);
    return sceneOf(place as FigurePlace, url, method, async () => ({ files: await fetchScene(url) }));
  }

  /** Tells the page of every change of the state, and of what fails. */
  #tell({ store, scene }: Seen): () => void {
    let last: string | null = null;
    const stopState = effect(() => {
      const state = store.state.value;
      const text = formatState(state);
      if (store.isReady && text !== last) {
        last = text;
        this.#say("ridgeline-state", state);
      }
    });
    const stopFailure = effect(() => {
      const { failure } = scene.state.value;
      if (failure !== null) {
        this.#say("ridgeline-failure", { message: failure });
      }
    });
    return () => {
      stopState();
      stopFailure();
    };
  }

  #say(type: string, detail: unknown): void {
    this.dispatchEvent(new CustomEvent(type, { detail, bubbles: true, composed: true }));
  }

  #end(): void {
    for (const stop of this.#stops) {
      stop();
    }
    this.#stops = [];
    this.#seen.value = null;
    this.#scene?.leave();
    this.#scene = null;
  }
}

const OWN_KEYS = /^(Arrow|Home|End|Page|Enter$|[-+=0 ]$)/;

/** What moves a figure does not move the slides around it. */
function keepOwnKeys(event: Event): void {
  const isOnControl =
    event.target instanceof Element && event.target.matches("input, select, canvas, button, [tabindex]");
  if (isOnControl && OWN_KEYS.test((event as KeyboardEvent).key)) {
    event.stopPropagation();
  }
}

interface RootProps {
  seen: { value: Seen | null };
  problem: { value: string | null };
}

function Root({ seen, problem }: RootProps) {
  if (problem.value !== null) {
    return (
      <p class="failure" role="alert">
        {problem.value}
      </p>
    );
  }
  return seen.value === null ? (
    <div class="frame unseen" />
  ) : (
    <FigureFrame key={seen.value} seen={seen.value} />
  );
}
