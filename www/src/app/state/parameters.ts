/** The parameters of the next run, among them the method, and their defaults. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { Params } from "../../shared/results";
import { type Method, methodOf } from "./methods";

const coreDefaults = signal<Params>({});
const chosen = signal<Params>({});

/** The core's own; empty until it is compiled. */
export const defaults: ReadonlySignal<Params> = coreDefaults;
export const params: ReadonlySignal<Params> = chosen;
export const method = computed<Method>(() => methodOf(params.value));

export function setDefaults(values: Params): void {
  coreDefaults.value = values;
}

export function replaceParams(values: Params): void {
  chosen.value = values;
}
