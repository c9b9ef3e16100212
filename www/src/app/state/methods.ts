/** The methods, and the stage views of each. */
import type { Params } from "../../shared/results";

const LINE_TABS = ["segments", "matches", "lines", "halfplanes", "groups", "facets", "refinement"] as const;
/** Tabs about the stages of method "rectangles". */
export const REGION_TABS = ["regions", "directions", "clusters", "rectangles"] as const;

/** The stage views of each method. */
export const TABS = {
  lines: ["images", ...LINE_TABS, "model"],
  rectangles: ["images", ...REGION_TABS, "model"],
  combined: ["images", ...REGION_TABS, ...LINE_TABS, "model"],
} as const;
export type Method = keyof typeof TABS;
export type Tab = (typeof TABS)[Method][number];

export function methodOf(values: Params): Method {
  return methodNamed(values["method"]) ?? "lines";
}

/** The method of this name; null where there is none. */
export function methodNamed(name: unknown): Method | null {
  return (Object.keys(TABS) as Method[]).find((one) => one === name) ?? null;
}
