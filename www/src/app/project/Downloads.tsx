/** The output files, as soon as their stage has run. */

import "./project.css";
import { download } from "../session/stageRuns";
import { isBusy } from "../state/activity";
import { inspection } from "../state/project";
import { exportNames } from "../state/results";
import { saveProject } from "./projectActions";

const WHAT: Record<string, string> = {
  "model.glb": "textured model, glTF 2.0",
  "tileset.json": "3D Tiles 1.1, beside model.glb",
  "model.city.json": "CityJSON 2.0, LoD 2.2 and 2.3",
  "model_atlas.jpg": "texture of the CityJSON and OBJ files",
  "model.obj": "triangles with texture",
  "model.mtl": "material of the OBJ file",
  "model.ply": "triangles, and 3D lines as edges",
  "model.dxf": "3DFACE and LINE, AutoCAD R12",
  "footprints.geojson": "outlines on the ground",
  "facets.geojson": "roof faces in plan: areas, slopes, directions",
  "edges.geojson": "ridges, hips, valleys, eaves, rakes",
  "roof_report.html": "roofs in numbers and drawings, for print",
  "buildings.csv": "buildings as a table",
  "facets.csv": "roof faces as a table",
  "edges.csv": "roof edges as a table",
  "lines.csv": "3D lines as a table",
  "lines.json": "3D lines and their views",
  "halfplanes.json": "half-planes and Sim(theta)",
  "segments.json": "image segments",
  "evidence.json": "what speaks for each line and facet",
  "report.json": "counts, parameters, warnings",
};

export function Downloads() {
  return (
    <section class="panel">
      <div class="row spread">
        <h2>Output</h2>
        <button
          type="button"
          class="quiet"
          disabled={inspection.value === null || isBusy.value}
          title="Images, orientation, choices, parameters and results in one file, which opens here and on the command line"
          onClick={() => void saveProject()}
        >
          Save project
        </button>
      </div>
      {exportNames.value.length === 0 ? (
        <p class="muted">Files appear here once their stage has run.</p>
      ) : (
        <ul class="downloads">
          {exportNames.value.map((name) => (
            <li key={name}>
              <button type="button" class="link" onClick={() => void download(name)}>
                {name}
              </button>
              <span class="muted">{WHAT[name] ?? ""}</span>
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}
