/** The project: where files are dropped, and what each of them was recognised as. */
import "./project.css";
import type { FileReport, ImageReport } from "../../shared/records";
import { counted } from "../parts/counted";
import { askedBy, onPage } from "../session/failureNotice";
import { isBusy } from "../state/activity";
import { files, inspection, isKnownKind, projectName, runOptions } from "../state/project";
import { images, peakMb, scene } from "../state/scene";
import { showsEntrance } from "../view/screen/opening";
import { ArrivalHabit } from "./ArrivalQuestion";
import { useFilePicker } from "./filePicker";
import { baseName } from "./inputFiles";
import { OrientationCheck } from "./OrientationCheck";
import { clearProject, deleteProject, openDemo, removeFile, setRunOptions } from "./projectActions";
import { Remedies } from "./Remedies";
import { OrientationChoice, PlaceFields } from "./RunOptionFields";
import { storedBytes } from "./storedProject";
import { Thumbnail } from "./Thumbnail";

export function Project() {
  return (
    <section class="panel">
      <div class="row spread">
        <h2>Project{projectName.value !== "" && <span class="muted"> · {projectName}</span>}</h2>
        {files.value.length > 0 && (
          <button type="button" onClick={() => void clearProject()}>
            New project
          </button>
        )}
      </div>
      {!showsEntrance.value && <DropZone />}
      {files.value.length > 0 && <Views />}
      {files.value.length > 0 && <OtherFiles />}
      <Warnings />
      {runOptions.value.applyFix && (
        <button type="button" onClick={() => void setRunOptions({ applyFix: false })}>
          Take the orientation as it is
        </button>
      )}
      {runOptions.value.ignoreCheck && (
        <button type="button" onClick={() => void setRunOptions({ ignoreCheck: false })}>
          Heed the orientation check again
        </button>
      )}
      <KeptNote />
    </section>
  );
}

/** More files of the project, or another one. */
function DropZone() {
  const { isOver, openFiles, openFolder, inputs } = useFilePicker();
  return (
    <section class={`dropzone ${isOver ? "over" : ""}`} aria-label="Add files">
      <p>Drop more files here, or another project.</p>
      <ArrivalHabit />
      <div class="row">
        <button type="button" onClick={openFiles}>
          Files…
        </button>
        <button type="button" onClick={openFolder}>
          Folder…
        </button>
        <button type="button" onClick={() => void openDemo()}>
          Demo scene
        </button>
      </div>
      {inputs}
    </section>
  );
}

function Views() {
  const report = inspection.value;
  if (report === null) {
    const count = counted(files.value.length, "files");
    return <p class="muted">{isBusy.value ? `Reading ${count}…` : `${count}, not read`}</p>;
  }
  if (report.images.length === 0) {
    return <p class="muted">No photograph among {counted(files.value.length, "files")}</p>;
  }
  return (
    <>
      <h3>{countText(report.images)}</h3>
      {peakMb.value !== null && <p class="muted numbers">about {peakMb} MB of memory in each worker</p>}
      <ul class="views">
        {report.images.map((image) => (
          <ViewRow key={image.path} image={image} />
        ))}
      </ul>
      <OrientationChoice />
      <PlaceFields />
    </>
  );
}

/** The image as the core has loaded it. */
function loadedImage(path: string): ImageBitmap | undefined {
  const views = scene.value?.views ?? [];
  return images.value[views.findIndex(({ name }) => name === baseName(path))];
}

function ViewRow({ image }: { image: ImageReport }) {
  const blob = files.value.find(({ path }) => path === image.path)?.blob;
  const { leftOut } = runOptions.value;
  const isUsed = !leftOut.includes(image.path);
  const others = leftOut.filter((path) => path !== image.path);
  return (
    <li class={`view ${isUsed ? "" : "left-out"}`}>
      <input
        type="checkbox"
        checked={isUsed}
        aria-label={`Use ${image.path}`}
        onChange={() => void setRunOptions({ leftOut: isUsed ? [...others, image.path] : others })}
      />
      <Thumbnail blob={blob} loaded={loadedImage(image.path)} />
      <div class="view-text">
        <span class="name" title={image.path}>
          {baseName(image.path)}
        </span>
        <span class="muted numbers">
          {image.size === null ? "unreadable" : `${image.size[0]} × ${image.size[1]} px`}
        </span>
        <Status image={image} />
      </div>
      <RemoveButton path={image.path} />
    </li>
  );
}

/** What is being read, or was rejected, is not told to be good. */
function Status({ image: { orientation } }: { image: ImageReport }) {
  const isTaken = scene.value !== null || runOptions.value.tileM !== null;
  const read = isBusy.value ? "orientation read" : "orientation read, not used";
  const kind = orientation === null ? "bad" : isTaken ? "good" : "";
  return (
    <span class={`status ${kind}`} title={orientation ?? ""}>
      {orientation === null ? "no orientation" : isTaken ? "oriented" : read}
    </span>
  );
}

/** Files inside an archive come and go with it. */
export function RemoveButton({ path }: { path: string }) {
  if (!files.value.some((file) => file.path === path)) {
    return <span />;
  }
  return (
    <button type="button" class="quiet" aria-label={`Remove ${path}`} onClick={() => void removeFile(path)}>
      ✕
    </button>
  );
}

/** What the panel of what is known beforehand does not show. */
function OtherFiles() {
  const report = inspection.value;
  const isShownAbove = ({ path, kind }: FileReport) =>
    isKnownKind(kind) || report?.images.some((image) => image.path === path) === true;
  const others = report?.files.filter((file) => !isShownAbove(file)) ?? [];
  if (others.length === 0) {
    return null;
  }
  return (
    <>
      <h3>Orientation and other files</h3>
      <ul class="files">
        {others.map(({ path, description }) => (
          <li key={path}>
            <span class="name" title={path}>
              {baseName(path)}
            </span>
            <span class="muted" title={description}>
              {description}
            </span>
            <RemoveButton path={path} />
          </li>
        ))}
      </ul>
    </>
  );
}

/** What the browser keeps, and how to have it forget. */
function KeptNote() {
  const bytes = storedBytes.value;
  if (bytes === null || files.value.length === 0) {
    return null;
  }
  return (
    <p class="kept muted" data-testid="kept">
      <span>Kept in this browser: {(bytes / 1e6).toFixed(1)} MB</span>
      <button type="button" class="quiet" onClick={() => void deleteProject()}>
        Delete
      </button>
    </p>
  );
}

function Warnings() {
  const all = new Set([...(inspection.value?.warnings ?? []), ...(scene.value?.warnings ?? [])]);
  if (all.size === 0) {
    return null;
  }
  return (
    <>
      <h3>Warnings</h3>
      <ul class="warnings">
        {[...all].map((text) => (
          <li key={text}>
            {onPage(text)} <Remedies asked={askedBy(text)} />
          </li>
        ))}
      </ul>
      <Doubts />
    </>
  );
}

/** The orientation check of a scene that was not rejected, where there is something to see. */
function Doubts() {
  const report = scene.value?.agreement ?? null;
  const isCured = runOptions.value.applyFix;
  if (report === null || isCured || (report.mistake === null && report.trials.length === 0)) {
    return null;
  }
  return <OrientationCheck report={report} />;
}

/** "6 views", or "4 of 6 views" where some are left out. */
function countText(images: readonly ImageReport[]): string {
  const used = images.filter(({ path }) => !runOptions.value.leftOut.includes(path)).length;
  const all = counted(images.length, "views");
  return used === images.length ? all : `${used} of ${all}`;
}
