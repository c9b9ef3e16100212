/** Edges that are drawn in the photographs, and the lines that were found for them. */
import { diamond, type Mark, project } from "../../../kinds/parts/marks";
import { PALETTE } from "../../../shared/palette";
import type { Vec2 } from "../../../shared/records";
import type { Figure } from "../../../stages/figure";
import { drawEdge, edgeStart, isDrawingEdge, takeEdgeEnd } from "../../results/corrections/edgeDrawing";
import type { PlaceTool } from "../images/ImageViews";

const START_PX = 3;

export function edgeTool({ scene, results }: Pick<Figure, "scene" | "results">): PlaceTool {
  const found = (view: number): Mark[] =>
    (results.corrected?.lines ?? []).flatMap((line) => {
      const info = scene?.views[view];
      const seen = line == null || info === undefined ? [] : [line.p0, line.p1].map((p) => project(info, p));
      const points = seen.filter((p): p is Vec2 => p !== null);
      return points.length < 2 ? [] : [{ points, colour: PALETTE.selected, width: 3 }];
    });
  const begun = (view: number): Mark[] => {
    const first = edgeStart.value;
    if (first === null || first.view !== view) {
      return [];
    }
    const points = diamond(first.at, START_PX);
    return [{ points, closed: true, colour: PALETTE.selected, width: 2, fill: 0.5 }];
  };
  const onPlace = (view: number, at: Vec2 | null, scale: number) => {
    if (at === null) {
      drawEdge(false);
    } else {
      void takeEdgeEnd(view, at, scale);
    }
  };
  return {
    onPlace: isDrawingEdge.value ? onPlace : undefined,
    marks: (view) => [...found(view), ...begun(view)],
  };
}
