/** The loaded scene: its views, their images, and the memory that they take. */
import { batch, type ReadonlySignal, signal } from "@preact/signals";
import type { SceneInfo } from "../../shared/records";

const loaded = signal<SceneInfo | null>(null);
const bitmaps = signal<ImageBitmap[]>([]);
const memory = signal<number | null>(null);

export const scene: ReadonlySignal<SceneInfo | null> = loaded;
/** The undistorted images of the loaded scene, by view. */
export const images: ReadonlySignal<ImageBitmap[]> = bitmaps;
/** Memory that the views in use will take at most, megabytes; null until they are read. */
export const peakMb: ReadonlySignal<number | null> = memory;

export function setScene(info: SceneInfo): void {
  loaded.value = info;
}

export function setImages(all: ImageBitmap[]): void {
  bitmaps.value = all;
}

export function setPeakMb(megabytes: number): void {
  memory.value = megabytes;
}

/** Lets go of the scene and its images. */
export function clearScene(): void {
  for (const image of bitmaps.peek()) {
    image.close();
  }
  batch(() => {
    loaded.value = null;
    memory.value = null;
    bitmaps.value = [];
  });
}
