import type { About } from "../../../src/kinds/parts/kind";
import { NO_DETAIL, NO_RESULTS, type Results } from "../../../src/shared/figure";

/** A figure of these results. */
export function about(found: Partial<Results>): About {
  return { scene: null, results: { ...NO_RESULTS, ...found }, params: {}, detail: NO_DETAIL, view: 0 };
}
