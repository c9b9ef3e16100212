/** The layers of the 3D view, from the results: each is built anew when what it shows has changed, in a task of its own. */
import { computed, effect, signal } from "@preact/signals";
import { Vector3 } from "three";
import { shapesOf } from "../../../kinds/kinds";
import type { Facet, Vec3 } from "../../../shared/records";
import type { Tab } from "../../../stages/list";
import { pageOf, STAGE_LAYERS } from "../../../stages/pages";
import { FACET } from "../../../stages/sample";
import type { LayerState, Plan, SpaceLayer } from "../../../stages/stagePage";
import { buildCameras } from "../../../viewer/layers/cameras";
import { buildFacets } from "../../../viewer/layers/facets";
import { buildHighlight } from "../../../viewer/layers/highlight";
import { buildOutlines } from "../../../viewer/layers/outlines";
import { unpicked } from "../../../viewer/scene/layer";
import type { LayerRoles } from "../../../viewer/scene/layerRoles";
import type { Viewer } from "../../../viewer/viewer";
import { keptResult } from "../../state/keptResult";
import { preliminaryFacets, results } from "../../state/results";
import { images, scene } from "../../state/scene";
import { selection, tab } from "../../state/viewState";
import { isBeside } from "./keptBeside";
import { showsKeptFacets } from "./modelLayers";

/** Whether the present tab shows the preliminary model. */
export const showsPreliminary = computed(() => tab.value === "model" && preliminaryFacets.value !== null);

/** Those of the stages, and those of the page. */
export const LAYERS: Readonly<Record<string, SpaceLayer>> = {
  ...STAGE_LAYERS,
  preliminary: {
    plan: () => {
      const facets = preliminaryFacets.value;
      return facets && [() => unpicked(buildFacets(facets, false)), facets];
    },
    isSeen: () => showsPreliminary.value,
  },
  kept: {
    plan: () => {
      const kept = keptResult.value;
      const beside = isBeside.value;
      const build = (facets: readonly Facet[]) =>
        beside ? unpicked(buildFacets(facets)) : buildOutlines(facets);
      return kept && [() => build(kept.facets), kept, beside];
    },
    isSeen: () => !isBeside.value || showsKeptFacets.value,
    isMeasured: true,
    warm: () => buildOutlines([FACET]),
  },
  keptModel: { isSeen: () => true, isMeasured: true },
  picked: {
    plan: () => {
      const shapes = shapesOf(selection.value, results.value).filter(({ role }) => role !== "before");
      const all = shapes.map(({ points, role }) => ({ points, closed: role === "area" }));
      return all.length === 0 ? null : [() => buildHighlight(all), selection.value, results.value];
    },
    isSeen: () => true,
    warm: () => buildHighlight([{ points: FACET.outer, closed: true }]),
  },
  cameras: {
    title: "Cameras",
    // Every photograph is drawn anew.
    plan: ({ isChosen, middle }) => {
      const views = scene.value?.views;
      if (views === undefined || !isChosen) {
        return null;
      }
      const [x, y, z] = middle();
      const pictures = images.value;
      return [() => buildCameras(views, new Vector3(x, y, z), pictures), views, pictures, x, y, z];
    },
    pickOrder: 11,
  },
};

/** What a person has switched, by tab. */
const switched = signal<Partial<Record<Tab, readonly string[]>>>({});

/** The layers whose switches are on in the present tab. */
export const chosenLayers = computed(() => switched.value[tab.value] ?? pageOf(tab.value).shows ?? []);

/** Shows a layer in the present tab, or hides it there. */
export function toggleLayer(name: string): void {
  const chosen = chosenLayers.value;
  const next = chosen.includes(name) ? chosen.filter((one) => one !== name) : [...chosen, name];
  switched.value = { ...switched.value, [tab.value]: next };
}

/** The layers that are seen now. */
export const seenLayers = computed(() =>
  Object.keys(LAYERS).filter((name) => {
    const isChosen = chosenLayers.value.includes(name);
    return LAYERS[name]?.isSeen?.(isChosen) ?? isChosen;
  }),
);

const namesOf = (isWanted: (layer: SpaceLayer) => boolean) =>
  Object.keys(LAYERS).filter((name) => isWanted(LAYERS[name] as SpaceLayer));
const orderOf = (name: string) => LAYERS[name]?.pickOrder ?? 0;

export const LAYER_ROLES: LayerRoles = {
  picked: namesOf(({ pickOrder }) => pickOrder !== undefined).sort((a, b) => orderOf(a) - orderOf(b)),
  measured: namesOf(({ isMeasured }) => isMeasured === true),
  cut: namesOf(({ isCut }) => isCut === true),
};

/** Keeps the viewer's layers as the results say, until the returned function is called. */
export function followResults(viewer: () => Viewer | null, middle: () => Vec3): () => void {
  const ends = Object.entries(LAYERS).flatMap(([name, { plan }]) => {
    const state: LayerState = {
      get isChosen() {
        return chosenLayers.value.includes(name);
      },
      middle,
    };
    return plan === undefined ? [] : [follow(name, viewer, () => plan(state))];
  });
  return () => {
    for (const end of ends) {
      end();
    }
  };
}

function follow(name: string, viewer: () => Viewer | null, plan: () => Plan): () => void {
  let shown: readonly unknown[] | null = null;
  return effect(() => {
    const space = viewer();
    const next = plan();
    const of = next === null || space === null ? null : [space, ...next.slice(1)];
    if (space === null || isSame(of, shown)) {
      return;
    }
    shown = of;
    setTimeout(() => {
      if (shown === of) {
        const layer = next === null ? null : next[0]();
        layer?.highlight(selection.peek());
        space.setLayer(name, layer);
      }
    });
  });
}

function isSame(a: readonly unknown[] | null, b: readonly unknown[] | null): boolean {
  return a === b || (a !== null && b !== null && a.length === b.length && a.every((one, i) => one === b[i]));
}
