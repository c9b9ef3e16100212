/** B99 2 (Bonn): the adjacency graph over an image; a corner that is picked there lights up in the other views and in space. */
import "../../app/view/figures/figures.css";
import { SplitLab } from "../../app/view/figures/SplitLab";
import { graphOverlay } from "../../app/view/images/graphOverlay";
import { FigureImage, OwnViewPicker } from "../../app/view/images/ImageRow";
import type { Figure } from "../figure";

export function AdjacencyLab({ figure }: { figure: Figure }) {
  const { adjacency } = figure.results;
  const view = Math.max(0, figure.view);
  if (adjacency === null || figure.images[view] === undefined) {
    return <p class="lab-hint muted">Run the stage: corners, edges and regions of each image appear here.</p>;
  }
  if (adjacency.trace.graphs.length === 0) {
    return (
      <p class="lab-hint muted">
        Beside half-planes the stage is switched off: choose the method Adjacency, or switch it on in the
        parameters.
      </p>
    );
  }
  return (
    <SplitLab figure={figure} testid="adjacency-lab">
      <OwnViewPicker figure={figure} />
      <FigureImage
        figure={figure}
        view={view}
        overlay={() => ({ segments: null, supports: null, graph: graphOverlay(adjacency, view) })}
      />
    </SplitLab>
  );
}
