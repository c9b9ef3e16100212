/** The engine of the page: its worker and its core are part of the site. */
import wasmUrl from "../pkg/ridgeline_bg.wasm?url";
import { type CoreSource, WorkerEngine } from "./workerEngine";

export { EngineError, isFatal, WorkerEnd } from "./workerEngine";
export { OF_SITE };

/** Changes with every other core that is built: what one found, another may not find. */
export const CORE_VERSION: string = import.meta.env.PROD
  ? wasmUrl.slice(wasmUrl.lastIndexOf("/") + 1)
  : String(performance.timeOrigin);

/** The site's own worker and core. */
const OF_SITE: CoreSource = {
  startWorker: () => new Worker(new URL("../worker/main.ts", import.meta.url), { type: "module" }),
  get wasmUrl() {
    return new URL(wasmUrl, document.baseURI).href;
  },
};

export class Engine extends WorkerEngine {
  /** While `mayAsk` says no, requests fail as if the worker had been ended. */
  constructor(onProgress: (stage: string, fraction: number) => void, mayAsk?: () => boolean) {
    super(OF_SITE, onProgress, mayAsk);
  }
}
