/** A result that was kept, to compare others with it. */
import { type ReadonlySignal, signal } from "@preact/signals";
import type { ParamTree } from "../../shared/paramTree";
import type { Facet } from "../../shared/records";
import type { Method } from "../../shared/stages";
import type { Results } from "./results";

export interface KeptResult {
  title: string;
  method: Method;
  facets: Facet[];
  /** The textured model; null where it was kept before there was one. */
  glb: Results["glb"];
  lines: number;
  seconds: number;
  params: ParamTree;
}

const kept = signal<KeptResult | null>(null);

export const keptResult: ReadonlySignal<KeptResult | null> = kept;

export function keepResult(result: KeptResult | null): void {
  kept.value = result;
}
