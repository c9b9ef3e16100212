/** The 3D view: layers follow the results, the tab and the switches above it. */
import "./space.css";
import { computed, signal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { Box3, Vector3 } from "three";
import { THEME_COLOURS } from "../../shared/palette";
import type { Vec3 } from "../../shared/records";
import { enlargement } from "../../stages/lines/uncertaintyLayer";
import { cornersOf, cornersOfFacets, endsOfLines, withCameras } from "../../viewer/scene/bounds";
import { GRID_STEP_M } from "../../viewer/scene/grid";
import { warmupLayers } from "../../viewer/shaderWarmup";
import { Viewer } from "../../viewer/viewer";
import { presentTitle } from "../comparison/comparedResults";
import { Legend } from "../parts/Legend";
import { isBusy } from "../state/activity";
import { keptResult } from "../state/keptResult";
import type { Tab } from "../state/methods";
import { notify } from "../state/notices";
import { method } from "../state/parameters";
import { preliminaryFacets, results } from "../state/results";
import { scene } from "../state/scene";
import { theme } from "../state/theme";
import {
  beforeGrowing,
  camera,
  select,
  selection,
  showBeforeGrowing,
  standAt,
  tab,
} from "../state/viewState";
import { useCornerHandles } from "./cornerHandles";
import { canStandBeside, isBeside, standBeside, wantsBeside } from "./keptBeside";
import { ModeLegend, ModeSwitches } from "./ModelModes";
import { model, showsKeptFacets, useModels } from "./modelLayers";
import { followResults, LAYERS, type LayerName, shownLayers, toggleLayer } from "./resultLayers";
import { SpaceTools } from "./SpaceTools";
import { Unmodelled } from "./Unmodelled";

const LAYER_TITLES: Record<LayerName, string> = {
  lines: "3D lines",
  uncertainty: "Uncertainty",
  fans: "Half-planes",
  coplanar: "Coplanar sets",
  adjacency: "Corners",
  dense: "Dense planes",
  groups: "Groups",
  facets: "Facets",
  model: "Model",
  ground: "Ground",
  cameras: "Cameras",
};

/** Layers that method "rectangles" does not fill. */
const LAYERS_OF_LINES: readonly LayerName[] = ["fans", "coplanar", "adjacency", "dense", "groups"];

/** The viewer while it exists; the effects below wait for it. */
const viewer = signal<Viewer | null>(null);

export function SpaceView({ hidden }: { hidden: boolean }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => createViewer(canvas.current), []);
  const paper = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const print = () => paper.current !== null && viewer.value?.printOn(paper.current);
    window.addEventListener("beforeprint", print);
    return () => window.removeEventListener("beforeprint", print);
  }, []);
  useLayers();
  const isEmpty = layerIsEmpty(tab.value);
  return (
    <div class="space-view" hidden={hidden}>
      <div class="toolbar">
        <LayerSwitches />
        {shownLayers.value[tab.value].includes("model") && <ModeSwitches />}
        {tab.value === "lines" && <GrowingSwitch />}
        {canStandBeside.value && <BesideSwitch />}
        <span class="grow" />
        <Legend />
        {shownLayers.value[tab.value].includes("model") && <ModeLegend />}
        {shownLayers.value[tab.value].includes("uncertainty") && results.value.records.length > 0 && (
          <p class="legend">
            <span class="swatch merged" aria-hidden="true" />1 σ, drawn {enlargement(results.value.records)} ×
            as large
          </p>
        )}
      </div>
      {isBeside.value && (
        <div class="halves" data-testid="halves">
          <p>
            <span class="muted">Kept:</span> {keptResult.value?.title}
          </p>
          <p>
            <span class="muted">Now:</span> {presentTitle.value}
          </p>
        </div>
      )}
      <div class={`space-canvas ${isBeside.value ? "halved" : ""}`}>
        <canvas
          ref={canvas}
          tabIndex={0}
          role="img"
          data-testid="viewer"
          aria-label="3D view: drag to orbit, right-drag or arrows to move, scroll to zoom, click to pick"
          onKeyDown={(event) => {
            if (event.key === "Escape") {
              select(null);
            }
          }}
        />
        <canvas ref={paper} class="paper" />
        {tab.value === "model" && <Unmodelled />}
        {isEmpty && (
          <div class="empty over">
            <p>Nothing to show yet.</p>
            <p class="muted">This view fills when its stage has run.</p>
          </div>
        )}
        {!isEmpty && <SpaceTools viewer={viewer.value} onFit={fitView} />}
        {!isEmpty && (
          <span class="scale muted numbers">
            {showsPreliminary.value && <span data-testid="preliminary">preliminary · </span>}
            grid {GRID_STEP_M} m
          </span>
        )}
      </div>
    </div>
  );
}

