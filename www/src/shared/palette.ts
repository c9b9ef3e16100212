/**
 * The one visual language of 2D, 3D and charts. Hues are those of Okabe and Ito, lifted so that they stand on a
 * photograph; each also differs in lightness or thickness, so that no meaning hangs on hue alone.
 */
export const PALETTE = {
  unmatched: "#c3c8d0",
  matched: "#4aa8ff",
  merged: "#c78bf2",
  grown: "#ff9d2e",
  halfPlane: "#14b8a0",
  rejected: "#e5484d",
  border: "#3fbf6f",
  beam: "#f4f6f8",
  selected: "#ffe11a",
  casing: "#14171c",
  line: "#4aa8ff",
} as const;

/** Colours that depend on the theme, for canvases that no style sheet reaches. */
export interface ThemeColours {
  background: string;
  grid: string;
  ink: string;
  clay: string;
}

export const THEME_COLOURS: Record<"light" | "dark", ThemeColours> = {
  light: { background: "#eef0f2", grid: "#d3d8de", ink: "#2a2f36", clay: "#e6dfd6" },
  dark: { background: "#15181d", grid: "#2b3139", ink: "#d9dee5", clay: "#b3aca3" },
};

/** Hues for things that have no order: groups, regions, the two main directions. Equal weight, told apart without red and green. */
const CATEGORIES = [
  "#4aa8ff",
  "#ff9d2e",
  "#c78bf2",
  "#14b8a0",
  "#f2c14e",
  "#ef7fb0",
  "#8fb8de",
  "#b5c76a",
] as const;

/** The methods, where both are shown: B99 and W96. */
export const METHOD_COLOURS = {
  lines: CATEGORIES[0],
  rectangles: CATEGORIES[1],
  combined: CATEGORIES[2],
  coplanar: CATEGORIES[3],
  adjacency: CATEGORIES[4],
} as const;

/** What a surface of dense matching is; told apart without red and green, and from the grey of what is in no plane. */
export const CLASS_COLOURS = {
  building: CATEGORIES[1],
  ground: CATEGORIES[2],
  vegetation: CATEGORIES[3],
} as const;

export function category(index: number): string {
  return CATEGORIES[index % CATEGORIES.length] as string;
}
