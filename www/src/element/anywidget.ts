/**
 * The figure in a notebook (Jupyter, by anywidget): one module that holds its worker. Files reach it as traits: `wasm` is the core,
 * `scene_files` a list of `{path, bytes}`; or `base` is the address of the package's folder "dist".
 */
import type { InputFile } from "../shared/calls";
import { FIRST_STATE, type FigureState, STATE_NAMES } from "./figureState";
import { defineFigure, type RidgelineFigure } from "./RidgelineFigure";

/** The built worker, which the build puts here. */
declare const __WORKER__: string;

/** What anywidget hands over of a widget's model. */
interface Model {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  save_changes(): void;
  on(event: string, listener: () => void): void;
  off(event: string, listener: () => void): void;
}

const HTML_NAMES = ["kind", "scene", "theme"] as const;

function render({ model, el }: { model: Model; el: HTMLElement }): () => void {
  const base = textOf(model.get("base"));
  const wasm = bytesOf(model.get("wasm"));
  defineFigure({
    startWorker: () => new Worker(blobUrl(__WORKER__, "text/javascript"), { type: "module" }),
    wasmUrl: wasm === null ? addressIn(base, "pkg/ridgeline_bg.wasm") : blobUrl(wasm, "application/wasm"),
    demoUrl: addressIn(base, "demo/"),
  });
  const figure = document.createElement("ridgeline-figure") as RidgelineFigure;
  for (const name of HTML_NAMES) {
    setAttribute(figure, name, model.get(name));
  }
  setState(figure, model);
  figure.files = filesOf(model.get("scene_files"));
  let isTelling = false;
  const tell = (event: Event) => {
    const state = (event as CustomEvent<FigureState>).detail;
    isTelling = true;
    for (const name of STATE_NAMES) {
      const value = state[name];
      model.set(name, typeof value === "object" ? (value?.join() ?? null) : value);
    }
    model.save_changes();
    isTelling = false;
  };
  const heed = STATE_NAMES.map((name) => {
    const listener = () => {
      const value = model.get(name);
      if (!isTelling && value !== null && value !== undefined) {
        setAttribute(figure, name, null);
        setAttribute(figure, name, value);
      }
    };
    model.on(`change:${name}`, listener);
    return () => model.off(`change:${name}`, listener);
  });
  const change = () => setAttribute(figure, "kind", model.get("kind"));
  model.on("change:kind", change);
  figure.addEventListener("ridgeline-state", tell);
  el.append(figure);
  return () => {
    for (const stop of heed) {
      stop();
    }
    model.off("change:kind", change);
    figure.remove();
  };
}

function setState(figure: RidgelineFigure, model: Model): void {
  for (const name of Object.keys(FIRST_STATE)) {
    setAttribute(figure, name, model.get(name));
  }
}

function setAttribute(figure: Element, name: string, value: unknown): void {
  if (value === null || value === undefined || value === "") {
    figure.removeAttribute(name);
  } else {
    figure.setAttribute(name, String(value));
  }
}

function filesOf(value: unknown): InputFile[] | null {
  if (!Array.isArray(value) || value.length === 0) {
    return null;
  }
  return value.map((file: { path: string; bytes: unknown }) => ({
    path: file.path,
    blob: new Blob([bytesOf(file.bytes) ?? new Uint8Array()]),
  }));
}

/** Traits of bytes arrive as views of a buffer. */
function bytesOf(value: unknown): Uint8Array<ArrayBuffer> | null {
  if (value instanceof ArrayBuffer) {
    return new Uint8Array(value);
  }
  if (!ArrayBuffer.isView(value) || value.byteLength === 0) {
    return null;
  }
  return new Uint8Array(value.buffer as ArrayBuffer, value.byteOffset, value.byteLength).slice();
}

function textOf(value: unknown): string | null {
  return typeof value === "string" && value !== "" ? value : null;
}

/** In the folder of the package; without one, beside this module where that has an address. */
function addressIn(base: string | null, path: string): string {
  const folder =
    base === null
      ? new URL(/* @vite-ignore */ "../", originOfModule())
      : new URL(`${base.replace(/\/$/, "")}/`, document.baseURI);
  return new URL(path, folder).href;
}

/** A notebook reads the module as text: then it has no address of its own. */
function originOfModule(): string {
  return import.meta.url.startsWith("blob:") ? document.baseURI : import.meta.url;
}

function blobUrl(content: string | Uint8Array<ArrayBuffer>, type: string): string {
  return URL.createObjectURL(new Blob([content], { type }));
}

export default { render };
