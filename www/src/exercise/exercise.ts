/** `import "ridgeline/exercise"`: makes `<ridgeline-exercise>` known. */
import { defineExercise } from "./RidgelineExercise";

export { RidgelineExercise } from "./RidgelineExercise";

defineExercise();
