import { describe, expect, it } from "vitest";
import { failureOf } from "../../../src/worker/failures";

const PANIC =
  "panicked at src/planes/hypotheses/hypothesis.rs:41:9:\nindex out of bounds: the len is 9 but the index is 9";
const trap = (words: string) => new WebAssembly.RuntimeError(words);

describe("why a call failed", () => {
  it("is what the core said last, with its place, where it stopped", () => {
    expect(failureOf(trap("unreachable"), PANIC)).toEqual({
      kind: "crash",
      message:
        "index out of bounds: the len is 9 but the index is 9 (src/planes/hypotheses/hypothesis.rs, line 41)",
      orientationCheck: null,
    });
  });

  it("is memory only where memory ran out", () => {
    const kindOf = (error: Error, words: string | null = null) => failureOf(error, words).kind;
    expect(kindOf(trap("unreachable"))).toBe("memory");
    expect(kindOf(trap("unreachable executed"))).toBe("memory");
    expect(kindOf(new RangeError("Array buffer allocation failed"))).toBe("memory");
    expect(
      kindOf(new RangeError("WebAssembly.instantiate(): Out of memory: Cannot allocate Wasm memory")),
    ).toBe("memory");
    expect(kindOf(trap("memory access out of bounds"))).toBe("crash");
    expect(kindOf(new RangeError("Maximum call stack size exceeded"))).toBe("crash");
    expect(kindOf(trap("unreachable"), PANIC)).toBe("crash");
    expect(kindOf(new RangeError("there is no line 7"))).toBe("internal");
  });

  it("keeps the core's refusals as they are", () => {
    const refusal = Object.assign(new Error("a.pdf: a PDF, no image; save its pages"), {
      name: "InputError",
    });
    expect(failureOf(refusal, null)).toMatchObject({ kind: "input", message: refusal.message });
  });
});
