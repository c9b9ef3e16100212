/** The tour: the model against a photograph. */
import { throughView } from "../../app/view/space/Photograph";
import type { StageStep } from "../tourStep";

export default [
  {
    title: "The model",
    text: "Facets, walls to the ground, textures from the photographs.",
    question:
      "Choose a view in the marked list “Free camera”: you look through its camera, and the slider below fades its photograph in and out.",
    answer: () =>
      "Where the edges of the model and of the photograph do not coincide, the model is wrong: the plainest check there is.",
    pointsTo: "camera",
    isFound: () => throughView.value !== null,
  },
] satisfies readonly StageStep[];
