/** What the images say of what is known beforehand, in words. */
import type { FootprintVerdict, KnownComparison, RegisterTrace } from "../../shared/records";
import { percentText } from "./numberText";

/** Of a single footprint. */
export const FOOTPRINT_WORDS: Record<FootprintVerdict, string> = {
  agrees: "agrees: a roof stands there",
  shifted: "displaced: a roof stands beside it",
  contradicted: "contradicted: the images show ground there",
  "nothing-found": "nothing found: the images show neither a roof nor ground",
};

/** What can be known beforehand. */
type KnownThing = "terrain" | "footprints" | "cloud";

const USES: Record<KnownThing, string> = {
  terrain: "it gives the ground",
  footprints: "it counted as evidence for roofs",
  cloud: "its points on roofs proposed planes and counted as evidence",
};

const CONTRADICTED: Record<KnownThing, string> = {
  terrain: "It follows the roofs, so it is a surface model, and was not used. Give a terrain model.",
  footprints:
    "The images contradict it as a whole, so it counted for little. Is it of another place, or in another coordinate system?",
  cloud:
    "The images contradict it as a whole, so its points on roofs were left out. Is it of another place, or in another coordinate system?",
};

/** Of a thing as a whole. */
export function knownWords(
  thing: KnownThing,
  { verdict, belongs, shift_m, contradicted_at }: KnownComparison,
): string {
  const but =
    contradicted_at.length > 0
      ? " Around some roofs they contradict it: there the ground that they show counts."
      : "";
  const uses = USES[thing];
  // Heights that are confirmed belong to any place that has them.
  const probability = thing === "terrain" ? "" : ` (probability ${percentText(belongs)})`;
  switch (verdict) {
    case "used":
      return `The images confirm it${probability}: ${uses}.${but}`;
    case "moved":
      return `The images confirm it${probability}, but it is displaced as a whole: it was moved by ${shiftWords(shift_m ?? [])} to what they show, and ${uses}.${but}`;
    case "unchecked":
      return `The images show too little to check it: ${uses} as it is.`;
    case "contradicted":
      return CONTRADICTED[thing];
    case "elsewhere":
      return "Hardly anything of it lies in the scene, so it was not used. Is it in another coordinate system?";
  }
}

/** "1.20 m west and 0.90 m north", "46.03 m up"; "nothing" where it is less than a centimetre. */
export function shiftWords([east = 0, north = 0, up = 0]: readonly number[]): string {
  const parts = [
    lengthWords(east, "east", "west"),
    lengthWords(north, "north", "south"),
    lengthWords(up, "up", "down"),
  ];
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
