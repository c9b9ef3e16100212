/** What every worker does with a call: finds who answers it, and what moves to the page with the answer. */

export interface Answer {
  result: unknown;
  transfer: Transferable[];
}

/** Answers a call by its name: one of the worker's own, or one of the core. */
export async function answer(
  own: object,
  core: object,
  { name, args }: { name: string; args: readonly unknown[] },
): Promise<Answer> {
  const target = name in own ? own : core;
  const method: unknown = Reflect.get(target, name);
  if (typeof method !== "function") {
    throw new Error(`There is no call '${name}'.`);
  }
  const result: unknown = await Reflect.apply(method, target, args);
  return { result, transfer: transferOf(result) };
}

/** Records of the core have large arrays under these names. */
const ARRAYS = ["rgba", "glb", "points", "colours"];

/** Arrays that the core hands out are copies of its memory, so their buffers may move. */
export function transferOf(result: unknown): Transferable[] {
  if (ArrayBuffer.isView(result)) {
    return [result.buffer as ArrayBuffer];
  }
  if (typeof ImageBitmap !== "undefined" && result instanceof ImageBitmap) {
    return [result];
  }
  return typeof result === "object" && result !== null
    ? ARRAYS.flatMap((name) => transferOf((result as Record<string, unknown>)[name]))
    : [];
}

/** Progress is a message at most every so often: the page cannot draw more. */
const PROGRESS_INTERVAL_MS = 40;

/** Passes progress on, but not more often than the page can draw it. */
export function throttled(tell: (fraction: number) => void): (fraction: number) => void {
  let last = 0;
  return (fraction) => {
    const now = performance.now();
    if (now - last >= PROGRESS_INTERVAL_MS || fraction >= 1) {
      last = now;
      tell(fraction);
    }
  };
}
