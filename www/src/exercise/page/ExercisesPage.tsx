/** All exercises by lesson, the one that is chosen, and the glossary. The chosen one is what stands behind "#" in the address. */
import "./page.css";
import { useEffect, useRef, useState } from "preact/hooks";
import { counted } from "../../app/parts/counted";
import { theme } from "../../app/state/theme";
import { Glossary } from "../../app/words/Glossary";
import { TeachingHead } from "../../app/words/TeachingHead";
import { type AnyExercise, EXERCISES, exerciseNamed, KIND_WORDS } from "../exercises";
import { LESSONS, type Lesson } from "../judging/about";

const GLOSSARY = "glossary";

export function ExercisesPage({ seed }: { seed: string | null }) {
  const shown = useHash();
  const [done, setDone] = useState<ReadonlySet<string>>(new Set());
  const main = useRef<HTMLElement>(null);
  const isGlossary = shown === GLOSSARY || shown.startsWith("term-");
  const exercise = isGlossary ? null : (exerciseNamed(shown) ?? firstOf(shown));
  useEffect(() => {
    const note = (event: Event) => {
      const { name, right } = (event as CustomEvent<{ name: string; right: boolean }>).detail;
      if (right) {
        setDone((before) => new Set([...before, name]));
      }
    };
    document.addEventListener("ridgeline-checked", note);
    return () => document.removeEventListener("ridgeline-checked", note);
  }, []);
  useEffect(() => {
    if (shown.startsWith("term-")) {
      document.getElementById(shown)?.scrollIntoView();
    }
  }, [shown]);
  return (
    <div class="exercises">
      <TeachingHead now={isGlossary ? "Glossary" : "Exercises"} />
      <h1 class="visually-hidden">{isGlossary ? "Glossary" : "Exercises"}</h1>
      <div class="columns">
        <nav class="contents" aria-label="Exercises">
          <p class="muted">{`${done.size} of ${counted(EXERCISES.length, "exercises")} done`}</p>
          <ol>
            {(Object.keys(LESSONS) as Lesson[]).map((lesson) => (
              <li key={lesson}>
                <h2>{LESSONS[lesson]}</h2>
                <ol>
                  {EXERCISES.filter((one) => one.lesson === lesson).map((one) => (
                    <Entry key={one.name} of={one} isShown={one === exercise} isDone={done.has(one.name)} />
                  ))}
                </ol>
              </li>
            ))}
          </ol>
        </nav>
        <main class="shown" ref={main} tabIndex={-1}>
          {exercise === null ? <Glossary /> : <One exercise={exercise} seed={seed} />}
          {exercise !== null && <Ways exercise={exercise} />}
        </main>
      </div>
    </div>
  );
}

/** Of a lesson, as its name says, or of all. */
function firstOf(lesson: string): AnyExercise | null {
  return EXERCISES.find((one) => one.lesson === lesson) ?? EXERCISES[0] ?? null;
}

/** Where to go on, and the lesson that an exercise belongs to. */
function Ways({ exercise }: { exercise: AnyExercise }) {
  const place = EXERCISES.indexOf(exercise);
  const [before, after] = [EXERCISES[place - 1], EXERCISES[place + 1]];
  return (
    <nav class="ways" aria-label="From here">
      {before === undefined ? <span /> : <a href={`#${before.name}`}>Previous: {before.title}</a>}
      <a href={`./lessons.html#lesson=${exercise.lesson}`}>Lesson: {LESSONS[exercise.lesson]}</a>
      {after === undefined ? <span /> : <a href={`#${after.name}`}>Next: {after.title}</a>}
    </nav>
  );
}

function Entry({ of, isShown, isDone }: { of: AnyExercise; isShown: boolean; isDone: boolean }) {
  return (
    <li>
      <a href={`#${of.name}`} aria-current={isShown ? "page" : undefined}>
        {of.title}
      </a>{" "}
      <span class="muted">
        {KIND_WORDS[of.kind]}
        {isDone && " · done"}
      </span>
    </li>
  );
}

/** The element itself, so that the page is what it is elsewhere. */
function One({ exercise: { name }, seed }: { exercise: AnyExercise; seed: string | null }) {
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const made = document.createElement("ridgeline-exercise");
    made.setAttribute("name", name);
    if (seed !== null) {
      made.setAttribute("seed", seed);
    }
    made.setAttribute("theme", theme.peek());
    place.current?.replaceChildren(made);
  }, [name, seed]);
  const shade = theme.value;
  useEffect(() => place.current?.firstElementChild?.setAttribute("theme", shade), [shade]);
  return <div ref={place} />;
}

function useHash(): string {
  const read = () => decodeURIComponent(location.hash.slice(1));
  const [hash, setHash] = useState(read);
  useEffect(() => {
    const follow = () => setHash(read());
    window.addEventListener("hashchange", follow);
    return () => window.removeEventListener("hashchange", follow);
  }, []);
  return hash;
}
