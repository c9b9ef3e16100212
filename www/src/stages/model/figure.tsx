/** The textured model. */
import { Filmstrip } from "../../app/view/images/Filmstrip";
import { facetRows } from "../facets/facetRows";
import type { StageFigure } from "../stageFigure";

export default {
  title: "Model",
  source: "B99 4.4, figures 24 and 25",
  text: "Walls down to the ground make facets into buildings: closed solids, whose V corners, E edges and F faces satisfy Euler's formula wherever no courtyard pierces them. Every face takes its texture from the view that shows it best; hidden parts come from other views.",
  equation: ["V - E + F = 2"],
  hint: "Choose a view instead of the free camera to lay its photograph over the model. Measure distances, slopes and areas.",

  rows: facetRows,
  Lab: Filmstrip,
} satisfies StageFigure;
