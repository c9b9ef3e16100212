/** B99 2 (Bonn): the adjacency graph over an image; a corner that is picked there lights up in the other views and in space. */
import "./figures.css";
import { marksOf } from "../../kinds/kinds";
import type { Figure } from "../../shared/figure";
import { Filmstrip } from "../images/Filmstrip";
import { graphOverlay } from "../images/graphOverlay";
import { ImageCanvas } from "../images/ImageCanvas";
import { ViewPicker } from "../images/ViewPicker";

export function AdjacencyLab({ figure }: { figure: Figure }) {
  const { scene, images, selection, results, act } = figure;
  const { adjacency } = results;
  const view = Math.max(0, figure.view);
  const image = images[view];
  if (adjacency === null || image === undefined) {
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
    <div class="split-lab even">
      <div class="chart-lab" data-testid="adjacency-lab">
        <ViewPicker views={scene?.views ?? []} shown={view} withAll={false} show={act.showView} />
        <ImageCanvas
          view={view}
          name={scene?.views[view]?.name ?? ""}
          image={image}
          overlay={{ segments: null, supports: null, graph: graphOverlay(adjacency, view) }}
          selection={selection}
          marks={marksOf(selection, view, figure)}
          follows={false}
          inText={figure.inText}
          onPick={act.select}
        />
      </div>
      <Filmstrip figure={figure} />
    </div>
  );
}
