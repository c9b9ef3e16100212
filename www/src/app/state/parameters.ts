/** The parameters of the next run, among them the method, and their defaults. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { ParamTree } from "../../shared/paramTree";
import type { Method } from "../../shared/stages";
import { methodOf } from "../../stages/catalogue";

const coreDefaults = signal<ParamTree>({});
const chosen = signal<ParamTree>({});

/** The core's own; empty until it is compiled. */
export const defaults: ReadonlySignal<ParamTree> = coreDefaults;
export const params: ReadonlySignal<ParamTree> = chosen;
export const method = computed<Method>(() => methodOf(params.value));

export function setDefaults(values: ParamTree): void {
  coreDefaults.value = values;
}

export function replaceParams(values: ParamTree): void {
  chosen.value = values;
}
