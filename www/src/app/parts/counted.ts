/** Numbers of things in words: the one place that knows singular and plural. */
import { grouped } from "./numberText";

/** The singulars that no rule gives. */
const SINGULARS: Record<string, string> = {
  "pairs of directions": "pair of directions",
  "pairs of lines": "pair of lines",
  matches: "match",
  patches: "patch",
};

/** "1 view", "1,952 segments": the thing is named by its plural, as the core names its counts. */
export function counted(count: number, plural: string): string {
  const singular = SINGULARS[plural] ?? plural.replace(/s$/, "");
  return `${grouped(count)} ${count === 1 ? singular : plural}`;
}
