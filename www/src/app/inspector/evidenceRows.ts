/** How probable a thing is, and what speaks for it and against it, for the inspector. */
import type { Evidence, LineRecord } from "../../shared/records";
import { percentText } from "../parts/numberText";
import { FEATURE_WORDS } from "../parts/reasonText";
import type { Row } from "./rowLinks";

/** Features that are 1 or 0: those that are 0 say next to nothing. */
const INDICATORS = new Set(["is_border", "is_intersection"]);

/** A line's probability, by its views and in the model. */
export function evidenceOfLine({ probability, by_views, in_model }: LineRecord): Row[] {
  const wasWeighed = (by_views ?? in_model ?? null) !== null;
  return [
    ...probabilityRow(probability, wasWeighed),
    ...evidenceRow("For and against it, by its views (nats)", by_views),
    ...evidenceRow("For and against it, in the model (nats)", in_model),
  ];
}

/** The core says 1 of what nothing weighed. */
export function probabilityRow(probability: number | undefined, wasWeighed = false): Row[] {
  return probability === undefined
    ? []
    : [["Probability", probability === 1 && !wasWeighed ? "–" : percentText(probability)]];
}

/** One bar a term, after the one for the prior; results of an older core have no evidence. */
export function evidenceRow(label: string, evidence: Evidence | null | undefined): Row[] {
  if (evidence == null) {
    return [];
  }
  const told = evidence.terms.filter(({ feature, value }) => value !== 0 || !INDICATORS.has(feature));
  const bars = told.map(({ feature, nats }) => ({ name: FEATURE_WORDS[feature] ?? feature, nats }));
  return [[label, { bars: [{ name: "prior odds", nats: evidence.prior }, ...bars] }]];
}
