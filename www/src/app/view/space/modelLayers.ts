/** The textured models of the 3D view: the present one, and the kept one beside it. */
import { computed, type ReadonlySignal, type Signal, signal, useSignalEffect } from "@preact/signals";
import { THEME_COLOURS } from "../../../shared/palette";
import { facetColours, modelMode, showsObstructions, sunColours } from "../../../stages/model/ModelModes";
import { buildModel, type ModelLayer } from "../../../viewer/layers/model";
import { modelOfParts } from "../../../viewer/modelOfParts";
import { cornersOf, cornersOfFacets } from "../../../viewer/scene/bounds";
import { unpicked } from "../../../viewer/scene/layer";
import type { Viewer } from "../../../viewer/viewer";
import { ask } from "../../session/session";
import { keptResult } from "../../state/keptResult";
import { notify } from "../../state/notices";
import { method } from "../../state/parameters";
import { foundSunshine, mainResults, preliminaryFacets, setSunshine } from "../../state/results";

import { theme } from "../../state/theme";
import { selection, tab } from "../../state/viewState";
import { isBeside } from "./keptBeside";

type Glb = Uint8Array<ArrayBuffer> | null;

const presentModel = signal<ModelLayer | null>(null);
export const model: ReadonlySignal<ModelLayer | null> = presentModel;
const keptModel = signal<ModelLayer | null>(null);

const presentGlb = computed(() => mainResults.value.glb);
const keptGlb = computed(() => keptResult.value?.glb ?? null);
/** The kept model is read once somebody looks at it. */
const shownKeptGlb = computed(() => (isBeside.value && tab.value === "model" ? keptGlb.value : null));
/** Where a kept result has no model, or another tab is open, its facets stand in its place. */
export const showsKeptFacets = computed(() => isBeside.value && shownKeptGlb.value === null);

/** Whether the camera stands where a preliminary model put it. */
let looksAtPreliminary = false;

/** Keeps both models, and how they look, as the signals say. */
export function useModels(viewer: ReadonlySignal<Viewer | null>): void {
  useSignalEffect(() => {
    void show("model", presentGlb, presentModel, viewer);
  });
  useSignalEffect(() => {
    void show("keptModel", shownKeptGlb, keptModel, viewer);
  });
  useSignalEffect(() => {
    void showTiles(mainResults.value.tileGlbs, viewer);
  });
  useSignalEffect(() => {
    const kept = keptResult.value;
    model.value?.setFacetColours(
      modelMode.value === "sun" ? sunColours.value : facetColours(mainResults.value.facets, method.value),
    );
    keptModel.value?.setFacetColours(kept === null ? [] : facetColours(kept.facets, kept.method));
    for (const layer of [model.value, keptModel.value]) {
      layer?.setMode(modelMode.value);
      layer?.showObstructions(showsObstructions.value);
      layer?.setTheme(THEME_COLOURS[theme.value]);
    }
    viewer.value?.draw();
  });
  useSignalEffect(() => {
    const of = mainResults.value;
    if (modelMode.value === "sun" && of.glb !== null && foundSunshine.value?.of !== of) {
      void ask("sunshine").then((sunshine) => setSunshine({ of, sunshine }));
    }
  });
  useSignalEffect(() => {
    if (preliminaryFacets.value !== null) {
      viewer.value?.lookAt(cornersOfFacets(preliminaryFacets.value));
      looksAtPreliminary = true;
    }
  });
  useSignalEffect(() => {
    if (model.value !== null) {
      const corners = cornersOf(model.value.object);
      // The model that a preliminary one announced stands where that stood.
      if (looksAtPreliminary) {
        viewer.peek()?.keepLookingAt(corners);
      } else {
        viewer.peek()?.lookAt(corners);
      }
      looksAtPreliminary = false;
    }
  });
}

/** What was read of the models of tiles; each is read once, while the model grows. */
const tileModels = new Map<Uint8Array, ModelLayer>();

/** Shows the models of the tiles that are done, until all are one. */
async function showTiles(
  glbs: readonly Uint8Array<ArrayBuffer>[],
  viewer: ReadonlySignal<Viewer | null>,
): Promise<void> {
  if (glbs.length === 0) {
    tileModels.clear();
    return;
  }
  try {
    for (const glb of glbs) {
      if (!tileModels.has(glb)) {
        tileModels.set(glb, await buildModel(glb));
      }
    }
  } catch (error) {
    notify({ severity: "error", title: "The model cannot be shown", text: String(error) });
    return;
  }
  if (mainResults.peek().tileGlbs !== glbs) {
    return;
  }
  const layer = modelOfParts(glbs.flatMap((glb) => tileModels.get(glb) ?? []));
  layer.setMode(modelMode.peek());
  viewer.peek()?.setLayer("model", layer);
  presentModel.value = layer;
}

/** Reads a model and puts it into its layer, unless another one has come meanwhile. */
async function show(
  name: "model" | "keptModel",
  glb: ReadonlySignal<Glb>,
  shown: Signal<ModelLayer | null>,
  viewer: ReadonlySignal<Viewer | null>,
): Promise<void> {
  const bytes = glb.value;
  if (bytes === null && name === "model" && mainResults.peek().tileGlbs.length > 0) {
    return;
  }
  if (bytes === null) {
    shown.value = null;
    viewer.peek()?.setLayer(name, null);
    return;
  }
  try {
    const layer = await buildModel(bytes);
    if (glb.peek() !== bytes) {
      layer.dispose();
      return;
    }
    layer.setMode(modelMode.peek());
    layer.highlight(name === "model" ? selection.peek() : null);
    viewer.peek()?.setLayer(name, name === "model" ? layer : unpicked(layer));
    shown.value = layer;
  } catch (error) {
    notify({ severity: "error", title: "The model cannot be shown", text: String(error) });
  }
}
