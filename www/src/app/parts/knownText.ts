/** What the images say of what is known beforehand, in words. */
import type {
  CloudComparison,
  FootprintVerdict,
  RegisterTrace,
  TerrainComparison,
  Vec2,
} from "../../shared/records";
import { percentText } from "./numberText";

/** Of a single footprint. */
export const FOOTPRINT_WORDS: Record<FootprintVerdict, string> = {
  agrees: "agrees: a roof stands there",
  shifted: "displaced: a roof stands beside it",
  contradicted: "contradicted: the images show ground there",
  "nothing-found": "nothing found: the images show neither a roof nor ground",
};

/** Of a register as a whole. */
export function registerWords({ verdict, belongs, moved_m }: RegisterTrace): string {
  const probability = `probability ${percentText(belongs)}`;
  switch (verdict) {
    case "used":
      return `It belongs to this place (${probability}), and counted as evidence for roofs.`;
    case "moved":
      return `It belongs to this place (${probability}), but is displaced as a whole: it was moved by ${shiftWords(moved_m)} to the roofs, and counted as evidence for them.`;
    case "doubted":
      return `The images contradict it as a whole (${probability} that it is of this place), so it counted for little. Is it of another place, or in another coordinate system?`;
    case "elsewhere":
      return "None of its footprints lies in the scene, so it was not used. Is it of another place, or in another coordinate system?";
  }
}

/** "1.20 m west and 0.90 m north"; "nothing" where it is less than a centimetre. */
export function shiftWords([east, north]: Vec2): string {
  const parts = [lengthWords(east, "east", "west"), lengthWords(north, "north", "south")];
  return parts.filter((part) => part !== "").join(" and ") || "nothing";
}

function lengthWords(metres: number, ahead: string, back: string): string {
  const size = Math.abs(metres).toFixed(2);
  return Number(size) === 0 ? "" : `${size} m ${metres > 0 ? ahead : back}`;
}

/** Footprints of the same outcome, by their places in the trace. */
export interface Outcome {
  verdict: FootprintVerdict;
  indices: readonly number[];
  /** "0.9 to 1.6 m": how far they are displaced; empty for the others. */
  range: string;
}

/** The footprints by their outcome, those that agree first; outcomes that none has are left out. */
export function outcomesOf({ footprints }: Pick<RegisterTrace, "footprints">): Outcome[] {
  const verdicts = Object.keys(FOOTPRINT_WORDS) as FootprintVerdict[];
  return verdicts.flatMap((verdict) => {
    const indices = footprints.flatMap((one, i) => (one.verdict === verdict ? [i] : []));
    const lengths = indices.flatMap((i) => {
      const shift = footprints[i]?.shift_m;
      return verdict === "shifted" && shift !== undefined ? [Math.hypot(...shift)] : [];
    });
    return indices.length === 0 ? [] : [{ verdict, indices, range: rangeText(lengths) }];
  });
}

function rangeText(lengths: readonly number[]): string {
  if (lengths.length === 0) {
    return "";
  }
  const [least, most] = [Math.min(...lengths).toFixed(1), Math.max(...lengths).toFixed(1)];
  return least === most ? `${least} m` : `${least} to ${most} m`;
}

/** Of a terrain model. */
export function terrainWords({ verdict, images_above_m }: TerrainComparison): string {
  const above = images_above_m ?? 0;
  const size = Math.abs(above).toFixed(2);
  const side = above < 0 ? "below" : "above";
  switch (verdict) {
    case "confirmed":
      return `It gives the ground. The images confirm it: their ground lies ${size} m ${side} it.`;
    case "unchecked":
      return "It gives the ground. The images show too little of the ground to check it.";
    case "moved":
      return `It gives the ground, with a difference of datums taken out: the ground in the images lies ${size} m ${side} it.`;
    case "surface":
      return "Not used: it follows the roofs, so it is a surface model. Give a terrain model.";
    case "elsewhere":
      return "Not used: it covers less than half of the place. Is it in another coordinate system?";
  }
}

/** Of a point cloud. */
export function cloudWords({ verdict, belongs, moved_m: [east, north, up] }: CloudComparison): string {
  const probability = `probability ${percentText(belongs)}`;
  const used = "its points on roofs proposed planes and counted as evidence";
  switch (verdict) {
    case "used":
      return `It belongs to this place (${probability}): ${used}.`;
    case "moved": {
      const inPlan = shiftWords([east, north]);
      const parts = [inPlan === "nothing" ? "" : inPlan, lengthWords(up, "up", "down")];
      return `It belongs to this place (${probability}), but is displaced as a whole: it was moved by ${parts.filter((part) => part !== "").join(" and ")} to what the images show, and ${used}.`;
    }
    case "unchecked":
      return `The images show too little to check it: ${used} as they are.`;
    case "left-out":
      return `The images contradict it as a whole (${probability} that it is of this place), so its points on roofs were left out. Is it of another place, or in another coordinate system?`;
    case "elsewhere":
      return "Hardly any of its points lie in the scene. Is it in another coordinate system?";
  }
}
