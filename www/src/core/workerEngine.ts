/**
 * The worker's other end: calls as promises. Cancelling terminates the worker; whoever uses the engine
 * then opens it again and replays its inputs.
 */
import type { Args, CallName, Result } from "../shared/calls";
import type { FailureKind, Outcome, Request, Told } from "../shared/messages";
import type { AgreementReport } from "../shared/records";

/** A call that the worker rejected, or that was cut short. */
export class EngineError extends Error {
  readonly kind: FailureKind | "cancelled";
  readonly orientationCheck: AgreementReport | null;
  /** The stage that was running, in words. */
  during: string | null = null;

  constructor(
    message: string,
    kind: FailureKind | "cancelled",
    orientationCheck: AgreementReport | null = null,
  ) {
    super(message);
    this.kind = kind;
    this.orientationCheck = orientationCheck;
  }
}

/** Did the core stop for good? */
export function isFatal(kind: EngineError["kind"]): boolean {
  return kind === "crash" || kind === "memory";
}

/** A request as it is made, before it is sent. */
type Unnumbered<R> = R extends unknown ? Omit<R, "id"> : never;

interface Waiting {
  resolve: (value: never) => void;
  reject: (error: EngineError) => void;
}

/** A worker's other end: requests as promises of their answers, until it ends. */
export class WorkerEnd<Made extends { id: number }, Told extends { type: string }> {
  readonly #worker: Worker;
  readonly #waiting = new Map<number, Waiting>();
  readonly #onEnd: (reason: EngineError) => void;
  #lastId = 0;

  /**
   * @param onTold hears what is no answer
   * @param onEnd hears that the worker has ended of itself
   */
  constructor(worker: Worker, onTold: (told: Told) => void, onEnd: (reason: EngineError) => void) {
    this.#worker = worker;
    this.#onEnd = onEnd;
    worker.onmessage = ({ data }: MessageEvent<Outcome | Told>) => {
      if ("id" in data) {
        this.#settle(data);
      } else {
        onTold(data);
      }
    };
    worker.onerror = (event) => {
      event.preventDefault();
      this.#fail(new EngineError(event.message || "the worker could not be started", "crash"));
    };
  }

  /** How many requests wait for their answers. */
  get waiting(): number {
    return this.#waiting.size;
  }

  /** What `transfer` names moves to the worker instead of being copied. */
  ask<T>(request: Unnumbered<Made>, transfer: readonly Transferable[] = []): Promise<T> {
    this.#lastId += 1;
    const id = this.#lastId;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject });
      this.#worker.postMessage({ ...request, id }, [...transfer]);
    });
  }

  /** Ends the worker at once, whatever it is doing; all requests that wait fail with `reason`. */
  end(reason: EngineError): void {
    this.#worker.terminate();
    const waiting = [...this.#waiting.values()];
    this.#waiting.clear();
    for (const { reject } of waiting) {
      reject(reason);
    }
  }

  #settle(outcome: Outcome): void {
    const waiting = this.#waiting.get(outcome.id);
    this.#waiting.delete(outcome.id);
    if (outcome.type === "done") {
      waiting?.resolve(outcome.result as never);
      return;
    }
    const error = new EngineError(outcome.message, outcome.kind, outcome.orientationCheck);
    waiting?.reject(error);
    if (isFatal(outcome.kind)) {
      this.#fail(error);
    }
  }

  #fail(reason: EngineError): void {
    this.end(reason);
    this.#onEnd(reason);
  }
}

/** Where the worker and the core come from. */
export interface CoreSource {
  startWorker(): Worker;
  /** Absolute. */
  wasmUrl: string;
}

export class WorkerEngine {
  readonly #source: CoreSource;
  #worker: WorkerEnd<Request, Told> | undefined;
  readonly #onProgress: (stage: string, fraction: number) => void;
  readonly #mayAsk: () => boolean;

  /** While `mayAsk` says no, requests fail as if the worker had been ended. */
  constructor(
    source: CoreSource,
    onProgress: (stage: string, fraction: number) => void,
    mayAsk = () => true,
  ) {
    this.#source = source;
    this.#onProgress = onProgress;
    this.#mayAsk = mayAsk;
  }

  /** Whether requests are waiting for their answers. */
  get isWorking(): boolean {
    return (this.#worker?.waiting ?? 0) > 0;
  }

  /** Whether a worker with a core exists, or is being made. */
  get isOpen(): boolean {
    return this.#worker !== undefined;
  }

  /** Starts a worker and compiles the core. */
  open(): Promise<void> {
    const end = new WorkerEnd<Request, Told>(
      this.#source.startWorker(),
      ({ stage, fraction }) => this.#onProgress(stage, fraction),
      () => {
        // Another one may have been opened since.
        if (this.#worker === end) {
          this.#worker = undefined;
        }
      },
    );
    this.#worker = end;
    return this.#send({ type: "open", wasmUrl: this.#source.wasmUrl }, []);
  }

  call<K extends CallName>(name: K, ...args: Args<K>): Promise<Result<K>> {
    return this.callMoving([], name, ...args);
  }

  /** What `transfer` names moves to the worker instead of being copied. */
  callMoving<K extends CallName>(
    transfer: readonly Transferable[],
    name: K,
    ...args: Args<K>
  ): Promise<Result<K>> {
    return this.#send({ type: "call", name, args }, transfer);
  }

  #send<T>(request: Unnumbered<Request>, transfer: readonly Transferable[]): Promise<T> {
    const worker = this.#worker;
    if (worker === undefined || !this.#mayAsk()) {
      return Promise.reject(new EngineError("No worker is running.", "cancelled"));
    }
    return worker.ask(request, transfer);
  }

  /** Ends the worker at once, whatever it is doing; every open call fails with `reason`. */
  close(reason = new EngineError("Cancelled.", "cancelled")): void {
    this.#worker?.end(reason);
    this.#worker = undefined;
  }
}
