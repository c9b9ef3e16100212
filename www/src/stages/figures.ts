/** The figures of the stages, from their folders. */
import { STAGE_FACTS, type Tab } from "./list";
import type { StageFigure } from "./stageFigure";

const found = import.meta.glob<StageFigure>("./*/figure.tsx", { eager: true, import: "default" });

/** In the order of the stages. */
export const FIGURES = Object.fromEntries(
  Object.keys(STAGE_FACTS).flatMap((name) => {
    const figure = found[`./${name}/figure.tsx`];
    return figure === undefined ? [] : [[name, figure]];
  }),
) as Readonly<Record<Tab, StageFigure>>;