/** B99 figures 5 and 7 against 6 and 8. */
function GrowingSwitch() {
  return (
    <fieldset class="choice growing">
      <legend class="visually-hidden">Before or after growing</legend>
      {[true, false].map((before) => (
        <button
          key={String(before)}
          type="button"
          aria-pressed={beforeGrowing.value === before}
          onClick={() => {
            showBeforeGrowing(before);
          }}
        >
          {before ? "Before growing" : "After"}
        </button>
      ))}
    </fieldset>
  );
}

/** The kept result beside the present one, or its outlines over it. */
function BesideSwitch() {
  return (
    <fieldset class="choice">
      <legend class="visually-hidden">Where the kept result stands</legend>
      {[true, false].map((beside) => (
        <button
          key={String(beside)}
          type="button"
          aria-pressed={wantsBeside.value === beside}
          onClick={() => {
            standBeside(beside);
          }}
        >
          {beside ? "Side by side" : "Outlines over it"}
        </button>
      ))}
    </fieldset>
  );
}

/** Of the height of a tab that the canvas has, more or less: the rest is its figure's. */
const CANVAS_SHARE = 0.6;
/** Between two stages nothing runs for a moment. */
const PAUSE_MS = 400;

function createViewer(canvas: HTMLCanvasElement | null): (() => void) | undefined {
  if (canvas === null) {
    return undefined;
  }
  try {
    const made = new Viewer(canvas, THEME_COLOURS[theme.peek()], (picked) => {
      select(picked);
    });
    made.onStand = standAt;
    const { clientWidth = 0, clientHeight = 0 } = canvas.closest(".stage-view") ?? {};
    made.prepareSize(clientWidth, Math.round(CANVAS_SHARE * clientHeight));
    warmupLayers().forEach((layer, i) => {
      made.showLayer(`warm ${i}`, false);
      made.setLayer(`warm ${i}`, layer);
    });
    viewer.value = made;
  } catch {
    notify({
      severity: "warning",
      about: "browser",
      title: "No 3D view",
      text: "This browser offers no WebGL 2. Everything else works, and the model can be downloaded.",
      advice: "Switch on hardware acceleration in the browser's settings to see the model here.",
    });
  }
  return () => {
    viewer.value?.dispose();
    viewer.value = null;
  };
}

/** Whether the present tab shows the preliminary model. */
const showsPreliminary = computed(() => tab.value === "model" && preliminaryFacets.value !== null);
const lines = computed(() => results.value.lines);
/** Changes when a stage has found the lines anew, but not when the model adds some. */
const lineStage = computed(() => results.value.stretches ?? results.value.clusters);

