/** What a person asks for beyond the files, as text in fields and as the core takes it. */
import type { Inspection, LoadOptions, OpenedProject } from "../../shared/records";
import type { Parsed } from "../parts/TextField";
import type { RunOptions } from "../state/project";
import { systemsNamed } from "./referenceSystems";

/** The core's options; the views are named only where some are left out. */
export function loadOptions(wanted: RunOptions, inspection: Inspection | null): LoadOptions {
  const { orientation, leftOut, roi, terrain, footprints, groundZ, reduction, applyFix, ignoreCheck, epsg } =
    wanted;
  const images = inspection?.images ?? [];
  const used = images.filter(({ path }) => !leftOut.includes(path));
  const unused = leftOut.filter(
    (path) => !images.some((image) => image.path === path) && isHere(path, inspection),
  );
  return {
    ...(orientation !== null && { orientation }),
    ...(used.length < images.length && { views: used.map(({ name }) => name) }),
    ...(roi !== null && { roi }),
    ...(terrain !== null && isHere(terrain, inspection) && { terrain }),
    ...(footprints !== null && isHere(footprints, inspection) && { footprints }),
    ...(unused.length > 0 && { unused }),
    ...(groundZ !== null && { groundZ }),
    ...(reduction !== null && reduction > 1 && { reduction }),
    ...(applyFix && { applyFix }),
    ...(ignoreCheck && { ignoreCheck }),
    ...(epsg !== null && { epsg }),
  };
}

/** Whether a file is still among those of the project, as far as that is known. */
function isHere(path: string, inspection: Inspection | null): boolean {
  return inspection?.files.some((file) => file.path === path) ?? true;
}

/** What a project file asks for, as the page has it; images are left out that it does not name. */
export function wishesOf(opened: OpenedProject["options"], inspection: Inspection): RunOptions {
  const { orientation, views, roi, terrain, footprints, unused, groundZ, reduction, epsg } = opened;
  const isNamed = (name: string) => (views ?? []).some((view) => stem(view) === stem(name));
  const leftOut = views === null ? [] : inspection.images.filter(({ name }) => !isNamed(name));
  return {
    orientation,
    leftOut: [...leftOut.map(({ path }) => path), ...(unused ?? [])],
    roi,
    terrain,
    footprints,
    groundZ,
    epsg,
    applyFix: opened.applyFix === true,
    ignoreCheck: opened.ignoreCheck === true,
    tileM: null,
    isAtOnce: false,
    reduction,
  };
}

function stem(name: string): string {
  return name.replace(/\.[^.]*$/, "");
}

/** The size of a tile in metres; nothing is no tiles. */
export function parseTile(text: string): Parsed<number | null> {
  const parsed = parseHeight(text);
  const isTooSmall = "value" in parsed && parsed.value !== null && parsed.value < LEAST_TILE_M;
  return isTooSmall ? { error: `${LEAST_TILE_M} m or more` } : parsed;
}

/** Side of the squares of which tiles consist. */
const LEAST_TILE_M = 60;

/** "x0, y0, x1, y1" in metres; nothing is the whole scene. */
export function parseRegion(text: string): Parsed<[number, number, number, number] | null> {
  const words = text.split(/[\s,;]+/).filter((word) => word !== "");
  if (words.length === 0) {
    return { value: null };
  }
  const [x0, y0, x1, y1] = words.map(Number) as [number, number, number, number];
  if (words.length !== 4 || ![x0, y0, x1, y1].every(Number.isFinite)) {
    return { error: "four numbers: x0, y0, x1, y1" };
  }
  return x0 < x1 && y0 < y1 ? { value: [x0, y0, x1, y1] } : { error: "x0 < x1 and y0 < y1 are needed" };
}

/** A height in metres; nothing has it estimated. */
export function parseHeight(text: string): Parsed<number | null> {
  const trimmed = text.trim();
  if (trimmed === "") {
    return { value: null };
  }
  return Number.isFinite(Number(trimmed)) ? { value: Number(trimmed) } : { error: "a number in metres" };
}

/** The code of a reference system, or words of the name of one; nothing has the files say it. */
export function parseEpsg(text: string): Parsed<number | null> {
  const code = /^(?:EPSG:)?(\d{4,6})$/i.exec(text.trim())?.[1];
  if (text.trim() === "" || code !== undefined) {
    return { value: code === undefined ? null : Number(code) };
  }
  const found = systemsNamed(text);
  const [only] = found;
  if (found.length === 1 && only !== undefined) {
    return { value: only.code };
  }
  const some = found.slice(0, 4).map(({ code, name }) => `${code} ${name}`);
  return { error: some.length === 0 ? "a code such as 25832, or a name" : `which of ${some.join("; ")} …` };
}
