/** The methods, and the stage views of each. */

import type { ParamTree } from "../../shared/paramTree";
import { METHODS, type Method, STAGES, type StageName } from "../../shared/stages";

export type { Method };

/** Stages without a view of their own: other views show what they do. */
const SHOWN_BY = { adjustment: "matches", corrections: "model" } as const;
type ShownElsewhere = keyof typeof SHOWN_BY;

/** Views of the stages, and beside them the photographs. */
export type Tab = Exclude<StageName, ShownElsewhere> | "images";

/** The stage views of each method. */
export const TABS: Readonly<Record<Method, readonly Tab[]>> = {
  lines: ["images", ...tabsOf("lines")],
  rectangles: ["images", ...tabsOf("rectangles")],
  combined: ["images", ...tabsOf("combined")],
  // These sweep no half-plane; of that stage they have the ground.
  coplanar: ["images", ...tabsOf("coplanar").filter((tab) => tab !== "halfplanes")],
  adjacency: ["images", ...tabsOf("adjacency").filter((tab) => tab !== "halfplanes")],
};

/** Tabs about the stages of method "rectangles" alone. */
export const REGION_TABS: readonly Tab[] = tabsOf("rectangles").filter((tab) => !TABS.lines.includes(tab));

function tabsOf(method: Method): Tab[] {
  const stages = STAGES.filter(({ methods }) => (methods as readonly Method[]).includes(method));
  return stages.flatMap(({ name }) => tabsOfStage(name));
}

function tabsOfStage(name: StageName): readonly Tab[] {
  return isShownElsewhere(name) ? [] : [name];
}

/** The view that tells most of a stage. */
export function mainTabOf(name: StageName): Tab {
  return isShownElsewhere(name) ? SHOWN_BY[name] : name;
}

function isShownElsewhere(name: StageName): name is ShownElsewhere {
  return name in SHOWN_BY;
}

/** The stage whose result a view shows; null where it needs none. */
export function stageOfTab(tab: Tab): StageName | null {
  const shows = ({ name }: { name: StageName }) => tabsOfStage(name).includes(tab);
  return STAGES.find(shows)?.name ?? null;
}

export function methodOf(values: ParamTree): Method {
  return methodNamed(values["method"]) ?? "lines";
}

/** The method of this name; null where there is none. */
export function methodNamed(name: unknown): Method | null {
  return METHODS.find((one) => one === name) ?? null;
}
