/** The thing that was picked, by its index in the results; anywhere it is picked, it lights up everywhere. */
export type Selection =
  | { kind: "segment"; view: number; index: number }
  | { kind: "line"; index: number }
  | { kind: "halfplane"; index: number }
  | { kind: "facet"; index: number }
  | { kind: "surface"; surface: string; building: number | null; facet: number | null; areaM2: number }
  | { kind: "view"; index: number };