/** Keeps the viewer's layers, modes, theme and selection as the signals say. */
function useLayers(): void {
  useEffect(() => followResults(() => viewer.value, middleNow), []);
  useSignalEffect(() => {
    const space = viewer.value;
    const isRunning = isBusy.value;
    const timer = setTimeout(() => space?.holdSize(isRunning), isRunning ? 0 : PAUSE_MS);
    return () => clearTimeout(timer);
  });
  useSignalEffect(() => {
    const found = lines.peek();
    if (lineStage.value !== null && found !== null && preliminaryFacets.peek() === null) {
      viewer.value?.lookAt(endsOfLines(found));
    }
  });
  useModels(viewer);
  useCornerHandles(viewer);
  // After the effects that look at new results: where a person or a link has put the camera, it stays.
  useSignalEffect(() => {
    void [model.value, lineStage.value, preliminaryFacets.value];
    if (camera.value !== null) {
      viewer.value?.standAt(camera.value);
    }
  });
  useSignalEffect(() => viewer.value?.setTheme(THEME_COLOURS[theme.value]));
  useSignalEffect(() => {
    viewer.value?.halve(isBeside.value ? ["kept", "keptModel"] : null);
    viewer.value?.showLayer("kept", !isBeside.value || showsKeptFacets.value);
  });
  useSignalEffect(() => {
    for (const name of LAYERS) {
      viewer.value?.showLayer(name, shownLayers.value[tab.value].includes(name));
    }
    const before = tab.value === "lines" && beforeGrowing.value;
    viewer.value?.showLayer("stretches", before);
    viewer.value?.showLayer("refinement", tab.value === "refinement");
    viewer.value?.showLayer("preliminary", showsPreliminary.value);
    if (before) {
      viewer.value?.showLayer("lines", false);
    }
    viewer.value?.highlight(selection.value);
  });
}

/** Looks at what is shown, the cameras with it where they are. */
function fitView(): void {
  standAt(null);
  const centres = scene.value?.views.map(({ center }) => center) ?? [];
  const areShown = shownLayers.value[tab.value].includes("cameras");
  viewer.value?.lookAt(areShown ? withCameras(pointsNow(), centres) : pointsNow());
}

/** The middle of what is shown, local frame: the points are in the viewer's. */
function middleNow(): Vec3 {
  const { x, y, z } = new Box3().setFromPoints(pointsNow()).getCenter(new Vector3());
  return [x, -z, y];
}

/** Tabs about facets. */
const FACET_TABS: readonly Tab[] = ["facets", "refinement", "rectangles"];

/** What the present tab shows, in the viewer's frame. */
function pointsNow(): Vector3[] {
  const { facets } = results.value;
  if (tab.value === "model" && model.value !== null) {
    return cornersOf(model.value.object);
  }
  if (FACET_TABS.includes(tab.value) && facets !== null && facets.length > 0) {
    return cornersOfFacets(facets);
  }
  return endsOfLines(lines.value ?? new Float64Array());
}

function layerIsEmpty(name: Tab): boolean {
  const { halfPlanes, coplanar, adjacency, dense, grouping, facets } = results.value;
  switch (name) {
    case "lines":
      return lines.value === null;
    case "halfplanes":
      return halfPlanes === null;
    case "coplanar":
      return coplanar === null;
    case "adjacency":
      return adjacency === null;
    case "dense":
      return dense === null;
    case "groups":
      return grouping === null;
    case "refinement":
      return results.value.refinement === null;
    case "facets":
    case "rectangles":
      return facets === null;
    case "model":
      return (
        results.value.glb === null && results.value.tileGlbs.length === 0 && preliminaryFacets.value === null
      );
    default:
      return false;
  }
}

function LayerSwitches() {
  const visible = shownLayers.value[tab.value];
  const toggle = (name: LayerName) => () => {
    toggleLayer(name, tab.value);
    if (name === "cameras") {
      fitView();
    }
  };
  return (
    <fieldset class="choice layers">
      <legend class="visually-hidden">Layers</legend>
      {LAYERS.filter((name) => method.value !== "rectangles" || !LAYERS_OF_LINES.includes(name)).map(
        (name) => (
          <button key={name} type="button" aria-pressed={visible.includes(name)} onClick={toggle(name)}>
            {LAYER_TITLES[name]}
          </button>
        ),
      )}
    </fieldset>
  );
}
