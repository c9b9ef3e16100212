/** Cameras and world points in space, as they come. */
import { signal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { THEME_COLOURS } from "../../../shared/palette";
import { buildCameras } from "../../../viewer/layers/cameras";
import { withCameras } from "../../../viewer/scene/bounds";
import { GRID_STEP_M } from "../../../viewer/scene/grid";
import { buildSparsePoints, usualPoints } from "../../../viewer/sparsePoints";
import { Viewer } from "../../../viewer/viewer";
import { counted } from "../../parts/counted";
import { theme } from "../../state/theme";
import { block, report } from "./orientation";

const viewer = signal<Viewer | null>(null);

export function OrientationSpace() {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    if (canvas.current === null) {
      return undefined;
    }
    try {
      viewer.value = new Viewer(canvas.current, THEME_COLOURS[theme.peek()], () => undefined);
    } catch {
      // Without WebGL the report says what was found.
    }
    return () => {
      viewer.value?.dispose();
      viewer.value = null;
    };
  }, []);
  useSignalEffect(() => viewer.value?.setTheme(THEME_COLOURS[theme.value]));
  useSignalEffect(show);
  const { views = [], points = [] } = block.value ?? {};
  return (
    <figure class="block-in-space" data-testid="block-in-space" data-cameras={views.length}>
      <div class="space-canvas">
        <canvas
          ref={canvas}
          tabIndex={0}
          role="img"
          aria-label={`3D view of ${counted(views.length, "cameras")} and ${counted(points.length / 3, "points")}: drag to orbit, scroll to zoom`}
        />
        <span class="scale muted numbers">
          {report.value?.is_metric === true ? `grid ${GRID_STEP_M} m` : "scale arbitrary"}
        </span>
      </div>
    </figure>
  );
}

/** How many cameras were in the picture when it was last looked at as a whole. */
let seen = 0;
/** A block that has grown by this is looked at anew. */
const GROWN = 1.5;

function show(): void {
  const space = viewer.value;
  const found = block.value;
  const isDone = report.value !== null;
  if (space === null || found === null) {
    return;
  }
  const { corners, middle } = usualPoints(found.points);
  space.setLayer("sparse", buildSparsePoints(found.points, found.colours));
  space.setLayer("cameras", buildCameras(found.views, middle));
  if (isDone || found.views.length < seen || found.views.length >= GROWN * seen) {
    seen = isDone ? 0 : found.views.length;
    space.lookAt(
      withCameras(
        corners,
        found.views.map(({ center }) => center),
      ),
    );
  }
}
