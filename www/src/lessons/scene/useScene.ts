/** The chosen scene, loaded and without any stage: for figures that need cameras and photographs alone. */
import { useComputed, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { OF_SITE } from "../../core/engine";
import { keyOfFiles } from "../../element/RidgelineFigure";
import { fetchScene, sceneUrl } from "../../element/sceneFiles";
import { type SceneState, type SharedScene, sceneOf } from "../../element/sharedScene";
import type { Mat } from "../../shared/linear";
import { type Choice, choice } from "./sceneChoice";

export const DEMO_URL = "./demo/";

export interface LoadedView {
  name: string;
  width: number;
  height: number;
  P: Mat;
  image: ImageBitmap;
}

export interface LoadedScene {
  views: readonly LoadedView[];
  /** What heights count from, metres. */
  originZ: number;
}

/** Loads when what `root` holds is seen; null while it is not there. */
export function useScene() {
  const root = useRef<HTMLDivElement>(null);
  const shown = useSignal<SharedScene | null>(null);
  const now = choice.value;
  useEffect(() => {
    const element = root.current;
    if (element === null || now === null) {
      return undefined;
    }
    let joined: SharedScene | null = null;
    const observer = new IntersectionObserver((entries) => {
      if (joined === null && entries.some(({ isIntersecting }) => isIntersecting)) {
        joined = sceneOfChoice(now);
        joined.join();
        shown.value = joined;
      }
    });
    observer.observe(element);
    return () => {
      observer.disconnect();
      shown.value = null;
      joined?.leave();
    };
  }, [now]);
  const state = useComputed<SceneState | null>(() => shown.value?.state.value ?? null);
  const loaded = useComputed<LoadedScene | null>(() => {
    const { scene, images } = state.value ?? {};
    return scene == null || images === undefined || images.length < scene.views.length
      ? null
      : {
          originZ: scene.origin[2],
          views: scene.views.map(({ name, width, height, projection: p }, i) => ({
            name,
            width,
            height,
            P: [p.slice(0, 4), p.slice(4, 8), p.slice(8, 12)],
            image: images[i] as ImageBitmap,
          })),
        };
  });
  return { root, state, loaded };
}

function sceneOfChoice(of: Choice): SharedScene {
  if (of.kind === "files") {
    return sceneOf(OF_SITE, keyOfFiles(of.input.files), "lines", async () => of.input);
  }
  const url = sceneUrl(of.kind === "demo" ? "demo" : of.url, DEMO_URL, document.baseURI);
  return sceneOf(OF_SITE, url, "lines", async () => ({ files: await fetchScene(url) }));
}
