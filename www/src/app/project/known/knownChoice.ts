/** Terrain models, footprints and point clouds among the files: what each is taken as, and why one is not. */
import type { Inspection, SceneInfo } from "../../../shared/records";
import { isKnownKind, type KnownKind, type RunOptions } from "../../state/project";

export interface KnownFile {
  path: string;
  kind: KnownKind;
  /** Null while no scene is loaded. */
  isTaken: boolean | null;
  words: string;
}

const TAKEN: Record<KnownKind, string> = {
  terrain: "taken as the terrain",
  footprints: "taken as the footprints",
};

/** A point cloud is taken as the terrain, for its roofs, or for both. */
function takenWords(path: string, kind: KnownKind, known: SceneInfo["known"] | null): string {
  const isCloud = known?.point_cloud === path;
  if (!isCloud) {
    return TAKEN[kind];
  }
  return known?.terrain === path
    ? "taken as the terrain, and for its points on roofs"
    : "taken for its points on roofs";
}

/** What is known beforehand, in the order of the files; `known` are the files that the loaded scene has taken. */
export function knownFiles(
  { files }: Pick<Inspection, "files">,
  wanted: Pick<RunOptions, "leftOut" | "groundZ">,
  known: SceneInfo["known"] | null,
): KnownFile[] {
  const all = files.flatMap(({ path, kind }) => (isKnownKind(kind) ? [{ path, kind }] : []));
  return all.map(({ path, kind }) => {
    const isOut = wanted.leftOut.includes(path);
    const isTaken = known === null ? null : known[kind] === path || known.point_cloud === path;
    const rivals = all.filter((one) => one.kind === kind && !wanted.leftOut.includes(one.path));
    const reason = () => {
      if (isOut) {
        return "left out";
      }
      if (isTaken === null) {
        return "";
      }
      if (kind === "terrain" && wanted.groundZ !== null) {
        return "not taken: the height of the ground is stated";
      }
      return rivals.length > 1
        ? "not taken: there are several; choose one"
        : "not taken by itself: it may be a result of this program; choose it if it is none";
    };
    return { path, kind, isTaken, words: isTaken === true ? takenWords(path, kind, known) : reason() };
  });
}

/** What is asked for once a file is taken, or left out. */
export function choiceOf(
  { path, kind }: KnownFile,
  isTaken: boolean,
  wanted: RunOptions,
): Partial<RunOptions> {
  const others = wanted.leftOut.filter((one) => one !== path);
  if (isTaken) {
    return { leftOut: others, [kind]: path };
  }
  return { leftOut: [...others, path], ...(wanted[kind] === path && { [kind]: null }) };
}
