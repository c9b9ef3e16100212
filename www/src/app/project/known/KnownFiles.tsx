/** What is known of the place beforehand: the terrain models and footprints among the files, and which are taken. */
import "./known.css";
import { inspection, type KnownKind, runOptions } from "../../state/project";
import { scene } from "../../state/scene";
import { baseName } from "../inputFiles";
import { RemoveButton } from "../Project";
import { setRunOptions } from "../projectActions";
import { choiceOf, type KnownFile, knownFiles } from "./knownChoice";

const NAMES: Record<KnownKind, string> = { terrain: "Terrain model", footprints: "Footprints of buildings" };

export function KnownFiles() {
  const report = inspection.value;
  const all = report === null ? [] : knownFiles(report, runOptions.value, scene.value?.known ?? null);
  if (all.length === 0) {
    return null;
  }
  return (
    <section class="panel">
      <h2>Known beforehand</h2>
      <ul class="known-files" data-testid="known-files">
        {all.map((file) => (
          <KnownRow key={file.path} file={file} />
        ))}
      </ul>
    </section>
  );
}

function KnownRow({ file }: { file: KnownFile }) {
  const { path, kind, isTaken, words } = file;
  const isChosen = isTaken ?? !runOptions.value.leftOut.includes(path);
  return (
    <li class={isChosen ? "" : "left-out"}>
      <input
        type="checkbox"
        checked={isChosen}
        aria-label={`Use ${path}`}
        onChange={() => void setRunOptions(choiceOf(file, !isChosen, runOptions.value))}
      />
      <div class="view-text">
        <span class="name" title={path}>
          {baseName(path)}
        </span>
        <span class="muted">{NAMES[kind]}</span>
        {words !== "" && <span class={isTaken === true ? "status good" : "muted"}>{words}</span>}
      </div>
      <RemoveButton path={path} />
    </li>
  );
}
