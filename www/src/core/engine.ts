/**
 * The worker's other end: calls as promises. Cancelling terminates the worker; whoever uses the engine
 * then opens it again and replays its inputs.
 */
import wasmUrl from "../pkg/ridgeline_bg.wasm?url";
import type {
  Args,
  CallName,
  FailureKind,
  Queries,
  QueryName,
  Reply,
  Request,
  Result,
} from "../shared/messages";
import type { OrientationCheckReport } from "../shared/results";

/** A call that the worker rejected, or that was cut short. */
export class EngineError extends Error {
  readonly kind: FailureKind | "cancelled";
  readonly orientationCheck: OrientationCheckReport | null;

  constructor(
    message: string,
    kind: FailureKind | "cancelled",
    orientationCheck: OrientationCheckReport | null = null,
  ) {
    super(message);
    this.kind = kind;
    this.orientationCheck = orientationCheck;
  }
}

interface Pending {
  resolve: (value: never) => void;
  reject: (error: EngineError) => void;
}

export class Engine {
  #worker: Worker | undefined;
  #pending = new Map<number, Pending>();
  #lastId = 0;
  readonly #onProgress: (stage: string, fraction: number) => void;

  constructor(onProgress: (stage: string, fraction: number) => void) {
    this.#onProgress = onProgress;
  }

  /** Whether a worker with a core exists, or is being made. */
  get isOpen(): boolean {
    return this.#worker !== undefined;
  }

  /** Starts a worker and compiles the core. */
  open(): Promise<Result<"open">> {
    this.#worker = new Worker(new URL("../worker/main.ts", import.meta.url), { type: "module" });
    this.#worker.onmessage = (event: MessageEvent<Reply>) => this.#receive(event.data);
    this.#worker.onerror = (event) => {
      event.preventDefault();
      this.close(new EngineError(event.message || "The worker could not be started.", "crash"));
    };
    return this.call("open", { wasmUrl: new URL(wasmUrl, document.baseURI).href });
  }

  /** What `transfer` names moves to the worker instead of being copied. */
  call<K extends CallName>(
    type: K,
    args: Args<K>,
    transfer: readonly Transferable[] = [],
  ): Promise<Result<K>> {
    const worker = this.#worker;
    if (worker === undefined) {
      return Promise.reject(new EngineError("No worker is running.", "cancelled"));
    }
    this.#lastId += 1;
    const id = this.#lastId;
    return new Promise((resolve, reject) => {
      this.#pending.set(id, { resolve, reject });
      worker.postMessage({ type, id, args } as Request, [...transfer]);
    });
  }

  /** Asks something about the results. */
  async ask<K extends QueryName>(query: K, ...of: Queries[K]["args"]): Promise<Queries[K]["result"]> {
    return (await this.call("ask", { query, of })) as Queries[K]["result"];
  }

  /** Ends the worker at once, whatever it is doing; every open call fails with `reason`. */
  close(reason = new EngineError("Cancelled.", "cancelled")): void {
    this.#worker?.terminate();
    this.#worker = undefined;
    const pending = [...this.#pending.values()];
    this.#pending.clear();
    for (const { reject } of pending) {
      reject(reason);
    }
  }

  #receive(reply: Reply): void {
    if (reply.type === "progress") {
      this.#onProgress(reply.stage, reply.fraction);
      return;
    }
    const pending = this.#pending.get(reply.id);
    this.#pending.delete(reply.id);
    if (reply.type === "done") {
      pending?.resolve(reply.result as never);
      return;
    }
    const error = new EngineError(reply.message, reply.kind, reply.orientationCheck);
    pending?.reject(error);
    if (reply.kind === "crash") {
      this.close(error);
    }
  }
}
