/** What stands around an exercise: its title and paper, what is to be done, and what is said of an answer. */
import type { ComponentChildren } from "preact";
import { spelledOut } from "../../app/words/papers";
import type { About, Verdict } from "../judging/about";

interface Props {
  about: About;
  /** What is said of an answer; null before one is given. */
  said: ComponentChildren;
  children: ComponentChildren;
}

export function ExerciseFrame({ about: { title, source }, said, children }: Props) {
  return (
    <section class="frame" aria-label={title}>
      <p class="title">
        {title} <span class="muted">{spelledOut(source)}</span>
      </p>
      {children}
      <div role="status">{said}</div>
    </section>
  );
}

export function Said({ verdict, right }: { verdict: Verdict; right: string }) {
  return verdict.kind === "right" ? (
    <p class="said right">{right}</p>
  ) : (
    <p class="said wrong">
      {verdict.kind === "mistake" && <strong>{verdict.name} </strong>}
      {verdict.says}
    </p>
  );
}
