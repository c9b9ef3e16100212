/** The stages and methods of the core. Written by `make golden` from src/pipeline/stages. */

export const METHODS = ["lines", "rectangles", "combined", "coplanar", "adjacency"] as const;
export type Method = (typeof METHODS)[number];

/** In their order; each with the methods that have it, and the parameters that it reads. */
export const STAGES = [
  {
    name: "segments",
    title: "Segments",
    section: "B99 3.2",
    methods: ["lines", "combined", "coplanar", "adjacency"],
    reads: ["segments"],
  },
  {
    name: "matches",
    title: "Matches",
    section: "B99 3.1–3.4",
    methods: ["lines", "combined", "coplanar", "adjacency"],
    reads: ["matching", "lines3d", "adjustment"],
  },
  {
    name: "adjustment",
    title: "Adjustment",
    section: "views to their lines",
    methods: ["lines", "combined", "coplanar", "adjacency"],
    reads: ["adjustment", "lines3d"],
  },
  {
    name: "regions",
    title: "Regions",
    section: "W96 3.3",
    methods: ["rectangles", "combined"],
    reads: ["objectspace.oris"],
  },
  {
    name: "directions",
    title: "Directions",
    section: "W96 3.4",
    methods: ["rectangles", "combined"],
    reads: ["objectspace.windows", "objectspace.directions", "objectspace.clusters", "objectspace.planes.min_height_m"],
  },
  {
    name: "clusters",
    title: "Clusters",
    section: "W96 3.5",
    methods: ["rectangles", "combined"],
    reads: ["objectspace.clusters"],
  },
  {
    name: "lines",
    title: "3D lines",
    section: "B99 3.2, fig. 4",
    methods: ["lines", "combined", "coplanar", "adjacency"],
    reads: ["lines3d"],
  },
  {
    name: "ground",
    title: "Ground",
    section: "height of the ground",
    methods: ["lines", "rectangles", "combined", "coplanar", "adjacency"],
    reads: [],
  },
  {
    name: "rectangles",
    title: "Rectangles",
    section: "W96 3.6",
    methods: ["rectangles", "combined"],
    reads: ["objectspace.planes", "roof.border_nats_per_m"],
  },
  {
    name: "coplanar",
    title: "Coplanar sets",
    section: "B99 2, 5",
    methods: ["coplanar"],
    reads: ["roof.border_nats_per_m"],
  },
  {
    name: "adjacency",
    title: "Adjacency graphs",
    section: "B99 2",
    methods: ["adjacency"],
    reads: ["roof.border_nats_per_m"],
  },
  {
    name: "halfplanes",
    title: "Half-planes",
    section: "B99 4.1",
    methods: ["lines", "combined"],
    reads: ["sweep"],
  },
  {
    name: "dense",
    title: "Dense planes",
    section: "B99 2",
    methods: ["lines", "combined"],
    reads: ["point_cloud"],
  },
  {
    name: "groups",
    title: "Groups",
    section: "B99 4.2",
    methods: ["lines", "combined", "coplanar", "adjacency"],
    reads: ["roof.coplanar_angle_deg", "roof.coplanar_distance_m", "roof.min_facet_depth_m", "roof.max_facet_depth_m", "roof.extension_m", "roof.min_height_m", "roof.refine.loss_sigmas", "point_cloud"],
  },
  {
    name: "facets",
    title: "Facets",
    section: "B99 4.3",
    methods: ["lines", "combined", "coplanar", "adjacency"],
    reads: ["roof.border_nats_per_m", "roof.least_nats", "roof.min_area_m2", "roof.min_height_m", "roof.register"],
  },
  {
    name: "refinement",
    title: "Refinement",
    section: "B99 2",
    methods: ["lines", "combined", "coplanar", "adjacency"],
    reads: ["roof.refine", "roof.border_nats_per_m"],
  },
  {
    name: "corrections",
    title: "Corrections",
    section: "by hand",
    methods: ["lines", "rectangles", "combined", "coplanar", "adjacency"],
    reads: ["corrections", "matching", "lines3d", "sweep", "roof.refine"],
  },
  {
    name: "model",
    title: "Model",
    section: "walls, texture, files",
    methods: ["lines", "rectangles", "combined", "coplanar", "adjacency"],
    reads: ["texture"],
  },
] as const;
export type StageName = (typeof STAGES)[number]["name"];

/** Those of a model that is there already. */
export const STAGES_WITHOUT_VIEWS: readonly StageName[] = ["corrections", "model"];
