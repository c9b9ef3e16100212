/** The head over lessons, exercises, glossary and the page for teachers: four parts of one place. */
import "./teachingHead.css";
import { LookButtons } from "../parts/LookButtons";

const PARTS = [
  ["Lessons", "./lessons.html#"],
  ["Exercises", "./exercises.html"],
  ["Glossary", "./exercises.html#glossary"],
  ["For teachers", "./exercises.html?teacher"],
] as const;

export function TeachingHead({ now }: { now: (typeof PARTS)[number][0] | null }) {
  return (
    <header class="teaching-head">
      <a class="home" href="./">
        <img src="./icon.svg" alt="" width="22" height="22" />
        ridgeline
      </a>
      <nav aria-label="Pages">
        {PARTS.map(([title, href]) => (
          <a key={title} href={href} aria-current={title === now ? "page" : undefined}>
            {title}
          </a>
        ))}
      </nav>
      <span class="grow" />
      <LookButtons />
    </header>
  );
}
