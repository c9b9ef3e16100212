/** One lesson: its screens one after the other, and the way between them. */

import { useEffect, useRef } from "preact/hooks";
import { spelledOut } from "../app/words/papers";
import { CONTENTS, goTo, linkTo, screenIndex } from "./address";
import { LESSONS } from "./catalogue";
import { isHandout, toggleHandout } from "./handout";
import type { Lesson } from "./parts/lesson";
import { keyOf, markSeen, seen } from "./progress";
import { ScreenView } from "./ScreenView";

/** Arrows, and what the remote controls of projectors send. */
const KEYS: Readonly<Record<string, 1 | -1>> = { ArrowRight: 1, PageDown: 1, ArrowLeft: -1, PageUp: -1 };

export function LessonView({ lesson }: { lesson: Lesson }) {
  const index = screenIndex.value;
  const { id, title, screens, papers } = lesson;
  const screen = screens[index];
  const number = LESSONS.indexOf(lesson) + 1;
  const top = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (screen !== undefined) {
      markSeen(keyOf(id, screen.id));
      document.title = `${screen.title} · ${title} · ridgeline`;
    }
    top.current?.scrollIntoView({ block: "start" });
  }, [id, screen, title]);
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      const by = KEYS[event.key] ?? 0;
      // Where there is more below, the keys of pages scroll as everywhere.
      const isScrolling = event.key.startsWith("Page") && document.body.scrollHeight > window.innerHeight;
      if (by !== 0 && !isScrolling && !isHandout.peek() && !ownsKeys(event)) {
        event.preventDefault();
        goTo(screenIndex.peek() + by);
      }
    };
    window.addEventListener("keydown", onKey);
    return () => window.removeEventListener("keydown", onKey);
  }, []);
  return (
    <div class="lesson-view" ref={top}>
      <div class="lesson-title">
        <h1>
          <span class="muted">{number}</span> {title}
        </h1>
        <span class="muted">{spelledOut(papers)}</span>
        <a href={`./exercises.html#${id}`}>Its exercises</a>
        <button
          type="button"
          class="quiet handout-button"
          aria-pressed={isHandout.value}
          onClick={toggleHandout}
        >
          Hand-out
        </button>
      </div>
      {isHandout.value
        ? screens.map((one) => <ScreenView key={one.id} lesson={id} screen={one} isOnPaper />)
        : screen !== undefined && (
            <ScreenView key={screen.id} lesson={id} screen={screen} isOnPaper={false} />
          )}
      <p class="visually-hidden" role="status">
        {screen?.title}
      </p>
      {!isHandout.value && <Ways lesson={lesson} index={index} />}
    </div>
  );
}

/** What moves a control does not turn the screen. */
function ownsKeys({ target, altKey, ctrlKey, metaKey }: KeyboardEvent): boolean {
  return (
    altKey ||
    ctrlKey ||
    metaKey ||
    (target instanceof Element &&
      target.closest("input, select, textarea, [role=slider], ridgeline-figure") !== null)
  );
}

function Ways({ lesson: { id, screens }, index }: { lesson: Lesson; index: number }) {
  const place = LESSONS.findIndex((one) => one.id === id);
  const [before, after] = [LESSONS[place - 1], LESSONS[place + 1]];
  const [previous, next] = [screens[index - 1], screens[index + 1]];
  const contents = { href: CONTENTS, text: "Contents" };
  const back =
    previous !== undefined
      ? { rel: "prev", href: linkTo(id, previous.id), text: "Back" }
      : before !== undefined
        ? { href: linkTo(before.id), text: `Lesson ${place}` }
        : contents;
  const on =
    next !== undefined
      ? { rel: "next", href: linkTo(id, next.id), text: "Next" }
      : after !== undefined
        ? { rel: "next", href: linkTo(after.id), text: `Lesson ${place + 2}: ${after.title}` }
        : contents;
  return (
    <nav class="ways" aria-label="Screens">
      <Way class="way" {...back} />
      <ol>
        {screens.map((screen, i) => (
          <li key={screen.id}>
            <a
              href={linkTo(id, screen.id)}
              aria-current={i === index ? "step" : undefined}
              class={seen.value.has(keyOf(id, screen.id)) ? "seen" : ""}
              title={screen.title}
            >
              <span class="visually-hidden">{screen.title}</span>
            </a>
          </li>
        ))}
      </ol>
      <Way class="way next" {...on} />
    </nav>
  );
}

function Way({ text, ...of }: { text: string; href: string; rel?: string; class: string }) {
  return <a {...of}>{text}</a>;
}
