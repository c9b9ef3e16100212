/** Of the result the model or the photographs are shown. */
import { Choice } from "../../parts/Choice";
import { mainResults } from "../../state/results";
import { face, showTab, tab } from "../../state/viewState";

export function ResultViews() {
  if (face.value !== "result" || mainResults.value.glb === null) {
    return null;
  }
  const choices = [
    ["model", "Model"],
    ["images", "Photographs"],
  ] as const;
  return (
    <Choice
      legend="What is shown"
      choices={choices}
      chosen={tab.value}
      choose={showTab}
      class="result-views"
    />
  );
}
