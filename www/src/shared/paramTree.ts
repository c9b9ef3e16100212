import type { Params } from "./records";

/** Parameters as the page handles them: a tree of whatever names the core's defaults hold (its type is `Params`). */
export type ParamValue = number | boolean | string | null | ParamValue[] | { [key: string]: ParamValue };
export type ParamGroup = Record<string, ParamValue>;
export type ParamTree = Record<string, ParamGroup>;

/** The core's parameters as the page handles them. */
export function asTree(params: Params): ParamTree {
  return params as unknown as ParamTree;
}
