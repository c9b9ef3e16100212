/**
 * The page's state in the address, behind "#", so that a link shows what the teacher sees: scene (the demo only: own
 * files stay where they are), face, method, tab, view, selection, theta, point, camera and changed parameters. Back and
 * forward go from one tab, view, selection or step of the tour to another.
 */
import { batch, effect } from "@preact/signals";
import type { ParamValue } from "../../shared/paramTree";
import { formatSelection, parseSelection, type Selection, type Standpoint } from "../../shared/selection";
import { methodNamed, tabsOf } from "../../stages/catalogue";
import { ALL_VIEWS } from "../../stages/figure";
import type { Tab } from "../../stages/list";
import { degreesOf } from "../parts/numberText";
import { isBusy } from "../state/activity";
import { defaults, method, params } from "../state/parameters";
import { isDemo } from "../state/project";
import { resumeDetail, selectionDetail } from "../state/selectionDetail";
import { showTourStep, tourStep } from "../state/tour";
import {
  camera,
  type Face,
  face,
  select,
  selection,
  showFace,
  shownView,
  showTab,
  showView,
  standAt,
  tab,
} from "../state/viewState";
import { changedParams } from "./parameterForm";

export interface Link {
  scene: "demo" | null;
  face: Face | null;
  tab: Tab | null;
  view: number | null;
  selection: Selection | null;
  params: Record<string, ParamValue>;
  tourStep: number | null;
  /** The angle to which the half-plane was turned, degrees. */
  thetaDeg: number | null;
  /** The candidate that the segment is compared with, and where on the segment, 0 to 1. */
  point: readonly [candidate: number, at: number] | null;
  camera: Standpoint | null;
}

/** What the address asked for when the page was opened. */
export const opened: Link = parseLink(typeof location === "undefined" ? "" : location.hash);

/** The parameters that the address changes; the method is one of them. */
export function linkedParams(): Record<string, ParamValue> {
  return opened.params;
}

export function parseLink(hash: string): Link {
  const fields = new URLSearchParams(hash.replace(/^#/, ""));
  const tabs: readonly string[] = tabsOf("combined");
  const asked = fields.get("tab") ?? "";
  const isTab = tabs.includes(asked);
  const named = methodNamed(fields.get("method"));
  const chosen = named === null ? {} : { method: named };
  return {
    scene: fields.get("scene") === "demo" ? "demo" : null,
    face: faceOf(fields.get("face"), isTab ? asked : ""),
    tab: isTab ? (asked as Tab) : null,
    view: wholeNumber(fields.get("view")),
    selection: parseSelection(fields.get("select")),
    params: { ...parseParams(fields.get("params")), ...chosen },
    tourStep: wholeNumber(fields.get("step")),
    thetaDeg: numbers(fields.get("theta"), 1)?.[0] ?? null,
    point: numbers(fields.get("point"), 2) as Link["point"],
    camera: numbers(fields.get("camera"), 6) as Link["camera"],
  };
}

/** The face that is named, or the only one that has the tab. */
function faceOf(named: string | null, asked: string): Face | null {
  if (named === "result" || named === "method") {
    return named;
  }
  return ["", "images", "model"].includes(asked) ? null : "method";
}

export function formatLink(link: Link): string {
  const { method: chosen, ...changed } = link.params;
  const fields = new URLSearchParams();
  const set = (name: string, value: string | number | null) => {
    if (value !== null && value !== "") {
      fields.set(name, String(value));
    }
  };
  set("scene", link.scene);
  set("face", link.face);
  set("method", chosen === undefined || chosen === "lines" ? null : String(chosen));
  set("tab", link.tab);
  set("view", link.view);
  set("select", link.selection === null ? null : formatSelection(link.selection));
  set("params", Object.keys(changed).length === 0 ? null : JSON.stringify(changed));
  set("step", link.tourStep);
  set("theta", link.thetaDeg);
  set("point", link.point?.join() ?? null);
  set("camera", link.camera?.join() ?? null);
  return fields.toString();
}

/** Keeps the address up to date, and goes where back and forward lead. */
export function followState(): void {
  let last = "";
  window.addEventListener("popstate", () => {
    const link = parseLink(location.hash);
    last = placeOf(link);
    const isTabOfMethod = tabsOf(method.value).includes(link.tab ?? "images");
    batch(() => {
      resumeDetail(link);
      showFace(link.face ?? face.value);
      if (isTabOfMethod) {
        showTab(link.tab ?? "images");
      }
      showView(link.view ?? ALL_VIEWS);
      select(link.selection);
      showTourStep(link.tourStep);
      standAt(link.camera);
    });
  });
  effect(() => {
    const link = presentLink();
    if (Object.keys(defaults.value).length === 0) {
      return;
    }
    const place = placeOf(link);
    // What stages show by themselves is no step of the person's.
    const isStep = last !== "" && place !== last && !isBusy.peek();
    history[isStep ? "pushState" : "replaceState"](null, "", `#${formatLink(link)}`);
    last = place;
  });
}

function presentLink(): Link {
  const { isTurned, theta, isMoved, candidate, at } = selectionDetail.value;
  return {
    scene: isDemo.value ? "demo" : null,
    face: face.value,
    tab: tab.value,
    view: shownView.value < 0 ? null : shownView.value,
    selection: selection.value,
    params: { ...changedParams(defaults.value, params.value), method: method.value },
    tourStep: tourStep.value,
    thetaDeg: isTurned ? rounded(degreesOf(theta), 10) : null,
    point: isMoved ? [candidate, rounded(at, 1000)] : null,
    camera: (camera.value?.map((metres) => rounded(metres, 100)) ?? null) as Standpoint | null,
  };
}

/** What back and forward tell apart. */
function placeOf(link: Link): string {
  return formatLink({ ...link, params: {}, thetaDeg: null, point: null, camera: null });
}

function rounded(value: number, steps: number): number {
  return Math.round(value * steps) / steps;
}

function wholeNumber(text: string | null): number | null {
  return text !== null && /^\d{1,6}$/.test(text) ? Number(text) : null;
}

/** So many numbers with commas between them. */
function numbers(text: string | null, count: number): number[] | null {
  const found = (text ?? "").split(",").map((word) => (word.trim() === "" ? Number.NaN : Number(word)));
  return found.length === count && found.every(Number.isFinite) ? found : null;
}

function parseParams(text: string | null): Record<string, ParamValue> {
  try {
    const value: unknown = JSON.parse(text ?? "{}");
    return typeof value === "object" && value !== null && !Array.isArray(value)
      ? (value as Record<string, ParamValue>)
      : {};
  } catch {
    return {};
  }
}
