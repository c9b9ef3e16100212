/** The output files, by what they are for. */
import { Menu } from "../../parts/Menu";
import { saveProject } from "../../project/projectActions";
import { download } from "../../session/stageRuns";
import { isBusy } from "../../state/activity";
import { exportNames } from "../../state/results";

type Files = Readonly<Record<string, string>>;

const GROUPS: readonly (readonly [title: string, files: Files])[] = [
  [
    "Report",
    {
      "roof_report.html": "roofs in numbers and drawings, for print",
      "buildings.csv": "buildings as a table",
      "facets.csv": "roof facets as a table",
      "edges.csv": "roof edges as a table",
      "roofs.json": "all of it for programs, with usable areas",
    },
  ],
  [
    "CAD",
    { "model.ifc": "IFC4: roofs, their facets, walls, areas", "model.dxf": "3DFACE and LINE, AutoCAD R12" },
  ],
  [
    "GIS",
    {
      "model.city.json": "CityJSON 2.0, LoD 2.2 and 2.3",
      "model.city.jsonl": "the same as CityJSONSeq, a building a line",
      "footprints.geojson": "outlines on the ground",
      "facets.geojson": "roof facets in plan: areas, slopes, directions",
      "edges.geojson": "ridges, hips, valleys, eaves, rakes",
      "obstructions.geojson": "what stands on the roofs, with heights",
    },
  ],
  [
    "3D",
    {
      "model.glb": "textured model, glTF 2.0",
      "model.obj": "triangles with texture",
      "model.mtl": "material of the OBJ file",
      "model_atlas.jpg": "texture of the CityJSON and OBJ files",
      "model.ply": "triangles, and 3D lines as edges",
      "tileset.json": "3D Tiles 1.1, beside model.glb",
    },
  ],
  [
    "Data",
    {
      "lines.json": "3D lines and their views",
      "lines.csv": "3D lines as a table",
      "halfplanes.json": "half-planes and Sim(θ)",
      "segments.json": "image segments",
      "evidence.json": "what speaks for each line and facet",
      "report.json": "counts, parameters, warnings",
    },
  ],
];

export function DownloadMenu() {
  const known = GROUPS.flatMap(([, files]) => Object.keys(files));
  const others = exportNames.value.filter((name) => !known.includes(name));
  const groups = [...GROUPS, ["Other", Object.fromEntries(others.map((name) => [name, ""]))] as const];
  return (
    <Menu title="Download" class="downloads">
      {groups.map(([title, files]) => {
        const names = Object.keys(files).filter((name) => exportNames.value.includes(name));
        return (
          names.length > 0 && (
            <section key={title}>
              <h3>{title}</h3>
              <ul>
                {names.map((name) => (
                  <li key={name}>
                    <button type="button" class="link" onClick={() => void download(name)}>
                      {name}
                    </button>
                    <span class="muted">{files[name]}</span>
                  </li>
                ))}
              </ul>
            </section>
          )
        );
      })}
      <section>
        <h3>Project</h3>
        <button type="button" class="link" disabled={isBusy.value} onClick={() => void saveProject()}>
          Save project
        </button>
        <span class="muted">
          {" "}
          images, orientation, choices and results in one file, which opens here and on the command line
        </span>
      </section>
    </Menu>
  );
}
