/** docs/exercises.md: all exercises by lesson, for `npm run lists`. */
import { EXERCISES, KIND_WORDS, mistakesOf } from "../src/exercise/exercises";
import { LESSONS, type Lesson } from "../src/exercise/judging/about";

export function exercisesPage(): string {
  const lessons = Object.keys(LESSONS) as Lesson[];
  return `# Exercises

What each asks and how answers are judged: [teaching.md](teaching.md). This page is written by \`npm run lists\` (in www/) from
[www/src/exercise](../www/src/exercise/exercises.ts).
${lessons.map(sectionOf).join("")}`;
}

function sectionOf(lesson: Lesson): string {
  const rows = EXERCISES.filter((one) => one.lesson === lesson).map((exercise) => {
    const mistakes = mistakesOf(exercise).map(({ name }) => name);
    const { name, title, kind, source } = exercise;
    return `| \`${name}\` | ${title} | ${KIND_WORDS[kind]} | ${source} | ${mistakes.join("; ")} |\n`;
  });
  return `
## ${LESSONS[lesson]}

| name | title | done in | section | mistakes that it knows |
|---|---|---|---|---|
${rows.join("")}`;
}
