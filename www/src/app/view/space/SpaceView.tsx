/** The 3D view: layers follow the results, the tab and the switches above it. */
import "./space.css";
import { computed, signal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { Box3, Vector3 } from "three";
import { THEME_COLOURS } from "../../../shared/palette";
import type { Vec3 } from "../../../shared/records";
import { tabsOf } from "../../../stages/catalogue";
import type { Tab } from "../../../stages/list";
import { PageLegend } from "../../../stages/PageLegend";
import { pageOf } from "../../../stages/pages";
import { cornersOf, cornersOfFacets, endsOfLines, withCameras } from "../../../viewer/scene/bounds";
import { yUp } from "../../../viewer/scene/frame";
import { GRID_STEP_M } from "../../../viewer/scene/grid";
import { warmupLayers } from "../../../viewer/shaderWarmup";
import { Viewer } from "../../../viewer/viewer";
import { Choice } from "../../parts/Choice";
import { Menu } from "../../parts/Menu";
import { presentTitle } from "../../results/comparison/comparedResults";
import { isBusy } from "../../state/activity";
import { keptResult } from "../../state/keptResult";
import { notify } from "../../state/notices";
import { method } from "../../state/parameters";
import { preliminaryFacets, results } from "../../state/results";
import { scene } from "../../state/scene";
import { theme } from "../../state/theme";
import { aim, camera, face, select, selection, standAt, tab } from "../../state/viewState";
import { useCornerHandles } from "./cornerHandles";
import { canStandBeside, isBeside, standBeside, wantsBeside } from "./keptBeside";
import { model, useModels } from "./modelLayers";
import { ResultViews } from "./ResultViews";
import {
  chosenLayers,
  followResults,
  LAYER_ROLES,
  LAYERS,
  seenLayers,
  showsPreliminary,
  toggleLayer,
} from "./resultLayers";
import { SpaceTools } from "./SpaceTools";
import { Unmodelled } from "./Unmodelled";

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
  const { isEmpty: isTabEmpty, Switch } = pageOf(tab.value);
  const isEmpty = isTabEmpty?.(results.value) === true && !showsPreliminary.value;
  return (
    <div class="space-view" hidden={hidden}>
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
        {isEmpty && (
          <div class="empty over">
            <p>Nothing to show yet.</p>
            <p class="muted">This view fills when its stage has run.</p>
          </div>
        )}
        {!isEmpty && (
          <>
            <SpaceTools viewer={viewer.value} onFit={fitView}>
              <ResultViews />
              <LookMenu />
              {face.value === "method" && Switch !== undefined && <Switch />}
              {canStandBeside.value && <BesideSwitch />}
            </SpaceTools>
            <div class="space-foot">
              {tab.value === "model" && <Unmodelled />}
              <PageLegend />
              <OfLayers part="Legend" />
              <span class="scale muted numbers">
                {showsPreliminary.value && <span data-testid="preliminary">preliminary · </span>}
                grid {GRID_STEP_M} m
              </span>
            </div>
          </>
        )}
      </div>
    </div>
  );
}

/** What the layers that are switched on bring with them. */
function OfLayers({ part }: { part: "Switch" | "Legend" }) {
  return (
    <>
      {chosenLayers.value.map((name) => {
        const Part = LAYERS[name]?.[part];
        return Part !== undefined && <Part key={name} />;
      })}
    </>
  );
}

/** The kept result beside the present one, or its outlines over it. */
function BesideSwitch() {
  return (
    <Choice
      legend="Where the kept result stands"
      choices={[
        [true, "Side by side"],
        [false, "Outlines over it"],
      ]}
      chosen={wantsBeside.value}
      choose={standBeside}
    />
  );
}

/** Between two stages nothing runs for a moment. */
const PAUSE_MS = 400;

function createViewer(canvas: HTMLCanvasElement | null): (() => void) | undefined {
  if (canvas === null) {
    return undefined;
  }
  try {
    const made = new Viewer(canvas, THEME_COLOURS[theme.peek()], select, LAYER_ROLES);
    made.onStand = standAt;
    const { clientWidth = 0, clientHeight = 0 } = canvas.closest(".stage-view") ?? {};
    made.prepareSize(clientWidth, clientHeight);
    const ofLayers = Object.values(LAYERS).flatMap(({ warm }) => warm?.() ?? []);
    [...warmupLayers(), ...ofLayers].forEach((layer, i) => {
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
  useSignalEffect(() => {
    if (aim.value !== null) {
      standAt(null);
      viewer.peek()?.lookAt(aim.value.map(yUp));
    }
  });
  useSignalEffect(() => viewer.value?.setTheme(THEME_COLOURS[theme.value]));
  useSignalEffect(() => viewer.value?.halve(isBeside.value ? ["kept", "keptModel"] : null));
  useSignalEffect(() => {
    for (const name of Object.keys(LAYERS)) {
      viewer.value?.showLayer(name, seenLayers.value.includes(name));
    }
    viewer.value?.highlight(selection.value);
  });
}

/** Looks at what is shown, the cameras with it where they are. */
function fitView(): void {
  standAt(null);
  const centres = scene.value?.views.map(({ center }) => center) ?? [];
  const areShown = chosenLayers.value.includes("cameras");
  viewer.value?.lookAt(areShown ? withCameras(pointsNow(), centres) : pointsNow());
}

/** The middle of what is shown, local frame: the points are in the viewer's. */
function middleNow(): Vec3 {
  const { x, y, z } = new Box3().setFromPoints(pointsNow()).getCenter(new Vector3());
  return [x, -z, y];
}

/** What the present tab shows, in the viewer's frame. */
function pointsNow(): Vector3[] {
  const { facets } = results.value;
  if (tab.value === "model" && model.value !== null) {
    return cornersOf(model.value.object);
  }
  if (pageOf(tab.value).shows?.includes("facets") && facets !== null && facets.length > 0) {
    return cornersOfFacets(facets);
  }
  return endsOfLines(lines.value ?? new Float64Array());
}

/** Layers that only tabs of other methods show first stay empty with this one. */
function isOffered(name: string): boolean {
  if (face.value === "result") {
    return ["model", "ground", "cameras", ...chosenLayers.value].includes(name);
  }
  const isFirst = (one: Tab) => pageOf(one).shows?.includes(name) === true;
  return tabsOf(method.value).some(isFirst) || !tabsOf("combined").some(isFirst);
}

/** Which layers are seen, and how the model looks. */
function LookMenu() {
  return (
    <Menu title="Layers">
      <OfLayers part="Switch" />
      <LayerSwitches />
    </Menu>
  );
}

function LayerSwitches() {
  const toggle = (name: string) => () => {
    toggleLayer(name);
    if (name === "cameras") {
      fitView();
    }
  };
  return (
    <fieldset class="choice layers">
      <legend class="visually-hidden">Layers</legend>
      {Object.entries(LAYERS).map(
        ([name, { title }]) =>
          title !== undefined &&
          isOffered(name) && (
            <button
              key={name}
              type="button"
              aria-pressed={chosenLayers.value.includes(name)}
              onClick={toggle(name)}
            >
              {title}
            </button>
          ),
      )}
    </fieldset>
  );
}
