/** An exercise sheet: one HTML file that prints, without answers or with them. */
import { escaped, plain } from "../../app/words/linkedText";
import { spelledOut } from "../../app/words/papers";
import { type AnyExercise, mistakesOf, taskText } from "../exercises";
import { LESSONS } from "../judging/about";
import { drawOf } from "../judging/judgeNumber";
import { quantityText } from "../judging/quantity";

export interface Sheet {
  exercises: readonly AnyExercise[];
  /** Draws the values of all numbers. */
  seed: number;
  /** Address of the page of the exercises. */
  page: string;
  /** Of the exercises in figures, as the demo scene has them; null: without answers. */
  answers: ReadonlyMap<string, string> | null;
}

const STYLE = `
@page { size: A4; margin: 18mm; }
body { max-width: 44em; margin: 2em auto; padding: 0 1em; font: 11pt/1.45 "Noto Sans", "Liberation Sans", sans-serif; color: #111; background: #fff; }
h1 { font-size: 16pt; } h2 { margin: 0 0 .2em; font-size: 12pt; }
section { margin: 1.6em 0; break-inside: avoid; }
small { color: #555; font-weight: 400; }
pre { padding: .6em; border: 1px solid #bbb; white-space: pre-wrap; overflow-wrap: anywhere; font-size: 9pt; }
.blank { height: 6em; border-bottom: 1px solid #bbb; }
.code { height: 14em; }
.answer { padding: .2em .8em; border-left: 3px solid #111; }
@media print { body { margin: 0; padding: 0; } a { color: inherit; text-decoration: none; } }
`;

/** The whole file. */
export function sheetOf(sheet: Sheet): string {
  const title = `Exercises, sheet ${sheet.seed}${sheet.answers === null ? "" : ", with answers"}`;
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>${title}</title>
<style>${STYLE}</style>
<h1>${title}</h1>
${sheet.answers === null ? "<p>Name: ____________________________</p>" : ""}
${sheet.exercises.map((one, i) => sectionOf(one, i, sheet)).join("\n")}
</html>
`;
}

function sectionOf(exercise: AnyExercise, place: number, sheet: Sheet): string {
  const { title, source, lesson } = exercise;
  const head = `${place + 1}. ${title} <small>${LESSONS[lesson]}, ${spelledOut(source)}</small>`;
  return `<section>
<h2>${head}</h2>
${taskOf(exercise, sheet)}
${sheet.answers === null ? "" : answerOf(exercise, sheet)}
</section>`;
}

function taskOf(exercise: AnyExercise, { seed, page, answers }: Sheet): string {
  const address = escaped(`${page}?seed=${seed}#${exercise.name}`);
  const isCode = exercise.kind === "function";
  const more = isCode
    ? `<pre>${escaped(exercise.starter)}</pre>\n`
    : exercise.kind === "figure"
      ? `<p>In the figure: <a href="${address}">${address}</a></p>\n`
      : "";
  const blank = answers === null ? `<div class="blank${isCode ? " code" : ""}"></div>` : "";
  return `<p>${escaped(plain(taskText(exercise, seed)))}</p>\n${more}${blank}`;
}

function answerOf(exercise: AnyExercise, { seed, answers }: Sheet): string {
  const mistakes = mistakesOf(exercise)
    .map(({ name }) => name)
    .join(", ");
  return `<div class="answer">${answerText(exercise, seed, answers)}
<p><small>Mistakes that are recognised: ${escaped(mistakes)}.</small></p></div>`;
}

function answerText(exercise: AnyExercise, seed: number, answers: Sheet["answers"]): string {
  if (exercise.kind === "function") {
    return `<pre>${escaped(exercise.solution)}</pre>`;
  }
  const { value, solution } =
    exercise.kind === "number" ? drawOf(exercise, seed) : { value: 0, solution: exercise.solution };
  const answer =
    exercise.kind === "number" ? quantityText({ value, unit: exercise.unit }) : answers?.get(exercise.name);
  return `<p><strong>${escaped(answer ?? "")}</strong> ${escaped(solution)}</p>`;
}
