/** The terms of the field that the page and the exercises use, each with what it means here. One file; the page and docs/glossary.md show it. */

export interface Term {
  /** As it stands in a text by itself. */
  word: string;
  /** In one or two sentences. */
  says: string;
  /** Paper and section where it is used; empty where it is common knowledge. */
  source: string;
  /** Terms to go on with. */
  see: readonly string[];
}

function term(source: string, says: string, ...see: readonly string[]): Omit<Term, "word"> {
  return { says, source, see };
}

/** By the id that `<Term id>` and `[[id]]` name: the word itself, hyphens for blanks, but for {@link OTHER_WORDS}. */
const ENTRIES = {
  "adjacency-graph": term(
    "B99 2",
    "What lies beside what in an image: corners, the edges that meet there, and the regions between them. Neighbours in an image are mostly neighbours in space.",
    "region",
  ),
  "border-line": term(
    "B99 4.3",
    "A line that may bound a facet: a matched line of its plane, an intersection with another plane, or a line that closes the outline.",
    "facet",
    "intersection-line",
  ),
  "camera-matrix": term(
    "",
    "K: focal length and principal point in pixels. It takes a direction in the camera's frame to its image.",
    "principal-point",
    "projection",
  ),
  candidate: term(
    "B99 3.1",
    "What may be the match of a segment, a line of the model or a facet, before anything has decided.",
    "epipolar-beam",
    "evidence",
  ),
  cluster: term(
    "W96 3.5",
    "A point of a cluster plane, across a main direction, where lines of several images meet: a 3D line.",
    "main-direction",
  ),
  correlation: term(
    "B99 3.1",
    "Normalised cross-correlation of two windows, from −1 to 1: the covariance of their grey values over both standard deviations. Brightness and contrast do not change it.",
    "correlation-window",
  ),
  "correlation-window": term(
    "B99 3.2",
    "The square of pixels about a point whose grey values are compared: 15 × 15 in the paper.",
    "correlation",
  ),
  covariance: term(
    "",
    "How the errors of several numbers scatter together: variances on the diagonal. It is the inverse of the information, which adds over independent measurements.",
    "standard-deviation",
  ),
  "description-length": term(
    "W96 3.3",
    "The number of bits that a model and what is left of the data take together. The shortest description is the best explanation (MDL).",
    "region",
    "nat",
  ),
  eave: term("", "The level lower border of a roof.", "rake", "ridge"),
  edgel: term(
    "B99 3.2",
    "A point on an edge in an image, to a fraction of a pixel, with the direction of the edge there.",
    "segment",
  ),
  "epipolar-beam": term(
    "B99 3.1",
    "The part of another view between the epipolar lines of the two ends of a segment. The match of the segment lies in it or crosses it.",
    "epipolar-line",
    "candidate",
  ),
  "epipolar-line": term(
    "B99 3.1",
    "The image of a ray of one view in another view: there the match of a point must lie. For a point x it is F x.",
    "fundamental-matrix",
    "epipolar-beam",
  ),
  evidence: term(
    "B99 5",
    "What measurements say for or against a candidate: the sum of the logarithms of likelihood ratios, in nats.",
    "likelihood-ratio",
    "posterior",
    "point-cloud",
  ),
  facet: term(
    "B99 4.3",
    "A polygon of a plane with a closed outline: a face of a roof as it was found.",
    "border-line",
    "half-plane",
  ),
  "fundamental-matrix": term(
    "B99 3.1",
    "F: the 3 × 3 matrix of two views with x′ᵀ F x = 0 for all images x and x′ of one point.",
    "epipolar-line",
  ),
  "half-plane": term(
    "B99 4.1",
    "A plane that begins at a 3D line and goes to one side of it. One angle is open, θ: 0 where it is level, positive where it rises away from the line.",
    "similarity",
    "homography",
  ),
  hip: term(
    "",
    "A sloping edge of a roof where two faces meet, from a corner of the eaves upwards.",
    "ridge",
    "eave",
  ),
  homography: term(
    "B99 4.1",
    "The map between two images that a plane induces: x′ ≃ H x for the images of all of its points.",
    "half-plane",
  ),
  "interpretation-plane": term(
    "W96 3.4",
    "The plane through the projection centre and an image line: what the line shows lies somewhere in it.",
    "projection-centre",
  ),
  "intersection-line": term(
    "B99 4.2",
    "A new line where two neighbouring planes meet: a ridge, a hip or a valley, whether a photograph shows it clearly or not.",
    "ridge",
    "border-line",
  ),
  "likelihood-ratio": term(
    "B99 5",
    "How many times likelier a measurement is on a true candidate than on a false one.",
    "evidence",
    "odds",
  ),
  "main-direction": term(
    "W96 3.4",
    "One of the two perpendicular horizontal directions in which most lines of a building run: two peaks of the histogram of azimuths.",
    "cluster",
    "interpretation-plane",
  ),
  nat: term(
    "",
    "The unit of information with natural logarithms: 1 nat is 1.44 bits. Odds of e to 1 are one nat.",
    "odds",
    "description-length",
  ),
  odds: term(
    "",
    "p / (1 − p) of a probability p: 1 where both are equally likely. Logarithms of odds add up with evidence.",
    "posterior",
    "prior",
  ),
  parallax: term(
    "",
    "How far the image of a point moves from one view to another. The nearer the point, the larger it is.",
    "triangulation",
  ),
  "point-cloud": term(
    "",
    "Points on roofs, ground and trees, as airborne laser scanning measures them. Their accuracy is stated, their datum often another one.",
    "evidence",
  ),
  posterior: term(
    "B99 5",
    "The probability of a candidate after all evidence; the prior is that before it.",
    "prior",
    "evidence",
  ),
  "principal-distance": term(
    "W96 3.2",
    "The distance of the projection centre from the image plane, in millimetres or pixels; the focal length of a camera that is focused far away.",
    "principal-point",
  ),
  "principal-point": term(
    "",
    "The foot of the projection centre in the image plane. Cut from a larger photograph, an image may not contain it.",
    "camera-matrix",
  ),
  prior: term(
    "",
    "The probability of a candidate before anything is measured of it: how many of its kind are true.",
    "posterior",
  ),
  projection: term(
    "B99 3.1",
    "P = K [R | t]: the 3 × 4 matrix that takes points of the world to their images, x ≃ P X.",
    "camera-matrix",
    "projection-centre",
  ),
  "projection-centre": term(
    "",
    "C: the point through which all rays of a photograph go; P C = 0.",
    "projection",
  ),
  rake: term("", "The sloping border of a roof at a gable.", "eave", "ridge"),
  region: term(
    "W96 3.3",
    "A part of an image with one mean grey level and noise, bounded by straight vectors that its neighbours share.",
    "description-length",
  ),
  ridge: term("", "The level upper edge of a roof where two faces meet.", "eave", "hip"),
  segment: term(
    "B99 3.2",
    "A straight piece of a chain of edgels, fitted by orthogonal regression. Its direction is reliable, its ends are not.",
    "edgel",
  ),
  similarity: term(
    "B99 4.1",
    "How well the views agree on a half-plane at the angle θ: squared correlations at points of interest, averaged over the views that see it.",
    "half-plane",
    "correlation",
  ),
  "standard-deviation": term(
    "",
    "σ: the square root of the variance, in the unit of the number itself. Independent errors add by their variances.",
    "covariance",
  ),
  transfer: term(
    "B99 3.2",
    "From two views to a third: a pair of points or lines determines where the third view must show them.",
    "trifocal-tensor",
    "verification",
  ),
  triangulation: term(
    "B99 3.2",
    "A point or line in space from its images: where the rays, or the planes through the lines, come nearest to each other.",
    "covariance",
  ),
  "trifocal-tensor": term(
    "B99 3.2",
    "What three views have as two have the fundamental matrix: it transfers lines of two views to the third.",
    "transfer",
  ),
  verification: term(
    "B99 3.2, 4.3",
    "A hypothesis is compared with views that did not make it: a predicted line with the segments there, a facet with all photographs.",
    "transfer",
    "facet",
  ),
} as const satisfies Record<string, Omit<Term, "word">>;

export type TermId = keyof typeof ENTRIES;

const OTHER_WORDS: { readonly [Id in TermId]?: string } = {
  "camera-matrix": "calibration matrix",
  "half-plane": "half-plane",
  "intersection-line": "intersection of planes",
  similarity: "Sim(θ)",
};

export const TERM_IDS = Object.keys(ENTRIES) as readonly TermId[];

export const TERMS = Object.fromEntries(
  TERM_IDS.map((id) => [id, { word: OTHER_WORDS[id] ?? id.replaceAll("-", " "), ...ENTRIES[id] }]),
) as Readonly<Record<TermId, Term>>;

/** By the word, as a glossary has them. */
export const IN_ORDER: readonly TermId[] = [...TERM_IDS].sort((a, b) =>
  TERMS[a].word.localeCompare(TERMS[b].word, "en"),
);

export function termNamed(id: string): Term | null {
  return Object.hasOwn(TERMS, id) ? TERMS[id as TermId] : null;
}
