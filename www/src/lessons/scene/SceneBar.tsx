/** Which scene is shown, and how to show another. */
import { pickedFiles } from "../../app/project/inputFiles";
import {
  choice,
  choiceName,
  hasStored,
  locked,
  showDemo,
  showFiles,
  showStored,
  unlockStored,
} from "./sceneChoice";

export function SceneBar() {
  const now = choice.value;
  const isStored = now?.kind === "files";
  return (
    <div class="scene-bar">
      <span>
        Shown on <strong>{choiceName.value}</strong>.
      </span>
      {hasStored.value && !isStored && (
        <button type="button" onClick={showStored}>
          Your project
        </button>
      )}
      {locked.value !== null && (
        <button type="button" onClick={() => void unlockStored()}>
          Open “{locked.value.name}” again
        </button>
      )}
      {now !== null && now.kind !== "demo" && (
        <button type="button" onClick={showDemo}>
          Demo scene
        </button>
      )}
      <label class="file-button">
        Other files…
        <input
          type="file"
          multiple
          class="visually-hidden"
          data-testid="lesson-files"
          onChange={(event) => {
            const { files } = event.currentTarget;
            if (files !== null) {
              showFiles(pickedFiles(files));
            }
          }}
        />
      </label>
    </div>
  );
}
