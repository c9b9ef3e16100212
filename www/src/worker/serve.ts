/** What every worker does with its requests: one after the other, each with one reply. */
import type { Outcome } from "../shared/messages";
import type { Answer } from "./answering";
import { failureOf } from "./failures";

/** Answers the requests of the page with what `perform` makes of them, by `post`. */
export function serve<R extends { id: number }>(
  perform: (request: R) => Promise<Answer>,
  post: (outcome: Outcome, transfer: Transferable[]) => void,
): void {
  // What the core wrote to the console last: a panic's message, of which the trap behind it says nothing.
  let lastWords: string | null = null;
  const write = console.error.bind(console);
  console.error = (...words: unknown[]) => {
    lastWords = String(words[0]);
    write(...words);
  };
  const reply = async (request: R) => {
    lastWords = null;
    try {
      const { result, transfer } = await perform(request);
      post({ type: "done", id: request.id, result }, transfer);
    } catch (error) {
      post({ type: "failed", id: request.id, ...failureOf(error, lastWords) }, []);
    }
  };
  let queue: Promise<void> = Promise.resolve();
  self.onmessage = (event: MessageEvent<R>) => {
    queue = queue.then(() => reply(event.data));
  };
}
