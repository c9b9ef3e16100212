/** The stages as the page names them. The core gives their order; this gives them words. */
import type { Tab } from "../state/methods";

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
  regions: { title: "Regions", section: "W96 3.3", tab: "regions" },
  directions: { title: "Directions", section: "W96 3.4", tab: "directions" },
  clusters: { title: "Clusters", section: "W96 3.5", tab: "clusters" },
  rectangles: { title: "Rectangles", section: "W96 3.6", tab: "rectangles" },
  model: { title: "Model", section: "walls, texture, files", tab: "model" },
};

/** The words for a stage; one that the page does not know is shown by its own name. */
export function stageWords(name: string): StageWords {
  return WORDS[name] ?? { title: name, section: "", tab: "model" };
}

/**
 * The stage whose result a parameter changes first, by the longest path that fits: as `Run::set_params` has it.
 * Windows are found with clusters and the ground, too.
 */
const STAGE_OF: Record<string, string> = {
  segments: "segments",
  matching: "matches",
  // Matching fits 3D lines too, to tell which segments agree.
  lines3d: "matches",
  sweep: "halfplanes",
  roof: "facets",
  "objectspace.oris": "regions",
  "objectspace.windows": "directions",
  "objectspace.directions": "directions",
  "objectspace.clusters": "directions",
  "objectspace.planes": "rectangles",
  "objectspace.planes.min_height_m": "directions",
  texture: "model",
};

/** The first stage that a change of the parameter at `path` makes outdated; an unknown one outdates everything. */
export function firstStageOf(path: string, stageNames: readonly string[]): number {
  const parts = path.split(".");
  for (let count = parts.length; count > 0; count -= 1) {
    const stage = STAGE_OF[parts.slice(0, count).join(".")];
    if (stage !== undefined) {
      const index = stageNames.indexOf(stage);
      // A stage of the other method: nothing here depends on it.
      return index < 0 ? stageNames.length : index;
    }
  }
  return 0;
}
