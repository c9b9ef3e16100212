/** The core's Session as the worker calls it, and the fake one of the tests. */
import type { Session } from "../pkg/ridgeline.js";
import type { Picture, TileModel, ViewImage } from "../shared/records";

/** The session; its pictures are objects of the core, of which only their fields are read. */
export type CoreSession = Omit<
  Session,
  "free" | typeof Symbol.dispose | "image" | "warped" | "ground" | "tileModel"
> & {
  image(view: number): FieldsOf<ViewImage>;
  warped(line: number, left: boolean, theta: number): FieldsOf<Picture> | undefined;
  ground(): FieldsOf<Picture> | undefined;
  tileModel(index: number, kept: Uint8Array): FieldsOf<TileModel>;
};
export type FieldsOf<T> = Omit<T, "free" | typeof Symbol.dispose>;
