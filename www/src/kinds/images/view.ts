/** A photograph. */
import { viewName } from "../../stages/figure";
import type { Kind } from "../parts/kind";
import { numbered, worldText } from "../parts/rows";

export default {
  title: ({ index }, about) => `View ${viewName(about, index)}`,
  rows({ index }, { scene }) {
    const view = scene?.views[index];
    return view === undefined
      ? []
      : [
          ["Size", `${view.width} × ${view.height} px`],
          ["Centre", worldText(scene, view.center)],
        ];
  },
  siblings: (_, { scene }) => numbered("view", scene?.views.length),
} satisfies Kind<"view">;
