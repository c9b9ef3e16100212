/** Dots at the corners and edges of the facet that is being corrected, or at the points that were drawn. */
import { type ReadonlySignal, useSignalEffect } from "@preact/signals";
import { add, edgesOf, sub } from "../../../shared/linear";
import type { Vec3 } from "../../../shared/records";
import type { Viewer } from "../../../viewer/viewer";
import { BY_HAND_M, selectedFacet } from "../../results/corrections/Corrections";
import { drawn, isCorrecting, moveDrawn } from "../../results/corrections/drawn";
import { type Ends, middle, placeOf } from "../../results/corrections/facetGeometry";
import { correct } from "../../results/corrections/history";
import { isBusy } from "../../state/activity";
import { mainResults } from "../../state/results";
import { scene } from "../../state/scene";
import { tab } from "../../state/viewState";

export function useCornerHandles(viewer: ReadonlySignal<Viewer | null>): void {
  useSignalEffect(() => {
    const facet = mainResults.value.facets?.[selectedFacet() ?? -1];
    const isShown = isCorrecting.value && !isBusy.value && tab.value === "model";
    const origin = scene.value?.origin;
    if (isShown && drawn.value.length > 0) {
      viewer.value?.showHandles(drawn.value, moveDrawn);
      return;
    }
    if (!isShown || facet === undefined || origin === undefined) {
      viewer.value?.showHandles([], () => undefined);
      return;
    }
    const corners: readonly Vec3[] = facet.outer;
    const edges = edgesOf(corners);
    const lookAt = placeOf(facet, origin).at;
    viewer.value?.showHandles([...corners, ...edges.map(middle)], (index, to) => {
      const corner = corners[index];
      if (corner !== undefined) {
        const [from, there] = [add(corner, origin), add(to, origin)];
        void correct({ correction: "move_corner", from, to: there, sigma_m: BY_HAND_M }, lookAt);
        return;
      }
      const edge = edges[index - corners.length] as Ends;
      const by = sub(to, middle(edge));
      const from: [Vec3, Vec3] = [add(edge[0], origin), add(edge[1], origin)];
      const moved: [Vec3, Vec3] = [add(from[0], by), add(from[1], by)];
      void correct({ correction: "move_edge", from, to: moved, sigma_m: BY_HAND_M }, lookAt);
    });
  });
}
