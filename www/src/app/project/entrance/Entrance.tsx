/** What is shown while nothing is open: a finished model, the photographs that it came from, and where to put one's own. */
import { counted } from "../../parts/counted";
import { baseName } from "../inputFiles";
import "./entrance.css";
import { signal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { THEME_COLOURS } from "../../../shared/palette";
import { createTurntable, type PhotographicGround, type Turntable } from "../../../viewer/turntable";
import { theme } from "../../state/theme";
import { startTour } from "../../tour/steps";
import { useFilePicker } from "../filePicker";
import { openDemo, reopen } from "../projectActions";
import { forgetStoredProject, keptProjects, listKept } from "../storedProject";

/** What the build wrote beside the model. */
interface EntranceScene {
  photographs: string[];
  ground: PhotographicGround;
}

const DEMO = "./demo/";
const FOLDER = "./entrance/";

export function Entrance() {
  return (
    <div class="entrance" data-testid="entrance">
      <section class="showpiece" aria-label="An example">
        <Model />
        <Photographs />
      </section>
      <section class="invitation" aria-label="Begin">
        <h2>From aerial photographs to textured roof models</h2>
        <p>
          Three or more overlapping photographs become buildings in 3D: computed here, in the browser. Nothing
          is sent anywhere.
        </p>
        <Doors />
        <KeptProjects />
        <p>
          <a href="./lessons.html">Ten lessons</a>{" "}
          <span class="muted">
            of multi-view geometry, with <a href="./exercises.html">exercises</a> and a{" "}
            <a href="./exercises.html#glossary">glossary</a>; or a{" "}
          </span>
          <button type="button" class="link" onClick={startTour}>
            tour in twelve steps
          </button>
          <span class="muted"> through the method.</span>
        </p>
      </section>
    </div>
  );
}

/** What people come with. */
function Doors() {
  const { isOver, openFiles, openFolder, inputs } = useFilePicker();
  return (
    <div class={`doors ${isOver ? "over" : ""}`}>
      <Door
        title="I have only photographs"
        text="JPEG, PNG or TIFF, from a drone or an aeroplane. Where each was taken is computed first."
        onClick={openFiles}
      />
      <Door
        title="Photographs with their orientation"
        text="From Metashape, Pix4D, COLMAP, OpenSfM, Bundler and others, matrices, or lists of X Y Z omega phi kappa."
        onClick={openFiles}
      />
      <Door
        title="Show me on the example"
        text="Five houses, from six photographs to the model, in some seconds."
        onClick={() => void openDemo()}
      />
      <p class="muted">
        Files and folders can be dropped anywhere on this page, also as a .zip, and a CityJSON model of your
        own or of anybody, to be looked at, measured and corrected; or{" "}
        <button type="button" class="link" onClick={openFolder}>
          open a folder
        </button>
        .
      </p>
      {inputs}
    </div>
  );
}

/** The projects of earlier visits. */
function KeptProjects() {
  useEffect(() => void listKept(), []);
  if (keptProjects.value.length === 0) {
    return null;
  }
  return (
    <section class="kept-projects" aria-label="Your last projects">
      <h3>Your last projects</h3>
      <ul>
        {keptProjects.value.map(({ id, name, seen }) => (
          <li key={id}>
            <button type="button" class="link" onClick={() => void reopen(id)}>
              {name}
            </button>
            <span class="muted numbers">{new Date(seen).toLocaleString([], SHORT)}</span>
            <button
              type="button"
              class="quiet"
              aria-label={`Delete ${name}`}
              title="Delete from this browser"
              onClick={() => void forgetStoredProject(id)}
            >
              ✕
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}

const SHORT = { dateStyle: "medium", timeStyle: "short" } as const;

function Door({ title, text, onClick }: { title: string; text: string; onClick: () => void }) {
  return (
    <button type="button" class="way" onClick={onClick}>
      <b>{title}</b>
      <span class="muted">{text}</span>
    </button>
  );
}

/** The scene that the build wrote; null until it is here, or where the site has none. */
const shown = signal<EntranceScene | null>(null);
const table = signal<Turntable | null>(null);

function Model() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const isDrawn = table.value !== null;
  useEffect(() => {
    const element = canvas.current;
    let isGone = false;
    if (element !== null) {
      void showModel(element).then((made) => {
        if (isGone) {
          made?.dispose();
        } else {
          table.value = made;
        }
      });
    }
    return () => {
      isGone = true;
      table.value?.dispose();
      table.value = null;
    };
  }, []);
  useSignalEffect(() => {
    table.value?.setBackground(THEME_COLOURS[theme.value].background);
  });
  return (
    <div class={`turntable ${isDrawn ? "drawn" : ""}`}>
      {!isDrawn && <img src={`${DEMO}images/s2_02.jpg`} alt="" />}
      <canvas
        ref={canvas}
        role="img"
        data-testid="turntable"
        aria-label="Textured 3D model of five detached houses on a photograph of their ground; drag to turn it"
      />
    </div>
  );
}

/** Null where there is no WebGL or no model: the photograph stays in its place. */
async function showModel(canvas: HTMLCanvasElement): Promise<Turntable | null> {
  try {
    const [scene, model] = await Promise.all([
      fetched("scene.json").then((response) => response.json() as Promise<EntranceScene>),
      fetched("model.glb").then((response) => response.arrayBuffer()),
    ]);
    shown.value = scene;
    const isStill = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
    return await createTurntable(canvas, model, scene.ground, `${DEMO}${scene.ground.photograph}`, !isStill);
  } catch {
    return null;
  }
}

async function fetched(name: string): Promise<Response> {
  const response = await fetch(`${FOLDER}${name}`);
  if (!response.ok) {
    throw new Error(`${name}: ${response.status}`);
  }
  return response;
}

function Photographs() {
  const names = shown.value?.photographs ?? [];
  return (
    <div class="sources">
      <p>Five houses, computed from {counted(names.length === 0 ? 6 : names.length, "photographs")}.</p>
      <ul>
        {names.map((path) => (
          <li key={path}>
            <img src={`${DEMO}${path}`} alt={`Aerial photograph ${baseName(path)}`} loading="lazy" />
          </li>
        ))}
      </ul>
    </div>
  );
}
