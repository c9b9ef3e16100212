/** B99 2 (Bonn): the adjacency graph over an image; a corner that is picked there lights up in the other views and in space. */
import "./figures.css";
import { Filmstrip } from "../images/Filmstrip";
import { graphOverlay } from "../images/graphOverlay";
import { ImageCanvas } from "../images/ImageCanvas";
import { ViewPicker } from "../images/ImageViews";
import { marksOf } from "../images/selectionMarks";
import { results } from "../state/results";
import { images, scene } from "../state/scene";
import { select, selection, shownView } from "../state/viewState";

export function AdjacencyLab() {
  const { adjacency } = results.value;
  const view = Math.max(0, shownView.value);
  const image = images.value[view];
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
        <ViewPicker withAll={false} />
        <ImageCanvas
          view={view}
          name={scene.value?.views[view]?.name ?? ""}
          image={image}
          overlay={{ segments: null, supports: null, graph: graphOverlay(adjacency, view) }}
          selection={selection.value}
          marks={marksOf(selection.value, view)}
          follows={false}
          onPick={select}
        />
      </div>
      <Filmstrip />
    </div>
  );
}
