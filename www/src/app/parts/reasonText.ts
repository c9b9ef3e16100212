/** The core's reasons in words. */
import type {
  BuildingRefinement,
  Evidence,
  FacetRejection,
  LineContradiction,
  LineOrigin,
  SegmentOutcome,
  TestedRelation,
} from "../../shared/records";
import { numberOf } from "../../shared/selection";
import { percentText, signed } from "./numberText";

/** Why a side of a line has no half-plane (B99 4.1). */
export const REJECTION_WORDS: Record<string, string> = {
  on_ground: "the line lies on the ground",
  no_frame: "the line is vertical",
  too_short: "no view shows the whole line at sufficient length",
  no_points_of_interest: "too little texture beside the line",
  no_valid_view: "too few views agree at any angle",
  at_interval_end: "Sim still rises where the range of angles ends",
  low_peak: "the peak is too low",
  flat_curve: "the curve is too flat",
  small_amplitude: "the amplitude is too small",
  improbable: "the posterior probability is too low",
};

const NOT_VERIFIED: Record<string, string> = {
  no_fit: "no line fits the segments",
  ill_conditioned: "the segments do not fix its position across",
  too_few_edges: "the edge shows in fewer than three views",
  too_few_segments: "too few views have a segment on it",
  no_stretch: "no stretch of it is supported by three views",
  improbable: "more likely no line than one",
  too_short: "the supported stretch is too short",
  outside_heights: "it lies outside the height range",
};

export function outcomeWords(outcome: SegmentOutcome | null): string {
  switch (outcome?.kind) {
    case undefined:
      return "not matched yet";
    case "matched":
      return `matched, in match ${numberOf(outcome.line)}`;
    case "no_candidate":
      return "rejected: no segment in any beam";
    case "below_threshold":
      return `rejected: best score ${outcome.best.toFixed(2)} is below the threshold`;
    case "not_verified":
      return `rejected: ${NOT_VERIFIED[outcome.reason] ?? outcome.reason}`;
    case "left_out":
      return `rejected: match ${numberOf(outcome.line)}, made from its pair, fits better without it`;
    case "lost_to":
      return `rejected: its candidates fit match ${numberOf(outcome.line)} better`;
  }
}

/** How a 3D line was found. */
export const ORIGIN_WORDS: Record<LineOrigin, string> = {
  matched: "matched over the views",
  clustered: "from boundaries of regions, in object space",
  intersection: "new: two planes intersect here",
  border: "new: a border, seen again in the views",
};

/** Why the model contradicts a 3D line, which the files then leave out. */
export const CONTRADICTION_WORDS: Record<LineContradiction, string> = {
  improbable: "too unlikely an edge in this model",
  duplicate: "a better line runs along it",
};

export const RELATION_WORDS: Record<TestedRelation["kind"], string> = {
  horizontal: "level",
  parallel: "parallel",
  perpendicular: "perpendicular",
  equal_height: "equal height",
  symmetric: "symmetric",
};

/** Why a building keeps the shape that it had (B99 2). */
const UNREFINED: Record<string, string> = {
  too_large: "too many unknowns",
  few_observations: "too few sides are visible",
  singular: "no solution",
  no_gain: "the images fit no better",
  broken: "the new outline does not close",
  dissimilar: "the views agree less inside",
};

/** What refinement made of a building, in a line. */
export function refinementWords({ error_before_px, error_after_px, refused }: BuildingRefinement): string {
  return refused === null
    ? `${error_before_px.toFixed(2)} → ${error_after_px.toFixed(2)} px`
    : `not refined: ${UNREFINED[refused.reason] ?? refused.reason}`;
}

/** Why a pair of parallel lines gave no plane (W96 3.6). */
export const PAIR_WORDS: Record<string, string> = {
  shape: "too steep, too narrow or too wide",
  near_ground: "not higher above the ground than a car",
  no_ends: "the crossing lines do not give two ends",
  weak: "its best measure is not positive",
};

/** What was measured of a facet or a line, by the names of the core's models. */
export const FEATURE_WORDS: Record<string, string> = {
  outline_on_lines: "outline on lines",
  displaced_plane_margin_sigmas: "margin over the plane moved up or down",
  rival_plane_margin_sigmas: "margin over other planes",
  correlation: "agreement of the views",
  excess_green: "excess green",
  ln_area_m2: "size",
  ln_1_plus_lines: "number of lines",
  ln_1_plus_half_planes: "number of half-planes",
  cos_slope: "slope",
  inside_footprint: "share inside of known footprints",
  on_point_cloud: "share on the points of a cloud",
  height_m: "height above the ground",
  roughness_px: "roughness",
  missing_views: "views that see it and do not show it",
  ln_sigma_without_a_view_px: "uncertainty without its weightiest view",
  residual_rms_sigmas: "residuals of its edges",
  slope_deg: "slope",
  nats_before: "what its views said",
  is_border: "border of a facet",
  is_intersection: "intersection of facets",
  share_on_surfaces: "share on roofs, walls, ground",
  hidden_views: "views that roofs hide it from",
  facets_on_it: "facets found with it",
};

/** Logarithm of the odds, by all that speaks for a candidate and against it. */
export function natsOf({ prior, terms }: Evidence): number {
  return terms.reduce((sum, { nats }) => sum + nats, prior);
}

export function probabilityOf(evidence: Evidence): number {
  return 1 / (1 + Math.exp(-natsOf(evidence)));
}

export function facetRejectionWords(reason: FacetRejection): string {
  if ("too_small" in reason) {
    return `too small (${reason.too_small.area_m2.toFixed(1)} m²)`;
  }
  if ("near_ground" in reason) {
    return `lower than any eave (its middle ${reason.near_ground.height_m.toFixed(1)} m above the ground)`;
  }
  if ("reaches_ground" in reason) {
    return `its low side is lower than any eave (${reason.reaches_ground.lowest_m.toFixed(1)} m above the ground)`;
  }
  const { evidence } = reason.improbable;
  const [worst] = evidence.terms.filter(({ nats }) => nats < 0).sort((a, b) => a.nats - b.nats);
  const most =
    worst === undefined
      ? ""
      : `; most against it: ${FEATURE_WORDS[worst.feature] ?? worst.feature} (${signed(worst.nats)} nats)`;
  return `more likely no roof (probability ${percentText(probabilityOf(evidence))})${most}`;
}
