/** `import "ridgeline/exercise"`: makes `<ridgeline-exercise>` known, with the figures' module beside this one. */
import { defineExercise } from "./RidgelineExercise";

export { RidgelineExercise } from "./RidgelineExercise";

defineExercise(
  () => import(/* @vite-ignore */ new URL(/* @vite-ignore */ "./figure.js", import.meta.url).href),
);
