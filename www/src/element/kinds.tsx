import type { Method, StageName } from "../shared/stages";
import { methodOfStage, stageOfTab } from "../stages/catalogue";
import { FIGURES } from "../stages/figures";
import type { Tab } from "../stages/list";
import type { StageFigure, StageKind } from "../stages/stageFigure";

export interface Kind extends Required<StageKind> {
  /** The page's own figure, whose text and paper it has. */
  of: StageFigure;
  method: Method;
  /** The last stage that it needs. */
  stage: StageName;
}

/** By the name that `kind` has in HTML. */
const KINDS = new Map(
  Object.entries(FIGURES).flatMap(([tab, of]) => {
    const stage = stageOfTab(tab as Tab);
    return stage === null
      ? []
      : Object.entries(of.kinds ?? {}).map(([name, kind]): [string, Kind] => [
          name,
          { begin: () => null, rows: of.rows, ...kind, of, method: methodOfStage(stage), stage },
        ]);
  }),
);

export const KIND_NAMES: readonly string[] = [...KINDS.keys()];

export function kindOf(name: string | null): Kind | null {
  return KINDS.get(name ?? "") ?? null;
}
