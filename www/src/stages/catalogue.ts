/** The methods, their stages and tabs, and what depends on which parameter: all from the core's own table and the list of stages. */
import type { ParamTree } from "../shared/paramTree";
import { METHODS, type Method, STAGES, type StageName } from "../shared/stages";
import { STAGE_FACTS, type Tab } from "./list";

/** A method on its button, what it is in a sentence, and in the legend of the model's colours. */
export const METHOD_WORDS: Readonly<Record<Method, { title: string; what: string; legend: string }>> = {
  lines: {
    title: "Lines",
    what: "Lines matched over the views, and half-planes at them (Baillard et al. 1999)",
    legend: "Lines (Baillard et al. 1999)",
  },
  rectangles: {
    title: "Rectangles",
    what: "Regions, and planes between parallel lines in object space (Wiman, Axelsson 1996)",
    legend: "Rectangles (Wiman, Axelsson 1996)",
  },
  combined: {
    title: "Combined",
    what: "The lines and planes of both compete for one model; regions take most of its time",
    legend: "Both",
  },
  coplanar: {
    title: "Coplanar",
    what: "Sets of coplanar lines and their polygons (Baillard et al. 1999, section 2)",
    legend: "Coplanar lines (Baillard et al. 1999)",
  },
  adjacency: {
    title: "Adjacency",
    what: "Corners with their edges and regions, matched as wholes (Baillard et al. 1999, section 2)",
    legend: "Corners (Baillard et al. 1999)",
  },
};

type CoreStage = (typeof STAGES)[number];
const BY_NAME = new Map<string, CoreStage>(STAGES.map((stage) => [stage.name, stage]));

/** The stages of a method, in their order. */
export function stagesOf(method: Method): StageName[] {
  const has = ({ methods }: CoreStage) => (methods as readonly Method[]).includes(method);
  return STAGES.filter(has).map(({ name }) => name);
}

/** The words for a stage. */
export function stageWords(name: StageName): Pick<CoreStage, "title" | "section"> {
  return BY_NAME.get(name) as CoreStage;
}

/** The method whose stage it is; of several, the first. */
export function methodOfStage(name: StageName): Method {
  const named = METHODS.find((method) => method === name);
  return named ?? METHODS.find((method) => stagesOf(method).includes(name)) ?? METHODS[0];
}

/** The stage views of a method. */
export function tabsOf(method: Method): Tab[] {
  return ["images", ...stagesOf(method).filter(isTab)];
}

/** Tabs about the stages of method "rectangles" alone. */
export const REGION_TABS: readonly Tab[] = tabsOf("rectangles").filter(
  (tab) => !tabsOf("lines").includes(tab),
);

/** The title on a tab. */
export function tabTitle(tab: Tab): string {
  return tab === "images" ? "Images" : (STAGE_FACTS[tab].tabTitle ?? stageWords(tab).title);
}

/** The view that tells most of a stage. */
export function mainTabOf(name: StageName): Tab {
  return (STAGE_FACTS[name].shownBy ?? name) as Tab;
}

/** That view, if it is one of the method's. */
export function shownTabOf(name: StageName, method: Method): Tab | null {
  const tab = mainTabOf(name);
  return tabsOf(method).includes(tab) ? tab : null;
}

/** The stage whose result a view shows; null where it needs none. */
export function stageOfTab(tab: Tab): StageName | null {
  return tab === "images" ? null : tab;
}

function isTab(name: StageName): name is StageName & Tab {
  return STAGE_FACTS[name].shownBy === undefined;
}

export function methodOf(values: ParamTree): Method {
  return methodNamed(values["method"]) ?? METHODS[0];
}

/** The method of this name; null where there is none. */
export function methodNamed(name: unknown): Method | null {
  return METHODS.find((one) => one === name) ?? null;
}

/** The first stage that a change of the parameter at `path` makes outdated; one that none reads outdates everything. */
export function firstStageOf(path: string, stageNames: readonly StageName[]): number {
  const readers = new Set<string>(STAGES.filter((stage) => reads(stage, path)).map(({ name }) => name));
  if (readers.size === 0) {
    return 0;
  }
  const first = stageNames.findIndex((name) => readers.has(name));
  // Stages of the other method: nothing here depends on them.
  return first < 0 ? stageNames.length : first;
}

/** Does a stage of the method read the parameter at `path`, or a part of that group? */
export function isReadBy(method: Method, path: string): boolean {
  return stagesOf(method).some((name) => reads(BY_NAME.get(name) as CoreStage, path));
}

function reads(stage: CoreStage, path: string): boolean {
  return stage.reads.some((read) => isWithin(path, read) || isWithin(read, path));
}

/** Is a parameter, or a group of them, the group at `path` or a part of it? */
function isWithin(parameter: string, path: string): boolean {
  return `${parameter}.`.startsWith(`${path}.`);
}

/** Titles of the sections of parameters, by their paths. */
export const SECTION_TITLES: Readonly<Record<string, string>> = Object.assign(
  {},
  ...Object.values(STAGE_FACTS).map(({ sections }) => sections),
);
