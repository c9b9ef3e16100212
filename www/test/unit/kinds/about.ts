import type { About } from "../../../src/kinds/parts/kind";
import { NO_DETAIL } from "../../../src/stages/figure";
import { NO_RESULTS, type Results } from "../../../src/stages/list";

/** A figure of these results. */
export function about(found: Partial<Results>): About {
  return { scene: null, results: { ...NO_RESULTS, ...found }, params: {}, detail: NO_DETAIL, view: 0 };
}
