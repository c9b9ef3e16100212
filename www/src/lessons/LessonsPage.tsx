/** The frame of the lessons: where one is, and the contents. */

import { spelledOut } from "../app/words/papers";
import { TeachingHead } from "../app/words/TeachingHead";
import { lesson, linkTo } from "./address";
import { LESSONS } from "./catalogue";
import { LessonView } from "./LessonView";
import type { Lesson } from "./parts/lesson";
import { keyOf, seen } from "./progress";
import { SceneBar } from "./scene/SceneBar";

export function LessonsPage() {
  const now = lesson.value;
  return (
    <div class="lessons">
      <TeachingHead now={now === null ? "Lessons" : null} />
      <main>{now === null ? <Contents /> : <LessonView key={now.id} lesson={now} />}</main>
    </div>
  );
}

function Contents() {
  return (
    <div class="contents">
      <h1>Ten lessons of multi-view geometry</h1>
      <p>
        From one photograph to a roof, in the order in which the subject is taught. Every figure moves: guess
        first, then look. A drawn house comes first, then whole photographs: your own project where one is
        open, otherwise the demo scene.
      </p>
      <ol>
        {LESSONS.map((one) => (
          <Entry key={one.id} lesson={one} />
        ))}
      </ol>
      <SceneBar />
    </div>
  );
}

function Entry({ lesson: { id, title, aim, minutes, papers, screens } }: { lesson: Lesson }) {
  const done = screens.filter((screen) => seen.value.has(keyOf(id, screen.id))).length;
  return (
    <li>
      <a href={linkTo(id)}>
        <strong>{title}</strong>
        <span>{aim}</span>
        <span class="muted numbers">
          {minutes} minutes · {spelledOut(papers)} ·{" "}
          {done === 0 ? `${screens.length} screens` : `${done} of ${screens.length} screens seen`}
        </span>
      </a>
    </li>
  );
}
