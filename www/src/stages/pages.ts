/** What only the page has of the stages, from their folders. */
import { STAGE_FACTS, type Tab } from "./list";
import type { SpaceLayer, StagePage } from "./stagePage";

const found = import.meta.glob<StagePage>("./*/page.tsx", { eager: true, import: "default" });

export function pageOf(tab: Tab): StagePage {
  return found[`./${tab}/page.tsx`] ?? {};
}

/** The layers of all stages, in the order of these. */
export const STAGE_LAYERS: Readonly<Record<string, SpaceLayer>> = Object.assign(
  {},
  ...Object.keys(STAGE_FACTS).map((name) => pageOf(name as Tab).layers),
);
