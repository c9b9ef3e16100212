/** Starts the page of the exercises; with `?teacher` in its address, that of the teacher. */
import "../../app/parts/base.css";
import "../../app/parts/parts.css";
import "./page.css";
import { render } from "preact";
import { restoreTextScale } from "../../app/state/textScale";
import { defineExercise } from "../RidgelineExercise";
import { ExercisesPage } from "./ExercisesPage";
import { needFigure } from "./siteFigure";

const fields = new URLSearchParams(location.search);
restoreTextScale();
defineExercise(needFigure);

const root = document.getElementById("app");
if (root !== null) {
  if (fields.has("teacher")) {
    void import("./TeacherPage").then(({ TeacherPage }) => render(<TeacherPage />, root));
  } else {
    render(<ExercisesPage seed={fields.get("seed")} />, root);
  }
}
