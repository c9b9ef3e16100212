/** The stages as the page names them. The core gives their order; this gives them words. */
import type { Tab } from "./state";

interface StageWords {
  title: string;
  section: string;
  /** The tab that shows its result. */
  tab: Tab;
}

const WORDS: Record<string, StageWords> = {
  segments: { title: "Segments", section: "B99 3.2", tab: "segments" },
  matches: { title: "Matches", section: "B99 3.1–3.4", tab: "matches" },
  lines: { title: "3D lines", section: "B99 3.2, fig. 4", tab: "lines" },
  halfplanes: { title: "Half-planes", section: "B99 4.1", tab: "halfplanes" },
  facets: { title: "Facets", section: "B99 4.2, 4.3", tab: "facets" },
  model: { title: "Model", section: "walls, texture, files", tab: "model" },
};

/** The words for a stage; one that the page does not know is shown by its own name. */
export function stageWords(name: string): StageWords {
  return WORDS[name] ?? { title: name, section: "", tab: "model" };
}

/** The stage whose result each group of parameters changes first. */
const STAGE_OF_GROUP: Record<string, string> = {
  segments: "segments",
  matching: "matches",
  lines3d: "lines",
  sweep: "halfplanes",
  roof: "facets",
  texture: "model",
};

/** The first stage that a change in `group` makes outdated; an unknown group outdates everything. */
export function firstStageOf(group: string, stageNames: readonly string[]): number {
  const index = stageNames.indexOf(STAGE_OF_GROUP[group] ?? "");
  return Math.max(0, index);
}
