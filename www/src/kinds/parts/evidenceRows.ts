/** How probable a thing is, and what speaks for it and against it. */
import { percentText } from "../../app/parts/numberText";
import { FEATURE_WORDS } from "../../app/parts/reasonText";
import type { Evidence } from "../../shared/records";
import type { Row } from "./rows";

/** Features that are 1 or 0: those that are 0 say next to nothing. */
const INDICATORS = new Set(["is_border", "is_intersection"]);

/** The core says 1 of what nothing weighed. */
export function probabilityRow(probability: number, wasWeighed = false): Row {
  return ["Probability", probability === 1 && !wasWeighed ? "–" : percentText(probability)];
}

/** One bar a term, after the one for the prior; null where nothing was weighed. */
export function evidenceRow(label: string, evidence: Evidence | null | undefined): Row | null {
  if (evidence == null) {
    return null;
  }
  const told = evidence.terms.filter(({ feature, value }) => value !== 0 || !INDICATORS.has(feature));
  const bars = told.map(({ feature, nats }) => ({ name: FEATURE_WORDS[feature] ?? feature, nats }));
  return [label, { bars: [{ name: "prior odds", nats: evidence.prior }, ...bars] }];
}
