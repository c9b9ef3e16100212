/** What the figures show of the selection beyond the results. */
import { type ReadonlySignal, signal } from "@preact/signals";
import { NO_DETAIL, type Resumed, type SelectionDetail } from "../../stages/figure";

export { NO_DETAIL, type SelectionDetail };

const shown = signal<SelectionDetail>(NO_DETAIL);

export const selectionDetail: ReadonlySignal<SelectionDetail> = shown;

export function setDetail(detail: SelectionDetail): void {
  shown.value = detail;
}

let resumed: Resumed = { thetaDeg: null, point: null };

/** The next selection is shown as a link says. */
export function resumeDetail(of: Resumed): void {
  resumed = of;
}

/** What the link said; once. */
export function takeResumed(): Resumed {
  const of = resumed;
  resumed = { thetaDeg: null, point: null };
  return of;
}
