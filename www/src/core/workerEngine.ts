/**
 * The worker's other end: calls as promises. Cancelling terminates the worker; whoever uses the engine
 * then opens it again and replays its inputs.
 */
import type { Args, CallName, Result } from "../shared/calls";
import type { FailureKind, Outcome, Reply, Request } from "../shared/messages";
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

/** The requests of a worker that wait for their answers. */
export class PendingCalls {
  readonly #waiting = new Map<number, Waiting>();
  #lastId = 0;

  get size(): number {
    return this.#waiting.size;
  }

  /** The promise of the answer to the request that `send` sends with its number. */
  ask<T>(send: (id: number) => void): Promise<T> {
    this.#lastId += 1;
    const id = this.#lastId;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject });
      send(id);
    });
  }

  /** Keeps the promise of an answer; returns the error after which the worker is of no more use. */
  settle(outcome: Outcome): EngineError | null {
    const waiting = this.#waiting.get(outcome.id);
    this.#waiting.delete(outcome.id);
    if (outcome.type === "done") {
      waiting?.resolve(outcome.result as never);
      return null;
    }
    const error = new EngineError(outcome.message, outcome.kind, outcome.orientationCheck);
    waiting?.reject(error);
    return isFatal(outcome.kind) ? error : null;
  }

  /** All that wait fail with `reason`. */
  rejectAll(reason: EngineError): void {
    const waiting = [...this.#waiting.values()];
    this.#waiting.clear();
    for (const { reject } of waiting) {
      reject(reason);
    }
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
  #worker: Worker | undefined;
  readonly #pending = new PendingCalls();
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
    return this.#pending.size > 0;
  }

  /** Whether a worker with a core exists, or is being made. */
  get isOpen(): boolean {
    return this.#worker !== undefined;
  }

  /** Starts a worker and compiles the core. */
  open(): Promise<void> {
    this.#worker = this.#source.startWorker();
    this.#worker.onmessage = (event: MessageEvent<Reply>) => this.#receive(event.data);
    this.#worker.onerror = (event) => {
      event.preventDefault();
      this.close(new EngineError(event.message || "the worker could not be started", "crash"));
    };
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
    return this.#pending.ask((id) => worker.postMessage({ ...request, id }, [...transfer]));
  }

  /** Ends the worker at once, whatever it is doing; every open call fails with `reason`. */
  close(reason = new EngineError("Cancelled.", "cancelled")): void {
    this.#worker?.terminate();
    this.#worker = undefined;
    this.#pending.rejectAll(reason);
  }

  #receive(reply: Reply): void {
    if (reply.type === "progress") {
      this.#onProgress(reply.stage, reply.fraction);
      return;
    }
    const fatal = this.#pending.settle(reply);
    if (fatal !== null) {
      this.close(fatal);
    }
  }
}
