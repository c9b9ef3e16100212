/** An exercise that is done in a live figure of the demo scene. */
import { useEffect, useRef, useState } from "preact/hooks";
import { Linked } from "../../app/words/Term";
import type { RidgelineFigure } from "../../element/RidgelineFigure";
import { type Asked, type FigureAnswer, type FigureExercise, judgeFigure } from "../figures/judgeFigure";
import { isDemo } from "../figures/truth";
import type { Verdict } from "../judging/about";
import { AnswerField } from "./AnswerField";
import { ExerciseFrame, Said } from "./ExerciseFrame";
import type { ViewProps } from "./view";

export function FigureView(props: ViewProps<FigureExercise>) {
  const { exercise, base, theme, onWritten, onVerdict, needFigure } = props;
  const written = props.written ?? "";
  const [figure, setFigure] = useState<Asked | null>(null);
  const [verdict, setVerdict] = useState<Verdict | null>(null);
  const [problem, setProblem] = useState<string | null>(null);
  const place = useRef<HTMLDivElement>(null);
  const begin = async (of: RidgelineFigure) => {
    if (isDemo(of.shown)) {
      const asked = askedOf(of);
      of.state = await exercise.begin(asked);
      setFigure(asked);
    } else {
      setProblem("The exercises are about the demo scene, and this is another one.");
    }
  };
  useEffect(() => {
    const host = place.current;
    let isGone = false;
    // Made by hand: its class comes with another module, later than this.
    void needFigure().then(
      () => {
        if (!isGone) {
          const made = figureElement(exercise, base, (of) => void begin(of));
          setTheme(made, theme);
          host?.replaceChildren(made);
        }
      },
      () => setProblem("The figure cannot be fetched: figure.js must be served beside exercise.js."),
    );
    return () => {
      isGone = true;
      host?.replaceChildren();
    };
  }, [exercise, base]);
  useEffect(() => setTheme(place.current?.firstElementChild, theme), [theme]);
  const check = async (given: string) => {
    if (figure !== null) {
      const found = await judgeFigure(exercise, figure, given);
      setVerdict(found);
      onVerdict(found);
    }
  };
  const again = () => {
    const made = place.current?.firstElementChild as RidgelineFigure | null;
    if (made !== null && figure !== null) {
      void begin(made);
      onWritten("");
      setVerdict(null);
    }
  };
  const { asks } = exercise;
  return (
    <ExerciseFrame about={exercise} said={verdict !== null && <Said verdict={verdict} right="Right." />}>
      <p>
        <Linked text={exercise.text} />
      </p>
      {problem !== null && (
        <p class="said wrong" role="alert">
          {problem}
        </p>
      )}
      <div class="place" ref={place} />
      {asks.by === "number" && (
        <AnswerField
          label="Number and unit"
          written={written}
          onWritten={onWritten}
          onCheck={() => void check(written)}
        />
      )}
      {asks.by === "choice" && figure !== null && (
        <fieldset class="choices">
          <legend class="visually-hidden">Answers</legend>
          {asks.choices(figure.shown).map((one) => (
            <label key={one}>
              <input
                type="radio"
                name={exercise.name}
                checked={written === one}
                onChange={() => onWritten(one)}
              />
              {one}
            </label>
          ))}
        </fieldset>
      )}
      <div class="row">
        {asks.by !== "number" && (
          <button
            type="button"
            class="primary"
            disabled={figure === null}
            onClick={() => void check(written)}
          >
            Check
          </button>
        )}
        <button type="button" disabled={figure === null} onClick={again}>
          Begin again
        </button>
        <Solution exercise={exercise} figure={figure} place={place} onWritten={onWritten} />
      </div>
    </ExerciseFrame>
  );
}

/** Exercises take it apart: the element's own method would lose its element. */
function askedOf(figure: RidgelineFigure): Asked {
  return {
    get shown() {
      return figure.shown;
    },
    ask: figure.ask.bind(figure),
  };
}

interface SolutionProps {
  exercise: FigureExercise;
  figure: Asked | null;
  place: { current: HTMLDivElement | null };
  onWritten: (written: string) => void;
}

function Solution({ exercise, figure, place, onWritten }: SolutionProps) {
  const [answer, setAnswer] = useState<FigureAnswer | null>(null);
  const find = () => {
    if (figure !== null) {
      void exercise.answer(figure).then(setAnswer);
    }
  };
  const show = ({ state, given }: FigureAnswer) => {
    const made = place.current?.firstElementChild as RidgelineFigure | null;
    if (state !== undefined && made !== null) {
      made.state = state;
    }
    if (given !== undefined) {
      onWritten(given);
    }
  };
  return (
    <details
      class="solution"
      onToggle={(event) => {
        if (event.currentTarget.open) {
          find();
        }
      }}
    >
      <summary>A solution</summary>
      <p>{exercise.solution}</p>
      {answer !== null && (
        <>
          <p class="answer-words">{answer.words}</p>
          <button type="button" onClick={() => show(answer)}>
            Show it
          </button>
        </>
      )}
    </details>
  );
}

function setTheme(figure: Element | null | undefined, theme: string | null): void {
  if (theme === null) {
    figure?.removeAttribute("theme");
  } else {
    figure?.setAttribute("theme", theme);
  }
}

function figureElement(
  { figure }: FigureExercise,
  base: string | null,
  onReady: (made: RidgelineFigure) => void,
): HTMLElement {
  const made = document.createElement("ridgeline-figure") as RidgelineFigure;
  made.setAttribute("kind", figure);
  if (base !== null) {
    made.setAttribute("base", base);
  }
  made.addEventListener("ridgeline-ready", () => onReady(made));
  return made;
}
